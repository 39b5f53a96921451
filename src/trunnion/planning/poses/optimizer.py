"""The states of a whole operation at once: dynamic programming, row by row.

A forward pass knows for every state of a row the least that it costs to get there, and from which state of the row
before; then the way back is read from the last row's cheapest state. What is least is counted first in rewinds, then in
degrees (``trunnion.planning.poses.states``).

Limits are hard: a state beyond a limit is closed. Where all are, those beyond the fewest axes stay open, so that there
is a row to complain about.

A step is *natural* when it stays in its branch and both axes take the nearer way: where points are added between its
ends, it follows the tool axis however coarse the path is. At the pole the free angle holds, and both branches go on
naturally. Any other step in the cut that bends the tool axis half-way (or half a turn on) by more than ``MAX_BEND`` is
a rewind. It takes place off the part at the row before, so the state that it leads to must be open there; if it is not,
the step is blocked.

Memory: one byte a state and row, and one more a row.

Small kernels are inlined into the big ones, and these work without counting references to arrays (``_nrt``), which is
why they are handed all that they work with: calls and counting took longer than all the rest.
"""

import math
from typing import Final, TypeAlias

import numpy as np

from trunnion.arrays import Codes, Codes2, Floats, Floats2, Floats3, Ints, Ints2, Ints3
from trunnion.jit import inlined, inner, kernel
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import POLE, UNREACHABLE, branch_angles, rotate_about, solve_slides_cos_sin, solve_tilt
from trunnion.planning.poses.placement import first_angle, is_beyond, principal_angle
from trunnion.planning.poses.states import (
    BLOCKED_STEP,
    BRANCH_CHANGE_COST,
    LIMIT_TOLERANCE,
    MAX_BEND,
    NEAR_LIMITS_COST,
    NON_PREFERRED_COST,
    POLE_JUMP,
    POLE_PASSAGE_COST,
    REVERSAL_COST,
    REWIND_IN_CUT_COST,
    REWIND_STEP,
    STATE_BITS,
    SearchSpace,
)

#: What the move into a row does: nothing to the part; touches it; cuts.
NO_CONTACT: Final = 0
MAY_TOUCH: Final = 1
CUTS: Final = 2

#: Rewinds that a blocked step counts as.
_BLOCKED_COUNT: Final = 1 << 20

#: Two costs nearer than this, degrees, are equal.
_SAME_COST: Final = 1e-9

#: Beyond a limit by more than this, degrees, however it was worked out.
_CLEARLY_BEYOND: Final = 1e-3

#: Motion below this, degrees, has no direction: vectors of CL files are rounded.
_NO_MOTION: Final = 1e-3

#: What ``solve_tilt`` returns.
Tilt: TypeAlias = tuple[int, float, float, float, float]

_COS_BEND: Final = math.cos(math.radians(MAX_BEND))


@inner
def is_bent(kinematics: KinematicParameters, first: float, second: float, i: float, j: float, k: float) -> bool:
    """Whether the tool axis at these rotary values, degrees, is off the direction i, j, k by more than ``MAX_BEND``."""
    angle = math.radians(second)
    cos, sin = math.cos(angle), math.sin(angle)
    s0, s1, s2 = kinematics.spindle[0], kinematics.spindle[1], kinematics.spindle[2]
    a, b = cos * s0 - sin * s1, sin * s0 + cos * s1
    two = kinematics.basis_2
    x, y, z = (
        two[0] * a + two[3] * b + two[6] * s2,
        two[1] * a + two[4] * b + two[7] * s2,
        two[2] * a + two[5] * b + two[8] * s2,
    )
    angle = kinematics.sense_1 * math.radians(first)
    x, y, z = rotate_about(kinematics.basis_1, math.cos(angle), math.sin(angle), x, y, z)
    return x * i + y * j + z * k < _COS_BEND * math.sqrt(i * i + j * j + k * k)


# What the forward pass works with besides; ``PREVIOUS`` is the last row, ``CURRENT`` this one.
#
# states  (s, 3) int64       ``States.table``
# cost    (2, s) float64     least cost of each state over that of the cheapest, inf where it is closed
# count   (2, 2, s) int64    FAULTS: rewinds on the way there; OPEN: whether the state is within the limits
# angle   (3, 2, 2) float64  of both branches (-180, 180] degrees, and HEADING: their last steps that moved the axes
# step    (2, 2, 2) float64  from branch to branch, the nearer way of each axis, degrees
# around  (2, 2, 2) int64    turns by which its angle jumps on that way
# side    (2, 3) int64       of each branch: slides beyond limits; whether it has an open state in this row; in the
#                            last row
PREVIOUS: Final = 0
CURRENT: Final = 1
HEADING: Final = 2
REWINDS: Final = 0
OPEN: Final = 1
SLIDES_BEYOND: Final = 0
IS_OPEN: Final = 1
WAS_OPEN: Final = 2

#: Slides beyond their limits in a branch that was not worked out.
_SKIPPED: Final = 50


@inlined
def _solve_branches(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints,
    angle: Floats,
    branch_status: Ints,
    tilt: Tilt,
    x: float,
    y: float,
    z: float,
    joints: Floats,
    skip: bool,
) -> None:
    """Angles of both branches in this row, and how many slides they put beyond their limits.

    With ``skip`` a branch 1 that is surely closed is left out, which saves half the work on many a machine: its first
    angle stays what it was.
    """
    status, u0, u1, cos, sin = tilt
    for b in range(2):
        if b == 1 and skip and _second_branch_is_closed(kinematics, space, states, angle, branch_status):
            branch_status[1, SLIDES_BEYOND] = _SKIPPED
            break
        first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(
            kinematics, u0, u1, cos, sin if b == 0 else -sin, status
        )
        if status & POLE:
            first = angle[PREVIOUS, b, 0]
        angle[CURRENT, b, 0], angle[CURRENT, b, 1] = first, second
        branch_status[b, SLIDES_BEYOND] = 0
        if space.slides:
            if status & POLE:
                cos_1, sin_1 = math.cos(math.radians(first)), kinematics.sense_1 * math.sin(math.radians(first))
            solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z, joints)
            for slide in range(3):
                column = kinematics.columns[2 + slide]
                branch_status[b, SLIDES_BEYOND] += is_beyond(joints[column], space.low[column], space.high[column])


@inlined
def _second_branch_is_closed(
    kinematics: KinematicParameters, space: SearchSpace, states: Ints, angle: Floats, branch_status: Ints
) -> bool:
    """Whether branch 1 is closed because branch 0 keeps all limits and the second axis of branch 1 does not.

    The second angles of both branches add up to a constant of the machine.
    """
    one, two = kinematics.columns[0], kinematics.columns[1]
    low_1, high_1, low_2, high_2 = space.low[one], space.high[one], space.low[two], space.high[two]
    first, second = angle[CURRENT, 0, 0], angle[CURRENT, 0, 1]
    other = principal_angle(space.second_angle_sum - second)
    inside, surely = False, True
    for t in range(len(states)):
        if states[t, 0] == 0:
            wrong = is_beyond(first + 360.0 * states[t, 1], low_1, high_1)
            inside |= not (wrong or is_beyond(second + 360.0 * states[t, 2], low_2, high_2))
        else:
            value = other + 360.0 * states[t, 2]
            surely &= value < low_2 - _CLEARLY_BEYOND or value > high_2 + _CLEARLY_BEYOND
    return inside and surely and branch_status[0, SLIDES_BEYOND] == 0


@inlined
def _open_states(
    kinematics: KinematicParameters, space: SearchSpace, states: Ints, count: Ints, angle: Floats, branch_status: Ints
) -> None:
    """Open the states with the fewest axes beyond their limits."""
    one, two = kinematics.columns[0], kinematics.columns[1]
    low_1, high_1, low_2, high_2 = space.low[one], space.high[one], space.low[two], space.high[two]
    least = 99
    for t in range(len(states)):
        b = states[t, 0]
        outside = branch_status[b, SLIDES_BEYOND]
        outside += is_beyond(angle[CURRENT, b, 0] + 360.0 * states[t, 1], low_1, high_1)
        outside += is_beyond(angle[CURRENT, b, 1] + 360.0 * states[t, 2], low_2, high_2)
        count[CURRENT, REWINDS, t] = outside
        least = min(least, outside)
    branch_status[0, IS_OPEN] = branch_status[1, IS_OPEN] = 0
    for t in range(len(states)):
        count[CURRENT, OPEN, t] = count[CURRENT, REWINDS, t] == least
        branch_status[states[t, 0], IS_OPEN] |= count[CURRENT, OPEN, t]


@inlined
def _branch_steps(angle: Floats, step: Floats, turn_jump: Ints, branch_status: Ints) -> None:
    """The steps between the branches the nearer way, where they have open states."""
    for a in range(2):
        for b in range(2):
            if not (branch_status[a, WAS_OPEN] and branch_status[b, IS_OPEN]):
                continue
            for r in range(2):
                move = angle[CURRENT, b, r] - angle[PREVIOUS, a, r]
                whole = np.rint(move / 360.0)
                step[a, b, r] = move - 360.0 * whole
                turn_jump[a, b, r] = int(whole)


@inlined
def _travel_from_start(space: SearchSpace, states: Ints, angle: Floats, t: int) -> float:
    """Travel to state ``t`` of the first row, degrees."""
    travel = 0.0
    for r in range(2):
        move = angle[CURRENT, states[t, 0], r] - space.start[r]
        if space.turn_ranges[2 * r + 1] == 0:
            move -= 360.0 * np.rint(move / 360.0)
        travel += abs(move + 360.0 * states[t, 1 + r])
    return travel


@inlined
def _rotary_step(
    space: SearchSpace, states: Ints, step: Floats, turn_jump: Ints, s: int, t: int
) -> tuple[float, float, bool]:
    """How both rotary axes go from state ``s`` of the last row to ``t``, degrees; whether they take the nearer way."""
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
def _natural_source_is_open(
    space: SearchSpace, states: Ints, count: Ints, turn_jump: Ints, branch_status: Ints, t: int
) -> bool:
    """Whether the state from which one gets to ``t`` naturally was open in the last row."""
    b = states[t, 0]
    if not branch_status[b, WAS_OPEN]:
        return False
    index = b
    for r in range(2):
        low, most = space.turn_ranges[2 * r], space.turn_ranges[2 * r + 1]
        if most:
            turn = states[t, 1 + r] + turn_jump[b, b, r] - low
            if not 0 <= turn < most:
                return False
            index = index * most + turn
    return bool(count[PREVIOUS, OPEN, index])


@inlined
def _find_predecessor(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints,
    cost: Floats,
    count: Ints,
    angle: Floats,
    step: Floats,
    turn_jump: Ints,
    branch_status: Ints,
    t: int,
    cut: int,
    was_pole: bool,
    i: float,
    j: float,
    k: float,
) -> int:
    """Least faults and cost of state ``t`` in this row, into the columns; returns its backpointer.

    cut      IDLE, TOUCHES or CUTS
    i, j, k  sum of the tool axes of both rows
    """
    b = states[t, 0]
    best, fewest, pointer = np.inf, 1 << 60, t
    for offset in range(len(states)):
        s = t + offset if t + offset < len(states) else t + offset - len(states)  # of equals, t itself is kept
        faults = count[PREVIOUS, REWINDS, s]
        if cost[PREVIOUS, s] == np.inf or faults > fewest or (faults == fewest and cost[PREVIOUS, s] >= best):
            continue
        one, two, near = _rotary_step(space, states, step, turn_jump, s, t)
        a = states[s, 0]
        natural = near and (a == b or was_pole)
        travel = abs(one) + abs(two)
        total, mark = cost[PREVIOUS, s] + travel, 0
        if total >= best and faults == fewest:
            continue
        small = a != b and travel < POLE_JUMP and branch_status[a, IS_OPEN] != 0
        bent = (small or (cut != NO_CONTACT and not natural)) and is_bent(
            kinematics, angle[PREVIOUS, a, 0] + _half_step(one), angle[PREVIOUS, a, 1] + _half_step(two), i, j, k
        )
        if cut != NO_CONTACT and bent and not natural:
            mark, faults = REWIND_STEP, faults + 1
            total += REWIND_IN_CUT_COST if cut == CUTS else 0.0
            if not _natural_source_is_open(space, states, count, turn_jump, branch_status, t):
                mark, faults = mark | BLOCKED_STEP, faults + _BLOCKED_COUNT
        elif a != b:
            total += POLE_PASSAGE_COST if small and not bent else BRANCH_CHANGE_COST
        if one * angle[HEADING, a, 0] < 0.0 and abs(one) > _NO_MOTION:
            total += REVERSAL_COST
        if two * angle[HEADING, a, 1] < 0.0 and abs(two) > _NO_MOTION:
            total += REVERSAL_COST
        if faults < fewest or (faults == fewest and total < best - _SAME_COST):
            best, fewest, pointer = total, faults, s | mark
    cost[CURRENT, t], count[CURRENT, REWINDS, t] = best, fewest
    return pointer


@inlined
def _is_not_preferred(space: SearchSpace, states: Ints, angle: Floats, prefer: int, t: int) -> bool:
    """Whether state ``t`` is not on the preferred side."""
    b = states[t, 0]
    other: bool = prefer == 1 - b
    for r in range(2):
        other |= space.preferred_sign[r] * (angle[CURRENT, b, r] + 360.0 * states[t, 1 + r]) < -LIMIT_TOLERANCE
    return other


@inlined
def _nearness_to_limits(
    kinematics: KinematicParameters, space: SearchSpace, states: Ints, angle: Floats, t: int
) -> float:
    """How close state ``t`` is to limits: 0 in the middle of both rotary axes' travel, 2 with both axes at its end."""
    close = 0.0
    for r in range(2):
        if space.turn_ranges[2 * r + 1]:
            low, high = space.low[kinematics.columns[r]], space.high[kinematics.columns[r]]
            value = angle[CURRENT, states[t, 0], r] + 360.0 * states[t, 1 + r]
            if high - low < np.inf:
                close += min(abs(2.0 * value - low - high) / (high - low), 1.0)
    return close


@inlined
def _advance(cost: Floats, count: Ints, angle: Floats, step: Floats, branch_status: Ints) -> None:
    """This row becomes the last one. Costs count from the cheapest on: small numbers keep their digits."""
    base = np.inf
    for t in range(cost.shape[1]):
        base = min(base, cost[CURRENT, t])
    for t in range(cost.shape[1]):
        cost[PREVIOUS, t] = cost[CURRENT, t] - base
        count[PREVIOUS, REWINDS, t] = count[CURRENT, REWINDS, t]
        count[PREVIOUS, OPEN, t] = count[CURRENT, OPEN, t]
    for b in range(2):
        for r in range(2):
            if not (branch_status[b, IS_OPEN] and branch_status[b, WAS_OPEN]):
                angle[HEADING, b, r] = 0.0
            elif abs(step[b, b, r]) > _NO_MOTION:
                angle[HEADING, b, r] = step[b, b, r]
            angle[PREVIOUS, b, r] = angle[CURRENT, b, r]
        branch_status[b, WAS_OPEN] = branch_status[b, IS_OPEN]


@inlined
def _half_step(move: float) -> float:
    """Half of a move, degrees; of more than a turn, half a turn: at whole turns nothing is bent."""
    return max(min(0.5 * move, 180.0), -180.0)


def workspace(states: int) -> tuple[Floats, Ints, Floats, Floats, Ints, Ints, Floats]:
    """What the forward pass works with, empty: cost, count, angle, step, around, side, and five joints."""
    return (
        np.full((2, states), np.inf), np.zeros((2, 2, states), np.int64), np.zeros((3, 2, 2)),
        np.zeros((2, 2, 2)), np.zeros((2, 2, 2), np.int64), np.zeros((2, 3), np.int64), np.empty(5),
    )  # fmt: skip


@kernel(writes="backpointers cost count angle step turn_jump branch_status joints")
def find_cheapest(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints2,
    tip: Floats2,
    axis: Floats2,
    cuts: Codes,
    prefer: int,
    backpointers: Codes2,
    cost: Floats2,
    count: Ints3,
    angle: Floats3,
    step: Floats3,
    turn_jump: Ints3,
    branch_status: Ints2,
    joints: Floats,
) -> int:
    """Fill the backpointers ``backpointers`` (n, s); return the state in which the cheapest way ends.

    cuts    (n,) uint8  IDLE, TOUCHES or CUTS
    prefer              the preferred branch; -1: none
    cost, count, angle, step, around, side, joints    of ``workspace``
    """
    for b in range(2):
        angle[PREVIOUS, b, 0], angle[PREVIOUS, b, 1] = principal_angle(space.start[0]), principal_angle(space.start[1])
    per_row = NEAR_LIMITS_COST / max(len(tip), 1)
    has_started, was_pole, cut_before = False, False, False
    tilt, last_off_pole = (0, 0.0, 0.0, 0.0, 0.0), -1
    i, j, k = np.nan, np.nan, np.nan
    for row in range(len(tip)):
        i_0, j_0, k_0 = i, j, k
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        fresh = i != i_0 or j != j_0 or k != k_0
        if fresh:
            tilt = solve_tilt(kinematics, i, j, k)
        if tilt[0] & UNREACHABLE:
            for t in range(len(states)):
                backpointers[row, t] = t
            continue
        if fresh or space.slides:
            pole = tilt[0] & POLE != 0
            if pole and branch_status[1, SLIDES_BEYOND] == _SKIPPED and last_off_pole >= 0:
                angle[PREVIOUS, 1, 0] = first_angle(
                    kinematics, axis[last_off_pole, 0], axis[last_off_pole, 1], axis[last_off_pole, 2], 1
                )
            if not pole:
                last_off_pole = row
            x, y, z = tip[row, 0], tip[row, 1], tip[row, 2]
            _solve_branches(kinematics, space, states, angle, branch_status, tilt, x, y, z, joints, not pole)
            _open_states(kinematics, space, states, count, angle, branch_status)
        _branch_steps(angle, step, turn_jump, branch_status)
        begins = cuts[row] != NO_CONTACT and not cut_before
        for t in range(len(states)):
            cost[CURRENT, t], count[CURRENT, REWINDS, t], backpointers[row, t] = np.inf, 0, t
            if not count[CURRENT, OPEN, t]:
                continue
            if has_started:
                backpointers[row, t] = _find_predecessor(
                    kinematics, space, states, cost, count, angle, step, turn_jump, branch_status,
                    t, cuts[row], was_pole, i + i_0, j + j_0, k + k_0,
                )  # fmt: skip
            else:
                cost[CURRENT, t] = _travel_from_start(space, states, angle, t)
            cost[CURRENT, t] += per_row * _nearness_to_limits(kinematics, space, states, angle, t)
            if begins and _is_not_preferred(space, states, angle, prefer, t):
                cost[CURRENT, t] += NON_PREFERRED_COST
        _advance(cost, count, angle, step, branch_status)
        has_started, was_pole, cut_before = True, tilt[0] & POLE != 0, cuts[row] != NO_CONTACT
    end, fewest, least = 0, 1 << 60, np.inf
    for t in range(len(states)):
        faults = count[PREVIOUS, REWINDS, t]
        if cost[PREVIOUS, t] < np.inf and (
            faults < fewest or (faults == fewest and cost[PREVIOUS, t] < least - _SAME_COST)
        ):
            end, fewest, least = t, faults, cost[PREVIOUS, t]
    return end


@kernel(writes="backpointers cost count angle step turn_jump branch_status joints")
def find_nearest(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints2,
    tip: Floats2,
    axis: Floats2,
    backpointers: Codes2,
    cost: Floats2,
    count: Ints3,
    angle: Floats3,
    step: Floats3,
    turn_jump: Ints3,
    branch_status: Ints2,
    joints: Floats,
) -> int:
    """As ``find_cheapest``, but from row to row the state with the least travel, whatever comes after."""
    for b in range(2):
        angle[PREVIOUS, b, 0], angle[PREVIOUS, b, 1] = principal_angle(space.start[0]), principal_angle(space.start[1])
    now, has_started = 0, False
    for row in range(len(tip)):
        tilt = solve_tilt(kinematics, axis[row, 0], axis[row, 1], axis[row, 2])
        for t in range(len(states)):
            backpointers[row, t] = now
        if tilt[0] & UNREACHABLE:
            continue
        x, y, z = tip[row, 0], tip[row, 1], tip[row, 2]
        _solve_branches(kinematics, space, states, angle, branch_status, tilt, x, y, z, joints, False)
        _open_states(kinematics, space, states, count, angle, branch_status)
        _branch_steps(angle, step, turn_jump, branch_status)
        best, last = np.inf, now
        for offset in range(len(states)):
            t = (last + offset) % len(states)
            if count[CURRENT, OPEN, t]:
                one, two, _ = _rotary_step(space, states, step, turn_jump, last, t)
                travel = abs(one) + abs(two) if has_started else _travel_from_start(space, states, angle, t)
                if travel < best - _SAME_COST:
                    best, now = travel, t
        _advance(cost, count, angle, step, branch_status)
        has_started = True
    return now


@kernel(writes="state")
def trace_back(backpointers: Codes2, end: int, state: Codes) -> None:
    """Read the way back: ``state`` (n,) is the state of each row, with the bits of the step into it."""
    now = end
    for row in range(backpointers.shape[0] - 1, -1, -1):
        pointer = backpointers[row, now]
        state[row] = now | (pointer & ~STATE_BITS)
        now = pointer & STATE_BITS
