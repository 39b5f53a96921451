"""Which points of the workpiece the tip reaches, each with a tool axis of its own."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines.inverse import slide_positions
from trunnion.machines.machine import Machine
from trunnion.machines.reach.poses import branch_positions, free_angles

#: How far a slide may be beyond its limit and still count as on it, mm.
_ON_LIMIT: Final = 1e-6

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

    Parameters
    ----------
    machine
        With its limits. Slides count only where it is known how they stand: ``Machine.is_placed``.
    points : (n, c, 3) float64, mm
        Points of each row, workpiece coordinates, that one position of the rotary axes must reach together.
    axes : (n, 3) float64
        From tip to holder, in workpiece coordinates; any length but zero.
    step
        Most degrees between two angles of a rotary axis that is free.
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
        rows = np.flatnonzero(found.usable[branch] & ~found.pole)
        rows = rows[~travel[rows]]
        travel[rows] = _within_slides(machine, points[rows], found.rotary[branch, rows])
        for angle in free_angles(machine, step).tolist():
            rows = np.flatnonzero(found.usable[branch] & found.pole & ~travel)
            if not len(rows):
                break
            rotary = found.rotary[branch, rows]
            rotary[:, 0] = angle
            travel[rows] = _within_slides(machine, points[rows], rotary)
    return np.asarray(found.usable.any(axis=0)), travel


def _within_slides(machine: Machine, points: Floats, rotary: Floats) -> Flags:
    """Whether the slides bring the tip to all points (k, c, 3) of each row at rotary positions (k, 2)."""
    each = points.shape[1]
    joints = slide_positions(machine, points.reshape(-1, 3), np.repeat(rotary, each, axis=0))
    within = np.ones(len(joints), np.bool_)
    for slide in machine.linear:
        axis = machine.axes[slide]
        if machine.is_placed(slide) and axis.has_limits:
            within &= (joints[:, slide] >= axis.low - _ON_LIMIT) & (joints[:, slide] <= axis.high + _ON_LIMIT)
        within &= ~np.isnan(joints[:, slide])
    return np.asarray(within.reshape(-1, each).all(axis=1))
