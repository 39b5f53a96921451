"""The place of the zero with the largest least distance of bodies, at one turn: branch and bound over cells.

A cell is a box of places. Few moments, found where they are nearest, bound the least distance within it by a linear
program: their ceilings, and the half-spaces of slides. The place of that bound is asked next; it is better than all
places so far, or brings a new moment. Where ceilings are too far above the distance, the cell is halved.
"""

import heapq
from collections.abc import Callable, Iterator
from dataclasses import field
from itertools import count
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.collisions.clearance import ENOUGH, Clearance, Nearest
from trunnion.placing.collisions.distance_planes import Plane, Witness
from trunnion.placing.largest_margin import EXACT, linear_program
from trunnion.placing.travel_limits import TABLE, CutSet
from trunnion.records import dataclass

#: The search ends when no place can have a distance larger by more, mm, or by more than this share of it; and what of
#: the distance is given up for more margin, as a part of that.
WITHIN: Final = 0.075
WITHIN_SHARE: Final = 0.0075
_GIVEN_UP: Final = 1.0 / 3.0

#: How far from the place with the largest margin places are sought, mm: slides without limits lead on without end.
FARTHEST: Final = 2000.0

#: Linear programs that one turn may cost; and those of one cell before it is halved.
_MOST_PROGRAMS: Final = 3000
_MOST_ROUNDS: Final = 40

#: Part of what is left to gain that a new ceiling must take away, else the cell is halved.
_WORTH: Final = 0.3

#: Rounding of linear programs, mm.
_TRIFLE: Final = 1e-6

#: Rounds in which a place with more margin is sought.
_SETTLING: Final = 25


def tolerance(distance: float) -> float:
    """How much more a place might have than one with a distance, mm."""
    return max(WITHIN, WITHIN_SHARE * distance)


@dataclass(frozen=True, slots=True, eq=False)
class FarthestPlace:
    """A place (3,) with the bodies that are nearest to each other there."""

    zero: Floats
    nearest: Nearest


@dataclass(slots=True, eq=False)
class _Cell:
    low: Floats
    high: Floats
    witnesses: list[tuple[Witness, Floats]] = field(default_factory=list)


class FarthestSearch:
    """Searches the places of one turn.

    cuts    half-spaces of places at which slides keep their limits
    margin  that is kept, mm
    start   (3,) a place
    cap     a larger distance is no better, mm
    coarse  asks some moments; whole, which is made when it is first needed, asks all of them
    bound   after the search: no place has a larger distance, mm
    moments of the whole path at which bodies were nearest
    """

    def __init__(
        self,
        cuts: CutSet,
        margin: float,
        start: Floats,
        cap: float,
        coarse: Clearance,
        whole: Callable[[], Clearance],
    ) -> None:
        self._cuts, self._margin, self._start, self._cap = cuts, margin, start, cap
        self._coarse, self._whole = coarse, whole
        self._best: tuple[Floats, Nearest] | None = None
        self._programs = 0
        self.moments: list[int] = []
        self.bound = ENOUGH

    def search(self, known: float) -> FarthestPlace | None:
        """Return the best place, if it is better than a distance that is ``known``, mm, by more than the tolerance."""
        order = count()
        heap = [(-ENOUGH, next(order), _Cell(*self._extent()))]
        while heap and self._programs < _MOST_PROGRAMS and -heap[0][0] > self._enough(known):
            above, _, cell = heapq.heappop(heap)
            for part, high in self._bounded(cell, -above, known):
                heapq.heappush(heap, (-high, next(order), part))
        self.bound = max(self._enough(known), -heap[0][0] if heap else 0.0)
        if self._best is None:
            return None
        zero, nearest = self._best
        return FarthestPlace(zero, nearest)

    def is_as_good(self, zero: Floats) -> bool:
        """Whether a place (3,) has nearly the distance of the best one."""
        found = self._whole().nearest(zero)
        return found is not None and found.distance >= self._wanted - _TRIFLE and self._whole().inside(zero) is None

    @property
    def _wanted(self) -> float:
        """A distance that is nearly the best one, mm."""
        least = self._cap if self._best is None else min(self._best[1].distance, self._cap)
        return least - _GIVEN_UP * tolerance(least)

    def settled(self) -> Floats:
        """Of places with nearly the distance of the best one that with the largest margin, (3,)."""
        assert self._best is not None
        best, nearest = self._best
        whole, zero, wanted = self._whole(), best, self._wanted
        floors: list[Plane] = []
        while len(floors) < _SETTLING:
            floors.append(Witness.of(whole, nearest).floor(best))
            try:
                zero = self._with_margin(floors, wanted)
            except ArithmeticError:
                return best
            asked = whole.nearest(zero)
            if asked is None or whole.inside(zero) is not None:
                return best
            if asked.distance >= wanted - _TRIFLE:
                return zero
            nearest = asked
        return best

    def _with_margin(self, floors: list[Plane], wanted: float) -> Floats:
        """Return the place with the largest margin at which all floors are at a height, (3,)."""
        ranges = [(-1e5, 1e5)] * 3 + [(None, ENOUGH)]
        while True:
            normals, bounds, slides = self._cuts.table()
            slopes, heights = _rows(floors)
            table = np.block([[normals, (slides != TABLE)[:, None]], [-slopes, np.zeros((len(slopes), 1))]])
            solved = linear_program(
                np.array([0.0, 0.0, 0.0, -1.0]), table, np.concatenate((bounds, heights - wanted)), ranges
            )
            if not self._cuts.add(self._cuts.at(solved.x[:3]), np.full((3, 2), float(solved.x[3]) - EXACT)):
                return np.asarray(solved.x[:3])

    def _enough(self, known: float) -> float:
        """Return a cell with no greater bound holds nothing better."""
        least = known if self._best is None else self._best[1].distance
        return least + tolerance(least)

    def _bounded(self, cell: _Cell, bound: float, known: float) -> Iterator[tuple[_Cell, float]]:
        """Yield the halves of a cell with their bound, unless nothing better is in it."""
        planes, bends = [], np.zeros(3)
        for witness, at in cell.witnesses:
            plane, _ = witness.ceiling(np.clip(at, cell.low, cell.high), cell.low, cell.high)
            planes.append(plane)
        for _ in range(_MOST_ROUNDS):
            try:
                zero, high = self._highest(cell, planes)
            except ArithmeticError:  # no place of the cell keeps the limits
                return
            bound = min(bound, high)
            if bound <= self._enough(known):
                return
            nearest, clearance = self._ask(zero, known)
            if nearest is None or bound <= self._enough(known):
                return
            witness = Witness.of(clearance, nearest)
            plane, bends = witness.ceiling(zero, cell.low, cell.high)
            planes.append(plane)
            cell.witnesses.append((witness, zero))
            left = bound - max(self._enough(known), nearest.distance)
            if plane.height > bound - _WORTH * left:
                break
        side = cell.high - cell.low
        k = int(np.argmax(bends)) if bends.max() > 1e-6 else int(np.argmax(side))
        middle = 0.5 * (cell.low[k] + cell.high[k])
        for end in (0, 1):
            low, high_ = cell.low.copy(), cell.high.copy()
            (high_ if end == 0 else low)[k] = middle
            yield _Cell(low, high_, list(cell.witnesses)), bound

    def _ask(self, zero: Floats, known: float) -> tuple[Nearest | None, Clearance]:
        """Which bodies are nearest at a place, and who found it; a better place is kept."""
        least = known if self._best is None else self._best[1].distance
        found = self._coarse.nearest(zero)
        if found is not None and found.distance <= least:
            return found, self._coarse
        whole = self._whole()
        asked = whole.nearest(zero, ENOUGH if found is None else found.distance)
        if asked is None and found is not None:
            asked = whole.nearest(zero)
        if asked is not None and asked.distance > 0.0 and (inside := whole.inside(zero)) is not None:
            asked = inside
        if asked is not None:
            self.moments.append(asked.moment)
        if asked is not None and asked.distance > least:
            self._best = zero, asked
        return asked, whole

    def _highest(self, cell: _Cell, planes: list[Plane]) -> tuple[Floats, float]:
        """Return the place of a cell (3,) that is highest under all planes, and its height."""
        ranges = [*zip(cell.low.tolist(), cell.high.tolist(), strict=True), (None, self._cap)]
        while True:
            normals, bounds, slides = self._cuts.table()
            slopes, heights = _rows(planes)
            table = np.block([[normals, np.zeros((len(normals), 1))], [-slopes, np.ones((len(slopes), 1))]])
            limits = np.concatenate((bounds - np.where(slides == TABLE, 0.0, self._margin), heights))
            solved = linear_program(np.array([0.0, 0.0, 0.0, -1.0]), table, limits, ranges)
            self._programs += 1
            zero = np.asarray(solved.x[:3])
            if not self._cuts.add(self._cuts.at(zero), np.full((3, 2), self._margin - EXACT)):
                return zero, float(solved.x[3])

    def _extent(self) -> tuple[Floats, Floats]:
        """Return the least box around all places, (3,) each."""
        whole = _Cell(self._start - FARTHEST, self._start + FARTHEST)
        low, high = whole.low.copy(), whole.high.copy()
        for k in range(3):
            for end, sign in ((low, -1.0), (high, 1.0)):
                zero, _ = self._highest(whole, [Plane(self._start, 0.0, sign * np.eye(3)[k])])
                end[k] = zero[k]
        return low, high


def _rows(planes: list[Plane]) -> tuple[Floats, Floats]:
    rows = [plane.row() for plane in planes]
    return np.array([slope for slope, _ in rows]).reshape(-1, 3), np.array([height for _, height in rows])
