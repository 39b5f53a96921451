"""Of all turns of a part, and all choices of branches, the place at which bodies stay farthest apart."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.clamping import Clamping
from trunnion.placing.best_turn import KEPT, Grid, TurnResult
from trunnion.placing.collisions.clearance import ENOUGH, Clearance, Nearest
from trunnion.placing.collisions.guarded_pairs import Changes, GuardedPair
from trunnion.placing.collisions.path_samples import PathSamples, path_samples
from trunnion.placing.collisions.search import FarthestSearch
from trunnion.placing.largest_margin import BestPlace, largest_margin
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.travel_limits import TABLE, Cut, CutSet
from trunnion.placing.turns import TurnedPath
from trunnion.records import dataclass

#: PathSamples that are asked first, and rows beside them where bodies were nearest at earlier turns.
_COARSE: Final = 400
_MOST_ROWS: Final = 200

#: Steps to which the best turn is refined, degrees.
_FINEST: Final = 0.1

#: Orientations count in whole thousandths of a degree.
_DECIMALS: Final = 3

#: A half-space with no more left than what is kept and this, mm, holds a place.
_HOLDS: Final = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class Guard:
    """What is kept apart: pairs of bodies, the tool of each row (n,), and lengths of tools, mm.

    ``left_out`` names the bodies of the machine that are no pair since they overlap at home.
    """

    pairs: tuple[GuardedPair, ...]
    tool: Ints
    lengths: Mapping[int, float]
    left_out: tuple[tuple[str, str], ...] = ()

    def without(self, pairs: Sequence[GuardedPair]) -> "Guard":
        """Return the same without some pairs."""
        return replace(self, pairs=tuple(pair for pair in self.pairs if pair not in pairs)) if pairs else self

    @property
    def is_changed(self) -> bool:
        """Whether place or turn change how far any two bodies are apart."""
        return bool(self.that(Changes.PLACE, Changes.TURN))

    def that(self, *changes: Changes) -> list[GuardedPair]:
        """Return the pairs that something changes."""
        return [pair for pair in self.pairs if pair.changes in changes]


@dataclass(frozen=True, slots=True, eq=False)
class NearestRow:
    """Two bodies where they are nearest to each other at a place: their names, their distance, mm, and the row."""

    names: tuple[str, str]
    distance: float
    row: int


class Oriented:
    """A path at a turn, with what asks about its bodies; made when it is needed."""

    def __init__(
        self, path: TurnedPath, guard: Guard, turn: float, tilt: float, near: Floats, rows: Sequence[int] = ()
    ) -> None:
        self._path, self._guard, self._near = path, guard, near
        self._rows = np.array(rows, np.int64)
        self._turn, self._tilt = turn, tilt

    @cached_property
    def moments(self) -> PathSamples:
        """All moments."""
        rows, positions = self._path.rows_at(self._turn)
        return path_samples(self._path.machine, rows, positions, self._guard.tool, self._guard.lengths)

    @cached_property
    def coarse(self) -> PathSamples:
        """Some of them."""
        return self.moments.some(_COARSE, self._rows)

    def asked(self, moments: PathSamples, *changes: Changes) -> Clearance:
        """Asks pairs that something changes."""
        turn = Clamping(self._turn, self._tilt).rotation
        return Clearance(self._path.machine, moments, self._guard.that(*changes), turn, self._near)


class ClearanceSearch:
    """Judges orientations, each of them once, and keeps the best."""

    def __init__(self, paths_at: Callable[[float], Sequence[TurnedPath]], guard: Guard) -> None:
        self._paths_at, self._guard = paths_at, guard
        self.results: dict[tuple[float, float], TurnResult] = {}
        self.best: tuple[TurnResult, Oriented, FarthestSearch | None] | None = None
        self.known, self.bound, self.weight = 0.0, 0.0, 1.0
        self._rows: dict[int, None] = {}

    def judge(self, turn: float, tilt: float) -> TurnResult:
        """Return the result at an orientation, degrees: its cost is the distance, where that is larger than
        all before.
        """
        key = (round(turn, _DECIMALS), round(tilt, _DECIMALS))
        if key not in self.results:
            found = [self._judge(path, *key) for path in self._paths_at(key[1])]
            best = max(found, key=lambda one: (one.cost or 0.0, one.margin))
            self.results[key] = replace(best, path=None, cuts=None)
        return self.results[key]

    def _judge(self, path: TurnedPath, turn: float, tilt: float) -> TurnResult:
        cuts = path.at(turn)
        if isinstance(cuts, Obstacle):
            return TurnResult(turn, obstacle=cuts, tilt=tilt)
        best = largest_margin(cuts, path.near, settled=False)
        result = TurnResult(turn, path, cuts, best, choice=path.choice, tilt=tilt)
        if result.margin < 0.0:
            return result
        oriented = Oriented(path, self._guard, turn, tilt, best.zero, list(self._rows)[-_MOST_ROWS:])
        of_turn = self._of_turn(oriented, best.zero)
        if of_turn is not None and of_turn.distance <= self.known:
            return result
        if not self._guard.that(Changes.PLACE):
            return self._kept(result, oriented, of_turn)
        margin = min(KEPT, best.margin)
        search = FarthestSearch(
            cuts, margin, best.zero, ENOUGH if of_turn is None else of_turn.distance,
            oriented.asked(oriented.coarse, Changes.PLACE),
            lambda: oriented.asked(oriented.moments, Changes.PLACE),
        )  # fmt: skip
        found = search.search(self.known)
        self._rows |= dict.fromkeys(oriented.moments.row[search.moments].tolist())
        above = search.bound if of_turn is None else min(search.bound, of_turn.distance)
        self.bound = max(self.bound, above)
        if found is None:
            return result
        result = replace(result, best=replace(best, zero=found.zero, reached=cuts.at(found.zero)))
        return self._kept(result, oriented, min_of(found.nearest, of_turn), search)

    def _kept(
        self, result: TurnResult, oriented: Oriented, nearest: Nearest | None, search: FarthestSearch | None = None
    ) -> TurnResult:
        """Return the result with its distance, if that is the largest so far."""
        if nearest is None or nearest.distance <= self.known:
            return result
        self.known, self.weight = nearest.distance, nearest.pair.weight
        self.bound = max(self.bound, self.known)
        result = replace(result, cost=self.known)
        self.best = result, oriented, search
        return result

    def _of_turn(self, oriented: Oriented, zero: Floats) -> Nearest | None:
        """Return the nearest of pairs that the turn alone changes; what is found first suffices if it is no better."""
        if not self._guard.that(Changes.TURN):
            return None
        some = oriented.asked(oriented.coarse, Changes.TURN).nearest(zero)
        if some is not None and some.distance <= self.known:
            return some
        asked = oriented.asked(oriented.moments, Changes.TURN)
        return asked.inside(zero) or asked.nearest(zero)

    def refine(self, turn_step: float, tilt_step: float, limits: tuple[float, float]) -> None:
        """Go on around the best orientation with steps that are halved, degrees; tilts stay within limits."""
        while self.best is not None and max(turn_step, tilt_step) / 2.0 >= _FINEST:
            turn_step, tilt_step = turn_step / 2.0, tilt_step / 2.0
            turn, tilt = self.best[0].turn, self.best[0].tilt
            for tilted in dict.fromkeys((tilt, tilt - tilt_step, tilt + tilt_step)):
                for side in (-1.0, 0.0, 1.0) if turn_step else (0.0,):
                    if limits[0] <= tilted <= limits[1]:
                        self.judge((turn + side * turn_step) % 360.0 if side else turn, tilted)


def farthest_orientations(
    paths_at: Callable[[float], Sequence[TurnedPath]], grid: Grid, guard: Guard, advance: Callable[[int], None]
) -> tuple[list[TurnResult], TurnResult, float | None]:
    """Return what each orientation allows, by tilt and turn, refined about the best; the best; and the distance that no
    place
    at any of these is above, mm; None where bodies of one side of the machine are what holds it.

    Where bodies touch everywhere, or nothing changes how far they are apart, the best is that with the largest margin.
    """
    search = ClearanceSearch(paths_at, guard)
    by_nearness = sorted(grid.tilts.tolist(), key=abs)
    for tilt in by_nearness:
        for turn in grid.turns.tolist():
            search.judge(turn, tilt)
            advance(1)
    search.refine(*grid.steps(), (min(by_nearness), max(by_nearness)))
    results = sorted(search.results.values(), key=lambda one: (one.tilt, one.turn))
    if search.best is None:
        best = max(search.results.values(), key=lambda one: one.margin)
        return results, _with_largest_margin(paths_at, best), search.bound
    result, _, asked = search.best
    assert result.path is not None
    assert result.best is not None
    assert result.cuts is not None
    place = largest_margin(result.cuts, result.path.near)
    if asked is not None and not asked.is_as_good(place.zero):
        zero = asked.settled()
        reached, holds = result.cuts.at(zero), _holding(result.cuts, zero, min(KEPT, result.margin))
        place = BestPlace(zero, reached.margin, reached, holds)
    return results, replace(result, best=place), search.bound if search.weight == 1.0 else None


def min_of(one: Nearest, other: Nearest | None) -> Nearest:
    """Return the nearer of two."""
    return one if other is None or one.distance <= other.distance else other


def _with_largest_margin(paths_at: Callable[[float], Sequence[TurnedPath]], result: TurnResult) -> TurnResult:
    """Return a result with its path and half-spaces again, at the place with the largest margin."""
    for path in paths_at(result.tilt):
        cuts = path.at(result.turn)
        if path.choice is result.choice and isinstance(cuts, CutSet):
            return replace(result, path=path, cuts=cuts, best=largest_margin(cuts, path.near))
    return result


def nearest_at(
    path: TurnedPath, guard: Guard, turn: float, tilt: float, zero: Floats, *changes: Changes
) -> NearestRow | None:
    """Of pairs that something changes the two bodies that are nearest to each other at a place (3,); None: no pairs."""
    if not guard.that(*changes):
        return None
    oriented = Oriented(path, guard, turn, tilt, zero)
    asked = oriented.asked(oriented.moments, *changes)
    found = asked.inside(zero) or asked.nearest(zero)
    if found is None:
        return None
    return NearestRow(found.pair.names, found.distance / found.pair.weight, int(oriented.moments.row[found.moment]))


def _holding(cuts: CutSet, zero: Floats, margin: float) -> tuple[Cut, ...]:
    """Return the half-spaces that hold a place (3,), the nearest first, one for each end of a slide."""
    lefts = sorted(((cut.bound - float(np.dot(cut.normal, zero)), k) for k, cut in enumerate(cuts.cuts)))
    held: dict[tuple[int, int], Cut] = {}
    for left, k in lefts:
        if left <= (0.0 if cuts.cuts[k].slide == TABLE else margin) + _HOLDS:
            held.setdefault((cuts.cuts[k].slide, cuts.cuts[k].side), cuts.cuts[k])
    return tuple(held.values())
