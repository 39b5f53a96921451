"""Passes: what every machining step of an impeller makes before its tool axes are chosen.

Frame: that of the impeller, for its first blade or channel; the others are copies turned about Z. Units: mm.
"""

import math
from enum import StrEnum

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass


class Way(StrEnum):
    """How the passes of a family follow one another.

    ONE_WAY    each begins where the first one began
    BOTH_WAYS  every other one is cut backwards, as its points stand
    SPIRAL     the family is one pass
    """

    ONE_WAY = "one-way"
    BOTH_WAYS = "both-ways"
    SPIRAL = "spiral"


@dataclass(frozen=True, slots=True)
class Stepover:
    """How far neighbouring passes are apart: so many mm on the surface, or so that ridges are no higher than a scallop.

    Exactly one of them is above 0.
    """

    distance: float = 0.0
    scallop: float = 0.0

    def on(self, radius: float, bend: float = 0.0) -> float:
        """Return the distance in mm for a ball of a radius on a surface of curvature ``bend`` (1/mm, above 0:
        convex).
        """
        if self.distance:
            return self.distance
        # On a plane, two balls s apart leave a ridge of r − √(r² − s²/4); where it bends by k, one of s²·(1/r + k)/8.
        return 2.0 * math.sqrt(self.scallop * (2.0 * radius - self.scallop)) / math.sqrt(max(1.0 + radius * bend, 0.25))


@dataclass(frozen=True, slots=True, eq=False)
class Pass:
    """One stretch of cutting, from its first to its last point, in the direction of cutting.

    centre  (n, 3)  of the tool's ball, dense: its chords are within the tolerance of the step
    normal  (n, 3)  unit vectors out of the surface towards the centre where the ball touches it; for a pass in solid
                    material those of the surface below
    place   (n, k)  parameters from 0 to 1 of the family, in which its tool axes are smooth: along, across and, if there
                    are layers, layer
    layer   number of its layer, from 0; passes of one layer are neighbours
    """

    centre: Floats
    normal: Floats
    place: Floats
    layer: int = 0

    def __len__(self) -> int:
        return len(self.centre)

    def backwards(self) -> "Pass":
        """Return the same pass cut the other way."""
        return Pass(self.centre[::-1], self.normal[::-1], self.place[::-1], self.layer)


@dataclass(frozen=True, slots=True, eq=False)
class PassFamily:
    """The passes of a step in the order of cutting, each in its direction.

    radius  of the tool's ball, mm
    """

    passes: tuple[Pass, ...]
    radius: float
    way: Way

    def centres(self) -> Floats:
        """All ball centres (n, 3)."""
        return np.concatenate([one.centre for one in self.passes])

    def places(self) -> Floats:
        """Return the parameters (n, k) of all ball centres."""
        return np.concatenate([one.place for one in self.passes])

    def turned(self, angle: float) -> "PassFamily":
        """Return the same passes turned about Z by an angle in radians."""
        cosine, sine = math.cos(angle), math.sin(angle)
        turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        passes = tuple(Pass(one.centre @ turn, one.normal @ turn, one.place, one.layer) for one in self.passes)
        return PassFamily(passes, self.radius, self.way)
