"""The text of a definition, changed at one place, with all else as it was: comments, order and blanks.

In:     TOML, the path of a value, a new value.
Out:    TOML.

Style-preserving TOML libraries hang a comment on the table before it, so that it wanders or vanishes when that table
grows or goes; here the text itself is changed, at the places that the scanner of definitions knows, and the result is
compared with what was meant.
"""

import copy
import json
import re
import tomllib
from typing import Any, Final, TypeAlias

from trunnion.definitions import KeyPath, Layout, layout

#: Keys from the root of a definition; a tuple of one text is the name of a table in an array:
#: ``("axis", ("B",), "home_deg")``.
FieldPath: TypeAlias = tuple[str | tuple[str], ...]

#: What a field can hold.
Value: TypeAlias = str | bool | int | float | list[float]

_BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]+")

#: Of a text of several lines: what cannot stand in it as it is.
_ESCAPES: Final = re.compile(r'[\\\x00-\x08\x0b-\x1f\x7f]|"""')


class UnclearPlaceError(ValueError):
    """The text says something in a way in which this change has no place: only the user can make it."""


def with_value(text: str, path: FieldPath, value: Value) -> str:
    """Return a definition in which a value is set; tables on the way to it are made.

    Raises
    ------
    UnclearPlaceError
        If there is no plain place for it.
    """
    found = layout(text)
    where = _located(tomllib.loads(text), path)
    if where is not None and where in found.values:
        place = found.values[where]
        made = text[: place.start] + _written(value) + text[place.end :]
    else:
        made = _with_new_value(text, found, path, value)
    return _checked(made, text, path, value)


def without_value(text: str, path: FieldPath) -> str:
    """Return a definition without a value; a named table of which only the name is left goes with it.

    Raises
    ------
    UnclearPlaceError
        If it cannot be taken out plainly.
    """
    found = layout(text)
    where = _located(tomllib.loads(text), path)
    if where is None:
        return text
    if where not in found.values:
        raise UnclearPlaceError
    place = found.values[where]
    begin, end = _line_start(text, place.key), _line_end(text, place.end)
    if text[begin : place.key].strip():
        raise UnclearPlaceError  # within an inline table
    return _without_empty_table(_checked(text[:begin] + text[end:], text, path, None), path)


def with_table_moved(text: str, array: str, name: str, by: int) -> str:
    """Return a definition in which one table of an array changes places with the one before or after it.

    by   -1 or 1; at the end of the array nothing changes
    """
    found = layout(text)
    names = [item.get("name") for item in tomllib.loads(text).get(array, [])]
    if name not in names or not 0 <= names.index(name) + by < len(names):
        return text
    first, second = sorted((names.index(name), names.index(name) + by))
    blocks = (_block(text, found, (array, k)) for k in (first, second))
    (a, b), (c, d) = ((begin, _end_of_lines(text, begin, end)) for begin, end in blocks)
    return text[:a] + text[c:d] + text[b:c] + text[a:b] + text[d:]


def _with_new_value(text: str, found: Layout, path: FieldPath, value: Value) -> str:
    """The text with a line for a value that it does not have."""
    key, line = path[-1], f"{_key(path[-1])} = {_written(value)}\n"
    assert isinstance(key, str)
    if len(path) == 1:
        at = _end_of_lines(text, 0, _begin(text, found, 0) if found.headers else len(text))
        return _joined(text[:at], line, text[at:])
    table = _located(tomllib.loads(text), path[:-1])
    if table is not None and any(header == table for _, header in found.headers):
        at = _end_of_lines(text, *_block(text, found, table, within=False))
        return _joined(text[:at], line, text[at:])
    if table is not None and table in found.values:
        place = found.values[table]
        inside = text[place.start + 1 : place.end - 1].strip()
        if text[place.start] != "{":
            raise UnclearPlaceError
        entry = f"{inside}, {line.strip()}" if inside else line.strip()
        return text[: place.start] + "{ " + entry + " }" + text[place.end :]
    return _with_new_table(text, found, path, line)


def _with_new_table(text: str, found: Layout, path: FieldPath, line: str) -> str:
    """The text with a table for a line: behind its like, or at the end."""
    head, name = path[:-1], ""
    if isinstance(head[-1], tuple):
        head, name = head[:-1], head[-1][0]
    if any(isinstance(step, tuple) for step in head):
        raise UnclearPlaceError
    dotted = ".".join(_key(step) for step in head)
    lines = f"[[{dotted}]]\nname = {_written(name)}\n{line}" if name else f"[{dotted}]\n{line}"
    alike = [header for _, header in found.headers if _plain(header)[: len(head)] == head] or [
        header for _, header in found.headers if header[0] == head[0]
    ]
    at = _end_of_lines(text, *_block(text, found, alike[-1])) if alike else len(text)
    before = text[:at].rstrip("\n")
    after = text[at:].lstrip("\n")
    return (before + "\n\n" if before else "") + lines + ("\n" + after if after else "")


def _without_empty_table(text: str, path: FieldPath) -> str:
    """The text without the table of a path if it has nothing left but its name."""
    content: Any = tomllib.loads(text)
    where = _located(content, path[:-1])
    for step in where or ():
        content = content[step]
    if not where or not isinstance(content, dict) or set(content) - ({"name"} if isinstance(where[-1], int) else set()):
        return text
    found = layout(text)
    if not any(header == where for _, header in found.headers):
        return text
    end = _end_of_lines(text, *_block(text, found, where))
    begin = _line_start(text, next(at for at, header in found.headers if header == where))
    if "#" in text[begin:end]:
        return text  # a comment of the user's stands in it
    before, after = text[:begin].rstrip("\n"), text[end:].lstrip("\n")
    return before + ("\n\n" if before and after else "\n" if before else "") + after


def _located(content: Any, path: FieldPath) -> KeyPath | None:
    """The path with indices for names; None if the definition has no such value."""
    where: KeyPath = ()
    for step in path:
        if isinstance(step, tuple):
            items = content if isinstance(content, list) else []
            key: str | int | None = next(
                (k for k, item in enumerate(items) if isinstance(item, dict) and item.get("name") == step[0]), None
            )
        else:
            key = step if isinstance(content, dict) and step in content else None
        if key is None:
            return None
        content, where = content[key], (*where, key)
    return where


def _plain(path: KeyPath) -> KeyPath:
    """A path without indices."""
    return tuple(step for step in path if isinstance(step, str))


def _block(text: str, found: Layout, table: KeyPath, *, within: bool = True) -> tuple[int, int]:
    """Begin and end of a table in the text, with the comments that belong to it, and the tables ``within`` it."""
    at = next(k for k, (_, header) in enumerate(found.headers) if header == table)
    later = (k for k in range(at + 1, len(found.headers)) if not within or found.headers[k][1][: len(table)] != table)
    following = next(later, None)
    return _begin(text, found, at), len(text) if following is None else _begin(text, found, following)


def _begin(text: str, found: Layout, number: int) -> int:
    """Where the comments begin that belong to a header: all above it down to the first blank line after a value."""
    header = _line_start(text, found.headers[number][0])
    before = [place.end for place in found.values.values() if place.end <= header]
    before += [at for at, _ in found.headers[:number]]
    after_value = _line_end(text, max(before)) if before else 0
    at = after_value
    while at < header and text[at : _line_end(text, at)].strip():
        at = _line_end(text, at)
    if at >= header:
        at = after_value  # no blank line: they stand right above the header
    return at + len(text[at:header]) - len(text[at:header].lstrip())


def _end_of_lines(text: str, begin: int, end: int) -> int:
    """Where the last line of a part of the text ends that is not blank."""
    return begin + len(text[begin:end].rstrip()) + 1 if text[begin:end].strip() else begin


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    end = text.find("\n", at)
    return len(text) if end < 0 else end + 1


def _joined(before: str, line: str, after: str) -> str:
    before += "\n" if before and not before.endswith("\n") else ""
    blank = "\n" if not before and after.lstrip().startswith("[") else ""
    return before + line + blank + after


def _key(step: object) -> str:
    text = str(step)
    return text if _BARE_KEY.fullmatch(text) else _quoted(text)


def _written(value: Value) -> str:
    """A value as TOML; a number without a point where it is whole."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    if isinstance(value, str):
        return _lines(value) if "\n" in value else _quoted(value)
    return str(value)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _lines(text: str) -> str:
    def escape(match: re.Match[str]) -> str:
        found = match.group()
        return '""\\"' if found == '"""' else "\\\\" if found == "\\" else f"\\u{ord(found):04x}"

    escaped = _ESCAPES.sub(escape, text)
    return f'"""\n{escaped}"""' if not escaped.endswith('"') else f'"""\n{escaped[:-1]}\\""""'


def _checked(made: str, text: str, path: FieldPath, value: Value | None) -> str:
    """The changed text, if it says what was meant and nothing else."""
    try:
        found = tomllib.loads(made)
    except ValueError:
        raise UnclearPlaceError from None
    if found != _meant(tomllib.loads(text), path, value):
        raise UnclearPlaceError
    return made


def _meant(content: dict[str, Any], path: FieldPath, value: Value | None) -> dict[str, Any]:
    """What a definition says with one value changed, or, by None, taken out."""
    root = copy.deepcopy(content)
    table: Any = root
    for step, then in zip(path, (*path[1:], ""), strict=True):
        if then == "":
            break
        if isinstance(step, tuple):
            named = next((item for item in table if item.get("name") == step[0]), None)
            if named is None:
                named = {"name": step[0]}
                table.append(named)
            table = named
        else:
            table = table.setdefault(step, [] if isinstance(then, tuple) else {})
    if not isinstance(table, dict):
        raise UnclearPlaceError
    if value is None:
        table.pop(path[-1])
    else:
        table[path[-1]] = value
    return root
