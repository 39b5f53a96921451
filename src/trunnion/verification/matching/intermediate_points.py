"""Intermediate points: which motions lead along the path from one CL point to the next.

A program may have more points than its CL file, inserted so that the tool stays on its path. Such a point lies on the
straight line between two CL points, with the tool axis that the great circle has there; in a rapid the tool axis is
free. Whether enough points were inserted is checked by ``trunnion.verification.deviations.linearization``.

Units: mm; degrees outside kernels, radians inside.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.model.run import RowPositions
from trunnion.records import dataclass
from trunnion.verification.kinematics.axis_difference import RotaryGeometry, RotaryPair, axis_difference
from trunnion.verification.kinematics.great_circles import angle_between, slerp_weights

#: Between points nearer to each other than this, mm, the tool axis tells how far the tool has come.
_SHORT: Final = 1e-3

#: Up to this many times its limits from a CL point, a motion is still about that point.
_ABOUT: Final = 3.0


class PathPoints(NamedTuple):
    """CL points in their order: tip (m, 3), axis (m, 3) and kind (m,)."""

    tip: Floats2
    axis: Floats2
    kind: Codes


class FollowLimits(NamedTuple):
    """How far a motion may be from a CL point, or from the path.

    near_tip        of a coordinate of the tip, mm, slightly more than its tolerance
    near_axis       of a coordinate of the tool axis, slightly more than its tolerance
    tip             the tolerance of a coordinate of the tip, mm
    angle           the tolerance of a rotary axis, degrees
    axis_deviation  of the tool axis from the great circle at intermediate points, rad
    """

    near_tip: float
    near_axis: float
    tip: float
    angle: float
    axis_deviation: float


@dataclass(frozen=True, slots=True, eq=False)
class FollowedPath:
    """What ``follow_path`` found.

    motions, points  how many of either side go together
    cl_point         (motions,) int64  the CL point that each motion goes to, or leads to
    arrives          (motions,) bool   it goes to that point; else it is an intermediate point
    """

    motions: int
    points: int
    cl_point: Ints
    arrives: Flags


class _Motions(NamedTuple):
    """Motions in their order; ``value`` (n,) is the position of the first rotary axis, degrees."""

    tip: Floats2
    axis: Floats2
    kind: Codes
    value: Floats


def follow_path(
    geometry: RotaryGeometry, positions: RowPositions, kind: Codes, points: PathPoints, limits: FollowLimits
) -> FollowedPath:
    """Follow CL points as far as motions go to them, directly or by intermediate points.

    positions, kind  of n motions in their order; a ``Kind`` each
    points           CL points, led by the one from which the first motion starts. Circles are reached directly or not
                     at all
    """
    cl_point, arrives = np.zeros(len(kind), np.int64), np.zeros(len(kind), np.bool_)
    motions, reached = _follow(
        _Motions(positions.tip, positions.axis, kind, positions.joints[:, geometry.column]), points, limits,
        geometry.pair, cl_point, arrives,
    )  # fmt: skip
    return FollowedPath(motions, reached, cl_point[:motions], arrives[:motions])


@kernel(writes="cl_point arrives")
def _follow(
    motions: _Motions,
    points: PathPoints,
    limits: FollowLimits,
    pair: RotaryPair,
    cl_point: Ints,
    arrives: Flags,
) -> tuple[int, int]:
    """Fill ``cl_point`` and ``arrives``; returns the motions and points up to the last motion that arrives."""
    followed, reached = 0, 0
    i, j, done = 0, 1, 0.0
    while i < motions.tip.shape[0] and j < points.tip.shape[0]:
        if _is_at(motions.tip, motions.axis, i, points, j, (limits.near_tip, limits.near_axis)):
            last = _last_at_point(motions, i, points, j, limits, pair)
            for k in range(i, last + 1):
                arrives[k], cl_point[k] = k == last, j - 1
            followed, reached = last + 1, j
            i, j, done = last + 1, j + 1, 0.0
            continue
        fraction = -1.0
        if points.kind[j] != 2:
            fraction = _fraction_of_line(motions, i, points, j, limits, done)
        if fraction >= 0.0:
            arrives[i], cl_point[i] = False, j - 1
            done = max(done, fraction)
            i += 1
            continue
        repeats = _is_at(points.tip, points.axis, j, points, j - 1, (2.0 * limits.near_tip, 2.0 * limits.near_axis))
        if not repeats or points.kind[j] == 2:
            break
        j, done = j + 1, 0.0
    return followed, reached


@inner
def _last_at_point(
    motions: _Motions, i: int, points: PathPoints, j: int, limits: FollowLimits, pair: RotaryPair
) -> int:
    """Return the last motion from ``i`` on that goes to point ``j``.

    Further motions of the same kind about the same place lead there too: near a pole the rotary axes turn far while
    the tool hardly moves. The last one within the tolerances counts.
    """
    last, ahead = i, i + 1
    about = (_ABOUT * limits.near_tip, _ABOUT * limits.near_axis)
    while (
        ahead < motions.tip.shape[0]
        and motions.kind[ahead] == motions.kind[i]
        and _is_at(motions.tip, motions.axis, ahead, points, j, about)
    ):
        _, off = axis_difference(motions.axis, ahead, points.axis, j, motions.value[ahead], pair)
        if off <= limits.angle and _is_at(motions.tip, motions.axis, ahead, points, j, (limits.tip, limits.near_axis)):
            last = ahead
        ahead += 1
    return last


@inner
def _is_at(tip: Floats, axis: Floats, i: int, points: PathPoints, j: int, near: tuple[float, float]) -> bool:
    near_tip, near_axis = near
    for k in range(3):
        if not abs(tip[i, k] - points.tip[j, k]) <= near_tip or not abs(axis[i, k] - points.axis[j, k]) <= near_axis:
            return False
    return True


@inner
def _fraction_of_line(
    motions: _Motions, i: int, points: PathPoints, j: int, limits: FollowLimits, done: float
) -> float:
    """At which fraction of the line to point ``j`` motion ``i`` lies, from ``done`` on; -1 if it is not on the line."""
    free_axis = points.kind[j] == 0
    near = 1.7320508075688772 * limits.near_tip
    length, along = 0.0, 0.0
    for k in range(3):
        length += (points.tip[j, k] - points.tip[j - 1, k]) ** 2
        along += (motions.tip[i, k] - points.tip[j - 1, k]) * (points.tip[j, k] - points.tip[j - 1, k])
    length = math.sqrt(length)
    angle = angle_between(points.axis, j - 1, points.axis, j)
    uncertainty = 0.0
    if length > _SHORT:
        fraction, uncertainty = along / length**2, 2.0 * near / length
    else:
        fraction = angle_between(motions.axis, i, points.axis, j - 1) / angle if angle > 1e-9 else done
    if not (done - uncertainty - 1e-9 <= fraction <= 1.0 + uncertainty + 1e-9):
        if length > _SHORT or not free_axis:
            return -1.0
        fraction = done
    off, foot = 0.0, fraction
    fraction = min(max(fraction, done), 1.0)
    for k in range(3):
        step = points.tip[j, k] - points.tip[j - 1, k]
        off += (motions.tip[i, k] - points.tip[j - 1, k] - foot * step) ** 2
    if not math.sqrt(off) <= near:
        return -1.0
    if not free_axis:
        before, after = slerp_weights(angle, fraction)
        off = 0.0
        for k in range(3):
            off += (motions.axis[i, k] - before * points.axis[j - 1, k] - after * points.axis[j, k]) ** 2
        if not math.sqrt(off) <= limits.axis_deviation + uncertainty * angle:
            return -1.0
    return fraction
