"""POLY: blocks in which axes move along polynomials of a parameter.

f(p) = a0 + a1 p + a2 p^2 + a3 p^3 for p from 0 to PL, 1 without it. ``PO[X]=(end,a2,a3)``: a0 is where the axis stands,
and a1 follows from its end. Facts: SINUMERIK 840D, *Job planning*, polynomial interpolation.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.splines import SplineError, points_of_polynomial, polynomial_spline
from trunnion.readers.families.sinumerik.block import Block
from trunnion.readers.families.sinumerik.control import POLYNOMIAL, SinumerikControl
from trunnion.readers.families.sinumerik.words import G_MACHINE

#: The end and the coefficients of the square and the cube: a higher degree depends on the software.
_MOST_VALUES: Final = 3

#: Limits of PL.
_LEAST_INTERVAL: Final = 1e-4
_GREATEST_INTERVAL: Final = 99999.9999


def move_along_polynomials(control: SinumerikControl, block: Block, count: Callable[[int], None]) -> None:
    """Execute a block with polynomials; what is not certain about it is reported, and it is not executed.

    ``count`` counts the points that it becomes.
    """
    fault = _fault(control, block)
    if fault:
        control.note(fault.within("block_not_executed"), Severity.ERROR)
        return
    interval, unit = block.interval or 1.0, control.length_unit
    start = control.programmed_position / unit
    bits = int(ProgrammedWord.FEED) if block.feed is not None else 0
    coefficients = np.zeros((_MOST_VALUES + 1, 3))
    coefficients[0] = start
    for axis, name in enumerate("XYZ"):
        end = float(start[axis])
        if name in block.polynomials:
            end, *higher = block.polynomials[name]
            coefficients[2 : 2 + len(higher), axis] = higher
        elif name in block.axes:
            end = block.axes[name][0]
        else:
            continue
        bits |= 1 << axis
        rest = coefficients[2:, axis] @ interval ** np.arange(2, _MOST_VALUES + 1)
        coefficients[1, axis] = (end - start[axis] - rest) / interval
    try:
        points = points_of_polynomial(coefficients, interval, unit)
    except SplineError as error:
        control.note(error.wording.within("block_not_executed"), Severity.ERROR)
        return
    count(len(points))
    control.move_along_spline(polynomial_spline(coefficients * unit, interval), points * unit, bits)


def _fault(control: SinumerikControl, block: Block) -> Wording | None:
    """Why a block with PO[], PL or circle words under POLY is not executed; None if it is."""
    values = [value for each in block.polynomials.values() for value in each]
    words = {word for word, (_, mode) in block.axes.items() if mode is not PositionMode.MODAL}
    if control.motion != POLYNOMIAL:
        return Wording("NC322", "polynomial_without_poly")
    if block.params:
        return Wording("NC322", "circle_word_in_poly", word=next(iter(block.params)))
    if not block.polynomials:
        return Wording("NC322", "interval_without_polynomial")
    if "" in block.polynomials:
        return Wording("NC322", "denominator")
    if other := next((name for name in (*block.polynomials, *block.axes) if name not in ("X", "Y", "Z")), ""):
        return Wording("NC322", "other_axis_in_poly", axis=other)
    if double := block.polynomials.keys() & block.axes.keys():
        return Wording("NC322", "axis_twice_in_poly", axis=min(double))
    if any(len(each) > _MOST_VALUES for each in block.polynomials.values()):
        return Wording("NC322", "too_many_values", most=_MOST_VALUES)
    if block.vector or control.tcp:
        return Wording("NC322", "poly_with_traori")
    if "SUPA" in block.words or G_MACHINE.intersection(block.g):
        return Wording("NC322", "poly_in_machine_positions")
    if not control.absolute or words:
        return Wording("NC322", "poly_not_absolute")
    if control.modal.compensation.current:
        return Wording("NC322", "poly_with_compensation")
    if block.interval is not None and not _LEAST_INTERVAL <= block.interval <= _GREATEST_INTERVAL:
        return Wording(
            "NC322", "bad_interval", value=block.interval, least=_LEAST_INTERVAL, greatest=_GREATEST_INTERVAL
        )
    if any(not abs(value) * control.length_unit <= MAX_POSITION for value in values):
        return Wording("NC322", "number_of_no_machine")
    return None
