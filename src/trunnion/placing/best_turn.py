"""Of all turns of a part about Z, and all choices of branches, the one with the largest margin."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.goals import OF_PLACE, Goal, PlaceCost, rotary_travel
from trunnion.placing.largest_margin import BestPlace, largest_margin
from trunnion.placing.least_cost import least_cost
from trunnion.placing.path_rows import about_z
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import TurnedPath

#: Turns whose margins differ by less are alike: of them the least one is taken, mm.
_ALIKE: Final = 1e-6

#: Costs whose shares differ by less are alike.
_LIKE_COST: Final = 1e-4

#: The margin that places with another goal keep where one can be had, mm.
KEPT: Final = 1.0

#: The step to which the best turn of a grid is refined, degrees.
_FINEST: Final = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class TurnResult:
    """What a turn allows.

    turn      degrees
    path      with the choice that has the largest margin; None if rotary axes reach it with none
    cuts      its half-spaces
    best      its best place
    obstacle  where there is no path: why
    cost      of the goal at the best place; None: the goal is the margin, or the part does not fit
    """

    turn: float
    path: TurnedPath | None = None
    cuts: CutSet | None = None
    best: BestPlace | None = None
    obstacle: Obstacle | None = None
    cost: float | None = None

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
    """The best place at a turn, over all choices; ``known`` has, and gets, the last result of each path."""
    best: TurnResult | None = None
    known = {} if known is None else known
    for number, path in enumerate(paths):
        cuts = path.at(turn)
        if isinstance(cuts, Obstacle):
            found = TurnResult(turn, obstacle=cuts)
        else:
            if number in known:
                _follow(cuts, known[number])
            found = known[number] = TurnResult(turn, path, cuts, largest_margin(cuts, path.near, settled=False))
            if goal is not Goal.MARGIN and found.margin >= 0.0:
                found = _with_cost(found, path, cuts, goal)
        if best is None or _is_better(found, best):
            best = found
    assert best is not None
    return best


def _with_cost(found: TurnResult, path: TurnedPath, cuts: CutSet, goal: Goal) -> TurnResult:
    """The result with the cheapest place that keeps a margin, and its cost."""
    assert found.best is not None
    angles = path.angles_at(found.turn)
    assert not isinstance(angles, Obstacle)
    rows = path.rows.turned(about_z(found.turn))
    if goal is Goal.ROTARY:
        return replace(found, cost=rotary_travel(rows, angles.positions))
    cost = PlaceCost.of(goal, path.machine, rows, angles.positions)
    cheapest = least_cost(cuts, cost, found.best.zero, min(KEPT, found.margin))
    reached = cuts.at(cheapest.zero)
    best = replace(found.best, zero=cheapest.zero, margin=float(reached.margins.min()), reached=reached)
    return replace(found, best=best, cost=cheapest.cost)


def _follow(cuts: CutSet, last: TurnResult) -> None:
    assert last.cuts is not None
    assert last.best is not None
    cuts.begin_with(last.cuts, last.best.zero, last.best.margin)


def best_turns(
    paths: Sequence[TurnedPath],
    turns: Floats,
    advance: Callable[[int], None],
    *,
    refine: bool,
    goal: Goal = Goal.MARGIN,
) -> tuple[list[TurnResult], TurnResult]:
    """What each turn (k,) allows, in their order and refined about the best; and the best of all."""
    results: list[TurnResult] = []
    known: dict[int, TurnResult] = {}
    for turn in turns.tolist():
        results.append(best_of_turn(paths, turn, known, goal))
        advance(1)
    best = _best(results)
    step = float(turns[1] - turns[0]) if len(turns) > 1 else 0.0
    while refine and best.best is not None and step / 2.0 >= _FINEST:
        step /= 2.0
        around = [best_of_turn(paths, (best.turn + side * step) % 360.0, known, goal) for side in (-1.0, 1.0)]
        results += around
        best = _best([best, *around])
    if best.cuts is not None and best.path is not None and goal not in OF_PLACE:
        best = replace(best, best=largest_margin(best.cuts, best.path.near))
    return sorted(results, key=lambda one: one.turn), best


def _best(results: Sequence[TurnResult]) -> TurnResult:
    """The least cost, or without any the largest margin; of like ones the first."""
    best = results[0]
    for result in results[1:]:
        if _is_better(result, best):
            best = result
    return best


def _is_better(one: TurnResult, other: TurnResult) -> bool:
    if one.cost is None or other.cost is None:
        return (one.cost is not None) or (other.cost is None and one.margin > other.margin + _ALIKE)
    return one.cost < other.cost * (1.0 - _LIKE_COST) - _ALIKE
