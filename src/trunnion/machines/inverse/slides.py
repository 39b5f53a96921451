"""Kernels for the three slides, with the rotary angles known: a 3x3 linear system."""

import math
from typing import Final

from trunnion.arrays import Floats
from trunnion.jit import inlined, inner
from trunnion.machines.inverse.parameters import MIN_SLIDE_VOLUME, FlatArray, KinematicParameters

#: Status bit of kernels, beside those of ``trunnion.machines.inverse.rotary``.
SLIDES_DEPENDENT: Final = 4


@inlined
def solve_slides(
    kinematics: KinematicParameters, first: float, second: float, x: float, y: float, z: float, out: Floats
) -> int:
    """Write a whole row: the rotary values as given, and the slides that bring the tip to x, y, z.

    first, second  displayed rotary values, deg; they may be wound up, and whole turns drop out without loss
    out            (5,) float64, written, mm and deg
    returns        0 or SLIDES_DEPENDENT
    """
    angle = kinematics.sense_1 * math.radians(first - 360.0 * math.floor(first / 360.0 + 0.5))
    cos_1, sin_1 = math.cos(angle), math.sin(angle)
    angle = math.radians(second - 360.0 * math.floor(second / 360.0 + 0.5))
    cos_2, sin_2 = math.cos(angle), math.sin(angle)
    out[kinematics.columns[0]] = first
    out[kinematics.columns[1]] = second
    return solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z, out)


@inner
def solve_slides_cos_sin(
    kinematics: KinematicParameters,
    cos_1: float,
    sin_1: float,
    cos_2: float,
    sin_2: float,
    x: float,
    y: float,
    z: float,
    out: Floats,
) -> int:
    """Write the slides of a row that bring the tip to x, y, z.

    cos_1 ... sin_2  of the rotary angles about the third rows of ``basis_1`` and ``basis_2``
    out              (5,) float64, the columns of the slides are written, mm
    returns          0 or SLIDES_DEPENDENT
    """
    x, y, z = x - kinematics.first_point[0], y - kinematics.first_point[1], z - kinematics.first_point[2]
    below = kinematics.rotary_below
    status = 0
    if below[0] == below[1] and below[1] == below[2] and not math.isnan(kinematics.slides_inverse[0]):
        a, b, c = _slides_together(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z)
    else:
        status, a, b, c = _slides_apart(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z)
    # Adding zero turns -0.0 into 0.0.
    out[kinematics.columns[2]] = a + 0.0
    out[kinematics.columns[3]] = b + 0.0
    out[kinematics.columns[4]] = c + 0.0
    return status


# Inlined like the next one: a call would copy the parameters, a fifth of the time of a solution.
@inlined
def _slides_together(
    kinematics: KinematicParameters,
    cos_1: float,
    sin_1: float,
    cos_2: float,
    sin_2: float,
    x: float,
    y: float,
    z: float,
) -> tuple[float, float, float]:
    """Slides with no rotary axis between them, for a tip x, y, z from the point of the first rotary axis.

    The slides keep their directions to each other. As seen from them, what is on the side of the workpiece turns back,
    and what is on the side of the tool turns.
    """
    one, two = kinematics.basis_1, kinematics.basis_2
    offset, below = kinematics.second_offset, kinematics.rotary_below[0]
    if below >= 1:
        x, y, z = rotate_about(one, cos_1, -sin_1, x, y, z)
        x, y, z = x - offset[0], y - offset[1], z - offset[2]
    rx, ry, rz = kinematics.tool_offset[0], kinematics.tool_offset[1], kinematics.tool_offset[2]
    if below == 2:
        x, y, z = rotate_about(two, cos_2, -sin_2, x, y, z)
    else:
        rx, ry, rz = rotate_about(two, cos_2, sin_2, rx, ry, rz)
    if below == 0:
        rx, ry, rz = rotate_about(one, cos_1, sin_1, rx + offset[0], ry + offset[1], rz + offset[2])
    px, py, pz = x - rx, y - ry, z - rz
    inverse = kinematics.slides_inverse
    return (
        inverse[0] * px + inverse[1] * py + inverse[2] * pz,
        inverse[3] * px + inverse[4] * py + inverse[5] * pz,
        inverse[6] * px + inverse[7] * py + inverse[8] * pz,
    )


@inlined
def _slides_apart(
    kinematics: KinematicParameters,
    cos_1: float,
    sin_1: float,
    cos_2: float,
    sin_2: float,
    x: float,
    y: float,
    z: float,
) -> tuple[int, float, float, float]:
    """Status and slides for any order of axes, for a tip x, y, z from the point of the first rotary axis."""
    one, two = kinematics.basis_1, kinematics.basis_2
    tool, offset = kinematics.tool_offset, kinematics.second_offset
    # Where the tip would be with the slides at zero, and how far the slides must move it from there.
    px, py, pz = rotate_about(two, cos_2, sin_2, tool[0], tool[1], tool[2])
    px, py, pz = rotate_about(one, cos_1, sin_1, px + offset[0], py + offset[1], pz + offset[2])
    px, py, pz = x - px, y - py, z - pz
    ax, ay, az = _slide_direction(kinematics, 0, cos_1, sin_1, cos_2, sin_2)
    bx, by, bz = _slide_direction(kinematics, 1, cos_1, sin_1, cos_2, sin_2)
    cx, cy, cz = _slide_direction(kinematics, 2, cos_1, sin_1, cos_2, sin_2)
    # Cramer's rule, by the reciprocal basis of the three slide directions.
    rx, ry, rz = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
    volume = ax * rx + ay * ry + az * rz
    if abs(volume) < MIN_SLIDE_VOLUME:
        return SLIDES_DEPENDENT, math.nan, math.nan, math.nan
    first = (px * rx + py * ry + pz * rz) / volume
    rx, ry, rz = cy * az - cz * ay, cz * ax - cx * az, cx * ay - cy * ax
    second = (px * rx + py * ry + pz * rz) / volume
    rx, ry, rz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    return 0, first, second, (px * rx + py * ry + pz * rz) / volume


@inner
def _slide_direction(
    kinematics: KinematicParameters, slide: int, cos_1: float, sin_1: float, cos_2: float, sin_2: float
) -> tuple[float, float, float]:
    """Direction of a slide as seen from the workpiece, with the rotary axes at these angles."""
    x, y, z = kinematics.slides[3 * slide], kinematics.slides[3 * slide + 1], kinematics.slides[3 * slide + 2]
    if kinematics.rotary_below[slide] == 2:
        x, y, z = rotate_about(kinematics.basis_2, cos_2, sin_2, x, y, z)
    if kinematics.rotary_below[slide] >= 1:
        x, y, z = rotate_about(kinematics.basis_1, cos_1, sin_1, x, y, z)
    return x, y, z


@inner
def rotate_about(basis: FlatArray, cos: float, sin: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector turned about the third row of ``basis``, an orthonormal 3x3 flattened by rows."""
    a = basis[0] * x + basis[1] * y + basis[2] * z
    b = basis[3] * x + basis[4] * y + basis[5] * z
    c = basis[6] * x + basis[7] * y + basis[8] * z
    a, b = cos * a - sin * b, sin * a + cos * b
    return (
        basis[0] * a + basis[3] * b + basis[6] * c,
        basis[1] * a + basis[4] * b + basis[7] * c,
        basis[2] * a + basis[5] * b + basis[8] * c,
    )
