"""The path of a cutter's axis: two cubic B-spline curves over one parameter from 0 to 1.

Units: mm.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.records import dataclass

DEGREE: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class FlankPath:
    """A path of flank milling.

    lower   (k, 3) control points of the curve of the axis' lower point, the centre of the ball at the cutter's end
    upper   (k, 3) control points of the curve of a point further up on the axis
    cutter  that is swept; its balls are measured from the lower point, so that the distance between the two points,
            which need not be the same everywhere, does not matter
    """

    lower: Floats
    upper: Floats
    cutter: FlankCutter

    @property
    def knots(self) -> Floats:
        """Knots of both curves, even and clamped."""
        return even_knots(len(self.lower))

    def poses(self, at: Floats) -> tuple[Floats, Floats]:
        """Lower points (n, 3) and unit vectors of the axis up into the holder (n, 3) at parameters (n,)."""
        weights = basis(at, len(self.lower))
        low, high = weights @ self.lower, weights @ self.upper
        axis = high - low
        return low, axis / np.linalg.norm(axis, axis=1)[:, None]


def even_knots(count: int) -> Floats:
    """Clamped knots from 0 to 1 of a cubic with so many control points, evenly apart."""
    return np.concatenate((np.zeros(DEGREE), np.linspace(0.0, 1.0, count - DEGREE + 1), np.ones(DEGREE)))


def basis(at: Floats, count: int) -> Floats:
    """Values (n, count) of the B-splines with even knots at parameters (n,)."""
    spline = import_extra("scipy.interpolate", "geometry").BSpline
    return np.asarray(spline.design_matrix(np.clip(at, 0.0, 1.0), even_knots(count), DEGREE).toarray())
