"""The place of a path that is nearest to where a machine was: in tip and tool axis together.

In:     a ``ProgramPath``, recorded tips and tool axes, and for each of them consecutive pieces that are looked at.
Out:    ``Nearest``.
Units:  mm and degrees.

A degree of the tool axis counts as a millimetre of the tip. A first guess takes pieces for straight; then the place in
the piece is refined by the forward map (Gauss-Newton).
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import forward
from trunnion.records import dataclass
from trunnion.verification.recorded.path import ProgramPath

#: What a unit vector of the tool axis is multiplied by, so that a degree is 1.
LEVER: Final = 180.0 / np.pi

#: Pairs of positions and pieces that are worked on at a time, and steps of the refinement.
_PAIRS: Final = 400_000
_STEPS: Final = 6

#: Part of a piece over which its direction is measured.
_STEP: Final = 1e-5


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """The nearest place to each of k positions.

    piece     (k,)    piece of the path; -1: there is none to compare with
    off       (k, 3)  from it to the recorded tip
    axis_off  (k,)    degrees from its tool axis to the recorded one
    """

    piece: Ints
    off: Floats
    axis_off: Floats

    @property
    def measure(self) -> Floats:
        """How far away it is, in tip and tool axis together, (k,); infinite where there is none."""
        return np.where(self.piece >= 0, np.hypot(np.linalg.norm(self.off, axis=1), self.axis_off), np.inf)


def nearest_places(path: ProgramPath, tip: Floats, axis: Floats, low: Ints, high: Ints) -> Nearest:
    """Find the nearest places among the pieces ``low`` to ``high`` (exclusive) of each position, (k,)."""
    count = np.maximum(high - low, 0)
    piece = np.full(len(tip), -1, np.int64)
    ends = np.cumsum(count)
    first = 0
    while first < len(tip):
        end = max(int(np.searchsorted(ends, (ends[first - 1] if first else 0) + _PAIRS, "right")), first + 1)
        part = slice(first, end)
        piece[part] = nearest_pieces(path, tip[part], axis[part], low[part], count[part])[0]
        first = end
    found = np.flatnonzero(piece >= 0)
    off, axis_off = np.full((len(tip), 3), np.nan), np.full(len(tip), np.nan)
    off[found], axis_off[found] = _refined(path, tip[found], axis[found], piece[found])
    return Nearest(piece, off, axis_off)


def nearest_pieces(path: ProgramPath, tip: Floats, axis: Floats, low: Ints, count: Ints) -> tuple[Ints, Floats]:
    """Return the nearest piece to each position, with pieces taken for straight, and how far away it is.

    They are ``count`` pieces from ``low`` on, (k,) each; where none of them is known the piece is -1, infinitely far
    away.
    """
    best, least = np.full(len(tip), -1, np.int64), np.full(len(tip), np.inf)
    of = np.repeat(np.arange(len(tip)), count)
    if not len(of):
        return best, least
    piece = np.repeat(low, count) + np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
    at = _along(path, tip[of], axis[of], piece)[:, None]
    away = tip[of] - path.tip[0, piece] - at * (path.tip[1, piece] - path.tip[0, piece])
    turned = axis[of] - path.axis[0, piece] - at * (path.axis[1, piece] - path.axis[0, piece])
    measure = np.where(path.known[piece], _square(away) + LEVER**2 * _square(turned), np.inf)
    there = count > 0
    begins = (np.cumsum(count) - count)[there]
    least[there] = np.minimum.reduceat(measure, begins)
    hits = np.flatnonzero((measure == least[of]) & np.isfinite(measure))[::-1]
    best[of[hits]] = piece[hits]  # the first of them
    return best, np.sqrt(least)


def _along(path: ProgramPath, tip: Floats, axis: Floats, piece: Ints) -> Floats:
    """Part of straight pieces at which they are nearest, (k,)."""
    way, turn = path.tip[1, piece] - path.tip[0, piece], path.axis[1, piece] - path.axis[0, piece]
    reach = _dot(tip - path.tip[0, piece], way) + LEVER**2 * _dot(axis - path.axis[0, piece], turn)
    length = _square(way) + LEVER**2 * _square(turn)
    return np.clip(np.where(length > 0.0, reach / np.where(length > 0.0, length, 1.0), 0.0), 0.0, 1.0)


def _refined(path: ProgramPath, tip: Floats, axis: Floats, piece: Ints) -> tuple[Floats, Floats]:
    """From the nearest place within each piece to the position: tip (k, 3), and degrees of the tool axis (k,)."""
    begin, way = path.begin[piece], path.end[piece] - path.begin[piece]
    at = _along(path, tip, axis, piece)
    for _ in range(_STEPS):
        low, high = np.maximum(at - _STEP, 0.0), np.minimum(at + _STEP, 1.0)
        before, after = (forward(path.machine, begin + part[:, None] * way) for part in (low, high))
        now = forward(path.machine, begin + at[:, None] * way)
        speed, turn = ((b - a) / (high - low)[:, None] for a, b in zip(before, after, strict=True))
        length = _square(speed) + LEVER**2 * _square(turn)
        step = _dot(speed, tip - now[0]) + LEVER**2 * _dot(turn, axis - now[1])
        at = np.clip(at + np.where(length > 0.0, step / np.where(length > 0.0, length, 1.0), 0.0), 0.0, 1.0)
    now = forward(path.machine, begin + at[:, None] * way)
    chord = np.linalg.norm(axis - now[1], axis=1)
    return tip - now[0], np.degrees(2.0 * np.arcsin(np.minimum(chord / 2.0, 1.0)))


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _square(a: Floats) -> Floats:
    return _dot(a, a)
