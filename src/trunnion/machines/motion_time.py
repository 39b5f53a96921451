"""How long a machine takes: speeds and accelerations of its axes, looking ahead over the corners.

Each row is a straight line in axis space, run at one speed along its length with a ramp at either end (a trapezoid).
A corner is rounded by a parabola that leaves it by no more than ``CORNER_TOLERANCE``: over the length l of the
parabola the direction changes by d, so it stands off by d l / 8 and asks for the acceleration d v^2 / l. The speeds at
the corners are then lowered until every ramp between them fits its row: once from the end to the start, once the other
way.

Units: mm and degrees, seconds. What the definition does not state limits nothing.
"""

import math

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.machines.machine import Machine

#: How far an axis may leave a corner, mm or degrees: what controls take for cuts of usual accuracy.
CORNER_TOLERANCE = 0.01


def row_seconds(machine: Machine, steps: Floats, length: Floats, rate: Floats, stops_after: Flags) -> Floats:
    """Time of every row of a path that begins and ends at rest.

    Parameters
    ----------
    machine
        Its rapid speeds and accelerations hold for each axis by itself.
    steps : (n, 5) float64
        What each axis moves in the row, mm or degrees, machine order.
    length : (n,) float64
        Length that the feed means: of the tip's way, or degrees where nothing but rotary axes move.
    rate : (n,) float64
        Programmed speed along that length, mm/min or deg/min; infinite for rapids.
    stop : (n,) bool
        The axes stand still after the row, be it for a dwell or because the next one's length is of another kind.

    Returns
    -------
    (n,) float64
        Seconds; 0 for rows without motion.
    """
    max_speed = np.array([math.inf if axis.rapid is None else axis.rapid / 60.0 for axis in machine.axes])
    max_acceleration = np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in machine.axes])
    seconds = np.zeros(len(steps))
    _fill_seconds(steps, length, rate / 60.0, stops_after, max_speed, max_acceleration, seconds)
    return seconds


def format_duration(seconds: float) -> str:
    """Return a time as people read it.

    >>> clock(4.26), clock(75), clock(7384)
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
    max_speed: Floats,
    max_acceleration: Floats,
    seconds: Floats,
) -> None:
    """Fill ``seconds`` (n,); speeds in mm/s or deg/s."""
    n = steps.shape[0]
    path_speed, path_acceleration, corner_speed = np.zeros(n), np.zeros(n), np.zeros(n)
    last = -1
    for row in range(n):
        largest_step = 0.0
        for k in range(5):
            largest_step = max(largest_step, abs(steps[row, k]))
        if largest_step == 0.0 or not length[row] > 0.0:
            if last >= 0 and stops_after[row]:
                corner_speed[last] = 0.0
            continue
        path_speed[row], path_acceleration[row] = rate[row], np.inf
        for k in range(5):
            share = abs(steps[row, k]) / length[row]
            if share > 0.0:
                path_speed[row] = min(path_speed[row], max_speed[k] / share)
                path_acceleration[row] = min(path_acceleration[row], max_acceleration[k] / share)
        if last >= 0 and corner_speed[last] > 0.0:
            fastest = min(corner_speed[last], path_speed[row])
            for k in range(5):
                direction_change = abs(steps[row, k] / length[row] - steps[last, k] / length[last])
                if direction_change > 1e-12:
                    rounding_length = min(0.5 * (length[row] + length[last]), 8.0 * CORNER_TOLERANCE / direction_change)
                    fastest = min(fastest, math.sqrt(max_acceleration[k] * rounding_length / direction_change))
            corner_speed[last] = fastest
        corner_speed[row] = 0.0 if stops_after[row] else path_speed[row]
        last = row
    if last >= 0:
        corner_speed[last] = 0.0
    after = 0.0
    for row in range(n - 1, -1, -1):
        if path_acceleration[row] > 0.0:
            corner_speed[row] = min(corner_speed[row], after)
            after = math.sqrt(corner_speed[row] ** 2 + 2.0 * path_acceleration[row] * length[row])
    before = 0.0
    for row in range(n):
        if path_acceleration[row] > 0.0:
            end = min(corner_speed[row], math.sqrt(before**2 + 2.0 * path_acceleration[row] * length[row]))
            corner_speed[row] = end
            seconds[row] = _trapezoid(length[row], before, end, path_speed[row], path_acceleration[row])
            before = end


@inner
def _trapezoid(length: float, begin: float, end: float, path_speed: float, path_acceleration: float) -> float:
    """Seconds for a length from one speed to another, no faster than ``path_speed`` (infinite: as the ramps allow)."""
    if not math.isfinite(path_acceleration):
        return length / path_speed if math.isfinite(path_speed) and path_speed > 0.0 else 0.0
    peak = min(path_speed, math.sqrt(path_acceleration * length + 0.5 * (begin * begin + end * end)))
    if peak <= 0.0:
        return 0.0
    ramp_length = max(2.0 * peak * peak - begin * begin - end * end, 0.0) / (2.0 * path_acceleration)
    return (2.0 * peak - begin - end) / path_acceleration + max(length - ramp_length, 0.0) / peak
