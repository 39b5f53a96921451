"""Limits of the axes: what they are, which values are beyond them, and how messages put it."""

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.planning.poses.states import LIMIT_TOLERANCE


def limits_of(machine: Machine, keep_slide_limits: bool) -> tuple[Floats, Floats]:
    """Lowest and highest values of all axes, (5,) float64 each, mm or degrees.

    They are infinite where no limit is to be kept; without ``keep_slide_limits`` that is so for slides.
    """
    low, high = machine.limits.T.copy()
    if not keep_slide_limits:
        slides = np.array(machine.linear)
        low[slides], high[slides] = -np.inf, np.inf
    return low, high


def outside_limits(values: Floats, low: Floats, high: Floats) -> Flags:
    """Which axis values are beyond their limits by more than ``LIMIT_TOLERANCE``; shapes broadcast."""
    return np.asarray((values < low - LIMIT_TOLERANCE) | (values > high + LIMIT_TOLERANCE))


def exceeds_travel(machine: Machine, extremes: Floats) -> Flags:
    """(5,) bool: slides that need more than their whole travel, wherever the workpiece sits.

    ``extremes`` (5, 2): least and greatest values of all axes, mm and degrees.
    """
    is_slide = np.zeros(5, bool)
    is_slide[list(machine.linear)] = True
    low, high = machine.limits.T
    return np.asarray(is_slide & (extremes[:, 1] - extremes[:, 0] > high - low + LIMIT_TOLERANCE))


def limit_violation_text(machine: Machine, column: int, value: float) -> Wording:
    """Such as ``axis B would go to 110.00000, above its limit 100 degrees``."""
    axis = machine.axes[column]
    below, said = value < axis.low, dict[str, str]()
    if _lacks_length(machine, column):
        variant = "below_limit_without_length" if below else "above_limit_without_length"
    elif machine.in_force and not axis.is_rotary:
        variant = "below_limit_in_force" if below else "above_limit_in_force"
        said = {"in_force": machine.in_force}
    else:
        variant = "below_limit" if below else "above_limit"
    limit, unit = axis.low if below else axis.high, "degrees" if axis.is_rotary else "mm"
    return phrase(variant, axis=axis.name, value=value, limit=limit, unit=unit, **said)


def limit_remedy(machine: Machine, column: int, value: float, remark: Wording | str = "") -> Wording:
    """Return what brings an axis back within its limits, as the cure of a message with a ``remark``."""
    axis = machine.axes[column]
    lacking = axis.low - value if value < axis.low else value - axis.high
    if axis.is_rotary:
        return phrase("tilt_by", lacking=lacking, remark=remark)
    variant = "give_length_or_shift" if _lacks_length(machine, column) else "shift"
    return phrase(variant, axis=axis.name, lacking=lacking, remark=remark)


def _lacks_length(machine: Machine, column: int) -> bool:
    """Whether the position of an axis is that for a tool without length, as nobody has said the length."""
    return machine.tool_length is None and machine.depends_on_length(column)
