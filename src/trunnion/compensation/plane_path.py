"""A path in a plane: lines and circles as arrays of complex numbers, x + iy in mm."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass

Points: TypeAlias = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, eq=False)
class PlanePath:
    """Elements of a path, (m,) each, one after another.

    start, end  points
    centre      of circles
    sense       0 a line, 1 a circle to the left (counterclockwise), -1 one to the right
    """

    start: Points
    end: Points
    centre: Points
    sense: Ints

    def __len__(self) -> int:
        return len(self.sense)

    @property
    def radius(self) -> Floats:
        """Radii of circles, at their starts, (m,)."""
        return np.abs(self.start - self.centre)

    def directions(self) -> tuple[Points, Points]:
        """Return unit tangents at the starts and the ends of the elements."""
        way = self.end - self.start
        straight = way / np.maximum(np.abs(way), 1e-300)
        return (
            np.where(self.sense == 0, straight, 1j * self.sense * _unit(self.start - self.centre)),
            np.where(self.sense == 0, straight, 1j * self.sense * _unit(self.end - self.centre)),
        )

    def swept(self) -> Floats:
        """Angles that circles turn through, (m,) radians, a full turn where start and end are one point."""
        ratio = (self.end - self.centre) * np.conj(self.start - self.centre)
        angle = np.mod(self.sense * np.angle(np.where(self.sense == 0, 1.0, ratio)), 2.0 * np.pi)
        closed = np.abs(self.end - self.start) <= 1e-9 * (1.0 + self.radius)
        return np.asarray(np.where(closed & (self.sense != 0), 2.0 * np.pi, angle))


def _unit(vector: Points) -> Points:
    return np.asarray(vector / np.maximum(np.abs(vector), 1e-300))


def meetings(first: PlanePath, second: PlanePath) -> Points:
    """Return where lines and circles of two paths meet if they go on, the point nearest to the end of the first, (m,).

    NaN where they do not meet.
    """
    found = np.full((4, len(first)), complex(np.nan, np.nan))
    a, b = first.sense == 0, second.sense == 0
    u, v = first.end - first.start, second.end - second.start
    with np.errstate(divide="ignore", invalid="ignore"):
        across = (np.conj(u) * v).imag
        both = first.start + u * (np.conj(second.start - first.start) * v).imag / across
        found[0] = np.where(a & b & (np.abs(across) > 1e-12 * np.abs(u) * np.abs(v)), both, found[0])
        for line, circle, which in ((first, second, a & ~b), (second, first, ~a & b)):
            way = _unit(line.end - line.start)
            seen = (circle.centre - line.start) * np.conj(way)
            half = np.sqrt(circle.radius**2 - seen.imag**2)
            for k, sign in ((0, 1.0), (1, -1.0)):
                found[k] = np.where(which, line.start + way * (seen.real + sign * half), found[k])
        apart = second.centre - first.centre
        gap = np.abs(apart)
        along = (gap**2 + first.radius**2 - second.radius**2) / (2.0 * gap)
        half = np.sqrt(first.radius**2 - along**2)
        for k, sign in ((2, 1.0), (3, -1.0)):
            found[k] = np.where(~a & ~b, first.centre + apart / gap * (along + 1j * sign * half), found[k])
        away = np.where(np.isnan(found), np.inf, np.abs(found - first.end))
    return np.asarray(np.take_along_axis(found, away.argmin(axis=0)[None], axis=0)[0])
