"""The place of the workpiece zero from which every slide is farthest from its limits.

With a margin t the linear program is: greatest t, so that normal . z + t <= bound for every half-space. Those that
count are added when the solution violates them; a solution that violates none is that of all. The edges of a table ask
for no margin.
"""

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.placing.travel_limits import FARTHEST, TABLE, Cut, CutSet, Reached
from trunnion.records import dataclass

#: More margin is not sought, mm: a slide with one limit alone would lead the part away without end.
ENOUGH: Final = 2000.0

#: A half-space that is violated by less is met, mm.
EXACT: Final = 1e-8

#: The edge of a table that is violated by less is met, mm: edges are a little farther than they are.
_EDGE_EXACT: Final = 1e-7

#: What slides and table keep where slides have the least margin, mm.
_FREE_SLIDES: Final = np.array([np.nan, np.nan, np.nan, 0.0])

#: So much of a margin is given up where it is kept, mm.
_TRIFLE: Final = 1e-7

#: How exactly HiGHS meets half-spaces: as exactly as it can.
_TOLERANCES: Final = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}

#: Solutions that are tried; the rounds of paths of any length are some twenty.
_MOST_ROUNDS: Final = 500

#: Weights of half-spaces below this are rounding.
_NO_WEIGHT: Final = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class BestPlace:
    """A place with the largest margin.

    zero     (3,) mm
    margin   of the slide that is nearest to a limit, at most ``ENOUGH``, mm; negative: the part fits nowhere, and this
             is the least excess
    reached  where the slides go there
    holds    the half-spaces that keep the margin from growing, the heaviest first
    """

    zero: Floats
    margin: float
    reached: Reached
    holds: tuple[Cut, ...]


@dataclass(frozen=True, slots=True, eq=False)
class _Solution:
    """A place (3,) mm, margins (4,) mm that half-spaces of slides and table keep there, and what its program says."""

    zero: Floats
    margins: Floats
    program: Any

    def holds(self, cuts: CutSet) -> list[Cut]:
        """Return the half-spaces without which the margin would grow, the heaviest first."""
        weights = -self.program.ineqlin.marginals[: len(cuts.cuts)]
        return [cuts.cuts[k] for k in np.argsort(-weights, kind="stable").tolist() if weights[k] > _NO_WEIGHT]


def largest_margin(cuts: CutSet, near: Floats, *, settled: bool = True) -> BestPlace:
    """Return the best place; ``near`` (3,) is where the search begins.

    Of places with the same margin, if ``settled``, the one whose other slides are farthest from their limits, and of
    like ones that next to ``near``; else any.
    """
    if not cuts.knows_slides:
        _seed(cuts, near)
    solution = _solve(cuts, lambda: _greatest_least(cuts, _FREE_SLIDES))
    holds = tuple(solution.holds(cuts))
    if settled:
        solution = _settle(cuts, solution, near)
    reached = cuts.at(solution.zero)
    return BestPlace(solution.zero, min(reached.margin, ENOUGH), reached, holds)


def innermost(cuts: CutSet) -> tuple[Floats, float]:
    """Return the place (3,) with the most left to limits and edges alike, and what that is, mm; ``cuts`` knows some."""
    solution = _solve(cuts, lambda: _greatest_least(cuts, np.full(4, np.nan)))
    return solution.zero, cuts.at(solution.zero).least


def _settle(cuts: CutSet, solution: _Solution, near: Floats) -> _Solution:
    """Keep what holds, and let the other slides have the largest margins in turn.

    Margins that are kept are a trifle smaller than those found: rounding must leave the next program a solution. If it
    leaves none all the same, the last one stands.
    """
    kept = _FREE_SLIDES.copy()
    for _ in range(2):
        held = {cut.slide for cut in solution.holds(cuts) if np.isnan(kept[cut.slide])}
        if not held:
            break
        kept[list(held)] = float(solution.program.x[3]) - _TRIFLE
        if not np.isnan(kept).any():
            break
        try:
            solution = _solve(cuts, lambda: _greatest_least(cuts, kept))
        except ArithmeticError:
            return solution
    margins = np.where(np.isnan(kept), float(solution.program.x[3]) - _TRIFLE, kept)
    try:
        return _solve(cuts, lambda: _nearest(cuts, margins, near))
    except ArithmeticError:
        return solution


def _seed(cuts: CutSet, near: Floats) -> None:
    """Half-spaces of some places around, so that the first solutions are not far away."""
    for step in np.concatenate((np.zeros((1, 3)), 200.0 * np.eye(3), -200.0 * np.eye(3))):
        cuts.add(cuts.at(near + step), np.full((3, 2), np.inf), -np.inf)


def _solve(cuts: CutSet, solve: Callable[[], _Solution]) -> _Solution:
    """Return the solution of a linear program of all half-spaces."""
    for _ in range(_MOST_ROUNDS):
        solution = solve()
        wanted = np.repeat(solution.margins[:TABLE, None], 2, axis=1) - EXACT
        if not cuts.add(cuts.at(solution.zero), wanted, float(solution.margins[TABLE]) - _EDGE_EXACT):
            break
    return solution


def _greatest_least(cuts: CutSet, kept: Floats) -> _Solution:
    """Return the greatest least margin, while slides and table keep ``kept`` (4,) mm; NaN: they have that least one."""
    normals, bounds, slides = cuts.table()
    free = np.isnan(kept[slides])
    table = np.column_stack((normals, free))
    ranges = [(-FARTHEST, FARTHEST)] * 3 + [(None, ENOUGH)]
    bounds = bounds - np.where(free, 0.0, kept[slides])
    solved = linear_program(np.array([0.0, 0.0, 0.0, -1.0]), table, bounds, ranges)
    return _Solution(solved.x[:3], np.where(np.isnan(kept), solved.x[3], kept), solved)


def _nearest(cuts: CutSet, margins: Floats, near: Floats) -> _Solution:
    """Return the place that keeps margins (4,) mm and is next to ``near`` (3,): by its distances along X, Y and Z
    together.
    """
    normals, bounds, slides = cuts.table()
    none, eye = np.zeros((len(normals), 3)), np.eye(3)
    table = np.block([[normals, none], [eye, -eye], [-eye, -eye]])
    ranges = [(-FARTHEST, FARTHEST)] * 3 + [(0.0, None)] * 3
    rows = np.concatenate((bounds - margins[slides], near, -near))
    solved = linear_program(np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]), table, rows, ranges)
    return _Solution(solved.x[:3], margins, solved)


def linear_program(cost: Floats, table: Floats, bounds: Floats, ranges: list[Any]) -> Any:
    """SciPy's solution of: least cost . x, so that table x <= bounds, within ranges."""
    optimize = import_extra("scipy.optimize", "place")
    solved = optimize.linprog(cost, A_ub=table, b_ub=bounds, bounds=ranges, method="highs", options=_TOLERANCES)
    if solved.x is None:
        raise ArithmeticError(f"the linear program of a place has no solution: {solved.message}")
    return solved
