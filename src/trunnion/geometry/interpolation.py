"""Curves through points."""

from typing import Any

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, argument_problem
from trunnion.extras import import_extra
from trunnion.geometry.curves import DEGREE, BSplineCurve
from trunnion.geometry.ends import End, Ends, Natural
from trunnion.messages import Wording


def interpolate(
    points: Floats, parameters: Floats, ends: Ends | None = None, weights: Floats | None = None
) -> BSplineCurve:
    """Return the cubic curve through points, twice continuously differentiable, with a knot at each point.

    points      (n, 3) float64: mm; at least two
    parameters  (n,) float64: rising from 0 to 1
    ends        of the curve; by default natural. Natural ends of a rational curve are those of its homogeneous form
    weights     (n,) float64, optional: above 0: the curve is rational, and has these weights at the points

    BSplineCurve  with n + 2 control points

    Raises ``InputError`` if weights vary so much from point to point that the curve would have a weight of 0 or less.
    """
    ends = ends or Ends()
    if weights is None:
        spline = _spline(parameters, points, *_conditions(points, ends))
        return BSplineCurve(spline.t, spline.c)
    weight = _spline(parameters, weights, (2, 0.0), (2, 0.0))
    slopes = weight([0.0, 1.0], nu=1)
    conditions = []
    for (order, derivative), point, slope, value in zip(
        _conditions(points, ends), points[[0, -1]], slopes, weights[[0, -1]], strict=True
    ):
        if order == 1:
            conditions.append((1, np.r_[slope * point + value * derivative, slope]))
        else:
            conditions.append((2, np.zeros(4)))
    homogeneous = np.column_stack((points * weights[:, None], weights))
    # Where one end has a tangent, its slope of the weight is that of the natural one: the weights stay the same spline.
    spline = _spline(parameters, homogeneous, *conditions)
    found = spline.c[:, 3]
    if not (found > 0.0).all():
        raise InputError(argument_problem("weights", Wording("IMP132", "vary_so_much")))
    return BSplineCurve(spline.t, spline.c[:, :3] / found[:, None], found)


def _conditions(points: Floats, ends: Ends) -> tuple[tuple[int, Floats], tuple[int, Floats]]:
    """Order and value of the derivative that is given at either end."""
    chords = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    def condition(end: End) -> tuple[int, Floats]:
        return (2, np.zeros(3)) if isinstance(end, Natural) else (1, np.array(end.derivative(chords)))

    return condition(ends.start), condition(ends.end)


def _spline(parameters: Floats, values: Floats, start: tuple[int, Any], end: tuple[int, Any]) -> Any:
    make = import_extra("scipy.interpolate", "geometry").make_interp_spline
    return make(parameters, values, k=DEGREE, bc_type=([start], [end]))
