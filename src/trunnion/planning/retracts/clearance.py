"""How far the tool retracts along its axis before it turns: by a distance, up to a plane, or out of a sphere."""

from enum import StrEnum
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass

#: A tool axis that rises towards a plane by less than this share of its length does not lead to it.
_MIN_RISE: Final = 0.05

#: The tool retracts by no less than this, mm, wherever it is.
MIN_RETRACT: Final = 2.0


class ClearanceSurface(StrEnum):
    """What the tool retracts to."""

    DISTANCE = "distance"
    PLANE = "plane"
    SPHERE = "sphere"


@dataclass(frozen=True, slots=True)
class Clearance:
    """Where the tool is clear of the part.

    surface  DISTANCE: ``value`` mm away from the point of the cut; PLANE: at Z ``value`` of the program; SPHERE: out of
             the sphere of radius ``value`` about the program's zero
    """

    value: float
    surface: ClearanceSurface = ClearanceSurface.DISTANCE

    def __str__(self) -> str:
        """Return it in the form of the setting ``clearance``."""
        return f"{self.value:g}" if self.surface is ClearanceSurface.DISTANCE else f"{self.surface}:{self.value:g}"

    def retract_distance(self, tip: Floats, axis: Floats) -> float:
        """How far to retract, mm; infinite if the tool axis does not lead to the clearance.

        tip, axis  (3,) float64: in the cut, in the program's coordinate system: mm, and the unit vector from tip to
                   holder
        """
        if self.surface is ClearanceSurface.DISTANCE:
            return self.value
        if self.surface is ClearanceSurface.PLANE:
            missing = self.value - float(tip[2])
            if missing <= 0.0:
                return MIN_RETRACT
            return max(MIN_RETRACT, missing / float(axis[2])) if axis[2] > _MIN_RISE else float("inf")
        # |tip + t axis| = value: the larger root leads out. Without a root the line passes the sphere by.
        along = float(tip @ axis)
        root = along * along + self.value**2 - float(tip @ tip)
        return max(MIN_RETRACT, float(np.sqrt(root)) - along) if root > 0.0 else MIN_RETRACT
