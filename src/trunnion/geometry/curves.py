"""Cubic B-spline curves, rational where they have weights."""

from math import comb
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats, distinct
from trunnion.extras import import_extra
from trunnion.records import dataclass

#: Every curve is cubic: the lowest degree whose curvature is continuous.
DEGREE: Final = 3

#: Points of Gauss and Legendre's rule in a knot interval: the length of a cubic to nine digits.
_GAUSS_POINTS: Final = 12


@dataclass(frozen=True, slots=True, eq=False)
class BSplineCurve:
    """A clamped cubic B-spline curve over the parameters 0 to 1.

    knots           (n + 4,) not falling; the first and the last four are equal
    control_points  (n, 3) mm
    weights         (n,) above 0 of a rational curve (NURBS); None: it is a polynomial one
    """

    knots: Floats
    control_points: Floats
    weights: Floats | None = None

    def points(self, parameters: Floats) -> Floats:
        """Points (m, 3) at parameters (m,)."""
        return np.asarray(self.derivatives(parameters, 0)[0])

    def derivatives(self, parameters: Floats, order: int) -> Floats:
        """Return the curve and its derivatives with respect to the parameter up to ``order``, (order + 1, m, 3).

        Those of a rational curve follow from its homogeneous form by Leibniz's rule (Piegl and Tiller, The NURBS Book,
        equation 4.8).
        """
        spline = self._homogeneous()
        at = np.clip(np.asarray(parameters, float), 0.0, 1.0)
        homogeneous = [spline(at, nu=k) for k in range(order + 1)]
        if self.weights is None:
            return np.stack(homogeneous)
        found: list[Floats] = []
        for k, row in enumerate(homogeneous):
            rest = row[:, :3].copy()
            for j in range(1, k + 1):
                rest -= comb(k, j) * homogeneous[j][:, 3:] * found[k - j]
            found.append(rest / homogeneous[0][:, 3:])
        return np.stack(found)

    def curvatures(self, parameters: Floats) -> Floats:
        """Curvature vectors (m, 3), 1/mm: towards the centre of curvature, as long as 1 / radius."""
        _, first, second = self.derivatives(parameters, 2)
        square = np.maximum(np.einsum("ij,ij->i", first, first), 1e-300)[:, None]
        along = np.einsum("ij,ij->i", first, second)[:, None] / square
        return np.asarray((second - along * first) / square)

    def lengths(self, parameters: Floats) -> Floats:
        """Length of the curve, mm, between one parameter and the next, (m - 1,); parameters rise."""
        nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
        at = distinct(np.r_[self.knots, parameters])
        at = at[(at >= parameters[0]) & (at <= parameters[-1])]
        middle, half = (at[1:] + at[:-1]) / 2.0, np.diff(at) / 2.0
        speed = np.linalg.norm(self.derivatives((middle[:, None] + half[:, None] * nodes).ravel(), 1)[1], axis=1)
        so_far = np.r_[0.0, np.cumsum(half * (speed.reshape(-1, _GAUSS_POINTS) @ weights))]
        return np.diff(so_far[np.searchsorted(at, parameters)])

    def _homogeneous(self) -> Any:
        weights = self.weights
        coordinates = self.control_points
        if weights is not None:
            coordinates = np.column_stack((coordinates * weights[:, None], weights))
        return import_extra("scipy.interpolate", "geometry").BSpline(self.knots, coordinates, DEGREE)
