"""Which points of the workpiece the tip reaches, each with a tool axis of its own."""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines.inverse import slide_positions
from trunnion.machines.machine import Machine
from trunnion.machines.reach.poses import branch_positions, free_angles
from trunnion.records import dataclass

#: How far a slide may be beyond its limit and still count as on it, mm.
_ON_LIMIT: Final = 1e-6

#: A free angle is tried finer around the best one: so many angles each time, in a stretch narrower by this factor.
_TRIALS: Final = 9
_FINER: Final = 0.3
_ROUNDS: Final = 6

#: Rows that are computed at a time.
_ROWS: Final = 65536


@dataclass(frozen=True, slots=True, eq=False)
class PointReach:
    """What is reached of n rows, (n,) each.

    axis    the rotary axes give the tool axis within their travel
    travel  and in one of those positions the slides bring the tip to all points of the row, within theirs
    """

    axis: Flags
    travel: Flags


def reached_points(machine: Machine, points: Floats, axes: Floats, step: float = 5.0) -> PointReach:
    """Tell which points are reached.

    machine  with its limits. Slides count only where it is known how they stand: ``Machine.is_placed``
    points   (n, c, 3) float64, mm: points of each row, workpiece coordinates, that one position of the rotary axes must
             reach together
    axes     (n, 3) float64: from tip to holder, in workpiece coordinates; any length but zero
    step     most degrees between two angles that are tried first of a rotary axis that is free
    """
    axis, travel = np.zeros(len(axes), np.bool_), np.zeros(len(axes), np.bool_)
    for first in range(0, len(axes), _ROWS):
        part = slice(first, first + _ROWS)
        axis[part], travel[part] = _reached(machine, points[part], axes[part], step)
    return PointReach(axis, travel)


def _reached(machine: Machine, points: Floats, axes: Floats, step: float) -> tuple[Flags, Flags]:
    found = branch_positions(machine, axes)
    travel = np.zeros(len(axes), np.bool_)
    for branch in range(2):
        rows = np.flatnonzero(found.usable[branch] & ~found.pole & ~travel)
        travel[rows] = _excess(machine, points[rows], found.rotary[branch, rows]) <= _ON_LIMIT
        rows = np.flatnonzero(found.usable[branch] & found.pole & ~travel)
        if len(rows):
            travel[rows] = _least_excess(machine, points[rows], found.rotary[branch, rows], step) <= _ON_LIMIT
    return np.asarray(found.usable.any(axis=0)), travel


def _least_excess(machine: Machine, points: Floats, rotary: Floats, step: float) -> Floats:
    """Return the excess at the best angle of the first rotary axis, which is free, (k,): tried over its travel, then
    finer.
    """
    axis = machine.axes[machine.rotary[0]]
    low, high = (-np.inf, np.inf) if axis.endless else (axis.low, axis.high)
    trial = rotary.copy()
    least, best = np.full(len(rotary), np.inf), np.zeros(len(rotary))

    def attempt(angles: Floats) -> None:
        trial[:, 0] = np.clip(angles, low, high)
        excess = _excess(machine, points, trial)
        better = excess < least
        least[better], best[better] = excess[better], trial[better, 0]

    for angle in free_angles(machine, step).tolist():
        attempt(np.full(len(rotary), angle))
    for width in step * _FINER ** np.arange(_ROUNDS):
        middle = best.copy()
        for offset in np.linspace(-width, width, _TRIALS).tolist():
            attempt(middle + offset)
    return least


def _excess(machine: Machine, points: Floats, rotary: Floats) -> Floats:
    """How far beyond their limits slides must go to bring the tip to all points (k, c, 3) of each row, (k,) mm.

    Negative within the limits; infinite where the slides cannot follow.
    """
    count, each = points.shape[:2]
    joints = slide_positions(machine, points.reshape(-1, 3), np.repeat(rotary, each, axis=0)).reshape(count, each, 5)
    excess = np.full(count, -np.inf)
    for slide in machine.linear:
        axis = machine.axes[slide]
        if machine.is_placed(slide) and axis.has_limits:
            beyond = np.maximum(axis.low - joints[:, :, slide], joints[:, :, slide] - axis.high).max(axis=1)
            excess = np.maximum(excess, beyond)
    return np.where(np.isnan(joints).any(axis=(1, 2)), np.inf, excess)
