"""How far two convex hulls are apart, between a bound from below and one from above: Gilbert, Johnson and Keerthi.

The way from any point of one hull to any of the other is an upper bound. A plane with both hulls on different sides is
a lower one. Both hold whatever rounding does, since each is worked out anew from the points themselves.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.simulation.collisions.hull_points import HullPoints, farthest

#: The search ends when the bounds are so near, mm, or share of the distance.
_CLOSE: Final = 1e-7

#: Hulls nearer than this touch, mm.
_TOUCH: Final = 1e-9

#: Rounds: what rounding keeps from ending is left with the bounds that it has.
_MOST_ROUNDS: Final = 60


@kernel(writes="direction")
def pose_gap(one: HullPoints, other: HullPoints, pose: Floats2, direction: Floats) -> tuple[float, float]:
    """Bounds of the distance of two hulls in a pose, mm, as ``gap_between`` has them."""
    return gap_between(one, other, pose, direction, np.zeros((7, 3)))


@kernel(writes="gaps")
def gaps_at(
    one: HullPoints, other: HullPoints, pose: Floats2, shifts: Floats2, direction: Floats, gaps: Floats
) -> None:
    """Write upper bounds of the distance of two hulls, (k,) mm, when the first is shifted by (k, 3)."""
    moved, guess, work = pose.copy(), direction.copy(), np.zeros((7, 3))
    for k in range(shifts.shape[0]):
        for j in range(3):
            moved[j, 3] = pose[j, 3] + shifts[k, j]
        gaps[k] = gap_between(one, other, moved, guess, work)[1]


@inner
def plane_gap(one: HullPoints, other: HullPoints, pose: Floats2, direction: Floats) -> float:
    """How far two hulls are apart along a unit vector from the second to the first: a lower bound, mm."""
    a = pose[0, 0] * direction[0] + pose[1, 0] * direction[1] + pose[2, 0] * direction[2]
    b = pose[0, 1] * direction[0] + pose[1, 1] * direction[1] + pose[2, 1] * direction[2]
    c = pose[0, 2] * direction[0] + pose[1, 2] * direction[1] + pose[2, 2] * direction[2]
    behind, _ = farthest(one, -a, -b, -c)
    most, _ = farthest(other, direction[0], direction[1], direction[2])
    shift: float = pose[0, 3] * direction[0] + pose[1, 3] * direction[1] + pose[2, 3] * direction[2]
    gap: float = shift - behind - most
    return gap


@inner
def gap_between(
    one: HullPoints, other: HullPoints, pose: Floats2, direction: Floats, work: Floats2
) -> tuple[float, float]:
    """Return a lower and an upper bound of the distance of two hulls, mm; the lower is negative where they may overlap.

    one, other  whose hulls are meant
    pose        (4, 4) maps the frame of the first into that of the second
    direction   (3,) unit vector, a guess of the way from the second to the first; the one of the lower bound is written
    work        (12, 3) room for the search
    """
    corners, nearest, chosen = work[:4], work[4], work[5]
    x, y, z = direction[0], direction[1], direction[2]
    count, upper, lower = 0, math.inf, -math.inf
    length = 1.0
    for _ in range(_MOST_ROUNDS):
        _support(one, other, pose, x / length, y / length, z / length, work)
        wx, wy, wz = work[6, 0], work[6, 1], work[6, 2]
        bound = (x * wx + y * wy + z * wz) / length
        if bound > lower:
            lower = bound
            direction[0], direction[1], direction[2] = x / length, y / length, z / length
        if count > 0 and upper - lower <= _CLOSE * max(1.0, upper):
            break
        is_known = False
        for k in range(count):
            same = abs(corners[k, 0] - wx) + abs(corners[k, 1] - wy) + abs(corners[k, 2] - wz)
            is_known = is_known or same < 1e-12
        if is_known:
            break
        corners[count, 0], corners[count, 1], corners[count, 2] = wx, wy, wz
        count = _nearest_of(corners, count + 1, nearest, chosen)
        x, y, z = nearest[0], nearest[1], nearest[2]
        length = math.sqrt(x * x + y * y + z * z)
        if length >= upper:
            break
        upper = length
        if length <= _TOUCH or count == 4:
            upper = 0.0
            break
    return min(lower, upper), upper


@inner
def _support(one: HullPoints, other: HullPoints, pose: Floats2, x: float, y: float, z: float, work: Floats2) -> None:
    """Write the corner of the difference of the hulls that lies farthest against a unit vector into ``work[6]``."""
    a = pose[0, 0] * x + pose[1, 0] * y + pose[2, 0] * z
    b = pose[0, 1] * x + pose[1, 1] * y + pose[2, 1] * z
    c = pose[0, 2] * x + pose[1, 2] * y + pose[2, 2] * z
    _, i = farthest(one, -a, -b, -c)
    _, j = farthest(other, x, y, z)
    point = one.points[i]
    for k in range(3):
        moved = pose[k, 0] * point[0] + pose[k, 1] * point[1] + pose[k, 2] * point[2] + pose[k, 3]
        work[6, k] = moved - other.points[j, k]


@inner
def _nearest_of(corners: Floats2, count: int, nearest: Floats, chosen: Floats) -> int:
    """Write the point of a simplex next to the origin, and keep the corners that it lies between; returns how many.

    Four corners that all stay hold the origin within them.
    """
    if count == 1:
        for k in range(3):
            nearest[k] = corners[0, k]
        return 1
    if count == 2:
        mask, _ = _on_triangle(corners, 0, 1, 1, nearest)
    elif count == 3:
        mask, _ = _on_triangle(corners, 0, 1, 2, nearest)
    else:
        mask, best = 0, math.inf
        is_inside = True
        for face in range(4):
            i, j, m = (face + 1) % 4, (face + 2) % 4, (face + 3) % 4
            if not _is_behind(corners, i, j, m, face):
                is_inside = False
                own, square = _on_triangle(corners, i, j, m, chosen)
                if square < best:
                    mask, best = own, square
                    for k in range(3):
                        nearest[k] = chosen[k]
        if is_inside:
            for k in range(3):
                nearest[k] = 0.0
            return 4
    kept = 0
    for i in range(count):
        if mask >> i & 1:
            for k in range(3):
                corners[kept, k] = corners[i, k]
            kept += 1
    return kept


@inner
def _is_behind(corners: Floats2, i: int, j: int, m: int, away: int) -> bool:
    """Whether the origin is on the side of a face that the fourth corner is on; not for a flat tetrahedron."""
    ux, uy, uz = corners[j, 0] - corners[i, 0], corners[j, 1] - corners[i, 1], corners[j, 2] - corners[i, 2]
    vx, vy, vz = corners[m, 0] - corners[i, 0], corners[m, 1] - corners[i, 1], corners[m, 2] - corners[i, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    origin = -(nx * corners[i, 0] + ny * corners[i, 1] + nz * corners[i, 2])
    fourth = (
        nx * (corners[away, 0] - corners[i, 0])
        + ny * (corners[away, 1] - corners[i, 1])
        + nz * (corners[away, 2] - corners[i, 2])
    )
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    return bool(abs(fourth) > 1e-10 * size and origin * fourth > 0.0)


@inner
def _on_triangle(corners: Floats2, i: int, j: int, m: int, nearest: Floats) -> tuple[int, float]:
    """Write the point of a triangle, or of a line if two corners are one, next to the origin.

    Returns the corners that it lies between, as bits, and its square.
    """
    best, mask = math.inf, 0
    for edge in range(3):
        p = i if edge == 0 else (j if edge == 1 else m)
        q = j if edge == 0 else (m if edge == 1 else i)
        dx, dy, dz = corners[q, 0] - corners[p, 0], corners[q, 1] - corners[p, 1], corners[q, 2] - corners[p, 2]
        size = dx * dx + dy * dy + dz * dz
        share = 0.0
        if size > 0.0:
            share = -(dx * corners[p, 0] + dy * corners[p, 1] + dz * corners[p, 2]) / size
            share = min(max(share, 0.0), 1.0)
        x, y, z = corners[p, 0] + share * dx, corners[p, 1] + share * dy, corners[p, 2] + share * dz
        square = x * x + y * y + z * z
        if square < best:
            best = square
            nearest[0], nearest[1], nearest[2] = x, y, z
            mask = 1 << p if share <= 0.0 else (1 << q if share >= 1.0 else 1 << p | 1 << q)
    if j == m:
        return mask, best
    ux, uy, uz = corners[j, 0] - corners[i, 0], corners[j, 1] - corners[i, 1], corners[j, 2] - corners[i, 2]
    vx, vy, vz = corners[m, 0] - corners[i, 0], corners[m, 1] - corners[i, 1], corners[m, 2] - corners[i, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    size = nx * nx + ny * ny + nz * nz
    if size <= 0.0:
        return mask, best
    wx, wy, wz = -corners[i, 0], -corners[i, 1], -corners[i, 2]
    s = ((wy * vz - wz * vy) * nx + (wz * vx - wx * vz) * ny + (wx * vy - wy * vx) * nz) / size
    t = ((uy * wz - uz * wy) * nx + (uz * wx - ux * wz) * ny + (ux * wy - uy * wx) * nz) / size
    if s > 0.0 and t > 0.0 and s + t < 1.0:
        x, y, z = corners[i, 0] + s * ux + t * vx, corners[i, 1] + s * uy + t * vy, corners[i, 2] + s * uz + t * vz
        square = x * x + y * y + z * z
        if square < best:
            best = square
            nearest[0], nearest[1], nearest[2] = x, y, z
            mask = 1 << i | 1 << j | 1 << m
    return mask, best
