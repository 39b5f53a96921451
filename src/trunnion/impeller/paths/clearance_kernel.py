"""How far tools are from the bodies of an impeller: least distances over trees of surface cells.

A body is a surface of balls of radius h about points P (h = 0: the surface itself). A cell of it is nearly flat: with
P + s a + t b for a point and h + s ha + t hb for its radius, −1 ≤ s, t ≤ 1, both together are off by no more than
``off``. The distance D of a point to a convex body of revolution is convex, so that with D's slope g in P no ball of
the cell is nearer than D(P) − h − |g·a − ha| − |g·b − hb| − off. Cells that cannot be nearer than what is found already
are left out; the smallest are divided further as if they were flat, until the bound is the distance.
"""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3, Ints, Ints2
from trunnion.jit import inner, kernel

#: Cells that wait: three for each level but the last, with plenty to spare.
_WAITING: Final = 256

#: Distances are told so much too small at most, mm, besides what cells are off.
_CLOSE: Final = 2e-3


class BodyData(NamedTuple):
    """Bodies as trees of cells.

    cells     (m, 13)  P, a, b, h, ha, hb, off
    children  (m, 4)   of a cell; −1: none
    root      (k,)     of each body
    turn      (k, 2)   cosine and sine of the angle about Z by which a body is turned
    """

    cells: Floats2
    children: Ints2
    root: Ints
    turn: Floats2


class ToolData(NamedTuple):
    """Convex bodies of revolution about the tool axis.

    first    (p + 1,)  corners of piece k are ``first[k]:first[k + 1]``
    corners  (c, 2)    radius and height above the ball's centre, from the axis below round to the axis above
    wanted   (p,)      distance that is wanted from a piece, mm
    """

    first: Ints
    corners: Floats2
    wanted: Floats


@inner
def _to_piece(corners: Floats2, first: int, last: int, r: float, z: float) -> tuple[float, float, float]:
    """Distance of a point to a piece, below 0 inside, and its slope by r and z."""
    inside, inside_r, inside_z = -np.inf, 0.0, 0.0
    near, near_r, near_z = np.inf, 0.0, 0.0
    for k in range(first, last - 1):
        dr, dz = corners[k + 1, 0] - corners[k, 0], corners[k + 1, 1] - corners[k, 1]
        length = (dr * dr + dz * dz) ** 0.5
        dr, dz = dr / length, dz / length
        x, y = r - corners[k, 0], z - corners[k, 1]
        out = dz * x - dr * y
        if out > inside:
            inside, inside_r, inside_z = out, dz, -dr
        along = min(max(dr * x + dz * y, 0.0), length)
        x, y = x - along * dr, y - along * dz
        square = x * x + y * y
        if square < near:
            near, near_r, near_z = square, x, y
    if inside <= 1e-12:
        return inside, inside_r, inside_z
    far = near**0.5
    return far, near_r / far, near_z / far


@inner
def _bound(
    cell: Floats,
    part: tuple[float, float, float],
    pose: tuple[float, float, float, float, float, float],
    corners: Floats2,
    first: int,
    last: int,
) -> tuple[float, float]:
    """Return the distance of the ball in the middle of a part of a cell to a piece, and one that none of its balls is
    below.

    The part is about s and t, and of a size against the cell's own.
    """
    s, t, size = part
    x = cell[0] + s * cell[3] + t * cell[6] - pose[0]
    y = cell[1] + s * cell[4] + t * cell[7] - pose[1]
    z = cell[2] + s * cell[5] + t * cell[8] - pose[2]
    height = x * pose[3] + y * pose[4] + z * pose[5]
    x, y, z = x - height * pose[3], y - height * pose[4], z - height * pose[5]
    r = (x * x + y * y + z * z) ** 0.5
    distance, by_r, by_z = _to_piece(corners, first, last, r, height)
    # On the axis, a slope by r of 0 is one of those that the distance has.
    by_r = by_r / r if r > 1e-9 else 0.0
    gx, gy, gz = by_r * x + by_z * pose[3], by_r * y + by_z * pose[4], by_r * z + by_z * pose[5]
    a = gx * cell[3] + gy * cell[4] + gz * cell[5] - cell[10]
    b = gx * cell[6] + gy * cell[7] + gz * cell[8] - cell[11]
    distance -= cell[9] + s * cell[10] + t * cell[11]
    return distance, distance - size * (abs(a) + abs(b)) - cell[12]


@inner
def _least(
    bodies: BodyData,
    body: int,
    pose: tuple[float, float, float, float, float, float],
    tool: ToolData,
    piece: int,
    limit: float,
    waiting: Ints,
    wait: Floats2,
) -> float:
    """Return the distance of a piece of a tool to a body, or ``limit`` if that is less.

    Of what waits, ``waiting`` is the cell, and ``wait`` its bound and which part of it is meant.
    """
    first, last = tool.first[piece], tool.first[piece + 1]
    waiting[0] = bodies.root[body]
    wait[0, 0], wait[0, 1], wait[0, 2], wait[0, 3] = -np.inf, 0.0, 0.0, 1.0
    count, least = 1, limit
    while count > 0:
        count -= 1
        above = wait[count, 0]
        if above >= least:
            continue
        cell = waiting[count]
        s, t, size = wait[count, 1], wait[count, 2], wait[count, 3]
        is_smallest = bodies.children[cell, 0] < 0
        start = count
        for k in range(4):
            if is_smallest:
                # A smallest cell is divided as the plane that it nearly is.
                child, half = cell, 0.5 * size
                part = (s + half * (2 * (k % 2) - 1), t + half * (2 * (k // 2) - 1), half)
            else:
                child, part = bodies.children[cell, k], (0.0, 0.0, 1.0)
                if child < 0:
                    break
            row = bodies.cells[child]
            value, bound = _bound(row, part, pose, tool.corners, first, last)
            # The bound of what is larger holds for its parts as well.
            bound = max(bound, above)
            if is_smallest:
                # Of a larger cell, the middle need not be a point of the body.
                value -= row[12]
                least = min(least, bound if value - bound < _CLOSE else value)
            if bound >= least:
                continue
            place = count
            while place > start and wait[place - 1, 0] < bound:
                waiting[place] = waiting[place - 1]
                for column in range(4):
                    wait[place, column] = wait[place - 1, column]
                place -= 1
            waiting[place] = child
            wait[place, 0], wait[place, 1], wait[place, 2], wait[place, 3] = bound, part[0], part[1], part[2]
            count += 1
    return least


@inner
def _turned(
    centre: Floats2, axis: Floats2, row: int, cosine: float, sine: float
) -> tuple[float, float, float, float, float, float]:
    """Return a pose in the frame of a body that is turned about Z."""
    return (
        cosine * centre[row, 0] + sine * centre[row, 1],
        cosine * centre[row, 1] - sine * centre[row, 0],
        centre[row, 2],
        cosine * axis[row, 0] + sine * axis[row, 1],
        cosine * axis[row, 1] - sine * axis[row, 0],
        axis[row, 2],
    )


@kernel(writes="found")
def least_margins(
    bodies: BodyData, tool: ToolData, centre: Floats2, axis: Floats2, low: float, high: float, found: Floats
) -> None:
    """Write what the least distance of a tool to all bodies is above that wanted, (n,), no more than ``high``.

    centre, axis  (n, 3)
    low           below that, it may be less than what is written
    """
    waiting, wait = np.empty(_WAITING, np.int64), np.empty((_WAITING, 4))
    for row in range(centre.shape[0]):
        least = high
        for body in range(bodies.root.shape[0]):
            pose = _turned(centre, axis, row, bodies.turn[body, 0], bodies.turn[body, 1])
            for piece in range(tool.wanted.shape[0]):
                if least < low:
                    break
                limit = least + tool.wanted[piece]
                least = _least(bodies, body, pose, tool, piece, limit, waiting, wait) - tool.wanted[piece]
        found[row] = least


@kernel(writes="found")
def part_distances(
    bodies: BodyData, tool: ToolData, centre: Floats2, axis: Floats2, high: float, found: Floats3
) -> None:
    """Write the distance of each piece of a tool to each body, (n, pieces, bodies), no more than ``high``."""
    waiting, wait = np.empty(_WAITING, np.int64), np.empty((_WAITING, 4))
    for row in range(centre.shape[0]):
        for body in range(bodies.root.shape[0]):
            pose = _turned(centre, axis, row, bodies.turn[body, 0], bodies.turn[body, 1])
            for piece in range(tool.wanted.shape[0]):
                found[row, piece, body] = _least(bodies, body, pose, tool, piece, high, waiting, wait)
