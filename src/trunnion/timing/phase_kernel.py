"""The phases in which a path is run, between the nodes that are passed without acceleration.

Units: mm and degrees, seconds.
"""

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.timing.s_curves import fill_ramp, peak, ramp_way, time_of, way_of


@kernel(writes="seconds reached phases")
def run_stretches(
    stretch: Floats2,
    piece: Ints,
    caps: Floats,
    passed: Flags,
    seconds: Floats,
    reached: Floats,
    phases: Floats2,
) -> int:
    """Add the ``seconds`` (m,) of pieces, raise the highest speeds ``reached`` (m,) in them, and fill ``phases``.

    As many phases are filled as there is room for; their number is returned.

    stretch, piece, caps, passed   as ``jerk_kernel`` has made them
    phases  (p, 6)  piece; seconds; way of the piece that is done where the phase begins, and speed, acceleration and
                    jerk there
    """
    curve = np.empty((7, 4))
    count, first, at = 0, 0, 0
    stretch_done, piece_done = 0.0, 0.0
    for node in range(1, caps.shape[0]):
        if not passed[node]:
            continue
        parts = _curve(stretch, first, node, caps[first], caps[node], curve)
        for part in range(parts):
            left, speed, acceleration, jerk = curve[part, 0], curve[part, 1], curve[part, 2], curve[part, 3]
            while left > 0.0:
                takes, leaves = left, False
                if at < node - 1:
                    room = stretch[at, 0] - stretch_done
                    leaves = way_of(left, speed, acceleration, jerk) > room
                    if leaves:
                        takes = time_of(max(room, 0.0), left, speed, acceleration, jerk) if room > 0.0 else 0.0
                if takes > 0.0:
                    if count < phases.shape[0]:
                        phases[count, 0], phases[count, 1], phases[count, 2] = piece[at], takes, piece_done
                        phases[count, 3], phases[count, 4], phases[count, 5] = speed, acceleration, jerk
                    count += 1
                    seconds[piece[at]] += takes
                    way = way_of(takes, speed, acceleration, jerk)
                    stretch_done += way
                    piece_done += way
                    # Within a phase the acceleration keeps its sign: the speed is highest at an end.
                    reached[piece[at]] = max(reached[piece[at]], speed)
                    speed += takes * (acceleration + 0.5 * takes * jerk)
                    acceleration += takes * jerk
                    left -= takes
                    reached[piece[at]] = max(reached[piece[at]], speed)
                if leaves:
                    at, stretch_done = at + 1, 0.0
                    piece_done = piece_done if piece[at] == piece[at - 1] else 0.0
        while at < node:  # what rounding has left ends here
            at, stretch_done = at + 1, 0.0
            if at < piece.shape[0] and piece[at] != piece[at - 1]:
                piece_done = 0.0
        first = node
    return count


@kernel(writes="must")
def check_nodes(stretch: Floats2, caps: Floats, passed: Flags, allowed: Floats, every: bool, must: Flags) -> int:
    """Mark nodes that are passed faster than is ``allowed`` (s + 1,), in each curve the worst; returns how many.

    every   all nodes within a curve that goes too fast are marked
    """
    curve = np.empty((7, 4))
    marked, first = 0, 0
    for node in range(1, caps.shape[0]):
        if not passed[node]:
            continue
        worst, greatest = -1, 1.0 + 1e-9
        parts = _curve(stretch, first, node, caps[first], caps[node], curve) if node > first + 1 else 0
        part, done, distance = 0, 0.0, 0.0
        for k in range(first + 1, node if parts > 0 else first):
            distance += stretch[k - 1, 0]
            way = way_of(curve[part, 0], curve[part, 1], curve[part, 2], curve[part, 3])
            while part < parts - 1 and done + way < distance:
                done, part = done + way, part + 1
                way = way_of(curve[part, 0], curve[part, 1], curve[part, 2], curve[part, 3])
            time = time_of(max(distance - done, 0.0), curve[part, 0], curve[part, 1], curve[part, 2], curve[part, 3])
            speed = curve[part, 1] + time * (curve[part, 2] + 0.5 * time * curve[part, 3])
            if speed > greatest * allowed[k]:
                worst, greatest = k, speed / allowed[k] if allowed[k] > 0.0 else np.inf
        if worst >= 0:
            for k in range(first + 1 if every else worst, node if every else worst + 1):
                must[k] = True
                marked += 1
        first = node
    return marked


@inner
def _curve(stretch: Floats2, first: int, node: int, begin: float, end: float, curve: Floats2) -> int:
    """Fill the seven phases between two nodes; returns how many there are."""
    distance, acceleration, jerk, top = 0.0, np.inf, np.inf, np.inf
    for k in range(first, node):
        distance += stretch[k, 0]
        acceleration, jerk = min(acceleration, stretch[k, 2]), min(jerk, stretch[k, 3])
    highest = max(begin, end)
    for _ in range(8):
        highest = peak(begin, end, distance, acceleration, jerk, top)
        if highest <= max(begin, end):
            break
        # Only the stretches in which it runs evenly, or turns from faster to slower, can be too slow for it.
        one = ramp_way(begin, highest, acceleration, jerk)
        two = distance - ramp_way(end, highest, acceleration, jerk)
        slowest, done = np.inf, 0.0
        for k in range(first, node):
            if done <= two and done + stretch[k, 0] >= one:
                slowest = min(slowest, stretch[k, 1])
            done += stretch[k, 0]
        if slowest >= highest * (1.0 - 1e-12):
            break
        top = slowest
        highest = max(begin, end)
    if not 0.0 < highest < np.inf:
        return 0
    count = fill_ramp(curve, 0, begin, highest, acceleration, jerk)
    even = distance - ramp_way(begin, highest, acceleration, jerk) - ramp_way(highest, end, acceleration, jerk)
    if even > 0.0:
        curve[count, 0], curve[count, 1], curve[count, 2], curve[count, 3] = even / highest, highest, 0.0, 0.0
        count += 1
    return fill_ramp(curve, count, highest, end, acceleration, jerk)
