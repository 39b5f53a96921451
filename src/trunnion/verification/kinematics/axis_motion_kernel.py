"""Kernels of ``trunnion.verification.kinematics.axis_motion``.

Units: mm, degrees and minutes.
"""

import math
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Floats3, Ints, Ints2
from trunnion.jit import inlined, inner, kernel
from trunnion.machines import Machine
from trunnion.model.feed_path import NO_ROTATION


class AxisLimits(NamedTuple):
    """Of the five axes: which are rotary, rapid speed (mm/min or deg/min), acceleration (mm/s^2 or deg/s^2).

    Infinite where the machine's definition states none.
    """

    rotary: Flags
    rapid: Floats
    acceleration: Floats

    @staticmethod
    def of(machine: Machine) -> "AxisLimits":
        axes = machine.axes
        return AxisLimits(
            np.array([axis.is_rotary for axis in axes]),
            np.array([math.inf if axis.rapid is None else axis.rapid for axis in axes]),
            np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in axes]),
        )


class ChunkRows(NamedTuple):
    """Columns of k consecutive rows, for the kernel.

    joints, tip, axis  (k + 1, …)  the position before the rows comes first
    half_way           (k, 3)      tool axis where every joint is half-way
    angles             (k,) bool   the control interpolates rotary angles, not the tool axis on a great circle
    feed_lengths       (k,)        what the feed counts where that is neither the path of the tip nor that of the
                                   slides, else NaN; or empty
    """

    joints: Floats2
    tip: Floats2
    axis: Floats2
    half_way: Floats2
    kind: Codes
    programmed: Codes
    tcp: Flags
    machine_frame: Flags
    feed: Floats
    feed_mode: Codes
    rpm: Floats
    angles: Flags
    feed_lengths: Floats


@inner
def half_way_deviation(axis: Floats, half_way: Floats, row: int) -> float:
    """Degrees from ``half_way`` (k, 3) at a row to the middle of the great circle from ``axis`` there to the next one.

    Opposite tool axes have no middle: 0.
    """
    x, y, z = axis[row, 0] + axis[row + 1, 0], axis[row, 1] + axis[row + 1, 1], axis[row, 2] + axis[row + 1, 2]
    length = math.sqrt(x * x + y * y + z * z)
    if not length > 0.0:
        return 0.0
    x, y, z = half_way[row, 0] - x / length, half_way[row, 1] - y / length, half_way[row, 2] - z / length
    chord = math.sqrt(x * x + y * y + z * z)
    # The angle of a small chord is the chord itself, to its last digit.
    return math.degrees(chord if chord < 1e-8 else 2.0 * math.asin(min(1.0, 0.5 * chord)))


@kernel(writes="carry extremes extreme_rows times shares deviation")
def axis_motion_rows(
    first: int,
    rows: ChunkRows,
    limits: AxisLimits,
    arc_row: Ints,
    arc_length: Floats,
    carry: Floats,
    extremes: Floats2,
    extreme_rows: Ints2,
    times: Floats2,
    shares: Floats3,
    deviation: Floats,
) -> None:
    """Analyze k rows from row ``first`` on.

    arc_row, arc_length  (m,)    rows of all circles, and their lengths, mm
    carry      (7,) float64      carried from chunk to chunk: minutes of the row before if it was at feed (else 0),
                                 next arc, axis speeds in that row (5)
    extremes, extreme_rows       updated, as in ``AxisMotion``
    times      (4, k) float64    written: the length that the feed counts, mm or degrees; the feed along it, infinite
                                 for rapids; the distance that the tip travels, mm; and whether the length is that of
                                 the tip (0), of the slides (1) or in degrees (2)
    shares     (2, 5, k) float64 written: shares of rapid speed and, where stated, of acceleration; 0 for rapids
    deviation  (k,) float64      written: how far the tool axis is off half-way in rows at feed, degrees
    """
    # Arrays are taken out of their tuples once: in the loop that would count references for every row.
    joints, tip, axis, half_way, kind, programmed, tcp, machine_frame, feed, feed_mode, rpm, angles, feed_lengths = rows
    rotary, rapid, acceleration = limits
    velocity = carry[2:]
    minutes_before = carry[0]
    arc = int(carry[1])
    for at in range(kind.shape[0]):
        row = first + at
        slides_count = not machine_frame[at] and (tcp[at] or programmed[at] & 7 != 0)
        slides, turned = _axis_steps(joints, at, row, rotary, slides_count, extremes, extreme_rows)
        while arc < arc_row.shape[0] and arc_row[arc] < row:
            arc += 1
        on_arc = arc < arc_row.shape[0] and arc_row[arc] == row
        travel = arc_length[arc] if on_arc else _tip_travel(tip, at)
        length, counts = (travel, 0.0) if tcp[at] or on_arc else (slides, 1.0)
        if feed_lengths.shape[0] and not on_arc and feed_lengths[at] == feed_lengths[at]:
            length = feed_lengths[at]
        if length < 1e-9:
            length, counts = turned, 2.0
        rate, minutes = math.inf, 0.0
        if kind[at] != 0:
            rate, minutes = _rate_and_minutes(feed[at], feed_mode[at], rpm[at], length)
        times[0, at], times[1, at], times[2, at], times[3, at] = length, rate, travel, counts
        deviation[at] = 0.0
        at_feed = kind[at] != 0 and not machine_frame[at]
        if turned > NO_ROTATION and at_feed and (angles[at] or not tcp[at]):
            deviation[at] = half_way_deviation(axis, half_way, at)
        _axis_shares(joints, at, rapid, acceleration, minutes, minutes_before, velocity, shares)
        minutes_before = minutes
    carry[0] = minutes_before
    carry[1] = arc


@inlined
def _axis_steps(
    joints: Floats, at: int, row: int, rotary: Flags, slides_count: bool, extremes: Floats, extreme_rows: Ints
) -> tuple[float, float]:
    """How far the slides go, mm, and the rotary axis that turns farthest, degrees.

    Extremes are updated; those of slides if ``slides_count``.
    """
    squares, turned = 0.0, 0.0
    for k in range(5):
        value = joints[at + 1, k]
        moved = abs(value - joints[at, k])
        if rotary[k]:
            turned = max(turned, moved)
        else:
            squares += moved * moved
        if rotary[k] or slides_count:
            if value < extremes[k, 0]:
                extremes[k, 0] = value
                extreme_rows[k, 0] = row
            if value > extremes[k, 1]:
                extremes[k, 1] = value
                extreme_rows[k, 1] = row
    return math.sqrt(squares), turned


@inlined
def _tip_travel(tip: Floats, at: int) -> float:
    """Straight distance of the tip in a row, mm."""
    dx, dy, dz = tip[at + 1, 0] - tip[at, 0], tip[at + 1, 1] - tip[at, 1], tip[at + 1, 2] - tip[at, 2]
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@inlined
def _rate_and_minutes(feed: float, mode: int, rpm: float, length: float) -> tuple[float, float]:
    """Speed along a length, per minute, and the minutes it takes; infinite and 0 without a feed."""
    rate = feed
    if mode == 95:
        rate = feed * rpm
    elif mode == 93:
        rate = feed * length
    if not rate > 0.0:
        return math.inf, 0.0
    return rate, length / rate


@inlined
def _axis_shares(
    joints: Floats,
    at: int,
    rapid: Floats,
    acceleration: Floats,
    minutes: float,
    minutes_before: float,
    velocity: Floats,
    shares: Floats,
) -> None:
    """Write the shares of a row; ``velocity`` (5,) holds the speeds in the row before and is updated."""
    for k in range(5):
        stated = acceleration[k] < math.inf
        shares[0, k, at] = 0.0
        if stated:
            shares[1, k, at] = 0.0
        if minutes <= 0.0:
            continue
        now = (joints[at + 1, k] - joints[at, k]) / minutes
        shares[0, k, at] = abs(now) / rapid[k]
        if stated and minutes_before > 0.0:
            change = 2.0 * abs(now - velocity[k]) / (minutes + minutes_before)
            shares[1, k, at] = change / 3600.0 / acceleration[k]
        velocity[k] = now
