"""Of all turns of a part about Z, and all choices of branches, the one with the largest margin; of tilts also.

The part is first tilted about X of the workpiece frame, then turned about Z, right-handed. A path that is tilted is a
path of its own, whose turns are judged as those of any other.
"""

from collections.abc import Callable, Sequence
from dataclasses import field, replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.model.rotations import about_z
from trunnion.placing.goals import OF_PLACE, Goal, PlaceCost, planned_seconds, rotary_travel
from trunnion.placing.largest_margin import BestPlace, largest_margin
from trunnion.placing.least_cost import least_cost
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import Choice, TurnedPath
from trunnion.records import dataclass

#: Turns whose margins differ by less are alike: of them the least one is taken, mm.
_ALIKE: Final = 1e-6

#: Costs whose shares differ by less are alike.
_LIKE_COST: Final = 1e-4

#: The margin that places with another goal keep where one can be had, mm.
KEPT: Final = 1.0

#: The step to which the best turn of a grid is refined, degrees.
_FINEST: Final = 0.1

#: Share of the margin that is given up for rotary axes with more room, orientations that are asked for it, and the
#: room that is as much, degrees.
_NEARLY: Final = 0.01
_MOST_NEAR: Final = 12
_LIKE_ROOM: Final = 0.01

#: Orientations whose places are timed.
_MOST_TIMED: Final = 5

#: Best ones of a grid of tilts and turns around which the search goes on.
_STARTS: Final = 3

#: Orientations count in whole thousandths of a degree, as programs state them.
_DECIMALS: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class TurnResult:
    """What a turn allows.

    turn      degrees
    tilt      before the turn, about X, degrees
    path      with the choice that has the largest margin; None if rotary axes reach it with none
    cuts      its half-spaces
    best      its best place
    obstacle  where there is no path: why
    choice    that of the path
    cost      of the goal at the best place; None: the goal is the margin, or the part does not fit
    """

    turn: float
    path: TurnedPath | None = None
    cuts: CutSet | None = None
    best: BestPlace | None = None
    obstacle: Obstacle | None = None
    cost: float | None = None
    tilt: float = 0.0
    choice: Choice | None = None

    @property
    def margin(self) -> float:
        """Of the best place, mm; minus infinity if rotary axes do not reach the path."""
        return -np.inf if self.best is None else self.best.margin


def best_of_turn(
    paths: Sequence[TurnedPath],
    turn: float,
    known: dict[int, TurnResult] | None = None,
    goal: Goal = Goal.MARGIN,
) -> TurnResult:
    """Return the best place at a turn, over all choices; ``known`` has, and gets, the last result of each path."""
    best: TurnResult | None = None
    known = {} if known is None else known
    for number, path in enumerate(paths):
        cuts = path.at(turn)
        if isinstance(cuts, Obstacle):
            found = TurnResult(turn, obstacle=cuts)
        else:
            if number in known:
                _follow(cuts, known[number])
            found = known[number] = TurnResult(
                turn, path, cuts, largest_margin(cuts, path.near, settled=False), choice=path.choice
            )
            if goal is not Goal.MARGIN and found.margin >= 0.0:
                found = _with_cost(found, path, cuts, goal)
        if best is None or _is_better(found, best):
            best = found
    assert best is not None
    return best


def _with_cost(found: TurnResult, path: TurnedPath, cuts: CutSet, goal: Goal) -> TurnResult:
    """Return the result with the cheapest place that keeps a margin, and its cost."""
    assert found.best is not None
    angles = path.angles_at(found.turn)
    assert not isinstance(angles, Obstacle)
    rows = path.rows.turned(about_z(found.turn))
    if goal is Goal.ROTARY:
        return replace(found, cost=rotary_travel(rows, angles.positions))
    cost = PlaceCost.of(goal, path.machine, rows, angles.positions)
    cheapest = least_cost(cuts, cost, found.best.zero, min(KEPT, found.margin))
    reached = cuts.at(cheapest.zero)
    best = replace(found.best, zero=cheapest.zero, margin=reached.margin, reached=reached)
    return replace(found, best=best, cost=cheapest.cost)


def _follow(cuts: CutSet, last: TurnResult) -> None:
    assert last.cuts is not None
    assert last.best is not None
    cuts.begin_with(last.cuts, last.best.zero, last.best.margin)


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The orientations that are tried.

    turns    (k,) about Z, degrees
    tilts    (t,) about X before, degrees
    refines_turns, refines_tilts  whether the search goes on between them, around the best
    """

    turns: Floats
    tilts: Floats = field(default_factory=lambda: np.zeros(1))
    refines_turns: bool = False
    refines_tilts: bool = False

    def __len__(self) -> int:
        return len(self.turns) * len(self.tilts)

    def has(self, turn: float, tilt: float) -> bool:
        """Whether an orientation is one of the grid, and not one between them, degrees."""
        near = 0.5 * 10.0**-_DECIMALS
        return bool((np.abs(self.turns - turn) <= near).any() and (np.abs(self.tilts - tilt) <= near).any())

    def steps(self) -> tuple[float, float]:
        """Those of turns and tilts, degrees; 0: not refined."""
        turn = float(self.turns[1] - self.turns[0]) if self.refines_turns and len(self.turns) > 1 else 0.0
        return turn, float(self.tilts[1] - self.tilts[0]) if self.refines_tilts and len(self.tilts) > 1 else 0.0


def best_orientations(
    paths_at: Callable[[float], Sequence[TurnedPath]],
    grid: Grid,
    advance: Callable[[int], None],
    *,
    goal: Goal = Goal.MARGIN,
) -> tuple[list[TurnResult], TurnResult]:
    """Return what each orientation allows, by tilt and turn, refined about the best; and the best of all.

    ``paths_at`` gives the paths of all choices at a tilt, degrees. Only the best result has its path and half-spaces.
    """
    search = _Search(paths_at, goal)
    by_nearness = sorted(grid.tilts.tolist(), key=abs)
    for tilt in by_nearness:
        for turn in grid.turns.tolist():
            search.judge(turn, tilt)
            advance(1)
    turn_step, tilt_step = grid.steps()
    if turn_step or tilt_step:
        limits = min(by_nearness), max(by_nearness)
        for start in search.best_ones(_STARTS if tilt_step else 1):
            search.refine(start, turn_step, tilt_step, limits)
    results = list(search.results.values())
    best = _best(results)
    if goal is Goal.MARGIN:
        best = search.with_most_rotary_room(best)
    whole = search.fastest(best) if goal is Goal.TIME else search.whole(best)
    return sorted(results, key=lambda one: (one.tilt, one.turn)), whole


class _Search:
    """Judges orientations, each of them once."""

    def __init__(self, paths_at: Callable[[float], Sequence[TurnedPath]], goal: Goal) -> None:
        self._paths_at, self._goal = paths_at, goal
        self._known: dict[int, TurnResult] = {}
        self._rooms: dict[tuple[float, Choice, float], float] = {}
        self.results: dict[tuple[float, float], TurnResult] = {}

    def judge(self, turn: float, tilt: float) -> TurnResult:
        """Return the result at an orientation, degrees, without its path and half-spaces: those of many are large."""
        key = (round(turn, _DECIMALS), round(tilt, _DECIMALS))
        if key not in self.results:
            found = best_of_turn(self._paths_at(key[1]), key[0], self._known, self._goal)
            self.results[key] = replace(found, tilt=key[1], path=None, cuts=None)
        return self.results[key]

    def best_ones(self, count: int) -> list[TurnResult]:
        """Return the best of all orientations so far that are within reach."""
        reached = [one for one in self.results.values() if one.best is not None]
        # A stable order: of like ones the least tilt, then the least turn.
        reached.sort(key=lambda one: (one.cost is None, one.cost or 0.0, -round(one.margin, 6)))
        return reached[:count]

    def refine(self, best: TurnResult, turn_step: float, tilt_step: float, limits: tuple[float, float]) -> None:
        """Go on around an orientation with steps that are halved, degrees; tilts stay within limits."""
        while max(turn_step, tilt_step) / 2.0 >= _FINEST:
            turn_step, tilt_step = turn_step / 2.0, tilt_step / 2.0
            tilts = dict.fromkeys((best.tilt, best.tilt - tilt_step, best.tilt + tilt_step))
            around = [
                self.judge((best.turn + side * turn_step) % 360.0 if side else best.turn, tilt)
                for tilt in tilts
                if limits[0] <= tilt <= limits[1]
                for side in ((0.0, -1.0, 1.0) if turn_step else (0.0,))
            ]
            best = _best([best, *around])

    def with_most_rotary_room(self, best: TurnResult) -> TurnResult:
        """Of orientations whose slides have nearly as much room as the best the one whose rotary axes have most."""
        if best.best is None or best.margin < 0.0:
            return best
        near = [one for one in self.best_ones(len(self.results)) if one.margin >= best.margin * (1.0 - _NEARLY)]
        chosen, room = best, self._rotary_room(best)
        for one in near[:_MOST_NEAR]:
            own = self._rotary_room(one)
            if own > room + _LIKE_ROOM:
                chosen, room = one, own
        return chosen

    def fastest(self, best: TurnResult) -> TurnResult:
        """Of the best few orientations, each with its cheapest place and that with the largest margin, the fastest.

        Costs leave accelerations out; the planner of speeds, which is not convex, judges these places.
        """
        if best.cost is None:
            return self.whole(best)
        found: list[tuple[float, TurnResult]] = []
        for one in dict.fromkeys([best, *self.best_ones(_MOST_TIMED)]):
            whole = self.whole(one)
            if whole.path is None or whole.cuts is None or whole.best is None or whole.cost is None:
                continue
            rows, positions = whole.path.rows_at(whole.turn)
            cost = PlaceCost.of(self._goal, whole.path.machine, rows, positions)
            for place in (whole.best, largest_margin(whole.cuts, whole.path.near)):
                seconds = planned_seconds(whole.path.machine, rows, positions, place.zero)
                found.append((seconds, replace(whole, best=place, cost=cost.at(place.zero)[0])))
        least = min(seconds for seconds, _ in found)
        return next(result for seconds, result in found if seconds <= least * (1.0 + _LIKE_COST))

    def _rotary_room(self, result: TurnResult) -> float:
        """Return what an orientation leaves of the travel of the rotary axes, degrees."""
        path = next(path for path in self._paths_at(result.tilt) if path.choice is result.choice)
        key = (result.tilt, path.choice, 0.0 if path.has_like_rotary_room else result.turn)
        if key not in self._rooms:
            _, positions = path.rows_at(result.turn)
            self._rooms[key] = rotary_room(path.machine, positions)
        return self._rooms[key]

    def whole(self, result: TurnResult) -> TurnResult:
        """Return a result with its path, half-spaces and settled place."""
        paths = self._paths_at(result.tilt)
        found = replace(best_of_turn(paths, result.turn, self._known, self._goal), tilt=result.tilt)
        if found.cuts is not None and found.path is not None and self._goal not in OF_PLACE:
            found = replace(found, best=largest_margin(found.cuts, found.path.near))
        return found


def rotary_room(machine: Machine, positions: Floats) -> float:
    """Return what positions (n, 2) leave of the travel of the rotary axes, degrees; infinite where they have
    no limits.
    """
    limits = machine.limits[list(machine.rotary)]
    return float(min((positions.min(axis=0) - limits[:, 0]).min(), (limits[:, 1] - positions.max(axis=0)).min()))


def _best(results: Sequence[TurnResult]) -> TurnResult:
    """Return the least cost, or without any the largest margin; of like ones the first."""
    best = results[0]
    for result in results[1:]:
        if _is_better(result, best):
            best = result
    return best


def _is_better(one: TurnResult, other: TurnResult) -> bool:
    if one.cost is None or other.cost is None:
        return (one.cost is not None) or (other.cost is None and one.margin > other.margin + _ALIKE)
    return one.cost < other.cost * (1.0 - _LIKE_COST) - _ALIKE
