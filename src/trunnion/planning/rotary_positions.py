"""Positions of the two rotary axes: as they are displayed, as they wind, and the tool axes that they give."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, forward

#: An axis that ends fewer turns from home is not worth a word.
_FEWEST_TURNS: Final = 2.0


def is_endless(machine: Machine) -> tuple[bool, bool]:
    """Which rotary axes have no limits, so that they take the shorter way."""
    first, second = (not np.isfinite(machine.limits[column]).any() for column in machine.rotary)
    return bool(first), bool(second)


def continuous_positions(machine: Machine, rotary: Floats) -> Floats:
    """Return displayed positions as the axes wind: endless axes take the shorter way, the others stay as they are.

    rotary  (n, 2) float64: degrees, in the order of ``machine.rotary``

    (n, 2) float64  degrees; without the jumps of an axis that displays one turn
    """
    continuous = np.array(rotary)
    for r, endless in enumerate(is_endless(machine)):
        if endless:
            continuous[1:, r] -= 360.0 * np.cumsum(np.rint(np.diff(rotary[:, r]) / 360.0))
    return continuous


def displayed_positions(machine: Machine, continuous: Floats) -> Floats:
    """Positions (n, 2), degrees, in the range that each axis displays."""
    displayed = np.array(continuous)
    for r, column in enumerate(machine.rotary):
        low = machine.axes[column].display_low
        if not np.isnan(low):
            displayed[:, r] -= 360.0 * np.floor((displayed[:, r] - low) / 360.0)
    return displayed


def tool_axes(machine: Machine, rotary: Floats) -> Floats:
    """(n, 3) float64: tool axes, seen from the workpiece, at rotary positions (n, 2), degrees."""
    joints = np.zeros((len(rotary), 5))
    joints[:, list(machine.rotary)] = rotary
    return np.asarray(forward(machine, joints)[1])


def wound_turns(machine: Machine, rotary: Floats) -> list[tuple[int, float]]:
    """Columns of rotary axes that displayed positions (n, 2), degrees, leave turns away from home, and how many.

    An axis that is displayed within one turn takes the shorter way home.
    """
    away = np.abs(rotary[-1] - machine.home[list(machine.rotary)]) / 360.0 if len(rotary) else np.zeros(2)
    return [(c, turns) for c, turns in zip(machine.rotary, away.tolist(), strict=True) if turns >= _FEWEST_TURNS]
