"""What a control did with a program: one row a motion, in columns, and what happened between the rows.

A run keeps what its blocks say and what cannot be worked out from a row alone. State that changes seldom is kept by its
changes (``ModalState``); slides, tips and tool axes come from the machine. ``positions`` and ``chunk`` work them out
for some rows; as whole columns they are made when they are first asked for, and then kept.

Units: mm, degrees, unit vectors, rev/min; feeds in mm/min, mm/rev or 1/min as ``feed_mode`` says.
Frame: the workpiece frame of the machine, that is the zero point set by the work offset; programmable frames and
swivelled planes are already resolved to it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from enum import IntEnum, IntFlag
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines
from trunnion.concurrency import prefetch
from trunnion.errors import Severity
from trunnion.machines import KinematicParameters, Machine, forward, kinematic_parameters, tool_axes
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.columns import RampColumn, StepColumn
from trunnion.model.toolpath import Arcs

#: Rows that are worked out at a time: some megabytes, and milliseconds enough that two threads seldom meet.
CHUNK_ROWS = 32768


class ProgrammedWord(IntFlag):
    """Words that a block really wrote, as bits of ``Run.programmed``."""

    X = 1
    Y = 2
    Z = 4
    FIRST = 8
    SECOND = 16
    VECTOR = 32
    FEED = 64


class Orientation(IntEnum):
    """How the tool axis moves between rows while TCP is on: angles linear, or the vector on a great circle."""

    ANGLES = 0
    GREAT_CIRCLE = 1


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """Something that the reader did not know, could not do or finds odd; line from 1, in ``file``."""

    line: int
    text: str
    severity: Severity = Severity.ERROR
    file: str = ""

    def __str__(self) -> str:
        """Return ``file:line: severity: text``."""
        return f"{self.file}:{self.line}: {self.severity}: {self.text}"


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment of the program, without its semicolon, and the row before which it stands; file as in ``Run.file``."""

    line: int
    before_row: int
    text: str
    file: int = 0


EventValue = float | str | tuple[float | str | None, ...] | None


@dataclass(frozen=True, slots=True)
class RunEvent:
    """Something that happens before row ``before_row`` (``before_row == n``: after the last one).

    kind    one of the names in ``docs/reader.md``: tool, tool_change, spindle, coolant, dwell, stop, message, ...
    value   a number, a text or the values of the cycle, as the kind has it
    file    as in ``Run.file``
    tcp     the control held the tip then (TCP); the rows beside it need not tell
    """

    line: int
    before_row: int
    kind: str
    value: EventValue = None
    file: int = 0
    tcp: bool = False


#: Codes of work offsets above this are those of ``G54.1 P``.
EXTENDED_OFFSET_BASE = 600


def offset_name(code: int) -> str:
    """The word of a work offset that is called by one: ``G54``, ``G505``, ``G54.1 P3``."""
    return f"G{code}" if code <= EXTENDED_OFFSET_BASE else f"G54.1 P{code - EXTENDED_OFFSET_BASE}"


#: ``ModalState.orientation`` before the first word of an ``Orientation``: as the words of each block have it.
ORIENTATION_FROM_WORDS = 2


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceNormals:
    """The surface's normals that blocks say: ``row`` (k,), growing, and ``vector`` (k, 3) in the workpiece frame.

    Vectors are as long as the program has them.
    """

    row: Ints
    vector: Floats

    def __post_init__(self) -> None:
        for column in (self.row, self.vector):
            column.setflags(write=False)

    def __len__(self) -> int:
        return len(self.row)

    @staticmethod
    def none() -> "SurfaceNormals":
        """No normals at all."""
        return SurfaceNormals(np.zeros(0, np.int64), np.zeros((0, 3)))


@dataclass(frozen=True, slots=True, eq=False)
class ModalState:
    """What changes seldom, as columns that are kept by their changes. The same names in ``Run`` are the whole columns.

    xyz_is_tip  ``Run.xyz`` is the tool tip, not the slides
    feed_path   a ``FeedPath``: what the feed would count where rotary axes turn without TCP
    """

    file: StepColumn
    feed: StepColumn
    feed_mode: StepColumn
    rpm: StepColumn
    spindle: StepColumn
    tool: StepColumn
    edge: StepColumn
    compensation: StepColumn
    work_offset: StepColumn
    tcp: StepColumn
    machine_frame: StepColumn
    inches: StepColumn
    orientation: StepColumn
    xyz_is_tip: StepColumn
    feed_path: StepColumn


@dataclass(frozen=True, slots=True, eq=False)
class RowPositions:
    """Where axes and tool are in k rows: ``joints`` (k, 5), ``tip`` and ``axis`` (k, 3) as in ``Run``, read-only."""

    joints: Floats
    tip: Floats
    axis: Floats

    def __post_init__(self) -> None:
        for column in (self.joints, self.tip, self.axis):
            column.setflags(write=False)


@dataclass(frozen=True, slots=True, eq=False)
class PositionChunk(RowPositions):
    """Consecutive rows: ``midpoint_axis`` (k - 1, 3) is the tool axis where every joint is half-way from row to row."""

    midpoint_axis: Floats


@dataclass(frozen=True, eq=False)
class Run:
    """A program as a machine's control ran it; columns have n rows and are read-only.

    Kept:

    lines          (n,)   RampColumn    line of the file, from 1
    block_numbers  (n,)   RampColumn    N number of the block, -1 where it has none
    kind           (n,)   uint8    a ``trunnion.model.toolpath.Kind``
    programmed     (n,)   uint8    ``ProgrammedWord`` bits
    xyz            (n, 3) float64  what X Y Z come to, mm: the tool tip, workpiece frame, where ``state.xyz_is_tip``;
    else
                                   the values of the slides X, Y and Z
    rotary         (n, 2) float64  positions of the rotary axes as they wind, deg, as in ``machine.rotary``
    start          (5,)   float64  axis values before row 0
    normals                        a ``SurfaceNormals``: where blocks say that of the surface (LN)
    uses_length_numbers            programs of this control select a tool length by its number (H), the column ``edge``

    Worked out of these when asked for:

    tip            (n, 3) float64  tool tip, mm, workpiece frame
    axis           (n, 3) float64  unit vector from tip to holder, workpiece frame
    line           (n,)   int32    ``lines`` as a whole column
    block_number   (n,)   int64    ``block_numbers`` as a whole column
    joints         (n, 5) float64  axis values as displayed, mm or deg, machine order; rotary values as they wind
    file           (n,)   uint16   index into ``files``: 0 is the program itself, others are its subprograms
    feed           (n,)   float64  NaN before the first F; rapids carry it on
    feed_mode      (n,)   uint8    94 mm/min, 95 mm/rev, 93 inverse time (1/min)
    rpm            (n,)   float64  programmed spindle speed, 0 before the first S
    spindle        (n,)   int8     +1 M3, -1 M4, 0 off
    tool           (n,)   int32    index into ``tools``; 0 is the empty name, no tool yet
    edge           (n,)   int32    D number, -1 before the first D; Fanuc, LinuxCNC: H of the length in force, else -1
    compensation   (n,)   int8     of the tool's radius: +1 left of the path (G41), -1 right of it, 0 off; not simulated
    work_offset    (n,)   uint16   work offset as the program numbers it (G54, preset 2), 0 before the first
    tcp            (n,)   bool     tool centre point control was on
    machine_frame  (n,)   bool     a block with positions of machine axes: SUPA, G53, M91
    inches         (n,)   bool     lengths were programmed in inches (the columns are in mm)
    orientation    (n,)   uint8    an ``Orientation``: how the tool axis got here from the row before
    """

    machine: Machine
    files: tuple[str, ...]
    lines: RampColumn
    block_numbers: RampColumn
    kind: Codes
    programmed: Codes
    xyz: Floats
    rotary: Floats
    state: ModalState
    start: Floats
    arcs: Arcs
    normals: SurfaceNormals = field(default_factory=SurfaceNormals.none)
    tools: tuple[str, ...] = ("",)
    comments: list[Comment] = field(default_factory=list)
    events: list[RunEvent] = field(default_factory=list)
    diagnostics: tuple[Diagnostic, ...] = ()
    uses_length_numbers: bool = False

    def __post_init__(self) -> None:
        for each in fields(self):
            column = getattr(self, each.name)
            if isinstance(column, np.ndarray):
                column.setflags(write=False)

    def __len__(self) -> int:
        return len(self.kind)

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """Findings that make the columns doubtful: words unknown or not acted upon."""
        return tuple(finding for finding in self.diagnostics if finding.severity is Severity.ERROR)

    # Some rows

    @cached_property
    def _kinematics(self) -> KinematicParameters:
        return kinematic_parameters(self.machine)

    def positions(self, rows: Ints) -> RowPositions:
        """Where axes and tool are at the end of rows, in any order; row -1 is the place before the first one."""
        if not len(self) or not len(rows):
            joints = np.tile(self.start, (len(rows), 1))
            return RowPositions(joints, *forward(self.machine, joints))
        xyz_is_tip = self.state.xyz_is_tip.at(rows)
        xyz = self.xyz[rows]
        joints = joints_from_rows(self.machine, self._kinematics, xyz_is_tip, xyz, self.rotary[rows])
        first = rows < 0
        joints[first] = self.start
        tip, axis = forward(self.machine, joints)
        xyz_is_tip &= ~first
        tip[xyz_is_tip] = xyz[xyz_is_tip]
        return RowPositions(joints, tip, axis)

    def chunk(self, first: int, end: int) -> PositionChunk:
        """Where axes and tool are in consecutive rows, led by the place before them: (end - first + 1) rows."""
        rows = slice(max(first - 1, 0), end)
        xyz_is_tip = self.state.xyz_is_tip.part(rows.start, end)
        xyz = self.xyz[rows]
        joints = joints_from_rows(self.machine, self._kinematics, xyz_is_tip, xyz, self.rotary[rows])
        if first == 0:
            joints = np.concatenate((self.start[None], joints))
        if first and xyz_is_tip.all():
            return PositionChunk(joints, xyz, *tool_axes(self.machine, joints))
        tip, _ = forward(self.machine, joints)
        reached = tip[1:] if first == 0 else tip
        reached[xyz_is_tip] = xyz[xyz_is_tip]
        return PositionChunk(joints, tip, *tool_axes(self.machine, joints))

    def chunks(self) -> Iterator[tuple[int, int, PositionChunk]]:
        """All rows, ``CHUNK_ROWS`` at a time: first row, the row after the last, and ``chunk`` of them.

        While one chunk is looked at the next one is worked out, on another core if there is one.
        """
        bounds = [(first, min(first + CHUNK_ROWS, len(self))) for first in range(0, len(self), CHUNK_ROWS)]
        for (first, end), poses in zip(bounds, prefetch(lambda rows: self.chunk(*rows), bounds), strict=True):
            yield first, end, poses

    def orientation_between(self, first: int, end: int) -> Codes:
        """Column ``orientation`` of consecutive rows."""
        said = self.state.orientation.part(first, end)
        vectors = (self.programmed[first:end] & int(ProgrammedWord.VECTOR)) != 0
        return np.where(said == ORIENTATION_FROM_WORDS, vectors, said).astype(np.uint8)

    # Whole columns

    @cached_property
    def line(self) -> Lines:
        return self.lines.column(np.int32)

    @cached_property
    def block_number(self) -> Ints:
        return self.block_numbers.column(np.int64)

    @cached_property
    def tip(self) -> Floats:
        return self._compute_column("tip", 3)

    @cached_property
    def axis(self) -> Floats:
        return self._compute_column("axis", 3)

    @cached_property
    def joints(self) -> Floats:
        return self._compute_column("joints", 5)

    def _compute_column(self, name: str, width: int) -> Floats:
        column = np.empty((len(self), width))
        for first, end, poses in self.chunks():
            column[first:end] = getattr(poses, name)[1:]
        column.setflags(write=False)
        return column

    @cached_property
    def orientation(self) -> Codes:
        column = self.orientation_between(0, len(self))
        column.setflags(write=False)
        return column

    @cached_property
    def file(self) -> NDArray[np.uint16]:
        return self.state.file.column()

    @cached_property
    def feed(self) -> Floats:
        return self.state.feed.column()

    @cached_property
    def feed_mode(self) -> Codes:
        return self.state.feed_mode.column()

    @cached_property
    def rpm(self) -> Floats:
        return self.state.rpm.column()

    @cached_property
    def spindle(self) -> NDArray[np.int8]:
        return self.state.spindle.column()

    @cached_property
    def tool(self) -> Lines:
        return self.state.tool.column()

    @cached_property
    def edge(self) -> Lines:
        return self.state.edge.column()

    @cached_property
    def compensation(self) -> NDArray[np.int8]:
        return self.state.compensation.column()

    @cached_property
    def work_offset(self) -> NDArray[np.uint16]:
        return self.state.work_offset.column()

    @cached_property
    def tcp(self) -> Flags:
        return self.state.tcp.column()

    @cached_property
    def machine_frame(self) -> Flags:
        return self.state.machine_frame.column()

    @cached_property
    def inches(self) -> Flags:
        return self.state.inches.column()
