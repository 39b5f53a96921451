"""From states to axis positions, and the states as well where there is nothing to choose.

``place`` works out the positions of rows whose states are known. ``follow_nearest`` finds states and positions in one
pass, as long as the nearest pose is the next one on the same side: most paths are like that, and on most machines it is
then the optimum (see ``trunnion.planning.poses.selection.choose_poses_in_one_pass``).
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Floats2, Ints, Ints2
from trunnion.jit import inlined, inner, kernel
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import POLE, UNREACHABLE, branch_angles, solve_slides_cos_sin, solve_tilt
from trunnion.planning.poses.states import (
    BLOCKED_STEP,
    LIMIT_TOLERANCE,
    POLE_JUMP,
    REWIND_STEP,
    STATE_BITS,
    SearchSpace,
)

#: What became of a row: nothing to say; 1 + index of the axis that is beyond its limit; or one of these.
WITHIN_LIMITS: Final = 0
REWIND: Final = 100
BLOCKED: Final = 101
OUT_OF_REACH: Final = 200

#: A step that turns the rotary axes by less than this together, degrees, is not longer than one to the other side.
_SURELY_NEAREST: Final = 60.0

#: By how much, degrees, the nearer of two poses must be nearer, so that none of the small costs can decide.
_MARGIN: Final = 1.0


# Columns of ``solutions``: what a tool axis asks of the rotary axes on a side of the machine. Bits of ``solve_tilt``;
# then as ``branch_angles`` returns them.
STATUS: Final = 0
FIRST: Final = 1
SECOND: Final = 2
COS_1: Final = 3
SIN_1: Final = 4
COS_2: Final = 5
SIN_2: Final = 6

# How ``follow_nearest`` stands between two rows: rotary values, degrees; the first one where it was last held by the
# tool axis; the side; whether that could still be the other one; whether the last tool axis was at the pole.
PREVIOUS_1: Final = 0
PREVIOUS_2: Final = 1
HELD_FIRST: Final = 2
BRANCH: Final = 3
UNDECIDED: Final = 4
WAS_POLE: Final = 5


@inner
def is_beyond(value: float, low: float, high: float) -> bool:
    """Whether a value lies outside of its limits for good."""
    return value < low - LIMIT_TOLERANCE or value > high + LIMIT_TOLERANCE


@inner
def principal_angle(value: float) -> float:
    """A value without its whole turns, degrees in [-180, 180]."""
    turns: float = np.rint(value / 360.0)
    return value - 360.0 * turns


@inner
def first_angle(kinematics: KinematicParameters, i: float, j: float, k: float, branch: int) -> float:
    """Angle of the first rotary axis under a tool axis off the pole, in a branch, degrees."""
    status, u0, u1, cos, sin = solve_tilt(kinematics, i, j, k)
    return branch_angles(kinematics, u0, u1, cos, sin if branch == 0 else -sin, status)[0]


@inner
def with_turns(angle: float, turn: int, endless: bool, last: float) -> float:
    """An angle with its turns: those of its state, or those that bring it nearest to the last value."""
    turns: float = np.rint((last - angle) / 360.0) if endless else turn
    return angle + 360.0 * turns


@inlined
def _write_row(
    kinematics: KinematicParameters,
    space: SearchSpace,
    display_low: Floats,
    cos_1: float,
    sin_1: float,
    cos_2: float,
    sin_2: float,
    tip: Floats,
    row: int,
    joints: Floats,
    found: Floats,
    outcome: Codes,
    excess: Floats,
    extremes: Floats,
    where: Ints,
) -> None:
    """Write a row's columns of ``PlannedPoses``; ``joints`` (5,) holds its rotary values, and is put onto its
    limits."""
    columns, low, high = kinematics.columns, space.low, space.high
    solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, tip[row, 0], tip[row, 1], tip[row, 2], joints)
    for column in range(5):
        value = joints[column]
        if is_beyond(value, low[column], high[column]):
            outcome[row], excess[row] = column + 1, value
        elif value < low[column]:
            joints[column] = low[column]
        elif value > high[column]:
            joints[column] = high[column]
        if joints[column] < extremes[column, 0]:
            extremes[column, 0], where[column, 0] = joints[column], row
        if joints[column] > extremes[column, 1]:
            extremes[column, 1], where[column, 1] = joints[column], row
    for r in range(2):
        value, begin = joints[columns[r]], display_low[columns[r]]
        found[row, r] = value if np.isnan(begin) else value - 360.0 * np.floor((value - begin) / 360.0)


@kernel(writes="found outcome excess extremes where changes")
def place_rows(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints2,
    display_low: Floats,
    tip: Floats2,
    axis: Floats2,
    state: Codes,
    found: Floats2,
    outcome: Codes,
    excess: Floats,
    extremes: Floats2,
    where: Ints2,
    changes: Ints,
) -> None:
    """Fill the columns of ``PlannedPoses`` for the states of all rows.

    display_low  (5,) float64   lower end of the 360 degrees that an axis displays, NaN: as it is
    """
    columns, start, turn_ranges = kinematics.columns, space.start, space.turn_ranges
    joints = np.empty(5)
    last_1, last_2 = start[0], start[1]
    held, last_off_pole, before = principal_angle(start[0]), -1, 0
    status, u0, u1, cos, sin = 0, 0.0, 0.0, 0.0, 0.0
    for row in range(tip.shape[0]):
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if row == 0 or i != axis[row - 1, 0] or j != axis[row - 1, 1] or k != axis[row - 1, 2]:
            status, u0, u1, cos, sin = solve_tilt(kinematics, i, j, k)
        if status & UNREACHABLE:
            outcome[row] = OUT_OF_REACH
            found[row, :] = np.nan
            continue
        t = state[row] & STATE_BITS
        b = states[t, 0]
        first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(
            kinematics, u0, u1, cos, sin if b == 0 else -sin, status
        )
        if status & POLE:
            if b != before and last_off_pole >= 0:
                held = first_angle(
                    kinematics, axis[last_off_pole, 0], axis[last_off_pole, 1], axis[last_off_pole, 2], b
                )
            first = held
            cos_1, sin_1 = math.cos(math.radians(first)), kinematics.sense_1 * math.sin(math.radians(first))
        else:
            held, last_off_pole = first, row
        was_1, was_2 = last_1, last_2
        last_1 = with_turns(first, states[t, 1], turn_ranges[1] == 0, last_1)
        last_2 = with_turns(second, states[t, 2], turn_ranges[3] == 0, last_2)
        if row > 0 and (b != before or abs(last_1 - was_1) > POLE_JUMP or abs(last_2 - was_2) > POLE_JUMP):
            _note_change(changes, row)
        before = b
        joints[columns[0]], joints[columns[1]] = last_1, last_2
        _write_row(
            kinematics, space, display_low, cos_1, sin_1, cos_2, sin_2, tip, row, joints,
            found, outcome, excess, extremes, where,
        )  # fmt: skip
        if outcome[row] == WITHIN_LIMITS and state[row] & REWIND_STEP:
            outcome[row] = BLOCKED if state[row] & BLOCKED_STEP else REWIND
        last_1, last_2 = joints[columns[0]], joints[columns[1]]


@kernel(writes="solutions")
def solve_rotary(kinematics: KinematicParameters, axis: Floats2, branch: int, solutions: Floats2) -> None:
    """What tool axes (k, 3) ask of the rotary axes on one side, into ``solutions`` (k, 7), columns as named above."""
    for row in range(axis.shape[0]):
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if row > 0 and i == axis[row - 1, 0] and j == axis[row - 1, 1] and k == axis[row - 1, 2]:
            for column in range(7):
                solutions[row, column] = solutions[row - 1, column]
            continue
        status, u0, u1, cos, sin = solve_tilt(kinematics, i, j, k)
        solutions[row, STATUS] = status
        if not status & UNREACHABLE:
            first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(
                kinematics, u0, u1, cos, sin if branch == 0 else -sin, status
            )
            solutions[row, FIRST], solutions[row, SECOND] = first, second
            solutions[row, COS_1], solutions[row, SIN_1], solutions[row, COS_2], solutions[row, SIN_2] = (
                cos_1,
                sin_1,
                cos_2,
                sin_2,
            )


@kernel(writes="progress state found outcome excess extremes where changes joints")
def follow_nearest(
    kinematics: KinematicParameters,
    space: SearchSpace,
    display_low: Floats,
    first_row: int,
    tip: Floats2,
    axis: Floats2,
    solutions: Floats2,
    solved_branch: int,
    progress: Floats,
    state: Codes,
    found: Floats2,
    outcome: Codes,
    excess: Floats,
    extremes: Floats2,
    where: Ints2,
    changes: Ints,
    joints: Floats,
) -> bool:
    """As ``place``, and fill ``state``, by the nearest pose from row to row as long as it stays on one side.

    Only for machines as ``trunnion.planning.poses.selection.branches_travel_alike`` describes them. Returns False, with
    the columns half filled, at the first row that leaves something to choose: a limit is left, an axis would have to
    wind back, or the other side is not clearly farther away.

    first_row  where to begin; rows before have gone by
    tilts      (k, 7) float64   of the k rows to be done now, by ``solve_rotary`` for the side ``solved_branch``
    stand      (6,) float64     how it stands before ``first_row``, and on return after the last row: columns above
    joints     (5,) float64     what it works with; a kernel that makes arrays takes longer to load
    """
    columns, low, high, turn_ranges = kinematics.columns, space.low, space.high, space.turn_ranges
    low_1, high_1, low_2, high_2 = low[columns[0]], high[columns[0]], low[columns[1]], high[columns[1]]
    last_1, last_2, held = progress[PREVIOUS_1], progress[PREVIOUS_2], progress[HELD_FIRST]
    branch, undecided, was_pole = int(progress[BRANCH]), progress[UNDECIDED] != 0.0, progress[WAS_POLE] != 0.0
    first, second, cos_1, sin_1, cos_2, sin_2 = 0.0, 0.0, 1.0, 0.0, 1.0, 0.0
    for at in range(solutions.shape[0]):
        row = first_row + at
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if at == 0 or i != axis[row - 1, 0] or j != axis[row - 1, 1] or k != axis[row - 1, 2]:
            status = int(solutions[at, STATUS])
            if status & UNREACHABLE:
                return False
            first, second, cos_1, sin_1, cos_2, sin_2 = (
                solutions[at, FIRST], solutions[at, SECOND], solutions[at, COS_1], solutions[at, SIN_1], solutions[at,
                COS_2], solutions[at, SIN_2],
            )  # fmt: skip
            if branch != solved_branch:
                first, second, cos_1, sin_1, cos_2, sin_2 = _branch_solution(kinematics, i, j, k, branch)
            if status & POLE:
                first = held
                cos_1, sin_1 = math.cos(math.radians(first)), kinematics.sense_1 * math.sin(math.radians(first))
            one, two = principal_angle(first - last_1), principal_angle(second - last_2)
            here = abs(one) + abs(two)
            if not status & POLE and (undecided or was_pole or here > _SURELY_NEAREST):
                # The other side has its first angle half a turn on, and its second one the other way.
                other_1, other_2 = principal_angle(first + 180.0), -second
                there = abs(principal_angle(other_1 - last_1)) + abs(principal_angle(other_2 - last_2))
                if not (_fits(other_1, low_1, high_1) and _fits(other_2, low_2, high_2)):
                    there = np.inf
                if undecided and not (_fits(first, low_1, high_1) and _fits(second, low_2, high_2)):
                    here = np.inf
                if undecided and there < here - _MARGIN:
                    branch = 1
                    for earlier in range(row):
                        state[earlier] += max(turn_ranges[1], 1) * max(turn_ranges[3], 1)
                    first, second, cos_1, sin_1, cos_2, sin_2 = _branch_solution(kinematics, i, j, k, branch)
                    one, two = principal_angle(first - last_1), principal_angle(second - last_2)
                elif not here < there - _MARGIN:
                    return False
            if (turn_ranges[1] and abs(one) > 180.0 - _MARGIN) or (turn_ranges[3] and abs(two) > 180.0 - _MARGIN):
                return False  # either way round ends on another turn
            if not status & POLE:
                held, undecided = first, False
            to_1, to_2 = with_turns(first, 0, True, last_1), with_turns(second, 0, True, last_2)
            if row > 0 and (abs(to_1 - last_1) > POLE_JUMP or abs(to_2 - last_2) > POLE_JUMP):
                _note_change(changes, row)
            joints[columns[0]], joints[columns[1]] = to_1, to_2
            was_pole = status & POLE != 0
        _write_row(
            kinematics, space, display_low, cos_1, sin_1, cos_2, sin_2, tip, row, joints,
            found, outcome, excess, extremes, where,
        )  # fmt: skip
        last_1, last_2 = joints[columns[0]], joints[columns[1]]
        index = branch
        if turn_ranges[1]:
            turn = int(np.rint((last_1 - first) / 360.0)) - turn_ranges[0]
            outcome[row] |= not 0 <= turn < turn_ranges[1]
            index = index * turn_ranges[1] + turn
        if turn_ranges[3]:
            turn = int(np.rint((last_2 - second) / 360.0)) - turn_ranges[2]
            outcome[row] |= not 0 <= turn < turn_ranges[3]
            index = index * turn_ranges[3] + turn
        if outcome[row] != WITHIN_LIMITS:
            return False
        state[row] = index
    progress[PREVIOUS_1], progress[PREVIOUS_2], progress[HELD_FIRST], progress[BRANCH] = last_1, last_2, held, branch
    progress[UNDECIDED], progress[WAS_POLE] = undecided, was_pole
    return True


@inner
def _branch_solution(
    kinematics: KinematicParameters, i: float, j: float, k: float, branch: int
) -> tuple[float, float, float, float, float, float]:
    """What ``branch_angles`` returns for a tool axis on a side."""
    status, u0, u1, cos, sin = solve_tilt(kinematics, i, j, k)
    return branch_angles(kinematics, u0, u1, cos, sin if branch == 0 else -sin, status)


@inner
def _fits(angle: float, low: float, high: float) -> bool:
    """Whether an angle lies within limits, maybe with whole turns added."""
    if low == -np.inf or high == np.inf:
        return True
    return not is_beyond(angle + 360.0 * math.ceil((low - LIMIT_TOLERANCE - angle) / 360.0), low, high)


@inner
def _note_change(changes: Ints, row: int) -> None:
    """Write a row into ``PlannedPoses.changes``."""
    changes[0], changes[1] = changes[0] + 1, row
    if changes[0] + 1 < len(changes):
        changes[changes[0] + 1] = row
