"""Splines of LinuxCNC: the cubic G5, the quadratic G5.1, and the NURBS between G5.2 and G5.3.

Facts: LinuxCNC's documentation of these G codes, what its interpreter 2.9 refuses, and the knots of its
``nurbs_additional_functions.cc``.
"""

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord
from trunnion.model.splines import Spline
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.splines import CHORD, SplineError, nurbs_points
from trunnion.readers.families.linuxcnc.arcs_of_splines import PIECES, arcs_beside
from trunnion.readers.families.linuxcnc.control import LinuxcncControl
from trunnion.readers.families.linuxcnc.words import CUBIC, END_NURBS, NURBS
from trunnion.readers.rs274.block import Block, g_code_text
from trunnion.readers.rs274.expressions import BlockError

#: The order without L; a lower L leaves it.
_QUADRATIC: Final = 3

#: The most control points of a NURBS.
_MOST_POLES: Final = 20_000

_Axes = Mapping[str, AxisWord]


class SplineBlocks:
    """Executes the blocks of splines; ``count`` counts the points that they become."""

    def __init__(self, control: LinuxcncControl, count: Callable[[int], None]) -> None:
        self._control = control
        self._count = count
        self._tangent: tuple[int, Floats] | None = None  # the row behind a G5, and P and Q of it with the other sign
        self._order = _QUADRATIC
        self._bits = 0
        self._unit = 1.0
        self._poles: list[Floats] = []
        self._weights: list[float] = []

    def execute(self, code: int, block: Block, axes: _Axes) -> None:
        """Execute a block of a spline by its G code; BlockError if LinuxCNC refuses it, or it is not followed."""
        try:
            if code == NURBS:
                self._add_pole(block, axes)
            elif code == END_NURBS:
                self._end_nurbs(axes)
            else:
                self._bezier(code, block, axes)
        except (BlockError, SplineError) as error:
            self._poles = []
            raise BlockError(error.wording.within("of_curve", word=g_code_text(code))) from None

    def break_off(self) -> None:
        """Report that another motion follows, or the program ends, before G5.3: LinuxCNC forgets the control points."""
        if self._poles:
            self._poles = []
            self._control.note(Wording("NC322", "g5_2_without_g5_3"), Severity.ERROR)

    # G5 and G5.1

    def _bezier(self, code: int, block: Block, axes: _Axes) -> None:
        control = self._control
        self._check_modes()
        if not axes:
            raise BlockError(Wording("NC322", "spline_without_x_y"))
        begin, end = _from_start(block, "IJ"), _from_start(block, "PQ")
        if code == CUBIC:
            if end is None:
                raise BlockError(Wording("NC322", "spline_without_direction", letters="P and Q"))
            if begin is None and self._tangent is not None and self._tangent[0] == control.row:
                begin = self._tangent[1]
        if begin is None:
            raise BlockError(Wording("NC322", "spline_without_direction", letters="I and J"))
        start = control.programmed_position.copy()
        goal = self._goal(axes)
        inner = [start + begin * control.length_unit]
        if end is not None:
            inner.append(goal + end * control.length_unit)
        poles = np.array([start, *inner, goal])
        self._move(poles, np.ones(len(poles)), _bits(block, axes))
        self._tangent = None if end is None else (control.row, -end)

    # G5.2 and G5.3

    def _add_pole(self, block: Block, axes: _Axes) -> None:
        control = self._control
        weight, order = block.take("P"), block.take("L")
        if not self._poles:
            self._check_modes()
            self._order = _QUADRATIC
            self._bits = 0
            self._unit = control.length_unit
            self._poles, self._weights = [control.programmed_position.copy()], [1.0]
            if not axes:
                self._weights = [self._weight(1.0 if weight is None else weight)]
        elif not axes and weight is not None:
            raise BlockError(Wording("NC322", "weight_without_point"))
        self._check_unit()
        if order is not None:
            if order != int(order):
                raise BlockError(Wording("NC322", "order_not_whole", order=order))
            self._order = max(int(order), _QUADRATIC) if abs(order) < MAX_POSITION else _MOST_POLES
            if order < _QUADRATIC:
                control.note(Wording("NC322", "order_below_three", order=order), Severity.WARNING)
        self._bits |= _bits(block, axes)
        if not axes:
            return
        if not control.absolute:
            raise BlockError(Wording("NC322", "curve_incremental"))
        if len(axes) < 2:
            raise BlockError(Wording("NC322", "control_point_without_both"))
        if weight is None:
            raise BlockError(Wording("NC322", "control_point_without_weight"))
        if len(self._poles) >= _MOST_POLES:
            raise BlockError(Wording("NC322", "too_many_control_points", most=_MOST_POLES))
        self._poles.append(self._goal(axes))
        self._weights.append(self._weight(weight))

    def _check_unit(self) -> None:
        if self._control.length_unit != self._unit:
            raise BlockError(Wording("NC322", "unit_changes_in_curve"))

    @staticmethod
    def _weight(weight: float) -> float:
        if not 0.0 < weight < MAX_POSITION:
            raise BlockError(Wording("NC322", "bad_weight", weight=weight))
        return weight

    def _end_nurbs(self, axes: _Axes) -> None:
        poles, weights = self._poles, self._weights
        self._poles = []
        if not poles:
            raise BlockError(Wording("NC322", "g5_3_without_g5_2"))
        self._check_unit()
        if axes:
            raise BlockError(Wording("NC322", "position_beside_g5_3"))
        if len(poles) < self._order:
            raise BlockError(Wording("NC322", "too_few_control_points", count=len(poles), order=self._order))
        self._check_modes()
        self._move(np.array(poles), np.array(weights), self._bits, self._order)

    # Both

    def _check_modes(self) -> None:
        control = self._control
        if control.plane_axis != 2:
            raise BlockError(Wording("NC322", "spline_outside_g17"))
        if control.modal.compensation.current:
            raise BlockError(Wording("NC322", "curve_under_compensation"))
        if control.modal.feed_mode.current != 94 or not control.programmed_feed > 0.0:
            raise BlockError(Wording("NC322", "curve_without_feed_per_minute"))
        if control.tcp:
            raise BlockError(Wording("NC322", "curve_in_tilted_plane"))

    def _goal(self, axes: _Axes) -> Floats:
        """Return the programmed position that the words of a block lead to, mm."""
        control = self._control
        goal = control.programmed_position.copy()
        for axis, (value, _) in axes.items():
            if axis not in ("X", "Y"):
                raise BlockError(Wording("NC322", "spline_with_other_axis", axis=axis))
            k = "XY".index(axis)
            goal[k] = value * control.length_unit + (0.0 if control.absolute else goal[k])
        return goal

    def _move(self, poles: Floats, weights: Floats, bits: int, order: int = 0) -> None:
        if not float(np.abs(poles).max()) < MAX_POSITION:
            raise BlockError(Wording("NC322", "control_point_too_far"))
        order = order or len(poles)
        spans = len(poles) - order + 1
        knots = np.concatenate((np.zeros(order), np.arange(1.0, spans), np.full(order, float(spans))))
        spline = Spline(order - 1, knots, poles, weights)
        points = nurbs_points(spline)
        self._count(len(points))
        if (apart := arcs_beside(spline)) > CHORD:
            arcs = Wording("NC322", "runs_as_arcs", count=2 * PIECES * len(poles), apart=apart)
            self._control.note(arcs, Severity.WARNING)
        self._control.move_along_spline(spline, points, bits)


def _from_start(block: Block, letters: str) -> Floats | None:
    """Return two offsets of a block in X and Y; None if it has neither. BlockError if it has one."""
    values = [block.take(letter) for letter in letters]
    if values == [None, None]:
        return None
    first, second = values
    if first is None or second is None:
        raise BlockError(Wording("NC322", "spline_without_direction", letters=" and ".join(letters)))
    return np.array([first, second, 0.0])


def _bits(block: Block, axes: _Axes) -> int:
    """Return the ``ProgrammedWord`` bits of the words of a block."""
    return sum(int(ProgrammedWord[axis]) for axis in axes if axis in "XY") | (
        int(ProgrammedWord.FEED) if "F" in block.words else 0
    )
