"""How long a machine takes: speeds and accelerations of its axes, looking ahead over the corners.

Each row is a straight line in axis space, run at one speed along its length with a ramp at either end (a trapezoid).
A corner is rounded by a parabola that leaves it by no more than ``ROUNDING``: over the length l of the parabola the
direction changes by d, so it stands off by d l / 8 and asks for the acceleration d v^2 / l. The speeds at the corners
are then lowered until every ramp between them fits its row: once from the end to the start, once the other way.

Units: mm and degrees, seconds. What the definition does not state limits nothing.
"""

import math

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.jit import njit
from trunnion.machines.machine import Machine

#: How far an axis may leave a corner, mm or degrees: what controls take for cuts of usual accuracy.
ROUNDING = 0.01


def row_seconds(machine: Machine, steps: Floats, length: Floats, rate: Floats, stop: Flags) -> Floats:
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
    rapid = np.array([math.inf if axis.rapid is None else axis.rapid / 60.0 for axis in machine.axes])
    most = np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in machine.axes])
    seconds = np.zeros(len(steps))
    _pace(steps, length, rate / 60.0, stop, rapid, most, seconds)
    return seconds


def clock(seconds: float) -> str:
    """Return a time as people read it.

    >>> clock(4.26), clock(75), clock(7384)
    ('4.3 s', '1:15 min', '2:03:04 h')
    """
    if round(seconds, 1) < 60.0:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d} min" if minutes < 60 else f"{minutes // 60}:{minutes % 60:02d}:{rest:02d} h"


@njit(cache=True)
def _pace(
    steps: Floats, length: Floats, rate: Floats, stop: Flags, rapid: Floats, most: Floats, seconds: Floats
) -> None:
    """Fill ``seconds`` (n,); speeds in mm/s or deg/s."""
    n = steps.shape[0]
    top, ramp, corner = np.zeros(n), np.zeros(n), np.zeros(n)
    last = -1
    for row in range(n):
        moved = 0.0
        for k in range(5):
            moved = max(moved, abs(steps[row, k]))
        if moved == 0.0 or not length[row] > 0.0:
            if last >= 0 and stop[row]:
                corner[last] = 0.0
            continue
        top[row], ramp[row] = rate[row], np.inf
        for k in range(5):
            share = abs(steps[row, k]) / length[row]
            if share > 0.0:
                top[row] = min(top[row], rapid[k] / share)
                ramp[row] = min(ramp[row], most[k] / share)
        if last >= 0 and corner[last] > 0.0:
            fastest = min(corner[last], top[row])
            for k in range(5):
                turn = abs(steps[row, k] / length[row] - steps[last, k] / length[last])
                if turn > 1e-12:
                    over = min(0.5 * (length[row] + length[last]), 8.0 * ROUNDING / turn)
                    fastest = min(fastest, math.sqrt(most[k] * over / turn))
            corner[last] = fastest
        corner[row] = 0.0 if stop[row] else top[row]
        last = row
    if last >= 0:
        corner[last] = 0.0
    after = 0.0
    for row in range(n - 1, -1, -1):
        if ramp[row] > 0.0:
            corner[row] = min(corner[row], after)
            after = math.sqrt(corner[row] ** 2 + 2.0 * ramp[row] * length[row])
    before = 0.0
    for row in range(n):
        if ramp[row] > 0.0:
            end = min(corner[row], math.sqrt(before**2 + 2.0 * ramp[row] * length[row]))
            corner[row] = end
            seconds[row] = _trapezoid(length[row], before, end, top[row], ramp[row])
            before = end


@njit(cache=True)
def _trapezoid(length: float, begin: float, end: float, top: float, ramp: float) -> float:
    """Seconds for a length from one speed to another, no faster than ``top`` (infinite: as the ramps allow)."""
    if not math.isfinite(ramp):
        return length / top if math.isfinite(top) and top > 0.0 else 0.0
    peak = min(top, math.sqrt(ramp * length + 0.5 * (begin * begin + end * end)))
    if peak <= 0.0:
        return 0.0
    ramps = max(2.0 * peak * peak - begin * begin - end * end, 0.0) / (2.0 * ramp)
    return (2.0 * peak - begin - end) / ramp + max(length - ramps, 0.0) / peak
