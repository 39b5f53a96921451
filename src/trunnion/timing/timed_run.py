"""A run as motion in time: where every axis is, and how fast, at any second of the program.

In:     a ``Run``, the lengths of its tools, and what the axes of its machine can do.
Out:    a ``TimedRun``.
Units:  mm and degrees, seconds; feeds in mm/min, spindle speeds in rev/min.

Axes stay on the programmed path: where a control rounds a corner off, they go through it at the speed of the rounding.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.timing.axis_pieces import MOST_PIECES, axis_pieces
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.path import PathBuilder
from trunnion.timing.planner import Phases, plan
from trunnion.timing.row_feeds import FeedRow, RowFeeds
from trunnion.timing.schedule import Schedule, TimedEvent
from trunnion.timing.spindle import SpindleSpeeds

#: What ``FeedRow.COUNTS`` says where F counts degrees, and the straight pieces that stand for the way of the tip then.
_DEGREES: Final = 2.0
_STEPS: Final = 64

_ALL_LENGTHS: Final[Mapping[int, float]] = {}

#: Slower than this the axes stand, mm/s or deg/s: it is what rounding leaves at the end of a ramp.
_STANDS: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class MachineState:
    """A machine at k times.

    joints    (k, 5)        axis values as displayed, with all turns; mm or deg, machine order
    velocity  (k, 5)        mm/s or deg/s
    acceleration  (k, 5)    mm/s^2 or deg/s^2
    jerk      (k, 5)        mm/s^3 or deg/s^3; 0 where the definition states none, and accelerations step
    row       (k,)  int64   row that is run, or was run last; -1 before the first
    feed      (k,)          speed along the path as F counts it, mm/min; that of the tip where F counts degrees
    tip_feed  (k,)          speed of the tip at the workpiece, mm/min
    rpm       (k,)          speed of the spindle, rev/min; negative counter-clockwise (M4)
    told_rpm  (k,)          speed that the spindle has been told
    """

    joints: Floats
    velocity: Floats
    acceleration: Floats
    jerk: Floats
    row: Ints
    feed: Floats
    tip_feed: Floats
    rpm: Floats
    told_rpm: Floats


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
    rates     (n,)    speed along the path that the program asks for, mm/min or deg/min; infinite for rapids
    in_mm     (n,)    mm that the tip goes for each degree where F counts degrees, else 1
    duration          seconds of the whole program, with dwells, tool changes and spindle ramps at its end
    waits     (w, 2)  seconds at which the axes begin and end to wait
    events            in order
    """

    run: Run
    begins: Floats
    ends: Floats
    rates: Floats
    in_mm: Floats
    duration: float
    waits: Floats
    events: tuple[TimedEvent, ...]
    _motion: _Motion
    _row_joints: Floats
    _spindle: SpindleSpeeds

    def at(self, seconds: Floats, after: Flags | None = None) -> MachineState:
        """Return the machine at k times, in any order; before the start and after the end it stands.

        ``after`` (k,): where motions and spindle change at that very time, what comes then; else what was until then.
        """
        times = np.asarray(seconds, np.float64)
        row = np.searchsorted(self.ends, times, "right") - 1
        joints = self._row_joints[row + 1]
        rates, feed, tip_feed = np.zeros((len(times), 3, 5)), np.zeros(len(times)), np.zeros(len(times))
        motion = self._motion
        if len(motion.ends):
            phase = np.searchsorted(motion.begins, times, "left") - 1
            moves = (phase >= 0) & (times <= motion.ends[phase])
            if after is not None:
                later = np.searchsorted(motion.begins, times, "right") - 1
                phase = np.where(after, later, phase)
                moves = np.where(after, (later >= 0) & (times < motion.ends[later]), moves)
            if moves.any():
                found = _moving(motion, phase[moves], times[moves])
                joints[moves], rates[moves], row[moves], feed[moves], tip_feed[moves] = found
                feed[moves] *= self.in_mm[row[moves]]
        spindle = self._spindle.at(times, after)
        return MachineState(joints, rates[:, 0], rates[:, 1], rates[:, 2], row, feed, tip_feed, *spindle)

    def passed(self, since: Floats, until: Floats) -> tuple[Floats, Floats]:
        """Return the least and the greatest values of all axes at the ends of pieces after ``since``, up to ``until``.

        Both (k,) seconds; the values (k, 5) are +inf and -inf where no piece ends.
        """
        motion, width = self._motion, self._motion.joints.shape[1]
        done = motion.ends[motion.completes]
        least, most = np.full((len(until), width), np.inf), np.full((len(until), width), -np.inf)
        firsts, lasts = (np.searchsorted(done, times, "right").tolist() for times in (since, until))
        pieces = motion.phases.piece[motion.completes]
        for k, (first, last) in enumerate(zip(firsts, lasts, strict=True)):
            if last > first:
                joints = motion.joints[pieces[first:last] + 1]
                least[k], most[k] = joints.min(axis=0), joints.max(axis=0)
        return least, most


def _moving(motion: _Motion, phase: Ints, times: Floats) -> tuple[Floats, Floats, Ints, Floats, Floats]:
    """Axis values, their derivatives (k, 3, 5), rows, feeds and those of the tip at times within phases."""
    phases = motion.phases
    time, piece = times - motion.begins[phase], phases.piece[phase]
    speed, acceleration, jerk = phases.speed[phase], phases.acceleration[phase], phases.jerk[phase]
    way = phases.done[phase] + time * (speed + time * (acceleration / 2.0 + time * jerk / 6.0))
    length = motion.length[piece]
    share = np.clip(way / length, 0.0, 1.0)
    share[(times >= motion.ends[phase]) & motion.completes[phase]] = 1.0
    before, after = motion.joints[piece], motion.joints[piece + 1]
    joints = np.where((share == 1.0)[:, None], after, before + share[:, None] * (after - before))
    rate = speed + time * (acceleration + time * jerk / 2.0)
    rate[rate < _STANDS] = 0.0
    row = motion.row[piece]
    along = np.stack((rate, acceleration + time * jerk, jerk), axis=1) / length[:, None]
    return joints, along[:, :, None] * (after - before)[:, None], row, 60.0 * rate, 60.0 * rate * motion.tip_share[row]


def time_run(run: Run, lengths: Mapping[int, float] = _ALL_LENGTHS, *, limits: AxisDynamics | None = None) -> TimedRun:
    """Give a run its motion in time.

    run      the program as its control ran it
    lengths  of tools, from tip to gauge point, mm, by their index in ``Run.tools``; others have that of the machine
    limits   what the machine can do; None: what its definition states

    Raises ``InputError`` if there is more motion than is kept in memory.
    """
    dynamics = AxisDynamics.of(run.machine) if limits is None else limits
    n, schedule = len(run), Schedule(run, dynamics)
    builder, joints, piece_rows = PathBuilder(run, schedule.stops), [run.start[None]], [np.zeros(0, np.int64)]
    tip_share, rates, in_mm = [np.zeros(0)], [np.zeros(0)], [np.zeros(0)]
    feeds = RowFeeds(run)
    for part in axis_pieces(run, lengths, most=MOST_PIECES):
        positions = run.chunk(part.first, part.end)
        of_rows = feeds.part(part.first, part.end, positions)
        counts = np.bincount(part.row - part.first, minlength=part.end - part.first)
        builder.add(part.first, of_rows, np.diff(part.joints, axis=0), counts, part.done - part.begin)
        joints.append(part.joints[1:])
        piece_rows.append(part.row)
        with np.errstate(divide="ignore", invalid="ignore"):
            length = of_rows[FeedRow.LENGTH]
            rates.append(of_rows[FeedRow.RATE])
            tip_share.append(np.where(length > 0.0, of_rows[FeedRow.TRAVEL] / length, 0.0))
        in_mm.append(_mm_of_degrees(run.machine, positions.joints, of_rows))
    path = builder.result()
    _, phases = plan(path, dynamics)
    row = np.concatenate(piece_rows)
    moved = np.cumsum(phases.seconds)
    scheduled = schedule.timed(_row_ends(n, row[phases.piece], moved))
    shift = np.cumsum(scheduled.waits)
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
        np.concatenate(tip_share),
    )
    whole = np.concatenate(([0], np.flatnonzero(np.diff(row, append=-1)) + 1))
    stood = np.concatenate(([0.0], row_ends))
    waits = np.column_stack((stood, stood + scheduled.waits))[scheduled.waits > 0.0]
    return TimedRun(
        run, row_begins, row_ends, np.concatenate(rates), np.concatenate(in_mm), scheduled.duration, waits,
        scheduled.events, motion, motion.joints[whole], scheduled.spindle,
    )  # fmt: skip


def _mm_of_degrees(machine: Machine, joints: Floats, feeds: Floats) -> Floats:
    """Return what the tip goes for each degree that F counts, mm, and 1 where it counts mm, (k,).

    joints  (k + 1, 5) before the first row and after each
    feeds   (4, k) of ``RowFeeds``
    """
    found = np.ones(feeds.shape[1])
    rows = np.flatnonzero((feeds[FeedRow.COUNTS] == _DEGREES) & (feeds[FeedRow.LENGTH] > 0.0))
    if len(rows):
        share = np.linspace(0.0, 1.0, _STEPS + 1)[None, :, None]
        within = joints[rows, None] + share * (joints[rows + 1] - joints[rows])[:, None]
        tip = forward(machine, within.reshape(-1, within.shape[2]))[0].reshape(len(rows), _STEPS + 1, 3)
        found[rows] = np.linalg.norm(np.diff(tip, axis=1), axis=2).sum(axis=1) / feeds[FeedRow.LENGTH, rows]
    return found


def _row_ends(n: int, row: Ints, moved: Floats) -> Floats:
    """Seconds of motion until the end of each row, (n,), by the rows of phases and the seconds until their ends."""
    ends = np.zeros(n)
    last = np.flatnonzero(np.diff(row, append=-1))
    ends[row[last]] = moved[last]
    return np.maximum.accumulate(ends) if n else ends
