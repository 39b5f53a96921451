"""Tool libraries in TOML: one ``[[tool]]`` for each tool, its sizes in mm and degrees."""

from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from trunnion.definitions import Table, load_table
from trunnion.definitions.messages import meant_word
from trunnion.messages import Wording
from trunnion.simulation.tools.library.library import LibraryTool, ToolLibrary
from trunnion.simulation.tools.shapes import shape_faults
from trunnion.simulation.tools.sizes import (
    ANGLE_LIMITS,
    GREATEST,
    OF_BODY,
    OF_KIND,
    OTHER_KINDS,
    BodyPiece,
    ToolKind,
    ToolSizes,
)

#: Greatest number of a tool.
_MOST: Final = 999_999_999

#: Parts of a tool that stand in tables of their own.
_PIECES: Final = ("shank", "holder")


def read_toml_library(path: Path) -> ToolLibrary:
    """Read a tool library in TOML.

    Raises ``InputError`` if it cannot be read, with every mistake in it and its line.
    """
    return read_library_table(library_table(path), path)


def library_table(path: Path) -> Table:
    """Return the table of a library and of all that it extends, unread.

    Raises ``InputError`` if a file is no TOML, or cannot be read.
    """
    return load_table(path, files(__package__), kind="tool library")


def read_library_table(root: Table, path: Path) -> ToolLibrary:
    """Read the table of a library that stands, or would stand, in ``path``; errors as ``read_toml_library``."""
    tools = read_tool_tables(root)
    root.report_unread_keys()
    root.raise_problems()
    return ToolLibrary(str(path), tools)


def read_tool_tables(root: Table) -> tuple[LibraryTool, ...]:
    """Read the tables ``[[tool]]`` of a file; mistakes are added to its problems."""
    tools: list[LibraryTool] = []
    taken: dict[int | str, str] = {}
    for table in root.tables("tool", required=True):
        number = table.integer("number", None, at_least=0, at_most=_MOST)
        name = table.text("name", "")
        if "number" not in table and not name:
            table.add_problem("", Wording("SIM174", "neither_number_nor"))
        called: dict[str, int | str | None] = {"number": number, "name": name or None}
        for key, value in called.items():
            if value is not None and taken.setdefault(value, table.path) != table.path:
                table.add_problem(key, Wording("SIM151", "too", taken=taken[value]))
        tools += _read_tool(table, number, name)
    return tuple(tools)


def _read_tool(table: Table, number: int | None, name: str) -> list[LibraryTool]:
    """Return the tool of a table; none if there is a mistake in it, which the table then has."""
    before = len(table.problems)
    description = table.text("description", "")
    word = table.text("kind", one_of=list(ToolKind), other_names=OTHER_KINDS)
    word = word if word in list(ToolKind) else meant_word(str(table.to_dict().get("kind")), ToolKind, OTHER_KINDS)
    if not word:  # which keys it should have, nobody knows
        table.mark_read(*table.keys())
        return []
    kind = ToolKind(word)
    sizes: dict[str, Any] = {part: tuple(map(_read_piece, table.tables(part))) for part in _PIECES}
    needed, others = OF_KIND[kind]
    for size in dict.fromkeys((*needed, *others, *OF_BODY)):
        key = _key(size)
        most = ANGLE_LIMITS.get(size, GREATEST)
        if size in needed:
            sizes[size] = table.number(key, above=0.0, at_most=most)
        else:
            sizes[size] = table.number(key, 0.0, at_least=0.0, at_most=most)
    table.report_unread_keys()
    if len(table.problems) > before:
        return []
    found = ToolSizes(kind, **sizes)
    faults = shape_faults(found)
    for size, wording in faults:
        table.add_problem(size if size in _PIECES else _key(size), wording)
    return [] if faults else [LibraryTool(found, number, name, description)]


def _key(size: str) -> str:
    """Return the key of a size, which ends in its unit."""
    return size + ("_deg" if size.endswith("angle") else "_mm")


def _read_piece(table: Table) -> BodyPiece:
    """Return a cylinder of one diameter, or a cone of two."""
    height = table.number("height_mm", above=0.0, at_most=GREATEST)
    if "diameter_mm" in table:
        low = high = table.number("diameter_mm", above=0.0, at_most=GREATEST)
    else:
        low = table.number("lower_diameter_mm", above=0.0, at_most=GREATEST)
        high = table.number("upper_diameter_mm", above=0.0, at_most=GREATEST)
    table.report_unread_keys()
    return BodyPiece(low, high, height)
