"""From states to axis positions, row by row: the columns of ``PlannedPoses``."""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Floats, Floats2, Ints, Ints2
from trunnion.jit import inlined, inner, kernel
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import POLE, UNREACHABLE, solve_slides_cos_sin, solve_tilt
from trunnion.planning.poses.rotary_solutions import (
    RotarySolution,
    branch_solution,
    first_angle,
    is_beyond,
    principal_angle,
    with_first_angle,
    with_turns,
)
from trunnion.planning.poses.search_space import SearchSpace
from trunnion.planning.poses.states import BLOCKED_STEP, POLE_JUMP, REWIND_STEP, STATE_BITS

#: Outcome of a row: nothing to report; 1 + column of the axis that is beyond its limit; or one of the others.
WITHIN_LIMITS: Final = 0
REWIND: Final = 100
BLOCKED: Final = 101
OUT_OF_REACH: Final = 200


class PoseColumns(NamedTuple):
    """The columns of ``PlannedPoses`` that follow from the states."""

    rotary: Floats2
    outcome: Codes
    beyond_value: Floats
    extremes: Floats2
    extreme_rows: Ints2
    changes: Ints


@inlined
def write_row(
    kinematics: KinematicParameters,
    space: SearchSpace,
    solution: RotarySolution,
    tip: Floats2,
    row: int,
    joints: Floats,
    columns: PoseColumns,
) -> None:
    """Write the columns of a row, except the state.

    ``joints`` (5,) holds the rotary values; values that print as a limit become that limit.
    """
    low, high, display_low = space.low, space.high, space.display_low
    rotary, outcome, beyond_value, extremes, extreme_rows, _ = columns
    _, _, cos_1, sin_1, cos_2, sin_2 = solution
    solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, tip[row, 0], tip[row, 1], tip[row, 2], joints)
    for column in range(5):
        value = joints[column]
        if is_beyond(value, low[column], high[column]):
            outcome[row], beyond_value[row] = column + 1, value
        elif value < low[column]:
            joints[column] = low[column]
        elif value > high[column]:
            joints[column] = high[column]
        if joints[column] < extremes[column, 0]:
            extremes[column, 0], extreme_rows[column, 0] = joints[column], row
        if joints[column] > extremes[column, 1]:
            extremes[column, 1], extreme_rows[column, 1] = joints[column], row
    for r in range(2):
        value, begin = joints[kinematics.columns[r]], display_low[kinematics.columns[r]]
        rotary[row, r] = value if np.isnan(begin) else value - 360.0 * np.floor((value - begin) / 360.0)


@inner
def note_change(changes: Ints, row: int) -> None:
    """Enter a row into ``PlannedPoses.changes``."""
    changes[0], changes[1] = changes[0] + 1, row
    if changes[0] + 1 < len(changes):
        changes[changes[0] + 1] = row


@kernel(writes="columns")
def place_rows(
    kinematics: KinematicParameters,
    space: SearchSpace,
    tip: Floats2,
    axis: Floats2,
    state: Codes,
    columns: PoseColumns,
) -> None:
    """Fill the columns for the states of all rows."""
    joints = np.empty(5)
    last_1, last_2 = space.start[0], space.start[1]
    held, last_off_pole, branch = principal_angle(space.start[0]), -1, 0
    tilt = (0, 0.0, 0.0, 0.0, 0.0)
    for row in range(tip.shape[0]):
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if row == 0 or i != axis[row - 1, 0] or j != axis[row - 1, 1] or k != axis[row - 1, 2]:
            tilt = solve_tilt(kinematics, i, j, k)
        if tilt[0] & UNREACHABLE:
            columns.outcome[row] = OUT_OF_REACH
            columns.rotary[row, :] = np.nan
            continue
        t = state[row] & STATE_BITS
        last_branch, branch = branch, space.states[t, 0]
        solution = branch_solution(kinematics, tilt, branch)
        if tilt[0] & POLE:
            if branch != last_branch and last_off_pole >= 0:
                at = last_off_pole
                held = first_angle(kinematics, axis[at, 0], axis[at, 1], axis[at, 2], branch)
            solution = with_first_angle(kinematics, solution, held)
        else:
            held, last_off_pole = solution[0], row
        value_1 = with_turns(solution[0], space.states[t, 1], space.turn_ranges[1] == 0, last_1)
        value_2 = with_turns(solution[1], space.states[t, 2], space.turn_ranges[3] == 0, last_2)
        jumps = abs(value_1 - last_1) > POLE_JUMP or abs(value_2 - last_2) > POLE_JUMP
        if row > 0 and (branch != last_branch or jumps):
            note_change(columns.changes, row)
        joints[kinematics.columns[0]], joints[kinematics.columns[1]] = value_1, value_2
        write_row(kinematics, space, solution, tip, row, joints, columns)
        if columns.outcome[row] == WITHIN_LIMITS and state[row] & REWIND_STEP:
            columns.outcome[row] = BLOCKED if state[row] & BLOCKED_STEP else REWIND
        last_1, last_2 = joints[kinematics.columns[0]], joints[kinematics.columns[1]]
