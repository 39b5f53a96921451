"""Tensor-product B-spline surfaces, lofted through curves.

In:     curves of one parameter u from 0 to 1, in their order along v.
Out:    ``BSplineSurface`` over u and v from 0 to 1, which goes on straight beyond.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats, distinct
from trunnion.extras import import_extra
from trunnion.geometry.curves import DEGREE, BSplineCurve
from trunnion.geometry.surface_kernel import SurfaceData, surface_points
from trunnion.records import dataclass

#: Two knots nearer to each other than this are one.
_SAME_KNOT: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class BSplineSurface:
    """A surface of degree 3 along u, and of ``degree`` along v.

    u_knots, v_knots  clamped, from 0 to 1
    degree            1 to 3; 1: it is ruled
    control_points    (n, m, 3) mm
    """

    u_knots: Floats
    v_knots: Floats
    degree: int
    control_points: Floats

    @property
    def data(self) -> SurfaceData:
        """The surface as kernels take it."""
        return SurfaceData(self.u_knots, self.v_knots, self.degree, self.control_points)

    def derivatives(self, u: Floats, v: Floats) -> Floats:
        """Points and derivatives (6, k, 3) at parameters (k,): S, Su, Sv, Suu, Suv, Svv."""
        u, v = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        found = np.empty((6, u.size, 3))
        surface_points(self.data, np.ascontiguousarray(u.ravel()), np.ascontiguousarray(v.ravel()), found)
        return found

    def points(self, u: Floats, v: Floats) -> Floats:
        """Points (k, 3) at parameters (k,)."""
        return np.asarray(self.derivatives(u, v)[0])


def loft(curves: Sequence[BSplineCurve]) -> BSplineSurface:
    """Return the surface through curves, each at its own v: of two the ruled one, else a spline along v of up to degree
    3.

    Points of the curves with the same u are joined. The places along v are as far apart as the curves are on average.

    curves  at least two, polynomial ones
    """
    knots = _merged([curve.knots for curve in curves])
    control = np.stack([_with_knots(curve, knots) for curve in curves])
    steps = np.linalg.norm(np.diff(control, axis=0), axis=2).mean(axis=1)
    places = np.r_[0.0, np.cumsum(steps)] / steps.sum()
    degree = min(DEGREE, len(curves) - 1)
    make = import_extra("scipy.interpolate", "geometry").make_interp_spline
    across = make(places, control, k=degree)
    points = np.ascontiguousarray(np.swapaxes(across.c, 0, 1))
    return BSplineSurface(knots, np.ascontiguousarray(across.t), degree, points)


def _merged(vectors: Sequence[Floats]) -> Floats:
    """All inner knots of several knot vectors, those that are the same once."""
    inner = distinct(np.concatenate([knots[DEGREE + 1 : -DEGREE - 1] for knots in vectors]))
    kept = inner[np.r_[True, np.diff(inner) > _SAME_KNOT]] if len(inner) else inner
    return np.concatenate((np.zeros(DEGREE + 1), kept, np.ones(DEGREE + 1)))


def _with_knots(curve: BSplineCurve, knots: Floats) -> Floats:
    """Control points of the same curve over more knots.

    The curve is one of those that the knots span, so that it is found again exactly by interpolation at the Greville
    points, where that is well posed (Schoenberg and Whitney 1953).
    """
    count = len(knots) - DEGREE - 1
    greville = np.array([knots[k + 1 : k + DEGREE + 1].mean() for k in range(count)])
    make = import_extra("scipy.interpolate", "geometry").make_interp_spline
    return np.asarray(make(greville, curve.points(greville), k=DEGREE, t=knots).c)
