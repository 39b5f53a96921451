"""Kernels for the angles of the two rotary axes; the formula is in ``trunnion.machines.inverse``."""

import math
from typing import Final

from trunnion.jit import inner
from trunnion.machines.inverse.parameters import REACH_TOLERANCE, KinematicParameters

#: Status bits of kernels.
UNREACHABLE: Final = 1
POLE: Final = 2

#: How near to the first rotary axis a tool axis counts as exactly parallel to it, rad.
POLE_TOLERANCE: Final = REACH_TOLERANCE


@inner
def solve_tilt(kinematics: KinematicParameters, i: float, j: float, k: float) -> tuple[int, float, float, float, float]:
    """Return what both branches of a tool axis share.

    i, j, k  the tool axis in workpiece coordinates, of any length
    returns  status bits, components of the tool axis along the first two rows of ``basis_1``, cosine and sine of phi,
             which is in [0, 180] degrees

    The sines of the formula follow from those of A/2 by addition, so that square roots are all it takes.
    """
    one = kinematics.basis_1
    u0 = one[0] * i + one[1] * j + one[2] * k
    u1 = one[3] * i + one[4] * j + one[5] * k
    u2 = one[6] * i + one[7] * j + one[8] * k
    across = math.sqrt(u0 * u0 + u1 * u1)
    length = math.sqrt(across * across + u2 * u2)
    if not 0.0 < length < math.inf:  # written so that NaN is out of reach as well
        return UNREACHABLE, math.nan, math.nan, math.nan, math.nan
    pole = across < kinematics.tolerance * length
    if pole:
        across, length = 0.0, abs(u2)
    if u2 >= 0.0:
        cos_a = math.sqrt(0.5 + 0.5 * u2 / length)
        sin_a = 0.5 * across / (length * cos_a)
    else:
        sin_a = math.sqrt(0.5 - 0.5 * u2 / length)
        cos_a = 0.5 * across / (length * sin_a)
    lean = sin_a * kinematics.half_difference[0] + cos_a * kinematics.half_difference[1]  # sin(S - B)
    between = sin_a * kinematics.half_difference[0] - cos_a * kinematics.half_difference[1]  # sin(S - G)
    half = sin_a * kinematics.half_sum[0] + cos_a * kinematics.half_sum[1]  # sin S
    off = cos_a * kinematics.half_sum[1] - sin_a * kinematics.half_sum[0]  # sin(S - A)
    if min(min(lean, between), min(half, off)) < -0.5 * kinematics.tolerance:
        return UNREACHABLE, math.nan, math.nan, math.nan, math.nan
    if kinematics.is_second == 0.0:  # the third corner of the triangle lies on w2: the tool turns about itself
        return POLE if pole else 0, u0, u1, 1.0, 0.0
    num, den = max(lean, 0.0) * max(between, 0.0), max(half, 0.0) * max(off, 0.0)
    return POLE if pole else 0, u0, u1, (den - num) / (den + num), 2.0 * math.sqrt(num * den) / (den + num)


@inner
def branch_angles(
    kinematics: KinematicParameters, u0: float, u1: float, cos: float, sin: float, status: int
) -> tuple[float, float, float, float, float, float]:
    """Return the rotary angles of one branch.

    u0, u1, cos, sin, status  as ``solve_tilt`` gives them; ``sin`` negated for branch 1
    returns                   first and second angle, deg, in (-180, 180], and cosine and sine of each about the third
                              row of its basis

    The second angle is phi - phase in branch 0 and -phi - phase in branch 1. If the tool axis at zero lies in the plane
    of the two rotary axes, phase is 0: branch 0 is the positive tilt, branch 1 the negative one. On fork heads that
    turn about X and then Y, phase is 90: branch 0 has the second angle in [-90, 90]. Along a path, each branch is
    continuous away from poles.
    """
    cos, sin = (
        cos * kinematics.phase[0] + sin * kinematics.phase[1],
        sin * kinematics.phase[0] - cos * kinematics.phase[1],
    )
    second = math.degrees(math.atan2(sin, cos))
    first, cos_1, sin_1 = 0.0, 1.0, 0.0
    if not status & POLE:
        # v = R2 s, then its components along the first two rows of basis_1.
        one, two = kinematics.basis_1, kinematics.basis_2
        s0, s1, s2 = kinematics.spindle[0], kinematics.spindle[1], kinematics.spindle[2]
        a, b = cos * s0 - sin * s1, sin * s0 + cos * s1
        v0 = two[0] * a + two[3] * b + two[6] * s2
        v1 = two[1] * a + two[4] * b + two[7] * s2
        v2 = two[2] * a + two[5] * b + two[8] * s2
        a = one[0] * v0 + one[1] * v1 + one[2] * v2
        b = one[3] * v0 + one[4] * v1 + one[5] * v2
        cos_1, sin_1 = u0 * a + u1 * b, u1 * a - u0 * b
        first = kinematics.sense_1 * math.degrees(math.atan2(sin_1, cos_1))
        length = math.sqrt(cos_1 * cos_1 + sin_1 * sin_1)
        cos_1, sin_1 = cos_1 / length, sin_1 / length
    if first <= -180.0:
        first = 180.0
    if second <= -180.0:
        second = 180.0
    return first + 0.0, second + 0.0, cos_1, sin_1, cos, sin  # adding zero turns -0.0 into 0.0
