"""Orientations said by the tool's vector, and which of them a control would turn into the planned rotary positions.

Units:  degrees; vectors of length 1, in the workpiece frame.
"""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.controls.vocabulary import TOOL_VECTOR_WORDS
from trunnion.controls.words import Word, round_to_counts
from trunnion.machines import AngleOutput, Machine, Mount, forward, inverse
from trunnion.model.motion import Motion

#: How much farther away the other position must be, degrees: controls may count what is nearest in ways of their own.
_CLEAR_MARGIN = 0.5

#: Ways that differ by no more are the same, degrees; and how much they must differ where an axis may stand elsewhere by
#: what a vector's last digit turns it.
_SAME_DISTANCE = 1e-9
_DIGIT_MARGIN = 1e-4

#: Where an axis cannot go, degrees.
_UNREACHABLE = 1e9


def tool_vectors_at(machine: Machine, rotary: Floats) -> Floats:
    """(n, 3): where the tool points from its tip with the rotary axes at ``rotary`` (n, 2)."""
    joints = np.zeros((len(rotary), len(machine.axes)))
    joints[:, list(machine.rotary)] = rotary
    return forward(machine, joints)[1]


def first_row_at_other_pose(machine: Machine, motion: Motion, words: Sequence[Word]) -> int:
    """The first row of a motion for whose vector a control could go elsewhere than planned; -1: there is none.

    It chooses as ``leading_axis_pose_is_planned`` says: the axis decides that carries the other one, or on machines
    that turn both workpiece and tool that of the table. ``words`` are those of the motion's blocks.
    """
    formats = {word.key: word.format for word in words}
    digits, of_angles = formats[TOOL_VECTOR_WORDS[0]].decimals, formats["primary"].decimals
    vectors = tool_vectors_at(machine, motion.rotary)
    printed = [round_to_counts(np.ascontiguousarray(vectors[:, k]), digits) for k in range(3)]
    turns = [round_to_counts(np.ascontiguousarray(motion.rotary[:, k]), of_angles) for k in range(2)]
    rows = 1 + np.flatnonzero(np.any([np.diff(column) != 0 for column in (*printed, *turns)], axis=0))
    if not len(rows):
        return -1
    before = motion.rotary[rows - 1]
    if rows[0] == 1:  # the axes were placed there, by words
        before[0] = np.round(motion.rotary[0], of_angles)
    shown = np.column_stack(printed)[rows] / np.float64(10**digits)
    in_table = [machine.axes[column].mount is Mount.PART for column in machine.rotary]
    leads = leading_axis_pose_is_planned(
        machine, shown, motion.rotary[rows], before, 1 if all(in_table) else 0, rows == 1
    )
    return -1 if leads.all() else int(rows[np.argmin(leads)])


def nearest_pose_is_planned(machine: Machine, vectors: Floats, rotary: Floats, before: Floats, off: float) -> Flags:
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
    found, pole = _rotary_solutions(machine, vectors, before)
    _move_inside_limits(machine, found)
    right = np.all(np.abs(_distance_to_plan(machine, found, rotary)) <= off, axis=2)
    ways = np.abs(found - before)
    sums, most = ways.sum(axis=2), ways.max(axis=2)
    leads = np.zeros(len(vectors), np.bool_)
    for this, that in ((0, 1), (1, 0)):
        same = np.all(np.abs(found[this] - found[that]) <= off, axis=1)
        nearer = (sums[this] + _CLEAR_MARGIN < sums[that]) & (most[this] + _CLEAR_MARGIN < most[that])
        leads |= np.asarray(right[this] & (nearer | same), np.bool_)
    return leads & ~pole


def leading_axis_pose_is_planned(
    machine: Machine, vectors: Floats, rotary: Floats, before: Floats, deciding: int, placed: Flags
) -> Flags:
    """Whether a control that has one rotary axis decide between two positions gets to the planned one.

    It takes the position to which that axis turns less, and where that is the same, the one to which the other axis
    turns less. Arguments and result as ``nearest_pose_is_planned``; ``deciding`` is 0 or 1, as ``machine.rotary`` has
    them. Where ``placed`` (n,) the axes stand at ``before`` by words, and not about there by a vector. Of the
    planned positions it is only asked which of the two they are: what a vector leaves open of them near a pole is
    nothing that the tool axis would show. Limits of axes count for nothing: it may not have been told of them.
    """
    found, pole = _rotary_solutions(machine, vectors, before)
    right = np.all(np.abs(_distance_to_plan(machine, found, rotary)) <= 0.5 * _CLEAR_MARGIN, axis=2)
    ways = np.abs(found - before)
    leads = np.zeros(len(vectors), np.bool_)
    slack = np.where(placed, _SAME_DISTANCE, -_DIGIT_MARGIN)
    for this, that in ((0, 1), (1, 0)):
        more = ways[this] - ways[that]
        # Where the first axis decides by a hair, the other one must say the same.
        nearer = (more[:, deciding] < -_CLEAR_MARGIN) | (
            (more[:, deciding] <= slack) & (more[:, 1 - deciding] < -_CLEAR_MARGIN)
        )
        leads |= np.asarray(right[this] & nearer, np.bool_)
    return leads & ~pole


def _rotary_solutions(machine: Machine, vectors: Floats, before: Floats) -> tuple[Floats, Flags]:
    """Both rotary positions for each vector, (2, n, 2), nearest to where the axes stand; and where an axis is free."""
    solved = inverse(machine, np.zeros_like(vectors), vectors)
    found = solved.joints[:, :, list(machine.rotary)] - before
    return before + found - 360.0 * np.rint(found / 360.0), solved.pole


def _move_inside_limits(machine: Machine, found: Floats) -> None:
    """Take positions (2, n, 2) of axes with ends into their limits by a turn; where there is none, to nowhere."""
    for k, column in enumerate(machine.rotary):
        axis = machine.axes[column]
        if axis.endless:
            continue
        for turn in (360.0, -360.0):
            other = found[:, :, k] + turn
            beyond = (found[:, :, k] < axis.low) | (found[:, :, k] > axis.high)
            found[:, :, k] = np.where(beyond & (other >= axis.low) & (other <= axis.high), other, found[:, :, k])
        found[:, :, k] = np.where(
            (found[:, :, k] < axis.low) | (found[:, :, k] > axis.high), _UNREACHABLE, found[:, :, k]
        )


def _distance_to_plan(machine: Machine, found: Floats, rotary: Floats) -> Floats:
    """How far positions (2, n, 2) are from the planned ones; of axes that are written within one turn in any turn."""
    apart = found - rotary
    for k, column in enumerate(machine.rotary):
        axis = machine.axes[column]
        if axis.endless and axis.output is not AngleOutput.NONE:  # such positions have no turns
            apart[:, :, k] -= 360.0 * np.rint(apart[:, :, k] / 360.0)
    return apart
