"""How far the tool axis may leave its great circle between two CL points where nobody asks for a tolerance.

Units: degrees.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.machining_method import machining_method
from trunnion.model.toolpath import Operation
from trunnion.records import dataclass

#: In a coarse step the tool axis may leave its great circle by this part of its turn. A control that turns its axes
#: evenly in a coarse step of a published program that ran needs a seventh; a turn of 180 degrees at the pole in the
#: same block needs two thirds.
_COARSE_PART: Final = 1.0 / 6.0


@dataclass(frozen=True, slots=True)
class AxisTolerance:
    """What a control's definition allows between points.

    cutting    in any operation, degrees
    finishing  in one that finishes, degrees
    """

    cutting: float = 1.0
    finishing: float = 0.25

    def of(self, operation: Operation) -> float:
        """Return the tolerance of an operation."""
        return (
            self.finishing
            if machining_method(operation.name, operation.intol, operation.outtol) == "FINISH"
            else self.cutting
        )


def allowed_deviation(tolerance: float | Floats, turn: Floats) -> Floats:
    """Return how far the tool axis may be off between points, (n,) degrees.

    tolerance  of the operation, for each step or for all of them
    turn       (n,) float64: how far the tool axis turns from point to point
    """
    return np.asarray(np.maximum(tolerance, _COARSE_PART * turn))
