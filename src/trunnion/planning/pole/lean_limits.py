"""How far rotary axes may turn if the tool axis may lean by an angle, and paths with limited steps within that.

With the first rotary axis at an angle, the second one turns the tool axis along a circle about its own direction w2, at
the angle B from it (names as in ``trunnion.machines.inverse``). So the tool axis can come within e of a target u if

    B - e <= angle(w2, u) <= B + e,

which, with d the angle from w2 to u about w1, is a condition on cos d alone:

    cos(B + e) <= cos G cos A + sin G sin A cos d <= cos(B - e).

Its solutions are an interval for either branch. With e they grow, meet, and at last are the whole turn: then the target
is no farther than e from the pole. On its circle the tool axis is nearest to u where cosine and sine of the second
angle are in the ratio of the components of u across w2; the second angles within e are an interval about that one.

Angles are in degrees outside of kernels; inside they are in radians where their names say so.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.machines import KinematicParameters, Machine

#: Halvings by which the least lean is found.
_HALVINGS: Final = 14

#: More than the rounding of angles here, rad.
_NOISE: Final = 1e-11


class StepLimits(NamedTuple):
    """What the positions of one rotary axis must keep in n rows; degrees.

    target     (n,) float64  the values to be near to, as they wind
    max_step   (n,) float64  the most by which a value may differ from that of the row before
    fixed      (n,) bool     rows that keep their target
    low, high                limits of the axis
    """

    target: Floats
    max_step: Floats
    fixed: Flags
    low: float
    high: float


def degrees_off_pole(kinematics: KinematicParameters, axis: Floats) -> Floats:
    """(n,) float64: angles between tool axes (n, 3) and the line of the first rotary axis, degrees."""
    frame = np.array(kinematics.basis_1).reshape(3, 3)
    across, along = np.linalg.norm(axis @ frame[:2].T, axis=1), np.abs(axis @ frame[2])
    return np.asarray(np.degrees(np.arctan2(across, along)))


def closest_second_angles(
    machine: Machine, kinematics: KinematicParameters, axis: Floats, first: Floats, near: Floats
) -> Floats:
    """(n,) float64: second angles within limits that bring the tool axis nearest to ``axis`` (n, 3), degrees.

    ``first`` (n,) are the first angles; the second ones are in the turns of ``near`` (n,).
    """
    bounds = machine.axes[machine.rotary[1]]
    target, slack = np.empty(len(axis)), np.empty(len(axis))
    _second_angle_ranges(kinematics, axis, first, near, 0.0, target, slack)
    return np.clip(target, bounds.low, bounds.high)


def least_lean(
    kinematics: KinematicParameters, axis: Floats, limits: StepLimits, angle: float
) -> tuple[Floats | None, float]:
    """First angles with limited steps under which the tool axis leans least.

    axis    (n, 3) float64: tool axes of the CAM
    limits  its targets are the first angles under which nothing leans
    angle   the most that the tool axis may lean, degrees

    first, lean  (n,) float64, degrees, and the most that the tool axis leans, degrees; None and NaN if there are none
    """
    path = np.empty((5, len(axis)))
    least = _least_lean(kinematics, axis, limits, math.radians(angle), *_fixed_angles(kinematics), path)
    return (None, math.nan) if math.isnan(least) else (path[0], math.degrees(least))


def second_angles_within(
    kinematics: KinematicParameters, axis: Floats, first: Floats, limits: StepLimits, angle: float
) -> Floats | None:
    """Second angles (n,) with limited steps for given first ones; None if there are none. As ``least_lean``."""
    target, slack = np.empty(len(axis)), np.empty(len(axis))
    _second_angle_ranges(kinematics, axis, first, limits.target, math.radians(angle), target, slack)
    target, slack = np.where(limits.fixed, limits.target, target), np.where(limits.fixed, 0.0, slack)
    lower, upper = np.maximum(target - slack, limits.low), np.minimum(target + slack, limits.high)
    path = np.empty((3, len(axis)))
    nearest = np.clip(target, limits.low, limits.high)
    return path[0] if _limit_steps(nearest, lower, upper, limits.max_step, path) else None


def _fixed_angles(kinematics: KinematicParameters) -> tuple[float, float]:
    """Angles G between both rotary axes and B between the second one and the spindle, rad."""
    less = math.atan2(kinematics.half_difference[1], kinematics.half_difference[0])
    more = math.atan2(kinematics.half_sum[1], kinematics.half_sum[0])
    return more + less, more - less


@kernel(writes="path")
def _least_lean(
    kinematics: KinematicParameters,
    axis: Floats2,
    limits: StepLimits,
    angle: float,
    g: float,
    b: float,
    path: Floats2,
) -> float:
    """Write the first angles into ``path[0]``; return the least lean, rad, or NaN. Other rows are for the work."""
    lower, upper = path[3], path[4]
    _first_angle_ranges(kinematics, axis, limits, angle, g, b, lower, upper)
    if not _path_with_steps(limits.target, lower, upper, limits.max_step, path):
        return math.nan
    low, high = 0.0, angle
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        _first_angle_ranges(kinematics, axis, limits, middle, g, b, lower, upper)
        if _path_with_steps(limits.target, lower, upper, limits.max_step, path):
            high = middle
        else:
            low = middle
    _first_angle_ranges(kinematics, axis, limits, high, g, b, lower, upper)
    _path_with_steps(limits.target, lower, upper, limits.max_step, path)
    return high


@inner
def _first_angle_ranges(
    kinematics: KinematicParameters,
    axis: Floats2,
    limits: StepLimits,
    angle: float,
    g: float,
    b: float,
    lower: Floats,
    upper: Floats,
) -> None:
    """Write the least and the greatest first angle of every row for a lean of at most ``angle``, rad."""
    target, fixed = limits.target, limits.fixed
    one = kinematics.basis_1
    cos_g, sin_g = math.cos(g), math.sin(g)
    angle = max(angle - _NOISE, 0.0)
    for row in range(axis.shape[0]):
        lower[row] = upper[row] = target[row]
        if fixed[row]:
            continue
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        u0 = one[0] * i + one[1] * j + one[2] * k
        u1 = one[3] * i + one[4] * j + one[5] * k
        u2 = one[6] * i + one[7] * j + one[8] * k
        across = math.sqrt(u0 * u0 + u1 * u1)
        length = math.sqrt(across * across + u2 * u2)
        least, most = 0.0, math.pi
        size = sin_g * across / length
        if size > 1e-15:
            rest = cos_g * u2 / length
            if b - angle > 0.0:
                high = (math.cos(b - angle) - rest) / size
                least = 0.0 if high >= 1.0 else math.acos(max(high, -1.0))
            if b + angle < math.pi:
                low = (math.cos(b + angle) - rest) / size
                most = math.pi if low <= -1.0 else math.acos(min(low, 1.0))
        before, after = _allowed_turns(kinematics, target[row], u0, u1, least, most)
        lower[row] = max(target[row] - before, limits.low)
        upper[row] = min(target[row] + after, limits.high)


@inner
def _allowed_turns(
    kinematics: KinematicParameters, target: float, u0: float, u1: float, least: float, most: float
) -> tuple[float, float]:
    """How far the first angle may be below and above its target, degrees, if |d| is from least to most, rad."""
    if least <= 0.0 and most >= math.pi:
        return math.inf, math.inf
    d = math.atan2(u1, u0) - kinematics.sense_1 * math.radians(target)
    d -= 2.0 * math.pi * math.floor(d / (2.0 * math.pi) + 0.5)
    begin, end = least, most
    if least <= 0.0:
        begin = -most
    elif most >= math.pi:
        end = 2.0 * math.pi - least
        if d < 0.0:
            d += 2.0 * math.pi
    elif d < 0.0:
        begin, end = -most, -least
    below, above = max(math.degrees(d - begin), 0.0), max(math.degrees(end - d), 0.0)
    if kinematics.sense_1 > 0.0:
        return above, below  # d shrinks as the first angle grows
    return below, above


@kernel(writes="target slack")
def _second_angle_ranges(
    kinematics: KinematicParameters,
    axis: Floats2,
    first: Floats,
    near: Floats,
    angle: float,
    target: Floats,
    slack: Floats,
) -> None:
    """Write the second angle with the least lean, and how far it may be from there for a lean of ``angle``, rad."""
    one, two, spindle = kinematics.basis_1, kinematics.basis_2, kinematics.spindle
    angle = max(angle - _NOISE, 0.0)
    for row in range(axis.shape[0]):
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        length = math.sqrt(i * i + j * j + k * k)
        turn = kinematics.sense_1 * math.radians(first[row])
        cos, sin = math.cos(turn), math.sin(turn)
        a = (one[0] * i + one[1] * j + one[2] * k) / length
        b = (one[3] * i + one[4] * j + one[5] * k) / length
        c = (one[6] * i + one[7] * j + one[8] * k) / length
        a, b = cos * a + sin * b, cos * b - sin * a
        x = one[0] * a + one[3] * b + one[6] * c
        y = one[1] * a + one[4] * b + one[7] * c
        z = one[2] * a + one[5] * b + one[8] * c
        p = two[0] * x + two[1] * y + two[2] * z
        q = two[3] * x + two[4] * y + two[5] * z
        r = two[6] * x + two[7] * y + two[8] * z
        cos, sin = p * spindle[0] + q * spindle[1], q * spindle[0] - p * spindle[1]
        size = math.sqrt(cos * cos + sin * sin)
        target[row], slack[row] = near[row], 180.0
        if size < 1e-12:  # the target is along the second rotary axis: all of its angles are alike
            continue
        best = math.degrees(math.atan2(sin, cos))
        target[row] = best + 360.0 * math.floor((near[row] - best) / 360.0 + 0.5)
        share = (math.cos(angle) - r * spindle[2]) / size
        slack[row] = math.degrees(math.acos(min(max(share, -1.0), 1.0)))


@kernel(writes="path")
def _limit_steps(target: Floats, lower: Floats, upper: Floats, max_step: Floats, path: Floats2) -> bool:
    """Call ``_path_with_steps``."""
    return _path_with_steps(target, lower, upper, max_step, path)


@inner
def _path_with_steps(target: Floats, lower: Floats, upper: Floats, max_step: Floats, path: Floats2) -> bool:
    """Write into ``path[0]`` values within bounds, each as near to its target as the steps allow.

    A value differs from that of the row before by no more than ``max_step``. ``path[1]`` and ``path[2]`` become the
    least and the greatest values with which the rest is possible. Returns False if there is no path.
    """
    values, low, high = path[0], path[1], path[2]
    last = len(target) - 1
    for row in range(last, -1, -1):
        low[row], high[row] = lower[row], upper[row]
        if row < last:
            low[row] = max(low[row], low[row + 1] - max_step[row + 1])
            high[row] = min(high[row], high[row + 1] + max_step[row + 1])
        if low[row] > high[row]:
            return False
    values[0] = min(max(target[0], low[0]), high[0])
    for row in range(1, last + 1):
        least, most = max(low[row], values[row - 1] - max_step[row]), min(high[row], values[row - 1] + max_step[row])
        values[row] = min(max(target[row], least), most)
    return True
