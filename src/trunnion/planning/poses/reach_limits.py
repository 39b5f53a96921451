"""Limits of the slides where no row stands: on arcs between their ends, and in holes below and above their points."""

import numpy as np

from trunnion.arrays import Ints
from trunnion.machines import Machine, kinematic_parameters
from trunnion.model.arc_extremes import Reach, axis_reach, operation_arcs
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.toolpath import Operation
from trunnion.planning.axis_limits import limits_of, outside_limits
from trunnion.planning.holes.hole_ends import hole_ends
from trunnion.planning.poses.placement import OUT_OF_REACH, REWIND
from trunnion.planning.poses.selection import PlannedPoses


def judge_reach(poses: PlannedPoses, machine: Machine, operation: Operation, keep_slide_limits: bool) -> None:
    """Take arcs and holes into the outcome of their rows and into the extremes of the slides in ``poses``.

    A row on whose arc or in whose hole a slide goes farther beyond a limit than at its end gets the value there.
    """
    for rows, reach in (_of_arcs(poses, machine, operation), _of_holes(poses, machine, operation)):
        if len(rows):
            _widen_extremes(poses, machine, rows, reach)
            _judge_limits(poses, machine, rows, reach, keep_slide_limits)


def _of_arcs(poses: PlannedPoses, machine: Machine, operation: Operation) -> tuple[Ints, Reach]:
    """Rows that are arcs, and what the slides reach between their ends."""
    rows = operation.arcs.row
    if not len(rows):
        return rows, Reach.nothing(0, 5)
    end = poses.rotary[rows]
    # After a rewind the arc begins in the pose in which it ends; a whole turn is a display that begins again.
    begin = np.where((poses.outcome[rows] == REWIND)[:, None], end, poses.rotary[np.maximum(rows - 1, 0)])
    way = end - begin
    return rows, axis_reach(machine, operation_arcs(operation), end - way + 360.0 * np.rint(way / 360.0), end)


def _of_holes(poses: PlannedPoses, machine: Machine, operation: Operation) -> tuple[Ints, Reach]:
    """Rows that are holes, and what the slides reach from the bottom to where the tool goes on."""
    rows, tips = hole_ends(operation)
    reach = Reach.nothing(len(rows), 5)
    if len(rows):
        every, rotary = np.ones(2 * len(rows), np.bool_), np.tile(poses.rotary[rows], (2, 1))
        kinematics, slides = kinematic_parameters(machine), list(machine.linear)
        joints = joints_from_rows(machine, kinematics, every, tips.reshape(-1, 3), rotary).reshape(2, -1, 5)
        reach.low[:, slides], reach.high[:, slides] = (each(joints, axis=0)[:, slides] for each in (np.min, np.max))
    return rows, reach


def _widen_extremes(poses: PlannedPoses, machine: Machine, rows: Ints, reach: Reach) -> None:
    for column in machine.linear:
        least, most = int(np.argmin(reach.low[:, column])), int(np.argmax(reach.high[:, column]))
        if reach.low[least, column] < poses.extremes[column, 0]:
            poses.extremes[column, 0], poses.extreme_rows[column, 0] = reach.low[least, column], rows[least]
        if reach.high[most, column] > poses.extremes[column, 1]:
            poses.extremes[column, 1], poses.extreme_rows[column, 1] = reach.high[most, column], rows[most]


def _judge_limits(poses: PlannedPoses, machine: Machine, rows: Ints, reach: Reach, keep_slide_limits: bool) -> None:
    low, high = limits_of(machine, keep_slide_limits)
    outside = outside_limits(reach.low, low, high) & np.isfinite(reach.low)
    outside |= outside_limits(reach.high, low, high) & np.isfinite(reach.high)
    for k in np.flatnonzero(outside.any(axis=1) & (poses.outcome[rows] < OUT_OF_REACH)).tolist():
        row, below, above = int(rows[k]), low - reach.low[k], reach.high[k] - high
        column = int(np.argmax(np.maximum(below, above)))
        known = int(poses.outcome[row]) - 1
        if 0 <= known < len(low):
            value = poses.beyond_value[row]
            if max(low[known] - value, value - high[known]) >= max(below[column], above[column]):
                continue
        poses.outcome[row] = column + 1
        poses.beyond_value[row] = reach.low[k, column] if below[column] > above[column] else reach.high[k, column]
