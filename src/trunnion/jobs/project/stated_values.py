"""Values of options that a TOML file states: each is read as its kind says; mistakes become problems of the tables."""

from pathlib import Path
from typing import Any

from trunnion.definitions import Table
from trunnion.jobs.project.paths import ProjectPaths
from trunnion.machines import shipped_machines
from trunnion.options.kinds import Choice, FileIn, Measure, Number, Point, Switch
from trunnion.options.option import SEVERAL, Option
from trunnion.simulation.fixtures import is_stated_fixture
from trunnion.simulation.stock.solids import is_mesh


class StatedValues:
    """Reads the values of options; files lie in the folder or below it."""

    def __init__(self, folder: Path) -> None:
        self.paths = ProjectPaths(folder)

    def value(self, table: Table, option: Option) -> Any:
        """Return what a table states of an option; None, or nothing of a list, where it does not."""
        key, kind = option.key, option.kind
        if isinstance(kind, Point | Measure) and kind.by_name and (table.is_table(key) or key not in table):
            return _by_name(table, key, kind)
        if isinstance(kind, FileIn):
            return self._files(table, option, kind)
        if isinstance(kind, Number | Measure):
            return _number(table, key, kind)
        if isinstance(kind, Point):
            return table.vector(key, 3, None)
        if isinstance(kind, Switch):
            return table.flag(key, False)
        if isinstance(kind, Choice):
            return table.text(key, None, one_of=kind.words)
        if option.many in SEVERAL:
            return table.texts(key, ())
        return table.text(key, None, example=getattr(kind, "example", ""))

    def machine(self, table: Table, key: str, *, required: bool = False) -> str:
        """Return a shipped machine, or the file of a definition; empty if it is not stated."""
        name = table.text(key) if required else table.text(key, "")
        if name.endswith(".toml"):
            return self.paths.file(table, key, name)
        file = f"{name}.toml"
        meant = {"".join(filter(str.isalpha, name.lower())): file} if self.paths.has_beside(file) else {}
        return table.text(key, "", one_of=shipped_machines(), other_names=meant) if name else ""

    def stock(self, table: Table, key: str) -> str:
        """Return a text of a stock, or the file of one."""
        name = table.text(key, "")
        return self.paths.file(table, key, name) if name and is_mesh(name) else name

    def _files(self, table: Table, option: Option, kind: FileIn) -> Any:
        if option.many in SEVERAL:
            is_text = is_stated_fixture if kind.leads == "fixture" else None
            return self.paths.files(table, option.key, is_text=is_text)
        if kind.leads == "machine":
            return self.machine(table, option.key)
        if kind.leads == "stock":
            return self.stock(table, option.key)
        name = table.text(option.key, "")
        return self.paths.file(table, option.key, name) if name or option.key in table else None


def _by_name(table: Table, key: str, kind: Point | Measure) -> dict[str, Any] | None:
    """Return values by their names; None if there are none."""
    single = table.table(key)
    found = {name: _one(single, name, kind) for name in single.names()}
    if key not in table:  # the other form, for the schema
        _one(table, key, kind)
    return found or None


def _one(table: Table, key: str, kind: Point | Measure) -> Any:
    return table.vector(key, 3, None) if isinstance(kind, Point) else _number(table, key, kind)


def _number(table: Table, key: str, kind: Number | Measure) -> float | None:
    """Return a number within the bounds of its kind."""
    if isinstance(kind, Measure):
        if kind.is_whole:
            return table.integer(key, None, at_least=kind.least, at_most=None if kind.most is None else int(kind.most))
        return table.number(key, None, above=kind.above, at_most=kind.most)
    above, least, most = (None if abs(each) == float("inf") else each for each in (kind.above, kind.least, kind.most))
    return table.number(key, None, above=above, at_least=least, at_most=most)
