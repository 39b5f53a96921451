"""The planner's result: motions on a machine, with problems and decisions."""

from dataclasses import field
from enum import StrEnum
from typing import Annotated

from trunnion.arrays import Floats, Ints, make_read_only
from trunnion.errors import Problem, Severity
from trunnion.messages import Wording
from trunnion.model.arcs import with_closed_turns
from trunnion.model.deviations import Deviations
from trunnion.model.frames import into_plane
from trunnion.model.toolpath import Frame, Operation
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure


class PoleStrategy(StrEnum):
    """What is done near the pole where a rotary axis would have to be too fast.

    ``trunnion.planning.pole.tool_axis_lean`` describes the strategies.
    """

    OFF = "off"
    HOLD = "hold"
    SPREAD = "spread"
    LEAN = "lean"


class MachiningMode(StrEnum):
    """How the machine makes an operation; values are words for messages.

    With M114 blocks hold tips, as with TCP, and the axes go straight between their ends, as without it.
    """

    THREE_AXIS = "three-axis"
    TILTED = "tilted plane"
    TCP = "TCP"
    WITHOUT_TCP = "without TCP"
    M114 = "M114"

    @property
    def is_simultaneous(self) -> bool:
        """Whether the tool axis may change within a cut."""
        return self in (MachiningMode.TCP, MachiningMode.WITHOUT_TCP, MachiningMode.M114)

    @property
    def goes_straight(self) -> bool:
        """Whether the axes go straight between the ends of blocks, while rotary ones turn."""
        return self in (MachiningMode.WITHOUT_TCP, MachiningMode.M114)

    @property
    def holds_tips(self) -> bool:
        """Whether X, Y and Z of blocks are the tip while rotary axes turn."""
        return self in (MachiningMode.TCP, MachiningMode.M114)


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """One operation, or a part of one, on the machine.

    operation         in the program's coordinate system (workpiece frame), with lines for arcs that the control cannot
                      take
    rotary            (n, 2) float64  displayed positions of the rotary axes, degrees, in the order of
                      ``machine.rotary``. The linear axes follow from them and the tip:
                      ``trunnion.machines.slide_positions``
    plane             in the mode TILTED the plane, seen from the program's coordinate system; its Z is the tool axis
    deviations        where it differs from its CL file
    starts_operation  False: it continues the operation of the motion before, in another plane or from home
    ends_in_hole      its last row is in a hole, so the tool retracts no farther than the cycle says
    cl_rows           (n,) int64  the row of the CL file's operation that each row leads to; -1: it is none of its
                      way. None: nobody asked for it
    """

    operation: Operation
    rotary: Floats
    mode: MachiningMode
    plane: Frame | None = None
    deviations: Deviations = field(default_factory=Deviations.none)
    starts_operation: bool = True
    ends_in_hole: bool = False
    cl_rows: Ints | None = None

    def __post_init__(self) -> None:
        make_read_only(self.rotary)

    @property
    def three_axis(self) -> bool:
        """Whether the tool axis is +Z of the program throughout."""
        return self.mode is MachiningMode.THREE_AXIS

    def as_written(self) -> Operation:
        """Return the operation in the coordinates of its blocks: those of the tilted plane, or else the program's."""
        placed = self.operation if self.plane is None else into_plane(self.operation, self.plane)
        return with_closed_turns(placed)


class DecisionTopic(StrEnum):
    """What a decision is about."""

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
    HOOKS = "hooks"


@dataclass(frozen=True, slots=True)
class Decision:
    """What the planner decided before a row, and why; ``text`` in English.

    line  of the CL file
    row   of the operation, in which arcs that became lines count as several; -1: it is about the whole operation
    """

    file: Annotated[str, Figure("cl_file", none="", after="operation")]
    operation: str
    line: Annotated[int, Figure("cl_line", none=0, after="cl_file")]
    row: Annotated[int, NOT_DATA]
    topic: Annotated[DecisionTopic, Figure("about")]
    said: Annotated[Wording, Figure("text", take=str)]

    @property
    def text(self) -> str:
        """What was decided, and why, in words."""
        return str(self.said)

    def __str__(self) -> str:
        """Return ``file:line: operation: text``."""
        return f"{self.file}:{self.line}: {self.operation}: {self.text}"


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The motions of one program, with problems and decisions.

    A problem of severity error means that the program must not run as it is.
    """

    motions: tuple[Motion, ...]
    problems: tuple[Problem, ...]
    decisions: tuple[Decision, ...] = ()

    def __repr__(self) -> str:
        """Return what matters in a notebook: the columns would fill pages."""
        errors = sum(problem.severity is Severity.ERROR for problem in self.problems)
        return f"Plan({len(self.motions)} motions, {errors} errors, {len(self.problems) - errors} warnings)"
