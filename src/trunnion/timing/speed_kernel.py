"""The fastest run of a path under speeds and accelerations of its axes, with corners that are rounded.

Each piece of the path is straight in the space of the axes; its way s counts what the feed counts. A corner between
two pieces is a parabola that departs from it by no more than a tolerance: over its length l the direction (axis values
per s) changes evenly by d, so it departs by d l / 8 and needs the acceleration d v^2 / l at the speed v. Its halves lie
in the two pieces, and take no more than half of the shorter one. Between two pieces of one row there is no corner: the
path bends evenly from the middle of one to the middle of the other, whatever the tolerance.

With b = v^2, whose change over a way is twice the acceleration along it, a limit A of an axis is

    c |b1 - b0| / (2 l) + d b / l <= A     with the greater axis value per s, c, of the two pieces; b is b0 or b1

which is linear: one pass from the end to the start lowers b at each boundary to what can still be braked from, one
pass the other way to what can be reached. Holding a speed is always possible, so the passes leave no gap. A first look,
as if corners had no length, says how fast they can be passed at most; then they are made no longer than that needs, and
the passes are done again.

Units: mm and degrees, seconds.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2
from trunnion.jit import inner, kernel

#: Columns of a plan: half the length of the corner after a piece; b where the piece's straight part begins and ends;
#: the greatest b and the greatest acceleration along the straight part, which is 0 for pieces without motion.
CORNER: Final = 0
BEGIN: Final = 1
END: Final = 2
TOP: Final = 3
ACCELERATION: Final = 4


@kernel(writes="reached")
def fill_reached(length: Floats, plan: Floats2, reached: Floats) -> None:
    """Fill the highest speed of each piece (m,), of what ``plan_speeds`` has planned; 0 without motion."""
    before = -1
    for at in range(plan.shape[0]):
        reached[at] = 0.0
        if not plan[at, 4] > 0.0:
            continue
        corner = plan[before, 0] if before >= 0 else 0.0
        straight = _straight(length[at], corner, plan[at, 0])
        greatest = max(plan[at, 1], plan[at, 2])
        if straight > 0.0:
            greatest = max(greatest, min(plan[at, 3], plan[at, 4] * straight + 0.5 * (plan[at, 1] + plan[at, 2])))
        # In a corner the square of the speed changes evenly; half of it is in either piece.
        if before >= 0 and corner > 0.0:
            middle = 0.5 * (plan[before, 2] + plan[at, 1])
            greatest, reached[before] = max(greatest, middle), max(reached[before], math.sqrt(middle))
        reached[at] = math.sqrt(greatest)
        before = at


@kernel(writes="plan seconds")
def plan_speeds(
    steps: Floats2,
    length: Floats,
    rate: Floats,
    tolerance: Floats,
    stops_after: Flags,
    bends_after: Flags,
    limits: Floats2,
    plan: Floats2,
    seconds: Floats,
) -> None:
    """Fill the ``plan`` (m, 5) of m pieces, and their ``seconds`` (m,).

    steps        (m, 5)    how far each axis moves
    length       (m,)      length that the feed counts
    rate         (m,)      programmed speed along it, per second
    tolerance    (m,)      how far the path may depart from the corner after a piece
    stops_after  (m,)      the axes stop there
    bends_after  (m,)      its row goes on there
    limits       (2, 5)    speeds and accelerations of the axes
    """
    acceleration = limits[1]
    _fill_straights(steps, length, rate, limits, plan)
    last = _fill_corners(steps, length, tolerance, stops_after, bends_after, acceleration, plan)
    if last < 0:
        return
    _lower(steps, length, acceleration, last, False, plan)
    _shorten_corners(steps, length, acceleration, last, plan)
    _lower(steps, length, acceleration, last, True, plan)
    _fill_seconds(length, plan, seconds)


@inner
def _lower(steps: Floats2, length: Floats, acceleration: Floats, last: int, round_corners: bool, plan: Floats2) -> None:
    """Lower b to what can be braked from and be reached; unless ``round_corners``, as if corners had no length."""
    after, straight = last, 0.0
    plan[last, END] = 0.0
    for at in range(last, -1, -1):
        if not plan[at, ACCELERATION] > 0.0:
            continue
        corner = plan[at, CORNER] if round_corners else 0.0
        if at != last:
            reached = _through(steps, length, at, after, corner, plan[after, BEGIN], acceleration)
            plan[at, END] = min(plan[at, END], reached)
        before = _before(plan, at) if round_corners else -1
        straight = _straight(length[at], plan[before, CORNER] if before >= 0 else 0.0, corner)
        plan[at, BEGIN] = min(plan[at, BEGIN], _over(plan, at, plan[at, END], straight))
        after = at
    before = -1
    for at in range(last + 1):
        if not plan[at, ACCELERATION] > 0.0:
            continue
        corner = 0.0
        if before < 0:
            plan[at, BEGIN] = 0.0
        else:
            corner = plan[before, CORNER] if round_corners else 0.0
            reached = _through(steps, length, before, at, corner, plan[before, END], acceleration)
            plan[at, BEGIN] = min(plan[at, BEGIN], reached)
        straight = _straight(length[at], corner, plan[at, CORNER] if round_corners else 0.0)
        plan[at, END] = min(plan[at, END], _over(plan, at, plan[at, BEGIN], straight))
        before = at


@inner
def _shorten_corners(steps: Floats2, length: Floats, acceleration: Floats, last: int, plan: Floats2) -> None:
    """Make corners no longer than the speeds need that are reached there."""
    before = -1
    for at in range(last + 1):
        if not plan[at, 4] > 0.0:
            continue
        if before >= 0 and plan[before, 0] > 0.0:
            needed = 0.0
            for k in range(5):
                turn = abs(steps[at, k] / length[at] - steps[before, k] / length[before])
                if turn > 0.0 and acceleration[k] < np.inf:
                    needed = max(needed, 0.5 * plan[at, 1] * turn / acceleration[k])
            plan[before, 0] = min(plan[before, 0], needed)
        if before >= 0:
            plan[before, 2] = plan[at, 1] = min(plan[before, 2], plan[at, 1])
        before = at


@inner
def _before(plan: Floats2, at: int) -> int:
    """Return the piece before one that moves, -1 for none."""
    at -= 1
    while at >= 0 and not plan[at, 4] > 0.0:
        at -= 1
    return at


@inner
def _straight(length: float, before: float, after: float) -> float:
    """Return what corners leave of a piece; of what rounding leaves, nothing."""
    straight = length - before - after
    return straight if straight > 1e-12 * length else 0.0


@inner
def _over(plan: Floats2, at: int, b: float, straight: float) -> float:
    """Return what b can become over a straight part, or have been."""
    return min(plan[at, 3], b + 2.0 * plan[at, 4] * straight) if straight > 0.0 else b


@inner
def _through(
    steps: Floats2, length: Floats, one: int, two: int, corner: float, b: float, acceleration: Floats
) -> float:
    """Return what b can become through the corner between two pieces, or have been; it is the greater one."""
    if not corner > 0.0:
        return b
    greatest = np.inf
    for k in range(5):
        p, q = steps[one, k] / length[one], steps[two, k] / length[two]
        c, turn = max(abs(p), abs(q)), abs(q - p)
        if c > 0.0 and acceleration[k] < np.inf:
            greatest = min(greatest, (4.0 * corner * acceleration[k] + c * b) / (c + 2.0 * turn))
    return greatest


@inner
def _fill_straights(steps: Floats2, length: Floats, rate: Floats, limits: Floats2, plan: Floats2) -> None:
    """Fill what straight parts allow."""
    for at in range(steps.shape[0]):
        largest = 0.0
        for k in range(5):
            largest = max(largest, abs(steps[at, k]))
        plan[at, :] = 0.0
        if largest == 0.0 or not length[at] > 0.0:
            continue
        speed, acceleration = rate[at], np.inf
        for k in range(5):
            share = abs(steps[at, k]) / length[at]
            if share > 0.0:
                speed = min(speed, limits[0, k] / share)
                acceleration = min(acceleration, limits[1, k] / share)
        plan[at, 1] = plan[at, 2] = plan[at, 3] = speed * speed
        plan[at, 4] = acceleration


@inner
def _fill_corners(
    steps: Floats2,
    length: Floats,
    tolerance: Floats,
    stops_after: Flags,
    bends_after: Flags,
    acceleration: Floats,
    plan: Floats2,
) -> int:
    """Fill the corners and what they allow; returns the last piece that moves, -1 for none."""
    last, stopped = -1, False
    for at in range(steps.shape[0]):
        if not plan[at, 4] > 0.0:
            stopped = stopped or stops_after[at]
            continue
        if last >= 0:
            greatest = 0.0
            if not stopped:
                allowed = np.inf if bends_after[last] else tolerance[last]
                corner, greatest = _corner(steps, length, last, at, allowed, acceleration, plan)
                plan[last, 0] = corner
            plan[last, 2] = min(plan[last, 2], greatest)
            plan[at, 1] = min(plan[at, 1], greatest)
        last, stopped = at, stops_after[at]
    return last


@inner
def _corner(
    steps: Floats2, length: Floats, one: int, two: int, tolerance: float, acceleration: Floats, plan: Floats2
) -> tuple[float, float]:
    """Half the length of the corner between two pieces, and the greatest b in it."""
    turned = 0.0
    for k in range(5):
        turned = max(turned, abs(steps[two, k] / length[two] - steps[one, k] / length[one]))
    greatest = min(plan[one, 3], plan[two, 3])
    if not turned > 1e-12:
        return 0.0, greatest
    half = min(0.5 * min(length[one], length[two]), 4.0 * tolerance / turned)
    for k in range(5):
        turn = abs(steps[two, k] / length[two] - steps[one, k] / length[one])
        if turn > 0.0 and acceleration[k] < np.inf:
            greatest = min(greatest, 2.0 * half * acceleration[k] / turn)
    return half, greatest


@inner
def _fill_seconds(length: Floats, plan: Floats2, seconds: Floats) -> None:
    """Fill the time of each piece: half of the corner before it, its straight part, half of the corner after it."""
    before, at = -1, 0
    n = plan.shape[0]
    while at < n:
        seconds[at] = 0.0
        if not plan[at, 4] > 0.0:
            at += 1
            continue
        after = at + 1
        while after < n and not plan[after, 4] > 0.0:
            seconds[after] = 0.0
            after += 1
        corner = 0.0
        if before >= 0 and plan[before, 0] > 0.0:
            corner = plan[before, 0]
            seconds[at] += _ramp(corner, 0.5 * (plan[before, 2] + plan[at, 1]), plan[at, 1])
        straight = _straight(length[at], corner, plan[at, 0])
        seconds[at] += _trapezoid(straight, math.sqrt(plan[at, 1]), math.sqrt(plan[at, 2]), plan[at, 3], plan[at, 4])
        if after < n and plan[at, 0] > 0.0:
            seconds[at] += _ramp(plan[at, 0], plan[at, 2], 0.5 * (plan[at, 2] + plan[after, 1]))
        before, at = at, after


@inner
def _ramp(way: float, b0: float, b1: float) -> float:
    """Seconds for a way with an even acceleration."""
    both = math.sqrt(b0) + math.sqrt(b1)
    return 2.0 * way / both if both > 0.0 else 0.0


@inner
def _trapezoid(way: float, begin: float, end: float, top: float, acceleration: float) -> float:
    """Seconds for a way from one speed to another, as fast as can be; ``top`` is the square of the greatest speed."""
    if not way > 0.0:
        return 0.0
    if not math.isfinite(acceleration):
        return way / math.sqrt(top) if math.isfinite(top) and top > 0.0 else 0.0
    peak = math.sqrt(min(top, acceleration * way + 0.5 * (begin * begin + end * end)))
    if not peak > 0.0:
        return 0.0
    ramps = max(2.0 * peak * peak - begin * begin - end * end, 0.0) / (2.0 * acceleration)
    return max(2.0 * peak - begin - end, 0.0) / acceleration + max(way - ramps, 0.0) / peak
