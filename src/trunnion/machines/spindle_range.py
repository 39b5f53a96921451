"""Which speeds the spindle of a machine turns at.

In:     a ``Machine`` and a speed.
Out:    what is wrong with it, in words.
Units:  rev/min.
"""

from typing import Final

from trunnion.machines.machine import Machine

#: Speeds are printed without decimals: this much is rounding.
_ROUNDING: Final = 0.5 + 1e-6


def spindle_speed_fault(machine: Machine, rpm: float) -> str:
    """Return why the spindle cannot turn at a speed; empty if it can, or if the definition states no range."""
    facts = machine.facts
    greatest, least = machine.spindle_max_rpm, facts.spindle_min_rpm
    if greatest is not None and rpm > greatest + _ROUNDING:
        return f"S{rpm:g} is above the greatest speed of the spindle, {greatest:g} rev/min"
    if least is not None and rpm < least - _ROUNDING:
        return f"S{rpm:g} is below the least speed of the spindle, {least:g} rev/min"
    gears = facts.spindle_gears_rpm
    if gears and not any(low - _ROUNDING <= rpm <= high + _ROUNDING for low, high in gears):
        ranges = ", ".join(f"{low:g} to {high:g}" for low, high in gears)
        return f"S{rpm:g} is in no gear of the spindle: {ranges} rev/min"
    return ""


def states_spindle_range(machine: Machine) -> bool:
    """Whether a definition states any limit of the speed."""
    facts = machine.facts
    return machine.spindle_max_rpm is not None or facts.spindle_min_rpm is not None or bool(facts.spindle_gears_rpm)
