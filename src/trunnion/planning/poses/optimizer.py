"""The states of a whole operation at once: dynamic programming, row by row.

A forward pass knows for every state of a row the least that it costs to get there, and from which state of the row
before; then the way back is read from the last row's cheapest state. What is least is counted first in rewinds, then in
degrees (``trunnion.planning.poses.states``).

Limits are hard: a state beyond a limit is closed. Where all are, those beyond the fewest axes stay open, so that there
is a row to complain about.

A step is *natural* when it stays in its branch and both axes take the nearer way: where points are added between its
ends, it follows the tool axis however coarse the path is. At the pole the free angle holds, and both branches go on
naturally. Any other step in the cut that bends the tool axis half-way (or half a turn on) by more than ``BEND`` is a
rewind. It takes place off the part at the row before, so the state that it leads to must be open there; if it is not,
the step is blocked.

Memory: one byte a state and row, and one more a row.

Small kernels are inlined into the big ones, and these work without counting references to arrays (``_nrt``), which is
why they are handed all that they work with: calls and counting took longer than all the rest.
"""

import math
from typing import Final, TypeAlias

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.jit import njit
from trunnion.machines import Packed
from trunnion.machines.inverse import POLE, UNREACHABLE, branch_angles, place_slides, solve_tilt, turned
from trunnion.planning.poses.placement import beyond, first_of, folded
from trunnion.planning.poses.states import (
    AT_LIMITS,
    BEND,
    IN_CUT,
    LIMIT_TOLERANCE,
    OTHER_SIDE,
    POLE_JUMP,
    POLE_PASS,
    REVERSAL,
    REWOUND,
    SIDE_CHANGE,
    STATE,
    STUCK_FAST,
    Choice,
)

#: What the move into a row does: nothing to the part; touches it; cuts.
IDLE: Final = 0
TOUCHES: Final = 1
CUTS: Final = 2

#: Rewinds that a blocked step counts as.
_BLOCKED: Final = 1 << 20

#: Two costs nearer than this, degrees, are equal.
_EQUAL: Final = 1e-9

#: Beyond a limit by more than this, degrees, however it was worked out.
_CLEARLY: Final = 1e-3

#: Motion below this, degrees, has no direction: vectors of CL files are rounded.
_STILL: Final = 1e-3

#: What ``solve_tilt`` returns.
Tilt: TypeAlias = tuple[int, float, float, float, float]

_COS_BEND: Final = math.cos(math.radians(BEND))


@njit(cache=True)
def bends(packed: Packed, first: float, second: float, i: float, j: float, k: float) -> bool:
    """Whether the tool axis at these rotary values, degrees, is off the direction i, j, k by more than ``BEND``."""
    angle = math.radians(second)
    cos, sin = math.cos(angle), math.sin(angle)
    s0, s1, s2 = packed.spindle[0], packed.spindle[1], packed.spindle[2]
    a, b = cos * s0 - sin * s1, sin * s0 + cos * s1
    two = packed.frame_2
    x, y, z = (
        two[0] * a + two[3] * b + two[6] * s2,
        two[1] * a + two[4] * b + two[7] * s2,
        two[2] * a + two[5] * b + two[8] * s2,
    )
    angle = packed.sense_1 * math.radians(first)
    x, y, z = turned(packed.frame_1, math.cos(angle), math.sin(angle), x, y, z)
    return x * i + y * j + z * k < _COS_BEND * math.sqrt(i * i + j * j + k * k)


# What the forward pass works with besides; ``WAS`` is the last row, ``NOW`` this one.
#
# states  (s, 3) int64       ``States.table``
# cost    (2, s) float64     least cost of each state over that of the cheapest, inf where it is closed
# count   (2, 2, s) int64    FAULTS: rewinds on the way there; OPEN: whether the state is within the limits
# angle   (3, 2, 2) float64  of both branches (-180, 180] degrees, and HEADING: their last steps that moved the axes
# step    (2, 2, 2) float64  from branch to branch, the nearer way of each axis, degrees
# around  (2, 2, 2) int64    turns by which its angle jumps on that way
# side    (2, 3) int64       of each branch: slides beyond limits; whether it has an open state in this row; in the
#                            last row
WAS: Final = 0
NOW: Final = 1
HEADING: Final = 2
FAULTS: Final = 0
OPEN: Final = 1
OUTSIDE: Final = 0
ALIVE: Final = 1
WAS_ALIVE: Final = 2

#: Slides beyond their limits in a branch that was not worked out.
_SKIPPED: Final = 50


@njit(cache=True, inline="always")
def _turn_to(
    packed: Packed,
    choice: Choice,
    states: Ints,
    angle: Floats,
    side: Ints,
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
        if b == 1 and skip and _is_closed(packed, choice, states, angle, side):
            side[1, OUTSIDE] = _SKIPPED
            break
        first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(packed, u0, u1, cos, sin if b == 0 else -sin, status)
        if status & POLE:
            first = angle[WAS, b, 0]
        angle[NOW, b, 0], angle[NOW, b, 1] = first, second
        side[b, OUTSIDE] = 0
        if choice.slides:
            if status & POLE:
                cos_1, sin_1 = math.cos(math.radians(first)), packed.sense_1 * math.sin(math.radians(first))
            place_slides(packed, cos_1, sin_1, cos_2, sin_2, x, y, z, joints)
            for slide in range(3):
                column = packed.columns[2 + slide]
                side[b, OUTSIDE] += beyond(joints[column], choice.low[column], choice.high[column])


@njit(cache=True, inline="always")
def _is_closed(packed: Packed, choice: Choice, states: Ints, angle: Floats, side: Ints) -> bool:
    """Whether branch 1 is closed because branch 0 keeps all limits and the second axis of branch 1 does not.

    The second angles of both branches add up to a constant of the machine.
    """
    one, two = packed.columns[0], packed.columns[1]
    low_1, high_1, low_2, high_2 = choice.low[one], choice.high[one], choice.low[two], choice.high[two]
    first, second = angle[NOW, 0, 0], angle[NOW, 0, 1]
    other = folded(choice.both - second)
    inside, surely = False, True
    for t in range(len(states)):
        if states[t, 0] == 0:
            wrong = beyond(first + 360.0 * states[t, 1], low_1, high_1)
            inside |= not (wrong or beyond(second + 360.0 * states[t, 2], low_2, high_2))
        else:
            value = other + 360.0 * states[t, 2]
            surely &= value < low_2 - _CLEARLY or value > high_2 + _CLEARLY
    return inside and surely and side[0, OUTSIDE] == 0


@njit(cache=True, inline="always")
def _open_states(packed: Packed, choice: Choice, states: Ints, count: Ints, angle: Floats, side: Ints) -> None:
    """Open the states with the fewest axes beyond their limits."""
    one, two = packed.columns[0], packed.columns[1]
    low_1, high_1, low_2, high_2 = choice.low[one], choice.high[one], choice.low[two], choice.high[two]
    least = 99
    for t in range(len(states)):
        b = states[t, 0]
        outside = side[b, OUTSIDE]
        outside += beyond(angle[NOW, b, 0] + 360.0 * states[t, 1], low_1, high_1)
        outside += beyond(angle[NOW, b, 1] + 360.0 * states[t, 2], low_2, high_2)
        count[NOW, FAULTS, t] = outside
        least = min(least, outside)
    side[0, ALIVE] = side[1, ALIVE] = 0
    for t in range(len(states)):
        count[NOW, OPEN, t] = count[NOW, FAULTS, t] == least
        side[states[t, 0], ALIVE] |= count[NOW, OPEN, t]


@njit(cache=True, inline="always")
def _step(angle: Floats, step: Floats, around: Ints, side: Ints) -> None:
    """The steps between the branches the nearer way, where they have open states."""
    for a in range(2):
        for b in range(2):
            if not (side[a, WAS_ALIVE] and side[b, ALIVE]):
                continue
            for r in range(2):
                move = angle[NOW, b, r] - angle[WAS, a, r]
                whole = np.rint(move / 360.0)
                step[a, b, r] = move - 360.0 * whole
                around[a, b, r] = int(whole)


@njit(cache=True, inline="always")
def _from_start(choice: Choice, states: Ints, angle: Floats, t: int) -> float:
    """Travel to state ``t`` of the first row, degrees."""
    travel = 0.0
    for r in range(2):
        move = angle[NOW, states[t, 0], r] - choice.start[r]
        if choice.span[2 * r + 1] == 0:
            move -= 360.0 * np.rint(move / 360.0)
        travel += abs(move + 360.0 * states[t, 1 + r])
    return travel


@njit(cache=True, inline="always")
def _moves(choice: Choice, states: Ints, step: Floats, around: Ints, s: int, t: int) -> tuple[float, float, bool]:
    """How both rotary axes go from state ``s`` of the last row to ``t``, degrees; whether they take the nearer way."""
    a, b = states[s, 0], states[t, 0]
    one, two, turns = step[a, b, 0], step[a, b, 1], 0
    if choice.span[1]:
        turns = states[t, 1] - states[s, 1] + around[a, b, 0]
        one += 360.0 * turns
    if choice.span[3]:
        more = states[t, 2] - states[s, 2] + around[a, b, 1]
        two += 360.0 * more
        turns |= more
    return one, two, turns == 0


@njit(cache=True, inline="always")
def _was_open(choice: Choice, states: Ints, count: Ints, around: Ints, side: Ints, t: int) -> bool:
    """Whether the state from which one gets to ``t`` naturally was open in the last row."""
    b = states[t, 0]
    if not side[b, WAS_ALIVE]:
        return False
    index = b
    for r in range(2):
        low, most = choice.span[2 * r], choice.span[2 * r + 1]
        if most:
            turn = states[t, 1 + r] + around[b, b, r] - low
            if not 0 <= turn < most:
                return False
            index = index * most + turn
    return bool(count[WAS, OPEN, index])


@njit(cache=True, inline="always")
def _arrive(
    packed: Packed,
    choice: Choice,
    states: Ints,
    cost: Floats,
    count: Ints,
    angle: Floats,
    step: Floats,
    around: Ints,
    side: Ints,
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
        faults = count[WAS, FAULTS, s]
        if cost[WAS, s] == np.inf or faults > fewest or (faults == fewest and cost[WAS, s] >= best):
            continue
        one, two, near = _moves(choice, states, step, around, s, t)
        a = states[s, 0]
        natural = near and (a == b or was_pole)
        travel = abs(one) + abs(two)
        total, mark = cost[WAS, s] + travel, 0
        if total >= best and faults == fewest:
            continue
        small = a != b and travel < POLE_JUMP and side[a, ALIVE] != 0
        bent = (small or (cut != IDLE and not natural)) and bends(
            packed, angle[WAS, a, 0] + _half(one), angle[WAS, a, 1] + _half(two), i, j, k
        )
        if cut != IDLE and bent and not natural:
            mark, faults = REWOUND, faults + 1
            total += IN_CUT if cut == CUTS else 0.0
            if not _was_open(choice, states, count, around, side, t):
                mark, faults = mark | STUCK_FAST, faults + _BLOCKED
        elif a != b:
            total += POLE_PASS if small and not bent else SIDE_CHANGE
        if one * angle[HEADING, a, 0] < 0.0 and abs(one) > _STILL:
            total += REVERSAL
        if two * angle[HEADING, a, 1] < 0.0 and abs(two) > _STILL:
            total += REVERSAL
        if faults < fewest or (faults == fewest and total < best - _EQUAL):
            best, fewest, pointer = total, faults, s | mark
    cost[NOW, t], count[NOW, FAULTS, t] = best, fewest
    return pointer


@njit(cache=True, inline="always")
def _is_other_side(choice: Choice, states: Ints, angle: Floats, prefer: int, t: int) -> bool:
    """Whether state ``t`` is not on the preferred side."""
    b = states[t, 0]
    other: bool = prefer == 1 - b
    for r in range(2):
        other |= choice.side[r] * (angle[NOW, b, r] + 360.0 * states[t, 1 + r]) < -LIMIT_TOLERANCE
    return other


@njit(cache=True, inline="always")
def _at_limits(packed: Packed, choice: Choice, states: Ints, angle: Floats, t: int) -> float:
    """How close state ``t`` is to limits: 0 in the middle of both rotary axes' travel, 2 with both axes at its end."""
    close = 0.0
    for r in range(2):
        if choice.span[2 * r + 1]:
            low, high = choice.low[packed.columns[r]], choice.high[packed.columns[r]]
            value = angle[NOW, states[t, 0], r] + 360.0 * states[t, 1 + r]
            if high - low < np.inf:
                close += min(abs(2.0 * value - low - high) / (high - low), 1.0)
    return close


@njit(cache=True, inline="always")
def _go_on(cost: Floats, count: Ints, angle: Floats, step: Floats, side: Ints) -> None:
    """This row becomes the last one. Costs count from the cheapest on: small numbers keep their digits."""
    base = np.inf
    for t in range(cost.shape[1]):
        base = min(base, cost[NOW, t])
    for t in range(cost.shape[1]):
        cost[WAS, t] = cost[NOW, t] - base
        count[WAS, FAULTS, t] = count[NOW, FAULTS, t]
        count[WAS, OPEN, t] = count[NOW, OPEN, t]
    for b in range(2):
        for r in range(2):
            if not (side[b, ALIVE] and side[b, WAS_ALIVE]):
                angle[HEADING, b, r] = 0.0
            elif abs(step[b, b, r]) > _STILL:
                angle[HEADING, b, r] = step[b, b, r]
            angle[WAS, b, r] = angle[NOW, b, r]
        side[b, WAS_ALIVE] = side[b, ALIVE]


@njit(cache=True, inline="always")
def _half(move: float) -> float:
    """Half of a move, degrees; of more than a turn, half a turn: at whole turns nothing is bent."""
    return max(min(0.5 * move, 180.0), -180.0)


def workspace(states: int) -> tuple[Floats, Ints, Floats, Floats, Ints, Ints, Floats]:
    """What the forward pass works with, empty: cost, count, angle, step, around, side, and five joints."""
    return (
        np.full((2, states), np.inf), np.zeros((2, 2, states), np.int64), np.zeros((3, 2, 2)),
        np.zeros((2, 2, 2)), np.zeros((2, 2, 2), np.int64), np.zeros((2, 3), np.int64), np.empty(5),
    )  # fmt: skip


@njit(cache=True, nogil=True, _nrt=False)
def cheapest(
    packed: Packed,
    choice: Choice,
    states: Ints,
    tip: Floats,
    axis: Floats,
    cuts: Codes,
    prefer: int,
    back: Codes,
    cost: Floats,
    count: Ints,
    angle: Floats,
    step: Floats,
    around: Ints,
    side: Ints,
    joints: Floats,
) -> int:
    """Fill the backpointers ``back`` (n, s); return the state in which the cheapest way ends.

    cuts    (n,) uint8  IDLE, TOUCHES or CUTS
    prefer              the preferred branch; -1: none
    cost, count, angle, step, around, side, joints    of ``workspace``
    """
    for b in range(2):
        angle[WAS, b, 0], angle[WAS, b, 1] = folded(choice.start[0]), folded(choice.start[1])
    per_row = AT_LIMITS / max(len(tip), 1)
    begun, was_pole, cut_before = False, False, False
    tilt, solid = (0, 0.0, 0.0, 0.0, 0.0), -1
    i, j, k = np.nan, np.nan, np.nan
    for row in range(len(tip)):
        i_0, j_0, k_0 = i, j, k
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        fresh = i != i_0 or j != j_0 or k != k_0
        if fresh:
            tilt = solve_tilt(packed, i, j, k)
        if tilt[0] & UNREACHABLE:
            for t in range(len(states)):
                back[row, t] = t
            continue
        if fresh or choice.slides:
            pole = tilt[0] & POLE != 0
            if pole and side[1, OUTSIDE] == _SKIPPED and solid >= 0:
                angle[WAS, 1, 0] = first_of(packed, axis[solid, 0], axis[solid, 1], axis[solid, 2], 1)
            if not pole:
                solid = row
            x, y, z = tip[row, 0], tip[row, 1], tip[row, 2]
            _turn_to(packed, choice, states, angle, side, tilt, x, y, z, joints, not pole)
            _open_states(packed, choice, states, count, angle, side)
        _step(angle, step, around, side)
        begins = cuts[row] != IDLE and not cut_before
        for t in range(len(states)):
            cost[NOW, t], count[NOW, FAULTS, t], back[row, t] = np.inf, 0, t
            if not count[NOW, OPEN, t]:
                continue
            if begun:
                back[row, t] = _arrive(
                    packed, choice, states, cost, count, angle, step, around, side,
                    t, cuts[row], was_pole, i + i_0, j + j_0, k + k_0,
                )  # fmt: skip
            else:
                cost[NOW, t] = _from_start(choice, states, angle, t)
            cost[NOW, t] += per_row * _at_limits(packed, choice, states, angle, t)
            if begins and _is_other_side(choice, states, angle, prefer, t):
                cost[NOW, t] += OTHER_SIDE
        _go_on(cost, count, angle, step, side)
        begun, was_pole, cut_before = True, tilt[0] & POLE != 0, cuts[row] != IDLE
    end, fewest, least = 0, 1 << 60, np.inf
    for t in range(len(states)):
        faults = count[WAS, FAULTS, t]
        if cost[WAS, t] < np.inf and (faults < fewest or (faults == fewest and cost[WAS, t] < least - _EQUAL)):
            end, fewest, least = t, faults, cost[WAS, t]
    return end


@njit(cache=True, nogil=True, _nrt=False)
def nearest(
    packed: Packed,
    choice: Choice,
    states: Ints,
    tip: Floats,
    axis: Floats,
    back: Codes,
    cost: Floats,
    count: Ints,
    angle: Floats,
    step: Floats,
    around: Ints,
    side: Ints,
    joints: Floats,
) -> int:
    """As ``cheapest``, but from row to row the state with the least travel, whatever comes after."""
    for b in range(2):
        angle[WAS, b, 0], angle[WAS, b, 1] = folded(choice.start[0]), folded(choice.start[1])
    now, begun = 0, False
    for row in range(len(tip)):
        tilt = solve_tilt(packed, axis[row, 0], axis[row, 1], axis[row, 2])
        for t in range(len(states)):
            back[row, t] = now
        if tilt[0] & UNREACHABLE:
            continue
        x, y, z = tip[row, 0], tip[row, 1], tip[row, 2]
        _turn_to(packed, choice, states, angle, side, tilt, x, y, z, joints, False)
        _open_states(packed, choice, states, count, angle, side)
        _step(angle, step, around, side)
        best, last = np.inf, now
        for offset in range(len(states)):
            t = (last + offset) % len(states)
            if count[NOW, OPEN, t]:
                one, two, _ = _moves(choice, states, step, around, last, t)
                travel = abs(one) + abs(two) if begun else _from_start(choice, states, angle, t)
                if travel < best - _EQUAL:
                    best, now = travel, t
        _go_on(cost, count, angle, step, side)
        begun = True
    return now


@njit(cache=True, nogil=True)
def trace(back: Codes, end: int, state: Codes) -> None:
    """Read the way back: ``state`` (n,) is the state of each row, with the bits of the step into it."""
    now = end
    for row in range(back.shape[0] - 1, -1, -1):
        pointer = back[row, now]
        state[row] = now | (pointer & ~STATE)
        now = pointer & STATE
