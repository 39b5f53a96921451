"""What the user asks of a plan, and what the control can do.

Both are values only: nothing here knows a control by name, and nothing reads a setting.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import field
from functools import partial
from typing import Final, TypeAlias

from trunnion.messages import Wording
from trunnion.model.axis_tolerance import AxisTolerance
from trunnion.model.motion import MachiningMode, PoleStrategy
from trunnion.model.splines import Spline
from trunnion.planning.holes.cycles import Cycle, SpindleState
from trunnion.planning.retracts.clearance import Clearance
from trunnion.records import dataclass

#: Tolerance of the tool axis between CL points without TCP, degrees, unless the user sets another.
AXIS_TOLERANCE_WITHOUT_TCP: Final = 0.05

#: Takes a cycle and the spindle at its holes (None: it stands still). Returns why the control has no such cycle; None
#: if it has one.
CycleObjection: TypeAlias = Callable[[Cycle, SpindleState | None], Wording | None]


@dataclass(frozen=True, slots=True, eq=False)
class PlanOptions:
    """What the user asks of a plan.

    mode                 machining mode of every operation; None: by the rule of ``trunnion.planning.machining_mode``
    mode_by_operation    the same for single operations, by name; takes precedence over ``mode``
    absolute_frame       the program's coordinate system is the CAM's absolute one, not that of the first operation
    tcp                  simultaneous operations are made with TCP; False: slide positions are written, or
    m114                 tips, which the control reaches at the ends of blocks alone
    holes_as_motion      holes are made as motion even if the control has a cycle for them
    allow_rewinds        insert a retract where a rotary axis must rewind in the cut; False: refuse the program
    clearance            how far the tool retracts along its axis for a rewind
    reengage_feed_share  share of the feed at which the tool returns to the cut after a rewind
    pole_strategy        what is done near the pole where a rotary axis would have to be too fast
    pole_angle           the most the tool axis may lean for that, degrees
    lower_feed           lower the feed where a rotary axis would have to be too fast
    fastest_feed         feeds will be those that the axes reach: motions say to which row of its CL file each of their
                         rows leads
    feed_limit           greatest feed of cuts then, in place of those of the CL files, mm/min; None: theirs
    tip_tolerance        without TCP: how far the tip may leave its line between CL points, mm
    axis_tolerance       how far the tool axis may leave its great circle between CL points, degrees; None: with TCP
                         ``default_axis_tolerance``, without TCP ``AXIS_TOLERANCE_WITHOUT_TCP``
    default_axis_tolerance  that of the control's definition
    explain              record decisions and their reasons, what the nearest neighbour would have done, and where a
                         rotary axis is too fast
    """

    mode: MachiningMode | None = None
    mode_by_operation: Mapping[str, MachiningMode | None] = field(default_factory=dict)
    absolute_frame: bool = False
    tcp: bool = True
    m114: bool = False
    holes_as_motion: bool = False
    allow_rewinds: bool = True
    clearance: Clearance = field(default_factory=partial(Clearance, 50.0))
    reengage_feed_share: float = 0.5
    pole_strategy: PoleStrategy = PoleStrategy.OFF
    pole_angle: float = 0.1
    lower_feed: bool = False
    fastest_feed: bool = False
    feed_limit: float | None = None
    tip_tolerance: float = 0.005
    axis_tolerance: float | None = None
    default_axis_tolerance: AxisTolerance = field(default_factory=AxisTolerance)
    explain: bool = False

    def mode_for(self, operation: str) -> MachiningMode | None:
        """Return the mode requested for the operation of this name; None: by the rule."""
        return self.mode_by_operation.get(operation, self.mode)

    @property
    def simultaneous_mode(self) -> MachiningMode:
        """How an operation with a changing tool axis is made."""
        if self.tcp:
            return MachiningMode.TCP
        return MachiningMode.M114 if self.m114 else MachiningMode.WITHOUT_TCP

    @property
    def axis_tolerance_between_points(self) -> float:
        """How far the tool axis may leave its great circle between CL points, degrees; infinite: as by default."""
        if self.axis_tolerance is not None:
            return self.axis_tolerance
        return math.inf if self.tcp else AXIS_TOLERANCE_WITHOUT_TCP


def _supports_every_cycle(cycle: Cycle, spindle: SpindleState | None) -> Wording | None:
    return None


def _takes_every_spline(spline: Spline) -> bool:
    return True


@dataclass(frozen=True, slots=True, eq=False)
class ControlCapabilities:
    """What the control can be told; by default everything.

    modes                 machining modes that it has words for
    mode_remedies         what would add a mode that it lacks, as the cure of a message
    negligible_tilt       sine of the largest tilt that rotary words print as zero
    only_arcs_about_z     it takes arcs about Z only
    helices               it takes arcs that rise; False: they become lines
    helices_by_angle      it takes a helix by centre and angle, not by its end
    multi_turn_arcs       it takes arcs of more than one turn; False: they become one arc a turn
    arcs_with_tcp         it takes arcs while TCP is on; False: they become lines
    planes_from_pose      it takes a tilted plane from the rotary positions: arcs there must turn about the tool axis
    plane_x_from_machine  X of a tilted plane is that of the machine after turning, unless the CL file gives an X
    turns_between_holes   the tool axis may change between holes of one cycle with TCP: no plane for each axis is needed
    cycle_objection       why it has no cycle for a hole
    takes_spline          whether it takes a spline; others become lines
    """

    modes: frozenset[MachiningMode] = frozenset(MachiningMode)
    mode_remedies: Mapping[MachiningMode, str] = field(default_factory=dict)
    negligible_tilt: float = 0.0
    only_arcs_about_z: bool = False
    helices: bool = True
    helices_by_angle: bool = False
    multi_turn_arcs: bool = True
    arcs_with_tcp: bool = True
    planes_from_pose: bool = False
    plane_x_from_machine: bool = False
    turns_between_holes: bool = False
    cycle_objection: CycleObjection = _supports_every_cycle
    takes_spline: Callable[[Spline], bool] = _takes_every_spline
