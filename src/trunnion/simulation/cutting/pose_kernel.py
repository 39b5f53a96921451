"""Many rays against a piece of the tool in one pose: the interval of each, and how fast its ends move.

In:     rays in a ``Work``, a motion and the part of it that is done, and a piece of the tool.
Out:    in the same work, for each ray what ``AtPose`` has.
Units:  mm, coordinates (u, v, w) of a bundle: the rays are parallel to w.

The loops over rays have no branches, and the rows of the work are at distances that the compiler knows: it makes them
do four rays at a time.
"""

import math
from typing import Annotated, Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats2
from trunnion.jit import inner
from trunnion.simulation.cutting.tool_table import (
    CENTRE,
    HIGH,
    HIGH_DISC,
    LOW,
    LOW_DISC,
    RADIUS,
    ROUND,
    SLOPE,
    Motion,
    Piece,
    axis_between,
    axis_speed,
)
from trunnion.simulation.stock.material import TILE_RAYS

#: Rays of a work at most: those of a tile.
MOST: Final = TILE_RAYS * TILE_RAYS

#: From one row of the work to the next. The same ray in all rows must not be in the same place of the cache.
ROW: Final = MOST + 72

#: Where the tool touches a ray from the side, its end moves infinitely fast, but for this.
STEEPEST: Final = 1e-12

#: A ray of the work that is no ray of the tile.
_SPARE: Final = MOST

#: Rows of the work: where rays are, and what is found of them; FIRST and LAST are counted along w from its zero.
U, V, FIRST, LAST, ON_FIRST, ON_LAST, DOWN, UP = (k * ROW for k in range(8))

#: Where ``keep`` puts what was found.
KEPT: Final = 6 * ROW

#: Where the rays behind a motion are, while those ahead of it are computed.
U_BEHIND, V_BEHIND = 14 * ROW, 15 * ROW

_ROWS: Final = 16

Work: TypeAlias = Annotated[NDArray[np.float64], 1]


class AtPose(NamedTuple):
    """The interval of a ray in a pose: whether there is one, both ends, the rows of the table that they are on.

    down, up   how fast the lower end and the upper end move along w, per part of the motion
    """

    hit: bool
    first: float
    last: float
    on_first: int
    on_last: int
    down: float
    up: float


@inner
def new_work() -> Work:
    return np.empty(_ROWS * ROW)


@inner
def found_at(work: Work, k: int) -> AtPose:
    """Return what ``at_pose`` has found of ray ``k``; of what was kept: ``k + KEPT``."""
    return AtPose(
        work[FIRST + k] < work[LAST + k],
        work[FIRST + k],
        work[LAST + k],
        int(work[ON_FIRST + k]),
        int(work[ON_LAST + k]),
        work[DOWN + k],
        work[UP + k],
    )


@inner
def keep(work: Work, k: int, at: int) -> None:
    """Keep what was found of ray ``k`` as that of ray ``at``, which is no later one."""
    work[U + at], work[V + at] = work[U + k], work[V + k]
    for row in (FIRST, LAST, ON_FIRST, ON_LAST, DOWN, UP):
        work[row + KEPT + at] = work[row + k]


@inner
def at_part(u: float, v: float, work: Work, motion: Motion, s: float, piece: Piece, table: Floats2) -> AtPose:
    """One more ray at a part of a motion; what is in the work of others stays."""
    work[U + _SPARE], work[V + _SPARE] = u, v
    at_pose(work, _SPARE, _SPARE + 1, motion, s, piece, table)
    return found_at(work, _SPARE)


@inner
def at_pose(work: Work, begin: int, end: int, motion: Motion, s: float, piece: Piece, table: Floats2) -> None:
    """Find the intervals of the rays ``begin`` to ``end`` (exclusive) within a piece at a part of a motion."""
    pose = _pose(motion, s)
    for k in range(begin, end):
        work[FIRST + k] = math.inf
        work[LAST + k] = -math.inf
        work[ON_FIRST + k] = work[ON_LAST + k] = 0.0
        work[DOWN + k] = work[UP + k] = 0.0
    for e in range(piece.first, piece.end):
        if table[e, ROUND] == 0.0:
            _cone(work, begin, end, pose, table, e)
        else:
            _sphere(work, begin, end, pose, table, e)
    if abs(pose.aw) > 1e-12:
        if piece.low_radius > 0.0:
            _disc(work, begin, end, pose, len(table) - LOW_DISC, piece.low, piece.low_radius)
        if piece.high_radius > 0.0:
            _disc(work, begin, end, pose, len(table) - HIGH_DISC, piece.high, piece.high_radius)


class Pose(NamedTuple):
    """A pose of a motion: tip, tool axis, the velocities of both, and how fast the tip moves along the axis."""

    tu: float
    tv: float
    tw: float
    au: float
    av: float
    aw: float
    du: float
    dv: float
    dw: float
    cu: float
    cv: float
    cw: float
    rising: float


@inner
def _pose(motion: Motion, s: float) -> Pose:
    au, av, aw = axis_between(motion, s)
    cu, cv, cw = axis_speed(motion, au, av, aw)
    du, dv, dw = motion.du, motion.dv, motion.dw
    tu, tv, tw = motion.tu + s * du, motion.tv + s * dv, motion.tw + s * dw
    return Pose(tu, tv, tw, au, av, aw, du, dv, dw, cu, cv, cw, au * du + av * dv + aw * dw)


@inner
def _cone(work: Work, begin: int, end: int, pose: Pose, table: Floats2, e: int) -> None:
    """Where the rays pass a cone.

    The surface is where F = p² - z² - (r + m z)² = 0 for the point p, counted from the tip, at the height z = p . axis;
    its end moves along the ray by -(dF/ds) / (dF/dw).
    """
    radius, slope, low, high, number = table[e, RADIUS], table[e, SLOPE], table[e, LOW], table[e, HIGH], float(e)
    tu, tv, tw, au, av, aw, du, dv, dw, cu, cv, cw, rising = pose
    a = 1.0 - aw * aw - slope * slope * aw * aw
    if abs(a) < 1e-14:
        _parallel_cone(work, begin, end, pose, table, e)
        return
    inverse = 1.0 / a
    for k in range(begin, end):
        pu, pv = work[U + k] - tu, work[V + k] - tv
        z0 = pu * au + pv * av
        base = radius + slope * z0
        b = -z0 * aw - slope * aw * base
        square = b * b - a * (pu * pu + pv * pv - z0 * z0 - base * base)
        hit = square >= 0.0
        root = math.sqrt(max(square, 0.0))
        steep = 1.0 / max(root, STEEPEST)
        moved, turned = pu * du + pv * dv, pu * cu + pv * cv - rising
        t = (-b - root) * inverse
        z = z0 + t * aw
        speed = -(moved + t * dw + (turned + t * cw) * (z + slope * (radius + slope * z))) * steep
        _passed(work, k, number, t + tw, speed, hit & (z >= low) & (z <= high))
        t = (-b + root) * inverse
        z = z0 + t * aw
        speed = (moved + t * dw + (turned + t * cw) * (z + slope * (radius + slope * z))) * steep
        _passed(work, k, number, t + tw, speed, hit & (z >= low) & (z <= high))


@inner
def _parallel_cone(work: Work, begin: int, end: int, pose: Pose, table: Floats2, e: int) -> None:
    """Where rays that are parallel to the side of a cone pass it: once, or, along a cylinder, nowhere."""
    radius, slope, low, high, number = table[e, RADIUS], table[e, SLOPE], table[e, LOW], table[e, HIGH], float(e)
    tu, tv, tw, au, av, aw, du, dv, dw, cu, cv, cw, rising = pose
    for k in range(begin, end):
        pu, pv = work[U + k] - tu, work[V + k] - tv
        z0 = pu * au + pv * av
        base = radius + slope * z0
        b = -z0 * aw - slope * aw * base
        if abs(b) >= 1e-14:
            t = -0.5 * (pu * pu + pv * pv - z0 * z0 - base * base) / b
            z = z0 + t * aw
            moved, turned = pu * du + pv * dv + t * dw, pu * cu + pv * cv + t * cw - rising
            speed = (moved + turned * (z + slope * (radius + slope * z))) / b
            _passed(work, k, number, t + tw, speed, (z >= low) & (z <= high))


@inner
def _sphere(work: Work, begin: int, end: int, pose: Pose, table: Floats2, e: int) -> None:
    """Where the rays pass a sphere."""
    radius, centre, low, high, number = table[e, RADIUS], table[e, CENTRE], table[e, LOW], table[e, HIGH], float(e)
    tu, tv, tw, au, av, aw, du, dv, dw, cu, cv, cw, rising = pose
    middle = centre * aw
    for k in range(begin, end):
        pu, pv = work[U + k] - tu, work[V + k] - tv
        z0 = pu * au + pv * av
        qu, qv = pu - centre * au, pv - centre * av
        square = radius * radius - qu * qu - qv * qv
        hit = square >= 0.0
        root = math.sqrt(max(square, 0.0))
        steep = 1.0 / max(root, STEEPEST)
        moved = pu * du + pv * dv + centre * (pu * cu + pv * cv - rising)
        along = dw + centre * cw
        t = middle - root
        z = z0 + t * aw
        _passed(work, k, number, t + tw, -(moved + t * along) * steep, hit & (z >= low) & (z <= high))
        t = middle + root
        z = z0 + t * aw
        _passed(work, k, number, t + tw, (moved + t * along) * steep, hit & (z >= low) & (z <= high))


@inner
def _disc(work: Work, begin: int, end: int, pose: Pose, e: int, height: float, radius: float) -> None:
    """Where the rays pass a disc that closes the piece."""
    tu, tv, tw, au, av, aw, _, _, _, cu, cv, cw, rising = pose
    number, inverse = float(e), 1.0 / aw
    across = 1.0 - aw * aw
    for k in range(begin, end):
        pu, pv = work[U + k] - tu, work[V + k] - tv
        z0 = pu * au + pv * av
        t = (height - z0) * inverse
        away = pu * pu + pv * pv - z0 * z0 + (across * t - 2.0 * z0 * aw) * t
        speed = (rising - pu * cu - pv * cv - t * cw) * inverse
        _passed(work, k, number, t + tw, speed, away <= radius * radius)


@inner
def _passed(work: Work, k: int, number: float, at: float, speed: float, hit: bool) -> None:
    """Take up where ray ``k`` passes an element."""
    first, last = work[FIRST + k], work[LAST + k]
    lower, higher = hit & (at < first), hit & (at > last)
    work[FIRST + k] = at if lower else first
    work[ON_FIRST + k] = number if lower else work[ON_FIRST + k]
    work[DOWN + k] = speed if lower else work[DOWN + k]
    work[LAST + k] = at if higher else last
    work[ON_LAST + k] = number if higher else work[ON_LAST + k]
    work[UP + k] = speed if higher else work[UP + k]
