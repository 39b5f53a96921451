"""How far the rotary axes may turn when the tool axis may lean by an angle, and ways with limited speed within that.

With the first rotary axis at an angle, the second one takes the tool axis round a circle about its own direction w2, B
away from it (``trunnion.machines.inverse`` has the names). So the tool axis can come within e of a wanted one u if

    B - e <= angle(w2, u) <= B + e,

which, with d the angle from w2 to u about w1, is a condition on cos d alone:

    cos(B + e) <= cos G cos A + sin G sin A cos d <= cos(B - e).

Its solutions are an interval for either branch, which grow with e, meet, and at last are the whole turn: the wanted
axis is no farther from the pole than e then. On its circle the tool axis comes nearest to u where the second angle's
cosine and sine stand as the components of u across w2, and the second angles within e are an interval about that.

Angles in degrees outside of kernels, in radians within where their names say so.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.machines import KinematicParameters, Machine

#: Halvings by which the least angle is found.
_HALVINGS: Final = 14

#: No less than the rounding of angles here, rad.
_NOISE: Final = 1e-11


def degrees_off_pole(kinematics: KinematicParameters, axis: Floats) -> Floats:
    """(n,): degrees between tool axes (n, 3) and the first rotary axis, whichever way along it."""
    frame = np.array(kinematics.basis_1).reshape(3, 3)
    across, along = np.linalg.norm(axis @ frame[:2].T, axis=1), np.abs(axis @ frame[2])
    return np.asarray(np.degrees(np.arctan2(across, along)))


def closest_second_angles(
    machine: Machine, kinematics: KinematicParameters, axis: Floats, first: Floats, near: Floats
) -> Floats:
    """(n,): second angles, degrees, that bring the tool axis nearest to ``axis`` (n, 3), within the limits.

    ``first`` (n,) are the first angles, ``near`` (n,) angles of whose turn the second ones are.
    """
    bounds = machine.axes[machine.rotary[1]]
    target, slack = np.empty(len(axis)), np.empty(len(axis))
    _second_angle_ranges(kinematics, axis, first, near, 0.0, target, slack)
    return np.clip(target, bounds.low, bounds.high)


def least_lean(
    kinematics: KinematicParameters,
    axis: Floats,
    wanted: Floats,
    max_step: Floats,
    fixed: Flags,
    bounds: tuple[float, float],
    angle: float,
) -> tuple[Floats | None, float]:
    """First angles (n,) that change by no more than ``max_step`` (n,) from row to row, with the least lean of the tool
    axis.

    Parameters
    ----------
    axis : (n, 3) float64
        Wanted tool axes.
    wanted : (n,) float64
        First angles under which the tool axis does not lean, as they wind.
    steady : (n,) bool
        Rows whose angle stays as wanted.
    bounds
        Limits of the axis.
    angle
        The most that the tool axis may lean.

    Returns
    -------
    The angles and what the lean is at most, degrees; None and NaN where there is no way.
    """
    g, b = _between(kinematics)
    path = np.empty((5, len(axis)))
    least = _least_lean(kinematics, axis, wanted, max_step, fixed, bounds, math.radians(angle), g, b, path)
    return (None, math.nan) if math.isnan(least) else (path[0], math.degrees(least))


def second_angles_within(
    kinematics: KinematicParameters,
    axis: Floats,
    first: Floats,
    wanted: Floats,
    max_step: Floats,
    fixed: Flags,
    bounds: tuple[float, float],
    angle: float,
) -> Floats | None:
    """Second angles (n,) to given first ones, with the same meaning as ``least_lean``; None where there is no way."""
    target, slack = np.empty(len(axis)), np.empty(len(axis))
    _second_angle_ranges(kinematics, axis, first, wanted, math.radians(angle), target, slack)
    target, slack = np.where(fixed, wanted, target), np.where(fixed, 0.0, slack)
    path = np.empty((3, len(axis)))
    lower, upper = np.maximum(target - slack, bounds[0]), np.minimum(target + slack, bounds[1])
    return path[0] if _limit_rate(np.clip(target, *bounds), lower, upper, max_step, *path) else None


def _between(kinematics: KinematicParameters) -> tuple[float, float]:
    """Angles G between both rotary axes and B between the second one and the spindle, rad."""
    less = math.atan2(kinematics.half_difference[1], kinematics.half_difference[0])
    more = math.atan2(kinematics.half_sum[1], kinematics.half_sum[0])
    return more + less, more - less


@kernel(writes="path")
def _least_lean(
    kinematics: KinematicParameters,
    axis: Floats2,
    wanted: Floats,
    max_step: Floats,
    fixed: Flags,
    bounds: tuple[float, float],
    angle: float,
    g: float,
    b: float,
    path: Floats2,
) -> float:
    """Write the way into ``path[0]``; return the least lean, rad, or NaN. The other rows are for the work."""
    lower, upper = path[3], path[4]
    _first_angle_ranges(kinematics, axis, wanted, fixed, bounds, angle, g, b, lower, upper)
    if not _limited_rate_path(wanted, lower, upper, max_step, path[0], path[1], path[2]):
        return math.nan
    low, high = 0.0, angle
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        _first_angle_ranges(kinematics, axis, wanted, fixed, bounds, middle, g, b, lower, upper)
        if _limited_rate_path(wanted, lower, upper, max_step, path[0], path[1], path[2]):
            high = middle
        else:
            low = middle
    _first_angle_ranges(kinematics, axis, wanted, fixed, bounds, high, g, b, lower, upper)
    _limited_rate_path(wanted, lower, upper, max_step, path[0], path[1], path[2])
    return high


@inner
def _first_angle_ranges(
    kinematics: KinematicParameters,
    axis: Floats,
    wanted: Floats,
    fixed: Flags,
    bounds: tuple[float, float],
    angle: float,
    g: float,
    b: float,
    lower: Floats,
    upper: Floats,
) -> None:
    """Write least and greatest first angle of every row with which the tool axis leans by no more than ``angle``."""
    one = kinematics.basis_1
    cos_g, sin_g = math.cos(g), math.sin(g)
    angle = max(angle - _NOISE, 0.0)
    for row in range(axis.shape[0]):
        lower[row] = upper[row] = wanted[row]
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
        before, after = _allowed_turns(kinematics, wanted[row], u0, u1, least, most)
        lower[row] = max(wanted[row] - before, bounds[0])
        upper[row] = min(wanted[row] + after, bounds[1])


@inner
def _allowed_turns(
    kinematics: KinematicParameters, wanted: float, u0: float, u1: float, least: float, most: float
) -> tuple[float, float]:
    """How far the first angle may go below and above ``wanted``, degrees, if d has a size of least to most, rad."""
    if least <= 0.0 and most >= math.pi:
        return math.inf, math.inf
    d = math.atan2(u1, u0) - kinematics.sense_1 * math.radians(wanted)
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
        if size < 1e-12:  # the wanted tool axis stands along the second rotary axis: all of its angles are alike
            continue
        best = math.degrees(math.atan2(sin, cos))
        target[row] = best + 360.0 * math.floor((near[row] - best) / 360.0 + 0.5)
        share = (math.cos(angle) - r * spindle[2]) / size
        slack[row] = math.degrees(math.acos(min(max(share, -1.0), 1.0)))


@kernel(writes="path low high")
def _limit_rate(
    wanted: Floats, lower: Floats, upper: Floats, max_step: Floats, path: Floats, low: Floats, high: Floats
) -> bool:
    """Call ``_limited_rate_path``."""
    return _limited_rate_path(wanted, lower, upper, max_step, path, low, high)


@inner
def _limited_rate_path(
    wanted: Floats, lower: Floats, upper: Floats, max_step: Floats, path: Floats, low: Floats, high: Floats
) -> bool:
    """Write values within bounds that change by no more than ``max_step`` from row to row, each as near as it can be.

    ``low`` and ``high`` are what each row may be if the rest is to be possible. False where nothing is.
    """
    last = len(wanted) - 1
    for row in range(last, -1, -1):
        low[row], high[row] = lower[row], upper[row]
        if row < last:
            low[row] = max(low[row], low[row + 1] - max_step[row + 1])
            high[row] = min(high[row], high[row + 1] + max_step[row + 1])
        if low[row] > high[row]:
            return False
    path[0] = min(max(wanted[0], low[0]), high[0])
    for row in range(1, last + 1):
        least, most = max(low[row], path[row - 1] - max_step[row]), min(high[row], path[row - 1] + max_step[row])
        path[row] = min(max(wanted[row], least), most)
    return True
