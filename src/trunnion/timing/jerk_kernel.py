"""The run of a path under jerks of its axes as well: its speed goes from one speed to the next by S-curves.

A path is a row of stretches, each with a greatest speed, acceleration and jerk along it, and of the nodes between them.
From a node that is passed at a speed v without acceleration, no node at the distance d is passed without acceleration
faster than by one S-curve over d, with the least acceleration and jerk of the stretches between. Nodes are taken in the
order of what they allow: one that no S-curve from a slower node has lowered is passed at the speed that it allows,
without acceleration, and lowers those around it. Between two nodes of this kind the path is run by the seven phases of
the textbook: up by an S-curve, evenly, and down by one. So jerk and acceleration along the path are within the least
limits between the two. Where such a curve goes through another node faster than that allows (``check_nodes``), the node
is to be passed without acceleration too, and all is done again.

In a corner the direction changes by d over its length 2 h as fast as a triangle rises and falls, which departs from it
by d h / 6 and needs the acceleration d v^2 / h and the jerk d v^3 / h^2. Where a ramp leads through a corner, its third
part of an axis' jerk is

    c j            of the ramp
    3 d v a / h    of ramp and corner together
    d v^3 / h^2    of the corner

each at most a third of the limit; acceleration is shared by halves.

Points that lie so close that such triangles, as wide as the pieces, are within the tolerance are those of a smooth
curve, and so are those within a row: it bends by k = 2 d / (l1 + l2), evenly from point to point, and needs the
acceleration k v^2 and the jerk v^3 times the change of k over the way between two points. A step of k is spread over
the way s over which the path departs by no more than the tolerance, k s^2 / 24, as at the begin of any transition
curve.

Units: mm and degrees, seconds.
"""

import math
from heapq import heapify, heappop, heappush

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.timing.s_curves import reach


@kernel(writes="stretch piece caps")
def fill_stretches(
    steps: Floats2,
    length: Floats,
    rate: Floats,
    tolerance: Floats,
    stops_after: Flags,
    bends_after: Flags,
    limits: Floats2,
    reached: Floats,
    stretch: Floats2,
    piece: Ints,
    caps: Floats,
) -> int:
    """Fill the stretches of m pieces, of which each has up to three, and return their number, s.

    reached  (m,)       speeds at most at the end of pieces, for which corners are long enough; empty: nobody knows, and
                        corners have no length
    stretch  (3 m, 4)   length; greatest speed, acceleration and jerk along it
    piece    (3 m,)     the piece of each
    limits   (3, 5)     speeds, accelerations and jerks of the axes
    caps     (3 m + 1,) the speeds that nodes allow: before the first stretch, and after each
    """
    count, last, stopped, before = 0, -1, False, 0.0
    caps[0] = 0.0
    bounds = np.empty((2, 3))
    bends = np.zeros((2, 5))
    for at in range(steps.shape[0]):
        if not _moves(steps, length, at):
            stopped = stopped or stops_after[at]
            continue
        half, bends[1, :] = 0.0, 0.0
        if last >= 0:
            bounds[0, 0] = 0.0
            if not stopped:
                speed = reached[last] if reached.shape[0] > 0 else np.inf
                allowed = np.inf if bends_after[last] else tolerance[last]
                half = _corner(steps, length, last, at, allowed, limits, rate, speed, bounds[0], bends[1])
                half = half if reached.shape[0] > 0 else 0.0
            _bend(steps, length, last, tolerance[last], limits, bends, bounds[1])
            count = _close(stretch, piece, caps, count, last, length[last] - before - half, half, bounds)
            caps[count] = min(caps[count], bounds[0, 0])
            if half > 0.0:
                count = _append(stretch, piece, caps, count, at, half, bounds[0])
        _straight(steps, length, rate, limits, at, bounds[1])
        bends[0] = bends[1]
        before, last, stopped = half, at, stops_after[at]
    if last >= 0:
        bends[1, :] = 0.0
        _bend(steps, length, last, tolerance[last], limits, bends, bounds[1])
        count = _close(stretch, piece, caps, count, last, length[last] - before, 0.0, bounds)
        caps[count] = 0.0
    return count


@inner
def _bend(
    steps: Floats2, length: Floats, at: int, tolerance: float, limits: Floats2, bends: Floats2, bounds: Floats
) -> None:
    """Lower what a piece between points of a smooth curve allows, which bends by ``bends`` at its two ends."""
    bent = 0.0
    for k in range(5):
        change = abs(bends[1, k] - bends[0, k])
        bent = max(bent, abs(bends[0, k]), abs(bends[1, k]))
        if change > 0.0:
            way = max(length[at], math.sqrt(24.0 * tolerance / change))
            bounds[0] = min(bounds[0], (limits[2, k] / 3.0 * way / change) ** (1.0 / 3.0))
    if bent == 0.0:
        return
    for k in range(5):
        bend = max(abs(bends[0, k]), abs(bends[1, k]))
        if bend > 0.0:
            bounds[0] = min(bounds[0], math.sqrt(0.5 * limits[1, k] / bend))
    for k in range(5):
        c, v = abs(steps[at, k]) / length[at], bounds[0]
        bend, change = max(abs(bends[0, k]), abs(bends[1, k])), abs(bends[1, k] - bends[0, k])
        if c > 0.0:
            way = max(length[at], math.sqrt(24.0 * tolerance / change)) if change > 0.0 else 1.0
            bounds[1] = min(bounds[1], (limits[1, k] - bend * v * v) / c)
            bounds[2] = min(bounds[2], (limits[2, k] / 1.5 - change * v * v * v / way) / c)
        if bend > 0.0 and v > 0.0:
            bounds[1] = min(bounds[1], limits[2, k] / (9.0 * bend * v))


@inner
def _moves(steps: Floats2, length: Floats, at: int) -> bool:
    """Whether a piece takes time."""
    largest = 0.0
    for k in range(5):
        largest = max(largest, abs(steps[at, k]))
    return largest > 0.0 and length[at] > 0.0


@inner
def _close(
    stretch: Floats2, piece: Ints, caps: Floats, count: int, at: int, straight: float, half: float, bounds: Floats2
) -> int:
    """Append the straight part of a piece, and the half of the corner after it."""
    if straight > 0.0:
        count = _append(stretch, piece, caps, count, at, straight, bounds[1])
    if half > 0.0:
        count = _append(stretch, piece, caps, count, at, half, bounds[0])
    return count


@inner
def _append(stretch: Floats2, piece: Ints, caps: Floats, count: int, at: int, way: float, bounds: Floats) -> int:
    """Append a stretch."""
    stretch[count, 0] = way
    stretch[count, 1], stretch[count, 2], stretch[count, 3] = bounds[0], bounds[1], bounds[2]
    piece[count] = at
    caps[count] = min(caps[count], bounds[0])
    caps[count + 1] = bounds[0]
    return count + 1


@inner
def _straight(steps: Floats2, length: Floats, rate: Floats, limits: Floats2, at: int, bounds: Floats) -> None:
    """Fill what the straight part of a piece allows: speed, acceleration, jerk."""
    bounds[0], bounds[1], bounds[2] = rate[at], np.inf, np.inf
    for k in range(5):
        share = abs(steps[at, k]) / length[at]
        if share > 0.0:
            for order in range(3):
                bounds[order] = min(bounds[order], limits[order, k] / share)


@inner
def _corner(
    steps: Floats2,
    length: Floats,
    one: int,
    two: int,
    tolerance: float,
    limits: Floats2,
    rate: Floats,
    reached: float,
    bounds: Floats,
    bends: Floats,
) -> float:
    """Return half the length of a corner, and fill what it allows; 0 for a point of a smooth curve: ``bends`` there."""
    turned = 0.0
    speed = min(rate[one], rate[two])
    for k in range(5):
        p, q = steps[one, k] / length[one], steps[two, k] / length[two]
        turned, c = max(turned, abs(q - p)), max(abs(p), abs(q))
        if c > 0.0:
            speed = min(speed, limits[0, k] / c)
    bounds[0], bounds[1], bounds[2] = speed, np.inf, np.inf
    if not turned > 1e-12:
        return 0.0
    short, long = min(length[one], length[two]), max(length[one], length[two])
    if long <= 4.0 * short and long * turned <= 6.0 * tolerance:
        for k in range(5):
            bends[k] = 2.0 * (steps[two, k] / length[two] - steps[one, k] / length[one]) / (short + long)
        return 0.0
    half: float = min(0.5 * short, 6.0 * tolerance / turned)
    if not half > 0.0:
        bounds[0] = 0.0
        return 0.0
    for k in range(5):
        turn = abs(steps[two, k] / length[two] - steps[one, k] / length[one])
        if turn > 0.0:
            bounds[0] = min(bounds[0], math.sqrt(0.5 * limits[1, k] * half / turn))
            bounds[0] = min(bounds[0], (limits[2, k] / 3.0 * half * half / turn) ** (1.0 / 3.0))
    v, needed = min(bounds[0], reached), 0.0
    for k in range(5):
        turn = abs(steps[two, k] / length[two] - steps[one, k] / length[one])
        needed = max(needed, 2.0 * turn * v * v / limits[1, k], math.sqrt(3.0 * turn * v * v * v / limits[2, k]))
    half = min(half, needed)
    bounds[0] = v
    if not half > 0.0:
        return 0.0
    for k in range(5):
        p, q = steps[one, k] / length[one], steps[two, k] / length[two]
        c, turn = max(abs(p), abs(q)), abs(q - p)
        if c > 0.0:
            bounds[1] = min(bounds[1], (limits[1, k] - turn * v * v / half) / c)
            bounds[2] = min(bounds[2], (limits[2, k] / 1.5 - turn * v * v * v / (half * half)) / c)
        if turn > 0.0 and v > 0.0:
            bounds[1] = min(bounds[1], limits[2, k] * half / (9.0 * turn * v))
    return half


@kernel(writes="caps passed")
def lower_nodes(stretch: Floats2, must: Flags, caps: Floats, passed: Flags) -> None:
    """Lower the ``caps`` (s + 1,) of nodes to what S-curves from slower ones leave, and fill ``passed``.

    must    (s + 1,)  nodes that are to be passed without acceleration
    passed  (s + 1,)  nodes that are
    """
    allowed, least = caps.copy(), np.array([0.0, np.inf, np.inf])
    for k in range(stretch.shape[0]):
        least[1], least[2] = min(least[1], stretch[k, 2]), min(least[2], stretch[k, 3])
    waiting = [(caps[node], node) for node in range(caps.shape[0])]
    for node in range(caps.shape[0]):
        least[0] = max(least[0], caps[node])
        passed[node] = False
        if must[node]:
            allowed[node] = -1.0
    heapify(waiting)
    while len(waiting) > 0:
        speed, node = heappop(waiting)
        if passed[node] or speed > caps[node] or speed < allowed[node]:
            continue
        passed[node] = True
        for way in range(-1, 2, 2):
            end = _lower(stretch, caps, passed, allowed, node, way, least)
            if end >= 0:
                allowed[end] = -1.0
                heappush(waiting, (caps[end], end))


@inner
def _lower(stretch: Floats2, caps: Floats, passed: Flags, allowed: Floats, node: int, way: int, least: Floats) -> int:
    """Lower what is around a node, one way; returns a node that is to be passed without acceleration, or -1.

    ``least``: the greatest speed of all, and the least acceleration and jerk.
    """
    distance, acceleration, jerk = 0.0, np.inf, np.inf
    at, count = node, 0
    while 0 <= at + way < caps.shape[0]:
        between = at if way > 0 else at - 1
        at += way
        distance += stretch[between, 0]
        acceleration, jerk = min(acceleration, stretch[between, 2]), min(jerk, stretch[between, 3])
        if passed[at]:
            return -1
        caps[at] = min(caps[at], reach(caps[node], distance, acceleration, jerk))
        count += 1
        if count == 500 or allowed[at] < 0.0:
            return at
        if reach(caps[node], distance, least[1], least[2]) >= least[0]:
            return -1
    return -1
