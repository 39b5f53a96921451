"""Orientations said by the tool's vector, and which of them a control would turn into the planned rotary positions.

Units:  degrees; vectors of length 1, in the workpiece frame.
"""

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machine import Machine, Output, forward, inverse

#: How much farther away the other position must be, degrees: controls may count what is nearest in ways of their own.
_CLEARLY = 0.5

#: Where an axis cannot go, degrees.
_NOWHERE = 1e9


def vectors_of(machine: Machine, rotary: Floats) -> Floats:
    """(n, 3): where the tool points from its tip with the rotary axes at ``rotary`` (n, 2)."""
    joints = np.zeros((len(rotary), len(machine.axes)))
    joints[:, list(machine.rotary)] = rotary
    return forward(machine, joints)[1]


def leads_there(machine: Machine, vectors: Floats, rotary: Floats, before: Floats, off: float) -> Flags:
    """Whether a control that takes the nearest rotary position for a vector gets to the planned one.

    Parameters
    ----------
    vectors : (n, 3) float64
        As they are printed.
    rotary : (n, 2) float64
        The planned positions, as they wind; those of endless axes that are written within one turn in any of them.
    before : (n, 2) float64
        Where the axes come from.
    off
        How far either axis may be off.

    Returns
    -------
    (n,) bool
        False also where another position is about as near, and at a pole, where an axis is free.
    """
    solved = inverse(machine, np.zeros_like(vectors), vectors)
    axes = [machine.axes[column] for column in machine.rotary]
    found = solved.joints[:, :, list(machine.rotary)] - before
    found = before + found - 360.0 * np.rint(found / 360.0)
    for k, axis in enumerate(axes):
        if axis.endless:
            continue
        for turn in (360.0, -360.0):
            other = found[:, :, k] + turn
            beyond = (found[:, :, k] < axis.low) | (found[:, :, k] > axis.high)
            found[:, :, k] = np.where(beyond & (other >= axis.low) & (other <= axis.high), other, found[:, :, k])
        found[:, :, k] = np.where((found[:, :, k] < axis.low) | (found[:, :, k] > axis.high), _NOWHERE, found[:, :, k])
    apart = found - rotary
    for k, axis in enumerate(axes):
        if axis.endless and axis.output is not Output.NONE:  # such positions have no turns
            apart[:, :, k] -= 360.0 * np.rint(apart[:, :, k] / 360.0)
    right = np.all(np.abs(apart) <= off, axis=2)
    ways = np.abs(found - before)
    sums, most = ways.sum(axis=2), ways.max(axis=2)
    leads = np.zeros(len(vectors), np.bool_)
    for this, that in ((0, 1), (1, 0)):
        same = np.all(np.abs(found[this] - found[that]) <= off, axis=1)
        nearer = (sums[this] + _CLEARLY < sums[that]) & (most[this] + _CLEARLY < most[that])
        leads |= np.asarray(right[this] & (nearer | same), np.bool_)
    return leads & ~solved.pole
