"""Splines through points at given parameters: the poles that a STEP file has.

A CAD kernel's own interpolation takes parameters of its choice, so that a patch and its neighbour part between points.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.solid.shapes import Spline, SplineSurface


def spline_through(parameters: Floats, points: Floats) -> Spline:
    """Return the cubic through points (k, 2) or (k, 3) at parameters (k,), at least four."""
    found = import_extra("scipy.interpolate", "impeller").make_interp_spline(parameters, points, k=3)
    return Spline(found.t, found.c)


def surface_through(u: Floats, v: Floats, points: Floats) -> SplineSurface:
    """Return the surface through points (k, m, 3) at parameters (k,) and (m,), at least four of each.

    Its edges are the cubics through the outermost points.
    """
    make = import_extra("scipy.interpolate", "impeller").make_interp_spline
    along = make(u, points, k=3)
    across = make(v, np.swapaxes(along.c, 0, 1), k=3)
    return SplineSurface(along.t, across.t, np.ascontiguousarray(np.swapaxes(across.c, 0, 1)))


def spline_of_slopes(parameters: Floats, points: Floats, slopes: Floats) -> Spline:
    """Return the cubic through points (k, 3) with derivatives (k, 3) at parameters (k,): two knots at each."""
    third = np.diff(parameters)[:, None] / 3.0
    inner = np.stack((points[:-1] + third * slopes[:-1], points[1:] - third * slopes[1:]), axis=1)
    first, last = parameters[0], parameters[-1]
    knots = np.r_[[first] * 4, np.repeat(parameters[1:-1], 2), [last] * 4]
    return Spline(knots, np.vstack((points[:1], inner.reshape(-1, points.shape[1]), points[-1:])))
