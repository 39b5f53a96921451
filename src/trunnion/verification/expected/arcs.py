"""Circles and helices of a CL file: where the tool should be on its way along them.

Units: mm and radians.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.arcs import CLOSED_ARC
from trunnion.model.run import Run
from trunnion.model.toolpath import Arcs
from trunnion.records import dataclass
from trunnion.verification.expected.path import ExpectedPath


@dataclass(frozen=True, slots=True, eq=False)
class Arc:
    """One circle or helix; rounding in the file is spread evenly along it.

    start, end, centre  (3,) mm, program's coordinate system
    normal              (3,) unit vector: the tool goes right-handed about it
    sweep               radians, with whole turns
    """

    start: Floats
    end: Floats
    centre: Floats
    normal: Floats
    sweep: float

    @property
    def radial(self) -> Floats:
        """From the axis to the start, (3,) mm."""
        arm = self.start - self.centre
        return np.asarray(arm - (arm @ self.normal) * self.normal)

    @property
    def radius(self) -> float:
        """Distance of the start from the axis, mm."""
        return float(np.linalg.norm(self.radial))

    @property
    def slope(self) -> float:
        """Rise along the axis per millimetre of arc length."""
        return abs(float((self.end - self.start) @ self.normal)) / max(self.radius * self.sweep, 1e-9)

    @property
    def closure_error(self) -> float:
        """Distance of the end from the end of the exact circle, seen along the axis, mm: rounding in the file."""
        radial, across = self.radial, np.cross(self.normal, self.radial)
        off = self.end - self.centre - np.cos(self.sweep) * radial - np.sin(self.sweep) * across
        return float(np.linalg.norm(off - (off @ self.normal) * self.normal))

    def fractions(self, points: Floats) -> Floats:
        """Fractions of the arc, (k,), at which points near it lie, (k, 3) mm; the points are in order.

        From each point to the next the shorter way round counts, and at the start a quarter turn back is the most:
        a fraction that is less than the one before it belongs to a point that goes back along the arc.
        """
        arm = points - self.centre
        across = np.cross(self.normal, self.radial)
        angle = np.unwrap(np.concatenate(([0.0], np.arctan2(arm @ across, arm @ self.radial))))[1:]
        if len(angle) and angle[0] < -0.5 * np.pi:
            angle = angle + 2.0 * np.pi
        return np.asarray(angle / self.sweep)

    def at(self, fraction: Floats) -> Floats:
        """Points at fractions of the arc, (k, 3) mm."""
        angle = (fraction * self.sweep)[:, None]
        radial, across = self.radial, np.cross(self.normal, self.radial)
        height = self.start - self.centre - radial
        circle = self.centre + height + np.cos(angle) * radial + np.sin(angle) * across
        last = self.centre + height + np.cos(self.sweep) * radial + np.sin(self.sweep) * across
        return np.asarray(circle + fraction[:, None] * (self.end - last))

    def deviation(self, points: Floats) -> Floats:
        """From where points should be to where they are, (k, 3)."""
        return np.asarray(points - self.at(self.fractions(points)))


def arc_of(expected: ExpectedPath, row: int) -> Arc:
    """Return the arc that ends at a row."""
    arcs = expected.arcs
    return _arc(arcs, int(np.searchsorted(arcs.row, row)), expected.point(row - 1).tip, expected.point(row).tip)


def circle_of(run: Run, row: int) -> Arc:
    """Return the circle or helix that a block of the program goes along; ``row`` is not the first."""
    start, end = run.positions(np.array([row - 1, row])).tip
    return _arc(run.arcs, int(np.searchsorted(run.arcs.row, row)), start, end)


def _arc(arcs: Arcs, k: int, start: Floats, end: Floats) -> Arc:
    centre, normal = arcs.centre[k], arcs.normal[k]
    a, b = start - centre, end - centre
    angle = float(np.arctan2(np.cross(a, b) @ normal, a @ b - (a @ normal) * (b @ normal))) % (2.0 * np.pi)
    if min(angle, 2.0 * np.pi - angle) * float(arcs.radius[k]) < CLOSED_ARC:
        angle = 2.0 * np.pi
    return Arc(start, end, centre, normal, angle + 2.0 * np.pi * float(arcs.full_turns[k]))


def great_circle_points(begin: Floats, end: Floats, fraction: Floats) -> Floats:
    """Return unit vectors at fractions of the great circle from ``begin`` to ``end``, (k, 3)."""
    angle = float(np.arctan2(np.linalg.norm(np.cross(begin, end)), begin @ end))
    if angle < 1e-9:
        return np.asarray(begin + fraction[:, None] * (end - begin))
    weights = np.sin((1.0 - fraction) * angle), np.sin(fraction * angle)
    return np.asarray((weights[0][:, None] * begin + weights[1][:, None] * end) / np.sin(angle))
