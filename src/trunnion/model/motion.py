"""What the planner hands on."""

from dataclasses import dataclass, field
from enum import StrEnum

from trunnion.arrays import Floats
from trunnion.errors import Problem
from trunnion.model.deviations import Deviations
from trunnion.model.frames import into_plane
from trunnion.model.toolpath import Frame, Operation


class PoleStrategy(StrEnum):
    """What is done near the pole where a rotary axis would have to be too fast
    (``trunnion.planning.pole.tool_axis_lean``)."""

    OFF = "off"
    HOLD = "hold"
    SPREAD = "spread"
    LEAN = "lean"


class MachiningMode(StrEnum):
    """How the machine makes an operation."""

    THREE_AXIS = "three-axis"
    TILTED = "tilted plane"
    TCP = "TCP"
    WITHOUT_TCP = "without TCP"


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """One operation on the machine.

    operation    the operation in the program's coordinate system (workpiece frame), with arcs that the control is not
                 to be given as arcs turned into lines
    rotary       (n, 2) float64   positions of the rotary axes, degrees, in the order of ``machine.rotary`` and in the
                 range that each displays. The slides follow from them and the tip:
                 ``trunnion.machines.slide_positions``
    mode         three-axis: the tool axis is +Z of the program's coordinate system throughout
    plane        the tilted plane as seen from the program's coordinate system, for that mode only. Its Z is the tool
                 axis
    deviations   where it is not made as its CL file has it
    begins       False: it goes on with the operation of the motion before it, in another plane or from home
    in_hole      its last row is that of a hole: the tool is drawn back no farther than its cycle says
    """

    operation: Operation
    rotary: Floats
    mode: MachiningMode
    plane: Frame | None = None
    deviations: Deviations = field(default_factory=Deviations.none)
    starts_operation: bool = True
    ends_in_hole: bool = False

    def __post_init__(self) -> None:
        self.rotary.setflags(write=False)

    @property
    def three_axis(self) -> bool:
        """Whether the rotary axes stand still at the program's own coordinate system."""
        return self.mode is MachiningMode.THREE_AXIS

    def as_written(self) -> Operation:
        """The operation in the coordinates of its blocks: those of the tilted plane, or else the program's."""
        return self.operation if self.plane is None else into_plane(self.operation, self.plane)


class DecisionTopic(StrEnum):
    """What a decision was about."""

    START = "start"
    POLE = "pole"
    CHANGE = "change"
    REWIND = "rewind"
    SPEED = "speed"
    FEED = "feed"
    MORE = "more"
    POINTS = "points"
    HOLES = "holes"
    NEAREST = "nearest"


@dataclass(frozen=True, slots=True)
class Decision:
    """What was decided before a row, and the reason for it, in words.

    row   row of the operation as the CL file has it, arcs that became lines counted; -1: about all of it
    line  line of the CL file
    """

    file: str
    operation: str
    line: int
    row: int
    topic: DecisionTopic
    text: str

    def __str__(self) -> str:
        """Return ``file:line: operation: text``."""
        return f"{self.file}:{self.line}: {self.operation}: {self.text}"


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """All operations of one program, what speaks against running them, and why they are planned as they are.

    ``problems`` with severity error mean that the program must not run as it is.
    """

    motions: tuple[Motion, ...]
    problems: tuple[Problem, ...]
    decisions: tuple[Decision, ...] = ()
