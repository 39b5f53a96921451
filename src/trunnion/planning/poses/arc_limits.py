"""Limits of the slides on arcs between their ends, where no row stands."""

import numpy as np

from trunnion.machines import Machine
from trunnion.model.arc_extremes import axis_reach, operation_arcs
from trunnion.model.toolpath import Operation
from trunnion.planning.axis_limits import limits_of, outside_limits
from trunnion.planning.poses.placement import OUT_OF_REACH, REWIND
from trunnion.planning.poses.selection import PlannedPoses


def judge_arcs(poses: PlannedPoses, machine: Machine, operation: Operation, keep_slide_limits: bool) -> None:
    """Take arcs into the outcome of their rows and into the extremes of the slides in ``poses``.

    A row whose arc is farther beyond a limit than its end gets the value on the arc.
    """
    rows = operation.arcs.row
    if not len(rows):
        return
    end = poses.rotary[rows]
    # After a rewind the arc begins in the pose in which it ends; a whole turn is a display that begins again.
    begin = np.where((poses.outcome[rows] == REWIND)[:, None], end, poses.rotary[np.maximum(rows - 1, 0)])
    way = end - begin
    reach = axis_reach(machine, operation_arcs(operation), end - way + 360.0 * np.rint(way / 360.0), end)
    for column in machine.linear:
        least, most = int(np.argmin(reach.low[:, column])), int(np.argmax(reach.high[:, column]))
        if reach.low[least, column] < poses.extremes[column, 0]:
            poses.extremes[column, 0], poses.extreme_rows[column, 0] = reach.low[least, column], rows[least]
        if reach.high[most, column] > poses.extremes[column, 1]:
            poses.extremes[column, 1], poses.extreme_rows[column, 1] = reach.high[most, column], rows[most]
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
