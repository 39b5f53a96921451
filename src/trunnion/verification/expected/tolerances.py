"""How far a program may be from its CL files, operation by operation."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.deviations import Deviations
from trunnion.records import dataclass

#: Share by which a feed per revolution may be off, however many digits are printed; that by which the last digit may
#: round it, which is this long, mm.
FEED_PER_REV_SHARE: Final = 1e-3
_ROUNDED_SHARE: Final = 1e-2
_HALF_A_DIGIT: Final = 5.1e-4


@dataclass(frozen=True, slots=True)
class Tolerances:
    """How far a program may be from its CL points.

    tip         of the tip, in each coordinate, mm
    angle       of each rotary axis, degrees
    chord       of lines from the arc that they replace, mm
    feed        of a feed, mm/min; feeds per revolution may be off by ``feed_per_rev_tolerance``
    deviations  rows at which the program may depart from the CL file on purpose
    centre      added for the centre of a circle that the control finds from a radius, mm
    normal      of each component of a surface normal
    plane       the tool stands on a tilted plane: its axis may be off by ``angle`` as a whole, however far a rotary
                axis is off. Near a pole one of them hardly matters
    """

    tip: float = 0.001
    angle: float = 0.001
    chord: float = 0.001
    feed: float = 0.005
    deviations: Deviations | None = None
    centre: float = 0.0
    normal: float = 1e-6
    plane: bool = False


def feed_per_rev_tolerance(feed: Floats) -> Floats:
    """Return by how much feeds per revolution (n,) may be off, mm/rev: a share, or half of the last digit."""
    return np.maximum(FEED_PER_REV_SHARE * feed, np.minimum(_HALF_A_DIGIT, _ROUNDED_SHARE * feed))
