"""Values with the file and line that they come from, and the lines of the keys of a TOML text."""

import re
import tomllib
from collections.abc import Mapping, Set
from functools import lru_cache
from typing import Final, NamedTuple, TypeAlias

from trunnion.records import dataclass

#: Deeper keys are refused unread: the time of the TOML parser grows with the cube of their depth.
MAX_KEY_DEPTH: Final = 32

# Groups are not possessive: before Python 3.11.5 such a group loses what it has matched. Their parts are.
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_BLANKS = re.compile(r"[ \t]*+")
_BLANK_LINES = re.compile(r"(?:[ \t\r\n]++|#[^\n]*+)*")
_UNQUOTED_VALUE = re.compile(r"[^,\]}#\n]*+")
_COMMENT = re.compile(r"#[^\n]*+")

#: What follows an opening quote, with the closing one. A multi-line string may end with up to two quotes of its own
#: before the closing three.
_STRING_ENDS: Final = {
    '"': re.compile(r'(?:[^"\\]++|\\.)*"', re.DOTALL),
    "'": re.compile(r"[^']*+'"),
    '"""': re.compile(r'(?:[^"\\]++|\\.|"(?!""))*"{3,}+', re.DOTALL),
    "'''": re.compile(r"(?:[^']++|'(?!''))*'{3,}+"),
}

_BELOW: Final = re.compile(r"(?:\"{3}|'{3}|\[[ \t]*)\r?\n")

KeyPath: TypeAlias = tuple[str | int, ...]


@dataclass(slots=True)
class LocatedValue:
    """A value of a definition, with its file and line.

    value         a scalar, a list of scalars or of lists, a dict of located values (a table), or a list of located
                  tables
    instead       the value of the definition that this one, of a call, stands for
    begins_below  the first line of a text, or of a list, stands in the line below that of its key and what opens it
    """

    value: object
    file: str
    line: int
    begins_below: bool = False
    instead: object = None


def _is_tables(value: object) -> bool:
    """Whether a raw TOML value is an array of tables."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def locate_values(
    value: object,
    file: str,
    lines: Mapping[KeyPath, int],
    path: KeyPath = (),
    parent_line: int = 0,
    below: Set[KeyPath] = frozenset(),
) -> LocatedValue:
    """Attach file and lines to a raw TOML value and everything in it.

    value        as ``tomllib`` gives it
    lines        of each key
    path         path of the value
    parent_line  line of values that have none of their own
    below        from ``texts_below``
    """
    line = lines.get(path, parent_line)
    if isinstance(value, dict):
        table = {str(key): locate_values(item, file, lines, (*path, key), line, below) for key, item in value.items()}
        return LocatedValue(table, file, line)
    if isinstance(value, list) and _is_tables(value):
        return LocatedValue(
            [locate_values(item, file, lines, (*path, i), line, below) for i, item in enumerate(value)], file, line
        )
    return LocatedValue(value, file, line, path in below)


class ValuePlace(NamedTuple):
    """Where a key and its value stand in a TOML text: ``text[key:start]`` is the key, ``text[start:end]`` the value.

    An item of an array has no key: ``key`` is ``start``.
    """

    key: int
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Layout:
    """Where everything stands in a TOML text; the path of a table in an array has its index.

    lines     line of every key, from 1
    values    places of the values of ``key = value``, and of the items of arrays
    headers   offsets of the headers of tables, with the paths of the tables, in the order of the text
    comments  begin and end of every comment, from its ``#`` on, in the order of the text
    """

    lines: dict[KeyPath, int]
    values: dict[KeyPath, ValuePlace]
    headers: list[tuple[int, KeyPath]]
    comments: list[tuple[int, int]]


@lru_cache(8)
def layout(text: str) -> Layout:
    """Where everything stands in a TOML text, which ``tomllib`` does not keep; nobody changes it.

    It is kept for a while: a definition is loaded, and then searched for marks.

    Nothing is checked here: for a text that is not TOML, the places mean nothing.

    Raises ``RecursionError`` if tables nest too deeply.
    """
    try:
        return _Scanner(text).scan()
    except (IndexError, ValueError):
        return Layout({}, {}, [], [])


def texts_below(text: str, found: Layout) -> frozenset[KeyPath]:
    """Keys of a TOML text whose texts and lists begin in the line below what opens them."""
    return frozenset(path for path, place in found.values.items() if _BELOW.match(text, place.start))


class _Scanner:
    """Goes over a TOML text once, notes the places of keys, and skips values."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.line = 1
        self.counted = 0
        self.found: dict[KeyPath, int] = {}
        self.values: dict[KeyPath, ValuePlace] = {}
        self.headers: list[tuple[int, KeyPath]] = []
        self.comments: list[tuple[int, int]] = []
        self.arrays: dict[KeyPath, int] = {}

    def scan(self) -> Layout:
        here: KeyPath = ()
        while self._skip_blanks(newlines=True):
            if self.text.startswith("[[", self.at):
                here = self._header(2, array=True)
            elif self.text[self.at] == "[":
                here = self._header(1, array=False)
            else:
                self._pair(here)
        return Layout(self.found, self.values, self.headers, self.comments)

    def _note_line(self, path: KeyPath) -> None:
        self.line += self.text.count("\n", self.counted, self.at)
        self.counted = self.at
        self.found.setdefault(path, self.line)

    def _skip_blanks(self, *, newlines: bool) -> bool:
        """Skip blanks (with newlines: also lines and comments); return whether text is left."""
        start = self.at
        self._skip(_BLANK_LINES if newlines else _BLANKS)
        self.comments += (match.span() for match in _COMMENT.finditer(self.text, start, self.at))
        return self.at < len(self.text)

    def _skip(self, pattern: re.Pattern[str]) -> None:
        """Skip what a pattern matches; without a match, all that is left."""
        match = pattern.match(self.text, self.at)
        self.at = match.end() if match else len(self.text)

    def _key(self) -> list[str]:
        """Read a dotted key, up to what follows it."""
        parts: list[str] = []
        while True:
            self._skip_blanks(newlines=False)
            start = self.at
            if self.text[start] in "\"'":
                self._string()
                # The TOML parser resolves the escapes of a quoted key.
                parts.append(tomllib.loads(f"key = {self.text[start : self.at]}")["key"])
            else:
                bare = _BARE_KEY.match(self.text, start)
                self.at = bare.end() if bare else start + 1
                parts.append(self.text[start : self.at])
            self._skip_blanks(newlines=False)
            if not self.text.startswith(".", self.at):
                return parts
            if len(parts) > MAX_KEY_DEPTH:
                raise RecursionError
            self.at += 1

    def _header(self, brackets: int, *, array: bool) -> KeyPath:
        begin = self.at
        self.at += brackets
        keys = self._key()
        path: KeyPath = ()
        for depth, key in enumerate(keys):
            path = (*path, key)
            if array and depth == len(keys) - 1:
                self._note_line(path)
                self.arrays[path] = self.arrays.get(path, -1) + 1
            if path in self.arrays:
                path = (*path, self.arrays[path])
            self._note_line(path)
        self.at += brackets
        self.headers.append((begin, path))
        return path

    def _pair(self, here: KeyPath) -> None:
        path, begin = here, self.at
        for key in self._key():
            path = (*path, key)
            self._note_line(path)
        self.at += 1  # the equals sign
        self._skip_blanks(newlines=False)
        start = self.at
        self._value(path)
        self._note_place(path, begin, start)

    def _note_place(self, path: KeyPath, key: int, start: int) -> None:
        """Note the value that begins at ``start`` and has just been skipped."""
        self.values.setdefault(path, ValuePlace(key, start, start + len(self.text[start : self.at].rstrip())))

    def _value(self, path: KeyPath) -> None:
        self._skip_blanks(newlines=False)
        letter = self.text[self.at] if self.at < len(self.text) else ""
        if letter == "{":
            self._items("}", path, array=False)
        elif letter == "[":
            self._items("]", path, array=True)
        elif letter and letter in "\"'":
            self._string()
        else:
            self._skip(_UNQUOTED_VALUE)

    def _items(self, close: str, path: KeyPath, *, array: bool) -> None:
        self.at += 1
        count = 0
        while self._skip_blanks(newlines=True) and self.text[self.at] != close:
            if self.text[self.at] in ",]}":
                self.at += 1  # also a bracket that closes nothing, which the TOML parser reports
            elif array:
                self._note_line((*path, count))
                start = self.at
                self._value((*path, count))
                self._note_place((*path, count), start, start)
                count += 1
            else:
                self._pair(path)
        self.at += 1

    def _string(self) -> None:
        quote = self.text[self.at]
        if self.text.startswith(quote * 3, self.at):
            quote *= 3
        self.at += len(quote)
        self._skip(_STRING_ENDS[quote])
