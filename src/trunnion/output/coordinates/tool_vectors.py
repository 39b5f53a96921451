"""The tool axis as a vector, and the rotary positions that controls would choose for it.

Units:  degrees; unit vectors in the workpiece frame.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.controls.vocabulary import TOOL_VECTOR_WORDS
from trunnion.controls.words import Word, round_to_counts
from trunnion.machines import AngleOutput, Machine, Mount, forward, inverse
from trunnion.model.motion import Motion

#: By how much the other position must be farther away, degrees: controls differ in how they measure it.
_CLEAR_MARGIN: Final = 0.5

#: Distances are equal within this, degrees.
_SAME_DISTANCE: Final = 1e-9

#: By how much they must differ where the last digit of a vector may have turned an axis, degrees.
_DIGIT_MARGIN: Final = 1e-4

#: An axis is at its limit within this, degrees.
_AT_LIMIT: Final = 1e-7

#: The position of an axis that cannot get there, degrees.
_UNREACHABLE: Final = 1e9


def tool_vectors_at(machine: Machine, rotary: Floats) -> Floats:
    """Return the tool axes, from tip to holder, at rotary positions (n, 2): (n, 3) unit vectors."""
    joints = np.zeros((len(rotary), len(machine.axes)))
    joints[:, list(machine.rotary)] = rotary
    return forward(machine, joints)[1]


def first_row_at_other_pose(machine: Machine, motion: Motion, words: Sequence[Word]) -> int:
    """Return the first row of a motion whose vector could lead the control to another rotary position than planned.

    The control is taken to choose as in ``leading_axis_pose_is_planned``. The axis that decides is the one that carries
    the other; on machines with one axis in the table and one in the head it is that of the table.

    words  of the motion's blocks

    int  -1 if there is no such row
    """
    formats = {word.key: word.format for word in words}
    vector_decimals, angle_decimals = formats[TOOL_VECTOR_WORDS[0]].decimals, formats["primary"].decimals
    vectors = tool_vectors_at(machine, motion.rotary)
    printed = [round_to_counts(np.ascontiguousarray(vectors[:, k]), vector_decimals) for k in range(3)]
    angles = [round_to_counts(np.ascontiguousarray(motion.rotary[:, k]), angle_decimals) for k in range(2)]
    rows = 1 + np.flatnonzero(np.any([np.diff(column) != 0 for column in (*printed, *angles)], axis=0))
    if not len(rows):
        return -1
    before = motion.rotary[rows - 1]
    if rows[0] == 1:  # rotary words have moved the axes there
        before[0] = np.round(motion.rotary[0], angle_decimals)
    vectors = np.column_stack(printed)[rows] / np.float64(10**vector_decimals)
    in_table = [machine.axes[column].mount is Mount.PART for column in machine.rotary]
    planned = leading_axis_pose_is_planned(
        machine, vectors, motion.rotary[rows], before, 1 if all(in_table) else 0, rows == 1
    )
    return -1 if planned.all() else int(rows[np.argmin(planned)])


def nearest_pose_is_planned(machine: Machine, vectors: Floats, rotary: Floats, before: Floats, off: float) -> Flags:
    """Return where a control that takes the nearest rotary position for a vector gets to the planned one.

    vectors  (n, 3) float64: as they are printed
    rotary   (n, 2) float64: the planned positions. Axes that wind have their full value; axes whose words stay within
             one turn may be any number of turns off
    before   (n, 2) float64: where the axes come from
    off      how far either axis may be off, degrees

    (n,) bool  false also where the other position is about as near, and at the pole, where an axis is free
    """
    solutions, pole = _rotary_solutions(machine, vectors, before)
    _move_inside_limits(machine, solutions)
    right = np.all(np.abs(_distance_to_plan(machine, solutions, rotary)) <= off, axis=2)
    steps = np.abs(solutions - before)
    total, largest = steps.sum(axis=2), steps.max(axis=2)
    planned = np.zeros(len(vectors), np.bool_)
    for this, that in ((0, 1), (1, 0)):
        same = np.all(np.abs(solutions[this] - solutions[that]) <= off, axis=1)
        nearer = (total[this] + _CLEAR_MARGIN < total[that]) & (largest[this] + _CLEAR_MARGIN < largest[that])
        planned |= np.asarray(right[this] & (nearer | same), np.bool_)
    return planned & ~pole


def leading_axis_pose_is_planned(
    machine: Machine, vectors: Floats, rotary: Floats, before: Floats, leading: int, placed: Flags
) -> Flags:
    """Return where a control with a leading rotary axis gets to the planned position for a vector.

    Of two positions it takes the one to which the leading axis turns less, and if that is equal, the one to which the
    other axis turns less. Only the choice between the two counts: what a vector leaves open near the pole does not
    change the tool axis. Axis limits do not count for the other position, for the control may not know them. The
    planned one must be inside them as the printed vector has it: the last digit may turn an axis beyond the limit at
    which it is planned, and a control that knows the limit takes the other position.

    vectors, rotary, before  as for ``nearest_pose_is_planned``
    leading                  column of the leading axis in ``rotary``
    placed                   (n,) bool: rotary words have moved the axes to ``before``; elsewhere a vector has, to its
                             last digit

    (n,) bool  as ``nearest_pose_is_planned``
    """
    solutions, pole = _rotary_solutions(machine, vectors, before)
    right = np.all(np.abs(_distance_to_plan(machine, solutions, rotary)) <= 0.5 * _CLEAR_MARGIN, axis=2)
    inside = _inside_travel(machine, solutions)
    steps = np.abs(solutions - before)
    planned = np.zeros(len(vectors), np.bool_)
    slack = np.where(placed, _SAME_DISTANCE, -_DIGIT_MARGIN)
    for this, that in ((0, 1), (1, 0)):
        more = steps[this] - steps[that]
        # Where the leading axis decides by little, the other one must agree.
        nearer = (more[:, leading] < -_CLEAR_MARGIN) | (
            (more[:, leading] <= slack) & (more[:, 1 - leading] < -_CLEAR_MARGIN)
        )
        planned |= np.asarray(right[this] & nearer & inside[this], np.bool_)
    return planned & ~pole


def _inside_travel(machine: Machine, solutions: Floats) -> Flags:
    """Which positions (2, n, 2) are inside the travel of both axes, (2, n) bool."""
    inside = np.ones(solutions.shape[:2], np.bool_)
    for k, column in enumerate(machine.rotary):
        axis = machine.axes[column]
        if not axis.endless:
            angle = solutions[:, :, k]
            inside &= (angle >= axis.low - _AT_LIMIT) & (angle <= axis.high + _AT_LIMIT)
    return inside


def _rotary_solutions(machine: Machine, vectors: Floats, before: Floats) -> tuple[Floats, Flags]:
    """Both rotary positions of each vector, (2, n, 2), in the turn nearest to ``before``; and where an axis is free."""
    solved = inverse(machine, np.zeros_like(vectors), vectors)
    steps = solved.joints[:, :, list(machine.rotary)] - before
    return before + steps - 360.0 * np.rint(steps / 360.0), solved.pole


def _move_inside_limits(machine: Machine, solutions: Floats) -> None:
    """Move positions (2, n, 2) of axes with limits inside them by a turn, in place; else they are unreachable."""
    for k, column in enumerate(machine.rotary):
        axis = machine.axes[column]
        if axis.endless:
            continue
        angle = solutions[:, :, k]
        for turn in (360.0, -360.0):
            other, beyond = angle + turn, (angle < axis.low) | (angle > axis.high)
            angle = np.where(beyond & (other >= axis.low) & (other <= axis.high), other, angle)
        solutions[:, :, k] = np.where((angle < axis.low) | (angle > axis.high), _UNREACHABLE, angle)


def _distance_to_plan(machine: Machine, solutions: Floats, rotary: Floats) -> Floats:
    """How far positions (2, n, 2) are from the planned ones, in any turn for axes whose words stay within one."""
    distance = solutions - rotary
    for k, column in enumerate(machine.rotary):
        axis = machine.axes[column]
        if axis.endless and axis.output is not AngleOutput.NONE:
            distance[:, :, k] -= 360.0 * np.rint(distance[:, :, k] / 360.0)
    return distance
