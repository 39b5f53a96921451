"""Rows round one blade: from its trailing edge along one side, round the leading edge, and back along the other.

In:     a sheet: where the ball's centre is at a station and a depth.
Out:    passes along the stations, as dense as a tolerance asks, in the order and directions of a way.
Units:  mm.

Stations are numbered by ``s``: 0 to 1 from the trailing to the leading edge on side +1, 1 to 2 round the leading edge,
2 to 3 back on side -1, 3 to 4 round the trailing edge if that is round. So the blade is on the right of the tool's way,
seen from its holder, and a tool that turns clockwise climbs.
"""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Final, Protocol

import numpy as np

from trunnion.arrays import Floats, distinct
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import Stations
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.passes import Pass, PassFamily, Stepover, Way
from trunnion.messages import Wording

#: Stations on each part of the way round before any are added.
_FIRST: Final = 33

#: Part of the tolerance that chords of the rows that are looked at may take: there are rows between them.
_SHARE: Final = 0.7

#: How often stations are added.
_ROUNDS: Final = 4

#: Depths at which rows are looked at.
_LOOKS: Final = 9

#: Steps in depth by which the distance between rows is measured.
_DEPTHS: Final = 65

#: Passes of a cut trailing edge end when the ball is so far out of the stock's cylinder, mm.
_CLEAR: Final = 0.2


class Sheet(Protocol):
    """Where the ball is at each of its stations, by a depth that goes from 0 to ``deepest``."""

    @property
    def deepest(self) -> float:
        """The depth of the last row."""

    def balls(self, depth: Floats) -> tuple[Floats, Floats]:
        """Centres and normals (k, 3) at depths (k,), one for each station."""


def stations_at(s: Floats, end: float) -> Stations:
    """Return the stations of numbers (k,); sides go to w = ``end``."""
    part = np.select([s <= 1.0, s < 2.0, s <= 3.0, s < 4.0], [2, 1, 0, 3], 2)
    at = np.select([s <= 1.0, s < 2.0, s <= 3.0, s < 4.0], [end * (1.0 - s), 2.0 - s, end * (s - 2.0), 4.0 - s], end)
    return Stations(part.astype(np.int64), at)


def side_end(impeller: Impeller, blade: Blade, reach: float) -> float:
    """w to which passes go: 1 at a round trailing edge, else where a ball at ``reach`` from the blade is out of stock.

    The blade goes on straight there.
    """
    if impeller.definition.trailing_edge == "round":
        return 1.0
    radius = impeller.definition.stock.diameter / 2.0 + reach + _CLEAR
    v = np.linspace(0.0, 1.0, 17)
    end = 1.0
    while end < 2.0:
        at = np.full(len(v), end)
        half = blade.halves(at, v)
        ends = [c + (half + reach)[:, None] * m for c, m in (blade.sides(at, v, side) for side in (1.0, -1.0))]
        if min(np.hypot(one[:, 0], one[:, 1]).min() for one in ends) >= radius:
            return end
        end += 0.01
    raise InputError(Problem(impeller.definition.file, 0, Wording("IMP327", "ball_does_not")))


def dense_stations(build: Callable[[Floats], Sheet], last: float, tolerance: float) -> Floats:
    """Numbers (k,) of stations from 0 to ``last`` whose chords are within a tolerance."""
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _FIRST))
    s = distinct(np.concatenate([part + share for part in range(int(last))]))
    for _ in range(_ROUNDS):
        middle = (s[1:] + s[:-1]) / 2.0
        every = np.sort(np.concatenate((s, middle)))
        sheet = build(every)
        sag = np.zeros(len(middle))
        for depth in np.linspace(0.0, sheet.deepest, _LOOKS):
            centre = sheet.balls(np.full(len(every), depth))[0]
            sag = np.maximum(sag, _sag(centre[:-2:2], centre[1::2], centre[2::2]))
        pieces = np.maximum(np.ceil(np.sqrt(sag / (_SHARE * tolerance))), 1.0).astype(int)
        if pieces.max() == 1:
            break
        s = np.r_[
            np.concatenate([a + (b - a) * np.arange(n) / n for (a, b), n in zip(pairwise(s), pieces, strict=True)]),
            last,
        ]
    return s


def _sag(first: Floats, middle: Floats, last: Floats) -> Floats:
    """How far points (k, 3) are off the chords between two others."""
    along = last - first
    square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-24)
    share = np.clip(np.einsum("ij,ij->i", middle - first, along) / square, 0.0, 1.0)
    return np.asarray(np.linalg.norm(middle - first - share[:, None] * along, axis=1))


def row_depths(sheet: Sheet, count: int, first: float, last: float, radius: float, stepover: Stepover) -> Floats:
    """Depths of rows from ``first`` to ``last``, nowhere farther apart on the surface than a step-over.

    ``count`` is the number of stations of the sheet, ``radius`` that of its ball.
    """
    depths = np.linspace(first, last, _DEPTHS)
    found = [sheet.balls(np.full(count, depth)) for depth in depths]
    normal = np.stack([one for _, one in found])
    moved = np.diff(np.stack([centre - radius * m for centre, m in found]), axis=0)
    square = np.einsum("ijk,ijk->ij", moved, moved)
    bends = np.einsum("ijk,ijk->ij", np.diff(normal, axis=0), moved)
    far = square > 1e-12
    bend = float((bends[far] / square[far]).max()) if far.any() else 0.0
    apart = np.r_[0.0, np.cumsum(np.sqrt(square).max(axis=1))] / stepover.on(radius, bend)
    if apart[-1] < 1e-9:
        return np.array([last])
    steps = max(math.ceil(apart[-1] - 1e-9), 1)
    return np.interp(np.linspace(0.0, apart[-1], steps + 1), apart, depths)


def lay_passes(sheet: Sheet, s: Floats, rows: Floats, radius: float, way: Way) -> PassFamily:
    """Return passes of a sheet over the stations ``s`` at the depths of rows, from the first to the last.

    A spiral begins with a whole turn at the first row and ends with one at the last; between them it sinks evenly.

    Raises ``InputError`` if a spiral is wanted and the stations do not go all the way round.
    """
    if way is Way.SPIRAL and s[-1] < 4.0:
        raise InputError(
            argument_problem(
                "way", Wording("IMP327", "spiral_trailing_edge", one_way=Way.ONE_WAY, both_ways=Way.BOTH_WAYS)
            )
        )
    centres = np.stack([sheet.balls(np.full(len(s), depth))[0] for depth in rows])
    lengths = np.linalg.norm(np.diff(centres, axis=1), axis=2).mean(axis=0)
    along = _shares(lengths)
    steps = np.linalg.norm(np.diff(centres, axis=0), axis=2).mean(axis=1)
    across = _shares(steps)

    def row(depth: Floats) -> Pass:
        centre, normal = sheet.balls(depth)
        return Pass(centre, normal, np.column_stack((along, np.interp(depth, rows, across))))

    if way is Way.SPIRAL:
        turns = [row(a + along * (b - a)) for a, b in pairwise(np.r_[rows[0], rows, rows[-1]])]
        return PassFamily((_joined(turns),), radius, way)
    passes = [row(np.full(len(s), depth)) for depth in rows]
    if way is Way.BOTH_WAYS:
        passes = [one.backwards() if k % 2 else one for k, one in enumerate(passes)]
    return PassFamily(tuple(passes), radius, way)


def _shares(lengths: Floats) -> Floats:
    """How far along (n + 1,) each end of n lengths is, from 0 to 1."""
    so_far = np.r_[0.0, np.cumsum(lengths)]
    return np.asarray(so_far / max(so_far[-1], 1e-300))


def _joined(turns: list[Pass]) -> Pass:
    """One pass of turns that follow each other; each begins where the last one ended."""
    rest = [slice(1 if k else 0, None) for k in range(len(turns))]
    return Pass(
        np.concatenate([one.centre[part] for one, part in zip(turns, rest, strict=True)]),
        np.concatenate([one.normal[part] for one, part in zip(turns, rest, strict=True)]),
        np.concatenate([one.place[part] for one, part in zip(turns, rest, strict=True)]),
    )
