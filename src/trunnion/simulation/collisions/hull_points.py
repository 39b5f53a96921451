"""The points of a hull in blocks, so that the farthest one in a direction is found without a look at all of them."""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2, Ints
from trunnion.jit import inner

#: Points of a block; hulls with few points are one block.
BLOCK: Final = 64
_FEW: Final = 4 * BLOCK


class HullPoints(NamedTuple):
    """Points (n, 3) in blocks of ``BLOCK``, the last with the rest, each in a ball; mm.

    No balls: there are few points, and all are looked at.
    """

    points: Floats2
    centres: Floats2
    radii: Floats


def hull_points(points: Floats) -> HullPoints:
    """Return points (n, 3) in blocks."""
    if len(points) <= _FEW:
        return HullPoints(np.ascontiguousarray(points, np.float64), np.zeros((0, 3)), np.zeros(0))
    ordered = np.ascontiguousarray(points[_near_each_other(points)], np.float64)
    centres, radii = [], []
    for first in range(0, len(ordered), BLOCK):
        own = ordered[first : first + BLOCK]
        centre = (own.min(axis=0) + own.max(axis=0)) / 2.0
        centres.append(centre)
        # Rounding must not make a ball too small.
        radii.append(float(np.linalg.norm(own - centre, axis=1).max()) * (1.0 + 1e-9) + 1e-9)
    return HullPoints(ordered, np.array(centres), np.array(radii))


def _near_each_other(points: Floats) -> Ints:
    """Return an order of points in which those of a block lie together: halved across the longest side again
    and again.
    """
    parts, found = [np.arange(len(points))], list[Ints]()
    while parts:
        part = parts.pop()
        if len(part) <= BLOCK:
            found.append(part)
            continue
        own = points[part]
        side = int(np.argmax(np.ptp(own, axis=0)))
        half = BLOCK * (-(-len(part) // BLOCK) // 2)
        order = part[np.argpartition(own[:, side], half)]
        parts += [order[half:], order[:half]]
    return np.concatenate(found)


@inner
def farthest(hull: HullPoints, x: float, y: float, z: float) -> tuple[float, int]:
    """Return how far the hull reaches along a unit vector, mm, and its point there."""
    points, count = hull.points, hull.points.shape[0]
    best: float = -np.inf
    at, blocks = 0, hull.radii.shape[0]
    if blocks == 0:
        for k in range(count):
            value = x * points[k, 0] + y * points[k, 1] + z * points[k, 2]
            if value > best:
                best, at = value, k
        return best, at
    # The block that may reach farthest comes first: then most others need no look.
    likely, most = 0, -np.inf
    for block in range(blocks):
        here = x * hull.centres[block, 0] + y * hull.centres[block, 1] + z * hull.centres[block, 2]
        if here + hull.radii[block] > most:
            likely, most = block, here + hull.radii[block]
    for step in range(-1, blocks):
        block = likely if step < 0 else step
        here = x * hull.centres[block, 0] + y * hull.centres[block, 1] + z * hull.centres[block, 2]
        if here + hull.radii[block] <= best:
            continue
        for k in range(block * BLOCK, min((block + 1) * BLOCK, count)):
            value = x * points[k, 0] + y * points[k, 1] + z * points[k, 2]
            if value > best:
                best, at = value, k
    return best, at
