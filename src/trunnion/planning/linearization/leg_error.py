"""How far a control leads the tool off a leg, the path from one CL point to the next.

On a leg the CAM moves the tip along a straight line and turns the tool axis along a great circle, both in step. A
control moves its axes evenly instead. With TCP it keeps the tip on the line, and only the tool axis bends; without TCP
the tip leaves the line as well.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner
from trunnion.machines import KinematicParameters
from trunnion.machines.forward import KinematicChain, forward_row
from trunnion.machines.inverse import POLE, Pair, branch_angles, solve_slides, solve_tilt

#: Where a span is sampled first: closer together towards its ends, as the tip may go back along its line there. Below
#: ``_SURELY_LARGEST`` that is enough: between the samples the error is at most two thirds larger.
_COARSE_SHARES: Final = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 6) / 6.0)
_SURELY_LARGEST: Final = 0.6

#: Where it is sampled again: if it turns little, so that its error is nearly a cubic curve; and if it turns more, as a
#: pole nearby bends it most.
_CUBIC_SHARES: Final = np.array([0.03, 0.125, 0.19, 0.375, 0.625, 0.81, 0.875, 0.97])
_DENSE_SHARES: Final = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 32) / 32.0)

#: A rotary axis that turns by less than this within a span turns little, degrees.
_SMALL_TURN: Final = 3.0

#: Below this sine of the angle between the second angles of both branches, the branches are one.
_SAME_BRANCH_SINE: Final = 1e-9


class Leg(NamedTuple):
    """The path from one CL point to the next.

    tips   (2, 3) float64  mm, workpiece frame
    axes   (2, 3) float64  tool axes, unit vectors, workpiece frame
    angle                  between the tool axes, rad
    """

    tips: Floats2
    axes: Floats2
    angle: float


@inner
def branch_of(kinematics: KinematicParameters, second: float) -> int:
    """Return the branch with this second angle, degrees; -1 where both branches are one."""
    angle = math.radians(second)
    sine = math.sin(angle) * kinematics.phase[0] + math.cos(angle) * kinematics.phase[1]
    return -1 if abs(sine) < _SAME_BRANCH_SINE else 0 if sine > 0.0 else 1


@inner
def axis_values(kinematics: KinematicParameters, tip: Floats, rotary: Floats, out: Floats) -> None:
    """Write all five axis values for a tip (3,) and rotary positions (2,), degrees."""
    solve_slides(kinematics, rotary[0], rotary[1], tip[0], tip[1], tip[2], out)
    out[kinematics.columns[0]], out[kinematics.columns[1]] = rotary[0], rotary[1]


@inner
def axis_values_on_leg(
    kinematics: KinematicParameters,
    leg: Leg,
    part: float,
    branch: int,
    before: Floats,
    goal: Floats,
    out: Floats,
    axis: Floats,
) -> None:
    """Write all five axis values at a ``part`` of a leg, in a branch, or for -1 in the one nearest to ``before``.

    Where the first axis turns by about half a turn, as it does across the pole, it turns to the side of ``goal``.
    """
    one_column, two_column = kinematics.columns[0], kinematics.columns[1]
    axis_on_leg(leg, part, axis)
    status, u0, u1, cos, sin = solve_tilt(kinematics, axis[0], axis[1], axis[2])
    best = math.inf
    first, second = before[one_column], before[two_column]
    for candidate in range(2):
        if candidate != branch and branch >= 0:
            continue
        found = branch_angles(kinematics, u0, u1, cos, sin if candidate == 0 else -sin, status)
        one = before[one_column] if status & POLE else nearest_turn(found[0], before[one_column])
        if abs(one - before[one_column]) > 90.0:
            one = nearest_turn(found[0], goal[one_column])
        two = nearest_turn(found[1], before[two_column])
        travel = abs(one - before[one_column]) + abs(two - before[two_column])
        if travel < best:
            best, first, second = travel, one, two
    tips = leg.tips
    x = tips[0, 0] + part * (tips[1, 0] - tips[0, 0])
    y = tips[0, 1] + part * (tips[1, 1] - tips[0, 1])
    z = tips[0, 2] + part * (tips[1, 2] - tips[0, 2])
    solve_slides(kinematics, first, second, x, y, z, out)
    out[one_column], out[two_column] = first, second


@inner
def nearest_turn(angle: float, near: float) -> float:
    """Return an angle with the whole turns that bring it nearest to another one, degrees."""
    turned: float = angle + 360.0 * math.floor((near - angle) / 360.0 + 0.5)
    return turned


@inner
def angle_between(a: Floats, b: Floats) -> float:
    """Angle between unit vectors, rad; accurate for small angles, too."""
    less = math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    more = math.sqrt((a[0] + b[0]) ** 2 + (a[1] + b[1]) ** 2 + (a[2] + b[2]) ** 2)
    return 2.0 * math.atan2(less, more)


@inner
def axis_on_leg(leg: Leg, part: float, out: Floats) -> None:
    """Write the tool axis at a ``part`` of a leg: spherical linear interpolation."""
    axes, angle = leg.axes, leg.angle
    sine = math.sin(angle)
    if sine < 1e-9:
        first, second = 1.0 - part, part
    else:
        first, second = math.sin((1.0 - part) * angle) / sine, math.sin(part * angle) / sine
    total = 0.0
    for k in range(3):
        out[k] = first * axes[0, k] + second * axes[1, k]
        total += out[k] * out[k]
    total = math.sqrt(total)
    for k in range(3):
        out[k] /= total


@inner
def is_surely_within(
    chain: KinematicChain, kinematics: KinematicParameters, tolerances: Pair, begin: Floats, end: Floats
) -> bool:
    """Whether the axes turn so little that no error can exceed the tolerances, as in most legs of a dense path.

    A curve with a second derivative of at most s is off its chord by at most s/8. For the tip, s is the square of the
    total turn times the distance from the rotary axes, plus twice the turn times the travel of the slides. For the tool
    axis it is the square alone, and the great circle may be as far off the chord on the other side.
    """
    one_column, two_column = kinematics.columns[0], kinematics.columns[1]
    turn, travel, distance = 0.0, 0.0, 0.0
    for k in range(5):
        moved = abs(end[k] - begin[k])
        if k in (one_column, two_column):
            turn += math.radians(moved)
        else:
            travel += moved
            distance += max(abs(begin[k]), abs(end[k]))
    if not 0.25 * turn * turn <= tolerances[1]:
        return False
    if tolerances[0] == math.inf:
        return True
    for k in range(3):
        one, two = chain.point[one_column, k], chain.point[two_column, k]
        distance += abs(chain.tip_at_zero[k] - one) + abs(chain.tip_at_zero[k] - two) + 2.0 * abs(one - two)
    within: bool = 0.125 * (turn * turn * distance + 2.0 * turn * travel) <= tolerances[0]
    return within


@inner
def span_error(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    tolerances: Pair,
    leg: Leg,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    work: Floats2,
) -> float:
    """Error of a span between two axis positions, as a share of the tolerances, from as many samples as needed.

    begin, end     (5,) axis values, mm and degrees
    first, last    the parts of the leg at which they are
    work           (4, 5) for the work
    """
    one, two = kinematics.columns[0], kinematics.columns[1]
    turns_little = abs(end[one] - begin[one]) < _SMALL_TURN and abs(end[two] - begin[two]) < _SMALL_TURN
    worst = sampled_error(chain, tolerances, leg, begin, end, first, last, _COARSE_SHARES, work)
    if worst > 1.0 or (turns_little and worst < _SURELY_LARGEST):
        return worst
    shares = _CUBIC_SHARES if turns_little else _DENSE_SHARES
    return max(worst, sampled_error(chain, tolerances, leg, begin, end, first, last, shares, work))


@inner
def in_place_error(
    chain: KinematicChain, tolerances: Pair, leg: Leg, begin: Floats, end: Floats, part: float, work: Floats2
) -> float:
    """Error of a turn at one place of a leg, as a share of the tolerances."""
    return sampled_error(chain, tolerances, leg, begin, end, part, part, _COARSE_SHARES, work)


@inner
def sampled_error(
    chain: KinematicChain,
    tolerances: Pair,
    leg: Leg,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    shares: Floats,
    work: Floats2,
) -> float:
    """Largest error at some ``shares`` of a span. Parameters as for ``span_error``.

    The tip is compared with its line, the tool axis with that of the great circle at the same share of the span.
    """
    joints, tip, axis, expected = work[0], work[1], work[2], work[3]
    tips = leg.tips
    length_squared = 0.0
    for k in range(3):
        length_squared += (tips[1, k] - tips[0, k]) ** 2
    worst = 0.0
    for share in shares:
        for k in range(5):
            joints[k] = begin[k] + share * (end[k] - begin[k])
        forward_row(chain, joints, tip, axis)
        part = first + share * (last - first)
        if tolerances[0] < math.inf:
            along, off = 0.0, 0.0
            for k in range(3):
                along += (tip[k] - tips[0, k]) * (tips[1, k] - tips[0, k])
            along = min(max(along / length_squared, first), last) if length_squared > 1e-12 else part
            for k in range(3):
                off += (tip[k] - tips[0, k] - along * (tips[1, k] - tips[0, k])) ** 2
            worst = max(worst, math.sqrt(off) / tolerances[0])
        axis_on_leg(leg, part, expected)
        worst = max(worst, angle_between(axis, expected) / tolerances[1])
    return worst
