"""Definition files: read one, and merge it onto what it extends."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from pathlib import Path, PurePosixPath
from typing import Final, TypeAlias

from trunnion.definitions.source_lines import LocatedValue, key_lines, locate_values
from trunnion.definitions.table import Table, as_written, did_you_mean
from trunnion.errors import InputError, Problem

#: Larger files are refused unread: real definitions have a few kilobytes.
MAX_FILE_BYTES: Final = 1_000_000

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")

Library: TypeAlias = Traversable | Path


@dataclass(frozen=True, slots=True)
class _DefinitionFile:
    """A definition file: where to read it, how to call it, and the folder that its ``extends`` may reach."""

    location: Library
    label: str
    folder: Path | None


def _shipped(name: str, library: Library) -> _DefinitionFile:
    location = library.joinpath(f"{name}.toml")
    return _DefinitionFile(location, str(location), None)


def _read(source: _DefinitionFile) -> LocatedValue:
    """Read and parse one file; what it extends is not looked at."""
    label = source.label
    try:
        if not source.location.is_file():
            raise InputError(Problem(label, 0, "there is no such file", "check the name"))
        with source.location.open("rb") as stream:
            data = stream.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise InputError(Problem(label, 0, f"cannot be read: {error.strerror or error}")) from None
    if len(data) > MAX_FILE_BYTES:
        raise InputError(Problem(label, 0, f"has more than {MAX_FILE_BYTES} bytes", "a definition is a small file"))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(Problem(label, line, "is not UTF-8 text", "save the file as UTF-8")) from None
    try:
        lines = key_lines(text)
        raw = tomllib.loads(text)
        return locate_values(raw, label, lines, (), 1)
    except RecursionError:
        raise InputError(Problem(label, 0, "nests too deeply", "a definition needs three levels")) from None
    except ValueError as error:  # TOMLDecodeError is one; so is a number with thousands of digits
        raise InputError(_syntax_problem(label, text, str(error))) from None


def _syntax_problem(label: str, text: str, message: str) -> Problem:
    what, _, location = message.partition(" (at ")
    number = re.search(r"line (\d+)", location)
    at_end = text.count("\n") + 1 if "end of document" in location else 0
    line = int(number.group(1)) if number else at_end
    return Problem(label, line, f"is not TOML: {what[:1].lower()}{what[1:]}", "mend the line, or the one before it")


def _parent(extends: LocatedValue, child: _DefinitionFile, library: Library) -> _DefinitionFile:
    """Find the file that ``extends`` names; the child may reach the library and its own folder, nothing else."""
    file, line, name = extends.file, extends.line, extends.value
    if not isinstance(name, str):
        cure = 'write one name, such as extends = "generic_head_table_bc"'
        raise InputError(Problem(file, line, f"extends is {as_written(name)}", cure))
    if _NAME.fullmatch(name):
        found = _shipped(name, library)
        if not found.location.is_file():
            cure = did_you_mean(name, definition_names(library)) or "write one of " + ", ".join(
                definition_names(library)
            )
            raise InputError(Problem(file, line, f'extends: nothing shipped is called "{name}"', cure))
        return found
    reach = "write the name of a shipped definition, or a path to a .toml file in the same folder or below it"
    pure = PurePosixPath(name)
    outside = pure.is_absolute() or ".." in pure.parts or re.search(r"[\\:\x00-\x1f]", name)
    if outside or pure.suffix != ".toml" or child.folder is None:
        raise InputError(Problem(file, line, f'extends: "{name}" is not a file that a definition may read', reach))
    location = child.folder / pure
    # A link may lead out of the folder although its name does not.
    if not location.resolve().is_relative_to(child.folder.resolve()):
        raise InputError(Problem(file, line, f'extends: "{name}" leads out of the folder of the definition', reach))
    if not location.is_file():
        raise InputError(Problem(file, line, f'extends: there is no file "{name}" beside the definition', reach))
    return _DefinitionFile(location, str(location), location.parent)


def _identity(source: _DefinitionFile) -> str:
    return str(source.location.resolve()) if isinstance(source.location, Path) else source.label


def _merge_ancestors(
    root: LocatedValue, source: _DefinitionFile, library: Library, problems: list[Problem]
) -> LocatedValue:
    """Merge a table onto everything that it extends, directly and through others."""
    tables = [root]
    seen = [_identity(source)]
    labels = [_file_name(source.label)]
    while True:
        table = tables[-1]
        assert isinstance(table.value, dict)
        extends = table.value.pop("extends", None)
        if extends is None:
            break
        # Where the word stands decides what it may reach, which matters for a table that was itself inherited.
        source = _parent(extends, source, library)
        labels.append(_file_name(source.label))
        if _identity(source) in seen:
            what = "extends goes in a circle: " + " extends ".join(labels)
            raise InputError(Problem(extends.file, extends.line, what, "take one extends out"))
        seen.append(_identity(source))
        tables.append(_read(source))
    merged = tables.pop()
    while tables:
        merged = _merge(merged, tables.pop(), "", problems)
    return merged


def _file_name(label: str) -> str:
    return PurePosixPath(label.replace("\\", "/")).name


def _merge(
    parent: LocatedValue, child: LocatedValue, path: str, problems: list[Problem], keep_removals: bool = False
) -> LocatedValue:
    """Return the parent with what the child says instead; tables merge deeply, named tables by name.

    ``keep_removals``: the table extends something that is not looked at yet (see ``extended``), so that removals must
    stay.
    """
    if isinstance(parent.value, dict) and isinstance(child.value, dict):
        table = dict(parent.value)
        keep_removals = keep_removals or "extends" in parent.value or "extends" in child.value
        for key, content in child.value.items():
            below = f"{path}.{key}" if path else key
            table[key] = _merge(table[key], content, below, problems, keep_removals) if key in table else content
        return LocatedValue(table, child.file, child.line)
    if _are_named(parent) and _holds_tables(child):
        return LocatedValue(_merge_by_name(parent, child, path, problems, keep_removals), child.file, child.line)
    return child


def _holds_tables(content: LocatedValue) -> bool:
    return isinstance(content.value, list) and bool(content.value) and isinstance(content.value[0], LocatedValue)


def _are_named(content: LocatedValue) -> bool:
    return _holds_tables(content) and all(_name_of(item) is not None for item in _items(content))


def _items(content: LocatedValue) -> list[LocatedValue]:
    return content.value if isinstance(content.value, list) else []


def _name_of(item: LocatedValue) -> str | None:
    name = item.value.get("name") if isinstance(item.value, dict) else None
    return name.value if isinstance(name, LocatedValue) and isinstance(name.value, str) else None


def _merge_by_name(
    parent: LocatedValue, child: LocatedValue, path: str, problems: list[Problem], keep_removals: bool
) -> list[LocatedValue]:
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
        item = item if keep_removals else _without_remove(item)
        at = next((k for k, old in enumerate(result) if _name_of(old) == name), None)
        if remove is not None and not isinstance(remove.value, bool):
            problems.append(
                Problem(remove.file, remove.line, f"{where}.remove is {as_written(remove.value)}", "write true")
            )
        elif remove is not None and remove.value:
            if keep_removals:
                result = [old for old in result if _name_of(old) != name] + [item]
            elif at is None:
                what = f'{where}: there is no {path} called "{name}" to remove'
                problems.append(
                    Problem(remove.file, remove.line, what, did_you_mean(name, map(str, map(_name_of, result))))
                )
            else:
                del result[at]
        elif at is None or name in taken:
            # The second of two with one name is kept apart, for the reader to complain of.
            result.append(item)
        else:
            result[at] = _merge(result[at], item, where, problems, keep_removals)
        taken.add(name)
    return result


def _without_remove(item: LocatedValue) -> LocatedValue:
    assert isinstance(item.value, dict)
    return LocatedValue({key: value for key, value in item.value.items() if key != "remove"}, item.file, item.line)


def definition_names(library: Library) -> list[str]:
    """Names of the definitions that a library holds, sorted."""
    names = (item.name for item in library.iterdir())
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def load_table(
    name_or_path: str | Path, library: Library, overrides: Mapping[str, object] | None = None, kind: str = "definition"
) -> Table:
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
        source = _DefinitionFile(path, text, path.parent)
    else:
        source = _shipped(text, library)
        if not _NAME.fullmatch(text) or not source.location.is_file():
            near = did_you_mean(text, definition_names(library))
            cure = f"{near} " if near else ""
            cure += f"write the path of a .toml file, or one of {', '.join(definition_names(library))}"
            raise InputError(Problem(text, 0, f"there is no shipped {kind} of this name", cure))
    problems: list[Problem] = []
    root = _merge_ancestors(_read(source), source, library, problems)
    if overrides:
        root = _merge(root, locate_values(dict(overrides), "overrides", {}), "", problems)
    return Table(root, "", problems)


def resolve_extends(table: Table, library: Library) -> Table:
    """Merge a table that stands inside a definition onto what its own ``extends`` names in another library.

    A machine names its control so: ``[control]`` with ``extends = "sinumerik_840d"``. Without ``extends`` the table is
    returned as it is, fresh.
    """
    assert isinstance(table.content.value, dict)
    extends = table.content.value.get("extends")
    file = extends.file if isinstance(extends, LocatedValue) else table.content.file
    folder = Path(file).parent
    problems: list[Problem] = []
    own = LocatedValue(dict(table.content.value), table.content.file, table.content.line)
    source = _DefinitionFile(folder / f"{Path(file).name}", f"{file} [{table.path}]", folder)
    merged = _merge_ancestors(own, source, library, problems)
    return Table(merged, table.path, problems)
