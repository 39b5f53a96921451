"""A tool and its motions as the kernels read them.

In:     ``RevolvedPieces``.
Out:    tables of pieces and their elements; ``Motion`` and ``Piece``.
Units:  mm, coordinates (u, v, w) of a bundle: its rays are parallel to w.

The kernels pass numbers rather than arrays to each other: an array costs more to pass than a ray to compute.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner
from trunnion.simulation.tools.pieces import RevolvedPieces

#: How far beyond the ends of an element a hit still is on it, mm: no ray passes between two of them.
SEAM: Final = 1e-9

#: Columns of the table of elements.
LOW, HIGH, ROUND, RADIUS, SLOPE, CENTRE, INVERSE, BASE, RAISED, UPRIGHT = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9
_COLUMNS: Final = 10

#: The last rows of the table stand for the discs that close a piece.
LOW_DISC: Final = 2
HIGH_DISC: Final = 1


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


def element_table(pieces: RevolvedPieces) -> Floats2:
    """Return the elements as the kernels read them, (e + 2, 10): the last two rows are discs that look down and up.

    LOW, HIGH   lowest and highest z
    ROUND       1 for a sphere
    RADIUS      of a cone at z = 0, or of the sphere
    SLOPE       of a cone
    CENTRE      of a sphere
    INVERSE     of the sphere's radius, or of the length of a cone's normal (1, slope)
    BASE, RAISED, UPRIGHT
                for normals: at a point p, counted from the tip, at the height z it is ``a p + b axis``, with
                ``a = INVERSE / (BASE + SLOPE z)`` and ``b = RAISED - a (UPRIGHT z + CENTRE)``
    """
    count = len(pieces.elements)
    table = np.zeros((count + 2, _COLUMNS))
    own = table[:count]
    low, high, third, fourth, is_sphere = pieces.elements.T
    sphere = is_sphere == 0.0
    slope = np.where(sphere, 0.0, (fourth - third) / (high - low))
    own[:, LOW], own[:, HIGH], own[:, ROUND] = low - SEAM, high + SEAM, sphere
    own[:, RADIUS] = np.where(sphere, fourth, third - slope * low)
    own[:, SLOPE], own[:, CENTRE] = slope, np.where(sphere, third, 0.0)
    own[:, INVERSE] = 1.0 / np.where(sphere, fourth, np.hypot(1.0, slope))
    own[:, BASE] = np.where(sphere, 1.0, own[:, RADIUS])
    own[:, RAISED], own[:, UPRIGHT] = -slope * own[:, INVERSE], ~sphere
    table[count:, BASE] = 1.0
    table[-LOW_DISC, RAISED], table[-HIGH_DISC, RAISED] = -1.0, 1.0
    return table


def piece_list(pieces: RevolvedPieces, table: Floats2) -> Floats2:
    """Return the fields of ``Piece`` for each piece, (p, 7)."""
    first, end = pieces.first[:-1], pieces.first[1:]
    low, high, widest = pieces.bounds.T
    discs = (_radii(table[first], low), _radii(table[end - 1], high))
    return np.column_stack((first, end, low, high, widest, *discs)).astype(np.float64)


def _radii(table: Floats2, z: Floats) -> Floats:
    round_ = np.sqrt(np.maximum(table[:, RADIUS] ** 2 - (z - table[:, CENTRE]) ** 2, 0.0))
    return np.where(table[:, ROUND] > 0.0, round_, np.maximum(table[:, RADIUS] + table[:, SLOPE] * z, 0.0))


@inner
def axis_between(motion: Motion, s: float) -> tuple[float, float, float]:
    """Return the tool axis at a part of a motion."""
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
def axis_speed(motion: Motion, au: float, av: float, aw: float) -> tuple[float, float, float]:
    """How fast a tool axis of a motion turns, per part of the motion: what of the chord is across it.

    The chord is as good as the arc: one motion turns by a few degrees.
    """
    cu, cv, cw = motion.bu - motion.au, motion.bv - motion.av, motion.bw - motion.aw
    along = au * cu + av * cv + aw * cw
    return cu - along * au, cv - along * av, cw - along * aw
