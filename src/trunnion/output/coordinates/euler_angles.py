"""The orientation of a tilted plane as three rotations, each about an axis that has already turned."""

import math

from trunnion.arrays import Floats


def tait_bryan_angles(matrix: Floats, order: tuple[int, int, int]) -> tuple[float, float, float]:
    """Return the angles of three rotations about three different axes that turn the program's axes into a plane's.

    matrix  (3, 3) float64: X, Y and Z of the plane as columns
    order   the axes of the rotations, 0 for X

    a, b, c  degrees
    """
    i, j, k = order
    s = 1.0 if (j - i) % 3 == 1 else -1.0
    cos_b = math.hypot(matrix[i, i], matrix[i, j])
    b = math.atan2(s * matrix[i, k], cos_b)
    if cos_b < 1e-9:
        a, c = math.atan2(s * matrix[k, j], matrix[j, j]), 0.0
    else:
        a, c = math.atan2(-s * matrix[j, k], matrix[k, k]), math.atan2(-s * matrix[i, j], matrix[i, i])
    return math.degrees(a), math.degrees(b), math.degrees(c)


def euler_zxz_angles(matrix: Floats) -> tuple[float, float, float]:
    """Return the angles of rotations about Z, the X that has turned with it, and the Z that has turned with both.

    matrix  (3, 3) float64: X, Y and Z of the plane as columns

    a, b, c  degrees
    """
    sin_b = math.hypot(matrix[0, 2], matrix[1, 2])
    b = math.atan2(sin_b, matrix[2, 2])
    if sin_b < 1e-9:
        a, c = math.atan2(matrix[1, 0], matrix[0, 0]), 0.0
    else:
        a, c = math.atan2(matrix[0, 2], -matrix[1, 2]), math.atan2(matrix[2, 0], matrix[2, 1])
    return math.degrees(a), math.degrees(b), math.degrees(c)
