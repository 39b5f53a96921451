"""The fastest run along a smooth path within speed, acceleration and jerk of all axes, at rest at both ends.

This is the mode without a control's habits: no blocks, no corners, no look-ahead. What a control does is timed by
``planner``.
Units: mm and degrees (or whatever the path and the limits agree on), seconds. Needs SciPy.
"""

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.records import dataclass
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.fastest_program import MotionLimits, SquareRates, faster

#: Coarser solutions to start from, each with half of the pieces.
_COARSER: Final = 2

#: A further linear program must save more than this share of the time, or it was the last one.
_LEAST_GAIN: Final = 3e-5
_MOST_PROGRAMS: Final = 40

#: Places in each piece at which the result is measured, ends included.
_MEASURED: Final = 65

#: A run may be beyond a limit by this share before it is looked for again with lower limits there, so often at most.
_BEYOND: Final = 1e-3
_MOST_TIGHTENED: Final = 6

#: Parameters that differ by no more than this share of the whole are the same.
_SAME: Final = 1e-14

#: Nodes of the quadrature that makes seconds of rates; its error is that of rounding.
_NODES: Final = 12


@dataclass(frozen=True, slots=True, eq=False)
class SmoothPath:
    """Axis values as a function of a parameter.

    derivatives  of parameters (n,) and flags (n,): axis values and their first three derivatives by the parameter,
                 (4, n, axes); where one has a step, a flag asks for its value before it
    breaks       (k,) ascending: the begin, the places at which the third derivative has steps, the end. Positions and
                 the first two derivatives have none.
    """

    derivatives: Callable[[Floats, Flags], Floats]
    breaks: Floats


@dataclass(frozen=True, slots=True, eq=False)
class AxisMotion:
    """Positions, velocities, accelerations and jerks of the axes at n moments, (n, axes) each; parameter (n,)."""

    parameter: Floats
    position: Floats
    velocity: Floats
    acceleration: Floats
    jerk: Floats


@dataclass(frozen=True, slots=True, eq=False)
class FastestRun:
    """A path as motion in time.

    path      that is run
    duration  seconds
    edges     (m + 1,) places from 0 to 1 at which pieces of the rate begin and end
    begins    (m + 1,) seconds at which they are reached
    """

    path: SmoothPath
    duration: float
    edges: Floats
    begins: Floats
    _square: Any

    def at(self, seconds: Floats) -> AxisMotion:
        """Return the motion at any times from 0 to ``duration``, by exact derivatives; at a step of the jerk that after
        it.
        """
        seconds = np.clip(np.asarray(seconds, float), 0.0, self.duration)
        place = self._places(seconds)
        last = place >= self.edges[-1]
        inside = np.where(last, np.nextafter(self.edges[-1], 0.0), place)
        square, slope, bend = (self._square(inside, order) for order in range(3))
        parameter, q = warped(self.path, place, last)
        rate = np.sqrt(square)[:, None]
        square, slope, bend = square[:, None], slope[:, None], bend[:, None]
        return AxisMotion(
            parameter,
            q[0],
            q[1] * rate,
            q[2] * square + 0.5 * q[1] * slope,
            (q[3] * square + 1.5 * q[2] * slope + 0.5 * q[1] * bend) * rate,
        )

    def _places(self, seconds: Floats) -> Floats:
        """Places (n,) that are reached at these times: Newton's method, kept within each piece by bisection."""
        piece = np.clip(np.searchsorted(self.begins, seconds, side="right") - 1, 0, len(self.edges) - 2)
        low, high = self.edges[piece], self.edges[piece + 1]
        begin, left = low, seconds - self.begins[piece]
        place = low + (high - low) * np.clip(left / np.diff(self.begins)[piece], 0.0, 1.0)
        for _ in range(60):
            error = _seconds_between(self._square, begin, place) - left
            low, high = np.where(error <= 0.0, place, low), np.where(error >= 0.0, place, high)
            step = error * np.sqrt(self._square(place))
            if float(np.abs(step).max(initial=0.0)) < 1e-14:
                break
            newton = place - step
            place = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
        return place


def fastest_run(path: SmoothPath, limits: AxisDynamics, pieces: int = 200) -> FastestRun:
    """Find the fastest run that no axis is beyond its limits in, from rest to rest.

    The unknown is b, the square of the rate at which the parameter goes on, as a cubic spline of the parameter. Speeds
    limit b, accelerations are linear in b and b' (D. Verscheure et al., IEEE Trans. Automatic Control 54, 2009). A
    jerk is (q''' b + 3/2 q'' b' + 1/2 q' b'') sqrt(b), so that |q''' b + ...| <= J / sqrt(b); a tangent of the right
    side lies below it, as it is convex. With tangents at a run that keeps all limits, a linear program finds a faster
    one that keeps them too, and so on. At rest b would go to zero with the power 4/3; so the parameter is warped to go
    with the cube at both ends, where its rate needs no zero then. The result is one from which no small change is
    faster, measured densely and slowed down by what it is beyond a limit between the places of the programs.

    path    some axis must move everywhere
    limits  those that are infinite do not count. Some axis needs a jerk
    pieces  on about so many pieces of the path the square of the rate is one polynomial; a path of many bends needs
            more

    Raises ``InputError`` if SciPy is not installed.

    Raises ``ValueError`` if no jerk is limited, a limit is not positive, breaks do not ascend, or the path does not
    move or is not finite.
    """
    table = np.stack((limits.speed, limits.acceleration, limits.jerk))
    if not (table > 0.0).all():
        raise ValueError("limits must be positive")
    if not limits.has_jerk:
        raise ValueError("no axis has a limit of its jerk")
    if len(path.breaks) < 2 or not (np.diff(path.breaks) > 0.0).all():
        raise ValueError("breaks must ascend")
    breaks = _unwarp((path.breaks - path.breaks[0]) / (path.breaks[-1] - path.breaks[0]))
    rates, coefficients, unit = None, np.zeros(0), 1.0
    for level in range(_COARSER, -1, -1):
        edges = _edges(breaks, max(pieces >> level, 1))
        finer = SquareRates.of(edges, breaks)
        places, before = finer.places()
        motion = MotionLimits.of(warped(path, places, before)[1], finer.matrices(), table)
        if rates is None:
            # One rate everywhere, as fast as its worst place; its time is the unit, so that numbers are near 1.
            coefficients = np.ones(finer.count)
            unit = motion.excess(coefficients)
            if not (math.isfinite(unit) and unit > 0.0):
                raise ValueError("the path does not move, or is not finite")
        else:
            coefficients = np.asarray(rates.spline(coefficients)(finer.middles()))
        motion = motion.in_unit(unit)
        rates = finer
        coefficients = faster(rates, motion, coefficients, _LEAST_GAIN, _MOST_PROGRAMS)
    assert rates is not None
    square = rates.spline(_within_limits(path, rates, motion, (coefficients, unit), table))
    taken = _seconds_between(square, rates.edges[:-1], rates.edges[1:])
    begins = np.concatenate(([0.0], np.cumsum(taken)))
    return FastestRun(path, float(begins[-1]), rates.edges, begins, square)


def warped(path: SmoothPath, places: Floats, before: Flags) -> tuple[Floats, Floats]:
    """Parameters (n,), and axis values with three derivatives (4, n, axes) by places from 0 to 1, at such places."""
    scale = path.breaks[-1] - path.breaks[0]
    w = places
    share = w**3 * (10.0 - 15.0 * w + 6.0 * w * w)
    parameter = path.breaks[0] + scale * share
    # A place at a break must not fall to the other side of it by rounding.
    nearest = path.breaks[np.searchsorted(0.5 * (path.breaks[1:] + path.breaks[:-1]), parameter)]
    parameter = np.where(np.abs(parameter - nearest) <= _SAME * scale, nearest, parameter)
    q = path.derivatives(parameter, before)
    d1 = (scale * 30.0 * w**2 * (1.0 - w) ** 2)[:, None]
    d2 = (scale * 60.0 * w * (1.0 - w) * (1.0 - 2.0 * w))[:, None]
    d3 = (scale * 60.0 * (1.0 - 6.0 * w + 6.0 * w * w))[:, None]
    return parameter, np.stack(
        (q[0], q[1] * d1, q[2] * d1**2 + q[1] * d2, q[3] * d1**3 + 3.0 * q[2] * d1 * d2 + q[1] * d3)
    )


def _unwarp(share: Floats) -> Floats:
    """Places from 0 to 1 of shares of the parameter, by bisection."""
    low, high = np.zeros(len(share)), np.ones(len(share))
    for _ in range(60):
        w = 0.5 * (low + high)
        under = w**3 * (10.0 - 15.0 * w + 6.0 * w * w) < share
        low, high = np.where(under, w, low), np.where(under, high, w)
    found = 0.5 * (low + high)
    found[0], found[-1] = 0.0, 1.0
    return found


def _edges(breaks: Floats, pieces: int) -> Floats:
    """Return ends of about so many pieces as even as breaks let them be, none of which contains a break."""
    counts = np.maximum(np.ceil(np.diff(breaks) * pieces - 1e-9), 1.0).astype(int)
    parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(breaks[:-1], breaks[1:], counts, strict=True)]
    return np.concatenate((*parts, breaks[-1:]))


def _within_limits(
    path: SmoothPath, rates: SquareRates, motion: MotionLimits, found: tuple[Floats, float], table: Floats
) -> Floats:
    """Coefficients of a run that keeps all limits, also between the places of the programs, in seconds.

    ``found``: those of the programs, and the unit of their time. A run that is beyond a limit within some pieces, as at
    the ends of a long way with short ramps, is looked for again with limits that are lower in these pieces: to stretch
    the whole would make all of it slower.
    """
    coefficients, unit = found
    least, best = math.inf, coefficients
    for _ in range(_MOST_TIGHTENED):
        shares = _measured_shares(path, rates, coefficients / unit**2, table)
        excess = _excess(shares)
        slowed = coefficients / (unit * excess) ** 2
        seconds = float(_seconds_between(rates.spline(slowed), rates.edges[:-1], rates.edges[1:]).sum())
        if seconds < least:
            least, best = seconds, slowed
        if excess <= 1.0 + _BEYOND:
            break
        motion = motion.tightened(np.maximum(shares, 1.0))
        coefficients = faster(rates, motion, coefficients, _LEAST_GAIN, _MOST_PROGRAMS)
    return best


def _excess(shares: Floats) -> float:
    """By what time must be stretched for shares of speed, acceleration and jerk (3, …)."""
    return max(math.pow(share.max(), 1.0 / order) for order, share in enumerate(shares, 1)) * (1.0 + 1e-9)


def _measured_shares(path: SmoothPath, rates: SquareRates, coefficients: Floats, table: Floats) -> Floats:
    """Greatest shares of speed, acceleration and jerk in each piece, (3, pieces).

    Measured at many places of each piece; between them a value is above the higher of both by an eighth of its second
    difference at most, of which twice as much is added.
    """
    places, before = rates.places(even=_MEASURED)
    q = warped(path, places, before)[1]
    shares = MotionLimits.of(q, rates.matrices(even=_MEASURED), table).shares(coefficients)
    worst = np.empty((3, len(rates.edges) - 1))
    for k, share in enumerate(shares):
        pieces = share.reshape(worst.shape[1], _MEASURED, -1)
        bends = np.abs(np.diff(pieces, 2, axis=1))
        margin = np.pad(bends, ((0, 0), (1, 1), (0, 0)), mode="edge") / 4.0
        worst[k] = (np.abs(pieces) + margin).max(axis=(1, 2))
    return worst


def _seconds_between(square: Any, begin: Floats, end: Floats) -> Floats:
    """Seconds from one place to another of the same piece, (n,)."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * (end - begin)[:, None]
    there = begin[:, None] + half * (1.0 + nodes)
    values = np.asarray(square(there.ravel())).reshape(there.shape)
    return np.asarray((half * weights / np.sqrt(values)).sum(axis=1))
