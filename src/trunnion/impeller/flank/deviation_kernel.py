"""How far points are from what a cutter leaves on its way.

The distance of a point to the cutter is that to the nearest of its balls; it is a closed formula in each pose. What
has been cut is the union of all poses, so that the deviation is the least distance over the path: below 0 the cutter
has cut the point away (overcut), above 0 it has left so much (undercut). The swept envelope comes out by itself.
"""

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner, kernel

#: Golden section: the part of an interval that stays.
_GOLDEN = 0.6180339887498949


@inner
def _distance(pose: Floats, cutter: Floats, x: float, y: float, z: float) -> float:
    """Return the distance of a point to the cutter (radius, slope, length) in a pose (lower point, axis)."""
    dx, dy, dz = x - pose[0], y - pose[1], z - pose[2]
    up = dx * pose[3] + dy * pose[4] + dz * pose[5]
    square = max(dx * dx + dy * dy + dz * dz - up * up, 0.0)
    lean = cutter[1] / (1.0 - cutter[1] * cutter[1]) ** 0.5
    place = min(max(up + square**0.5 * lean, 0.0), cutter[2])
    return float((square + (up - place) * (up - place)) ** 0.5 - cutter[0] - cutter[1] * place)


@inner
def _pose(lower: Floats2, upper: Floats2, t: float, pose: Floats) -> None:
    """Write lower point and axis at a parameter to ``pose``: de Boor's algorithm on even, clamped knots."""
    spans = lower.shape[0] - 3
    span = min(int(t * spans), spans - 1)
    weights = np.empty(4)
    weights[0] = 1.0
    # Cox and de Boor: weights of the four B-splines that are not 0 (Piegl and Tiller, The NURBS Book, A2.2).
    for degree in range(1, 4):
        saved = 0.0
        for k in range(degree):
            right = min(max(span + k + 1, 0), spans) / spans
            left = min(max(span + k + 1 - degree, 0), spans) / spans
            part = weights[k] / (right - left)
            weights[k] = saved + (right - t) * part
            saved = (t - left) * part
        weights[degree] = saved
    size = 0.0
    for axis in range(3):
        low = high = 0.0
        for k in range(4):
            low += weights[k] * lower[span + k, axis]
            high += weights[k] * upper[span + k, axis]
        pose[axis] = low
        pose[3 + axis] = high - low
        size += (high - low) ** 2
    for axis in range(3, 6):
        pose[axis] /= size**0.5


@kernel(writes="found at")
def least_distances(
    lower: Floats2,
    upper: Floats2,
    cutter: Floats,
    points: Floats2,
    samples: int,
    rounds: int,
    found: Floats2,
    at: Floats2,
) -> None:
    """Write the least distances of points (n, 3) along a path to ``found`` (n, m), and where they are to ``at`` (n, m).

    The first column is the least, the others are the next local minima; inf where there are no more. Each is
    looked for between ``samples`` even parameters, then by ``rounds`` of golden section.
    """
    count = found.shape[1]
    poses = np.empty((samples, 6))
    for i in range(samples):
        _pose(lower, upper, i / (samples - 1), poses[i])
    gaps, pose = np.empty(samples), np.empty(6)
    for n in range(points.shape[0]):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        for i in range(samples):
            gaps[i] = _distance(poses[i], cutter, x, y, z)
        for k in range(count):
            found[n, k] = np.inf
            at[n, k] = 0.0
        for i in range(samples):
            if (i > 0 and gaps[i - 1] < gaps[i]) or (i < samples - 1 and gaps[i + 1] <= gaps[i]):
                continue
            # Refined, it may be a little less: those that are far behind need not be looked at.
            if gaps[i] > found[n, count - 1] + 1.0:
                continue
            low, high = max(i - 1, 0) / (samples - 1), min(i + 1, samples - 1) / (samples - 1)
            first, second = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
            _pose(lower, upper, first, pose)
            near = _distance(pose, cutter, x, y, z)
            _pose(lower, upper, second, pose)
            far = _distance(pose, cutter, x, y, z)
            for _ in range(rounds):
                if near <= far:
                    high, second, far = second, first, near
                    first = high - _GOLDEN * (high - low)
                    _pose(lower, upper, first, pose)
                    near = _distance(pose, cutter, x, y, z)
                else:
                    low, first, near = first, second, far
                    second = low + _GOLDEN * (high - low)
                    _pose(lower, upper, second, pose)
                    far = _distance(pose, cutter, x, y, z)
            gap, place = min(near, far), first if near <= far else second
            if gaps[i] < gap:
                gap, place = gaps[i], i / (samples - 1)
            for k in range(count):
                if gap < found[n, k]:
                    for later in range(count - 1, k, -1):
                        found[n, later], at[n, later] = found[n, later - 1], at[n, later - 1]
                    found[n, k], at[n, k] = gap, place
                    break
