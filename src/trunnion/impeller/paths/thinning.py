"""The fewest points of a path: what a control makes of them by itself is left out.

In:     ball centres and tool axes, dense.
Out:    which of them stay.
Units:  mm.

Between two points a control with TCP moves the tip on a straight line while the tool axis turns evenly. A point may go
if the ball and the axis are then within their tolerances of where they were.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2
from trunnion.jit import inner, kernel

#: No more points than this go between two that stay: the search is as long as its square.
_MOST: Final = 200


def thinned(centre: Floats, axis: Floats, radius: float, tolerance: float, angle: float) -> Flags:
    """Which points of a path stay, (n,); the first and the last do.

    centre, axis  (n, 3): ball centres, and unit vectors from them towards the holder
    radius        from the ball's centre to the tip, mm
    tolerance     how far the ball may be off, mm
    angle         how far the tool axis may be off, degrees
    """
    keep = np.zeros(len(centre), np.bool_)
    if len(centre):
        points, directions = (np.ascontiguousarray(each, np.float64) for each in (centre, axis))
        thin_rows(points, directions, radius, tolerance, math.cos(math.radians(angle)), keep)
    return keep


@inner
def _may_go(
    centre: Floats2, axis: Floats2, first: int, last: int, radius: float, tolerance: float, cosine: float
) -> bool:
    """Whether all points between two may be left out."""
    length = 0.0
    for k in range(3):
        length += (centre[last, k] - centre[first, k]) ** 2
    for row in range(first + 1, last):
        share = 0.0
        for k in range(3):
            share += (centre[row, k] - centre[first, k]) * (centre[last, k] - centre[first, k])
        share = min(max(share / max(length, 1e-24), 0.0), 1.0)
        size = dot = off = 0.0
        for k in range(3):
            turned = axis[first, k] + share * (axis[last, k] - axis[first, k])
            size += turned * turned
            dot += turned * axis[row, k]
        size = size**0.5
        if dot < cosine * size:
            return False
        for k in range(3):
            start, end = centre[first, k] - radius * axis[first, k], centre[last, k] - radius * axis[last, k]
            turned = (axis[first, k] + share * (axis[last, k] - axis[first, k])) / size
            off += (start + share * (end - start) + radius * turned - centre[row, k]) ** 2
        if off > tolerance * tolerance:
            return False
    return True


@kernel(writes="keep")
def thin_rows(centre: Floats2, axis: Floats2, radius: float, tolerance: float, cosine: float, keep: Flags) -> None:
    """Mark the points that stay, (n,): from each one, as far as all between may go."""
    n = centre.shape[0]
    keep[0] = True
    row = 0
    while row < n - 1:
        following = row + 1
        while following + 1 < n and following + 1 - row <= _MOST:
            if not _may_go(centre, axis, row, following + 1, radius, tolerance, cosine):
                break
            following += 1
        keep[following] = True
        row = following
