"""S-curves: ramps of a speed whose acceleration begins and ends at zero and changes no faster than a jerk.

Their three parts are those of any textbook: the acceleration rises, holds and falls; a small change of speed needs no
part in which it holds. An infinite jerk makes an even ramp of it.

Units: mm or degrees, seconds.
"""

import math

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner


@inner
def ramp_time(change: float, acceleration: float, jerk: float) -> float:
    """Seconds of an S-curve that changes the speed by so much."""
    if not change > 0.0:
        return 0.0
    if not jerk < np.inf:
        return change / acceleration
    if acceleration < np.inf and change * jerk >= acceleration * acceleration:
        return change / acceleration + acceleration / jerk
    return 2.0 * math.sqrt(change / jerk)


@inner
def ramp_way(one: float, two: float, acceleration: float, jerk: float) -> float:
    """Way of an S-curve from one speed to another: its mean speed is the middle of both."""
    return 0.5 * (one + two) * ramp_time(abs(two - one), acceleration, jerk)


@inner
def reach(speed: float, way: float, acceleration: float, jerk: float) -> float:
    """Return the speed that one S-curve reaches over a way, which begins and ends without acceleration."""
    if not jerk < np.inf:
        return math.sqrt(speed * speed + 2.0 * acceleration * way) if acceleration < np.inf else np.inf
    if acceleration < np.inf:
        change = acceleration * acceleration / jerk
        if ramp_way(speed, speed + change, acceleration, jerk) <= way:
            # (v + w) / 2 ((w - v) / A + A / J) = d, with w - v = x
            p = speed + 0.5 * change
            x = -p + math.sqrt(max(p * p - 2.0 * (speed * change - acceleration * way), 0.0))
            return speed + max(x, change)
    # (2 v + x^2) x = d sqrt(J), with w - v = x^2: from above, Newton's steps come down to it
    given = way * math.sqrt(jerk)
    x = given ** (1.0 / 3.0)
    if 2.0 * speed * x > given:
        x = given / (2.0 * speed)
    for _ in range(40):
        less = (x * x * x + 2.0 * speed * x - given) / (3.0 * x * x + 2.0 * speed) if x > 0.0 else 0.0
        x -= less
        if not less > 1e-15 * x:
            break
    return speed + x * x


@inner
def peak(one: float, two: float, way: float, acceleration: float, jerk: float, top: float) -> float:
    """Return the highest speed on a way from one speed to another, no higher than ``top``."""
    low = max(one, two)
    if ramp_way(one, two, acceleration, jerk) >= way or top <= low:
        return low
    if not (acceleration < np.inf or jerk < np.inf):
        return top
    high = min(top, max(reach(one, way, acceleration, jerk), low))
    if ramp_way(one, high, acceleration, jerk) + ramp_way(two, high, acceleration, jerk) <= way:
        return high
    for _ in range(60):
        middle = 0.5 * (low + high)
        if ramp_way(one, middle, acceleration, jerk) + ramp_way(two, middle, acceleration, jerk) <= way:
            low = middle
        else:
            high = middle
    return low


@inner
def fill_ramp(curve: Floats2, count: int, one: float, two: float, acceleration: float, jerk: float) -> int:
    """Append the parts of a ramp to ``curve`` (7, 4): seconds, and speed, acceleration and jerk at their begin."""
    change = abs(two - one)
    sign = 1.0 if two > one else -1.0
    if not change > 0.0:
        return count
    if not jerk < np.inf:
        if acceleration < np.inf:
            _fill(curve[count], change / acceleration, one, sign * acceleration, 0.0)
            count += 1
        return count
    if acceleration < np.inf and change * jerk >= acceleration * acceleration:
        rises = acceleration / jerk
        risen = 0.5 * acceleration * rises
        _fill(curve[count], rises, one, 0.0, sign * jerk)
        _fill(curve[count + 1], max(change / acceleration - rises, 0.0), one + sign * risen, sign * acceleration, 0.0)
        _fill(curve[count + 2], rises, two - sign * risen, sign * acceleration, -sign * jerk)
        return count + 3
    rises = math.sqrt(change / jerk)
    _fill(curve[count], rises, one, 0.0, sign * jerk)
    _fill(curve[count + 1], rises, 0.5 * (one + two), sign * jerk * rises, -sign * jerk)
    return count + 2


@inner
def _fill(part: Floats, seconds: float, speed: float, acceleration: float, jerk: float) -> None:
    part[0], part[1], part[2], part[3] = seconds, speed, acceleration, jerk


@inner
def way_of(seconds: float, speed: float, acceleration: float, jerk: float) -> float:
    """Way after some time."""
    return seconds * (speed + seconds * (0.5 * acceleration + seconds * jerk / 6.0))


@inner
def time_of(way: float, within: float, speed: float, acceleration: float, jerk: float) -> float:
    """Seconds, at most ``within``, after which a way is done along which the speed is nowhere below zero."""
    low, high = 0.0, within
    time = min(way / speed, within) if speed > 0.0 else 0.5 * within
    for _ in range(80):
        over = way_of(time, speed, acceleration, jerk) - way
        if over > 0.0:
            high = time
        else:
            low = time
        slope = speed + time * (acceleration + 0.5 * time * jerk)
        better = time - over / slope if slope > 0.0 else 0.5 * (low + high)
        if not low < better < high:
            better = 0.5 * (low + high)
        if abs(better - time) <= 1e-15 * within:
            return better
        time = better
    return time
