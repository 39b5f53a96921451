"""Deviations by arithmetic of their own: dense poses, and the distance to the cutter's outline.

It shares nothing with the kernel: the path is SciPy's, poses are so many and fixed, and the cutter is a line and two
arcs in the plane of its axis.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.flank.path import FlankPath

#: Points are looked at in groups of so many.
_GROUP: Final = 64


def measured_deviations(path: FlankPath, points: Floats, poses: int = 3001) -> Floats:
    """Deviations (n,) of points (n, 3): the least distance over so many poses, mm.

    With poses ``s`` mm apart it is too large by s²/8r at most.
    """
    spline = import_extra("scipy.interpolate", "geometry").BSpline
    at = np.linspace(0.0, 1.0, poses)
    lower, upper = (spline(path.knots, one, 3)(at) for one in (path.lower, path.upper))
    axis = (upper - lower) / np.linalg.norm(upper - lower, axis=1)[:, None]
    offset = np.einsum("ij,ij->i", lower, axis)
    found = np.empty(len(points))
    sizes = np.einsum("ij,ij->i", lower, lower)
    for first in range(0, len(points), _GROUP):
        some = points[first : first + _GROUP]
        up = some @ axis.T - offset
        square = np.einsum("ij,ij->i", some, some)[:, None] - 2.0 * some @ lower.T + sizes
        side = np.sqrt(np.maximum(square - up * up, 0.0))
        found[first : first + _GROUP] = _outline_distances(path, side, up).min(axis=1)
    return found


def _outline_distances(path: FlankPath, side: Floats, up: Floats) -> Floats:
    """Distances to the outline in the plane of the axis, from those to the axis and heights above the lower point."""
    cutter = path.cutter
    cosine = np.cos(cutter.half_angle)
    # The flank is the line from one ball's point of contact to the other's; beyond its ends, the balls count.
    start = cutter.radius * np.array([cosine, -cutter.slope])
    along = (up - start[1]) * cosine + (side - start[0]) * cutter.slope
    reach = cutter.length * cosine
    line = (side - start[0]) * cosine - (up - start[1]) * cutter.slope
    below = np.hypot(side, up) - cutter.radius
    above = np.hypot(side, up - cutter.length) - cutter.radius - cutter.slope * cutter.length
    return np.where(along < 0.0, below, np.where(along > reach, above, line))
