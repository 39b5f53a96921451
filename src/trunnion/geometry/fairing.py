"""Points moved a little, so that the curve through them bends more evenly."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra

#: A smoothing spline has at least so many points.
LEAST_POINTS: Final = 5

#: Powers of ten of the weight of the bending: from no effect to a straight line.
_LEAST, _MOST = -20.0, 6.0

_HALVINGS: Final = 20


def fair_points(points: Floats, parameters: Floats, most: float) -> Floats:
    """Move points so that the curve through them bends least, none of them farther than ``most``.

    The points of a smoothing spline, which makes the sum of squared moves and the integral of the squared second
    derivative, times a weight, least (Reinsch 1967). The weight is the largest that moves no point too far.

    points      (n, 3) float64: mm; at least ``LEAST_POINTS``
    parameters  (n,) float64: rising from 0 to 1
    most        mm, above 0
    """
    smoothing = import_extra("scipy.interpolate", "geometry").make_smoothing_spline

    def moved(power: float) -> Floats:
        return np.column_stack([smoothing(parameters, column, lam=10.0**power)(parameters) for column in points.T])

    low, high = _LEAST, _MOST
    best = points
    for _ in range(_HALVINGS):
        power = (low + high) / 2.0
        found = moved(power)
        if np.linalg.norm(found - points, axis=1).max() <= most:
            low, best = power, found
        else:
            high = power
    return best
