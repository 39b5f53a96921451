"""A toolpath: what the cutter does, in workpiece coordinates.

Dense motion is columns, one row a CL point; sparse happenings are small frozen events, each with the row
before which it takes place and the line of the CL file that it came from.

Units: mm, degrees where an angle is meant, unit vectors for directions, mm/min or mm/rev for feeds.
Frame: the operation's own coordinate system (``Operation.frame``, MSYS in a CLSF).
"""

from dataclasses import dataclass, field
from enum import IntEnum, StrEnum

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines
from trunnion.errors import Problem


class Kind(IntEnum):
    """How the tip gets to a row from the row before it."""

    RAPID = 0
    LINEAR = 1
    ARC = 2


class Phase(IntEnum):
    """The part that a motion plays in its operation; the CAM system says it by colour."""

    INITIAL = 0
    RAPID = 1
    APPROACH = 2
    ENGAGE = 3
    CUT = 4
    STEPOVER = 5
    RETRACT = 6
    DEPARTURE = 7
    TRAVERSE = 8


@dataclass(frozen=True, slots=True, eq=False)
class Moves:
    """The dense columns of one operation; all have n rows and are read-only.

    tip      (n, 3) float64   end point of the move, mm
    axis     (n, 3) float64   tool axis at the end point, unit vector from tip to holder
    kind     (n,)   uint8     a ``Kind``
    phase    (n,)   uint8     a ``Phase``
    feed     (n,)   float64   mm/min, or mm/rev where ``per_rev``; NaN before the first FEDRAT; rapids carry it on
    per_rev  (n,)   bool      feed is per spindle revolution
    line     (n,)   int32     line of the CL file, from 1
    normal   (n, 3) float64   unit vector out of the surface where the tool touches it, NaN where nobody knows; None:
                              nobody asked for it
    """

    tip: Floats
    axis: Floats
    kind: Codes
    phase: Codes
    feed: Floats
    per_rev: Flags
    line: Lines
    normal: Floats | None = None

    def __post_init__(self) -> None:
        for column in (self.tip, self.axis, self.kind, self.phase, self.feed, self.per_rev, self.line, self.normal):
            if column is not None:
                column.setflags(write=False)

    def __len__(self) -> int:
        return len(self.tip)

    def select(self, rows: slice | Ints | Flags) -> "Moves":
        """Some of the rows."""
        return Moves(
            self.tip[rows], self.axis[rows], self.kind[rows], self.phase[rows], self.feed[rows], self.per_rev[rows],
            self.line[rows], None if self.normal is None else self.normal[rows],
        )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Arcs:
    """The circles of one operation, one entry for each row of ``Moves`` whose kind is ARC, in row order.

    row      (m,)   int64     row of the end point
    centre   (m, 3) float64   mm
    normal   (m, 3) float64   unit vector; the tip turns about it by the right-hand rule
    radius   (m,)   float64   mm
    full_turns (m,) int64     whole turns besides the arc from start to end; a full circle (start = end) has 0
    """

    row: Ints
    centre: Floats
    normal: Floats
    radius: Floats
    full_turns: Ints

    def __post_init__(self) -> None:
        for column in (self.row, self.centre, self.normal, self.radius, self.full_turns):
            column.setflags(write=False)

    @staticmethod
    def empty() -> "Arcs":
        """No arcs at all."""
        return Arcs(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0, np.int64))


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens before row ``row`` (``row == n``: after the last one)."""

    row: int
    line: int


class Sense(StrEnum):
    """Which way the spindle turns."""

    CLW = "CLW"
    CCLW = "CCLW"


@dataclass(frozen=True, slots=True)
class LoadTool(Event):
    """Put a tool into the spindle. ``adjust`` is the length register, 0 if none was named."""

    number: int
    adjust: int = 0


@dataclass(frozen=True, slots=True)
class SelectTool(Event):
    """Bring the tool after next to the changer."""

    number: int


@dataclass(frozen=True, slots=True)
class SpindleOn(Event):
    """Spindle speed in rev/min and sense; surface speeds are already turned into rev/min."""

    rpm: float
    sense: Sense = Sense.CLW


@dataclass(frozen=True, slots=True)
class SpindleOff(Event):
    """Stop the spindle."""


@dataclass(frozen=True, slots=True)
class Coolant(Event):
    """Coolant by its CL word: ON, FLOOD, MIST, TAP, THRU, AIR or OFF."""

    kind: str


@dataclass(frozen=True, slots=True)
class CutterComp(Event):
    """Cutter radius compensation.

    side is LEFT, RIGHT, ON or OFF; plane XYPLAN, ZXPLAN, YZPLAN or empty; register 0 if none was named.
    """

    side: str
    plane: str = ""
    register: int = 0


@dataclass(frozen=True, slots=True)
class Dwell(Event):
    """Wait, in seconds or in spindle revolutions."""

    amount: float
    revolutions: bool = False


@dataclass(frozen=True, slots=True)
class Stop(Event):
    """Program stop; optional stops depend on the switch at the control."""

    optional: bool
    text: str = ""


@dataclass(frozen=True, slots=True)
class Message(Event):
    """Text for the operator or for the reader of the program (PPRINT, DISPLY)."""

    text: str
    display: bool = False


@dataclass(frozen=True, slots=True)
class Insert(Event):
    """Text that goes into the NC program as it stands."""

    text: str


@dataclass(frozen=True, slots=True)
class BlockSkip(Event):
    """Optional block skip on or off."""

    on: bool


@dataclass(frozen=True, slots=True)
class CycleOn(Event):
    """A hole-making cycle becomes modal; each following row is a hole until ``CycleOff``.

    mode     minor words before the first couplet, such as ("DRILL", "DEEP")
    values   couplets word -> numbers in CL units turned to mm, such as {"RAPTO": (3.0,)}
    words    minor words that carry no number, such as ("AUTO",) after RTRCTO as {"RTRCTO": "AUTO"}
    """

    mode: tuple[str, ...]
    values: tuple[tuple[str, tuple[float, ...]], ...]
    words: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class CycleOff(Event):
    """The modal cycle ends."""


@dataclass(frozen=True, slots=True)
class From(Event):
    """The position from which the path starts; not a motion."""

    tip: tuple[float, float, float]
    axis: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class GoHome(Event):
    """Go to the machine's home (GOHOME without a point; with a point it is a rapid row)."""


@dataclass(frozen=True, slots=True)
class SetMode(Event):
    """SET/MODE and its kin, kept with the words that it carried."""

    words: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class UnknownStatement(Event):
    """A statement that nobody knows, kept as it stood."""

    text: str


@dataclass(frozen=True, slots=True)
class Tool:
    """The cutter, mm and degrees.

    kind is the CL form: MILL (corner radius, maybe taper), TCUTTER, BARREL, DRILL or UNKNOWN.
    """

    kind: str = "UNKNOWN"
    name: str = ""
    diameter: float = 0.0
    corner_radius: float = 0.0
    length: float = 0.0
    taper_angle: float = 0.0
    tip_angle: float = 0.0
    flute_length: float = 0.0
    upper_radius: float = 0.0


@dataclass(frozen=True, slots=True)
class Frame:
    """A right-handed coordinate system: origin in mm, X and Y as unit vectors, all in the CAM's absolute system."""

    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    x: tuple[float, float, float] = (1.0, 0.0, 0.0)
    y: tuple[float, float, float] = (0.0, 1.0, 0.0)

    def matrix(self) -> Floats:
        """(3, 3) float64: columns are X, Y, Z of this frame in the absolute system."""
        x, y = np.array(self.x), np.array(self.y)
        return np.column_stack((x, y, np.cross(x, y)))


@dataclass(frozen=True, slots=True, eq=False)
class Operation:
    """One tool path: its tool, its frame, its motion and what happens on the way."""

    name: str
    tool: Tool
    frame: Frame
    moves: Moves
    arcs: Arcs
    events: tuple[Event, ...]
    line: int
    intol: float | None = None
    outtol: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Toolpath:
    """A CL file, read: its operations in order, and what was noticed while reading. ``unit``: of its lengths, mm."""

    file: str
    operations: tuple[Operation, ...]
    part: str = ""
    remarks: tuple[Problem, ...] = field(default=())
    unit: float = 1.0
