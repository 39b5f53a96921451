"""The place with the least cost among those that keep a margin: cutting planes of a convex function (Kelley).

Each place that is tried gives a plane below the cost; the next one to be tried is the lowest point of all planes within
the half-spaces known so far. Its height is a bound: no place costs less.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.goals import PlaceCost
from trunnion.placing.largest_margin import EXACT, linear_program
from trunnion.placing.travel_limits import FARTHEST, TABLE, CutSet
from trunnion.records import dataclass

#: The search ends when no place can cost less by more than this share.
_SHARE: Final = 1e-3

_MOST_ROUNDS: Final = 120


@dataclass(frozen=True, slots=True, eq=False)
class CheapestPlace:
    """A place (3,) with its cost, the number of rows whose feed is not reached, and a bound that no place is below."""

    zero: Floats
    cost: float
    count: int
    bound: float


def least_cost(cuts: CutSet, cost: PlaceCost, start: Floats, margin: float) -> CheapestPlace:
    """Return the cheapest place that keeps a margin, mm; ``start`` (3,) keeps it."""
    value, gradient, count = cost.at(start)
    best = CheapestPlace(start, value, count, 0.0)
    planes, heights = [gradient], [value - float(gradient @ start)]
    for _ in range(_MOST_ROUNDS):
        zero, bound = _lowest(cuts, np.array(planes), np.array(heights), margin)
        if not cuts.add(cuts.at(zero), np.full((3, 2), margin - EXACT)) and cuts.at(zero).margin > -1e-6:
            value, gradient, count = cost.at(zero)
            if (value, count) < (best.cost, best.count):
                best = CheapestPlace(zero, value, count, bound)
        else:
            value, gradient, _ = cost.at(zero)
        if best.cost - bound <= _SHARE * max(best.cost, EXACT):
            break
        planes.append(gradient)
        heights.append(value - float(gradient @ zero))
    return CheapestPlace(best.zero, best.cost, best.count, max(bound, 0.0))


def _lowest(cuts: CutSet, planes: Floats, heights: Floats, margin: float) -> tuple[Floats, float]:
    """Return the lowest point (3,) of planes within the half-spaces, and its height."""
    normals, bounds, slides = cuts.table()
    scale = max(float(np.abs(heights).max()), 1.0)  # costs of millions of rows are large numbers
    table = np.block([[normals, np.zeros((len(normals), 1))], [planes / scale, -np.ones((len(planes), 1))]])
    rows = np.concatenate((bounds - np.where(slides == TABLE, 0.0, margin), -heights / scale))
    ranges = [(-FARTHEST, FARTHEST)] * 3 + [(0.0, None)]
    solved = linear_program(np.array([0.0, 0.0, 0.0, 1.0]), table, rows, ranges)
    return solved.x[:3], float(solved.x[3] * scale)
