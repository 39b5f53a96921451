"""Rays against a moving tool: the interval of a ray that a convex, revolved piece of the tool passes through.

In:     a ray, what ``pose_kernel`` has found of it at both ends of a short motion, and a piece of the tool.
Out:    the lowest and the highest point of the ray that the piece reaches in any pose between, and its normals there.
Units:  mm, coordinates (u, v, w) of a bundle: the ray is parallel to w.

Between the ends the tip moves on a straight line and the tool axis on the chord of its great circle. At a part s of the
motion the piece covers one interval [f(s), g(s)] of the ray. For a motion without rotation f is convex and g concave
in s, since the swept solid is convex; with the small rotations of one motion they still are, within the tolerance for
which it is divided. Their extremes are searched with their slopes: the velocity of the point of the tool that touches
the ray gives df/ds = (n . velocity) / n_w. Two tangents bound the extreme from below, so the search ends when no more
than the tolerance can be missing. Every value it returns is one of a real pose of the tool: nothing is removed that
the tool does not reach.
"""

import math
from typing import NamedTuple

from trunnion.arrays import Floats2
from trunnion.jit import inner
from trunnion.simulation.cutting.motion_bounds import Passage
from trunnion.simulation.cutting.pose_kernel import AtPose, Work, at_part
from trunnion.simulation.cutting.tool_table import (
    BASE,
    CENTRE,
    INVERSE,
    RAISED,
    SLOPE,
    UPRIGHT,
    Motion,
    Piece,
    axis_between,
)


class Ends(NamedTuple):
    """The interval that a moving piece covers: whether there is one, its ends, and the tool's unit normals there."""

    hit: bool
    low: float
    high: float
    low_u: float
    low_v: float
    low_w: float
    high_u: float
    high_v: float
    high_w: float


@inner
def normal_at(
    u: float, v: float, w: float, motion: Motion, s: float, on: int, table: Floats2
) -> tuple[float, float, float]:
    """Return the tool's normal at a point of it."""
    au, av, aw = axis_between(motion, s)
    pu, pv, pw = u - motion.tu - s * motion.du, v - motion.tv - s * motion.dv, w - motion.tw - s * motion.dw
    z = pu * au + pv * av + pw * aw
    a = table[on, INVERSE] / max(table[on, BASE] + table[on, SLOPE] * z, 1e-12)
    b = table[on, RAISED] - a * (table[on, UPRIGHT] * z + table[on, CENTRE])
    return a * pu + b * au, a * pv + b * av, a * pw + b * aw


@inner
def within_tangents(before: AtPose, after: AtPose) -> tuple[float, float]:
    """Return the interval that a piece covers during a motion, at both ends of which it hits the ray, or more."""
    low = _least(before.first, before.down, after.first, after.down)
    return low, -_least(-before.last, -before.up, -after.last, -after.up)


@inner
def _least(start: float, start_slope: float, end: float, end_slope: float) -> float:
    """Return what a convex function is not below between 0 and 1, by its tangents there."""
    if start_slope >= 0.0 or end_slope <= 0.0:
        return min(start, end)
    return start + start_slope * (end - end_slope - start) / (start_slope - end_slope)


@inner
def swept_ends(
    u: float,
    v: float,
    work: Work,
    motion: Motion,
    way: Passage,
    piece: Piece,
    table: Floats2,
    tolerance: float,
    bottom: float,
    top: float,
    before: AtPose,
    after: AtPose,
) -> Ends:
    """Return the interval of ray (u, v) that a piece passes through during a motion, within ``tolerance``, mm.

    ``before`` and ``after`` are what is known of its start and its end; ``bottom`` and ``top`` the ends of the ray's
    material. What the interval covers beyond them may be wrong, and one that cannot reach the material is none.
    """
    nothing = Ends(False, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    begin = 0.5
    if not (before.hit or after.hit):
        begin = passing(u, v, work, motion, way, piece, table)
        if begin < 0.0:
            return nothing
    low, low_s, low_on, high, high_s, high_on = math.inf, 0.0, 0, -math.inf, 0.0, 0
    if after.hit:
        low, low_s, low_on, high, high_s, high_on = after.first, 1.0, after.on_first, after.last, 1.0, after.on_last
    if before.hit and before.first < low:
        low, low_s, low_on = before.first, 0.0, before.on_first
    if before.hit and before.last > high:
        high, high_s, high_on = before.last, 0.0, before.on_last
    if low > bottom:
        known = Tangents(before.hit, before.first, before.down, after.hit, after.first, after.down)
        value, s, on = lowest(u, v, work, motion, piece, table, tolerance, known, begin, 1.0, top)
        if value < low:
            low, low_s, low_on = value, s, on
    if low >= top:
        return nothing
    if high < top:
        known = Tangents(before.hit, -before.last, -before.up, after.hit, -after.last, -after.up)
        value, s, on = lowest(u, v, work, motion, piece, table, tolerance, known, begin, -1.0, -bottom)
        if -value > high:
            high, high_s, high_on = -value, s, on
    if high <= bottom:
        return nothing
    lu, lv, lw = normal_at(u, v, low, motion, low_s, low_on, table)
    hu, hv, hw = normal_at(u, v, high, motion, high_s, high_on, table)
    return Ends(True, low, high, lu, lv, lw, hu, hv, hw)


class Tangents(NamedTuple):
    """What is known of a convex function at the ends of [0, 1]: whether it has a value there, the value, the slope."""

    at_start: bool
    start: float
    start_slope: float
    at_end: bool
    end: float
    end_slope: float


@inner
def lowest(
    u: float,
    v: float,
    work: Work,
    motion: Motion,
    piece: Piece,
    table: Floats2,
    tolerance: float,
    known: Tangents,
    begin: float,
    sign: float,
    wanted: float,
) -> tuple[float, float, int]:
    """Return the lowest start of the interval during a motion (sign 1), or the lowest of what its end is below zero
    (sign -1).

    ``begin`` is where the search begins if nothing is known of both ends; the ray is hit there. What is not below
    ``wanted`` need not be found. Returns the value, the part of the motion, and the row of the table;
    infinite if none is lower than those of the ends.
    """
    left, left_known, left_value, left_slope = 0.0, known.at_start, known.start, known.start_slope
    right, right_known, right_value, right_slope = 1.0, known.at_end, known.end, known.end_slope
    best, found_value, found_s, found_on = math.inf, math.inf, 0.0, 0
    if left_known:
        best = left_value
    if right_known and right_value < best:
        best = right_value
    if (left_known and left_slope >= 0.0) or (right_known and right_slope <= 0.0):
        return math.inf, 0.0, 0
    s = begin
    for _ in range(24):
        # What may still be gained, and where.
        if left_known and right_known:
            s = (right_value - right_slope * right - left_value + left_slope * left) / (left_slope - right_slope)
            bound = left_value + left_slope * (s - left)
            if bound > best - tolerance or bound >= wanted:
                break
            margin = 0.02 * (right - left)
            s = min(right - margin, max(left + margin, s))
        elif left_known:
            if left_value + left_slope * (right - left) > best - tolerance:
                break
            s = 0.5 * (left + right)
        elif right_known:
            if right_value - right_slope * (right - left) > best - tolerance:
                break
            s = 0.5 * (left + right)
        found = at_part(u, v, work, motion, s, piece, table)
        if not found.hit:
            if left_known:
                right = s
            else:
                left = s
            continue
        value, slope, on = found.first, found.down, found.on_first
        if sign < 0.0:
            value, slope, on = -found.last, -found.up, found.on_last
        if value < best:
            best, found_value, found_s, found_on = value, value, s, on
        if slope < 0.0:
            left, left_known, left_value, left_slope = s, True, value, slope
        elif slope > 0.0:
            right, right_known, right_value, right_slope = s, True, value, slope
        else:
            break
        if right - left < 1e-9:
            break
    return found_value, found_s, found_on


@inner
def passing(u: float, v: float, work: Work, motion: Motion, way: Passage, piece: Piece, table: Floats2) -> float:
    """Return a part of a motion in which a piece hits a ray that it hits neither at the start nor at the end; -1 for
    none.
    """
    qu, qv = u - motion.tu, v - motion.tv
    aside = qu * way.across_u + qv * way.across_v
    if not way.low < aside < way.high:
        return -1.0
    share = (aside - way.low) / (way.high - way.low)
    s = qu * way.u + qv * way.v - way.low_s - share * (way.high_s - way.low_s)
    return s if 0.0 < s < 1.0 and at_part(u, v, work, motion, s, piece, table).hit else -1.0
