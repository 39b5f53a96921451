"""Planes above the distance of two bodies, over a cell of places: it is a convex function of the zero.

At a convex function's plane of contact it is lifted until it is above all corners of the cell; then it is above the
function in all of the cell. The other way round the plane itself is below the function everywhere.
"""

from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.collisions.clearance import Clearance, Nearest
from trunnion.records import dataclass
from trunnion.simulation.collisions.hull_gap import gaps_at, pose_gap

_CORNERS: Final = np.array(list(product((0.0, 1.0), repeat=3)))


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """height + slope . (zero - at), mm."""

    at: Floats
    height: float
    slope: Floats

    def row(self) -> tuple[Floats, float]:
        """Return the plane as slope (3,) and height at the origin."""
        return self.slope, self.height - float(self.slope @ self.at)


@dataclass(frozen=True, slots=True, eq=False)
class Witness:
    """Two bodies at one moment: as a function of the zero they are never farther apart than two hulls.

    Distances are times the weight of the pair.

    pose   (4, 4) with the zero at the origin
    shift  (3, 3): how the first body is shifted in the frame of the second for each mm of the zero
    """

    nearest: Nearest
    pose: Floats
    shift: Floats

    @staticmethod
    def of(clearance: Clearance, nearest: Nearest) -> "Witness":
        """Return the witness of what was found."""
        poses = [
            clearance.pose(nearest.pair, zero, nearest.moment, nearest.share) for zero in (np.zeros(3), *np.eye(3))
        ]
        shift = np.stack([pose[:3, 3] - poses[0][:3, 3] for pose in poses[1:]], axis=1)
        return Witness(nearest, poses[0], shift)

    def gaps(self, zeros: Floats) -> Floats:
        """How far the bodies are apart at most with the zero at (k, 3), (k,) mm."""
        gaps = np.empty(len(zeros))
        shifts = np.ascontiguousarray(zeros @ self.shift.T)
        gaps_at(self.nearest.one, self.nearest.other, self.pose, shifts, np.array([0.0, 0.0, 1.0]), gaps)
        return np.asarray(self.nearest.pair.weight * np.maximum(gaps - self.nearest.inside, 0.0))

    def floor(self, zero: Floats) -> Plane:
        """Return a plane below their distance at any zero, which it touches at this one, (3,)."""
        pose = self.pose.copy()
        pose[:3, 3] += self.shift @ zero
        direction = np.array([0.0, 0.0, 1.0])
        low, _ = pose_gap(self.nearest.one, self.nearest.other, pose, direction)
        if low <= self.nearest.inside:
            return Plane(zero, 0.0, np.zeros(3))
        weight = self.nearest.pair.weight
        return Plane(zero, weight * (low - self.nearest.inside), weight * (self.shift.T @ direction))

    def ceiling(self, zero: Floats, low: Floats, high: Floats) -> tuple[Plane, Floats]:
        """Return a plane above their distance in a cell, and how far the distance bends up along each side of
        it, (3,).
        """
        floor = self.floor(zero)
        ends = np.concatenate((low + _CORNERS * (high - low), np.tile(zero, (6, 1))))
        for k in range(3):
            ends[8 + 2 * k, k], ends[9 + 2 * k, k] = low[k], high[k]
        beyond = self.gaps(ends) - floor.height - (ends - zero) @ floor.slope
        lift = max(float(beyond[:8].max()), 0.0)
        return Plane(zero, floor.height + lift, floor.slope), beyond[8:].reshape(3, 2).max(axis=1)
