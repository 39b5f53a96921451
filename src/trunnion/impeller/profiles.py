"""Hub and shroud: curves in the plane of radius and height, turned about Z.

In:     a curve in space, which is turned about Z.
Out:    its profile; the distance of points to the surface; the outline as a polygon.
Units:  mm.

A profile goes from the inlet to the outlet. Metal of the hub is on its right, towards the axis and below; normals point
to the left. Beyond its ends it goes on straight.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.geometry.closest import closest_parameters
from trunnion.geometry.curves import BSplineCurve
from trunnion.geometry.interpolation import interpolate
from trunnion.geometry.parameters import parameters_of
from trunnion.records import dataclass

#: Points of the curve in space that make the profile.
_SAMPLES: Final = 801


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """A profile: a curve of (radius, 0, height) over the parameters 0 to 1."""

    curve: BSplineCurve

    @staticmethod
    def of_curve(curve: BSplineCurve) -> "Profile":
        """Return the profile of a curve in space that is turned about Z."""
        points = curve.points(np.linspace(0.0, 1.0, _SAMPLES))
        flat = np.column_stack((np.hypot(points[:, 0], points[:, 1]), np.zeros(_SAMPLES), points[:, 2]))
        return Profile(interpolate(flat, parameters_of(flat)))

    def distances(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Distance (k,) of points (k, 3) to the surface, above 0 on the side of the normals.

        Also the normals (k, 3) at the nearest points of the surface, and their parameters (k,).
        """
        radius = np.hypot(points[:, 0], points[:, 1])
        flat = np.column_stack((radius, np.zeros(len(points)), points[:, 2]))
        at = closest_parameters(self.curve, flat)
        place, slope = self.curve.derivatives(at, 1)
        along = slope / np.linalg.norm(slope, axis=1)[:, None]
        away = flat - place
        # Beyond an end, the surface goes on straight: what is along it does not count.
        normal = np.column_stack((-along[:, 2], np.zeros(len(points)), along[:, 0]))
        distance = np.einsum("ij,ij->i", away, normal)
        outward = points[:, :2] / np.maximum(radius, 1e-12)[:, None]
        return distance, np.column_stack((normal[:, :1] * outward, normal[:, 2:])), at

    def outline(self, tolerance: float, beyond: float) -> Floats:
        """Points (k, 2) of radius and height, chords within a tolerance, straight on by ``beyond`` mm at either end.

        Where it would cross the axis, it ends there.
        """
        count = 8
        while True:
            at = np.linspace(0.0, 1.0, count + 1)
            points = self.curve.points(at)
            middle = self.curve.points((at[1:] + at[:-1]) / 2.0)
            if np.linalg.norm(middle - (points[1:] + points[:-1]) / 2.0, axis=1).max() <= tolerance or count > 4096:
                break
            count *= 2
        slope = self.curve.derivatives(np.array([0.0, 1.0]), 1)[1]
        along = slope / np.linalg.norm(slope, axis=1)[:, None]
        first, last = points[0] - beyond * along[0], points[-1] + beyond * along[1]
        if first[0] < 0.0:
            first = points[0] - along[0] * points[0, 0] / along[0, 0]
        return np.asarray(np.vstack((first, points, last))[:, [0, 2]])
