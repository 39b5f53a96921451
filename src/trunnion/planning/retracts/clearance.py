"""How far the tool draws back along its axis before it turns: by a distance, up to a plane, or out to a sphere."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from trunnion.arrays import Floats

#: A tool axis that rises towards a plane by less than this share does not lead to it.
_MIN_RISE = 0.05

#: The tool draws back by no less than this, mm, wherever it is.
MIN_RETRACT = 2.0


class ClearanceSurface(StrEnum):
    """What the tool draws back to."""

    DISTANCE = "distance"
    PLANE = "plane"
    SPHERE = "sphere"


@dataclass(frozen=True, slots=True)
class Clearance:
    """Where the tool is clear of the part.

    surface  DISTANCE: ``value`` mm away from where it cuts; PLANE: at Z ``value`` of the program; SPHERE: out of the
             sphere of radius ``value`` about the program's zero
    """

    value: float
    surface: ClearanceSurface = ClearanceSurface.DISTANCE

    def __str__(self) -> str:
        """Return it as the setting says it."""
        return f"{self.value:g}" if self.surface is ClearanceSurface.DISTANCE else f"{self.surface}:{self.value:g}"

    def retract_distance(self, tip: Floats, axis: Floats) -> float:
        """How far to draw back, mm; infinite where the tool axis does not lead there.

        Parameters
        ----------
        tip, axis : (3,) float64
            Where the tool cuts, in the program's coordinate system: mm, and the unit vector from tip to holder.
        """
        if self.surface is ClearanceSurface.DISTANCE:
            return self.value
        if self.surface is ClearanceSurface.PLANE:
            missing = self.value - float(tip[2])
            if missing <= 0.0:
                return MIN_RETRACT
            return max(MIN_RETRACT, missing / float(axis[2])) if axis[2] > _MIN_RISE else float("inf")
        # |tip + t axis| = value: the way out is the larger root; there is none if the whole line passes outside.
        along = float(tip @ axis)
        under = along * along + self.value**2 - float(tip @ tip)
        return max(MIN_RETRACT, float(np.sqrt(under)) - along) if under > 0.0 else MIN_RETRACT
