"""Where a piece of the tool may be during a motion: what keeps rays out that it cannot hit.

In:     a ``Motion`` and a ``Piece``.
Out:    a box around what of the piece comes near to a tile, and a strip in the plane across the rays.
Units:  mm, coordinates (u, v, w) of a bundle.
"""

import math
from typing import Final, NamedTuple

from trunnion.jit import inner
from trunnion.simulation.cutting.ray_kernel import Motion, Piece

#: Bounds are wider by this, mm: rays on them are not lost to rounding.
_SLACK: Final = 1e-6


class Strip(NamedTuple):
    """A piece in motion seen along the rays: a strip about its axis half-way, beyond which no ray is hit.

    u, v            the tip half-way
    u_axis, v_axis  the tool axis half-way; shorter as it is seen more from its end
    widest          half the strip's width, times the length of (u_axis, v_axis)
    along           which way the tip moves across the strip; 0 where the tool is seen from its end, or moves along it
    """

    u: float
    v: float
    u_axis: float
    v_axis: float
    widest: float
    along: float


@inner
def strip(motion: Motion, piece: Piece) -> Strip:
    u_axis, v_axis = 0.5 * (motion.au + motion.bu), 0.5 * (motion.av + motion.bv)
    turned = math.sqrt((motion.bu - motion.au) ** 2 + (motion.bv - motion.av) ** 2 + (motion.bw - motion.aw) ** 2)
    # Across the strip the tip leaves the middle by half of its way there, and the axis by half of its rotation.
    along = motion.du * v_axis - motion.dv * u_axis
    shown = math.sqrt(u_axis * u_axis + v_axis * v_axis)
    reach = max(abs(piece.low), abs(piece.high))
    widest = (piece.widest + 0.5 * turned * reach + 1e-6) * shown + 0.5 * abs(along)
    if shown < 1e-6:
        widest = math.inf
    if shown < 0.1 or along * along < 1e-3 * shown * shown * (motion.du**2 + motion.dv**2):
        along = 0.0
    return Strip(motion.tu + 0.5 * motion.du, motion.tv + 0.5 * motion.dv, u_axis, v_axis, widest, along)


@inner
def near_part(
    motion: Motion, piece: Piece, box: tuple[float, float, float, float, float, float]
) -> tuple[float, float]:
    """The part of a piece, from z to z, that may reach a box in any pose; none if the first is above the second."""
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
    """The part between ``low`` and ``high`` whose discs may lie between two values of one coordinate.

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
def swept_box(motion: Motion, piece: Piece, low: float, high: float) -> tuple[float, float, float, float, float, float]:
    """A box around a piece in motion, from z ``low`` to ``high``: lowest and highest u, v and w."""
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
