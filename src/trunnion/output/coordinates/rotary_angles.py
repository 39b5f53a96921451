"""Rotary positions as they are printed."""

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.words import round_to_counts
from trunnion.machines import Machine


def rotary_counts(machine: Machine, axis: int, angle: Floats, decimals: int) -> Ints:
    """Return the counts of a rotary word; an axis that displays 0 to 360 degrees prints 360 as 0.

    machine, axis  the machine, and the index of the axis in ``Machine.axes``
    angle          (n,) float64: degrees
    decimals       of the word
    """
    display_low = machine.axes[axis].display_low
    count = round_to_counts(np.ascontiguousarray(angle), decimals)
    if not np.isnan(display_low):
        turn = 360 * 10**decimals
        count[count >= round(display_low * 10**decimals) + turn] -= turn
    return count
