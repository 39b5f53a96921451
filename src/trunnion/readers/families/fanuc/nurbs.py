"""G06.2: NURBS by blocks of control points with knots and weights, and of further knots that end them.

Facts: FANUC Series 15i operator's manual, NURBS interpolation, with its alarms.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.model.run import ProgrammedWord
from trunnion.model.splines import Spline
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.splines import SplineError, nurbs_points
from trunnion.readers.families.fanuc.control import FanucControl
from trunnion.readers.families.fanuc.words import NURBS
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError

#: P, one more than the degree: the least, the greatest, and the one without it.
_ORDERS: Final = range(2, 5)
_CUBIC: Final = 4

#: How far the first control point may be from where the tool stands, mm; and the most control points.
_SAME_POINT: Final = 1e-6
_MOST_POLES: Final = 20_000


class NurbsBlocks:
    """The blocks of one NURBS after another; ``is_open`` from its first block to its last knot."""

    def __init__(self, control: FanucControl) -> None:
        self._control = control
        self.is_open = False
        self._order = _CUBIC
        self._bits = 0
        self._knots: list[float] = []
        self._poles: list[tuple[float, ...]] = []
        self._weights: list[float] = []

    def add(self, block: Block) -> int:
        """Add a block; returns how many points its curve becomes, 0 before it is complete. BlockError if it is wrong.

        What is wrong ends the curve: the control would stop there.
        """
        try:
            return self._add(block)
        except (BlockError, SplineError) as error:
            self.is_open = False
            raise BlockError(f"G6.2: {error}", code="NC322") from None

    def break_off(self) -> None:
        """Report that the program ends, or leaves, before the curve is complete."""
        if self.is_open:
            self.is_open = False
            self._control.note("G6.2 without its last knots: the curve is not executed", Severity.ERROR, "NC322")

    def _add(self, block: Block) -> int:
        if NURBS in block.g:
            if self.is_open:
                raise BlockError("the curve before lacks knots", code="NC322")
            self._begin(block)
        elif block.g or block.m:
            raise BlockError("another command before the last knot", code="NC322")
        knot, weight = block.take("K"), block.take("R")
        pole = tuple(block.take(axis) for axis in "XYZ")
        if knot is None:
            raise BlockError("a block without K")
        if self._knots and knot < self._knots[-1]:
            raise BlockError("a knot below the one before")
        self._knots.append(knot)
        if all(value is None for value in pole) and weight is None and len(self._poles) >= self._order:
            return self._finish() if len(self._knots) == len(self._poles) + self._order else 0
        if len(self._knots) > len(self._poles) + 1:
            raise BlockError("a control point behind the last ones")
        if any(value is None for value in pole):
            raise BlockError("a control point without X, Y and Z")
        if len(self._poles) >= _MOST_POLES:
            raise BlockError(f"more than {_MOST_POLES} control points")
        weight = 1.0 if weight is None else weight
        if not 0.0 < weight < MAX_POSITION:
            raise BlockError(f"a weight of {weight:g}")
        self._poles.append(tuple(value for value in pole if value is not None))
        self._weights.append(weight)
        self._check_start()
        return 0

    def _begin(self, block: Block) -> None:
        control = self._control
        self.is_open = True
        self._knots, self._poles, self._weights = [], [], []
        order = block.take("P")
        self._order = _CUBIC if order is None else int(order) if order in _ORDERS else 0
        self._bits = sum(ProgrammedWord[axis] for axis in "XYZ") | (int(ProgrammedWord.FEED) * ("F" in block.words))
        if len(block.g) > 1 or block.m:
            raise BlockError("other G and M words in its block")
        if not self._order:
            raise BlockError(f"an order P{order:g}; it is from 2 to 4")
        if control.modal.feed_mode.current != 94 or not control.programmed_feed > 0.0:
            raise BlockError("without a feed per minute")
        if control.modal.compensation.current:
            raise BlockError("under radius compensation")
        if not control.absolute:
            raise BlockError("with incremental positions")
        if control.tcp or control.tilted or control.plane_of_pose:
            raise BlockError("with TCP or in a tilted plane, which is not simulated")

    def _check_start(self) -> None:
        if len(self._poles) > 1:
            return
        off = np.abs(np.array(self._poles[0]) * self._control.length_unit - self._control.programmed_position)
        if not float(off.max()) <= _SAME_POINT:
            raise BlockError("the first control point is not where the tool stands (PS1009)")

    def _finish(self) -> int:
        """Move along the complete curve."""
        self.is_open = False
        control, degree = self._control, self._order - 1
        knots, poles = np.array(self._knots), np.array(self._poles) * control.length_unit
        _check_knots(knots, degree)
        if not float(np.abs(poles).max()) < MAX_POSITION:
            raise BlockError("a control point farther away than any machine reaches")
        spline = Spline(degree, knots, poles, np.array(self._weights))
        points = nurbs_points(spline)
        control.move_along_spline(spline, points, self._bits)
        return len(points)


def _check_knots(knots: Floats, degree: int) -> None:
    """Raise BlockError for knots that the control refuses (PS1007, PS1008)."""
    first, last = knots[: degree + 1], knots[-degree - 1 :]
    if (first != first[0]).any() or (last != last[0]).any() or not first[0] < last[0]:
        raise BlockError("the first knots, or the last ones, are not as often the same as its order (PS1007)")
    inner = knots[degree + 1 : -degree - 1]
    _, repeats = np.unique(inner, return_counts=True)
    if (inner <= first[0]).any() or (inner >= last[0]).any() or repeats.max(initial=0) > degree:
        raise BlockError("a knot within it is there too often (PS1008)")
