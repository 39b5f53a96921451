"""Kernels for unit vectors on great circles."""

import math

from trunnion.arrays import Floats
from trunnion.jit import inner


@inner
def angle_between(a: Floats, i: int, b: Floats, j: int) -> float:
    """Angle between the unit vectors ``a[i]`` and ``b[j]``, rad, exact for small angles and for opposite vectors."""
    less, more = 0.0, 0.0
    for k in range(3):
        less += (a[i, k] - b[j, k]) ** 2
        more += (a[i, k] + b[j, k]) ** 2
    return 2.0 * math.atan2(math.sqrt(less), math.sqrt(more))


@inner
def slerp_weights(angle: float, fraction: float) -> tuple[float, float]:
    """Weights of both ends for the vector at a fraction of a great circle of ``angle`` radians."""
    sine = math.sin(angle)
    if sine < 1e-9:
        return 1.0 - fraction, fraction
    return math.sin((1.0 - fraction) * angle) / sine, math.sin(fraction * angle) / sine
