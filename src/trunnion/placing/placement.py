"""What is found about the place of a part."""

from collections.abc import Callable, Mapping
from dataclasses import field
from operator import attrgetter
from typing import Annotated, ClassVar

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem
from trunnion.machines.machine import Vector
from trunnion.messages import Wording, foreign, texts
from trunnion.model.clamping import Clamping
from trunnion.model.toolpath import Toolpath
from trunnion.placing.region import Region
from trunnion.placing.table_limits import ClampingArea
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure


@dataclass(frozen=True, slots=True)
class Limit:
    """A limit, and where a linear axis comes nearest to it.

    axis       its name, or ``table``
    end        ``low`` or ``high``; of the table the edge: ``low X``, ``high X``, ``low Y``, ``high Y`` or ``rim``
    limit_mm   the limit; of the table where that edge is, of its rim the diameter
    file, line  a CL file or an NC program, and its line; empty and 0 for limits of the table
    operation   its name; empty where it has none
    """

    axis: str
    end: str
    limit_mm: float
    file: str
    line: int
    operation: str = ""


@dataclass(frozen=True, slots=True)
class AxisUse:
    """How a linear axis uses its travel at a place.

    axis                   its name
    least_mm, greatest_mm  how far it goes, mm
    margin_mm              what is left to the nearer of its limits; infinite without limits
    low, high              where it goes farthest, with the limits
    """

    axis: str
    least_mm: float
    greatest_mm: float
    margin_mm: float
    low: Limit
    high: Limit


@dataclass(frozen=True, slots=True)
class RotaryUse:
    """How a rotary axis uses its travel at a place.

    axis                     its name
    least_deg, greatest_deg  how far it goes, degrees
    margin_deg               what is left to the nearer of its limits; infinite without limits
    low_deg, high_deg        the limits
    """

    axis: str
    least_deg: float
    greatest_deg: float
    margin_deg: float
    low_deg: float
    high_deg: float


@dataclass(frozen=True, slots=True)
class BodyDistance:
    """Two bodies where they are nearest to each other.

    distance_mm  0: they touch
    between      their names
    file, line   a CL file or an NC program, and its line
    operation    its name; empty where it has none
    """

    distance_mm: float
    between: tuple[str, str]
    file: str
    line: int
    operation: str = ""

    @property
    def touches(self) -> bool:
        """Whether the bodies touch."""
        return self.distance_mm <= 0.0


@dataclass(frozen=True, slots=True)
class PartPlace:
    """A place of the part, and what it leaves the linear axes.

    zero_mm    of the workpiece, machine frame, all axes at zero
    turn_deg   of the part about Z, right-handed
    tilt_deg   of the part about X of the program's coordinate system, right-handed: the first of the two
    margin_mm  of the linear axis that is nearest to a limit; negative beyond it, or where something is beyond the table
    value      of the goal: mm of margin, mm or degrees of travel, seconds, blocks; None: the goal has none here
    axes       of all linear axes
    rotary     of the rotary axes
    planned_s  with the goal ``time``: seconds of the rows by the planner of speeds, with accelerations and jerks
    table_mm   what stock and part, seen from above, have left to the edge of the table; negative beyond it; None: not
               judged
    nearest    of bodies whose distance the place or the turn changes the two that come nearest to each other; None:
               none were given
    """

    zero_mm: Vector
    turn_deg: float
    margin_mm: float
    axes: Annotated[tuple[AxisUse, ...], Figure(after="nearest")]
    value: float | None = None
    tilt_deg: Annotated[float, Figure(after="turn_deg")] = 0.0
    rotary: Annotated[tuple[RotaryUse, ...], Figure(after="axes")] = ()
    planned_s: float | None = None
    table_mm: float | None = None
    nearest: BodyDistance | None = None

    @property
    def fits(self) -> bool:
        """Whether every linear axis keeps its limits, and what stands on the table stays on it."""
        return self.margin_mm >= 0.0


@dataclass(frozen=True, slots=True)
class TurnMargin:
    """What a turn of the part allows, after a tilt.

    margin_mm  the largest one of any place; None: some row is out of reach of the rotary axes, or the table is too
               small, as ``obstacle`` says
    zero_mm    the best place there
    why        why there is none; says nothing where there is one. ``obstacle`` is that in English
    value      of the goal there, as in ``PartPlace``
    is_asked   it is one of those that were asked for; else it was tried between them, around the best
    table_is_too_small  that is the obstacle
    """

    turn_deg: float
    margin_mm: float | None
    zero_mm: Vector | None = None
    why: Annotated[Wording, Figure("obstacle", after="value", take=str)] = field(default=foreign(""))
    value: float | None = None
    tilt_deg: Annotated[float, Figure(after="turn_deg")] = 0.0
    is_asked: Annotated[bool, Figure("asked", after="tilt_deg")] = True
    table_is_too_small: Annotated[bool, NOT_DATA] = False

    @property
    def obstacle(self) -> str:
        """Why there is none; empty where there is one."""
        return str(self.why)

    @property
    @Figure(after="asked")
    def fits(self) -> bool:
        """Whether the part fits somewhere."""
        return self.margin_mm is not None and self.margin_mm >= 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Where a part may sit on a machine.

    machine   key of the machine
    files     what was placed
    goal      what the best place is best for
    best      the best place; where the part fits nowhere, that with the least excess; None: no turn is within reach
    limits    what keeps its margin from growing, the heaviest first; with other goals than ``margin`` the limits that
              are nearest at the best place; where it does not fit, what conflicts
    present   the place of the definition or of the arguments; None: neither states one
    turns     what each turn allows, in order; those of the grid and those around the best
    between_mm  how far linear axes may go beyond that between rows where rotary axes turn
    remarks   what was assumed, or cannot be judged
    toolpaths  of CL files; empty for NC programs
    clamping  how the part is clamped, as the files state; turns and tilts come after that. None: they state nothing
    tool_length_mm    of the tool that linear axes keep their limits with; None: it is not known
    tool_lengths_mm   of tools that have lengths of their own, by number or name, as they were stated
    nearest_anywhere  of bodies whose distance no place and no turn changes, such as tool and fixture, the nearest two
    left_out  names of pairs of bodies that are not judged: at home they overlap, on one side of the machine
    table     of the machine's definition; None: it states none
    unmeasured    values of the definition that the place stands on, though nobody has measured them
    most_distance_mm  with the goal ``collisions``: at no turn that was tried a place keeps the others farther apart
    """

    SCHEMA: ClassVar[int] = 2
    DECIMALS: ClassVar[int] = 6

    machine: str
    files: tuple[str, ...]
    goal: str
    best: PartPlace | None
    limits: Annotated[tuple[Limit, ...], Figure(after="present")]
    present: PartPlace | None
    turns: tuple[TurnMargin, ...]
    between_mm: float = 0.0
    remarks: Annotated[tuple[Problem, ...], Figure(after="left_out")] = ()
    toolpaths: Annotated[tuple[Toolpath, ...], NOT_DATA] = ()
    clamping: Annotated[
        Clamping | None,
        Figure("turn_deg", take=attrgetter("turn"), within="stated"),
        Figure("tilt_deg", take=attrgetter("tilt"), within="stated"),
    ] = None
    tool_length_mm: Annotated[float | None, NOT_DATA] = None
    tool_lengths_mm: Annotated[Mapping[str, float], NOT_DATA] = field(default_factory=dict)
    nearest_anywhere: BodyDistance | None = None
    most_distance_mm: float | None = None
    left_out: tuple[tuple[str, str], ...] = ()
    table: Annotated[ClampingArea | None, Figure(after="region")] = None
    unmeasured: Annotated[tuple[Wording, ...], Figure("not_measured", take=texts, after="remarks")] = ()
    _find_region: Callable[[], Region | None] = field(default=lambda: None, repr=False)
    _margin_at: Callable[[Floats, float, float], float] = field(default=lambda *_: np.nan, repr=False)

    @property
    def not_measured(self) -> tuple[str, ...]:
        """The values that nobody has measured, in words."""
        return texts(self.unmeasured)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The name of ``remarks`` before, which goes with the next version."""
        return self.remarks

    @property
    @Figure(after="turns")
    def region(self) -> Region | None:
        """The places at the turn of the best one; None: it fits nowhere. Worked out when first asked for."""
        return self._find_region()

    @property
    @Figure(after="goal")
    def fits(self) -> bool:
        """Whether the part fits somewhere, with the goal ``collisions`` so that nothing touches."""
        return self.best is not None and self.best.fits and not (self.goal == "collisions" and self.touching)

    @property
    def nearest(self) -> BodyDistance | None:
        """At the best place the two bodies that come nearest to each other; None: none were given."""
        own = None if self.best is None else self.best.nearest
        found = [each for each in (own, self.nearest_anywhere) if each is not None]
        return min(found, key=lambda each: each.distance_mm, default=None)

    @property
    @Figure(after="clamped")
    def distance_mm(self) -> float | None:
        """How far they are apart."""
        return None if self.nearest is None else self.nearest.distance_mm

    @property
    def touching(self) -> BodyDistance | None:
        """Two bodies that touch at the best place; None: none do."""
        return self.nearest if self.nearest is not None and self.nearest.touches else None

    @property
    def zero_mm(self) -> Vector | None:
        """The workpiece zero of the best place, machine frame, all axes at zero."""
        return None if self.best is None else self.best.zero_mm

    @property
    def turn_deg(self) -> float | None:
        """The turn of the best place about Z, right-handed."""
        return None if self.best is None else self.best.turn_deg

    @property
    def tilt_deg(self) -> float | None:
        """The tilt of the best place about X, right-handed; it comes before the turn."""
        return None if self.best is None else self.best.tilt_deg

    @property
    @Figure("turn_deg", take=attrgetter("turn"), within="clamped", after="stated")
    @Figure("tilt_deg", take=attrgetter("tilt"), within="clamped")
    def clamped(self) -> Clamping | None:
        """How the part is clamped against its drawing at the best place, as far as the files state it."""
        return None if self.best is None else (self.clamping or Clamping()).then(self.best.turn_deg, self.best.tilt_deg)

    @property
    def margin_mm(self) -> float | None:
        """The margin of the best place; negative: how far it is from fitting."""
        return None if self.best is None else self.best.margin_mm

    @property
    def seconds(self) -> float | None:
        """With the goal ``time`` that of the best place, as the planner of speeds has it."""
        return None if self.best is None else self.best.planned_s

    @property
    @Figure(after="limits")
    def share_of_turns(self) -> float:
        """Of the turns and tilts that were asked for, those at which the part fits somewhere, 0 to 1."""
        asked = [turn for turn in self.turns if turn.is_asked]
        return sum(turn.fits for turn in asked) / max(len(asked), 1)

    def margin_at(self, zero_mm: Vector, turn_deg: float, tilt_deg: float = 0.0) -> float:
        """Return the margin of any place, exact.

        Minus infinity where rotary axes do not reach the path, or the table is too small.
        """
        return self._margin_at(np.array(zero_mm, np.float64), float(turn_deg), float(tilt_deg))
