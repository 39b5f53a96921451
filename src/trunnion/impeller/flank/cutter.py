"""The cutter of flank milling: all balls along its axis, each as large as the cutter is thick there.

Units: mm.
"""

import math

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class FlankCutter:
    """A cylinder or a cone with a ball at its lower end.

    radius  of the ball at its lower end
    slope   sine of half the cone's angle, above 0 where the cutter is thicker further up; 0: a cylinder
    length  of the axis along which it cuts, from the ball's centre

    The ball at ``x`` mm above the lower one has the radius ``radius + slope * x``; the cone is the envelope of these
    balls. Where the axis goes beyond the flank, the shape of the end does not matter.

    Raises
    ------
    InputError
        If that is no cutter.
    """

    radius: float
    slope: float = 0.0
    length: float = 50.0

    def __post_init__(self) -> None:
        ends = self.radius, self.radius + self.slope * self.length
        if not (self.length > 0.0 and min(ends) > 0.0 and abs(self.slope) < 1.0):
            raise InputError(
                Problem(
                    "flank milling",
                    0,
                    Wording("IMP326", "cutter_radius_over", tip_radius=ends[0], top_radius=ends[1], length=self.length),
                )
            )

    @property
    def half_angle(self) -> float:
        """Half the cone's angle, radians."""
        return math.asin(self.slope)
