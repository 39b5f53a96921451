"""Definitions in TOML: read with account of every key, and with the place that each value came from.

In:     a TOML file, or the name of a shipped one, that may extend one other.
Out:    a ``Table`` with typed getters. Mistakes are collected, and raised together by ``Table.check``.
Knows:  TOML, files and keys. What the keys mean is the reader's business: machines and controls both use this.

A definition may come from anybody, so reading one runs nothing and opens nothing but TOML files that were named by the
user, shipped with Trunnion, or lie beside or below the file that extends them.
"""

import difflib
import math
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources.abc import Traversable
from pathlib import Path, PurePosixPath
from typing import Final, TypeAlias, overload

from trunnion.errors import InputError, Problem

#: Larger files are refused unread: real definitions have a few kilobytes.
LARGEST_FILE: Final = 1_000_000

#: The end of a key says its unit; the longest one that fits counts.
UNITS: Final[Mapping[str, str]] = {
    "_mm_min": "millimetres per minute",
    "_deg_min": "degrees per minute",
    "_mm_s2": "millimetres per second squared",
    "_deg_s2": "degrees per second squared",
    "_mm_s": "millimetres per second",
    "_deg_s": "degrees per second",
    "_mm": "millimetres",
    "_deg": "degrees",
    "_s": "seconds",
    "_rpm": "revolutions per minute",
    "_kw": "kilowatts",
    "_nm": "newton metres",
    "_kg": "kilograms",
}

#: Deeper keys are refused unread: the TOML parser takes time that grows with the cube of their depth.
DEEPEST_KEY: Final = 32

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)")


class Required:
    """The type of ``REQUIRED``: there is no default, a missing key is a mistake."""


REQUIRED: Final = Required()

Path_: TypeAlias = tuple[str | int, ...]
Library: TypeAlias = Traversable | Path


# ---------------------------------------------------------------------------------------------------------------------
# Values that know where they stand


@dataclass(slots=True)
class Entry:
    """A value and its place. ``value`` is a scalar, a list, a dict of entries (table) or a list of table entries."""

    value: object
    file: str
    line: int


def _is_tables(value: object) -> bool:
    """Say whether a raw TOML value is an array of tables."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def _entry(value: object, file: str, lines: Mapping[Path_, int], path: Path_ = (), parent_line: int = 0) -> Entry:
    """Give a raw TOML value, and all that it holds, its place."""
    line = lines.get(path, parent_line)
    if isinstance(value, dict):
        table = {str(key): _entry(item, file, lines, (*path, key), line) for key, item in value.items()}
        return Entry(table, file, line)
    if isinstance(value, list) and _is_tables(value):
        return Entry([_entry(item, file, lines, (*path, i), line) for i, item in enumerate(value)], file, line)
    return Entry(value, file, line)


# ---------------------------------------------------------------------------------------------------------------------
# Lines of keys


def key_lines(text: str) -> dict[Path_, int]:
    """Line of every key of a TOML text, from 1; tables in arrays are told apart by their index.

    ``tomllib`` keeps no lines. Nothing is checked here: of a text that is not TOML, any lines or none may come out.

    Raises
    ------
    RecursionError
        If tables nest too deeply.
    """
    try:
        return _Lines(text).index()
    except (IndexError, ValueError):
        return {}


class _Lines:
    """One walk over a TOML text that notes where keys stand, and skips what values hold."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.line = 1
        self.counted = 0
        self.found: dict[Path_, int] = {}
        self.arrays: dict[Path_, int] = {}

    def index(self) -> dict[Path_, int]:
        here: Path_ = ()
        while self._blank(newlines=True):
            if self.text.startswith("[[", self.at):
                here = self._header(2, array=True)
            elif self.text[self.at] == "[":
                here = self._header(1, array=False)
            else:
                self._pair(here)
        return self.found

    def _note(self, path: Path_) -> None:
        self.line += self.text.count("\n", self.counted, self.at)
        self.counted = self.at
        self.found.setdefault(path, self.line)

    def _blank(self, *, newlines: bool) -> bool:
        """Skip blanks (with newlines: also lines and comments); say whether text is left."""
        blanks = " \t\r\n" if newlines else " \t"
        while self.at < len(self.text):
            letter = self.text[self.at]
            if letter in blanks:
                self.at += 1
            elif newlines and letter == "#":
                self._to("\n")
            else:
                return True
        return False

    def _to(self, mark: str) -> None:
        end = self.text.find(mark, self.at)
        self.at = len(self.text) if end < 0 else end

    def _key(self) -> list[str]:
        """Read a dotted key and leave the cursor on what follows it."""
        parts: list[str] = []
        while True:
            self._blank(newlines=False)
            start = self.at
            if self.text[start] in "\"'":
                self._string()
                # The parser itself undoes the escapes of a quoted key.
                parts.append(tomllib.loads(f"key = {self.text[start : self.at]}")["key"])
            else:
                bare = _BARE_KEY.match(self.text, start)
                self.at = bare.end() if bare else start + 1
                parts.append(self.text[start : self.at])
            self._blank(newlines=False)
            if not self.text.startswith(".", self.at):
                return parts
            if len(parts) > DEEPEST_KEY:
                raise RecursionError
            self.at += 1

    def _header(self, brackets: int, *, array: bool) -> Path_:
        self.at += brackets
        keys = self._key()
        path: Path_ = ()
        for depth, key in enumerate(keys):
            path = (*path, key)
            if array and depth == len(keys) - 1:
                self._note(path)
                self.arrays[path] = self.arrays.get(path, -1) + 1
            if path in self.arrays:
                path = (*path, self.arrays[path])
            self._note(path)
        self.at += brackets
        return path

    def _pair(self, here: Path_) -> None:
        path = here
        for key in self._key():
            path = (*path, key)
            self._note(path)
        self.at += 1  # the equals sign
        self._value(path)

    def _value(self, path: Path_) -> None:
        self._blank(newlines=False)
        letter = self.text[self.at] if self.at < len(self.text) else ""
        if letter == "{":
            self._items("}", path, array=False)
        elif letter == "[":
            self._items("]", path, array=True)
        elif letter and letter in "\"'":
            self._string()
        else:
            while self.at < len(self.text) and self.text[self.at] not in ",]}#\n":
                self.at += 1

    def _items(self, close: str, path: Path_, *, array: bool) -> None:
        self.at += 1
        count = 0
        while self._blank(newlines=True) and self.text[self.at] != close:
            if self.text[self.at] in ",]}":
                self.at += 1  # also a bracket that closes nothing: the parser complains of it
            elif array:
                self._note((*path, count))
                self._value((*path, count))
                count += 1
            else:
                self._pair(path)
        self.at += 1

    def _string(self) -> None:
        quote = self.text[self.at]
        if self.text.startswith(quote * 3, self.at):
            quote *= 3
        self.at += len(quote)
        while self.at < len(self.text) and not self.text.startswith(quote, self.at):
            self.at += 2 if self.text[self.at] == "\\" and quote[0] == '"' else 1
        self.at += len(quote)
        # A multi-line string may end with up to two quotes of its own before the closing three.
        while len(quote) == 3 and self.text.startswith(quote[0], self.at):
            self.at += 1


# ---------------------------------------------------------------------------------------------------------------------
# Files


@dataclass(frozen=True, slots=True)
class _File:
    """A definition file: where to read it, how to call it, and the folder that its ``extends`` may reach."""

    place: Library
    label: str
    folder: Path | None


def _shipped(name: str, library: Library) -> _File:
    place = library.joinpath(f"{name}.toml")
    return _File(place, str(place), None)


def _read(source: _File) -> Entry:
    """Read and parse one file; what it extends is not looked at."""
    label = source.label
    try:
        if not source.place.is_file():
            raise InputError(Problem(label, 0, "there is no such file", "check the name"))
        with source.place.open("rb") as stream:
            data = stream.read(LARGEST_FILE + 1)
    except OSError as error:
        raise InputError(Problem(label, 0, f"cannot be read: {error.strerror or error}")) from None
    if len(data) > LARGEST_FILE:
        raise InputError(Problem(label, 0, f"has more than {LARGEST_FILE} bytes", "a definition is a small file"))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(Problem(label, line, "is not UTF-8 text", "save the file as UTF-8")) from None
    try:
        lines = key_lines(text)
        raw = tomllib.loads(text)
        return _entry(raw, label, lines, (), 1)
    except RecursionError:
        raise InputError(Problem(label, 0, "nests too deeply", "a definition needs three levels")) from None
    except ValueError as error:  # TOMLDecodeError is one; so is a number with thousands of digits
        raise InputError(_syntax_problem(label, text, str(error))) from None


def _syntax_problem(label: str, text: str, message: str) -> Problem:
    what, _, place = message.partition(" (at ")
    number = re.search(r"line (\d+)", place)
    at_end = text.count("\n") + 1 if "end of document" in place else 0
    line = int(number.group(1)) if number else at_end
    return Problem(label, line, f"is not TOML: {what[:1].lower()}{what[1:]}", "mend the line, or the one before it")


def _parent(extends: Entry, child: _File, library: Library) -> _File:
    """Find the file that ``extends`` names; the child may reach the library and its own folder, nothing else."""
    file, line, name = extends.file, extends.line, extends.value
    if not isinstance(name, str):
        cure = 'write one name, such as extends = "generic_head_table_bc"'
        raise InputError(Problem(file, line, f"extends is {_shown(name)}", cure))
    if _NAME.fullmatch(name):
        found = _shipped(name, library)
        if not found.place.is_file():
            near = _near(name, names_in(library))
            cure = near or "write one of " + ", ".join(names_in(library))
            raise InputError(Problem(file, line, f'extends: nothing shipped is called "{name}"', cure))
        return found
    reach = "write the name of a shipped definition, or a path to a .toml file in the same folder or below it"
    pure = PurePosixPath(name)
    outside = pure.is_absolute() or ".." in pure.parts or re.search(r"[\\:\x00-\x1f]", name)
    if outside or pure.suffix != ".toml" or child.folder is None:
        raise InputError(Problem(file, line, f'extends: "{name}" is not a file that a definition may read', reach))
    place = child.folder / pure
    # A link may lead out of the folder although its name does not.
    if not place.resolve().is_relative_to(child.folder.resolve()):
        raise InputError(Problem(file, line, f'extends: "{name}" leads out of the folder of the definition', reach))
    if not place.is_file():
        raise InputError(Problem(file, line, f'extends: there is no file "{name}" beside the definition', reach))
    return _File(place, str(place), place.parent)


def _identity(source: _File) -> str:
    return str(source.place.resolve()) if isinstance(source.place, Path) else source.label


def _line_of_ancestors(root: Entry, source: _File, library: Library, problems: list[Problem]) -> Entry:
    """Merge a table onto everything that it extends, directly and through others."""
    tables = [root]
    seen = [_identity(source)]
    labels = [_short(source.label)]
    while True:
        table = tables[-1]
        assert isinstance(table.value, dict)
        extends = table.value.pop("extends", None)
        if extends is None:
            break
        # Where the word stands decides what it may reach, which matters for a table that was itself inherited.
        source = _parent(extends, source, library)
        labels.append(_short(source.label))
        if _identity(source) in seen:
            what = "extends goes in a circle: " + " extends ".join(labels)
            raise InputError(Problem(extends.file, extends.line, what, "take one extends out"))
        seen.append(_identity(source))
        tables.append(_read(source))
    merged = tables.pop()
    while tables:
        merged = _merge(merged, tables.pop(), "", problems)
    return merged


def _short(label: str) -> str:
    return PurePosixPath(label.replace("\\", "/")).name


# ---------------------------------------------------------------------------------------------------------------------
# Merging


def _merge(parent: Entry, child: Entry, path: str, problems: list[Problem], later: bool = False) -> Entry:
    """Return the parent with what the child says instead; tables merge deeply, named tables by name.

    ``later``: the table extends something that is not looked at yet (see ``extended``), so that removals must stay.
    """
    if isinstance(parent.value, dict) and isinstance(child.value, dict):
        table = dict(parent.value)
        later = later or "extends" in parent.value or "extends" in child.value
        for key, entry in child.value.items():
            below = f"{path}.{key}" if path else key
            table[key] = _merge(table[key], entry, below, problems, later) if key in table else entry
        return Entry(table, child.file, child.line)
    if _named(parent) and _holds_tables(child):
        return Entry(_merge_by_name(parent, child, path, problems, later), child.file, child.line)
    return child


def _holds_tables(entry: Entry) -> bool:
    return isinstance(entry.value, list) and bool(entry.value) and isinstance(entry.value[0], Entry)


def _named(entry: Entry) -> bool:
    return _holds_tables(entry) and all(_name_of(item) is not None for item in _items(entry))


def _items(entry: Entry) -> list[Entry]:
    return entry.value if isinstance(entry.value, list) else []


def _name_of(item: Entry) -> str | None:
    name = item.value.get("name") if isinstance(item.value, dict) else None
    return name.value if isinstance(name, Entry) and isinstance(name.value, str) else None


def _merge_by_name(parent: Entry, child: Entry, path: str, problems: list[Problem], later: bool) -> list[Entry]:
    """Merge two arrays of named tables: the parent's order first, then the child's new ones."""
    result = list(_items(parent))
    taken: set[str] = set()
    for i, item in enumerate(_items(child)):
        assert isinstance(item.value, dict)
        name = _name_of(item)
        where = f"{path}[{i}]"
        if name is None:
            cure = "write the name of the one to change, or a new name"
            problems.append(Problem(item.file, item.line, f"{where}.name is missing", cure))
            continue
        remove = item.value.get("remove")
        item = item if later else _without_remove(item)
        at = next((k for k, old in enumerate(result) if _name_of(old) == name), None)
        if remove is not None and not isinstance(remove.value, bool):
            problems.append(
                Problem(remove.file, remove.line, f"{where}.remove is {_shown(remove.value)}", "write true")
            )
        elif remove is not None and remove.value:
            if later:
                result = [old for old in result if _name_of(old) != name] + [item]
            elif at is None:
                what = f'{where}: there is no {path} called "{name}" to remove'
                problems.append(Problem(remove.file, remove.line, what, _near(name, map(str, map(_name_of, result)))))
            else:
                del result[at]
        elif at is None or name in taken:
            # The second of two with one name is kept apart, for the reader to complain of.
            result.append(item)
        else:
            result[at] = _merge(result[at], item, where, problems, later)
        taken.add(name)
    return result


def _without_remove(item: Entry) -> Entry:
    assert isinstance(item.value, dict)
    return Entry({key: value for key, value in item.value.items() if key != "remove"}, item.file, item.line)


# ---------------------------------------------------------------------------------------------------------------------
# Loading


def names_in(library: Library) -> list[str]:
    """Names of the definitions that a library holds, sorted."""
    names = (item.name for item in library.iterdir())
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def load_table(
    name_or_path: str | Path, library: Library, overrides: Mapping[str, object] | None = None, kind: str = "definition"
) -> "Table":
    """Read a definition and everything that it extends.

    Parameters
    ----------
    name_or_path
        The name of a file in the library (without ``.toml``), or a path that ends in ``.toml``.
    library
        The folder of shipped definitions.
    overrides
        Values that replace those of the file, shaped like it; they merge as if a file extended this one.
    kind
        What the library holds, for messages: "machine".

    Raises
    ------
    InputError
        If a file cannot be used as TOML, or ``extends`` cannot be followed. What the keys hold is not checked yet.
    """
    text = str(name_or_path)
    if text.endswith(".toml"):
        path = Path(name_or_path)
        source = _File(path, text, path.parent)
    else:
        source = _shipped(text, library)
        if not _NAME.fullmatch(text) or not source.place.is_file():
            near = _near(text, names_in(library))
            cure = f"{near} " if near else ""
            cure += f"write the path of a .toml file, or one of {', '.join(names_in(library))}"
            raise InputError(Problem(text, 0, f"there is no shipped {kind} of this name", cure))
    problems: list[Problem] = []
    root = _line_of_ancestors(_read(source), source, library, problems)
    if overrides:
        root = _merge(root, _entry(dict(overrides), "overrides", {}), "", problems)
    return Table(root, "", problems)


def extended(table: "Table", library: Library) -> "Table":
    """Merge a table that stands inside a definition onto what its own ``extends`` names in another library.

    A machine names its control so: ``[control]`` with ``extends = "sinumerik_840d"``. Without ``extends`` the table is
    returned as it is, fresh.
    """
    assert isinstance(table.entry.value, dict)
    extends = table.entry.value.get("extends")
    file = extends.file if isinstance(extends, Entry) else table.entry.file
    folder = Path(file).parent
    problems: list[Problem] = []
    own = Entry(dict(table.entry.value), table.entry.file, table.entry.line)
    source = _File(folder / f"{Path(file).name}", f"{file} [{table.path}]", folder)
    merged = _line_of_ancestors(own, source, library, problems)
    return Table(merged, table.path, problems)


# ---------------------------------------------------------------------------------------------------------------------
# Reading keys


def unit_of(key: str) -> str:
    """Unit that the end of a key names, in words; empty if it names none.

    >>> unit_of("rapid_deg_min")
    'degrees per minute'
    """
    return next((unit for end, unit in UNITS.items() if key.endswith(end)), "")


def _stem(key: str) -> str:
    return next((key.removesuffix(end) for end in UNITS if key.endswith(end)), key)


def _shown(value: object) -> str:
    """Show a value as it could stand in the file, cut short."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        text = '"' + value + '"'
    elif isinstance(value, dict):
        return "a table"
    elif isinstance(value, list):
        text = "an array of tables" if value and isinstance(value[0], Entry) else str(value).replace("'", '"')
    else:
        text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _near(word: str, known: Iterator[str] | Sequence[str]) -> str:
    near = difflib.get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f'did you mean "{near[0]}"?' if near else ""


@dataclass(eq=False)
class Table:
    """A TOML table that keeps account of the keys that were asked for.

    A getter that finds a mistake adds a ``Problem`` to the shared list and returns the default, or an empty value of
    its type, so that reading goes on to the next mistake. ``check`` raises them all.
    """

    entry: Entry
    path: str = ""
    problems: list[Problem] = field(default_factory=list)
    asked: dict[str, None] = field(default_factory=dict)
    below: list["Table"] = field(default_factory=list)

    # Where things stand

    @property
    def file(self) -> str:
        """File of the table, or of its last change."""
        return self.entry.file

    @property
    def line(self) -> int:
        """Line of the table's header in ``file``."""
        return self.entry.line

    def origin(self, key: str) -> tuple[str, int]:
        """File and line of a key; those of the table if the key is not there."""
        entry = self._cells.get(key, self.entry)
        return entry.file, entry.line

    def dotted(self, key: str) -> str:
        """Path of a key from the root of the definition, such as ``axis[1].limits_deg``."""
        return f"{self.path}.{key}" if self.path else key

    def keys(self) -> list[str]:
        """Every key of the table, in order, read or not."""
        return list(self._cells)

    def __contains__(self, key: object) -> bool:
        return key in self._cells

    def raw(self) -> dict[str, object]:
        """Everything the table holds, as plain dicts, lists and scalars. Counts as reading nothing."""
        plain = _plain(self.entry)
        assert isinstance(plain, dict)
        return plain

    def fresh(self) -> "Table":
        """The same table with nothing read yet and no problems noted."""
        return Table(self.entry, self.path)

    def files(self) -> list[str]:
        """Every file that a value of this table came from, sorted."""
        return sorted(set(_files(self.entry)))

    @property
    def _cells(self) -> dict[str, Entry]:
        return self.entry.value if isinstance(self.entry.value, dict) else {}

    # Problems

    def problem(self, key: str, what: str, cure: str = "") -> None:
        """Note that the value of a key will not do; an empty key means the table itself."""
        file, line = self.origin(key)
        name = self.dotted(key) if key else self.path or "definition"
        self.problems.append(Problem(file, line, f"{name} {what}", cure))

    def check(self) -> None:
        """Raise every problem noted so far, in the order of files and lines, if there is one."""
        if self.problems:
            unique = dict.fromkeys(self.problems)
            raise InputError(sorted(unique, key=lambda problem: (problem.file, problem.line)))

    def finish(self) -> None:
        """Note each key that nobody asked for; call it when the table has been read."""
        for key in self._cells:
            if key in self.asked:
                continue
            kin = next((known for known in self.asked if _stem(known) == _stem(key) and unit_of(known)), "")
            if kin and unit_of(key) != unit_of(kin):
                self.problem(key, "has a unit that does not fit here", f"write {kin}, in {unit_of(kin)}")
            else:
                cure = _near(key, list(self.asked)) or "known here: " + ", ".join(sorted(self.asked))
                self.problem(key, "is not a key that is known here", cure)

    def skip(self, *keys: str) -> None:
        """Count keys as read without looking at them."""
        self.asked.update(dict.fromkeys(keys))

    def every_key(self) -> set[str]:
        """Every key that was asked for here and below, with indices left out: ``axis.limits_deg``."""
        found = {re.sub(r"\[\d+\]", "", self.dotted(key)) for key in self.asked}
        return found.union(*(table.every_key() for table in self.below))

    # Getters

    def _get(self, key: str, required: bool, cure: str) -> object | None:
        self.asked[key] = None
        entry = self._cells.get(key)
        if entry is None:
            if required:
                self.problem(key, "is missing", cure)
            return None
        return entry.value

    @overload
    def text(self, key: str, default: Required = ..., *, one_of: Sequence[str] = ...) -> str: ...
    @overload
    def text(self, key: str, default: str, *, one_of: Sequence[str] = ...) -> str: ...
    @overload
    def text(self, key: str, default: None, *, one_of: Sequence[str] = ...) -> str | None: ...
    def text(self, key: str, default: str | Required | None = REQUIRED, *, one_of: Sequence[str] = ()) -> str | None:
        """Return a text; with ``one_of``, one of these words."""
        spare = "" if isinstance(default, Required) else default
        words = ", ".join(f'"{word}"' for word in one_of)
        cure = f"write one of {words}" if one_of else "write a text in quotes"
        value = self._get(key, isinstance(default, Required), cure)
        if value is None:
            return spare
        if not isinstance(value, str) or (one_of and value not in one_of):
            near = _near(value, list(one_of)) if isinstance(value, str) else ""
            self.problem(key, f"is {_shown(value)}", near + " " + cure if near else cure)
            return spare
        return value

    @overload
    def number(
        self,
        key: str,
        default: Required = ...,
        *,
        above: float | None = ...,
        at_least: float | None = ...,
        at_most: float | None = ...,
    ) -> float: ...
    @overload
    def number(
        self,
        key: str,
        default: float,
        *,
        above: float | None = ...,
        at_least: float | None = ...,
        at_most: float | None = ...,
    ) -> float: ...
    @overload
    def number(
        self,
        key: str,
        default: None,
        *,
        above: float | None = ...,
        at_least: float | None = ...,
        at_most: float | None = ...,
    ) -> float | None: ...
    def number(
        self,
        key: str,
        default: float | Required | None = REQUIRED,
        *,
        above: float | None = None,
        at_least: float | None = None,
        at_most: float | None = None,
    ) -> float | None:
        """Return a finite number, in the unit that the key names."""
        spare = 0.0 if isinstance(default, Required) else default
        cure = f"write {_a_number(key)}{_bounds(above, at_least, at_most)}"
        value = self._get(key, isinstance(default, Required), cure)
        if value is None:
            return spare
        number = _finite(value)
        if number is None:
            self.problem(key, f"is {_shown(value)}", cure + _hint(key, value))
            return spare
        if not _within(number, above, at_least, at_most):
            self.problem(key, f"is {_shown(value)}", cure)
            return spare
        return number

    @overload
    def integer(
        self, key: str, default: Required = ..., *, at_least: int | None = ..., at_most: int | None = ...
    ) -> int: ...
    @overload
    def integer(self, key: str, default: int, *, at_least: int | None = ..., at_most: int | None = ...) -> int: ...
    @overload
    def integer(
        self, key: str, default: None, *, at_least: int | None = ..., at_most: int | None = ...
    ) -> int | None: ...
    def integer(
        self,
        key: str,
        default: int | Required | None = REQUIRED,
        *,
        at_least: int | None = None,
        at_most: int | None = None,
    ) -> int | None:
        """Return a whole number."""
        spare = 0 if isinstance(default, Required) else default
        cure = f"write a whole number{_bounds(None, at_least, at_most)}"
        value = self._get(key, isinstance(default, Required), cure)
        if value is None:
            return spare
        if not isinstance(value, int) or isinstance(value, bool) or not _within(value, None, at_least, at_most):
            self.problem(key, f"is {_shown(value)}", cure)
            return spare
        return value

    @overload
    def flag(self, key: str, default: bool | Required = ...) -> bool: ...
    @overload
    def flag(self, key: str, default: None) -> bool | None: ...
    def flag(self, key: str, default: bool | Required | None = REQUIRED) -> bool | None:
        """Return true or false."""
        spare = False if isinstance(default, Required) else default
        value = self._get(key, isinstance(default, Required), "write true or false")
        if value is None:
            return spare
        if not isinstance(value, bool):
            self.problem(key, f"is {_shown(value)}", "write true or false, without quotes")
            return spare
        return value

    @overload
    def vector(self, key: str, n: int, default: Sequence[float] | Required = ...) -> tuple[float, ...]: ...
    @overload
    def vector(self, key: str, n: int, default: None) -> tuple[float, ...] | None: ...
    def vector(
        self, key: str, n: int, default: Sequence[float] | Required | None = REQUIRED
    ) -> tuple[float, ...] | None:
        """Return n finite numbers, in the unit that the key names."""
        spare = (0.0,) * n if isinstance(default, Required) else None if default is None else tuple(default)
        unit = f" in {unit_of(key)}" if unit_of(key) else ""
        cure = f"write [{', '.join('abcdefgh'[:n])}] with {n} numbers{unit}"
        value = self._get(key, isinstance(default, Required), cure)
        if value is None:
            return spare
        numbers = [_finite(item) for item in value] if isinstance(value, list) else []
        good = [number for number in numbers if number is not None]
        if len(numbers) != n or len(good) != n:
            self.problem(key, f"is {_shown(value)}", cure)
            return spare
        return tuple(good)

    @overload
    def interval(self, key: str, default: tuple[float, float] | Required = ...) -> tuple[float, float]: ...
    @overload
    def interval(self, key: str, default: None) -> tuple[float, float] | None: ...
    def interval(
        self, key: str, default: tuple[float, float] | Required | None = REQUIRED
    ) -> tuple[float, float] | None:
        """Return [low, high] with low < high, in the unit that the key names."""
        spare = (-math.inf, math.inf) if isinstance(default, Required) else default
        unit = f", in {unit_of(key)}" if unit_of(key) else ""
        cure = f"write [low, high] with low < high{unit}"
        value = self._get(key, isinstance(default, Required), cure)
        if value is None:
            return spare
        numbers = [_finite(item) for item in value] if isinstance(value, list) else []
        if len(numbers) != 2 or numbers[0] is None or numbers[1] is None:
            self.problem(key, f"is {_shown(value)}", cure)
            return spare
        if numbers[0] >= numbers[1]:
            swapped = f": [{numbers[1]:g}, {numbers[0]:g}]?" if numbers[0] > numbers[1] else ""
            self.problem(key, f"is {_shown(value)}", cure + swapped)
            return spare
        return numbers[0], numbers[1]

    @overload
    def texts(self, key: str, default: Sequence[str] | Required = ...) -> tuple[str, ...]: ...
    @overload
    def texts(self, key: str, default: None) -> tuple[str, ...] | None: ...
    def texts(self, key: str, default: Sequence[str] | Required | None = REQUIRED) -> tuple[str, ...] | None:
        """Return a list of texts."""
        spare = () if isinstance(default, Required) else None if default is None else tuple(default)
        cure = 'write ["one", "two"]'
        value = self._get(key, isinstance(default, Required), cure)
        if value is None:
            return spare
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            self.problem(key, f"is {_shown(value)}", cure)
            return spare
        return tuple(str(item) for item in value)

    def table(self, key: str, *, required: bool = False) -> "Table":
        """Return the table under a key; an empty one if there is none."""
        value = self._get(key, required, f"write a table [{self.dotted(key)}]")
        if isinstance(value, dict):
            child = Table(self._cells[key], self.dotted(key), self.problems)
        else:
            if value is not None:
                self.problem(key, f"is {_shown(value)}", f"write a table [{self.dotted(key)}]")
            child = Table(Entry({}, self.file, self.line), self.dotted(key), self.problems)
        self.below.append(child)
        return child

    def tables(self, key: str, *, required: bool = False) -> "list[Table]":
        """Return the array of tables under a key; an empty list if there is none."""
        value = self._get(key, required, f"write tables [[{self.dotted(key)}]]")
        if value is None or value == []:
            return []
        if not isinstance(value, list) or not isinstance(value[0], Entry):
            self.problem(key, f"is {_shown(value)}", f"write tables [[{self.dotted(key)}]]")
            return []
        children = [Table(item, f"{self.dotted(key)}[{i}]", self.problems) for i, item in enumerate(value)]
        self.below.extend(children)
        return children


def _plain(entry: Entry) -> object:
    if isinstance(entry.value, dict):
        return {key: _plain(item) for key, item in entry.value.items()}
    if isinstance(entry.value, list):
        return [_plain(item) if isinstance(item, Entry) else item for item in entry.value]
    return entry.value


def _files(entry: Entry) -> Iterator[str]:
    yield entry.file
    if isinstance(entry.value, dict):
        for item in entry.value.values():
            yield from _files(item)
    elif isinstance(entry.value, list):
        for item in entry.value:
            if isinstance(item, Entry):
                yield from _files(item)


def _finite(value: object) -> float | None:
    """Return the number that a TOML value is, or None; true and false are no numbers here."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def _within(number: float, above: float | None, at_least: float | None, at_most: float | None) -> bool:
    return (
        (above is None or number > above)
        and (at_least is None or number >= at_least)
        and (at_most is None or number <= at_most)
    )


def _a_number(key: str) -> str:
    unit = unit_of(key)
    return f"a number in {unit}" if unit else "a number"


def _bounds(above: float | None, at_least: float | None, at_most: float | None) -> str:
    parts = [
        f"above {above:g}" if above is not None else "",
        f"of at least {at_least:g}" if at_least is not None else "",
        f"of at most {at_most:g}" if at_most is not None else "",
    ]
    text = " and ".join(part for part in parts if part)
    return f" {text}" if text else ""


def _hint(key: str, value: object) -> str:
    """Say what a number in quotes would look like without them."""
    found = _NUMBER.match(value.strip()) if isinstance(value, str) else None
    return f", without quotes and unit: {key} = {found.group()}" if found else ""
