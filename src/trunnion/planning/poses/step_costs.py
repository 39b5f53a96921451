"""What steps and states cost in the search, and which steps are rewinds; ``trunnion.planning.poses.states`` has the
constants."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats2, Floats3, Ints2, Ints3
from trunnion.jit import inlined, inner
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import rotate_about
from trunnion.planning.poses.contact import CUTS, NO_CONTACT
from trunnion.planning.poses.search_rows import (
    CURRENT,
    HEADING,
    IS_OPEN,
    NO_MOTION,
    OPEN,
    PREVIOUS,
    REWINDS,
    WAS_OPEN,
    rotary_step,
)
from trunnion.planning.poses.search_space import SearchSpace
from trunnion.planning.poses.states import (
    BLOCKED_STEP,
    BRANCH_CHANGE_COST,
    LIMIT_TOLERANCE,
    MAX_BEND,
    POLE_JUMP,
    POLE_PASSAGE_COST,
    REVERSAL_COST,
    REWIND_IN_CUT_COST,
    REWIND_STEP,
)

#: Rewinds that a blocked step counts as.
_BLOCKED_COUNT: Final = 1 << 20

#: More rewinds than any path has.
NO_PATH: Final = 1 << 60

#: Costs nearer to each other than this, degrees, are equal.
SAME_COST: Final = 1e-9

_COS_BEND: Final = math.cos(math.radians(MAX_BEND))


@inner
def exceeds_bend(kinematics: KinematicParameters, first: float, second: float, i: float, j: float, k: float) -> bool:
    """Whether the tool axis at rotary values in degrees is off the direction i, j, k by more than ``MAX_BEND``."""
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


@inlined
def find_predecessor(
    kinematics: KinematicParameters,
    space: SearchSpace,
    states: Ints2,
    cost: Floats2,
    counts: Ints3,
    angle: Floats3,
    step: Floats3,
    turn_jump: Ints3,
    branch_status: Ints2,
    t: int,
    contact: int,
    was_pole: bool,
    i: float,
    j: float,
    k: float,
) -> int:
    """Fewest rewinds and least cost of state ``t`` in this row, into the columns; returns its backpointer.

    i, j, k  sum of the tool axes of both rows: the direction half-way
    """
    b = states[t, 0]
    best, fewest, pointer = np.inf, NO_PATH, t
    for offset in range(len(states)):
        # The first of equals is taken, which is t itself.
        s = t + offset if t + offset < len(states) else t + offset - len(states)
        rewinds = counts[PREVIOUS, REWINDS, s]
        if cost[PREVIOUS, s] == np.inf or rewinds > fewest or (rewinds == fewest and cost[PREVIOUS, s] >= best):
            continue
        one, two, is_shorter = rotary_step(space, states, step, turn_jump, s, t)
        a = states[s, 0]
        is_direct = is_shorter and (a == b or was_pole)
        travel = abs(one) + abs(two)
        total, mark = cost[PREVIOUS, s] + travel, 0
        if total >= best and rewinds == fewest:
            continue
        is_small = a != b and travel < POLE_JUMP and branch_status[a, IS_OPEN] != 0
        bends = (is_small or (contact != NO_CONTACT and not is_direct)) and exceeds_bend(
            kinematics, angle[PREVIOUS, a, 0] + _half(one), angle[PREVIOUS, a, 1] + _half(two), i, j, k
        )
        if contact != NO_CONTACT and bends and not is_direct:
            mark, rewinds = REWIND_STEP, rewinds + 1
            total += REWIND_IN_CUT_COST if contact == CUTS else 0.0
            if not _direct_source_is_open(space, states, counts, turn_jump, branch_status, t):
                mark, rewinds = mark | BLOCKED_STEP, rewinds + _BLOCKED_COUNT
        elif a != b:
            total += POLE_PASSAGE_COST if is_small and not bends else BRANCH_CHANGE_COST
        if one * angle[HEADING, a, 0] < 0.0 and abs(one) > NO_MOTION:
            total += REVERSAL_COST
        if two * angle[HEADING, a, 1] < 0.0 and abs(two) > NO_MOTION:
            total += REVERSAL_COST
        if rewinds < fewest or (rewinds == fewest and total < best - SAME_COST):
            best, fewest, pointer = total, rewinds, s | mark
    cost[CURRENT, t], counts[CURRENT, REWINDS, t] = best, fewest
    return pointer


@inlined
def _direct_source_is_open(
    space: SearchSpace, states: Ints2, counts: Ints3, turn_jump: Ints3, branch_status: Ints2, t: int
) -> bool:
    """Whether the state from which a direct step leads to ``t`` was open in the previous row."""
    b = states[t, 0]
    if not branch_status[b, WAS_OPEN]:
        return False
    index = b
    for r in range(2):
        low, count = space.turn_ranges[2 * r], space.turn_ranges[2 * r + 1]
        if count:
            turn = states[t, 1 + r] + turn_jump[b, b, r] - low
            if not 0 <= turn < count:
                return False
            index = index * count + turn
    return bool(counts[PREVIOUS, OPEN, index])


@inlined
def is_not_preferred(space: SearchSpace, states: Ints2, angle: Floats3, prefer: int, t: int) -> bool:
    """Whether state ``t`` is not in the preferred branch, or an axis does not have its preferred sign."""
    b = states[t, 0]
    other: bool = prefer == 1 - b
    for r in range(2):
        value = angle[CURRENT, b, r] + 360.0 * states[t, 1 + r]
        other |= space.preferred_sign[r] * value < -LIMIT_TOLERANCE
    return other


@inlined
def nearness_to_limits(
    kinematics: KinematicParameters, space: SearchSpace, states: Ints2, angle: Floats3, t: int
) -> float:
    """How close state ``t`` is to limits: 0 in the middle of both rotary axes' travel, 2 with both at an end of it."""
    nearness = 0.0
    for r in range(2):
        if space.turn_ranges[2 * r + 1]:
            low, high = space.low[kinematics.columns[r]], space.high[kinematics.columns[r]]
            value = angle[CURRENT, states[t, 0], r] + 360.0 * states[t, 1 + r]
            if 0.0 < high - low < np.inf:
                nearness += min(abs(2.0 * value - low - high) / (high - low), 1.0)
    return nearness


@inlined
def _half(step: float) -> float:
    """Half of a step, degrees; half a turn if it is more than a turn, as nothing is bent after whole turns."""
    return max(min(0.5 * step, 180.0), -180.0)
