"""The speed of a run along its path, as a control plans it: within what program and axes allow, looking ahead.

Without jerks speeds change evenly (``speed_kernel``); where a jerk is stated they change by S-curves (``jerk_kernel``).
Units: mm and degrees, seconds.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.records import dataclass
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.jerk_kernel import fill_stretches, lower_nodes
from trunnion.timing.path import Path
from trunnion.timing.phase_kernel import check_nodes, run_stretches
from trunnion.timing.speed_kernel import ACCELERATION, BEGIN, CORNER, END, TOP, fill_reached, plan_speeds

#: After so many looks for nodes that are passed too fast all nodes of such curves are passed without acceleration.
_MOST_ATTEMPTS: Final = 6


@dataclass(frozen=True, slots=True, eq=False)
class PieceTimes:
    """The m pieces of a path in time; 0 in those without motion.

    seconds  (m,)
    reached  (m,)  highest speed along the piece, per second, the corners at its ends included
    """

    seconds: Floats
    reached: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Phases:
    """p phases in time, each with an even jerk in one piece of a path; none of them without time.

    piece         (p,)
    seconds       (p,)  that it takes
    done          (p,)  way of the piece where it begins
    speed, acceleration, jerk  (p,)  there, along the path
    """

    piece: Ints
    seconds: Floats
    done: Floats
    speed: Floats
    acceleration: Floats
    jerk: Floats


def piece_seconds(path: Path, dynamics: AxisDynamics) -> Floats:
    """Seconds of each piece of a path that begins and ends at rest, (m,); 0 without motion."""
    return timed_pieces(path, dynamics).seconds if dynamics.has_jerk else _planned(path, dynamics)[1]


def timed_pieces(path: Path, dynamics: AxisDynamics) -> PieceTimes:
    """Return the pieces of a path that begins and ends at rest."""
    if dynamics.has_jerk:
        return _with_jerk(path, dynamics, phases=False)[0]
    columns, seconds = _planned(path, dynamics)
    reached = np.empty(len(seconds))
    fill_reached(path.length, columns, reached)
    return PieceTimes(seconds, reached)


def plan(path: Path, dynamics: AxisDynamics) -> tuple[Floats, Phases]:
    """Seconds of each piece of a path, (m,), and the phases in which it is run."""
    if dynamics.has_jerk:
        times, phases = _with_jerk(path, dynamics, phases=True)
        return times.seconds, phases
    columns, seconds = _planned(path, dynamics)
    return seconds, _even_phases(path.length, columns)


def _planned(path: Path, dynamics: AxisDynamics) -> tuple[Floats, Floats]:
    m = len(path.length)
    columns, seconds = np.zeros((m, 5)), np.zeros(m)
    limits = np.stack((dynamics.speed, dynamics.acceleration))
    plan_speeds(
        path.steps, path.length, path.rate / 60.0, path.tolerance, path.stops_after, path.bends_after, limits, columns,
        seconds,
    )  # fmt: skip
    return columns, seconds


def _with_jerk(path: Path, dynamics: AxisDynamics, *, phases: bool) -> tuple[PieceTimes, Phases]:
    m = len(path.length)
    limits = np.stack((dynamics.speed, dynamics.acceleration, dynamics.jerk))
    _, piece, caps, _ = _stretches(path, limits, np.zeros(0))
    reached = np.zeros(m)
    reached[piece] = caps[1:]
    stretch, piece, caps, passed = _stretches(path, limits, reached)
    times = PieceTimes(np.zeros(m), np.zeros(m))
    found = run_stretches(stretch, piece, caps, passed, times.seconds, times.reached, np.empty((0, 6)))
    table = np.empty((found if phases else 0, 6))
    if phases:
        run_stretches(stretch, piece, caps, passed, np.zeros(m), np.zeros(m), table)
    return times, Phases(table[:, 0].astype(np.int64), *table[:, 1:].T)


def _stretches(path: Path, limits: Floats, reached: Floats) -> tuple[Floats, Ints, Floats, Flags]:
    """Return the stretches of a path, the piece of each, the speeds at their ends, and which of them need no
    acceleration.

    ``reached`` are speeds at most at the ends of pieces, or nothing: then corners have no length.
    """
    m = len(path.length)
    stretch, piece, caps = np.empty((3 * m, 4)), np.empty(3 * m, np.int64), np.full(3 * m + 1, np.inf)
    count = fill_stretches(
        path.steps, path.length, path.rate / 60.0, path.tolerance, path.stops_after, path.bends_after, limits, reached,
        stretch, piece, caps,
    )  # fmt: skip
    stretch, allowed = stretch[:count], caps[: count + 1]
    passed, must = np.zeros(count + 1, np.bool_), np.zeros(count + 1, np.bool_)
    for attempt in range(_MOST_ATTEMPTS + 1):
        caps = allowed.copy()
        lower_nodes(stretch, must, caps, passed)
        if not check_nodes(stretch, caps, passed, allowed, attempt >= _MOST_ATTEMPTS - 1, must):
            break
    return stretch, piece[:count], caps, passed


def _even_phases(length: Floats, columns: Floats) -> Phases:
    """Return the phases of a plan without jerks: half a corner, up, evenly, down, half a corner."""
    piece = np.flatnonzero(columns[:, ACCELERATION] > 0.0)
    corner, begin, end, top, acceleration = (columns[piece, k] for k in (CORNER, BEGIN, END, TOP, ACCELERATION))
    before, b_before = np.zeros(len(piece)), begin.copy()
    if len(piece):
        before[1:], b_before[1:] = corner[:-1], 0.5 * (begin[1:] + end[:-1])
    b_after = np.append(b_before[1:], end[-1:])
    straight = length[piece] - before - corner
    straight[straight <= 1e-12 * length[piece]] = 0.0
    with np.errstate(invalid="ignore", divide="ignore"):
        peak = np.maximum(np.minimum(top, acceleration * straight + 0.5 * (begin + end)), np.maximum(begin, end))
        ramps = (straight > 0.0) & np.isfinite(acceleration)
        up, down = (np.where(ramps, (peak - each) / (2.0 * acceleration), 0.0) for each in (begin, end))
        even = np.maximum(straight - up - down, 0.0)
        ways = np.stack((before, up, even, down, corner), axis=1)
        b_first = np.stack((b_before, begin, peak, peak, end), axis=1)
        b_last = np.stack((begin, peak, peak, end, b_after), axis=1)
        first = np.sqrt(b_first)
        both = first + np.sqrt(b_last)
        seconds = np.where((ways > 0.0) & (both > 0.0), 2.0 * ways / both, 0.0)
        rising = np.where(seconds > 0.0, (b_last - b_first) / (2.0 * ways), 0.0)
        rising[:, 1], rising[:, 2], rising[:, 3] = acceleration, 0.0, -acceleration
    done = np.cumsum(ways, axis=1) - ways
    runs = seconds > 0.0
    return Phases(
        np.repeat(piece, 5).reshape(-1, 5)[runs], seconds[runs], done[runs], first[runs], rising[runs],
        np.zeros(int(runs.sum())),
    )  # fmt: skip
