"""What CL files hold, for a person or a program that has no machine yet."""

from collections.abc import Iterable, Sequence
from typing import Annotated, ClassVar, Final

import numpy as np

from trunnion.cl import DIALECTS, other_system, unknown_statements
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.inputs.reading import ToolpathLike, read_toolpaths, stated_reading
from trunnion.jobs.inputs.settings import Settings
from trunnion.jobs.observer import SILENT, Observer
from trunnion.messages import Wording, foreign
from trunnion.model.apt_cutter import apt_cutter
from trunnion.model.frames import into_frame
from trunnion.model.toolpath import (
    CycleOn,
    Frame,
    From,
    GoHome,
    LoadTool,
    Operation,
    SpindleOff,
    SpindleOn,
    Tool,
    Toolpath,
)
from trunnion.planning.holes.cycles import SpindleState
from trunnion.planning.holes.operations import hole_rows
from trunnion.planning.path_measures import Range, extents, kind_and_planes, measure
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure

Vector = tuple[float, float, float]

#: Units by their length in mm.
_UNITS: Final = {1.0: "mm", 25.4: "inch"}


@dataclass(frozen=True, slots=True)
class ClFileDescription:
    """One CL file.

    dialect       ``clsf``, ``ncl``, ``solidworks``, ``clt``, ``catia``, ``fusion``, ``apt``, ``nci`` or ``trunnion``
    title, why    its name in words, and by what it was recognized; ``recognized`` in English
    units         ``mm`` or ``inch``
    states_units  the file says its unit, or its feeds do; else mm are assumed
    part          name of the part, empty if there is none
    system        coordinate system of the points in that of the model, where the file gives one whose meaning is not
                  settled: 3 rows of 4 numbers, mm; else empty
    stock         the stock that the file gives, as ``trunnion simulate --stock`` takes it; empty if it gives none
    """

    file: str
    dialect: str
    title: str
    why: Annotated[Wording, Figure("recognized", take=str)]
    units: str
    states_units: bool
    part: str
    system: tuple[float, ...]
    stock: str

    @property
    def recognized(self) -> str:
        """By what the dialect was recognized."""
        return str(self.why)


@dataclass(frozen=True, slots=True)
class ToolDescription:
    """A tool as the CL files describe it, mm and degrees; 0 is a size that they do not state.

    number      with which it is loaded; None: it is never loaded
    register    of its length, 0 if none is named
    holder      its name, empty if none is stated
    extension   how far it stands out of the holder
    set_length  its length in the spindle as the tool change states it
    apt         its form by APT's parameters d, r, e, f, a, b, h; empty if no size is stated
    upper_centre  centre of the upper corner: distance from the axis, height above the tip; None if it is not stated
    operations  those that it works in, by their places from 0
    """

    number: int | None
    register: int
    name: str
    kind: str
    diameter: float
    corner_radius: float
    length: float
    flute_length: float
    taper_angle: float
    tip_angle: float
    upper_radius: float
    holder: str
    extension: float
    set_length: float
    apt: tuple[float, ...]
    upper_centre: tuple[float, float] | None
    operations: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class OperationDescription:
    """An operation; the lengths are mm, the feeds mm/min and mm/rev.

    file, line          where it begins
    kind                ``three-axis``, ``3+2``, ``simultaneous`` or ``empty``, in coordinates of the first operation
    planes              tool axes of the planes of a 3+2 operation, in the same coordinates
    tool                its place in the list of tools
    system              place of its coordinate system in the list of these
    points, arcs, holes  its motions: rapids and lines, arcs, and points of cycles
    splines             how many splines some of its points stand for
    cycles              kinds of its holes, such as ``DRILL,DEEP``
    cutting_length      at feed, that of holes included
    cutting_seconds     at the programmed feeds, with dwells
    rapid_length        from point to point
    moves_without_time  those at feed that have no feed, or a feed per revolution while the spindle stands
    feed, feed_per_rev, rpm  lowest and highest while cutting; None: there is none
    extents             lowest and highest coordinates of its points, arcs and holes, in its own coordinate system
    joined              names of the operations of the file that it goes on with
    """

    name: str
    file: str
    line: int
    kind: str
    planes: tuple[Vector, ...]
    tool: int
    system: int
    points: int
    arcs: int
    holes: int
    splines: int
    cycles: tuple[str, ...]
    cutting_length: float
    cutting_seconds: float
    rapid_length: float
    moves_without_time: int
    feed: tuple[float, float] | None
    feed_per_rev: tuple[float, float] | None
    rpm: tuple[float, float] | None
    extents: tuple[Vector, Vector] | None
    joined: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class UnknownDescription:
    """Statements alike that the reader does not know: why (``what`` in English), how many, and the first one.

    acts  they may change the machine: ``post`` refuses them, unless a definition says what becomes of them
    """

    statement: str
    said: Annotated[Wording, Figure("what", take=str)]
    acts: bool
    count: int
    file: str
    line: int

    @property
    def what(self) -> str:
        """Why it is not known, in words."""
        return str(self.said)


@dataclass(frozen=True, slots=True)
class ClDescription:
    """What one or more CL files hold, as one job.

    dialect, units  of all files; None if they differ
    extents         lowest and highest coordinates of all points, arcs and holes in the coordinate system of the first
                    operation, mm; None without points, or if the files have coordinate systems that cannot be put
                    together
    systems         the coordinate systems of the operations: origin, X and Y in the CAM's absolute system
    unknown         statements that are not known
    remarks         warnings of the reader
    toolpaths       what was read
    """

    SCHEMA: ClassVar[int] = 2
    DECIMALS: ClassVar[int] = 9

    dialect: str | None
    units: str | None
    files: tuple[ClFileDescription, ...]
    operations: tuple[OperationDescription, ...]
    tools: tuple[ToolDescription, ...]
    systems: tuple[Frame, ...]
    extents: tuple[Vector, Vector] | None
    cutting_length: float
    cutting_seconds: float
    rapid_length: float
    moves_without_time: int
    unknown: tuple[UnknownDescription, ...]
    remarks: tuple[Problem, ...]
    toolpaths: Annotated[tuple[Toolpath, ...], NOT_DATA]

    def __repr__(self) -> str:
        """Return what matters in a notebook."""
        return f"ClDescription({self.dialect}, {self.units}, {len(self.operations)} operations)"


def describe_cl(
    cl: ToolpathLike | Iterable[ToolpathLike],
    *,
    units: str | None = None,
    dialect: str | None = None,
    strict: bool = False,
    settings: Settings | None = None,
    observer: Observer = SILENT,
) -> ClDescription:
    """Describe what CL files hold. No machine is needed.

    Parameters
    ----------
    cl
        CL files in the order in which they are cut: paths (of archives too), binary streams, or toolpaths that are
        already read.
    units
        Length unit of the files, ``"mm"`` or ``"inch"``; by default each file decides.
    dialect
        What they are written in; by default the content of each file decides.
    strict
        Raise an error for an unknown statement instead of listing it.
    settings
        How they are read, as for ``trunnion.post``: ``cutcom``, ``open_cycle``, ``spline_tolerance``.
    observer
        Receives the progress.

    Returns
    -------
    ClDescription
        Dialects, units, operations with their kinds, points, arcs and holes, tools, coordinate systems, extents, feeds,
        speeds, lengths, times at the programmed feeds, and statements that are not known. Lengths are in mm.

    Raises
    ------
    InputError
        With every problem found, if a file cannot be used.

    Notes
    -----
    Points, arcs and holes together are the statements that move the tool: GOTO, and GODLTA, GOHOME with a point, GOFWD.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.describe_cl("tests/golden/yl569/2_hub_rough.cls")
    >>> [(operation.name, operation.kind, operation.points) for operation in found.operations]
    [('MULTI_BLADE_ROUGH', 'simultaneous', 23)]
    """
    toolpaths = read_toolpaths(cl, observer, stated_reading(settings, strict, cl_units=units, dialect=dialect))
    if not toolpaths:
        raise InputError(argument_problem("cl", Wording("ARG130", "no_cl_file")))
    files = tuple(map(_file, toolpaths))
    pairs = [(toolpath.file, operation) for toolpath in toolpaths for operation in toolpath.operations]
    first = next((operation.frame for _, operation in pairs if len(operation.moves)), Frame())
    found = _Description(first)
    for file, operation in pairs:
        found.add(file, operation)
    operations = found.operations
    dialects, all_units = {file.dialect for file in files}, {file.units for file in files}
    return ClDescription(
        dialect=dialects.pop() if len(dialects) == 1 else None,
        units=all_units.pop() if len(all_units) == 1 else None,
        files=files,
        operations=tuple(operations),
        tools=found.tools(),
        systems=tuple(found.systems),
        extents=None if other_system(toolpaths) else found.extents(),
        cutting_length=sum(operation.cutting_length for operation in operations),
        cutting_seconds=sum(operation.cutting_seconds for operation in operations),
        rapid_length=sum(operation.rapid_length for operation in operations),
        moves_without_time=sum(operation.moves_without_time for operation in operations),
        unknown=tuple(_unknown(toolpaths)),
        remarks=tuple(remark for toolpath in toolpaths for remark in toolpath.remarks),
        toolpaths=tuple(toolpaths),
    )


def _file(toolpath: Toolpath) -> ClFileDescription:
    why = toolpath.recognized_by.parameter("why")
    return ClFileDescription(
        file=toolpath.file,
        dialect=toolpath.dialect,
        title=DIALECTS[toolpath.dialect].title,
        why=why if isinstance(why, Wording) else foreign(""),
        units=_UNITS[toolpath.unit],
        states_units=toolpath.states_unit,
        part=toolpath.part,
        system=toolpath.system,
        stock=toolpath.stock,
    )


def _unknown(toolpaths: Sequence[Toolpath]) -> Iterable[UnknownDescription]:
    for toolpath in toolpaths:
        for same in unknown_statements(toolpath):
            first = same[0]
            yield UnknownDescription(first.text.strip(), first.what, first.acts, len(same), toolpath.file, first.line)


class _Description:
    """Collects operations, and what goes on from one to the next: tool, spindle and position."""

    def __init__(self, frame: Frame) -> None:
        self.operations: list[OperationDescription] = []
        self.systems: dict[Frame, int] = {}
        self._frame = frame
        self._tools: dict[tuple[int | None, int, Tool], list[int]] = {}
        self._loaded: LoadTool | None = None
        self._spindle: SpindleState | None = None
        self._tip: np.ndarray[tuple[int, ...], np.dtype[np.float64]] | None = None
        self._extents = tuple(Range() for _ in range(3))

    def add(self, file: str, operation: Operation) -> None:
        """Describe an operation."""
        moved = into_frame(operation, self._frame)
        kind, planes = kind_and_planes(moved)
        measured = measure(moved, self._start(moved), self._spindle)
        holes = hole_rows(operation)
        arcs = len(operation.arcs.row)
        for range_, *ends in zip(self._extents, *(extents(moved) or ()), strict=False):
            range_.add(np.array(ends))
        self.operations.append(
            OperationDescription(
                name=operation.name,
                file=file,
                line=operation.line,
                kind=kind,
                planes=planes,
                tool=self._tool(operation),
                system=self.systems.setdefault(operation.frame, len(self.systems)),
                points=len(operation.moves) - arcs - int(holes.sum()),
                arcs=arcs,
                holes=int(holes.sum()),
                splines=len(operation.splines),
                cycles=tuple(dict.fromkeys(",".join(e.mode) for e in operation.events if isinstance(e, CycleOn))),
                cutting_length=measured.cutting_length,
                cutting_seconds=measured.cutting_seconds,
                rapid_length=measured.rapid_length,
                moves_without_time=measured.moves_without_time,
                feed=measured.feed.pair(),
                feed_per_rev=measured.feed_per_rev.pair(),
                rpm=measured.rpm.pair(),
                extents=extents(operation),
                joined=operation.joined,
            )
        )
        self._go_on(moved)

    def tools(self) -> tuple[ToolDescription, ...]:
        """Return the tools in the order of their first use."""
        return tuple(
            ToolDescription(
                number=number, register=register, name=tool.name, kind=tool.kind, diameter=tool.diameter,
                corner_radius=tool.corner_radius, length=tool.length, flute_length=tool.flute_length,
                taper_angle=tool.taper_angle, tip_angle=tool.tip_angle, upper_radius=tool.upper_radius,
                holder=tool.holder, extension=tool.extension, set_length=tool.set_length,
                apt=tuple(apt_cutter(tool)) if tool.diameter or tool.corner_radius else (),
                upper_centre=tool.upper_centre,
                operations=tuple(operations),
            )
            for (number, register, tool), operations in self._tools.items()
        )  # fmt: skip

    def extents(self) -> tuple[Vector, Vector] | None:
        """Lowest and highest coordinates of all points, arcs and holes."""
        if self._extents[0].pair() is None:
            return None
        x, y, z = self._extents
        return (x.low, y.low, z.low), (x.high, y.high, z.high)

    def _start(self, operation: Operation) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]] | None:
        """Where the tool stands before the first row; None after a tool change or from home."""
        begin = [event for event in operation.events if event.row == 0]
        if given := [event for event in begin if isinstance(event, From)]:
            return np.array(given[-1].tip)
        return None if any(isinstance(event, LoadTool | GoHome) for event in begin) else self._tip

    def _tool(self, operation: Operation) -> int:
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        loaded = loads[0] if loads else self._loaded
        key = (None, 0, operation.tool) if loaded is None else (loaded.number, loaded.adjust, operation.tool)
        self._tools.setdefault(key, []).append(len(self.operations))
        return list(self._tools).index(key)

    def _go_on(self, operation: Operation) -> None:
        for event in operation.events:
            if isinstance(event, LoadTool):
                self._loaded = event
            elif isinstance(event, SpindleOn):
                self._spindle = SpindleState(event.rpm, event.sense)
            elif isinstance(event, SpindleOff):
                self._spindle = None
        if len(operation.moves):
            self._tip = operation.moves.tip[-1]
        if any(isinstance(event, GoHome) and event.row == len(operation.moves) for event in operation.events):
            self._tip = None
