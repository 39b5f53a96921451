"""Coordinate systems of programs, shifted, rotated, mirrored or scaled, as affine maps.

A frame of a program maps positions in it to the frame that it is defined in: ``linear @ p + shift``, mm.
"""

import math
from dataclasses import field

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class AffineMap:
    """An affine map: linear (3, 3) float64 and shift (3,) float64, mm."""

    linear: Floats = field(default_factory=lambda: np.eye(3))
    shift: Floats = field(default_factory=lambda: np.zeros(3))

    def compose(self, inner: "AffineMap") -> "AffineMap":
        """Return the map of a frame ``inner`` that is defined in this frame."""
        return AffineMap(self.linear @ inner.linear, self.linear @ inner.shift + self.shift)

    def solve(self, point: Floats) -> Floats:
        """Return the position whose image is ``point``, (3,) mm."""
        if self.keeps_lengths:
            return np.asarray(self.linear.T @ (point - self.shift))
        return np.asarray(np.linalg.solve(self.linear, point - self.shift), np.float64)

    @property
    def is_identity(self) -> bool:
        """Whether it changes nothing."""
        return bool(np.allclose(self.linear, np.eye(3), rtol=0.0, atol=1e-12) and not self.shift.any())

    @property
    def keeps_lengths(self) -> bool:
        """Whether lengths stay the same; mirroring keeps them too."""
        return bool(np.allclose(self.linear.T @ self.linear, np.eye(3), rtol=0.0, atol=1e-12))

    @property
    def keeps_circles(self) -> bool:
        """Whether circles stay circles."""
        gram = self.linear.T @ self.linear
        return bool(np.allclose(gram, gram[0, 0] * np.eye(3), rtol=0.0, atol=1e-9 * abs(gram[0, 0])))


def rotation_matrix(axis: int, angle: float) -> Floats:
    """Return the right-handed rotation about axis 0, 1 or 2, degrees, as (3, 3); exact at multiples of 90."""
    quarter = angle / 90.0
    if quarter == math.floor(quarter) and abs(quarter) < 1e9:
        cos, sin = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    else:
        cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    matrix = np.eye(3)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    matrix[j, j] = matrix[k, k] = cos
    matrix[j, k], matrix[k, j] = -sin, sin
    return matrix


def rotation_about(direction: Floats, angle: float) -> Floats:
    """Return the right-handed rotation about a unit vector, degrees, as (3, 3) (Rodrigues' formula)."""
    a, b, c = direction
    cross = np.array([[0.0, -c, b], [c, 0.0, -a], [-b, a, 0.0]])
    radians = math.radians(math.fmod(angle, 360.0))
    return np.asarray(np.eye(3) + math.sin(radians) * cross + (1.0 - math.cos(radians)) * (cross @ cross))


def affine_matrix(linear: Floats, shift: Floats) -> Floats:
    """Return a linear map (3, 3) and a shift (3,) as one matrix (3, 4), applied as ``m[:, :3] @ p + m[:, 3]``."""
    return np.ascontiguousarray(np.column_stack((linear, shift)))
