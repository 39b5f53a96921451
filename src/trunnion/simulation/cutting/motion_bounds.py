"""Where a piece of the tool may be during a motion: what keeps rays out that it cannot hit.

In:     a ``Motion`` and a ``Piece``.
Out:    a box around what of the piece comes near to a tile, an outline of it in the plane across the rays, and how it
        passes rays that it hits neither at the start nor at the end.
Units:  mm, coordinates (u, v, w) of a bundle.
"""

import math
from typing import Final, NamedTuple, TypeAlias

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner
from trunnion.simulation.cutting.tool_table import (
    CENTRE,
    HIGH,
    LOW,
    RADIUS,
    ROUND,
    SEAM,
    SLOPE,
    Motion,
    Piece,
    axis_between,
)

#: Bounds are wider by this, mm: rays on them are not lost to rounding.
_SLACK: Final = 1e-6

#: Straight edges of an outline, evenly turned.
EDGES: Final = 16
_TURNS: Final = tuple((math.cos(2.0 * math.pi * k / EDGES), math.sin(2.0 * math.pi * k / EDGES)) for k in range(EDGES))

#: Lowest and highest u, v and w.
Box: TypeAlias = tuple[float, float, float, float, float, float]


@inner
def near_part(motion: Motion, piece: Piece, box: Box) -> tuple[float, float]:
    """Return the part of a piece, from z to z, that may reach a box in any pose; none if the first is above
    the second.
    """
    low, high = piece.low, piece.high
    low, high = _near_in(motion.tu, motion.au, motion.du, motion.bu, box[0], box[1], piece, low, high)
    low, high = _near_in(motion.tv, motion.av, motion.dv, motion.bv, box[2], box[3], piece, low, high)
    return _near_in(motion.tw, motion.aw, motion.dw, motion.bw, box[4], box[5], piece, low, high)


@inner
def _near_in(
    tip: float,
    start: float,
    way: float,
    end: float,
    lowest: float,
    highest: float,
    piece: Piece,
    low: float,
    high: float,
) -> tuple[float, float]:
    """Return the part between ``low`` and ``high`` whose discs may lie between two values of one coordinate.

    The bounds move evenly from those of the start to those of the end: in between they are not wider.
    """
    if abs(start) < 1e-3 or abs(end) < 1e-3 or (start > 0.0) != (end > 0.0):
        return low, high
    nearest, farthest = math.inf, -math.inf
    for at, axis in ((tip, start), (tip + way, end)):
        across = piece.widest * math.sqrt(max(0.0, 1.0 - axis * axis))
        one, two = (lowest - across - at) / axis, (highest + across - at) / axis
        nearest, farthest = min(nearest, one, two), max(farthest, one, two)
    return max(low, nearest - _SLACK), min(high, farthest + _SLACK)


@inner
def swept_box(motion: Motion, piece: Piece, low: float, high: float) -> Box:
    """Return a box around a piece in motion, from z ``low`` to ``high``: lowest and highest u, v and w."""
    widest = piece.widest
    u0, u1 = _extent(motion.tu, motion.au, motion.du, motion.bu, low, high, widest)
    v0, v1 = _extent(motion.tv, motion.av, motion.dv, motion.bv, low, high, widest)
    w0, w1 = _extent(motion.tw, motion.aw, motion.dw, motion.bw, low, high, widest)
    return u0, u1, v0, v1, w0, w1


@inner
def _extent(
    tip: float, start: float, way: float, end: float, low: float, high: float, widest: float
) -> tuple[float, float]:
    """Lowest and highest coordinate of a cylinder about the tool axis at the start and the end of a motion.

    Between them the axis is nowhere farther out than at the ends by more than what the motion is divided for.
    """
    lowest, highest = math.inf, -math.inf
    for at, along in ((tip, start), (tip + way, end)):
        across = widest * math.sqrt(max(0.0, 1.0 - along * along))
        lowest = min(lowest, at + min(low * along, high * along) - across)
        highest = max(highest, at + max(low * along, high * along) + across)
    return lowest, highest


@inner
def outline(edges: Floats, motion: Motion, piece: Piece, table: Floats2, low: float, high: float) -> None:
    """Write the outline of a piece in motion, from z ``low`` to ``high``, seen along the rays.

    edges   (3 * EDGES,) for each edge n_u, n_v and d: inside n_u u + n_v v <= d; one pair of edges lies along the piece
    """
    across_u, across_v = 0.5 * (motion.au + motion.bu), 0.5 * (motion.av + motion.bv)
    shown = math.sqrt(across_u * across_u + across_v * across_v)
    if shown < 1e-6:
        across_u, across_v, shown = 1.0, 0.0, 1.0
    across_u, across_v = across_u / shown, across_v / shown
    turned = (motion.bu - motion.au) ** 2 + (motion.bv - motion.av) ** 2 + (motion.bw - motion.aw) ** 2
    # Between the ends the axis is farther out than both by no more than this.
    slack = 0.15 * turned * (max(abs(low), abs(high)) + piece.widest) + _SLACK
    for k in range(EDGES):
        cosine, sine = _TURNS[k]
        u, v = cosine * across_u - sine * across_v, sine * across_u + cosine * across_v
        start, _ = _farthest(motion.au, motion.av, u, v, piece, table, low, high)
        end, _ = _farthest(motion.bu, motion.bv, u, v, piece, table, low, high)
        at_start, at_end = motion.tu * u + motion.tv * v, (motion.tu + motion.du) * u + (motion.tv + motion.dv) * v
        edges[3 * k], edges[3 * k + 1] = u, v
        edges[3 * k + 2] = max(at_start + start, at_end + end) + slack


@inner
def within(edges: Floats, u: float, lowest: float, highest: float) -> tuple[float, float]:
    """Return the values of v at which ``u`` is within an outline, between two others; none: the first is above the
    second.
    """
    for k in range(EDGES):
        across, along, d = edges[3 * k], edges[3 * k + 1], edges[3 * k + 2]
        if along > 1e-9:
            highest = min(highest, (d - across * u) / along)
        elif along < -1e-9:
            lowest = max(lowest, (d - across * u) / along)
        elif across * u > d:
            return 1.0, 0.0
    return lowest, highest


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
    whole = piece.low, piece.high
    low, low_along = _farthest(au, av, -across_u, -across_v, piece, table, *whole)
    high, high_along = _farthest(au, av, across_u, across_v, piece, table, *whole)
    # Seen across, the way is v for u and -u for v.
    return Passage(
        motion.du / way, motion.dv / way, across_u, across_v, -low, high, -low_along / length, high_along / length
    )


@inner
def _farthest(
    au: float, av: float, u: float, v: float, piece: Piece, table: Floats2, low: float, high: float
) -> tuple[float, float]:
    """How far a piece from z ``low`` to ``high`` reaches in a direction across the rays, and where along (v, -u)."""
    along = au * u + av * v
    across = math.sqrt(max(0.0, 1.0 - along * along))
    farthest, at_z, at_radius = -math.inf, 0.0, 0.0
    for e in range(piece.first, piece.end):
        bottom, top = max(table[e, LOW] + SEAM, low), min(table[e, HIGH] - SEAM, high)
        if bottom > top:
            continue
        if table[e, ROUND] == 0.0:
            # Straight: one of its ends.
            z = top if along + table[e, SLOPE] * across > 0.0 else bottom
            radius = max(0.0, table[e, RADIUS] + table[e, SLOPE] * z)
        else:
            z = min(top, max(bottom, table[e, CENTRE] + table[e, RADIUS] * along))
            radius = math.sqrt(max(0.0, table[e, RADIUS] ** 2 - (z - table[e, CENTRE]) ** 2))
        reach = z * along + radius * across
        if reach > farthest:
            farthest, at_z, at_radius = reach, z, radius
    scale = at_radius / across if across > 1e-12 else 0.0
    pu, pv = at_z * au + scale * (u - along * au), at_z * av + scale * (v - along * av)
    return farthest, pu * v - pv * u
