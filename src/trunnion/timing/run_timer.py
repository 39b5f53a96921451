"""How long the rows of a run take: what they ask for, within what the axes can do.

A row at feed takes its length at its feed, and a rapid what its slowest axis needs; accelerations add ramps, with a
look ahead over corners. Dwells, tool changes and waits for the spindle belong to the row at whose end the axes wait.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.run import PositionChunk, Run
from trunnion.records import dataclass
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.path import PathBuilder, steady
from trunnion.timing.planner import piece_seconds, timed_pieces
from trunnion.timing.row_feeds import FeedRow
from trunnion.timing.row_interpolation import RowInterpolation
from trunnion.timing.schedule import Schedule

#: Rows in which rotary axes turn by no more than this, degrees, count as straight: 2 m from the axis they are, to
#: 0.02 mm.
_STRAIGHT_TURN = 0.5

#: Axes that move by no more than this, mm or degrees, stand still.
_NO_MOTION = 1e-9

#: Pieces into which the rows of a run are cut: so many for each row, and so many besides for the whole run. Where more
#: would be needed, all rows of a chunk are cut into fewer.
_MOST_PIECES = 16
_SPARE_PIECES = 4_000_000


@dataclass(frozen=True, slots=True, eq=False)
class RowTimes:
    """The times of n rows.

    moving    (n,)  seconds of motion
    waiting   (n,)  seconds that the axes wait at the end of each; before the first row, that of the first
    tip_feed  (n,)  mean speed of the tip while it moves, mm/min; NaN where nobody knows how fast an axis goes
    """

    moving: Floats
    waiting: Floats
    tip_feed: Floats


class RunTimer:
    """Collects what determines the times of a run."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._dynamics = AxisDynamics.of(run.machine)
        self._inside = RowInterpolation(run)
        self._schedule = Schedule(run, self._dynamics)
        self._path = PathBuilder(run, self._schedule.stops)
        self._travel = np.empty(len(run))
        self._untimed = np.zeros(len(run), np.bool_)
        self._spare = _SPARE_PIECES

    def add(self, first: int, positions: PositionChunk, feeds: Floats) -> None:
        """Add rows, in order; ``positions`` is the ``Run.chunk`` of them, ``feeds`` what ``RowFeeds`` has."""
        joints = positions.joints
        n = len(joints) - 1
        self._travel[first : first + n] = feeds[FeedRow.TRAVEL]
        # A rapid, or a motion without a feed, of an axis without a stated speed: the others say nothing of its time.
        free = np.isinf(self._dynamics.speed)
        if free.any():
            moves = (np.abs(np.diff(joints[:, free], axis=0)) > _NO_MOTION).any(axis=1)
            self._untimed[first : first + n] = np.isinf(feeds[FeedRow.RATE]) & moves
        length = np.full(n, self._run.machine_at(first).tool_length or 0.0)
        counts = self._inside.counts(first, joints, length, _STRAIGHT_TURN)
        pieces = int(counts.sum())
        if pieces == n:
            self._path.add(first, feeds, np.diff(joints, axis=0), counts)
            return
        most = n * _MOST_PIECES + self._spare
        if pieces > most:
            counts = np.maximum(counts * most // pieces, 1)
            pieces = int(counts.sum())
        self._spare -= max(pieces - n * _MOST_PIECES, 0)
        _, begin, done, along = self._inside.pieces(first, joints, length, counts)
        steps = np.diff(along, axis=0, prepend=joints[:1])
        self._path.add(first, feeds, steps, counts, done - begin)

    def reached(self) -> tuple[Floats, Floats]:
        """Seconds of the axes' motion, and highest speed along what the feed counts, per minute, of all rows, (n,).

        Of a circle it is the highest ``steady`` one.
        """
        path = self._path.result()
        times = timed_pieces(path, self._dynamics)
        speed = path.of_rows(times.reached, np.maximum).copy()
        if len(path.counts):
            ends = np.cumsum(path.counts)
            for row in self._run.arcs.row.tolist():
                speed[row] = steady(times.reached[ends[row] - path.counts[row] : ends[row]])
        return path.of_rows(times.seconds), 60.0 * speed

    def result(self) -> RowTimes:
        """Return the times of all rows."""
        path = self._path.result()
        moving = path.of_rows(piece_seconds(path, self._dynamics))
        with np.errstate(divide="ignore", invalid="ignore"):
            tip_feed = np.where(moving > 0.0, 60.0 * self._travel / moving, 0.0)
        tip_feed[self._untimed] = np.nan
        waiting = np.zeros(len(moving))
        if len(moving):
            waits = self._schedule.timed(np.cumsum(np.where(np.isfinite(moving), moving, 0.0))).waits
            waiting += waits[1:]
            waiting[0] += waits[0]
        return RowTimes(moving, waiting, tip_feed)
