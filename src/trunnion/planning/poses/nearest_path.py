"""The nearest pose from row to row, in one pass, as long as nothing is to be chosen.

Most paths are like that, and on most machines this is then the optimum
(``trunnion.planning.poses.selection.choose_poses_in_one_pass``). What does not depend on the rows before is worked out
ahead, by another thread.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import POLE, UNREACHABLE, solve_tilt
from trunnion.planning.poses.placement import WITHIN_LIMITS, PoseColumns, note_change, write_row
from trunnion.planning.poses.rotary_solutions import (
    RotarySolution,
    branch_solution,
    is_beyond,
    principal_angle,
    with_first_angle,
    with_turns,
)
from trunnion.planning.poses.search_space import SearchSpace
from trunnion.planning.poses.states import LIMIT_TOLERANCE, POLE_JUMP

#: A step in which both rotary axes together turn by less than this, degrees, is no longer than one to the other branch.
_SURELY_NEAREST: Final = 60.0

#: The nearer of two poses must be nearer by this, degrees, so that none of the small costs can decide.
_MARGIN: Final = 1.0

#: Number of columns of ``solutions``: status bits of the tilt, then a ``RotarySolution``.
SOLUTION_COLUMNS: Final = 7

# Entries of ``progress``, the state between two rows: rotary values, degrees; the first one as it was last given by a
# tool axis; the branch; whether it could still be the other one; whether the last tool axis was in the pole.
LAST_1: Final = 0
LAST_2: Final = 1
HELD_FIRST: Final = 2
BRANCH: Final = 3
UNDECIDED: Final = 4
WAS_POLE: Final = 5

# What ``_compare_branches`` finds.
_KEEP: Final = 0
_CHANGE: Final = 1
_TOO_CLOSE: Final = 2


@kernel(writes="solutions")
def solve_rotary(kinematics: KinematicParameters, axis: Floats2, branch: int, solutions: Floats2) -> None:
    """Write the rotary solutions of tool axes (k, 3) in one branch into ``solutions`` (k, 7)."""
    for row in range(axis.shape[0]):
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if row > 0 and i == axis[row - 1, 0] and j == axis[row - 1, 1] and k == axis[row - 1, 2]:
            for column in range(SOLUTION_COLUMNS):
                solutions[row, column] = solutions[row - 1, column]
            continue
        tilt = solve_tilt(kinematics, i, j, k)
        solutions[row, 0] = tilt[0]
        if not tilt[0] & UNREACHABLE:
            solution = branch_solution(kinematics, tilt, branch)
            for column in range(SOLUTION_COLUMNS - 1):
                solutions[row, column + 1] = solution[column]


@kernel(writes="progress state columns joints")
def follow_nearest(
    kinematics: KinematicParameters,
    space: SearchSpace,
    first_row: int,
    tip: Floats2,
    axis: Floats2,
    solutions: Floats2,
    solved_branch: int,
    progress: Floats,
    state: Codes,
    columns: PoseColumns,
    joints: Floats,
) -> bool:
    """Fill states and columns by the nearest pose from row to row, as long as it stays in one branch.

    Only for machines as ``trunnion.planning.poses.selection.branches_travel_alike`` describes them. Returns False, with
    the columns partly filled, at the first row that leaves something to choose: a limit is left, an axis would have to
    rewind, or the other branch is not clearly farther away.

    first_row  where to begin
    solutions  (k, 7) float64  of the k rows to be done, by ``solve_rotary`` for ``solved_branch``
    progress   (6,) float64    before ``first_row``, and on return after the last row
    joints     (5,) float64    for the work: a kernel that makes arrays takes longer to load
    """
    one, two = kinematics.columns[0], kinematics.columns[1]
    last_1, last_2, held = progress[LAST_1], progress[LAST_2], progress[HELD_FIRST]
    branch, undecided, was_pole = int(progress[BRANCH]), progress[UNDECIDED] != 0.0, progress[WAS_POLE] != 0.0
    solution = (0.0, 0.0, 1.0, 0.0, 1.0, 0.0)
    for at in range(solutions.shape[0]):
        row = first_row + at
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if at == 0 or i != axis[row - 1, 0] or j != axis[row - 1, 1] or k != axis[row - 1, 2]:
            status = int(solutions[at, 0])
            if status & UNREACHABLE:
                return False
            is_pole = status & POLE != 0
            solution = _stored(solutions, at)
            if branch != solved_branch:
                solution = branch_solution(kinematics, solve_tilt(kinematics, i, j, k), branch)
            if is_pole:
                solution = with_first_angle(kinematics, solution, held)
            elif undecided or was_pole or _travel(solution, last_1, last_2) > _SURELY_NEAREST:
                found = _compare_branches(kinematics, space, solution, last_1, last_2, undecided)
                if found == _TOO_CLOSE:
                    return False
                if found == _CHANGE:
                    branch = 1
                    for earlier in range(row):
                        state[earlier] += max(space.turn_ranges[1], 1) * max(space.turn_ranges[3], 1)
                    solution = branch_solution(kinematics, solve_tilt(kinematics, i, j, k), branch)
            if _turns_half_way(space, solution, last_1, last_2):
                return False
            if not is_pole:
                held, undecided = solution[0], False
            value_1, value_2 = with_turns(solution[0], 0, True, last_1), with_turns(solution[1], 0, True, last_2)
            if row > 0 and (abs(value_1 - last_1) > POLE_JUMP or abs(value_2 - last_2) > POLE_JUMP):
                note_change(columns.changes, row)
            joints[one], joints[two] = value_1, value_2
            was_pole = is_pole
        write_row(kinematics, space, solution, tip, row, joints, columns)
        last_1, last_2 = joints[one], joints[two]
        index = _state_index(space, branch, solution, last_1, last_2)
        if index < 0 or columns.outcome[row] != WITHIN_LIMITS:
            return False
        state[row] = index
    progress[LAST_1], progress[LAST_2], progress[HELD_FIRST], progress[BRANCH] = last_1, last_2, held, branch
    progress[UNDECIDED], progress[WAS_POLE] = undecided, was_pole
    return True


@inner
def _stored(solutions: Floats2, at: int) -> RotarySolution:
    return (
        solutions[at, 1], solutions[at, 2], solutions[at, 3], solutions[at, 4], solutions[at, 5], solutions[at, 6],
    )  # fmt: skip


@inner
def _travel(solution: RotarySolution, last_1: float, last_2: float) -> float:
    """Turn of both axes to a solution, the shorter way."""
    return abs(principal_angle(solution[0] - last_1)) + abs(principal_angle(solution[1] - last_2))


@inner
def _compare_branches(
    kinematics: KinematicParameters,
    space: SearchSpace,
    solution: RotarySolution,
    last_1: float,
    last_2: float,
    undecided: bool,
) -> int:
    """Whether to keep the branch of a solution or to change to the other one, which is allowed while ``undecided``."""
    low_1, high_1 = space.low[kinematics.columns[0]], space.high[kinematics.columns[0]]
    low_2, high_2 = space.low[kinematics.columns[1]], space.high[kinematics.columns[1]]
    here = _travel(solution, last_1, last_2)
    # In the other branch the first angle is half a turn away, and the second one opposite.
    other_1, other_2 = principal_angle(solution[0] + 180.0), -solution[1]
    there = abs(principal_angle(other_1 - last_1)) + abs(principal_angle(other_2 - last_2))
    if not (_fits(other_1, low_1, high_1) and _fits(other_2, low_2, high_2)):
        there = np.inf
    if undecided and not (_fits(solution[0], low_1, high_1) and _fits(solution[1], low_2, high_2)):
        here = np.inf
    if undecided and there < here - _MARGIN:
        return _CHANGE
    return _KEEP if here < there - _MARGIN else _TOO_CLOSE


@inner
def _fits(angle: float, low: float, high: float) -> bool:
    """Whether an angle is within limits with some number of whole turns."""
    if low == -np.inf or high == np.inf:
        return True
    return not is_beyond(angle + 360.0 * math.ceil((low - LIMIT_TOLERANCE - angle) / 360.0), low, high)


@inner
def _turns_half_way(space: SearchSpace, solution: RotarySolution, last_1: float, last_2: float) -> bool:
    """Whether a limited axis turns by about half a turn, so that either way is as short and ends on another turn."""
    limit = 180.0 - _MARGIN
    first = space.turn_ranges[1] > 0 and abs(principal_angle(solution[0] - last_1)) > limit
    return first or (space.turn_ranges[3] > 0 and abs(principal_angle(solution[1] - last_2)) > limit)


@inner
def _state_index(space: SearchSpace, branch: int, solution: RotarySolution, value_1: float, value_2: float) -> int:
    """Return the state with these rotary values; -1 if there is none with as many turns."""
    index = branch
    low_1, count_1, low_2, count_2 = space.turn_ranges
    if count_1:
        turn = int(np.rint((value_1 - solution[0]) / 360.0)) - low_1
        if not 0 <= turn < count_1:
            return -1
        index = index * count_1 + turn
    if count_2:
        turn = int(np.rint((value_2 - solution[1]) / 360.0)) - low_2
        if not 0 <= turn < count_2:
            return -1
        index = index * count_2 + turn
    return index
