"""G06.2: NURBS by blocks of control points with knots and weights, and of further knots that end them.

Facts: FANUC Series 15i operator's manual, NURBS interpolation, with its alarms.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.messages import Wording
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
            raise BlockError(error.wording.within("of_curve", word="G6.2")) from None

    def break_off(self) -> None:
        """Report that the program ends, or leaves, before the curve is complete."""
        if self.is_open:
            self.is_open = False
            self._control.note(Wording("NC322", "g6_2_without_last_knots"), Severity.ERROR)

    def _add(self, block: Block) -> int:
        if NURBS in block.g:
            if self.is_open:
                raise BlockError(Wording("NC322", "curve_before_lacks_knots"))
            self._begin(block)
        elif block.g or block.m:
            raise BlockError(Wording("NC322", "another_command_before_last_knot"))
        knot, weight = block.take("K"), block.take("R")
        pole = tuple(block.take(axis) for axis in "XYZ")
        if knot is None:
            raise BlockError(Wording("NC322", "block_without_k"))
        if self._knots and knot < self._knots[-1]:
            raise BlockError(Wording("NC322", "knot_below_before"))
        self._knots.append(knot)
        if all(value is None for value in pole) and weight is None and len(self._poles) >= self._order:
            return self._finish() if len(self._knots) == len(self._poles) + self._order else 0
        if len(self._knots) > len(self._poles) + 1:
            raise BlockError(Wording("NC322", "control_point_behind_last"))
        if any(value is None for value in pole):
            raise BlockError(Wording("NC322", "control_point_without_x_y"))
        if len(self._poles) >= _MOST_POLES:
            raise BlockError(Wording("NC322", "too_many_control_points", most=_MOST_POLES))
        weight = 1.0 if weight is None else weight
        if not 0.0 < weight < MAX_POSITION:
            raise BlockError(Wording("NC322", "bad_weight", weight=weight))
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
            raise BlockError(Wording("NC322", "curve_with_other_words"))
        if not self._order:
            raise BlockError(Wording("NC322", "bad_order", order=order))
        if control.modal.feed_mode.current != 94 or not control.programmed_feed > 0.0:
            raise BlockError(Wording("NC322", "curve_without_feed_per_minute"))
        if control.modal.compensation.current:
            raise BlockError(Wording("NC322", "curve_under_compensation"))
        if not control.absolute:
            raise BlockError(Wording("NC322", "curve_incremental"))
        if control.tcp or control.tilted or control.plane_of_pose:
            raise BlockError(Wording("NC322", "curve_in_tilted_plane"))

    def _check_start(self) -> None:
        if len(self._poles) > 1:
            return
        off = np.abs(np.array(self._poles[0]) * self._control.length_unit - self._control.programmed_position)
        if not float(off.max()) <= _SAME_POINT:
            raise BlockError(Wording("NC322", "first_point_elsewhere"))

    def _finish(self) -> int:
        """Move along the complete curve."""
        self.is_open = False
        control, degree = self._control, self._order - 1
        knots, poles = np.array(self._knots), np.array(self._poles) * control.length_unit
        _check_knots(knots, degree)
        if not float(np.abs(poles).max()) < MAX_POSITION:
            raise BlockError(Wording("NC322", "control_point_too_far"))
        spline = Spline(degree, knots, poles, np.array(self._weights))
        points = nurbs_points(spline)
        control.move_along_spline(spline, points, self._bits)
        return len(points)


def _check_knots(knots: Floats, degree: int) -> None:
    """Raise BlockError for knots that the control refuses (PS1007, PS1008)."""
    first, last = knots[: degree + 1], knots[-degree - 1 :]
    if (first != first[0]).any() or (last != last[0]).any() or not first[0] < last[0]:
        raise BlockError(Wording("NC322", "bad_end_knots"))
    inner = knots[degree + 1 : -degree - 1]
    _, repeats = np.unique(inner, return_counts=True)
    if (inner <= first[0]).any() or (inner >= last[0]).any() or repeats.max(initial=0) > degree:
        raise BlockError(Wording("NC322", "knot_too_often"))
