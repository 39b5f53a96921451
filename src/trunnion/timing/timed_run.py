"""A run as motion in time: where every axis is, and how fast, at any second of the program.

In:     a ``Run``, the lengths of its tools, and what the axes of its machine can do.
Out:    a ``TimedRun``.
Units:  mm and degrees, seconds; feeds in mm/min, spindle speeds in rev/min.

Axes stay on the programmed path: where a control rounds a corner off, they go through it at the speed of the rounding.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run, RunEvent
from trunnion.timing.axis_pieces import MOST_PIECES, axis_pieces
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.path import PathBuilder
from trunnion.timing.pauses import pauses
from trunnion.timing.planner import Phases, plan
from trunnion.timing.row_feeds import FeedRow, RowFeeds
from trunnion.timing.spindle import SpindleSpeeds, spindle_targets, waiting_rows

_ALL_LENGTHS: Final[Mapping[int, float]] = {}


@dataclass(frozen=True, slots=True)
class TimedEvent:
    """An event of a run in time: the second at which it happens, and how many seconds it takes.

    The axes wait for dwells and tool changes, and for the spindle as ``spindle`` says.
    """

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
class _Motion:
    """The phases of a run in time, and the m pieces in which every axis moves evenly.

    phases
    begins, ends  (p,)      seconds of each phase
    completes     (p,)      whether its piece ends with it
    joints        (m + 1, 5)  axis values before the first piece and after each
    length        (m,)      what the feed counts
    row           (m,)      row of each piece
    tip_share     (n,)      way of the tip for each unit of the length, by rows
    """

    phases: Phases
    begins: Floats
    ends: Floats
    completes: Flags
    joints: Floats
    length: Floats
    row: Ints
    tip_share: Floats


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
    _motion: _Motion
    _row_joints: Floats
    _spindle: SpindleSpeeds

    def at(self, seconds: Floats) -> MachineState:
        """Return the machine at k times, in any order; before the start and after the end it stands."""
        times = np.asarray(seconds, np.float64)
        row = np.searchsorted(self.ends, times, "right") - 1
        joints = self._row_joints[row + 1]
        velocity, tip_feed = np.zeros((len(times), 5)), np.zeros(len(times))
        motion = self._motion
        phase = np.searchsorted(motion.begins, times, "left") - 1
        moves = (phase >= 0) & (times <= motion.ends[phase]) if len(motion.ends) else np.zeros(len(times), np.bool_)
        if moves.any():
            joints[moves], velocity[moves], row[moves], tip_feed[moves] = _moving(motion, phase[moves], times[moves])
        return MachineState(joints, velocity, row, tip_feed, self._spindle.at(times))


def _moving(motion: _Motion, phase: Ints, times: Floats) -> tuple[Floats, Floats, Ints, Floats]:
    """Axis values, velocities, rows and feeds of the tip at times within phases."""
    phases = motion.phases
    time, piece = times - motion.begins[phase], phases.piece[phase]
    speed, acceleration, jerk = phases.speed[phase], phases.acceleration[phase], phases.jerk[phase]
    way = phases.done[phase] + time * (speed + time * (acceleration / 2.0 + time * jerk / 6.0))
    length = motion.length[piece]
    share = np.clip(way / length, 0.0, 1.0)
    share[(times >= motion.ends[phase]) & motion.completes[phase]] = 1.0
    before, after = motion.joints[piece], motion.joints[piece + 1]
    joints = np.where((share == 1.0)[:, None], after, before + share[:, None] * (after - before))
    rate = np.maximum(speed + time * (acceleration + time * jerk / 2.0), 0.0)
    row = motion.row[piece]
    return joints, (after - before) * (rate / length)[:, None], row, 60.0 * rate * motion.tip_share[row]


def time_run(run: Run, lengths: Mapping[int, float] = _ALL_LENGTHS, *, limits: AxisDynamics | None = None) -> TimedRun:
    """Give a run its motion in time.

    Parameters
    ----------
    run
        The program as its control ran it.
    lengths
        Of tools, from tip to gauge point, mm, by their index in ``Run.tools``; others have that of the machine.
    limits
        What the machine can do; None: what its definition states.

    Raises
    ------
    InputError
        If there is more motion than is kept in memory.
    """
    dynamics = AxisDynamics.of(run.machine) if limits is None else limits
    n, spindle_rate = len(run), dynamics.spindle
    waits_for = list(waiting_rows(run)) if math.isfinite(spindle_rate) else []
    stops = np.array([row - 1 for _, row in waits_for if row], np.int64)
    builder, joints, piece_rows, tip_share = PathBuilder(run, stops), [run.start[None]], [np.zeros(0, np.int64)], []
    feeds = RowFeeds(run)
    for part in axis_pieces(run, lengths, most=MOST_PIECES):
        of_rows = feeds.part(part.first, part.end, run.chunk(part.first, part.end))
        counts = np.bincount(part.row - part.first, minlength=part.end - part.first)
        builder.add(part.first, of_rows, np.diff(part.joints, axis=0), counts, part.done - part.begin)
        joints.append(part.joints[1:])
        piece_rows.append(part.row)
        with np.errstate(divide="ignore", invalid="ignore"):
            length = of_rows[FeedRow.LENGTH]
            tip_share.append(np.where(length > 0.0, of_rows[FeedRow.TRAVEL] / length, 0.0))
    path = builder.result()
    _, phases = plan(path, dynamics)
    row = np.concatenate(piece_rows)
    waits = np.zeros(n + 1)
    for event, takes in pauses(run, dynamics):
        waits[min(event.before_row, n)] += takes
    moved = np.cumsum(phases.seconds)
    spindle = _spindle(run, spindle_rate, waits_for, waits, _row_ends(n, row[phases.piece], moved))
    shift = np.cumsum(waits)
    begins, ends = (each + shift[row[phases.piece]] for each in (moved - phases.seconds, moved))
    row_ends = _row_ends(n, row[phases.piece], moved) + shift[:n]
    row_begins = row_ends.copy()
    starts = np.flatnonzero(np.diff(row[phases.piece], prepend=-1))
    row_begins[row[phases.piece][starts]] = begins[starts]
    completes = np.diff(phases.piece, append=-1) != 0
    motion = _Motion(
        phases,
        begins,
        ends,
        completes,
        np.concatenate(joints),
        path.length,
        row,
        np.concatenate([np.zeros(0), *tip_share]),
    )
    duration = max((float(row_ends[-1]) if n else 0.0) + float(waits[n]), spindle.end())
    events = _timed_events(run, dynamics, row_ends, spindle)
    whole = np.concatenate(([0], np.flatnonzero(np.diff(row, append=-1)) + 1))
    return TimedRun(run, row_begins, row_ends, duration, events, motion, motion.joints[whole], spindle)


def _row_ends(n: int, row: Ints, moved: Floats) -> Floats:
    """Seconds of motion until the end of each row, (n,), by the rows of phases and the seconds until their ends."""
    ends = np.zeros(n)
    last = np.flatnonzero(np.diff(row, append=-1))
    ends[row[last]] = moved[last]
    return np.maximum.accumulate(ends) if n else ends


def _spindle(run: Run, rate: float, waits_for: list[tuple[int, int]], waits: Floats, moved: Floats) -> SpindleSpeeds:
    """The spindle in time; ``waits`` (n + 1,) before rows become longer where a motion waits for it."""
    rows, target = spindle_targets(run)
    waiting = dict(waits_for)
    seconds, before = np.zeros(len(rows)), np.zeros(len(rows))
    shift, done = np.cumsum(waits), 0.0
    for k, row in enumerate(rows.tolist()):
        start = (float(moved[row - 1] + shift[row - 1]) if row else 0.0) + done
        seconds[k] = max(start, seconds[k - 1]) if k else start
        if k:
            reached = SpindleSpeeds(seconds[:k], before[:k], target[:k], rate)
            before[k] = float(reached.at(seconds[k : k + 1])[0])
        if k in waiting:
            feed = waiting[k]
            ready = seconds[k] + abs(target[k] - before[k]) / rate
            begins = (float(moved[feed - 1]) if feed else 0.0) + float(shift[feed]) + done
            wait = max(ready - begins, 0.0)
            waits[feed] += wait
            done += wait
    return SpindleSpeeds(seconds, before, target, rate)


def _timed_events(run: Run, dynamics: AxisDynamics, ends: Floats, spindle: SpindleSpeeds) -> tuple[TimedEvent, ...]:
    """The events of a run in time: those before one row come one after the other, when the row before has ended."""
    found, before, now = [], -1, 0.0
    rows, _ = spindle_targets(run)
    ramps = dict(zip(rows.tolist(), np.abs(spindle.target - spindle.before).tolist(), strict=True))
    for event, takes in pauses(run, dynamics):
        row = min(event.before_row, len(run))
        if row != before:
            before, now = row, float(ends[row - 1]) if row else 0.0
        ramp = ramps.pop(row, 0.0) / spindle.rate if event.kind == "spindle" else 0.0
        found.append(TimedEvent(now, takes + ramp, event))
        now += takes
    return tuple(found)
