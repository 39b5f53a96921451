"""A run as motion in time: where every axis is, and how fast, at any second of the program.

In:     a ``Run``, the lengths of its tools, and what the axes of its machine can do.
Out:    a ``TimedRun``.
Units:  mm and degrees, seconds; feeds in mm/min, spindle speeds in rev/min.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines.motion_time import row_seconds
from trunnion.model.run import Run, RunEvent
from trunnion.timing.axis_pieces import axis_pieces
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.row_feeds import RowFeeds

#: Events for which the axes stand still.
STOPS: Final = ("dwell", "stop", "tool_change", "end")

_ALL_LENGTHS: Final[Mapping[int, float]] = {}


@dataclass(frozen=True, slots=True)
class TimedEvent:
    """An event of a run in time: the second at which it happens, and how many seconds the axes wait for it."""

    seconds: float
    takes: float
    event: RunEvent


@dataclass(frozen=True, slots=True, eq=False)
class MachineState:
    """A machine at k times.

    joints    (k, 5)        axis values as displayed, with all turns; mm or deg, machine order
    velocity  (k, 5)        mm/s or deg/s
    row       (k,)  int64   row that is run, or was run last; -1 before the first
    tip_feed  (k,)          speed of the tip at the workpiece, mm/min
    rpm       (k,)          speed of the spindle, rev/min; negative counter-clockwise (M4)
    """

    joints: Floats
    velocity: Floats
    row: Ints
    tip_feed: Floats
    rpm: Floats


@dataclass(frozen=True, slots=True, eq=False)
class _Pieces:
    """m pieces in which every axis moves evenly, none of them without time.

    begins, ends  (m,)    seconds
    row           (m,)    row of each
    before, after (m, 5)  axis values at both ends
    tip_feed      (m,)    mm/min
    """

    begins: Floats
    ends: Floats
    row: Ints
    before: Floats
    after: Floats
    tip_feed: Floats


@dataclass(frozen=True, slots=True, eq=False)
class TimedRun:
    """A run of n rows as motion in time; seconds count from the start of the program.

    begins    (n,)    seconds at which each row begins to move
    ends      (n,)    seconds at which its target is reached; dwells after it come later
    duration          seconds of the whole program, with dwells, tool changes and spindle ramps at its end
    events            in order
    """

    run: Run
    begins: Floats
    ends: Floats
    duration: float
    events: tuple[TimedEvent, ...]
    _pieces: _Pieces
    _joints: Floats

    def at(self, seconds: Floats) -> MachineState:
        """Return the machine at k times, in any order; before the start and after the end it stands."""
        times = np.asarray(seconds, np.float64)
        row = np.searchsorted(self.begins, times, "right") - 1
        joints = self._joints[row + 1].copy()
        velocity, tip_feed = np.zeros((len(times), 5)), np.zeros(len(times))
        pieces = self._pieces
        if len(pieces.row):
            at = np.minimum(np.searchsorted(pieces.ends, times, "left"), len(pieces.row) - 1)
            inside = (times >= pieces.begins[at]) & (times <= pieces.ends[at])
            piece, time = at[inside], times[inside]
            takes = pieces.ends[piece] - pieces.begins[piece]
            share = ((time - pieces.begins[piece]) / takes)[:, None]
            way = pieces.after[piece] - pieces.before[piece]
            joints[inside] = np.where(share == 1.0, pieces.after[piece], pieces.before[piece] + share * way)
            velocity[inside] = way / takes[:, None]
            tip_feed[inside], row[inside] = pieces.tip_feed[piece], pieces.row[piece]
        return MachineState(joints, velocity, row, tip_feed, self._rpm(row, times))

    def _rpm(self, row: Ints, times: Floats) -> Floats:
        """Speed of the spindle, signed."""
        state, n = self.run.state, len(self.run)
        if not n:
            return np.zeros(len(times))
        at = np.maximum(row, 0)
        return np.where(row < 0, 0.0, state.rpm.at(at) * state.spindle.at(at))


def time_run(run: Run, lengths: Mapping[int, float] = _ALL_LENGTHS, *, limits: AxisDynamics | None = None) -> TimedRun:
    """Give a run its motion in time.

    Parameters
    ----------
    run
        The program as its control ran it.
    lengths
        Of tools, from tip to gauge point, mm, by their index in ``Run.tools``; others have that of the machine.
    limits
        What the axes can do; None: what the machine's definition states.
    """
    dynamics = AxisDynamics.of(run.machine) if limits is None else limits
    seconds, tip_feed = _row_times(run, dynamics)
    waits = dict.fromkeys(range(-1, len(run)), 0.0)
    for event, takes in _waits(run):
        waits[min(event.before_row, len(run)) - 1] += takes
    pauses = np.array([waits[row] for row in range(-1, len(run))])
    ends = np.cumsum(seconds + pauses[:-1])
    begins = ends - seconds
    joints, pieces = _timed_pieces(run, lengths, begins, seconds, tip_feed)
    events = _timed_events(run, ends)
    duration = (float(ends[-1]) if len(ends) else 0.0) + float(pauses[-1])
    return TimedRun(run, begins, ends, duration, events, pieces, joints)


def _row_times(run: Run, dynamics: AxisDynamics) -> tuple[Floats, Floats]:
    """Seconds and speed of the tip, mm/min, of all rows, (n,) each."""
    n = len(run)
    steps, feeds = np.empty((n, 5)), np.empty((4, n))
    of = RowFeeds(run)
    for first, end, positions in run.chunks():
        steps[first:end] = np.diff(positions.joints, axis=0)
        feeds[:, first:end] = of.part(first, end, positions)
    length, rate, travel, counts = feeds
    moving = np.flatnonzero(length > 0.0)
    stop = np.zeros(n, np.bool_)
    stop[moving[:-1][np.diff(counts[moving]) != 0.0]] = True
    rows = [event.before_row - 1 for event in run.events if event.kind in STOPS]
    stop[[row for row in rows if row >= 0]] = True
    seconds = row_seconds(run.machine, steps, length, rate, stop)
    with np.errstate(divide="ignore", invalid="ignore"):
        return seconds, np.where(seconds > 0.0, 60.0 * travel / seconds, 0.0)


def _waits(run: Run) -> Iterator[tuple[RunEvent, float]]:
    """Each event and the seconds that the axes wait for it; revolutions of a spindle of unknown speed take none."""
    last = len(run) - 1
    for event in run.events:
        takes = 0.0
        if event.kind == "dwell" and isinstance(event.value, float) and math.isfinite(event.value):
            takes = event.value
            if takes < 0.0:
                rpm = float(run.state.rpm[min(event.before_row, last)]) if last >= 0 else 0.0
                takes = -takes * 60.0 / rpm if rpm > 0.0 else 0.0
        yield event, takes


def _timed_events(run: Run, ends: Floats) -> tuple[TimedEvent, ...]:
    """The events of a run in time: those before one row come one after the other, when the row before has ended."""
    found, before, now = [], -1, 0.0
    for event, takes in _waits(run):
        row = min(event.before_row, len(run))
        if row != before:
            before, now = row, float(ends[row - 1]) if row else 0.0
        found.append(TimedEvent(now, takes, event))
        now += takes
    return tuple(found)


def _timed_pieces(
    run: Run, lengths: Mapping[int, float], begins: Floats, seconds: Floats, tip_feed: Floats
) -> tuple[Floats, _Pieces]:
    """Axis values before the first row and after each, (n + 1, 5), and the pieces that take time."""
    joints = np.empty((len(run) + 1, 5))
    joints[0] = run.start
    columns: list[tuple[Floats, Floats, Ints, Floats, Floats]] = []
    for part in axis_pieces(run, lengths):
        whole = part.done == 1.0
        joints[part.row[whole] + 1] = part.joints[1:][whole]
        moves = seconds[part.row] > 0.0
        row = part.row[moves]
        columns.append(
            (
                begins[row] + part.begin[moves] * seconds[row],
                begins[row] + part.done[moves] * seconds[row],
                row,
                part.joints[:-1][moves],
                part.joints[1:][moves],
            )
        )
    if not columns:
        nothing = np.zeros(0)
        return joints, _Pieces(nothing, nothing, np.zeros(0, np.int64), np.zeros((0, 5)), np.zeros((0, 5)), nothing)
    begin, end, row, before, after = (np.concatenate(each) for each in zip(*columns, strict=True))
    return joints, _Pieces(begin, end, row, before, after, tip_feed[row])
