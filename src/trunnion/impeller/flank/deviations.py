"""Deviations of what a path leaves from points of a flank, and how they change with the path's control points.

Units: mm.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.impeller.flank.deviation_kernel import least_distances
from trunnion.impeller.flank.path import FlankPath, basis
from trunnion.records import dataclass

#: Parameters between which minima are looked for, and rounds of golden section: 1e-7 of the path.
_SAMPLES: Final = 241
_ROUNDS: Final = 24


@dataclass(frozen=True, slots=True)
class Deviations:
    """The greatest overcut and undercut, mm, both at least 0."""

    overcut: float
    undercut: float

    @staticmethod
    def of(deviations: Floats) -> "Deviations":
        """Those of deviations (n,), below 0 where too much is cut."""
        return Deviations(max(0.0, -float(deviations.min())), max(0.0, float(deviations.max())))

    @property
    def largest(self) -> float:
        """The greater of both."""
        return max(self.overcut, self.undercut)


def deviations_of(path: FlankPath, points: Floats, minima: int = 1) -> tuple[Floats, Floats]:
    """Deviations (n, minima) of points (n, 3), and the parameters of the path (n, minima) where they are.

    The first is the deviation; the others are further local minima along the path, inf where there are none.
    """
    found, at = np.empty((len(points), minima)), np.empty((len(points), minima))
    cutter = np.array([path.cutter.radius, path.cutter.slope, path.cutter.length])
    lower, upper = (np.ascontiguousarray(one, float) for one in (path.lower, path.upper))
    least_distances(lower, upper, cutter, np.ascontiguousarray(points, float), _SAMPLES, _ROUNDS, found, at)
    return found, at


@dataclass(frozen=True, slots=True, eq=False)
class Slopes:
    """How distances of points change with a path's control points; n points, k control points.

    weights  (n, k) values of the B-splines
    axis     (n, 3) the cutter's axis
    share    (n,) where the nearest ball's centre is, from the lower to the upper point
    outward  (n, 3) unit vectors from that centre to the point
    """

    weights: Floats
    axis: Floats
    share: Floats
    outward: Floats

    def changes(self) -> Floats:
        """Return changes (n, 6 k) by the coordinates of lower, then of upper control points.

        At a minimum along the path and the axis, what moves along them changes nothing.
        """
        outward = self.outward
        across = outward - np.einsum("ij,ij->i", outward, self.axis)[:, None] * self.axis
        by_upper = -self.share[:, None] * across
        parts = (-outward - by_upper, by_upper)
        return np.concatenate([(self.weights[:, :, None] * one[:, None]).reshape(len(outward), -1) for one in parts], 1)


def slopes_of(path: FlankPath, points: Floats, at: Floats) -> Slopes:
    """How distances of points (n, 3) to the cutter at parameters (n,) change."""
    weights = basis(at, len(path.lower))
    low, high = weights @ path.lower, weights @ path.upper
    size = np.linalg.norm(high - low, axis=1)
    axis = (high - low) / size[:, None]
    away = points - low
    up = np.einsum("ij,ij->i", away, axis)
    side = np.linalg.norm(away - up[:, None] * axis, axis=1)
    place = np.clip(up + side * np.tan(path.cutter.half_angle), 0.0, path.cutter.length)
    outward = away - place[:, None] * axis
    far = np.linalg.norm(outward, axis=1)
    return Slopes(weights, axis, place / size, outward / np.maximum(far, 1e-12)[:, None])
