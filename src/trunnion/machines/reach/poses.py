"""The rotary positions that give tool axes, within the travel of the rotary axes."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines.inverse import inverse
from trunnion.machines.machine import Axis, Machine
from trunnion.records import dataclass

#: How far an angle may be beyond its limit and still count as on it, degrees: that of a tool axis at the very limit has
#: rounding errors.
_ON_LIMIT: Final = 1e-6

#: Two branches with angles as near as this, degrees, are one: on the edge of what the rotary axes reach.
_SAME: Final = 1e-5

#: Rows whose solutions are computed at a time.
_ROWS: Final = 65536


@dataclass(frozen=True, slots=True, eq=False)
class AxisPoses:
    """Rotary positions of n tool axes, without whole turns.

    direction  (k,) int64      tool axis that a pose gives, increasing
    rotary     (k, 2) float64  deg, in the order of ``machine.rotary``
    branches   (n,) int64      how many of the two branches give each tool axis; at a pole, how many with some angle of
                               the first rotary axis
    pole       (n,) bool       the angle of the first rotary axis is free; it has a pose every ``step`` degrees
    """

    direction: Ints
    rotary: Floats
    branches: Ints
    pole: Flags


def axis_poses(machine: Machine, axes: Floats, step: float = 5.0) -> AxisPoses:
    """Return the rotary positions that give tool axes.

    machine  with the limits of its rotary axes; those of slides are ignored
    axes     (n, 3) float64: from tip to holder, in workpiece coordinates; any length but zero
    step     most degrees between two angles of a rotary axis that is free
    """
    parts = [_poses(machine, axes[k : k + _ROWS], step, k) for k in range(0, len(axes), _ROWS)]
    if not parts:
        return AxisPoses(np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros(0, np.int64), np.zeros(0, np.bool_))
    return AxisPoses(
        np.concatenate([part.direction for part in parts]),
        np.concatenate([part.rotary for part in parts]),
        np.concatenate([part.branches for part in parts]),
        np.concatenate([part.pole for part in parts]),
    )


def _poses(machine: Machine, axes: Floats, step: float, offset: int) -> AxisPoses:
    found = branch_positions(machine, axes)
    at, branch = np.nonzero(found.usable.T)
    free = free_angles(machine, step)
    direction = np.repeat(at, np.where(found.pole[at], len(free), 1))
    poses = np.repeat(found.rotary[branch, at], np.where(found.pole[at], len(free), 1), axis=0)
    at_pole = found.pole[direction]
    # Each pole takes the free angles in turn.
    poses[at_pole, 0] = np.tile(free, np.count_nonzero(at_pole) // len(free))
    return AxisPoses(direction + offset, poses, found.usable.sum(axis=0), found.pole)


@dataclass(frozen=True, slots=True, eq=False)
class BranchPositions:
    """Rotary positions of n tool axes in both branches, without whole turns.

    rotary  (2, n, 2) float64  deg, in the order of ``machine.rotary``; NaN where there is none
    usable  (2, n) bool        the branch exists within the travel of the rotary axes, and is not the other one again
    pole    (n,) bool          the angle of the first rotary axis is free, and 0 here
    """

    rotary: Floats
    usable: Flags
    pole: Flags


def branch_positions(machine: Machine, axes: Floats) -> BranchPositions:
    """Return what both branches give for tool axes (n, 3)."""
    found = inverse(machine, np.zeros(axes.shape), axes)
    rotary = found.joints[:, :, list(machine.rotary)]
    first, second = (machine.axes[k] for k in machine.rotary)
    usable = within_travel(second, rotary[:, :, 1]) & (found.pole | within_travel(first, rotary[:, :, 0]))
    apart = np.abs(_turned_back(rotary[1] - rotary[0])).max(axis=1) > _SAME
    usable[1] &= apart | ~usable[0]
    return BranchPositions(rotary, usable, found.pole)


def free_angles(machine: Machine, step: float) -> Floats:
    """Angles of the first rotary axis where it is free, over its travel, at most ``step`` degrees apart."""
    return _angles(machine.axes[machine.rotary[0]], step)


def _angles(axis: Axis, step: float) -> Floats:
    """Angles of an axis whose angle is free, over its travel, but no more than a turn."""
    low, high = (-180.0, 180.0) if axis.endless else (axis.low, axis.high)
    if high - low >= 360.0:
        count = math.ceil(360.0 / step)
        return np.asarray(low + 360.0 / count * np.arange(count))
    return np.linspace(low, high, math.ceil((high - low) / step) + 1)


def _turned_back(angles: Floats) -> Floats:
    """Angles within half a turn to both sides."""
    return np.asarray(np.mod(angles + 180.0, 360.0) - 180.0)


def within_travel(axis: Axis, angles: Floats) -> Flags:
    """Whether angles, degrees, are within the travel of a rotary axis with some whole turns; NaN is not."""
    if axis.endless:
        return np.asarray(np.isfinite(angles))
    lowest = angles + 360.0 * np.ceil((axis.low - _ON_LIMIT - angles) / 360.0)
    return np.asarray(lowest <= axis.high + _ON_LIMIT)
