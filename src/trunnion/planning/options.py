"""What whoever asks for a program may wish of its planning."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

from trunnion.model.motion import MachiningMode, PoleStrategy
from trunnion.planning.holes.cycles import Cycle, SpindleState
from trunnion.planning.retracts.clearance import Clearance

#: How far the tool axis may be off between CL points without TCP, degrees, unless something else is asked.
AXIS_WITHOUT_TCP: Final = 0.05


def _never(cycle: Cycle, spindle: SpindleState | None) -> str:
    """Nothing is unsaid."""
    return ""


@dataclass(frozen=True, slots=True)
class PlanOptions:
    """What is asked of a plan, and what the control can do, with defaults.

    rewind          insert retreats where an axis must wind back in the cut; False: refuse the program
    clearance       how far the tool draws back along its axis for that
    engage          share of the feed with which it comes back
    explain         write the log: what was decided and why, what the nearest neighbour would have done, where a rotary
                    axis is too fast
    manner          how every operation is to be made, whatever the rule says; None: by the rule
    own_manner      the same for operations by their names; this is stronger
    manners         those that the control has words for
    level           sine of a tilt that the control's rotary words print as none
    cures           what would give it words for one that it lacks
    arcs_about_z    the control knows arcs about Z only
    machine_x       X of a tilted plane is that of the machine once it has turned, unless the CL file has an own one
    pole            what is done near the pole where a rotary axis would have to be too fast
    pole_angle      by how much the tool axis may lean for that, degrees
    absolute        the program's coordinate system is the CAM's absolute one, not that of the first operation
    lower_feed      lower the feed where a rotary axis would have to be too fast
    helices_by_angle  the control is told a helix by its centre and its angle, and not by its end
    helices         the control takes circles that rise, or of more than one turn; False: they become lines
    turns           the control takes circles and helices of more than one turn; False: they become lines
    arcs_with_tcp   the control takes circles while it holds the tip; False: they become lines
    pose_planes     the control takes a tilted plane from the rotary position: only circles about the tool axis stay
                    circles there
    turns_between_holes  where the tool axis changes between holes, they are not made in planes
    tcp             the control holds the tip (TCP); False: the slides and rotary axes themselves are led
    tip_tolerance   without TCP: how far the tip may be off its line between CL points, mm
    unsaid          why the control has no cycle for a hole, with the spindle as it turns there; empty where it has one
    holes_as_motion  holes are made as motion even where the control has a cycle
    axis_tolerance  how far the tool axis may be off its great circle between CL points, degrees; None: with TCP it is
                    not looked at, without TCP it is ``AXIS_WITHOUT_TCP``
    """

    allow_rewinds: bool = True
    clearance: Clearance = field(default_factory=partial(Clearance, 50.0))
    reengage_feed_share: float = 0.5
    explain: bool = False
    mode: MachiningMode | None = None
    mode_by_operation: Mapping[str, MachiningMode | None] = field(default_factory=dict)
    modes: frozenset[MachiningMode] = frozenset(MachiningMode)
    negligible_tilt: float = 0.0
    mode_remedies: Mapping[MachiningMode, str] = field(default_factory=dict)
    only_arcs_about_z: bool = False
    helices_by_angle: bool = False
    plane_x_from_machine: bool = False
    absolute_frame: bool = False
    pole_strategy: PoleStrategy = PoleStrategy.OFF
    pole_angle: float = 0.1
    lower_feed: bool = False
    helices: bool = True
    multi_turn_arcs: bool = True
    arcs_with_tcp: bool = True
    planes_from_pose: bool = False
    turns_between_holes: bool = False
    tcp: bool = True
    tip_tolerance: float = 0.005
    unsupported_cycle_reason: Callable[[Cycle, SpindleState | None], str] = _never
    holes_as_motion: bool = False
    axis_tolerance: float | None = None

    def for_operation(self, operation: str) -> "PlanOptions":
        """The options for the operation of this name."""
        return replace(self, mode=self.mode_by_operation.get(operation, self.mode))

    @property
    def axis_tolerance_between_points(self) -> float:
        """How far the tool axis may be off between CL points, degrees; infinite where nobody asks."""
        if self.axis_tolerance is not None:
            return self.axis_tolerance
        return math.inf if self.tcp else AXIS_WITHOUT_TCP
