"""Of all turns of a part about Z, and all choices of branches, the one with the largest margin."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.largest_margin import BestPlace, largest_margin
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import TurnedPath

#: Turns whose margins differ by less are alike: of them the least one is taken, mm.
_ALIKE: Final = 1e-6

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
    """

    turn: float
    path: TurnedPath | None = None
    cuts: CutSet | None = None
    best: BestPlace | None = None
    obstacle: Obstacle | None = None

    @property
    def margin(self) -> float:
        """Of the best place, mm; minus infinity if rotary axes do not reach the path."""
        return -np.inf if self.best is None else self.best.margin


def best_of_turn(paths: Sequence[TurnedPath], turn: float, known: dict[int, TurnResult] | None = None) -> TurnResult:
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
        if best is None or found.margin > best.margin + _ALIKE:
            best = found
    assert best is not None
    return best


def _follow(cuts: CutSet, last: TurnResult) -> None:
    assert last.cuts is not None
    assert last.best is not None
    cuts.begin_with(last.cuts, last.best.zero, last.best.margin)


def best_turns(
    paths: Sequence[TurnedPath], turns: Floats, advance: Callable[[int], None], *, refine: bool
) -> tuple[list[TurnResult], TurnResult]:
    """What each turn (k,) allows, in their order and refined about the best; and the best of all."""
    results: list[TurnResult] = []
    known: dict[int, TurnResult] = {}
    for turn in turns.tolist():
        results.append(best_of_turn(paths, turn, known))
        advance(1)
    best = _best(results)
    step = float(turns[1] - turns[0]) if len(turns) > 1 else 0.0
    while refine and best.best is not None and step / 2.0 >= _FINEST:
        step /= 2.0
        around = [best_of_turn(paths, (best.turn + side * step) % 360.0, known) for side in (-1.0, 1.0)]
        results += around
        best = _best([best, *around])
    if best.cuts is not None and best.path is not None:
        best = replace(best, best=largest_margin(best.cuts, best.path.near))
    return sorted(results, key=lambda one: one.turn), best


def _best(results: Sequence[TurnResult]) -> TurnResult:
    """The largest margin; of like ones the first."""
    best = results[0]
    for result in results[1:]:
        if result.margin > best.margin + _ALIKE:
            best = result
    return best
