"""Curves near points, with few control points."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.geometry.closest import closest_parameters
from trunnion.geometry.curves import DEGREE, BSplineCurve
from trunnion.geometry.interpolation import interpolate

#: How often parameters are moved to the nearest points of the curve, and the curve is fitted anew.
_CORRECTIONS: Final = 8


def approximate(points: Floats, parameters: Floats, tolerance: float) -> BSplineCurve:
    """Return a cubic curve from the first to the last point that passes all others within a tolerance, by least
    squares.

    It has the fewest control points with which this way of placing knots succeeds: knots are placed so that each
    interval has points (Piegl and Tiller, The NURBS Book, equations 9.68 and 9.69), then parameters and curve are
    corrected in turn (Hoschek 1988).

    points      (n, 3) float64: mm; at least two
    parameters  (n,) float64: rising from 0 to 1
    tolerance   mm, above 0: how far a point may be from the curve
    """
    count, most = DEGREE + 1, len(points)
    failed = DEGREE
    best: BSplineCurve | None = None
    while best is None and count < most:  # first by doubling, then by halving the interval
        best = _within(points, parameters, count, tolerance)
        if best is None:
            failed, count = count, min(2 * count, most)
    if best is None:
        return interpolate(points, parameters)
    while len(best.control_points) - failed > 1:
        count = (failed + len(best.control_points)) // 2
        found = _within(points, parameters, count, tolerance)
        if found is None:
            failed = count
        else:
            best = found
    return best


def _within(points: Floats, parameters: Floats, count: int, tolerance: float) -> BSplineCurve | None:
    """Return a curve with so many control points, if it passes all points within a tolerance."""
    at = parameters
    for _ in range(_CORRECTIONS):
        curve = _least_squares(points, at, count)
        at = closest_parameters(curve, points)
        at[0], at[-1] = 0.0, 1.0
        if np.linalg.norm(curve.points(at) - points, axis=1).max() <= tolerance:
            return curve
        if not (np.diff(at) > 0.0).all():  # the curve runs back: its parameters are of no more use
            return None
    return None


def _least_squares(points: Floats, parameters: Floats, count: int) -> BSplineCurve:
    """Return the curve with so many control points whose points at the parameters are nearest; its ends are exact."""
    knots = _knots(parameters, count)
    matrix = import_extra("scipy.interpolate", "geometry").BSpline.design_matrix(parameters, knots, DEGREE)
    ends = matrix[:, [0, count - 1]] @ points[[0, -1]]
    inner = matrix[:, 1 : count - 1]
    solve = import_extra("scipy.sparse.linalg", "geometry").splu
    rest = solve((inner.T @ inner).tocsc()).solve(inner.T @ (points - ends))
    return BSplineCurve(knots, np.vstack((points[:1], rest, points[-1:])))


def _knots(parameters: Floats, count: int) -> Floats:
    """Knots for so many control points, each interval with a parameter in it."""
    inner = count - DEGREE - 1
    place = np.arange(1, inner + 1) * len(parameters) / (inner + 1)
    k = place.astype(int)
    share = place - k
    between = (1.0 - share) * parameters[k - 1] + share * parameters[np.minimum(k, len(parameters) - 1)]
    return np.concatenate((np.zeros(DEGREE + 1), between, np.ones(DEGREE + 1)))
