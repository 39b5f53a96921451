"""The point of a curve that is nearest to a given one."""

from functools import lru_cache
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.geometry.curves import BSplineCurve

#: Samples in a knot interval: the nearest of them begins the search.
_SAMPLES: Final = 12

#: Newton's method doubles the digits in a step; where it does not help, halving ends as near.
_STEPS: Final = 60

_CLOSE: Final = 1e-12


def closest_parameters(curve: BSplineCurve, points: Floats) -> Floats:
    """Parameters (m,) of the points of a curve that are nearest to points (m, 3).

    The nearest of dense samples begins the search, which stays between that sample's neighbours: Newton's method on the
    derivative of the squared distance, and halving of the interval where a step would leave it.
    """
    at, tree = _samples(curve)
    nearest = tree.query(points)[1]
    low, high = at[np.maximum(nearest - 1, 0)], at[np.minimum(nearest + 1, len(at) - 1)]
    found = at[nearest]
    for _ in range(_STEPS):
        position, first, second = curve.derivatives(found, 2)
        away = position - points
        slope = np.einsum("ij,ij->i", away, first)
        bend = np.einsum("ij,ij->i", first, first) + np.einsum("ij,ij->i", away, second)
        low, high = np.where(slope < 0.0, found, low), np.where(slope > 0.0, found, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = found - slope / bend
        inside = (bend > 0.0) & (step >= low) & (step <= high)
        following = np.where(inside, step, (low + high) / 2.0)
        following = np.where(slope == 0.0, found, following)
        moved = np.abs(following - found).max(initial=0.0)
        found = following
        if moved < _CLOSE:
            break
    return np.asarray(found)


@lru_cache(maxsize=8)
def _samples(curve: BSplineCurve) -> tuple[Floats, Any]:
    """Parameters of dense samples of a curve, and a tree of the samples; hub and shroud are asked again and again."""
    knots = np.unique(curve.knots)
    at = np.unique(np.linspace(knots[:-1], knots[1:], _SAMPLES + 1))
    return at, import_extra("scipy.spatial", "geometry").cKDTree(curve.points(at))
