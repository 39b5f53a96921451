"""One row of the search: angles of both branches, open states, and the steps from the row before.

These inner functions are inlined into the passes of ``trunnion.planning.poses.optimizer``: calls took longer than the
work itself. They take the arrays of ``Workspace`` one by one, because taking them out of the tuple in every function,
each time with a count of references, made the search half as fast.
"""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3, Ints2, Ints3
from trunnion.jit import inlined
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import POLE, solve_slides_cos_sin
from trunnion.planning.poses.rotary_solutions import (
    Tilt,
    branch_solution,
    is_beyond,
    principal_angle,
    with_first_angle,
)
from trunnion.planning.poses.search_space import SearchSpace

#: A value is surely beyond a limit by more than this, degrees, whatever the rounding.
_CLEARLY_BEYOND: Final = 1e-3

#: Motion below this, degrees, has no direction: vectors of CL files are rounded.
NO_MOTION: Final = 1e-3

#: Slides beyond their limits in a branch that was not worked out.
SKIPPED: Final = 50

# Indices of the columns of ``Workspace``.
PREVIOUS: Final = 0
CURRENT: Final = 1
HEADING: Final = 2
REWINDS: Final = 0
OPEN: Final = 1
SLIDES_BEYOND: Final = 0
IS_OPEN: Final = 1
WAS_OPEN: Final = 2


class Workspace(NamedTuple):
    """What a pass keeps from row to row: s states, 2 branches, 2 rotary axes; PREVIOUS row and CURRENT row.

    cost           (2, s) float64     least cost of each state, above that of the cheapest; inf if it is closed
    counts         (2, 2, s) int64    REWINDS on the way to the state; OPEN: whether it is within limits
    angle          (3, 2, 2) float64  of both branches, in (-180, 180] degrees; HEADING: their last steps with motion
    step           (2, 2, 2) float64  from branch to branch, the shorter way of each axis, degrees
    turn_jump      (2, 2, 2) int64    whole turns by which the angle jumps in that step
    branch_status  (2, 3) int64       of each branch: SLIDES_BEYOND limits; IS_OPEN: it has an open state in this row;
                                      WAS_OPEN: in the row before
    joints         (5,) float64       one position
    """

    cost: Floats2
    counts: Ints3
    angle: Floats3
    step: Floats3
    turn_jump: Ints3
    branch_status: Ints2
    joints: Floats


def workspace(states: int) -> Workspace:
    """Return an empty workspace for a number of states."""
    return Workspace(
        cost=np.full((2, states), np.inf),
        counts=np.zeros((2, 2, states), np.int64),
        angle=np.zeros((3, 2, 2)),
        step=np.zeros((2, 2, 2)),
        turn_jump=np.zeros((2, 2, 2), np.int64),
        branch_status=np.zeros((2, 3), np.int64),
        joints=np.empty(5),
    )


@inlined
def start_angles(space: SearchSpace, angle: Floats3) -> None:
    """Set the previous angles of both branches to the start."""
    for b in range(2):
        angle[PREVIOUS, b, 0] = principal_angle(space.start[0])
        angle[PREVIOUS, b, 1] = principal_angle(space.start[1])


@inlined
def solve_branches(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints2,
    angle: Floats3,
    branch_status: Ints2,
    joints: Floats,
    tilt: Tilt,
    x: float,
    y: float,
    z: float,
    skip: bool,
) -> None:
    """Angles of both branches in this row, and how many slides they put beyond limits; x, y, z: the tip.

    With ``skip`` a branch 1 that is surely closed is left out, which saves half the work on many machines. Its first
    angle keeps its value.
    """
    for b in range(2):
        if b == 1 and skip and _second_branch_is_closed(kinematics, space, states, angle, branch_status):
            branch_status[1, SLIDES_BEYOND] = SKIPPED
            break
        solution = branch_solution(kinematics, tilt, b)
        if tilt[0] & POLE:
            solution = with_first_angle(kinematics, solution, angle[PREVIOUS, b, 0])
        angle[CURRENT, b, 0], angle[CURRENT, b, 1] = solution[0], solution[1]
        branch_status[b, SLIDES_BEYOND] = 0
        if space.has_slide_limits:
            solve_slides_cos_sin(kinematics, solution[2], solution[3], solution[4], solution[5], x, y, z, joints)
            for slide in range(3):
                column = kinematics.columns[2 + slide]
                beyond = is_beyond(joints[column], space.low[column], space.high[column])
                branch_status[b, SLIDES_BEYOND] += beyond


@inlined
def _second_branch_is_closed(
    kinematics: KinematicParameters, space: SearchSpace, states: Ints2, angle: Floats3, branch_status: Ints2
) -> bool:
    """Whether branch 1 is closed because branch 0 keeps all limits, and the second axis of branch 1 does not.

    The second angles of both branches add up to a constant of the machine.
    """
    one, two = kinematics.columns[0], kinematics.columns[1]
    low_1, high_1, low_2, high_2 = space.low[one], space.high[one], space.low[two], space.high[two]
    first, second = angle[CURRENT, 0, 0], angle[CURRENT, 0, 1]
    other = principal_angle(space.second_angle_sum - second)
    inside, surely = False, True
    for t in range(len(states)):
        if states[t, 0] == 0:
            beyond = is_beyond(first + 360.0 * states[t, 1], low_1, high_1)
            inside |= not (beyond or is_beyond(second + 360.0 * states[t, 2], low_2, high_2))
        else:
            value = other + 360.0 * states[t, 2]
            surely &= value < low_2 - _CLEARLY_BEYOND or value > high_2 + _CLEARLY_BEYOND
    return inside and surely and branch_status[0, SLIDES_BEYOND] == 0


@inlined
def open_states(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints2,
    counts: Ints3,
    angle: Floats3,
    branch_status: Ints2,
) -> None:
    """Open the states with the fewest axes beyond their limits."""
    one, two = kinematics.columns[0], kinematics.columns[1]
    low_1, high_1, low_2, high_2 = space.low[one], space.high[one], space.low[two], space.high[two]
    least = 99
    for t in range(len(states)):
        b = states[t, 0]
        beyond = branch_status[b, SLIDES_BEYOND]
        beyond += is_beyond(angle[CURRENT, b, 0] + 360.0 * states[t, 1], low_1, high_1)
        beyond += is_beyond(angle[CURRENT, b, 1] + 360.0 * states[t, 2], low_2, high_2)
        counts[CURRENT, REWINDS, t] = beyond  # until the pass counts rewinds there
        least = min(least, beyond)
    branch_status[0, IS_OPEN] = branch_status[1, IS_OPEN] = 0
    for t in range(len(states)):
        counts[CURRENT, OPEN, t] = counts[CURRENT, REWINDS, t] == least
        branch_status[states[t, 0], IS_OPEN] |= counts[CURRENT, OPEN, t]


@inlined
def branch_steps(angle: Floats3, step: Floats3, turn_jump: Ints3, branch_status: Ints2) -> None:
    """Fill in the steps from branch to branch, the shorter way, where both have open states."""
    for a in range(2):
        for b in range(2):
            if not (branch_status[a, WAS_OPEN] and branch_status[b, IS_OPEN]):
                continue
            for r in range(2):
                change = angle[CURRENT, b, r] - angle[PREVIOUS, a, r]
                turns = np.rint(change / 360.0)
                step[a, b, r] = change - 360.0 * turns
                turn_jump[a, b, r] = int(turns)


@inlined
def travel_from_start(space: SearchSpace, states: Ints2, angle: Floats3, t: int) -> float:
    """Travel to state ``t`` of the first row, degrees."""
    travel = 0.0
    for r in range(2):
        step = angle[CURRENT, states[t, 0], r] - space.start[r]
        if space.turn_ranges[2 * r + 1] == 0:
            step -= 360.0 * np.rint(step / 360.0)
        travel += abs(step + 360.0 * states[t, 1 + r])
    return travel


@inlined
def rotary_step(
    space: SearchSpace, states: Ints2, step: Floats3, turn_jump: Ints3, s: int, t: int
) -> tuple[float, float, bool]:
    """Return the step of both rotary axes from state ``s`` to ``t``, degrees, and whether both take the shorter way."""
    a, b = states[s, 0], states[t, 0]
    one, two, turns = step[a, b, 0], step[a, b, 1], 0
    if space.turn_ranges[1]:
        turns = states[t, 1] - states[s, 1] + turn_jump[a, b, 0]
        one += 360.0 * turns
    if space.turn_ranges[3]:
        more = states[t, 2] - states[s, 2] + turn_jump[a, b, 1]
        two += 360.0 * more
        turns |= more
    return one, two, turns == 0


@inlined
def advance(cost: Floats2, counts: Ints3, angle: Floats3, step: Floats3, branch_status: Ints2) -> None:
    """Make this row the previous one. Costs are counted from the cheapest state on, so that they keep their digits."""
    base = np.inf
    for t in range(cost.shape[1]):
        base = min(base, cost[CURRENT, t])
    for t in range(cost.shape[1]):
        cost[PREVIOUS, t] = cost[CURRENT, t] - base
        counts[PREVIOUS, REWINDS, t] = counts[CURRENT, REWINDS, t]
        counts[PREVIOUS, OPEN, t] = counts[CURRENT, OPEN, t]
    for b in range(2):
        for r in range(2):
            if not (branch_status[b, IS_OPEN] and branch_status[b, WAS_OPEN]):
                angle[HEADING, b, r] = 0.0
            elif abs(step[b, b, r]) > NO_MOTION:
                angle[HEADING, b, r] = step[b, b, r]
            angle[PREVIOUS, b, r] = angle[CURRENT, b, r]
        branch_status[b, WAS_OPEN] = branch_status[b, IS_OPEN]
