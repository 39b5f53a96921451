"""Operations while they are read: what their statements say, in units of the file.

Statements may refer to later ones, and the length unit may be known only at the end of the file. So they are collected
here, and ``trunnion.cl.assemble`` makes operations of them when the file has been read.
"""

import math
from dataclasses import field
from enum import Enum, auto
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Lines
from trunnion.cl.scan import PointColumns
from trunnion.messages import Wording
from trunnion.model.splines import SplineRows
from trunnion.model.toolpath import CycleOn, Event, Frame, Sense, Tool
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class MoveColumns:
    """The columns of ``trunnion.model.toolpath.Moves`` for the whole file; operations are slices of them.

    Tip and axis are written while the file is scanned, the others when an operation is assembled. Spare rows cost no
    memory: the operating system provides pages only when they are written.
    """

    tip: Floats
    axis: Floats
    kind: Codes
    phase: Codes
    feed: Floats
    per_rev: Flags
    line: Lines

    def points(self) -> PointColumns:
        """Return the columns that the scan writes."""
        return PointColumns(self.tip, self.axis, self.line)

    def grow(self) -> None:
        """Add half as many rows again."""
        for name in ("tip", "axis", "kind", "phase", "feed", "per_rev", "line"):
            old = getattr(self, name)
            new = np.empty((len(old) * 3 // 2 + 1, *old.shape[1:]), old.dtype)
            new[: len(old)] = old
            setattr(self, name, new)

    @staticmethod
    def allocate(n: int) -> "MoveColumns":
        """Return columns of ``n`` uninitialized rows."""
        return MoveColumns(
            tip=np.empty((n, 3)),
            axis=np.empty((n, 3)),
            kind=np.empty(n, np.uint8),
            phase=np.empty(n, np.uint8),
            feed=np.empty(n),
            per_rev=np.empty(n, np.bool_),
            line=np.empty(n, np.int32),
        )


@dataclass(frozen=True, slots=True)
class SurfaceSpeed(Event):
    """A spindle speed as the speed of the cutting edge, mm/min; the tool's diameter turns it into rev/min."""

    speed: float
    sense: Sense
    diameter: float | None


class FeedChange(NamedTuple):
    """A FEDRAT: ``value`` in mm/min or mm/rev, in units of the file if it names no unit, or 1/min if ``inverse``.

    ``is_kept``: the operation has it from the one before.
    """

    row: int
    value: float
    per_rev: bool
    in_file_units: bool
    inverse: bool = False
    is_kept: bool = False


class CircleStatement(NamedTuple):
    """An arc: xc, yc, zc, i, j, k, r in units of the file, and the number of turns that it begins (TIMES).

    A radius that is NaN is the distance of the start point. ``may_go_on``: points behind the next one may belong to the
    arc as well. ``angle``: degrees by which it turns, NaN if it does not say.
    """

    row: int
    line: int
    numbers: tuple[float, ...]
    turns: int
    may_go_on: bool = False
    angle: float = math.nan


@dataclass(slots=True)
class SplineStatement:
    """A spline: the row of its first control point, its knots, and how many control points it has in as many rows."""

    row: int
    line: int
    knots: tuple[float, ...] = ()
    points: int = 0


class FromStatement(NamedTuple):
    """A FROM: the tip, and the tool axis if it gives one."""

    row: int
    line: int
    tip: tuple[float, float, float]
    axis: tuple[float, float, float] | None


class NoAxis(Enum):
    """The tool axis of a point that gives none."""

    MODAL = auto()  # that of the point before
    Z = auto()  # (0, 0, 1)
    DOUBTFUL = auto()  # that of the point before, which must be (0, 0, 1): systems differ in any other case
    UPRIGHT = auto()  # the same, of records that never give one
    NEVER = auto()  # each point must give one


class AxisStatement(NamedTuple):
    """A statement about tool axes from ``row`` on (TLAXIS, MULTAX): an axis, and that of points that give none.

    ``vectors``: what points give behind their coordinates are tool axes; else it may be a vector of compensation.
    """

    row: int
    line: int
    axis: tuple[float, float, float] | None
    no_axis: NoAxis
    vectors: bool = True


class PlaneStatement(NamedTuple):
    """From ``row`` on, points are in the coordinates of a plane: its X, Y and Z, one behind the other."""

    row: int
    axes: tuple[float, ...]


class StatedPoints(NamedTuple):
    """What a file says of its points: those of the contour, or of the tool's centre.

    words  in which it says so
    lost   what is to say where no CUTCOM makes the control add the radius, and whether that refuses the file
    """

    contour: bool
    line: int
    words: str
    lost: Wording
    refuses: bool = False


@dataclass(slots=True, eq=False)
class OperationBuilder:
    """An operation while it is read. Rows count from ``first``, the row of the columns at which it begins.

    continues  it starts with the last point and tool axis of the operation before
    colours    (row, colour) of each PAINT/COLOR
    rapids     rows before which a RAPID stands
    axes       statements about the tool axis
    upright    (row, line, word) of statements that are understood for the tool axis (0, 0, 1) only
    tilted     the cure for a tilted tool axis, which the operation must not have; empty if it may
    named      the file gives it its name
    joined     names of the operations that were joined to it
    stated     what is true of the whole operation: the line that states it, and its value
    curves     the splines in mm, once their points are known, with the rows of these
    points     what the file says of its points
    open_cycle  the cycle that is still on where it begins; None: there is none
    planes     planes in whose coordinates the points are; none: they are in those of the file
    work_offset  which one of the control, from 1; 0: none is stated
    """

    name: str
    line: int
    first: int
    stop: int = 0
    continues: bool = False
    tool: Tool = field(default_factory=Tool)
    frame: Frame = field(default_factory=Frame)
    intol: float | None = None
    outtol: float | None = None
    events: list[Event] = field(default_factory=list)
    feeds: list[FeedChange] = field(default_factory=list)
    colours: list[tuple[int, int]] = field(default_factory=list)
    rapids: list[int] = field(default_factory=list)
    circles: list[CircleStatement] = field(default_factory=list)
    starts: list[FromStatement] = field(default_factory=list)
    axes: list[AxisStatement] = field(default_factory=list)
    upright: list[tuple[int, int, str]] = field(default_factory=list)
    tilted: str = ""
    splines: list[SplineStatement] = field(default_factory=list)
    named: bool = False
    joined: list[str] = field(default_factory=list)
    stated: dict[str, tuple[int, object]] = field(default_factory=dict)
    curves: list[SplineRows] = field(default_factory=list)
    points: StatedPoints | None = None
    open_cycle: CycleOn | None = None
    planes: list[PlaneStatement] = field(default_factory=list)
    work_offset: int = 0
