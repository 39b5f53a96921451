"""What is simulated, as arguments or a project file state it: names of files, texts and numbers.

Units:  mm, degrees.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field, replace
from pathlib import Path
from typing import TypeAlias

from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike
from trunnion.jobs.inputs.settings import Settings
from trunnion.jobs.inputs.stated_setup import LengthLike, ZeroLike
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.solids import CL_STOCK
from trunnion.simulation.stock.stated_stock import stated_stock
from trunnion.simulation.stock.turning import Pose
from trunnion.simulation.tools.profile import ToolShape

#: Argument -> file, line and key of a project that states it.
Places: TypeAlias = Mapping[str, tuple[str, int, str]]


@dataclass(frozen=True, slots=True, eq=False)
class SetupInput:
    """One set-up: the stock as it is clamped, and what runs there. The rest as ``trunnion.simulate`` has it.

    name         for findings; empty where there is one set-up only
    pose         where the last set-up's workpiece frame lies in this one's; None: where it was
    part         None: that of the last set-up, where it lies now
    work_offset  in which the programs must cut; None: in any
    turn, tilt   how the part is clamped, degrees; None: as it is drawn. Stock, part and fixtures are given as drawn
    cl_is_turned  CL files, which are toolpaths, are turned already
    places       where a project file states arguments
    """

    programs: Sequence[FilePath | Run]
    machine: MachineLike
    name: str = ""
    pose: Pose | None = None
    part: str | Path | TriangleMesh | None = None
    fixtures: Sequence[str | Path | TriangleMesh] = ()
    work_offset: str | None = None
    tools: Iterable[str | ToolShape] = ()
    tool_libraries: Sequence[FilePath] = ()
    unit: str | None = None
    cl: ToolpathLike | Iterable[ToolpathLike] = ()
    strict: bool = False
    hooks: Sequence[FilePath] = ()
    subprograms: Sequence[FilePath] = ()
    zero: ZeroLike | None = None
    tool_length: LengthLike | None = None
    until: str | int | None = None
    radius_register: str | None = None
    settings: Settings | None = None
    assume: Mapping[str, str] | None = None
    turn: float | None = None
    tilt: float | None = None
    cl_is_turned: bool = False
    places: Places = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class SimulationInput:
    """Stock, and the set-ups in which it is cut one after another; the rest as ``trunnion.simulate`` has it.

    stock       empty, or ``cl``: that which the CL files of the first set-up state
    stock_from  the CL file that states it; empty where it is given
    """

    stock: str | Path | TriangleMesh
    setups: Sequence[SetupInput]
    stock_from: str = ""
    cell: float | None = None
    accuracy: float | None = None
    near: float | None = None
    stop_at: str | None = None
    threads: int | None = None
    places: Places = field(default_factory=dict)


def leaves_stock_to_cl(stock: str | Path | TriangleMesh | None) -> bool:
    """Whether what is stated of a stock leaves it to CL files."""
    return stock in (None, "", CL_STOCK)


def with_decided_stock(
    given: SimulationInput, drawn: Sequence[Toolpath], *, is_absolute: bool = False
) -> SimulationInput:
    """Return what is simulated with its stock: the one that is given, else that which CL files state.

    drawn        toolpaths of the part as it is drawn
    is_absolute  the program has the absolute coordinate system of the CAM system

    Raises ``InputError`` if there is none.
    """
    if not leaves_stock_to_cl(given.stock):
        return given
    if (stated := stated_stock(drawn, absolute=is_absolute)) is None:
        raise InputError(argument_problem("stock", Wording("SIM110", "stock_nowhere")))
    return replace(given, stock=stated.stock, stock_from=stated.file)


@contextmanager
def told_with_places(places: Places, setup: str = "") -> Iterator[None]:
    """Tell problems with arguments at the places where a project states them, with the set-up that has them."""
    try:
        yield
    except InputError as error:
        raise InputError([with_place(problem, places, setup) for problem in error.problems]) from None


def with_place(problem: Problem, places: Places, setup: str = "") -> Problem:
    """Return a problem with an argument where a project states it; any other as it is."""
    if problem.argument not in places:
        return problem
    file, line, key = places[problem.file]
    wording = problem.wording.within("of", name=key)
    wording = wording.within("of", name=setup) if setup else wording
    return replace(problem, file=file, line=line, wording=wording, subject=None)
