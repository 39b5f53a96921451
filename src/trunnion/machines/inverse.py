"""Where the axes must be for the tool to be somewhere: one closed form for every chain with two rotary axes.

In:     a ``Machine``, tool tips and tool axes in workpiece coordinates.
Out:    displayed axis values, two branches a row. Choosing between them, and between turns, is the planner's business.
Units:  mm and degrees; rotary values in (-180, 180].

The form. Let w1 and w2 be the directions of the two rotary axes (w1 next to the workpiece) and s the spindle, all axes
at zero. The tool axis is u = R1 R2 s, so the vector v = R2 s stands as far from w2 as s does, and as far from w1 as u
does: it is the third corner of a spherical triangle with three known sides,

    A = angle(w1, u)      B = angle(w2, s)      G = angle(w1, w2)

and the half-angle formula gives its corner at w2,

    tan^2(phi/2) = sin(S-B) sin(S-G) / (sin S sin(S-A)),    S = (A + B + G)/2,

to both sides of the great circle through w1 and w2: two branches. The formula loses no digits near the pole, as an arc
cosine would. The first angle then turns v onto u about w1. With both angles known, the slides solve a 3x3 linear system
whose columns are the slides' directions, each turned by the rotary axes that stand between it and the workpiece.

This is the second of the classic subproblems of Paden and Kahan (Murray, Li, Sastry: A Mathematical Introduction to
Robotic Manipulation, 3.3.2) in the shape of spherical trigonometry. It shares nothing with
``trunnion.machines.forward``.

Status bits, kernels do not raise:

    0             two solutions, which coincide on the edge of what the rotary axes reach
    UNREACHABLE   no rotary angles give this tool axis; the row is NaN
    POLE          the tool axis is parallel to the first rotary axis, whose angle is free and carries 0 here. Whoever
                  keeps another angle there calls ``solve_slides`` with it
    SLIDES_DEPENDENT the slides are linearly dependent at these angles (possible only where a rotary axis stands between
                  slides, such as a quill at 90 degrees); slide values are NaN
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Final, NamedTuple, TypeAlias

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Floats3
from trunnion.jit import inner, kernel
from trunnion.machines.machine import Machine

UNREACHABLE: Final = 1
POLE: Final = 2
SLIDES_DEPENDENT: Final = 4

#: How far a tool axis may lie outside the reach of the rotary axes and still be taken for the edge of it, rad. CL files
#: print seven decimals, which moves a vector by up to 0.9e-7: so much is noise. On a tool of 100 mm it is 0.01 um.
REACH_TOLERANCE: Final = 1e-7

#: How near to the first rotary axis a tool axis counts as parallel to it, rad; the same noise of CL files. The tool
#: axis is then taken to be exactly parallel.
POLE_TOLERANCE: Final = 1e-7

#: Least volume of the three slide directions, as a box of unit vectors.
_MIN_SLIDE_VOLUME: Final = 1e-9


FlatArray: TypeAlias = tuple[float, ...]
Pair: TypeAlias = Annotated[FlatArray, 2]
Triple: TypeAlias = Annotated[FlatArray, 3]
Matrix: TypeAlias = Annotated[FlatArray, 9]


class KinematicParameters(NamedTuple):
    """A machine with a tool, for compiled kernels. Directions point where growing values move the tool.

    Vectors and matrices are flat tuples, which a kernel keeps in registers: with arrays it took 1.8 times as long.

    columns   (5,) int      columns of: first rotary, second rotary, the three slides
    basis_1   (9,) float    rows: two unit vectors across the first rotary axis, the first towards w2; its line
    basis_2   (9,) float    rows: two unit vectors across the second rotary axis, the first towards w1; its line
    sense_1   float         -1 where the line of ``basis_1`` points against growing values
    half_difference (2,) float    cosine and sine of (G - B)/2
    half_sum  (2,) float    cosine and sine of (G + B)/2
    phase     (2,) float    cosine and sine of the second angle from where the spindle leans most towards w1 to zero
    spindle   (3,) float    the spindle in ``basis_2``
    slides    (9,) float    rows: directions of the slides
    slides_inverse (9,) float    rows: the reciprocal of ``slides``; NaN where they do not span space
    rotary_below (3,) int      how many rotary axes stand between the slide and the workpiece
    first_point (3,) float    point of the first rotary axis, from workpiece zero, mm
    second_offset (3,) float    from there to the point of the second rotary axis, mm
    tool_offset (3,) float    from there to the tool tip, mm
    """

    columns: Annotated[tuple[int, ...], 5]
    basis_1: Matrix
    basis_2: Matrix
    sense_1: float
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


@dataclass(frozen=True, slots=True, eq=False)
class InverseSolutions:
    """Axis values for rows of tool positions.

    joints     (2, n, 5) float64  displayed values, mm or deg; NaN where not reachable; branches as in ``branch_angles``
    reachable  (n,) bool          the rotary axes reach the tool axis and the slides can follow; travel is not looked at
    pole       (n,) bool          the angle of the first rotary axis is free and carries 0
    """

    joints: Floats
    reachable: Flags
    pole: Flags


@lru_cache(maxsize=4)  # most runs have one machine, and ask again and again
def kinematic_parameters(machine: Machine, tool_length: float | None = None) -> KinematicParameters:
    """Plain numbers for the kernels of this module, for a machine and the length (mm) of the tool in its spindle.

    Without a length it is that of ``machine.tool_length``.
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
    zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0))
    slides = machine.linear
    return KinematicParameters(
        columns=(first, second, *slides),
        basis_1=_flatten(basis_1),
        basis_2=_flatten(basis_2),
        sense_1=sense,
        half_difference=_cos_sin(0.5 * (_angle(w1, w2) - _angle(w2, s))),
        half_sum=_cos_sin(0.5 * (_angle(w1, w2) + _angle(w2, s))),
        phase=_flatten(spindle[:2] / math.hypot(spindle[0], spindle[1])),
        spindle=_flatten(spindle),
        slides=_flatten(directions[list(slides)]),
        slides_inverse=_flatten(_reciprocal(directions[list(slides)])),
        rotary_below=tuple(int(first < k) + int(second < k) for k in slides),
        first_point=_flatten(points[first] - zero),
        second_offset=_flatten(points[second] - points[first]),
        tool_offset=_flatten(tip - points[second]),
    )


def _reciprocal(slides: Floats) -> Floats:
    """(3, 3): rows whose products with a vector are its parts along the slides."""
    flat = abs(float(np.linalg.det(slides))) < _MIN_SLIDE_VOLUME
    return np.full((3, 3), np.nan) if flat else np.asarray(np.linalg.inv(slides.T))


def _flatten(array: Floats) -> FlatArray:
    return tuple(array.ravel().tolist())


def _cos_sin(angle: float) -> FlatArray:
    return math.cos(angle), math.sin(angle)


def _angle(a: Floats, b: Floats) -> float:
    """Angle between two vectors, rad, in [0, pi], good to the last digits everywhere."""
    return math.atan2(float(np.linalg.norm(_cross(a, b))), float(np.dot(a, b)))


def _basis(line: Floats, other: Floats) -> Floats:
    """Rows: the unit vector across ``line`` towards ``other``, the one that makes it right-handed, the line."""
    across = _cross(_cross(line, other), line)
    across = across / np.linalg.norm(across)
    return np.array([across, _cross(line, across), line])


def _cross(a: Floats, b: Floats) -> Floats:
    """``np.cross`` of two vectors, which takes ten times as long for them."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def _branch_sign(w1: Floats, w2: Floats, s: Floats) -> float:
    """Sign that makes the first line lean towards the spindle, as seen along the second: it fixes which branch is 0."""
    frame = _basis(w2, w1)
    lean = float(frame[0] @ s)
    if abs(lean) > 1e-9:
        return math.copysign(1.0, lean)
    # The spindle stands square to both, as on a fork that turns about X and then Y: the side where zero is in branch 0.
    return 1.0 if float(frame[1] @ s) > 0.0 else -1.0


def inverse(machine: Machine, tip: Floats, axis: Floats, tool_length: float | None = None) -> InverseSolutions:
    """Both sets of axis values for rows of tool tips and tool axes.

    Parameters
    ----------
    machine
        The chain, from the workpiece to the tool.
    tip : (n, 3) float64, mm
        In workpiece coordinates, counted from ``machine.workpiece_zero``; from the machine's own zero if that is None.
    axis : (n, 3) float64
        From tip to holder, in workpiece coordinates; any length but zero.
    tool_length
        From the gauge point to the tip, mm; None: that of ``machine.tool_length``.
    """
    tips = np.ascontiguousarray(tip, dtype=np.float64)
    axes = np.ascontiguousarray(axis, dtype=np.float64)
    if tips.ndim != 2 or tips.shape[1] != 3 or axes.shape != tips.shape:
        raise ValueError(f"tip and axis must both have shape (n, 3), not {tips.shape} and {axes.shape}")
    joints = np.empty((2, len(tips), 5))
    status = np.empty(len(tips), np.uint8)
    solve_rows(kinematic_parameters(machine, tool_length), tips, axes, joints, status)
    return InverseSolutions(joints, (status & (UNREACHABLE | SLIDES_DEPENDENT)) == 0, (status & POLE) != 0)


def slide_positions(machine: Machine, tip: Floats, rotary: Floats, tool_length: float | None = None) -> Floats:
    """All five axis positions for rows of tool tips when the rotary positions are known.

    Parameters
    ----------
    tip : (n, 3) float64, mm
        In workpiece coordinates, as for ``inverse``.
    rotary : (n, 2) float64, deg
        Displayed values in the order of ``machine.rotary``.

    Returns
    -------
    (n, 5) float64
        mm or deg, in the order of ``machine.axes``; NaN slides where they are stuck.
    """
    joints = np.empty((len(tip), 5))
    slide_rows(
        kinematic_parameters(machine, tool_length), np.ascontiguousarray(tip), np.ascontiguousarray(rotary), joints
    )
    return joints


@kernel(writes="joints")
def slide_rows(kinematics: KinematicParameters, tip: Floats2, rotary: Floats2, joints: Floats2) -> None:
    """Call ``solve_slides`` for each row; joints (n, 5) is written."""
    for row in range(tip.shape[0]):
        solve_slides(kinematics, rotary[row, 0], rotary[row, 1], tip[row, 0], tip[row, 1], tip[row, 2], joints[row])


@kernel(writes="joints status")
def solve_rows(kinematics: KinematicParameters, tip: Floats2, axis: Floats2, joints: Floats3, status: Codes) -> None:
    """Call ``solve_point`` for each row; joints (2, n, 5) and status (n,) uint8 are written."""
    for row in range(tip.shape[0]):
        status[row] = solve_point(
            kinematics,
            tip[row, 0],
            tip[row, 1],
            tip[row, 2],
            axis[row, 0],
            axis[row, 1],
            axis[row, 2],
            joints[:, row, :],
        )


@inner
def solve_point(
    kinematics: KinematicParameters, x: float, y: float, z: float, i: float, j: float, k: float, out: Floats
) -> int:
    """Write both branches of one tool position into ``out`` (2, 5), mm and deg; return the status bits."""
    status, u0, u1, cos, sin = solve_tilt(kinematics, i, j, k)
    if status == UNREACHABLE:
        out[:, :] = math.nan
        return UNREACHABLE
    both = status
    for branch in range(2):
        first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(
            kinematics, u0, u1, cos, sin if branch == 0 else -sin, status
        )
        out[branch, kinematics.columns[0]] = first
        out[branch, kinematics.columns[1]] = second
        both |= solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z, out[branch])
    return both


@inner
def solve_tilt(kinematics: KinematicParameters, i: float, j: float, k: float) -> tuple[int, float, float, float, float]:
    """Return what both branches of a tool axis share.

    That is the status bits, the two components of the tool axis across the first line, and cosine and sine of phi, in
    [0, 180] degrees. All sines of the module's formula come from those of A/2 by addition, so that nothing but square
    roots is needed.
    """
    one = kinematics.basis_1
    u0 = one[0] * i + one[1] * j + one[2] * k
    u1 = one[3] * i + one[4] * j + one[5] * k
    u2 = one[6] * i + one[7] * j + one[8] * k
    across = math.sqrt(u0 * u0 + u1 * u1)
    length = math.sqrt(across * across + u2 * u2)
    if not 0.0 < length < math.inf:  # written so that NaN is out of reach as well
        return UNREACHABLE, math.nan, math.nan, math.nan, math.nan
    pole = across < POLE_TOLERANCE * length
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
    if min(min(lean, between), min(half, off)) < -0.5 * REACH_TOLERANCE:
        return UNREACHABLE, math.nan, math.nan, math.nan, math.nan
    num, den = max(lean, 0.0) * max(between, 0.0), max(half, 0.0) * max(off, 0.0)
    return POLE if pole else 0, u0, u1, (den - num) / (den + num), 2.0 * math.sqrt(num * den) / (den + num)


@inner
def branch_angles(
    kinematics: KinematicParameters, u0: float, u1: float, cos: float, sin: float, status: int
) -> tuple[float, float, float, float, float, float]:
    """First and second rotary angle of one branch, deg, in (-180, 180], and cosine and sine of each about its line.

    Branch 0 has the second rotary angle phi - phase, branch 1, for which ``sin`` comes negative, -phi - phase. On
    machines whose tool axis at zero lies in the plane of the two rotary axes phase is 0: branch 0 is the positive tilt,
    branch 1 the negative one. On fork heads that turn about X and then Y phase is 90: branch 0 has the second angle in
    [-90, 90]. Along a path each branch is continuous, away from poles.

    u0, u1, cos, sin and status are as ``solve_tilt`` gives them.
    """
    cos, sin = (
        cos * kinematics.phase[0] + sin * kinematics.phase[1],
        sin * kinematics.phase[0] - cos * kinematics.phase[1],
    )
    second = math.degrees(math.atan2(sin, cos))
    first, cos_1, sin_1 = 0.0, 1.0, 0.0
    if not status & POLE:
        # v = R2 s, then its components across the first line.
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


@inner
def solve_slides(
    kinematics: KinematicParameters, first: float, second: float, x: float, y: float, z: float, out: Floats
) -> int:
    """Write one whole row ``out`` (5,): the rotary values as given, deg, and the slides that bring the tip to x, y, z.

    Returns 0 or SLIDES_DEPENDENT. Rotary values are displayed ones and may be wound up: whole turns drop out without
    loss.
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
    """Write the slides of ``out`` (5,) that bring the tip to x, y, z; returns 0 or SLIDES_DEPENDENT.

    The rotary axes stand at the angles with these cosines and sines, about the lines of ``basis_1`` and ``basis_2``.
    """
    one, two, second_offset, tool_offset = (
        kinematics.basis_1,
        kinematics.basis_2,
        kinematics.second_offset,
        kinematics.tool_offset,
    )
    x, y, z = x - kinematics.first_point[0], y - kinematics.first_point[1], z - kinematics.first_point[2]
    rotary_below = kinematics.rotary_below
    if (
        rotary_below[0] == rotary_below[1]
        and rotary_below[1] == rotary_below[2]
        and not math.isnan(kinematics.slides_inverse[0])
    ):
        # All slides stand on one side of each rotary axis, and always as at zero to each other: seen from there, what
        # is on the workpiece's side turns back, and what is on the tool's side turns.
        if rotary_below[0] >= 1:
            x, y, z = rotate_about(one, cos_1, -sin_1, x, y, z)
            x, y, z = x - second_offset[0], y - second_offset[1], z - second_offset[2]
        rx, ry, rz = tool_offset[0], tool_offset[1], tool_offset[2]
        if rotary_below[0] == 2:
            x, y, z = rotate_about(two, cos_2, -sin_2, x, y, z)
        else:
            rx, ry, rz = rotate_about(two, cos_2, sin_2, rx, ry, rz)
        if rotary_below[0] == 0:
            rx, ry, rz = rotate_about(
                one, cos_1, sin_1, rx + second_offset[0], ry + second_offset[1], rz + second_offset[2]
            )
        px, py, pz = x - rx, y - ry, z - rz
        across = kinematics.slides_inverse
        out[kinematics.columns[2]] = across[0] * px + across[1] * py + across[2] * pz + 0.0
        out[kinematics.columns[3]] = across[3] * px + across[4] * py + across[5] * pz + 0.0
        out[kinematics.columns[4]] = across[6] * px + across[7] * py + across[8] * pz + 0.0
        return 0
    # Where the tip would be with the slides at zero.
    px, py, pz = rotate_about(two, cos_2, sin_2, tool_offset[0], tool_offset[1], tool_offset[2])
    px, py, pz = rotate_about(one, cos_1, sin_1, px + second_offset[0], py + second_offset[1], pz + second_offset[2])
    px, py, pz = x - px, y - py, z - pz
    ax, ay, az = slide_direction(kinematics, 0, cos_1, sin_1, cos_2, sin_2)
    bx, by, bz = slide_direction(kinematics, 1, cos_1, sin_1, cos_2, sin_2)
    cx, cy, cz = slide_direction(kinematics, 2, cos_1, sin_1, cos_2, sin_2)
    # Cramer: the reciprocal basis of the three slide directions.
    rx, ry, rz = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
    box = ax * rx + ay * ry + az * rz
    if abs(box) < _MIN_SLIDE_VOLUME:
        for slide in range(3):
            out[kinematics.columns[2 + slide]] = math.nan
        return SLIDES_DEPENDENT
    out[kinematics.columns[2]] = (px * rx + py * ry + pz * rz) / box + 0.0
    rx, ry, rz = cy * az - cz * ay, cz * ax - cx * az, cx * ay - cy * ax
    out[kinematics.columns[3]] = (px * rx + py * ry + pz * rz) / box + 0.0
    rx, ry, rz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    out[kinematics.columns[4]] = (px * rx + py * ry + pz * rz) / box + 0.0
    return 0


@inner
def slide_direction(
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
def rotate_about(frame: FlatArray, cos: float, sin: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector turned about the third row of ``frame``, an orthonormal 3x3 flattened by rows."""
    a = frame[0] * x + frame[1] * y + frame[2] * z
    b = frame[3] * x + frame[4] * y + frame[5] * z
    c = frame[6] * x + frame[7] * y + frame[8] * z
    a, b = cos * a - sin * b, sin * a + cos * b
    return (
        frame[0] * a + frame[3] * b + frame[6] * c,
        frame[1] * a + frame[4] * b + frame[7] * c,
        frame[2] * a + frame[5] * b + frame[8] * c,
    )
