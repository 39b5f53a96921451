"""How long the rows of a run take: what they ask for, within what the axes can do.

A row at feed takes its length at its feed, and a rapid what its slowest axis needs; accelerations add ramps, with a
look ahead over corners. A dwell and a tool change add their seconds to the row at whose end the axes wait.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.run import PositionChunk, Run
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.path import PathBuilder
from trunnion.timing.pauses import pauses
from trunnion.timing.planner import piece_seconds, timed_pieces
from trunnion.timing.row_feeds import FeedRow
from trunnion.timing.row_interpolation import RowInterpolation

#: Rows in which rotary axes turn by no more than this, degrees, count as straight: 2 m from the axis they are, to
#: 0.02 mm.
_STRAIGHT_TURN = 0.5

#: On average no row of a chunk is cut into more pieces than this; where many would be, all are cut into fewer.
_MOST_PIECES = 16


class RunTimer:
    """Collects what determines the times of a run."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._dynamics = AxisDynamics.of(run.machine)
        self._inside = RowInterpolation(run)
        self._path = PathBuilder(run)
        self._travel = np.empty(len(run))
        self._read_with = run.machine.tool_length or 0.0

    def add(self, first: int, positions: PositionChunk, feeds: Floats) -> None:
        """Add rows, in order; ``positions`` is the ``Run.chunk`` of them, ``feeds`` what ``RowFeeds`` has."""
        joints = positions.joints
        n = len(joints) - 1
        self._travel[first : first + n] = feeds[FeedRow.TRAVEL]
        length = np.full(n, self._read_with)
        counts = self._inside.counts(first, joints, length, _STRAIGHT_TURN)
        pieces = int(counts.sum())
        if pieces == n:
            self._path.add(first, feeds, np.diff(joints, axis=0), counts)
            return
        if pieces > n * _MOST_PIECES:
            counts = np.maximum(counts * (n * _MOST_PIECES) // pieces, 1)
        _, begin, done, along = self._inside.pieces(first, joints, length, counts)
        steps = np.diff(along, axis=0, prepend=joints[:1])
        self._path.add(first, feeds, steps, counts, done - begin)

    def reached(self) -> tuple[Floats, Floats]:
        """Seconds of the axes' motion, and highest speed along what the feed counts, per minute, of all rows, (n,)."""
        path = self._path.result()
        times = timed_pieces(path, self._dynamics)
        return path.of_rows(times.seconds), 60.0 * path.of_rows(times.reached, np.maximum)

    def result(self) -> tuple[Floats, Floats]:
        """Seconds, and mean speed of the tip in mm/min, of all rows, (n,) each."""
        path = self._path.result()
        seconds = path.of_rows(piece_seconds(path, self._dynamics))
        with np.errstate(divide="ignore", invalid="ignore"):
            tip_feed = np.where(seconds > 0.0, 60.0 * self._travel / seconds, 0.0)
        if len(seconds):
            for event, takes in pauses(self._run, self._dynamics):
                seconds[max(min(event.before_row, len(seconds)) - 1, 0)] += takes
        return seconds, tip_feed
