"""The text of a definition, changed at one place, with all else as it was: comments, order and blanks.

In:     TOML, the path of a value, a new value.
Out:    TOML.

Style-preserving TOML libraries hang a comment on the table before it, so that it wanders or vanishes when that table
grows or goes; here the text itself is changed, at the places that the scanner of definitions knows, and the result is
compared with what was meant.
"""

import copy
import tomllib
from itertools import pairwise
from typing import Any, TypeAlias

from trunnion.definitions import KeyPath, Layout, layout
from trunnion.definitions.toml_text import written, written_key

#: Keys from the root of a definition; a tuple of one text is the name of a table in an array:
#: ``("axis", ("B",), "home_deg")``.
FieldPath: TypeAlias = tuple[str | tuple[str], ...]

#: What a field can hold.
Value: TypeAlias = str | bool | int | float | list[float]


class UnclearPlaceError(ValueError):
    """The text says something in a way in which this change has no place: only the user can make it."""


def with_value(text: str, path: FieldPath, value: Value) -> str:
    """Return a definition in which a value is set; tables on the way to it are made.

    Raises ``UnclearPlaceError`` if there is no plain place for it.
    """
    found, content = layout(text), tomllib.loads(text)
    where = located(content, path)
    if where is not None and where in found.values:
        made = _with_replaced(text, found, where, value, _at(content, where))
    else:
        made = _with_new_value(text, found, path, value)
    return _checked(made, text, _meant(content, path, value))


def without_value(text: str, path: FieldPath) -> str:
    """Return a definition without a value; a named table of which only the name is left goes with it.

    Comments behind the value stay, as lines of their own.

    Raises ``UnclearPlaceError`` if it cannot be taken out plainly.
    """
    found, content = layout(text), tomllib.loads(text)
    where = located(content, path)
    if where is None:
        return text
    if where not in found.values:
        raise UnclearPlaceError
    place = found.values[where]
    begin, end = _line_start(text, place.key), _line_end(text, place.end)
    indent = text[begin : place.key]
    if indent.strip():
        raise UnclearPlaceError  # within an inline table
    kept = "".join(f"{indent}{text[a:b]}\n" for a, b in found.comments if begin <= a < end)
    if kept and text[end:].lstrip(" \t").startswith("["):
        kept += "\n"  # or they would be those of the next table
    after = text[end:].removeprefix("\n") if begin == 0 and not kept else text[end:]
    return _without_empty_table(_checked(text[:begin] + kept + after, text, _meant(content, path, None)), path)


def with_table_moved(text: str, array: str, name: str, by: int) -> str:
    """Return a definition in which one table of an array changes places with the one before or after it.

    by   -1 or 1; at the end of the array nothing changes

    Raises ``UnclearPlaceError`` if the tables are not written as ``[[...]]``, each with all that belongs to it.
    """
    whole = text if text.endswith("\n") else text + "\n"
    found, content = layout(whole), tomllib.loads(whole)
    items = content.get(array)
    names = [item.get("name") if isinstance(item, dict) else None for item in items] if isinstance(items, list) else []
    if name not in names or not 0 <= names.index(name) + by < len(names):
        return text
    first, second = sorted((names.index(name), names.index(name) + by))
    blocks = (_block(whole, found, (array, k)) for k in (first, second))
    (a, b), (c, d) = ((begin, _end_of_lines(whole, begin, end)) for begin, end in blocks)
    made = whole[:a] + whole[c:d] + whole[b:c] + whole[a:b] + whole[d:]
    content[array][first], content[array][second] = content[array][second], content[array][first]
    return _checked(made[: len(text)], text, content)


def same(one: Any, other: Any) -> bool:
    """Return whether two TOML values say the same: 1 and 1.0 do, 1 and true do not, nan is nan."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, bool) != isinstance(other, bool):
        return False
    return bool(one == other) or (one != one and other != other)


def _with_replaced(text: str, found: Layout, where: KeyPath, value: Value, old: object) -> str:
    """Return the text with another value at a place; of a list as long as before, only the items that differ are
    written.
    """
    places = [(found.values[where], value)]
    if isinstance(value, list) and isinstance(old, list) and len(value) == len(old):
        places = [(found.values[*where, k], value[k]) for k in range(len(value)) if not same(value[k], old[k])]
    for place, item in reversed(places):
        text = text[: place.start] + written(item) + text[place.end :]
    return text


def _with_new_value(text: str, found: Layout, path: FieldPath, value: Value) -> str:
    """Return the text with a line for a value that it does not have."""
    key, line = path[-1], f"{written_key(path[-1])} = {written(value)}\n"
    assert isinstance(key, str)
    if len(path) == 1:
        at = _end_of_lines(text, 0, _begin(text, found, 0) if found.headers else len(text))
        return _joined(text[:at], line, text[at:])
    table = located(tomllib.loads(text), path[:-1])
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
    """Return the text with a table for a line: behind its like, or at the end."""
    head, name = path[:-1], ""
    if isinstance(head[-1], tuple):
        head, name = head[:-1], head[-1][0]
    if any(isinstance(step, tuple) for step in head):
        raise UnclearPlaceError
    dotted = ".".join(written_key(step) for step in head)
    lines = f"[[{dotted}]]\nname = {written(name)}\n{line}" if name else f"[{dotted}]\n{line}"
    alike = [header for _, header in found.headers if _plain(header)[: len(head)] == head] or [
        header for _, header in found.headers if header[0] == head[0]
    ]
    at = _end_of_lines(text, *_block(text, found, alike[-1])) if alike else len(text)
    before = _joined(text[:at], "", "")
    return before + ("\n" if before else "") + lines + text[at:]


def _without_empty_table(text: str, path: FieldPath) -> str:
    """Return the text without the table of a path if it has nothing left but its name."""
    content = tomllib.loads(text)
    where = located(content, path[:-1])
    table = _at(content, where or ())
    if not where or not isinstance(table, dict) or set(table) - ({"name"} if isinstance(where[-1], int) else set()):
        return text
    found = layout(text)
    if not any(header == where for _, header in found.headers):
        return text
    end = _end_of_lines(text, *_block(text, found, where))
    begin = _line_start(text, next(at for at, header in found.headers if header == where))
    if any(begin <= at < end for at, _ in found.comments):
        return text  # a comment of the user's stands in it
    before, after = text[:begin], text[end:]
    made = before[: -1 if before.endswith("\n\n") else None] + after if before.strip() else after.lstrip("\n")
    table.clear()
    return made if same(_filled(tomllib.loads(made)), _filled(content)) else text


def located(content: Any, path: FieldPath) -> KeyPath | None:
    """Return the path with indices for names; None if the definition has no such value."""
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


def _at(content: Any, where: KeyPath) -> object:
    """Return the value at a path with indices."""
    for step in where:
        content = content[step]
    found: object = content
    return found


def _plain(path: KeyPath) -> KeyPath:
    """Return a path without indices."""
    return tuple(step for step in path if isinstance(step, str))


def _block(text: str, found: Layout, table: KeyPath, *, within: bool = True) -> tuple[int, int]:
    """Begin and end of a table in the text, with the comments that belong to it, and the tables ``within`` it."""
    at = next((k for k, (_, header) in enumerate(found.headers) if header == table), None)
    if at is None:
        raise UnclearPlaceError  # it has no header
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
    while at < header and not text[at : _line_end(text, at)].strip():
        at = _line_end(text, at)
    return at


def _end_of_lines(text: str, begin: int, end: int) -> int:
    """Where the last line of a part of the text ends that is not blank; the part ends with a line."""
    full = len(text[begin:end].rstrip())
    return min(_line_end(text, begin + full), end) if full else begin


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    end = text.find("\n", at)
    return len(text) if end < 0 else end + 1


def _joined(before: str, line: str, after: str) -> str:
    before += "\n" if before and not before.endswith("\n") else ""
    blank = "\n" if not before and after.lstrip().startswith("[") else ""
    return before + line + blank + after


def _checked(made: str, text: str, meant: dict[str, Any]) -> str:
    """Return the changed text, if it says what was meant and nothing else, with every comment of the text before."""
    try:
        found = tomllib.loads(made)
    except ValueError:
        raise UnclearPlaceError from None
    if not same(found, meant) or _comments(made) != _comments(text):
        raise UnclearPlaceError
    return made


def _comments(text: str) -> list[str]:
    return sorted(text[begin:end] for begin, end in layout(text).comments)


def _filled(content: Any) -> Any:
    """Return a value without the tables and arrays in it that hold nothing."""
    if isinstance(content, dict):
        parts = {key: _filled(item) for key, item in content.items()}
        return {key: item for key, item in parts.items() if item not in ({}, [])}
    if isinstance(content, list):
        return [item for item in map(_filled, content) if item not in ({}, [])]
    return content


def _meant(content: dict[str, Any], path: FieldPath, value: Value | None) -> dict[str, Any]:
    """Return what a definition says with one value changed, or, by None, taken out."""
    root = copy.deepcopy(content)
    table: Any = root
    for step, then in pairwise(path):
        if isinstance(step, tuple):
            table = _named(table, step[0])
        elif isinstance(table, dict):
            table = table.setdefault(step, [] if isinstance(then, tuple) else {})
    if not isinstance(table, dict):
        raise UnclearPlaceError
    if value is None:
        table.pop(path[-1])
    else:
        table[path[-1]] = value
    return root


def _named(tables: Any, name: str) -> dict[str, Any]:
    """Return the table of this name, which is added if there is none."""
    if not isinstance(tables, list):
        raise UnclearPlaceError
    found = next((item for item in tables if isinstance(item, dict) and item.get("name") == name), None)
    if found is None:
        found = {"name": name}
        tables.append(found)
    return found
