"""A toolpath: what the cutter does, in workpiece coordinates.

Motion is columns, a row for each CL point. Events are frozen records with the row before which they happen, and a line.

Units: mm, degrees, mm/min or mm/rev, unit vectors. Frame: the operation's own (``Operation.frame``, MSYS in a CLSF).
"""

from collections.abc import Callable
from dataclasses import field
from enum import IntEnum, StrEnum
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines, make_read_only
from trunnion.errors import Problem
from trunnion.messages import Wording, foreign
from trunnion.model.clamping import Clamping
from trunnion.model.splines import Splines
from trunnion.records import dataclass
from trunnion.results import Figure


class Kind(IntEnum):
    """How the tip moves to a row from the row before it."""

    RAPID = 0
    LINEAR = 1
    ARC = 2


class Phase(IntEnum):
    """The role of a move in its operation, which CAM systems write as a colour."""

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
    feed     (n,)   float64   mm/min, or mm/rev where ``per_rev``; NaN before the first FEDRAT; rapids keep the last one
    per_rev  (n,)   bool      feed is per spindle revolution
    line     (n,)   int32     line of the CL file, from 1
    normal   (n, 3) float64   unit vector out of the surface where the tool touches it, NaN if not known; None if the
                              normals were not read
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
        make_read_only(self.tip, self.axis, self.kind, self.phase, self.feed, self.per_rev, self.line, self.normal)

    def __len__(self) -> int:
        return len(self.tip)

    def select(self, rows: slice | Ints | Flags) -> "Moves":
        """Return the given rows; ``rows`` is a slice, row numbers or flags."""
        return Moves(
            self.tip[rows], self.axis[rows], self.kind[rows], self.phase[rows], self.feed[rows], self.per_rev[rows],
            self.line[rows], None if self.normal is None else self.normal[rows],
        )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Arcs:
    """The arcs of one operation, one entry for each row of ``Moves`` whose kind is ARC, in row order.

    row         (m,)   int64     row of the end point
    centre      (m, 3) float64   mm
    normal      (m, 3) float64   unit vector; the tip turns about it by the right-hand rule
    radius      (m,)   float64   mm
    full_turns  (m,)   int64     whole turns in addition to the arc from start to end; 0 for a full circle (start = end)
    """

    row: Ints
    centre: Floats
    normal: Floats
    radius: Floats
    full_turns: Ints

    def __post_init__(self) -> None:
        make_read_only(self.row, self.centre, self.normal, self.radius, self.full_turns)

    @staticmethod
    def empty() -> "Arcs":
        """No arcs."""
        return Arcs(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0, np.int64))


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens before row ``row``; after the last row if ``row == n``."""

    row: int
    line: int


class Sense(StrEnum):
    """Direction of rotation of the spindle, by its CL word."""

    CLW = "CLW"
    CCLW = "CCLW"


@dataclass(frozen=True, slots=True)
class LoadTool(Event):
    """Load a tool into the spindle. ``adjust`` is the length register, 0 if none is given."""

    number: int
    adjust: int = 0


@dataclass(frozen=True, slots=True)
class SelectTool(Event):
    """Bring a tool to the changer, to be loaded next."""

    number: int


@dataclass(frozen=True, slots=True)
class SpindleOn(Event):
    """Turn the spindle on, rev/min; ``stated``: by a setting; ``surface``: of m/min at a diameter in mm."""

    rpm: float
    sense: Sense = Sense.CLW
    stated: bool = False
    surface: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class SpindleOff(Event):
    """Stop the spindle."""


@dataclass(frozen=True, slots=True)
class Coolant(Event):
    """Coolant by its CL word: ON, FLOOD, MIST, TAP, THRU, AIR or OFF."""

    kind: str


@dataclass(frozen=True, slots=True)
class CutterComp(Event):
    """Cutter radius compensation: ``side`` is LEFT, RIGHT, ON or OFF.

    plane, register  XYPLAN, ZXPLAN, YZPLAN or empty; 0 if none is given
    contour   the points behind it are those of the contour, and the control adds the radius; else of the tool's centre
    """

    side: str
    plane: str = ""
    register: int = 0
    contour: bool = False


@dataclass(frozen=True, slots=True)
class Dwell(Event):
    """Wait for ``amount`` seconds or spindle revolutions."""

    amount: float
    revolutions: bool = False


@dataclass(frozen=True, slots=True)
class Stop(Event):
    """Program stop; an optional one only if the operator has switched it on."""

    optional: bool
    text: str = ""


@dataclass(frozen=True, slots=True)
class Message(Event):
    """Text in the program (PPRINT), or on the display of the control (DISPLY)."""

    text: str
    display: bool = False


@dataclass(frozen=True, slots=True)
class Insert(Event):
    """Text for the NC program, letter by letter; ``template`` is that of the shop it comes from, if it does."""

    text: str
    template: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class RewindMessage(Message):
    """The remark of a rewind, which the planner has put into the path."""


@dataclass(frozen=True, slots=True)
class ShopStatement(Event):
    """A statement of which the definition of the machine has a template.

    text     as it stands in the CL file, without its word
    word, words  its word; its values that are words
    numbers  its values that are numbers
    """

    text: str
    word: str
    words: tuple[str, ...] = ()
    numbers: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class BlockSkip(Event):
    """Optional block skip on or off."""

    on: bool


@dataclass(frozen=True, slots=True)
class CycleOn(Event):
    """Begin a modal hole-making cycle; each following row is a hole until ``CycleOff``.

    mode     minor words before the first couplet, such as ("DRILL", "DEEP")
    values   couplets of a word and its numbers, lengths in mm, such as ("RAPTO", (3.0,))
    words    words without numbers, with the word that follows or "", such as ("RTRCTO", "AUTO")
    """

    mode: tuple[str, ...]
    values: tuple[tuple[str, tuple[float, ...]], ...]
    words: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class CycleOff(Event):
    """End the modal cycle."""


@dataclass(frozen=True, slots=True)
class From(Event):
    """Position in which the path begins; not a motion."""

    tip: tuple[float, float, float]
    axis: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class GoHome(Event):
    """Move to the machine's home (GOHOME without a point; with a point it is a rapid row)."""


@dataclass(frozen=True, slots=True)
class SetMode(Event):
    """SET, MODE or MULTAX, with its words."""

    words: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class UnknownStatement(Event):
    """A statement that is not known, or some of whose words are not: what is known of it are events of their own.

    words  those of ``text``, as the CL file has it, that are not known; none if all of the statement is not
    what   why, for messages; ``meant``: the words that it may be, damaged or in one line
    acts   it may move or switch something: no program is made without it
    """

    text: str
    words: tuple[str, ...] = field(default=(), compare=False)
    what: Wording = field(default=foreign(""), compare=False)
    acts: bool = field(default=True, compare=False)
    meant: tuple[str, ...] = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Tool:
    """The cutter, mm and degrees; 0 is a size that nothing states.

    kind           its form in TLDATA: MILL, TCUTTER, BARREL, DRILL or UNKNOWN
    length         of the cutter itself
    taper_angle    of its side from the axis
    tip_angle      whole angle of a drill's tip; of a mill, that of its bottom from the horizontal
    upper_radius   second corner radius of a TCUTTER or a BARREL
    holder         what the CL file calls its holder
    extension      how far it stands out of the holder
    set_length     its length in the spindle as the tool change states it
    corner_centre  distance of the corner's centre from the axis, negative beyond it, and its height above the tip;
                   None: not stated, or that of a corner that touches a level bottom and an upright side
    upper_centre   the same of the second corner
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
    holder: str = ""
    extension: float = 0.0
    set_length: float = 0.0
    corner_centre: tuple[float, float] | None = None
    upper_centre: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Frame:
    """A right-handed coordinate system: origin in mm, X and Y as unit vectors, all in the CAM's absolute system."""

    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    x: tuple[float, float, float] = (1.0, 0.0, 0.0)
    y: tuple[float, float, float] = (0.0, 1.0, 0.0)

    @property
    @Figure()
    def z(self) -> tuple[float, ...]:
        """Z as a unit vector."""
        return tuple(np.cross(self.x, self.y).tolist())

    def matrix(self) -> Floats:
        """(3, 3) float64: columns are X, Y, Z of this frame in the absolute system."""
        return np.column_stack((self.x, self.y, self.z))


@dataclass(frozen=True, slots=True, eq=False)
class Operation:
    """One tool path: its tool, coordinate system, moves and events; ``line`` is that of its TOOL PATH in ``file``.

    ``splines`` are those for which rows of ``moves`` stand; ``joined`` names operations that it goes on with;
    ``work_offset`` counts those of the control from 1, 0: not stated.
    """

    name: str
    tool: Tool
    frame: Frame
    moves: Moves
    arcs: Arcs
    events: tuple[Event, ...]
    line: int
    intol: float | None = None
    outtol: float | None = None
    file: str = ""
    splines: Splines = field(default_factory=Splines.empty)
    joined: tuple[str, ...] = ()
    work_offset: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Toolpath:
    """The content of a CL file.

    file, reopen  its path, in an archive with the name there, or ``stdin``; opens a packed text or a stream again
    operations, part, remarks  in the order of the file; name of the part; warnings of the reader
    unit, states_unit  length unit of the file, mm; the file says it, or its feeds do: else mm are assumed
    dialect, recognized_by  a key of ``trunnion.cl.dialects.DIALECTS``; its title, and by what it was recognized
    system      of the points, in that of the model, where the file gives it and its meaning is open: 3 rows of 4, mm
    states_system  each operation states where its coordinate system lies in the absolute one of the CAM system
    clamping, stock  as comments in the head say, or None; as ``--stock`` takes it, in the absolute system, or empty
    """

    file: str
    operations: tuple[Operation, ...]
    part: str = ""
    remarks: tuple[Problem, ...] = field(default=())
    unit: float = 1.0
    states_unit: bool = True
    dialect: str = "clsf"
    recognized_by: Wording = field(default=foreign(""))
    system: tuple[float, ...] = ()
    states_system: bool = True
    clamping: Clamping | None = None
    stock: str = ""
    reopen: Callable[[], BinaryIO] | None = None

    @property
    def recognized(self) -> str:
        """The title of the dialect, and by what it was recognized."""
        return str(self.recognized_by)

    def __repr__(self) -> str:
        """Return what matters in a notebook: the columns would fill pages."""
        points = sum(len(operation.moves) for operation in self.operations)
        return f"Toolpath({self.file!r}, {len(self.operations)} operations, {points} points)"
