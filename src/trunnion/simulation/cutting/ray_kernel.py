"""Rays against a moving tool: the interval of a ray that a convex, revolved piece of the tool passes through.

In:     a ray, the poses of the tool at the ends of a short motion, and a piece of the tool.
Out:    the lowest and the highest point of the ray that the piece reaches in any pose between, and its normals there.
Units:  mm, coordinates (u, v, w) of a bundle: the ray is parallel to w.

Between the ends the tip moves on a straight line and the tool axis on the chord of its great circle. At a part s of the
motion the piece covers one interval [f(s), g(s)] of the ray. For a motion without rotation f is convex and g concave
in s, since the swept solid is convex; with the small rotations of one motion they still are, within the tolerance for
which it is divided. Their extremes are searched with their slopes: the velocity of the point of the tool that touches
the ray gives df/ds = (n . velocity) / n_w. Two tangents bound the extreme from below, so the search ends when no more
than the tolerance can be missing. Every value it returns is one of a real pose of the tool: nothing is removed that
the tool does not reach.

The kernels pass numbers rather than arrays to each other: an array costs more to pass than a ray to compute.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner
from trunnion.simulation.tools.pieces import RevolvedPieces

#: What a hit is on: an element counts from 0, the discs at the lowest and the highest z are below.
LOW_DISC: Final = -1
HIGH_DISC: Final = -2

#: How far beyond the ends of an element a hit still is on it, mm: no ray passes between two of them.
_SEAM: Final = 1e-9

#: Columns of the table of elements.
_LOW, _HIGH, _ROUND, _RADIUS, _SLOPE, _CENTRE, _INVERSE = 0, 1, 2, 3, 4, 5, 6


class Motion(NamedTuple):
    """A short motion: tip and tool axis at its start, the way of the tip, and the tool axis at its end."""

    tu: float
    tv: float
    tw: float
    au: float
    av: float
    aw: float
    du: float
    dv: float
    dw: float
    bu: float
    bv: float
    bw: float


class Piece(NamedTuple):
    """A convex piece: its elements, lowest and highest z, greatest radius, and the radii of the discs that close it."""

    first: int
    end: int
    low: float
    high: float
    widest: float
    low_radius: float
    high_radius: float


class Hit(NamedTuple):
    """The interval of a ray within a piece: whether there is one, both ends, and what they are on."""

    hit: bool
    first: float
    last: float
    on_first: int
    on_last: int


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


def element_table(pieces: RevolvedPieces) -> Floats2:
    """Return the elements as the kernels read them, (e, 7).

    Lowest and highest z; 1 for a sphere; radius of a cone at z = 0, or of the sphere; slope of a cone; centre of a
    sphere; the inverse of the sphere's radius, or of the length of a cone's normal (1, slope).
    """
    table = np.zeros((len(pieces.elements), 7))
    low, high, third, fourth, is_sphere = pieces.elements.T
    sphere = is_sphere == 0.0
    slope = np.where(sphere, 0.0, (fourth - third) / (high - low))
    table[:, _LOW], table[:, _HIGH], table[:, _ROUND] = low - _SEAM, high + _SEAM, sphere
    table[:, _RADIUS] = np.where(sphere, fourth, third - slope * low)
    table[:, _SLOPE], table[:, _CENTRE] = slope, np.where(sphere, third, 0.0)
    table[:, _INVERSE] = 1.0 / np.where(sphere, fourth, np.hypot(1.0, slope))
    return table


def piece_list(pieces: RevolvedPieces, table: Floats2) -> Floats2:
    """Return the fields of ``Piece`` for each piece, (p, 7)."""
    first, end = pieces.first[:-1], pieces.first[1:]
    low, high, widest = pieces.bounds.T
    discs = (_radii(table[first], low), _radii(table[end - 1], high))
    return np.column_stack((first, end, low, high, widest, *discs)).astype(np.float64)


def _radii(table: Floats2, z: Floats) -> Floats:
    round_ = np.sqrt(np.maximum(table[:, _RADIUS] ** 2 - (z - table[:, _CENTRE]) ** 2, 0.0))
    return np.where(table[:, _ROUND] > 0.0, round_, np.maximum(table[:, _RADIUS] + table[:, _SLOPE] * z, 0.0))


@inner
def hits(pu: float, pv: float, au: float, av: float, aw: float, piece: Piece, table: Floats2) -> Hit:
    """The interval of a ray within a piece that does not move, counted from the tip along w.

    pu, pv      the ray, counted from the tip
    au, av, aw  the tool axis
    """
    z0 = pu * au + pv * av
    across = 1.0 - aw * aw
    half = -z0 * aw
    start = pu * pu + pv * pv - z0 * z0
    # The cylinder around the piece.
    if across < 1e-14:
        if start > piece.widest * piece.widest:
            return Hit(False, 0.0, 0.0, 0, 0)
    elif half * half - across * (start - piece.widest * piece.widest) < 0.0:
        return Hit(False, 0.0, 0.0, 0, 0)
    first, last = math.inf, -math.inf
    on_first, on_last = 0, 0
    for e in range(piece.first, piece.end):
        radius = table[e, _RADIUS]
        if table[e, _ROUND] == 0.0:
            slope = table[e, _SLOPE]
            base = radius + slope * z0
            a = across - slope * slope * aw * aw
            b = half - slope * aw * base
            c = start - base * base
        else:
            above = z0 - table[e, _CENTRE]
            a = 1.0
            b = half + aw * above
            c = start + above * above - radius * radius
        if abs(a) < 1e-14:
            if abs(b) < 1e-14:
                continue
            one = -0.5 * c / b
            two = one
        else:
            root = b * b - a * c
            if root < 0.0:
                continue
            root, inverse = math.sqrt(root), 1.0 / a
            one, two = (-b - root) * inverse, (-b + root) * inverse
        z = z0 + one * aw
        if table[e, _LOW] <= z <= table[e, _HIGH]:
            if one < first:
                first, on_first = one, e
            if one > last:
                last, on_last = one, e
        z = z0 + two * aw
        if table[e, _LOW] <= z <= table[e, _HIGH]:
            if two < first:
                first, on_first = two, e
            if two > last:
                last, on_last = two, e
    if abs(aw) > 1e-12:
        t = (piece.low - z0) / aw
        if start + (2.0 * half + across * t) * t <= piece.low_radius * piece.low_radius:
            if t < first:
                first, on_first = t, LOW_DISC
            if t > last:
                last, on_last = t, LOW_DISC
        t = (piece.high - z0) / aw
        if start + (2.0 * half + across * t) * t <= piece.high_radius * piece.high_radius:
            if t < first:
                first, on_first = t, HIGH_DISC
            if t > last:
                last, on_last = t, HIGH_DISC
    return Hit(first < last, first, last, on_first, on_last)


@inner
def hits_between(u: float, v: float, motion: Motion, s: float, piece: Piece, table: Floats2) -> Hit:
    """As ``hits`` at a part of a motion, counted along w from its zero."""
    au, av, aw = axis_between(motion, s)
    tw = motion.tw + s * motion.dw
    found = hits(u - motion.tu - s * motion.du, v - motion.tv - s * motion.dv, au, av, aw, piece, table)
    return Hit(found.hit, found.first + tw, found.last + tw, found.on_first, found.on_last)


@inner
def axis_between(motion: Motion, s: float) -> tuple[float, float, float]:
    """The tool axis at a part of a motion."""
    if s == 0.0:
        return motion.au, motion.av, motion.aw
    if s == 1.0:
        return motion.bu, motion.bv, motion.bw
    u = motion.au + s * (motion.bu - motion.au)
    v = motion.av + s * (motion.bv - motion.av)
    w = motion.aw + s * (motion.bw - motion.aw)
    scale = 1.0 / math.sqrt(u * u + v * v + w * w)
    return u * scale, v * scale, w * scale


@inner
def slope_at(
    u: float, v: float, w: float, motion: Motion, s: float, on: int, table: Floats2
) -> tuple[float, float, float, float]:
    """How fast an end of the interval moves along the ray, per part of the motion, and the tool's normal there.

    The chord of the tool axis is as good as unit vectors: one motion turns by a few degrees.
    """
    au, av, aw = axis_between(motion, s)
    pu, pv, pw = u - motion.tu - s * motion.du, v - motion.tv - s * motion.dv, w - motion.tw - s * motion.dw
    z = pu * au + pv * av + pw * aw
    if on == LOW_DISC:
        nu, nv, nw = -au, -av, -aw
    elif on == HIGH_DISC:
        nu, nv, nw = au, av, aw
    elif table[on, _ROUND] == 0.0:
        slope, length = table[on, _SLOPE], table[on, _INVERSE]
        scale = length / max(table[on, _RADIUS] + slope * z, 1e-12)
        back = scale * z + slope * length
        nu, nv, nw = pu * scale - back * au, pv * scale - back * av, pw * scale - back * aw
    else:
        centre, scale = table[on, _CENTRE], table[on, _INVERSE]
        nu, nv, nw = (pu - centre * au) * scale, (pv - centre * av) * scale, (pw - centre * aw) * scale
    # Velocity of the axis: the part of its chord across it. Of the point: that of the tip, plus rotation.
    cu, cv, cw = motion.bu - motion.au, motion.bv - motion.av, motion.bw - motion.aw
    along = au * cu + av * cv + aw * cw
    cu, cv, cw = cu - along * au, cv - along * av, cw - along * aw
    turned = pu * cu + pv * cv + pw * cw
    speed = (
        nu * (motion.du + z * cu - turned * au)
        + nv * (motion.dv + z * cv - turned * av)
        + nw * (motion.dw + z * cw - turned * aw)
    )
    # Where the tool touches the ray from the side, the end moves infinitely fast.
    if abs(nw) < 1e-12:
        nw = math.copysign(1e-12, nw)
    return speed / nw, nu, nv, nw


@inner
def swept_ends(
    u: float, v: float, motion: Motion, piece: Piece, table: Floats2, tolerance: float, bottom: float, top: float
) -> Ends:
    """The interval of ray (u, v) that a piece passes through during a motion, within ``tolerance``, mm.

    ``bottom`` and ``top`` are the ends of the ray's material. What the interval covers beyond them may be wrong, and an
    interval that cannot reach the material is none.
    """
    nothing = Ends(False, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    lu, lv, lw, hu, hv, hw = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    low, high, low_found, high_found = math.inf, -math.inf, False, False
    down0, down1, up0, up1 = 0.0, 0.0, 0.0, 0.0
    after = hits_between(u, v, motion, 1.0, piece, table)
    if after.hit:
        low, high = after.first, after.last
        low_found, high_found = low <= bottom, high >= top
        if not low_found:
            down1, lu, lv, lw = slope_at(u, v, low, motion, 1.0, after.on_first, table)
            if low - max(down1, 0.0) >= top:
                return nothing
            low_found = down1 <= 0.0
        if not high_found:
            up1, hu, hv, hw = slope_at(u, v, high, motion, 1.0, after.on_last, table)
            if high - min(up1, 0.0) <= bottom:
                return nothing
            high_found = up1 >= 0.0
        if low_found and high_found:
            return Ends(low < top and high > bottom, low, high, lu, lv, lw, hu, hv, hw)
    before = hits_between(u, v, motion, 0.0, piece, table)
    begin = 0.5
    if before.hit:
        if not low_found:
            down0, nu, nv, nw = slope_at(u, v, before.first, motion, 0.0, before.on_first, table)
            if before.first < low:
                low, lu, lv, lw = before.first, nu, nv, nw
            low_found = down0 >= 0.0 or low <= bottom
        if not high_found:
            up0, nu, nv, nw = slope_at(u, v, before.last, motion, 0.0, before.on_last, table)
            if before.last > high:
                high, hu, hv, hw = before.last, nu, nv, nw
            high_found = up0 <= 0.0 or high >= top
    elif not after.hit:
        begin = passing(u, v, motion, piece, table)
        if begin < 0.0:
            return nothing
    if not low_found:
        known = Tangents(before.hit, before.first, down0, after.hit, after.first, down1)
        low, changed, nu, nv, nw = lowest(u, v, motion, piece, table, tolerance, known, begin, 1.0, top)
        if changed:
            lu, lv, lw = nu, nv, nw
    if low >= top:
        return nothing
    if not high_found:
        known = Tangents(before.hit, -before.last, -up0, after.hit, -after.last, -up1)
        high, changed, nu, nv, nw = lowest(u, v, motion, piece, table, tolerance, known, begin, -1.0, -bottom)
        high = -high
        if changed:
            hu, hv, hw = nu, nv, nw
    return Ends(high > bottom, low, high, lu, lv, lw, hu, hv, hw)


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
    motion: Motion,
    piece: Piece,
    table: Floats2,
    tolerance: float,
    known: Tangents,
    begin: float,
    sign: float,
    wanted: float,
) -> tuple[float, bool, float, float, float]:
    """The lowest start of the interval during a motion (sign 1), or the lowest of what its end is below zero (sign -1).

    ``begin`` is where the search begins if nothing is known of both ends; the ray is hit there. What is not below
    ``wanted`` need not be found. Returns the value, whether it is lower than those of the ends, and the tool's normal.
    """
    left, left_known, left_value, left_slope = 0.0, known.at_start, known.start, known.start_slope
    right, right_known, right_value, right_slope = 1.0, known.at_end, known.end, known.end_slope
    best, changed, best_u, best_v, best_w = math.inf, False, 0.0, 0.0, 0.0
    if left_known:
        best = left_value
    if right_known and right_value < best:
        best = right_value
    if (left_known and left_slope >= 0.0) or (right_known and right_slope <= 0.0):
        return best, False, 0.0, 0.0, 0.0
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
        found = hits_between(u, v, motion, s, piece, table)
        if not found.hit:
            if left_known:
                right = s
            else:
                left = s
            continue
        value = found.first if sign > 0.0 else found.last
        slope, nu, nv, nw = slope_at(u, v, value, motion, s, found.on_first if sign > 0.0 else found.on_last, table)
        value, slope = sign * value, sign * slope
        if value < best:
            best, changed, best_u, best_v, best_w = value, True, nu, nv, nw
        if slope < 0.0:
            left, left_known, left_value, left_slope = s, True, value, slope
        elif slope > 0.0:
            right, right_known, right_value, right_slope = s, True, value, slope
        else:
            break
        if right - left < 1e-9:
            break
    return best, changed, best_u, best_v, best_w


class Passage(NamedTuple):
    """A piece that moves across the rays, seen along them: when its inside passes a ray.

    Both ends of the piece across its way are points of it, and so is all of the straight line between them.

    u, v          a ray's place, times these, is the part of the motion in which the tip passes it
    across_u, across_v   unit vector across the way
    low, high     how far the piece reaches across the way from the tip, mm
    low_s, high_s   the parts of the motion by which these ends are ahead of the tip
    """

    u: float
    v: float
    across_u: float
    across_v: float
    low: float
    high: float
    low_s: float
    high_s: float


@inner
def passage(motion: Motion, piece: Piece, table: Floats2) -> Passage:
    """How a piece passes rays; ``high`` is below ``low`` where it moves along them only."""
    way = motion.du * motion.du + motion.dv * motion.dv
    if way < 1e-18:
        return Passage(0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0)
    au, av, _ = axis_between(motion, 0.5)
    length = math.sqrt(way)
    across_u, across_v = -motion.dv / length, motion.du / length
    low, low_along = _farthest(au, av, -across_u, -across_v, piece, table)
    high, high_along = _farthest(au, av, across_u, across_v, piece, table)
    # Seen across, the way is v for u and -u for v.
    return Passage(
        motion.du / way, motion.dv / way, across_u, across_v, -low, high, -low_along / length, high_along / length
    )


@inner
def _farthest(au: float, av: float, u: float, v: float, piece: Piece, table: Floats2) -> tuple[float, float]:
    """How far a piece reaches in a direction across the rays, and where that point is along (v, -u)."""
    along = au * u + av * v
    across = math.sqrt(max(0.0, 1.0 - along * along))
    farthest, at_z, at_radius = -math.inf, 0.0, 0.0
    for e in range(piece.first, piece.end):
        low, high = table[e, _LOW] + _SEAM, table[e, _HIGH] - _SEAM
        top = high
        if table[e, _ROUND] != 0.0:
            top = min(high, max(low, table[e, _CENTRE] + table[e, _RADIUS] * along))
        for z in (low, top):
            if table[e, _ROUND] == 0.0:
                radius = max(0.0, table[e, _RADIUS] + table[e, _SLOPE] * z)
            else:
                radius = math.sqrt(max(0.0, table[e, _RADIUS] ** 2 - (z - table[e, _CENTRE]) ** 2))
            reach = z * along + radius * across
            if reach > farthest:
                farthest, at_z, at_radius = reach, z, radius
    scale = at_radius / across if across > 1e-12 else 0.0
    pu, pv = at_z * au + scale * (u - along * au), at_z * av + scale * (v - along * av)
    return farthest, pu * v - pv * u


@inner
def passing(u: float, v: float, motion: Motion, piece: Piece, table: Floats2) -> float:
    """A part of a motion in which a piece hits a ray that it hits neither at the start nor at the end; -1 for none."""
    way = passage(motion, piece, table)
    qu, qv = u - motion.tu, v - motion.tv
    aside = qu * way.across_u + qv * way.across_v
    if not way.low < aside < way.high:
        return -1.0
    share = (aside - way.low) / (way.high - way.low)
    s = qu * way.u + qv * way.v - way.low_s - share * (way.high_s - way.low_s)
    return s if 0.0 < s < 1.0 and hits_between(u, v, motion, s, piece, table).hit else -1.0
