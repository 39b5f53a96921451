"""Time that a machine takes for a path: speeds and accelerations of its axes, with look-ahead over corners.

Each row is a straight line in axis space, run with a trapezoidal speed profile. A corner is rounded by a parabola that
departs from it by no more than ``CORNER_TOLERANCE``. Over the length l of the parabola the direction changes by d, so
the parabola departs by d l / 8 and needs the acceleration d v^2 / l at the speed v. The corner speeds are then lowered
until every ramp between them fits its row: in one pass from the end to the start, and in one the other way.

Units: mm and degrees, seconds. A speed or acceleration that the definition does not state sets no limit.
"""

import math

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.machines.machine import Machine

#: How far an axis may depart from a corner, mm or degrees: usual for cuts of ordinary accuracy.
CORNER_TOLERANCE = 0.01


def row_seconds(machine: Machine, steps: Floats, length: Floats, rate: Floats, stops_after: Flags) -> Floats:
    """Time of every row of a path that begins and ends at rest.

    Parameters
    ----------
    machine
        Its rapid speeds and accelerations limit each axis by itself.
    steps : (n, 5) float64
        How far each axis moves in the row, mm or degrees, in the order of ``machine.axes``.
    length : (n,) float64
        Length that the feed refers to: of the path of the tip, or degrees if only rotary axes move.
    rate : (n,) float64
        Programmed speed along that length, mm/min or deg/min; infinite for rapids.
    stops_after : (n,) bool
        The axes stop after the row, for a dwell or because the length of the next row is of another kind.

    Returns
    -------
    (n,) float64
        Seconds; 0 for rows without motion.
    """
    axis_speed = np.array([math.inf if axis.rapid is None else axis.rapid / 60.0 for axis in machine.axes])
    axis_acceleration = np.array(
        [math.inf if axis.acceleration is None else axis.acceleration for axis in machine.axes]
    )
    seconds = np.zeros(len(steps))
    _fill_seconds(steps, length, rate / 60.0, stops_after, axis_speed, axis_acceleration, seconds)
    return seconds


def format_duration(seconds: float) -> str:
    """A time as people read it.

    >>> format_duration(4.26), format_duration(75), format_duration(7384)
    ('4.3 s', '1:15 min', '2:03:04 h')
    """
    if round(seconds, 1) < 60.0:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d} min" if minutes < 60 else f"{minutes // 60}:{minutes % 60:02d}:{rest:02d} h"


@kernel(writes="seconds")
def _fill_seconds(
    steps: Floats2,
    length: Floats,
    rate: Floats,
    stops_after: Flags,
    axis_speed: Floats,
    axis_acceleration: Floats,
    seconds: Floats,
) -> None:
    """Fill ``seconds`` (n,); speeds in mm/s or deg/s, accelerations in mm/s^2 or deg/s^2."""
    n = steps.shape[0]
    speed, acceleration, corner_speed = np.zeros(n), np.zeros(n), np.zeros(n)
    _fill_path_limits(steps, length, rate, axis_speed, axis_acceleration, speed, acceleration)
    _fill_corner_speeds(steps, length, stops_after, axis_acceleration, speed, acceleration, corner_speed)
    after = 0.0
    for row in range(n - 1, -1, -1):
        if acceleration[row] > 0.0:
            corner_speed[row] = min(corner_speed[row], after)
            after = math.sqrt(corner_speed[row] ** 2 + 2.0 * acceleration[row] * length[row])
    before = 0.0
    for row in range(n):
        if acceleration[row] > 0.0:
            end = min(corner_speed[row], math.sqrt(before**2 + 2.0 * acceleration[row] * length[row]))
            seconds[row] = _trapezoid(length[row], before, end, speed[row], acceleration[row])
            before = end


@inner
def _fill_path_limits(
    steps: Floats2,
    length: Floats,
    rate: Floats,
    axis_speed: Floats,
    axis_acceleration: Floats,
    speed: Floats,
    acceleration: Floats,
) -> None:
    """Fill the highest speed and acceleration along the path, (n,); rows without motion keep 0."""
    for row in range(steps.shape[0]):
        largest_step = 0.0
        for k in range(5):
            largest_step = max(largest_step, abs(steps[row, k]))
        if largest_step == 0.0 or not length[row] > 0.0:
            continue
        speed[row], acceleration[row] = rate[row], np.inf
        for k in range(5):
            share = abs(steps[row, k]) / length[row]
            if share > 0.0:
                speed[row] = min(speed[row], axis_speed[k] / share)
                acceleration[row] = min(acceleration[row], axis_acceleration[k] / share)


@inner
def _fill_corner_speeds(
    steps: Floats2,
    length: Floats,
    stops_after: Flags,
    axis_acceleration: Floats,
    speed: Floats,
    acceleration: Floats,
    corner_speed: Floats,
) -> None:
    """Fill the highest speed at the end of each row, (n,), as far as the corner and stops limit it."""
    last = -1
    for row in range(steps.shape[0]):
        if not acceleration[row] > 0.0:
            if last >= 0 and stops_after[row]:
                corner_speed[last] = 0.0
            continue
        if last >= 0 and corner_speed[last] > 0.0:
            fastest = min(corner_speed[last], speed[row])
            for k in range(5):
                direction_change = abs(steps[row, k] / length[row] - steps[last, k] / length[last])
                if direction_change > 1e-12:
                    rounding = min(0.5 * (length[row] + length[last]), 8.0 * CORNER_TOLERANCE / direction_change)
                    fastest = min(fastest, math.sqrt(axis_acceleration[k] * rounding / direction_change))
            corner_speed[last] = fastest
        corner_speed[row] = 0.0 if stops_after[row] else speed[row]
        last = row
    if last >= 0:
        corner_speed[last] = 0.0


@inner
def _trapezoid(length: float, begin: float, end: float, speed: float, acceleration: float) -> float:
    """Seconds for a length from one speed to another, no faster than ``speed``; infinite: as the ramps allow."""
    if not math.isfinite(acceleration):
        return length / speed if math.isfinite(speed) and speed > 0.0 else 0.0
    peak = min(speed, math.sqrt(acceleration * length + 0.5 * (begin * begin + end * end)))
    if peak <= 0.0:
        return 0.0
    ramp_length = max(2.0 * peak * peak - begin * begin - end * end, 0.0) / (2.0 * acceleration)
    return (2.0 * peak - begin - end) / acceleration + max(length - ramp_length, 0.0) / peak
