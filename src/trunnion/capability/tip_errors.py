"""How far the tip is off at axis values, and how much of that the workpiece zero takes.

In:     a ``Machine`` and axis values.
Out:    errors of tip and tool axis for each geometry number.
Units:  mm, radians; workpiece frame.
"""

import math
from collections.abc import Iterable, Mapping
from itertools import repeat
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, slide_positions
from trunnion.machines.sensitivity import GeometryNumber, NumberDerivative, derivatives
from trunnion.records import dataclass

_SECONDS: Final = 3600.0


@dataclass(frozen=True, slots=True, eq=False)
class TipErrors:
    """Errors by one number: ``tip`` and ``left`` (k, 3) mm, as they are and with the zero set; ``axis`` (k, 3) rad."""

    number: GeometryNumber
    tip: Floats
    left: Floats | None
    axis: Floats


def tip_errors(
    machine: Machine, joints: Floats, at_zero: Floats | None, amounts: tuple[float, float]
) -> list[TipErrors]:
    """Errors at rows of axis values (k, 5); ``at_zero`` (1, 5) those where the zero was set; amounts in mm and rad."""
    constant: Iterable[NumberDerivative | None] = repeat(None) if at_zero is None else derivatives(machine, at_zero)
    found = []
    for each, there in zip(derivatives(machine, joints), constant, strict=False):
        amount = amounts[each.number.is_angle]
        left = None if there is None else amount * (each.tip - there.tip)
        found.append(TipErrors(each.number, amount * each.tip, left, amount * each.axis))
    return found


def in_radians(length: float, angle: float) -> tuple[float, float]:
    """Amounts as derivatives take them: mm, and radians of seconds of arc."""
    return length, math.radians(angle / _SECONDS)


def joints_at_zero(machine: Machine, pose: Mapping[str, float]) -> Floats:
    """Axis values (1, 5) with the tip in the workpiece zero; NaN where the slides cannot bring it there."""
    rotary = np.array([[pose.get(machine.names[k], 0.0) for k in machine.rotary]])  # a missing axis stands at 0
    return slide_positions(machine, np.zeros((1, 3)), rotary)
