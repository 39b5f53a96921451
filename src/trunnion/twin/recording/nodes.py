"""What is recorded: the columns of a recording, and the variables of the machine's server that they show.

In:     the name of a shipped list, or a TOML file.
Out:    a ``NodeList``.
"""

import re
from importlib.resources import files
from pathlib import Path
from typing import Final

from trunnion.definitions import Table, definition_names, load_table
from trunnion.messages import Wording
from trunnion.model.recording import PROGRAM
from trunnion.records import dataclass

_LIBRARY: Final = files("trunnion.twin.recording").joinpath("library")

_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,31}", re.ASCII)

#: Columns that every recording has.
TIMES: Final = ("source", "server", "received", "mark")
STAMPS: Final = TIMES[:3]

#: Columns of texts, whatever a list says.
TEXTS: Final = (PROGRAM, "block")

_MOST_COLUMNS: Final = 200


@dataclass(frozen=True, slots=True)
class VariableAddress:
    """Where a variable is: by its NodeId in a namespace, or by the names on the way to it from the objects.

    identifier  of the NodeId, as OPC UA writes it (``s=…``, ``i=…``); empty: it is found by its path
    """

    namespace: str = ""
    identifier: str = ""
    path: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "/".join(self.path) if self.path else f"nsu={self.namespace};{self.identifier}"


@dataclass(frozen=True, slots=True)
class Column:
    """A column and the variable that it shows.

    is_text      it holds texts
    is_optional  a machine may lack it
    element      which element of an array it is, from 1; 0: the variable is no array
    named_by     a variable that holds the name of the column; None: the name is ``name``
    """

    name: str
    place: VariableAddress
    is_text: bool = False
    is_optional: bool = False
    element: int = 0
    named_by: VariableAddress | None = None


@dataclass(frozen=True, slots=True)
class NodeList:
    """The columns of a recording, in their order."""

    columns: tuple[Column, ...]


def node_list_names() -> list[str]:
    """Names of the shipped lists."""
    return definition_names(_LIBRARY)


def load_nodes(name_or_path: str | Path) -> NodeList:
    """Read a list of nodes.

    Raises
    ------
    InputError
        If there is none of this name, or with every mistake of the file.
    """
    return read_nodes(load_table(name_or_path, _LIBRARY, kind="list of nodes"))


def read_nodes(root: Table) -> NodeList:
    """Read the table of a list of nodes.

    Raises
    ------
    InputError
        With every mistake of it.
    """
    namespace = root.text("namespace", "")
    columns = root.table("columns", required=True)
    found = [_column(name, columns.table(name), namespace) for name in columns.names()]
    for name in columns.names():
        if not _NAME.fullmatch(name) or name in TIMES:
            columns.add_problem(name, Wording("TWN232", "cannot_name_column"))
    if not found and "columns" in root:
        root.add_problem("columns", Wording("TWN232", "empty"))
    if len(found) > _MOST_COLUMNS:
        root.add_problem("columns", Wording("TWN232", "columns", count=len(found), most_columns=_MOST_COLUMNS))
    root.report_unread_keys()
    root.raise_problems()
    return NodeList(tuple(found))


def _column(name: str, table: Table, namespace: str) -> Column:
    place = _place(table, "id", "path", table.text("namespace", namespace))
    named = _place(table, "name_id", "name_path", table.text("namespace", namespace), required=False)
    made = Column(
        name=name,
        place=place or VariableAddress(),
        is_text=table.flag("text", name in TEXTS),
        is_optional=table.flag("optional", False),
        element=table.integer("element", 0, at_least=1, at_most=10_000),
        named_by=named,
    )
    table.report_unread_keys()
    return made


def _place(
    table: Table, identifier: str, path: str, namespace: str, *, required: bool = True
) -> VariableAddress | None:
    """Return the place that one of two keys states."""
    by_id, by_path = table.text(identifier, ""), table.text(path, "")
    if by_id and by_path:
        table.add_problem(path, Wording("TWN232", "given_beside", identifier=identifier))
    if by_path:
        return VariableAddress(path=tuple(filter(None, by_path.split("/"))))
    if by_id:
        if not namespace:
            table.add_problem(identifier, Wording("TWN232", "no_namespace"))
        return VariableAddress(namespace, by_id if re.match(r"[isgb]=", by_id) else f"s={by_id}")
    if required:
        table.add_problem("", Wording("TWN232", "does_not_say", identifier=identifier, path=path))
    return None
