"""Kernels of ``trunnion.verification.kinematics.axis_motion``.

Units: mm, degrees and minutes.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Flags2, Floats, Floats2, Floats3, Ints, Ints2
from trunnion.jit import inlined, inner, kernel
from trunnion.machines import Machine
from trunnion.model.feed_path import NO_ROTATION

#: Slides that move by less than this, mm, stand still.
STANDS_STILL: Final = 1e-9


class AxisLimits(NamedTuple):
    """Of the five axes: which are rotary, rapid speed (mm/min or deg/min), acceleration (mm/s^2 or deg/s^2).

    Infinite where the machine's definition states none. ``placed``: positions of the axis are those of the machine.
    """

    rotary: Flags
    rapid: Floats
    acceleration: Floats
    placed: Flags

    @staticmethod
    def of(machine: Machine) -> "AxisLimits":
        axes = machine.axes
        return AxisLimits(
            np.array([axis.is_rotary for axis in axes]),
            np.array([math.inf if axis.rapid is None else axis.rapid for axis in axes]),
            np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in axes]),
            np.array([machine.is_placed(column) for column in range(len(axes))]),
        )


class ChunkRows(NamedTuple):
    """Columns of k consecutive rows, for the kernel.

    joints, tip, axis  (k + 1, …)  the position before the rows comes first
    half_way           (k, 3)      tool axis where every joint is half-way
    at_machine         (k, 5) bool the slide stands at a position of the machine, and nobody knows where that is
    angles             (k,) bool   the control interpolates rotary angles, not the tool axis on a great circle
    feeds              (4, k)      as ``trunnion.timing.row_feeds`` has them
    arcs               (m,)        the rows from the first that are arcs, in order
    arc_begin, arc_end (m, 5)      what an axis would travel on the arc with its speed at the start or the end
    """

    joints: Floats2
    tip: Floats2
    axis: Floats2
    half_way: Floats2
    kind: Codes
    programmed: Codes
    tcp: Flags
    machine_frame: Flags
    at_machine: Flags2
    angles: Flags
    feeds: Floats2
    arcs: Ints
    arc_begin: Floats2
    arc_end: Floats2


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


@kernel(writes="carry extremes extreme_rows shares deviation")
def axis_motion_rows(
    first: int,
    rows: ChunkRows,
    limits: AxisLimits,
    carry: Floats,
    extremes: Floats2,
    extreme_rows: Ints2,
    shares: Floats3,
    deviation: Floats,
) -> None:
    """Analyze k rows from row ``first`` on.

    carry      (6,) float64      carried from chunk to chunk: minutes of the row before if it was at feed (else 0), and
                                 axis speeds in that row (5)
    extremes, extreme_rows       updated, as in ``AxisMotion``
    shares     (2, 5, k) float64 written: shares of rapid speed and, where stated, of acceleration; 0 for rapids
    deviation  (k,) float64      written: how far the tool axis is off half-way in rows at feed, degrees
    """
    # Arrays are taken out of their tuples once: in the loop that would count references for every row.
    joints, _, axis, half_way, kind, programmed, tcp, machine_frame, at_machine, angles, feeds = rows[:11]
    arcs, arc_begin, arc_end = rows[11:]
    rotary, rapid, acceleration, placed = limits
    velocity = carry[1:]
    minutes_before = carry[0]
    steps = np.empty((2, 5))
    arc = 0
    for at in range(kind.shape[0]):
        row = first + at
        # Circles by their centre and motions of cycles name no axis (bits 0 to 5), and move slides.
        names_slides = programmed[at] & 7 != 0 or programmed[at] & 63 == 0
        counts = not machine_frame[at]
        slides_count = counts and (tcp[at] or names_slides)
        turned = _axis_steps(joints, at_machine, at, row, rotary, placed, counts, slides_count, extremes, extreme_rows)
        minutes = feeds[0, at] / feeds[1, at] if feeds[1, at] < math.inf else 0.0
        deviation[at] = 0.0
        at_feed = kind[at] != 0 and not machine_frame[at]
        if turned > NO_ROTATION and at_feed and (angles[at] or not tcp[at]):
            deviation[at] = half_way_deviation(axis, half_way, at)
        on_arc = arc < arcs.shape[0] and arcs[arc] == at
        for k in range(5):
            steps[0, k] = arc_begin[arc, k] if on_arc else joints[at + 1, k] - joints[at, k]
            steps[1, k] = arc_end[arc, k] if on_arc else steps[0, k]
        arc += on_arc
        _axis_shares(steps, at, rapid, acceleration, minutes, minutes_before, velocity, shares)
        minutes_before = minutes
    carry[0] = minutes_before


@inlined
def _axis_steps(
    joints: Floats,
    at_machine: Flags,
    at: int,
    row: int,
    rotary: Flags,
    placed: Flags,
    turns_count: bool,
    slides_count: bool,
    extremes: Floats,
    extreme_rows: Ints,
) -> float:
    """How far the rotary axis turns that turns farthest, degrees.

    Extremes are updated: those of rotary axes if ``turns_count``, those of slides if ``slides_count``.
    """
    turned = 0.0
    for k in range(5):
        value = joints[at + 1, k]
        if rotary[k]:
            turned = max(turned, abs(value - joints[at, k]))
        elif at_machine[at, k] or (placed[k] and abs(value - joints[at, k]) <= STANDS_STILL):
            continue  # where it came to this was counted, or is a position of the machine, such as home
        if turns_count if rotary[k] else slides_count:
            if value < extremes[k, 0]:
                extremes[k, 0] = value
                extreme_rows[k, 0] = row
            if value > extremes[k, 1]:
                extremes[k, 1] = value
                extreme_rows[k, 1] = row
    return turned


@inlined
def _axis_shares(
    steps: Floats2,
    at: int,
    rapid: Floats,
    acceleration: Floats,
    minutes: float,
    minutes_before: float,
    velocity: Floats,
    shares: Floats,
) -> None:
    """Write the shares of a row; ``velocity`` (5,) holds the speeds at the end of the row before and is updated.

    steps  (2, 5)  what the axes would travel with their speeds at the start and at the end of the row
    """
    for k in range(5):
        stated = acceleration[k] < math.inf
        shares[0, k, at] = 0.0
        if stated:
            shares[1, k, at] = 0.0
        if minutes <= 0.0:
            continue
        now = steps[0, k] / minutes
        shares[0, k, at] = abs(now) / rapid[k]
        if stated and minutes_before > 0.0:
            change = 2.0 * abs(now - velocity[k]) / (minutes + minutes_before)
            shares[1, k, at] = change / 3600.0 / acceleration[k]
        velocity[k] = steps[1, k] / minutes
