"""What whoever asks for a program may wish of its planning."""

from dataclasses import dataclass, field
from functools import partial

from trunnion.plan.clearance import Clearance
from trunnion.plan.motion import Manner, Pole


@dataclass(frozen=True, slots=True)
class Wishes:
    """Wishes with their defaults.

    rewind      insert retreats where an axis must wind back in the cut; False: refuse the program
    clearance   how far the tool draws back along its axis for that
    engage      share of the feed with which it comes back
    explain     say more in the log: what the nearest neighbour would have done, where a rotary axis is too fast
    manner      how every operation is to be made, whatever the rule says; None: by the rule
    pole        what is done near the pole where a rotary axis would have to be too fast
    pole_angle  by how much the tool axis may lean for that, degrees
    absolute    the program's coordinate system is the CAM's absolute one, not that of the first operation
    lower_feed  lower the feed where a rotary axis would have to be too fast
    """

    rewind: bool = True
    clearance: Clearance = field(default_factory=partial(Clearance, 50.0))
    engage: float = 0.5
    explain: bool = False
    manner: Manner | None = None
    absolute: bool = False
    pole: Pole = Pole.OFF
    pole_angle: float = 0.1
    lower_feed: bool = False
