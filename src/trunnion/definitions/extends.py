"""Definition files: each is read, and merged onto the one that it extends."""

import io
import re
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from importlib.resources.abc import Traversable
from pathlib import Path, PurePosixPath
from typing import Final, TypeAlias

from trunnion.definitions.merging import merge
from trunnion.definitions.messages import as_written, meant_word
from trunnion.definitions.source_lines import KeyPath, LocatedValue, layout, locate_values, texts_below
from trunnion.definitions.table import Table
from trunnion.definitions.toml_faults import toml_fault
from trunnion.encoding import EncodingDetector
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: Larger files are refused unread; real definitions have a few kilobytes.
MAX_FILE_BYTES: Final = 1_000_000

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")

#: How messages begin about what a file has twice.
_TWICE = ("Cannot overwrite a value", "Cannot declare")

#: Python writes no whole number of many more in decimal digits.
_MAX_BITS: Final = 10_000

#: Longer names are no file's.
_MAX_NAME: Final = 1000

Library: TypeAlias = Traversable | Path


@dataclass(frozen=True, slots=True)
class _Draft:
    """A definition that is in no file yet."""

    data: bytes

    def open(self, _mode: str) -> io.BytesIO:
        """Return the text, as a file would give it."""
        return io.BytesIO(self.data)

    def is_file(self) -> bool:
        """Return whether it can be read."""
        return True


@dataclass(frozen=True, slots=True, eq=False)
class _DefinitionFile:
    """A definition file: its location, its name in messages, and the folder that its ``extends`` may reach."""

    location: Library | _Draft
    label: str
    folder: Path | None


def _shipped(name: str, library: Library) -> _DefinitionFile:
    location = library.joinpath(f"{name}.toml")
    return _DefinitionFile(location, str(location), None)


#: What is read -> how messages call it, without and with an article.
_KINDS: Final = {
    "machine": ("kind_machine", "file_of_machine_definition"),
    "control": ("kind_control", "file_of_control_definition"),
    "impeller": ("kind_impeller", "file_of_impeller_definition"),
    "project": ("kind_project", "file_of_project"),
    "list of nodes": ("kind_list_of_nodes", "file_of_nodes"),
    "tool library": ("kind_tool_library", "file_of_tools"),
    "file of jobs": ("kind_file_of_jobs", "file_of_jobs"),
    "definition": ("kind_definition", "file_of_definition"),
}


def _named(kind: str) -> Wording:
    """Return a kind of definition as messages name it."""
    return phrase(_KINDS[kind][0])


def _with_article(kind: str) -> Wording:
    """Return a kind of definition as messages name one."""
    return phrase(_KINDS[kind][1])


def _read(source: _DefinitionFile, kind: str = "machine") -> LocatedValue:
    """Read and parse one file, without following its ``extends``."""
    label = source.label
    try:
        unusable = unusable_file(source.location, _with_article(kind)) if isinstance(source.location, Path) else None
        if unusable:
            raise InputError(replace(unusable, file=label))
        with source.location.open("rb") as stream:
            data = stream.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise InputError(
            Problem(label, 0, Wording("DEF120", "cannot_read", strerror=error.strerror or error))
        ) from None
    if len(data) > MAX_FILE_BYTES:
        raise InputError(Problem(label, 0, Wording("DEF120", "more_bytes", max_file_bytes=MAX_FILE_BYTES)))
    root = _parse(label, data)
    assert isinstance(root.value, dict)
    return LocatedValue(dict(root.value), root.file, root.line)  # its ``extends`` will be taken out


def _text(label: str, data: bytes) -> str:
    """Return the bytes of a file as text: UTF-8, or GBK where all of it reads as Chinese."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        detector = EncodingDetector()
        detector.add(data)
        with suppress(UnicodeDecodeError):
            if detector.encoding() == "gb18030":
                return data.decode("gb18030")
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(Problem(label, line, Wording("DEF120", "not_utf_8"))) from None


@lru_cache(maxsize=32)
def _parse(label: str, data: bytes) -> LocatedValue:
    """Return the values of a file: a post needs those of its control four times."""
    text = _text(label, data)
    try:
        found = layout(text)
        raw = tomllib.loads(text)
        _check_whole_numbers(raw, label, found.lines)
        return locate_values(raw, label, found.lines, (), 1, texts_below(text, found))
    except RecursionError:
        raise InputError(Problem(label, 0, Wording("DEF120", "nests_too_deeply"))) from None
    except ValueError as error:  # TOMLDecodeError is one; so is a number with thousands of digits
        raise InputError(_syntax_problem(label, text, str(error))) from None


def _check_whole_numbers(value: object, label: str, lines: Mapping[KeyPath, int], path: KeyPath = ()) -> None:
    """Raise ``InputError`` for a whole number that no message could show; decimal ones the parser refuses itself."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inner:
        _check_whole_numbers(item, label, lines, (*path, key))
    if isinstance(value, int) and value.bit_length() > _MAX_BITS:
        raise InputError(Problem(label, lines.get(path, 0), Wording("DEF120", "whole_number_more", max_bits=_MAX_BITS)))


def _syntax_problem(label: str, text: str, message: str) -> Problem:
    what, _, location = message.partition(" (at ")
    number = re.search(r"line (\d+)", location)
    at_end = text.count("\n") + 1 if "end of document" in location else 0
    line = int(number.group(1)) if number else at_end
    if number and what.startswith(_TWICE):
        key = text.split("\n")[line - 1].partition("=")[0].strip()
        return Problem(label, line, Wording("DEF130", "not_toml_already", key=key))
    fault = toml_fault(text, line, what)
    return Problem(label, fault.line, fault.wording)


def _parent(extends: LocatedValue, child: _DefinitionFile, library: Library) -> _DefinitionFile:
    """Return the file that ``extends`` names; the child may reach the library and its own folder, nothing else."""
    file, line, name = extends.file, extends.line, extends.value
    if not isinstance(name, str):
        raise InputError(Problem(file, line, Wording("DEF210", "extends", name=as_written(name))))
    if len(name) > _MAX_NAME:
        raise InputError(Problem(file, line, Wording("DEF210", "extends_text_letters", count=len(name))))
    if _NAME.fullmatch(name):
        found = _shipped(name, library)
        if not _is_file(found.location):
            names = definition_names(library)
            near = meant_word(name, names)
            if near:
                wording = Wording("DEF210", "extends_nothing_shipped_but_near", name=name, near=near)
            elif names:
                wording = Wording("DEF210", "extends_nothing_shipped", name=name, names=tuple(names))
            else:
                wording = Wording("DEF210", "extends_no_name", name=name)
            raise InputError(Problem(file, line, wording))
        return found
    in_capitals = name.casefold().endswith(".toml") and not name.endswith(".toml")
    pure = PurePosixPath(name)
    outside = pure.is_absolute() or ".." in pure.parts or re.search(r"[\\:\x00-\x1f]", name)
    if "/" in name and pure.name and not pure.suffix:
        pure = pure.with_suffix(".toml")
    if outside or pure.suffix != ".toml" or child.folder is None:
        variant = "extends_not_file" if in_capitals else "extends_not_file_definition"
        raise InputError(Problem(file, line, Wording("DEF210", variant, name=name)))
    location = child.folder / pure
    # A link may lead out of the folder although its name does not.
    if not is_within(location, child.folder):
        raise InputError(Problem(file, line, Wording("DEF210", "extends_leads_out_folder", name=name)))
    if not _is_file(location):
        raise InputError(Problem(file, line, Wording("DEF210", "extends_no_file_beside", pure=pure)))
    return _DefinitionFile(location, str(location), location.parent)


def is_within(location: Path, folder: Path) -> bool:
    """Whether a path leads into a folder, wherever links go; links that go round lead nowhere."""
    try:
        return location.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):
        return False


def _is_file(location: Library | _Draft) -> bool:
    """Whether a path is that of a file; one that is too long, or a link that goes round, is not."""
    try:
        return location.is_file()
    except (OSError, RuntimeError, ValueError):
        return False


def _identity(source: _DefinitionFile) -> object:
    """Return what tells a file from others, by whatever path it was found."""
    if not isinstance(source.location, Path):
        return source.label
    with suppress(OSError):
        found = source.location.stat()
        if found.st_ino:  # some file systems count no files
            return found.st_dev, found.st_ino
    return source.location.resolve()


def _merge_ancestors(
    root: LocatedValue, source: _DefinitionFile, library: Library, problems: list[Problem]
) -> tuple[LocatedValue, tuple[str, ...]]:
    """Merge a table onto everything that it extends, directly or through others; and the files of those."""
    tables = [root]
    seen = [_identity(source)]
    labels, files = [_file_name(source.label)], list[str]()
    while True:
        table = tables[-1]
        assert isinstance(table.value, dict)
        extends = table.value.pop("extends", None)
        if extends is None:
            break
        # The file in which ``extends`` stands decides what it may reach, also if that file is itself extended.
        source = _parent(extends, source, library)
        labels.append(_file_name(source.label))
        if _identity(source) in seen:
            raise InputError(
                Problem(extends.file, extends.line, Wording("DEF220", "extends_goes_circle", labels=tuple(labels)))
            )
        seen.append(_identity(source))
        tables.append(_read(source))
        files.append(source.label)
    merged = tables.pop()
    while tables:
        merged = merge(merged, tables.pop(), "", problems)
    return merged, tuple(files)


def _file_name(label: str) -> str:
    return PurePosixPath(label.replace("\\", "/")).name


def definition_names(library: Library) -> list[str]:
    """Names of the definitions that a library holds, sorted."""
    names = (item.name for item in library.iterdir())
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def load_table(
    name_or_path: str | Path, library: Library, overrides: Mapping[str, object] | None = None, kind: str = "definition"
) -> Table:
    """Read a definition and everything that it extends.

    name_or_path  the name of a file in the library (without ``.toml``), or a path that ends in ``.toml``
    library       the folder of shipped definitions
    overrides     values in place of those of the file, shaped like it; they merge as if a file with them extended this
                  one
    kind          what the library holds, for messages: "machine"

    Raises ``InputError`` if a file is not TOML, or ``extends`` cannot be followed. The values of the keys are not
    checked yet.
    """
    text = str(name_or_path)
    if text.endswith(".toml"):
        path = Path(name_or_path)
        source = _DefinitionFile(path, text, path.parent)
    else:
        source = _shipped(text, library)
        if not _NAME.fullmatch(text) or not _is_file(source.location):
            names = definition_names(library)
            _check_is_name(text, kind, has_shipped=bool(names))
            if not names:
                raise InputError(
                    Problem(text, 0, Wording("DEF110", "file_not_found", with_article=_with_article(kind)))
                )
            near = f"{text}.toml" if Path(f"{text}.toml").is_file() else meant_word(text, names)
            raise InputError(
                Problem(
                    text,
                    0,
                    Wording("DEF110", "no_shipped_name", kind=_named(kind), near=near, names=tuple(names))
                    if near
                    else Wording("DEF110", "no_shipped", kind=_named(kind), names=tuple(names)),
                )
            )
    problems: list[Problem] = []
    root, extended = _merge_ancestors(_read(source, kind), source, library, problems)
    if overrides:
        root = merge(root, locate_values(dict(overrides), "overrides", {}), "", problems)
    return Table(root, "", problems, sources=(source.label, *extended))


def load_draft(text: str, path: Path, library: Library) -> Table:
    """Read a definition that is not saved yet, and everything that it extends.

    text     of the definition
    path     where it would be saved: what it extends lies beside or below it. It need not be there, and is not read
    library  the folder of shipped definitions

    Raises ``InputError`` as ``load_table``.
    """
    source = _DefinitionFile(_Draft(text.encode()), str(path), path.parent)
    problems: list[Problem] = []
    root, extended = _merge_ancestors(_read(source), source, library, problems)
    return Table(root, "", problems, sources=(source.label, *extended))


def own_keys(path: Path) -> frozenset[str]:
    """Return the keys at the top of a definition file, without those of what it extends.

    Raises ``InputError`` if the file cannot be read or is not TOML.
    """
    content = _read(_DefinitionFile(path, str(path), path.parent)).value
    return frozenset(content) if isinstance(content, dict) else frozenset()


def _check_is_name(text: str, kind: str, *, has_shipped: bool) -> None:
    """Raise ``InputError`` for the path of a folder or of a file of another kind, which is no name."""
    try:
        path = Path(text)
        is_folder, is_file = path.is_dir(), path.is_file()
    except (OSError, ValueError):
        return
    if is_folder:
        raise InputError(
            Problem(
                text,
                0,
                Wording("DEF140", "folder_not", with_article=_with_article(kind), kind=_named(kind))
                if has_shipped
                else Wording("DEF140", "definition_is_folder", with_article=_with_article(kind)),
            )
        )
    if is_file:
        raise InputError(
            Problem(
                text,
                0,
                (
                    Wording("DEF140", "not_whose_name", with_article=_with_article(kind), kind=_named(kind))
                    if has_shipped
                    else Wording("DEF140", "not_whose_name_ends", with_article=_with_article(kind))
                )
                if text.casefold().endswith(".toml")
                else (
                    Wording("DEF140", "not_whose_name_ends_toml", with_article=_with_article(kind), kind=_named(kind))
                    if has_shipped
                    else Wording("DEF140", "not_whose", with_article=_with_article(kind))
                ),
            )
        )


def resolve_extends(table: Table, library: Library) -> Table:
    """Merge a table within a definition onto what its own ``extends`` names in another library.

    A machine names its control in this way: ``[control]`` with ``extends = "sinumerik_840d"``. Without ``extends`` the
    result is an unread copy of the table.

    Raises ``InputError`` if ``extends`` cannot be followed.
    """
    assert isinstance(table.content.value, dict)
    extends = table.content.value.get("extends")
    file = extends.file if isinstance(extends, LocatedValue) else table.content.file
    folder = Path(file).parent
    problems: list[Problem] = []
    own = LocatedValue(dict(table.content.value), table.content.file, table.content.line)
    source = _DefinitionFile(folder / f"{Path(file).name}", f"{file} [{table.path}]", folder)
    merged, extended = _merge_ancestors(own, source, library, problems)
    return replace(table.other(merged, problems), sources=(*table.sources, *extended))
