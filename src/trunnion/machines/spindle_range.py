"""Which speeds the spindle of a machine turns at.

In:     a ``Machine`` and a speed.
Out:    what is wrong with it, in words.
Units:  rev/min.
"""

from typing import Final

from trunnion.machines.machine import Machine
from trunnion.messages import Wording, phrase

#: Speeds are printed without decimals: this much is rounding.
_ROUNDING: Final = 0.5 + 1e-6


def spindle_speed_fault(machine: Machine, rpm: float) -> Wording | None:
    """Return why the spindle cannot turn at a speed; None if it can, or if the definition states no range."""
    facts = machine.facts
    greatest, least = machine.spindle_max_rpm, facts.spindle_min_rpm
    if greatest is not None and rpm > greatest + _ROUNDING:
        return phrase("s_above_greatest", rpm=rpm, greatest=greatest)
    if least is not None and rpm < least - _ROUNDING:
        return phrase("s_below_least", rpm=rpm, least=least)
    gears = facts.spindle_gears_rpm
    if gears and not any(low - _ROUNDING <= rpm <= high + _ROUNDING for low, high in gears):
        return phrase("s_no_gear", rpm=rpm, gears=tuple(f"{low:g} to {high:g}" for low, high in gears))
    return None


def states_spindle_range(machine: Machine) -> bool:
    """Whether a definition states any limit of the speed."""
    facts = machine.facts
    return machine.spindle_max_rpm is not None or facts.spindle_min_rpm is not None or bool(facts.spindle_gears_rpm)
