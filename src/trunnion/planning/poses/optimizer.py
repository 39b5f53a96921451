"""The states of a whole operation at once, by dynamic programming.

A forward pass finds for every state of a row the least cost of getting there, and from which state of the row before;
then the path is read backwards from the cheapest state of the last row. Cost means fewest rewinds first, then degrees
(``trunnion.planning.poses.states``).

Limits are hard: a state beyond a limit is closed. If all are, those with the fewest axes beyond their limits stay open,
so that there is a pose to report.

A step is *direct* if it stays in its branch and both axes take the shorter way: points inserted between its ends
follow the tool axis, however coarse the path is. In the pole the free angle holds, and both branches continue
directly. Any other step in the cut that bends the tool axis half-way (or half a turn on) by more than ``MAX_BEND`` is
a rewind. It takes place off the part at the row before, so the state to which it leads must be open there; if it is
not, the step is blocked.

Memory: one byte for each state and row, and one more for each row.
"""

import numpy as np

from trunnion.arrays import Codes, Codes2, Floats2
from trunnion.jit import kernel
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import POLE, UNREACHABLE, solve_tilt
from trunnion.planning.poses.contact import NO_CONTACT
from trunnion.planning.poses.rotary_solutions import first_angle
from trunnion.planning.poses.search_rows import (
    CURRENT,
    OPEN,
    PREVIOUS,
    REWINDS,
    SKIPPED,
    SLIDES_BEYOND,
    Workspace,
    advance,
    branch_steps,
    open_states,
    rotary_step,
    solve_branches,
    start_angles,
    travel_from_start,
)
from trunnion.planning.poses.search_space import SearchSpace
from trunnion.planning.poses.states import NEAR_LIMITS_COST, NON_PREFERRED_COST, STATE_BITS
from trunnion.planning.poses.step_costs import (
    NO_PATH,
    SAME_COST,
    find_predecessor,
    is_not_preferred,
    nearness_to_limits,
)


@kernel(writes="backpointers work")
def find_cheapest(
    kinematics: KinematicParameters,
    space: SearchSpace,
    tip: Floats2,
    axis: Floats2,
    contact: Codes,
    prefer: int,
    backpointers: Codes2,
    work: Workspace,
) -> int:
    """Fill the backpointers (n, s); return the state in which the cheapest path ends.

    contact  (n,) uint8  of ``trunnion.planning.poses.contact``
    prefer   the preferred branch; -1: none
    """
    states = space.states
    cost, counts, angle, step, turn_jump, branch_status, joints = work
    start_angles(space, angle)
    cost_at_limits = NEAR_LIMITS_COST / max(len(tip), 1)
    has_started, was_pole, was_in_contact = False, False, False
    tilt, last_off_pole = (0, 0.0, 0.0, 0.0, 0.0), -1
    i, j, k = np.nan, np.nan, np.nan
    for row in range(len(tip)):
        i_0, j_0, k_0 = i, j, k
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        is_new = i != i_0 or j != j_0 or k != k_0
        if is_new:
            tilt = solve_tilt(kinematics, i, j, k)
        if tilt[0] & UNREACHABLE:
            for t in range(len(states)):
                backpointers[row, t] = t
            continue
        if is_new or space.has_slide_limits:
            is_pole = tilt[0] & POLE != 0
            if is_pole and branch_status[1, SLIDES_BEYOND] == SKIPPED and last_off_pole >= 0:
                at = last_off_pole
                angle[PREVIOUS, 1, 0] = first_angle(kinematics, axis[at, 0], axis[at, 1], axis[at, 2], 1)
            if not is_pole:
                last_off_pole = row
            solve_branches(
                kinematics,
                space,
                states,
                angle,
                branch_status,
                joints,
                tilt,
                tip[row, 0],
                tip[row, 1],
                tip[row, 2],
                not is_pole,
            )
            open_states(kinematics, space, states, counts, angle, branch_status)
        branch_steps(angle, step, turn_jump, branch_status)
        starts_contact = contact[row] != NO_CONTACT and not was_in_contact
        for t in range(len(states)):
            cost[CURRENT, t], counts[CURRENT, REWINDS, t], backpointers[row, t] = np.inf, 0, t
            if not counts[CURRENT, OPEN, t]:
                continue
            if has_started:
                backpointers[row, t] = find_predecessor(
                    kinematics,
                    space,
                    states,
                    cost,
                    counts,
                    angle,
                    step,
                    turn_jump,
                    branch_status,
                    t,
                    contact[row],
                    was_pole,
                    i + i_0,
                    j + j_0,
                    k + k_0,
                )
            else:
                cost[CURRENT, t] = travel_from_start(space, states, angle, t)
            cost[CURRENT, t] += cost_at_limits * nearness_to_limits(kinematics, space, states, angle, t)
            if starts_contact and is_not_preferred(space, states, angle, prefer, t):
                cost[CURRENT, t] += NON_PREFERRED_COST
        advance(cost, counts, angle, step, branch_status)
        has_started, was_pole, was_in_contact = True, tilt[0] & POLE != 0, contact[row] != NO_CONTACT
    end, fewest, least = 0, NO_PATH, np.inf
    for t in range(len(states)):
        rewinds, total = counts[PREVIOUS, REWINDS, t], cost[PREVIOUS, t]
        if total < np.inf and (rewinds < fewest or (rewinds == fewest and total < least - SAME_COST)):
            end, fewest, least = t, rewinds, total
    return end


@kernel(writes="backpointers work")
def find_nearest(
    kinematics: KinematicParameters,
    space: SearchSpace,
    tip: Floats2,
    axis: Floats2,
    backpointers: Codes2,
    work: Workspace,
) -> int:
    """As ``find_cheapest``, but from row to row the state with the least travel, without regard to what follows."""
    states = space.states
    cost, counts, angle, step, turn_jump, branch_status, joints = work
    start_angles(space, angle)
    state, has_started = 0, False
    for row in range(len(tip)):
        tilt = solve_tilt(kinematics, axis[row, 0], axis[row, 1], axis[row, 2])
        for t in range(len(states)):
            backpointers[row, t] = state
        if tilt[0] & UNREACHABLE:
            continue
        solve_branches(
            kinematics, space, states, angle, branch_status, joints, tilt, tip[row, 0], tip[row, 1], tip[row, 2], False
        )
        open_states(kinematics, space, states, counts, angle, branch_status)
        branch_steps(angle, step, turn_jump, branch_status)
        best, last = np.inf, state
        for offset in range(len(states)):
            t = (last + offset) % len(states)
            if counts[CURRENT, OPEN, t]:
                one, two, _ = rotary_step(space, states, step, turn_jump, last, t)
                travel = abs(one) + abs(two) if has_started else travel_from_start(space, states, angle, t)
                if travel < best - SAME_COST:
                    best, state = travel, t
        advance(cost, counts, angle, step, branch_status)
        has_started = True
    return state


@kernel(writes="state")
def trace_back(backpointers: Codes2, end: int, state: Codes) -> None:
    """Read the path backwards: ``state`` (n,) becomes the state of each row, with the bits of the step into it."""
    current = end
    for row in range(backpointers.shape[0] - 1, -1, -1):
        pointer = backpointers[row, current]
        state[row] = current | (pointer & ~STATE_BITS)
        current = pointer & STATE_BITS
