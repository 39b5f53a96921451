"""A machine as the kernels of the inverse map take it."""

import math
from functools import lru_cache
from typing import Annotated, Final, NamedTuple, TypeAlias

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines.machine import Machine

#: Least volume of the box that the unit vectors of the three slides span; below it they count as dependent.
MIN_SLIDE_VOLUME: Final = 1e-9

#: How far a tool axis may lie outside the reach of the rotary axes and still count as on its edge, rad, and how near to
#: the first one it counts as parallel to it. CL files print seven decimals, which moves a vector by up to 0.9e-7; on a
#: tool of 100 mm that is 0.01 um.
REACH_TOLERANCE: Final = 1e-7

#: The same with fewer than two rotary axes, where every tool axis is on the edge: half a thousandth of a degree, half
#: the last digit of a rotary word of three decimals. On a tool of 100 mm it is 0.9 um.
FEWER_AXES_TOLERANCE: Final = 8.7e-6

FlatArray: TypeAlias = tuple[float, ...]
Pair: TypeAlias = Annotated[FlatArray, 2]
Triple: TypeAlias = Annotated[FlatArray, 3]
Matrix: TypeAlias = Annotated[FlatArray, 9]


class KinematicParameters(NamedTuple):
    """A machine with a tool, as plain numbers for kernels.

    Directions point where growing values move the tool; w1, w2, s, B and G are those of ``trunnion.machines.inverse``.
    Vectors and matrices are flat tuples, which a kernel keeps in registers: with arrays it took 1.8 times as long.

    columns          (5,) int    columns of: first rotary axis, second rotary axis, the three slides
    basis_1          (9,) float  rows: two unit vectors square to the first rotary axis, the first towards w2; w1
    basis_2          (9,) float  rows: two unit vectors square to the second rotary axis, the first towards w1; w2
    sense_1          float       -1 where the third row of ``basis_1`` points against growing values
    is_second        float       0 where the second rotary axis is missing, else 1
    tolerance        float       how far a tool axis may lie beside what the axes reach, or beside the pole, rad
    half_difference  (2,) float  cosine and sine of (G - B)/2
    half_sum         (2,) float  cosine and sine of (G + B)/2
    phase            (2,) float  cosine and sine of the angle about w2 from w1 to the spindle
    spindle          (3,) float  the spindle in ``basis_2``
    slides           (9,) float  rows: directions of the slides
    slides_inverse   (9,) float  rows: the reciprocal basis of ``slides``; NaN if they do not span space
    rotary_below     (3,) int    number of rotary axes between the slide and the workpiece
    first_point      (3,) float  point of the first rotary axis, from workpiece zero, mm
    second_offset    (3,) float  from there to the point of the second rotary axis, mm
    tool_offset      (3,) float  from there to the tool tip, mm
    """

    columns: Annotated[tuple[int, ...], 5]
    basis_1: Matrix
    basis_2: Matrix
    sense_1: float
    is_second: float
    tolerance: float
    half_difference: Pair
    half_sum: Pair
    phase: Pair
    spindle: Triple
    slides: Matrix
    slides_inverse: Matrix
    rotary_below: Annotated[tuple[int, ...], 3]
    first_point: Triple
    second_offset: Triple
    tool_offset: Triple


@lru_cache(maxsize=4)  # most runs have one machine, and need them again and again
def kinematic_parameters(machine: Machine, tool_length: float | None = None) -> KinematicParameters:
    """Parameters of a machine with a tool.

    machine      the chain, from the workpiece to the tool
    tool_length  from the gauge point to the tip, mm; None: that of ``machine.tool_length``
    """
    length = (machine.tool_length or 0.0) if tool_length is None else tool_length
    first, second = machine.rotary
    directions = np.array([[axis.sense * d for d in axis.direction] for axis in machine.axes])
    points = np.array([axis.point for axis in machine.axes])
    s = np.array(machine.spindle_direction)
    w1, w2 = directions[first], directions[second]
    sense = _branch_sign(w1, w2, s)
    w1 = sense * w1
    basis_1 = _basis(w1, w2)
    basis_2 = _basis(w2, w1)
    spindle = basis_2 @ s
    tip = np.array(machine.spindle_point) - length * s
    zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0), np.float64)
    slides = machine.linear
    return KinematicParameters(
        columns=(first, second, *slides),
        basis_1=_flatten(basis_1),
        basis_2=_flatten(basis_2),
        sense_1=sense,
        is_second=0.0 if machine.axes[second].is_missing else 1.0,
        tolerance=REACH_TOLERANCE if len(machine.own_rotary) == 2 else FEWER_AXES_TOLERANCE,
        half_difference=_cos_sin(0.5 * (_angle(w1, w2) - _angle(w2, s))),
        half_sum=_cos_sin(0.5 * (_angle(w1, w2) + _angle(w2, s))),
        phase=(1.0, 0.0) if machine.axes[second].is_missing else _flatten(spindle[:2] / math.hypot(*spindle[:2])),
        spindle=_flatten(spindle),
        slides=_flatten(directions[list(slides)]),
        slides_inverse=_flatten(_reciprocal(directions[list(slides)])),
        rotary_below=tuple(sum(turning < k for turning in machine.own_rotary) for k in slides),
        first_point=_flatten(points[first] - zero),
        second_offset=_flatten(points[second] - points[first]),
        tool_offset=_flatten(tip - points[second]),
    )


def _reciprocal(slides: Floats) -> Floats:
    """(3, 3) float64: rows whose products with a vector are its components along the slides."""
    flat = abs(float(np.linalg.det(slides))) < MIN_SLIDE_VOLUME
    return np.full((3, 3), np.nan) if flat else np.asarray(np.linalg.inv(slides.T))


def _flatten(array: Floats) -> FlatArray:
    return tuple(array.ravel().tolist())


def _cos_sin(angle: float) -> FlatArray:
    return math.cos(angle), math.sin(angle)


def _angle(a: Floats, b: Floats) -> float:
    """Angle between two vectors, rad, in [0, pi]; accurate near both ends as well."""
    return math.atan2(float(np.linalg.norm(_cross(a, b))), float(np.dot(a, b)))


def _basis(line: Floats, other: Floats) -> Floats:
    """Rows: the unit vector square to ``line`` towards ``other``, the one that makes it right-handed, the line."""
    across = _cross(_cross(line, other), line)
    if not np.linalg.norm(across) > 1e-9:  # parallel, as a missing axis may be: any direction will do
        across = _cross(line, np.eye(3)[int(np.argmin(np.abs(line)))])
    across = across / np.linalg.norm(across)
    return np.array([across, _cross(line, across), line])


def _cross(a: Floats, b: Floats) -> Floats:
    """Cross product of two vectors; ``np.cross`` takes ten times as long for them."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def _branch_sign(w1: Floats, w2: Floats, s: Floats) -> float:
    """Sign that makes w1 lean towards the spindle as seen along w2; it decides which branch is 0."""
    basis = _basis(w2, w1)
    lean = float(basis[0] @ s)
    if abs(lean) > 1e-9:
        return math.copysign(1.0, lean)
    # The spindle is square to both, as on a fork that turns about X and then Y: the side on which zero is in branch 0.
    return 1.0 if float(basis[1] @ s) > 0.0 else -1.0
