"""The largest box, with edges along X, Y and Z, of places of the workpiece zero that all fit.

A half-space ``n . z <= b`` has a box within it if its corner in the direction of n is: that is linear in the ends of
the box. The volume is made largest as the sum of the logarithms of its edges, each of them below its tangents: a linear
program.
"""

from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.largest_margin import linear_program
from trunnion.placing.travel_limits import FARTHEST, CutSet
from trunnion.records import dataclass

#: Ratio of the edges at which the logarithm has tangents, and their number: down to a millionth of the extent.
_RATIO: Final = 1.15
_TANGENTS: Final = 100

#: Ends are in whole thousandths of a millimetre, rounded into the box.
_DIGIT: Final = 1e-3

_MOST_ROUNDS: Final = 200


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """Ends (3,) each, mm; infinite where nothing limits it."""

    low: Floats
    high: Floats

    @property
    def corners(self) -> Floats:
        """(8, 3), mm."""
        return np.array(list(product(*zip(self.low.tolist(), self.high.tolist(), strict=True))))


def inscribed_box(cuts: CutSet, inside: Floats, low: Floats, high: Floats) -> Box:
    """Return the box around a place (3,) that fits, in a region with the extent ``low`` to ``high`` (3,); mm.

    Each of its corners fits. Its volume is within a hundredth of the largest one. It is the place alone where rounding
    leaves no other.
    """
    point = Box(inside, inside)
    low, high = np.clip(low, -FARTHEST, inside), np.clip(high, inside, FARTHEST)
    box = point
    for _ in range(_MOST_ROUNDS):
        try:
            box = _largest(cuts, inside, low, high)
        except ArithmeticError:
            return point
        found = [cuts.add(cuts.at(corner), np.full((3, 2), -_DIGIT / 4.0), -_DIGIT / 4.0) for corner in box.corners]
        if not any(found):
            break
    fitting = _fitting(cuts, box, inside)
    low, high = fitting.low, fitting.high
    return Box(np.where(low < -0.99 * FARTHEST, -np.inf, low), np.where(high > 0.99 * FARTHEST, np.inf, high))


def _largest(cuts: CutSet, inside: Floats, low: Floats, high: Floats) -> Box:
    """Return the largest box within the half-spaces so far: of its ends (6) and the logarithms of its edges (3)."""
    normals, bounds, _ = cuts.table()
    none = np.zeros((len(normals), 3))
    table = [np.block([np.minimum(normals, 0.0), np.maximum(normals, 0.0), none])]
    rows = [np.maximum(bounds, normals @ inside)]  # the place itself fits but for rounding
    extent = np.maximum(high - low, 1e-6)
    edges = _RATIO ** -np.arange(_TANGENTS)
    for k in range(3):
        tangents = np.zeros((_TANGENTS, 9))
        slopes = 1.0 / (edges * extent[k])
        tangents[:, k], tangents[:, 3 + k], tangents[:, 6 + k] = slopes, -slopes, 1.0
        table.append(tangents)
        rows.append(np.log(edges) - 1.0)
    ranges = [*zip(low.tolist(), inside.tolist(), strict=True), *zip(inside.tolist(), high.tolist(), strict=True)]
    ranges += [(None, 1.0)] * 3
    cost = np.array([0.0] * 6 + [-1.0] * 3)
    solved = linear_program(cost, np.concatenate(table), np.concatenate(rows), ranges)
    return Box(solved.x[:3], solved.x[3:6])


def _fitting(cuts: CutSet, box: Box, inside: Floats) -> Box:
    """Return the box a little smaller, in whole thousandths, so that every corner fits; the place alone if
    none does.
    """
    for less in (0.0, _DIGIT, 4.0 * _DIGIT, 16.0 * _DIGIT):
        low = np.minimum(np.ceil((box.low + less) / _DIGIT - 1e-6) * _DIGIT, inside)
        high = np.maximum(np.floor((box.high - less) / _DIGIT + 1e-6) * _DIGIT, inside)
        smaller = Box(np.asarray(np.round(low, 9), np.float64), np.asarray(np.round(high, 9), np.float64))
        if all(cuts.at(corner).margin >= 0.0 for corner in smaller.corners):
            return smaller
    return Box(inside, inside)
