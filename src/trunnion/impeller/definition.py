"""``impeller.toml``: an impeller as data.

In:     the path of a definition; tables of points beside it.
Out:    ``ImpellerDefinition``, every value checked by itself.
"""

from collections.abc import Mapping
from dataclasses import field
from importlib.resources import files
from pathlib import Path
from typing import Final

from trunnion.definitions import Table, load_table
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem, key_subject
from trunnion.geometry.parameters import PARAMETERIZATIONS
from trunnion.geometry.point_tables import PointTable, read_point_table, scaled
from trunnion.impeller.steps import MachiningStep, StepKind, read_name, read_steps
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.tools.library.library import LibraryTool
from trunnion.simulation.tools.library.toml_library import read_tool_tables

EDGES: Final = ("round", "cut")

_GREATEST: Final = 10_000.0

_MOST_BLADES: Final = 60

#: No ball mills a smaller fillet, mm, and facets get as small as it.
_LEAST_FILLET: Final = 0.05


@dataclass(frozen=True, slots=True)
class StockSize:
    """A cylinder about Z, mm: its lowest height is ``bottom``; ``bore`` 0: it has none."""

    diameter: float
    height: float
    bottom: float
    bore: float

    @property
    def top(self) -> float:
        """Its highest height."""
        return self.bottom + self.height


@dataclass(frozen=True, slots=True, eq=False)
class ImpellerDefinition:
    """What ``impeller.toml`` says.

    sections          the blade's curves from hub to shroud, as measured points, mm
    parameterization  of the curves
    number            of blades
    hub_thickness, tip_thickness   of the blade, mm
    trailing_edge     ``cut`` by the stock, or ``round``
    splitter          share of the blade's length at which its splitters begin; None: it has none
    fillet            radius between blade and hub, mm
    tools, steps      with which it is machined, in their order; none where the definition has none
    premachined       what was made elsewhere before these steps
    places            file and line of each key, by its path, such as ``stock.height_mm``
    files             all that were read: the definition, what it extends, tables of points
    """

    file: str
    name: str
    sections: tuple[PointTable, ...]
    parameterization: str
    number: int
    hub_thickness: float
    tip_thickness: float
    trailing_edge: str
    splitter: float | None
    fillet: float
    stock: StockSize
    tools: tuple[LibraryTool, ...] = ()
    steps: tuple[MachiningStep, ...] = ()
    premachined: tuple[StepKind, ...] = ()
    places: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    files: tuple[str, ...] = ()

    def problem(self, key: str, wording: Wording) -> Problem:
        """Return a mistake that a key makes; it is told at the line of its table where the key is not written."""
        table = key.rpartition(".")[0]
        file, line = self.places.get(key) or self.places.get(table) or (self.file, 0)
        return Problem(file, line, wording, subject=key_subject(key))


def read_impeller(path: Path) -> ImpellerDefinition:
    """Read a definition of an impeller and its tables of points.

    Raises ``InputError`` if a file cannot be read, with every mistake and its line.
    """
    return read_impeller_table(load_table(path, files(__package__), kind="impeller"), path)


def read_impeller_table(root: Table, path: Path) -> ImpellerDefinition:
    """Read the table of a definition that stands, or would stand, in the file ``path``; errors as ``read_impeller``."""
    name = read_name(root, path.stem)
    blade, hub, stock = (root.table(key, required=True) for key in ("blade", "hub", "stock"))
    sections = _sections(blade, path)
    tools = _tools(root) if "operation" in root or "tool" in root else ()
    found = ImpellerDefinition(
        file=str(path),
        name=name,
        sections=sections,
        parameterization=blade.text("parameterization", PARAMETERIZATIONS[0], one_of=PARAMETERIZATIONS),
        number=blade.integer("number", at_least=2, at_most=_MOST_BLADES),
        hub_thickness=blade.number("hub_thickness_mm", above=0.0, at_most=_GREATEST),
        tip_thickness=blade.number("tip_thickness_mm", above=0.0, at_most=_GREATEST),
        trailing_edge=_edges(blade),
        splitter=blade.number("splitter_start", None, at_least=0.05, at_most=0.95),
        fillet=hub.number("fillet_mm", at_least=_LEAST_FILLET, at_most=_GREATEST),
        stock=_stock(stock),
        tools=tools,
        steps=read_steps(root, tools),
        premachined=_premachined(stock),
        places=_places(root, blade, hub, stock),
        files=(*root.files(), *(table.file for table in sections)),
    )
    for table in (root, blade, hub, stock):
        table.report_unread_keys()
    root.raise_problems()
    return found


def _tools(root: Table) -> tuple[LibraryTool, ...]:
    """Return the tools; their names stand in CL files and programs."""
    tools = read_tool_tables(root)
    for table in root.tables("tool"):
        read_name(table, "tool")
    return tools


def _places(*tables: Table) -> dict[str, tuple[str, int]]:
    """File and line of each key of some tables, by its path."""
    return {table.key_path(key): table.location(key) for table in tables for key in [*table.keys()]}


def _edges(blade: Table) -> str:
    """Return the trailing edge; a leading edge is round."""
    blade.text("leading_edge", "round", one_of=("round",))
    return blade.text("trailing_edge", "cut", one_of=EDGES)


def _stock(table: Table) -> StockSize:
    diameter = table.number("diameter_mm", above=0.0, at_most=_GREATEST)
    height = table.number("height_mm", above=0.0, at_most=_GREATEST)
    bore = table.number("bore_mm", 0.0, at_least=0.0, at_most=_GREATEST)
    if diameter and bore >= diameter:
        table.add_problem("bore_mm", Wording("IMP216", "not_less_diameter", bore=bore))
    return StockSize(diameter, height, table.number("bottom_mm", 0.0, at_least=-_GREATEST, at_most=_GREATEST), bore)


def _premachined(stock: Table) -> tuple[StepKind, ...]:
    """Kinds of steps that were made elsewhere."""
    words = stock.texts("premachined", ())
    kinds = list(StepKind)
    for word in words:
        if word not in kinds:
            stock.add_problem("premachined", Wording("IMP216", "names_no_kind", word=repr(word), kinds=tuple(kinds)))
    return tuple(StepKind(word) for word in words if word in kinds)


def _sections(blade: Table, path: Path) -> tuple[PointTable, ...]:
    """Return the blade's curves; mistakes in the table of points are added to those of the definition."""
    file = blade.text("points")
    scale = blade.number("scale", 1.0, above=0.0, at_most=1000.0)
    names = blade.texts("curves")
    if not file:
        if "points" in blade and not blade.problems:
            blade.add_problem("points", Wording("IMP216", "empty"))
        return ()
    place = Path(file)
    if place.is_absolute() or ".." in place.parts:
        blade.add_problem("points", Wording("IMP216", "is", file=repr(file)))
        return ()
    if not is_within(path.parent / place, path.parent):
        blade.add_problem("points", Wording("IMP216", "leads_out_folder", file=repr(file)))
        return ()
    try:
        tables = {table.name: table for table in read_point_table(path.parent / place)}
    except InputError as error:
        blade.problems.extend(error.problems)
        return ()
    for name in names:
        if name not in tables:
            blade.add_problem(
                "curves", Wording("IMP216", "names_not", name=repr(name), file=file, tables=tuple(map(repr, tables)))
            )
    if len(names) < 2 or len(set(names)) < len(names):
        blade.add_problem("curves", Wording("IMP216", "not_least_two"))
    return tuple(scaled(tables[name], scale) for name in names if name in tables)
