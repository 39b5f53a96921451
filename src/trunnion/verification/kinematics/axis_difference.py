"""The difference of two tool axes, as an angle and in each rotary axis.

The difference is split along the two directions into which the rotary axes turn the tool where it stands. That tells
how far each rotary axis is off from the forward map alone, and leaves out an angle that does not matter: at a pole.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats
from trunnion.jit import inner
from trunnion.machines import Machine
from trunnion.records import dataclass

#: By how much forward and inverse map may differ, rad.
_NOISE: Final = 1e-11

#: What the seven decimals of CL files leave open at a pole and at the edge of what the rotary axes reach, rad.
_CL_ROUNDING: Final = 1.1e-7


@dataclass(frozen=True, slots=True, eq=False)
class RotaryGeometry:
    """The rotary axes of a machine, for kernels.

    column   column in ``joints`` of the first rotary axis, the one next to the workpiece
    sense    1 or -1: how its values turn it
    first    (3,) its direction, with all axes at zero
    second   (3,) direction of the other rotary axis
    """

    column: int
    sense: float
    first: Floats
    second: Floats

    @property
    def pair(self) -> "RotaryPair":
        """The axes, as kernels take them."""
        return RotaryPair(self.sense, self.first, self.second)

    @staticmethod
    def of(machine: Machine) -> "RotaryGeometry":
        """From a machine's definition."""
        first, second = machine.rotary
        one, two = machine.axes[first], machine.axes[second]
        return RotaryGeometry(first, one.sense, np.array(one.direction), np.array(two.direction))


class RotaryPair(NamedTuple):
    """``sense``, ``first`` and ``second`` of ``RotaryGeometry``, as kernels take them."""

    sense: float
    first: Floats
    second: Floats


@inner
def axis_difference(
    actual: Floats, i: int, expected: Floats, j: int, value: float, pair: RotaryPair
) -> tuple[float, float]:
    """Angle between tool axes ``actual[i]`` and ``expected[j]``, rad, and the larger error of both rotary axes, deg.

    ``value`` is the position of the first rotary axis under ``actual[i]``, degrees.
    """
    sense, first, second = pair
    w0, w1, w2 = first[0], first[1], first[2]
    v0, v1, v2 = second[0], second[1], second[2]
    a0, a1, a2 = actual[i, 0], actual[i, 1], actual[i, 2]
    e0, e1, e2 = a0 - expected[j, 0], a1 - expected[j, 1], a2 - expected[j, 2]
    chord = e0 * e0 + e1 * e1 + e2 * e2
    if not chord > _NOISE * _NOISE:
        return (math.sqrt(chord), 0.0) if chord == chord else (0.0, np.inf)
    # The angle of a small chord is the chord itself, to the eleventh digit.
    angle = math.sqrt(chord) if chord < 1e-10 else 2.0 * math.asin(min(0.5 * math.sqrt(chord), 1.0))
    if chord > 1e-4:  # no longer a small difference: the angle itself
        return angle, math.degrees(angle)
    # The second axis as turned by the first, and the directions in which both move the tool axis.
    q = math.radians(sense * value)
    cos, sin = math.cos(q), math.sin(q)
    rest = (w0 * v0 + w1 * v1 + w2 * v2) * (1.0 - cos)
    s0 = v0 * cos + (w1 * v2 - w2 * v1) * sin + w0 * rest
    s1 = v1 * cos + (w2 * v0 - w0 * v2) * sin + w1 * rest
    s2 = v2 * cos + (w0 * v1 - w1 * v0) * sin + w2 * rest
    p0, p1, p2 = w1 * a2 - w2 * a1, w2 * a0 - w0 * a2, w0 * a1 - w1 * a0
    r0, r1, r2 = s1 * a2 - s2 * a1, s2 * a0 - s0 * a2, s0 * a1 - s1 * a0
    pp = p0 * p0 + p1 * p1 + p2 * p2
    pr = p0 * r0 + p1 * r1 + p2 * r2
    rr = r0 * r0 + r1 * r1 + r2 * r2
    pe = p0 * e0 + p1 * e1 + p2 * e2
    re = r0 * e0 + r1 * e1 + r2 * e2
    volume = pp * rr - pr * pr
    if volume < 1e-5 * pp * rr or pp < 1e-12 or rr < 1e-12:
        # At a pole, or at the edge of what the axes reach: their errors cannot be told apart.
        return angle, math.degrees(max(angle - _CL_ROUNDING, 0.0) / (math.sqrt(pp) + math.sqrt(rr)))
    one, two = abs((rr * pe - pr * re) / volume), abs((pp * re - pr * pe) / volume)
    # The split is for small turns: products of both, which grow towards the pole, are tolerated.
    height = abs(w0 * a0 + w1 * a1 + w2 * a2)
    first_off = one * (1.0 - two * height / math.sqrt(pp)) - _NOISE / math.sqrt(pp)
    second_off = two - 0.5 * one * one - _NOISE / math.sqrt(rr)
    return angle, math.degrees(max(first_off, second_off, 0.0))


def degrees_apart(one: Floats, two: Floats) -> Floats:
    """Angles between unit vectors (k, 3), degrees, (k,); exact for small angles, where an arc cosine is not."""
    chord = np.linalg.norm(one - two, axis=1)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))))
