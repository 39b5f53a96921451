"""The speeds on a path, by lowering what is too fast until nothing is: slow, and without a thought of any order.

The same physics as ``trunnion.timing.speed_kernel``, written down once more: a row of squared speeds at the borders of
straight parts and corners, and for each of these what the speed at one border allows at the other.
"""

from collections.abc import Callable
from itertools import pairwise
from math import inf, sqrt

from trunnion.timing import AxisDynamics, Path

#: What a squared speed at one border allows at the other.
Allows = Callable[[float], float]


def naive_seconds(path: Path, dynamics: AxisDynamics) -> list[float]:
    """Seconds of each piece."""
    moving = [i for i, step in enumerate(path.steps) if abs(step).max() > 0.0 and path.length[i] > 0.0]
    seconds = [0.0] * len(path.length)
    if not moving:
        return seconds
    direction = {i: [float(v) / float(path.length[i]) for v in path.steps[i]] for i in moving}
    tops, ramps = {}, {}
    for i in moving:
        shares = [abs(v) for v in direction[i]]
        speeds = [float(dynamics.speed[k]) / c for k, c in enumerate(shares) if c > 0.0]
        tops[i] = min([float(path.rate[i]) / 60.0, *speeds]) ** 2
        ramps[i] = min(float(dynamics.acceleration[k]) / c for k, c in enumerate(shares) if c > 0.0)
    joints = list(pairwise(moving))
    halves = [_half(path, direction, one, two) for one, two in joints]
    sharp = _relaxed(path, dynamics, moving, direction, tops, ramps, halves, [0.0] * len(halves))
    reached = [sharp[2 * k + 1] for k in range(len(joints))]
    for k, (one, two) in enumerate(joints):
        if halves[k] is not None:
            needed = [
                reached[k] * abs(q - p) / (2.0 * float(a))
                for p, q, a in zip(direction[one], direction[two], dynamics.acceleration, strict=True)
            ]
            halves[k] = min(halves[k] or 0.0, max(needed))
    lengths = [half or 0.0 for half in halves]
    squares = _relaxed(path, dynamics, moving, direction, tops, ramps, halves, lengths, reached)
    for at, i in enumerate(moving):
        before, after = lengths[at - 1] if at else 0.0, lengths[at] if at < len(lengths) else 0.0
        begin, end = squares[2 * at], squares[2 * at + 1]
        if before > 0.0:
            seconds[i] += 2.0 * before / (sqrt(0.5 * (squares[2 * at - 1] + begin)) + sqrt(begin))
        if after > 0.0:
            seconds[i] += 2.0 * after / (sqrt(0.5 * (end + squares[2 * at + 2])) + sqrt(end))
        way = float(path.length[i]) - before - after
        if way > 1e-12 * float(path.length[i]):
            peak = min(tops[i], ramps[i] * way + 0.5 * (begin + end))
            even = way - (2.0 * peak - begin - end) / (2.0 * ramps[i])
            seconds[i] += (2.0 * sqrt(peak) - sqrt(begin) - sqrt(end)) / ramps[i] + max(even, 0.0) / sqrt(peak)
    return seconds


def _half(path: Path, direction: dict[int, list[float]], one: int, two: int) -> float | None:
    """Half of the longest corner between two pieces; 0 where they are in line, None where the axes stop."""
    if path.stops_after[one:two].any():
        return None
    turned = max(abs(q - p) for p, q in zip(direction[one], direction[two], strict=True))
    if turned <= 1e-12:
        return 0.0
    if path.tolerance[one] == 0.0:
        return None
    shorter = min(float(path.length[one]), float(path.length[two]))
    return min(0.5 * shorter, 4.0 * float(path.tolerance[one]) / turned)


def _relaxed(
    path: Path,
    dynamics: AxisDynamics,
    moving: list[int],
    direction: dict[int, list[float]],
    tops: dict[int, float],
    ramps: dict[int, float],
    halves: list[float | None],
    lengths: list[float],
    caps: list[float] | None = None,
) -> list[float]:
    """Squared speeds where straight parts begin and end, 2 for each piece that moves."""
    squares = [tops[i] for i in moving for _ in range(2)]
    squares[0] = squares[-1] = 0.0
    allows: list[Allows] = []
    for at, i in enumerate(moving):
        way = float(path.length[i]) - (lengths[at - 1] if at else 0.0) - (lengths[at] if at < len(lengths) else 0.0)
        way = way if way > 1e-12 * float(path.length[i]) else 0.0
        allows.append(lambda b, a=ramps[i], s=way: b + 2.0 * a * s if s > 0.0 else b)  # type: ignore[misc]
        if at == len(lengths):
            break
        one, two = direction[i], direction[moving[at + 1]]
        limits = [
            (max(abs(p), abs(q)), abs(q - p), float(a))
            for p, q, a in zip(one, two, dynamics.acceleration, strict=True)
        ]  # fmt: skip
        cap = inf if caps is None else caps[at]
        half = halves[at]
        if half is None:
            cap = 0.0
        elif caps is None and half > 0.0:
            cap = min(2.0 * half * a / turn for _, turn, a in limits if turn > 0.0)
        for border in (2 * at + 1, 2 * at + 2):
            squares[border] = min(squares[border], cap)
        h = lengths[at]
        allows.append(
            lambda b, h=h, limits=limits: (  # type: ignore[misc]
                min((4.0 * h * a + c * b) / (c + 2.0 * turn) for c, turn, a in limits if c > 0.0) if h > 0.0 else b
            )
        )
    changed = True
    while changed:
        changed = False
        for k, allowed in enumerate(allows):
            for one_end, other in ((k, k + 1), (k + 1, k)):
                least = allowed(squares[one_end])
                if least < squares[other] * (1.0 - 1e-14):
                    squares[other], changed = least, True
    return squares
