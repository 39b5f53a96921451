"""The path of a run as its speed is planned on it: pieces that are straight in the space of the axes.

Rows are added chunk after chunk. Where no row is cut, pieces are rows.
Units: mm and degrees; mm/min and deg/min.
"""

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.timing.path_modes import corner_tolerances, exact_stop_rows
from trunnion.timing.row_feeds import FeedRow

#: Events for which the axes stand still.
STOPS = ("dwell", "stop", "tool_change", "end")


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """m pieces of n rows.

    steps        (m, 5)  how far each axis moves
    length       (m,)    what the feed counts
    rate         (m,)    programmed speed along it, per minute; infinite for rapids
    tolerance    (m,)    how far the control may depart from the corner after a piece, mm or degrees
    stops_after  (m,)    the axes stop after it
    bends_after  (m,)    its row goes on after it: no corner of the program is there
    counts       (n,)    pieces of each row; empty: one
    """

    steps: Floats
    length: Floats
    rate: Floats
    tolerance: Floats
    stops_after: Flags
    bends_after: Flags
    counts: Ints

    def of_rows(self, column: Floats, combine: np.ufunc = np.add) -> Floats:
        """Return sums of a column of pieces for each row, or what else ``combine`` makes of them."""
        if not len(self.counts):
            return column
        return np.asarray(combine.reduceat(column, np.cumsum(self.counts) - self.counts))


def steady(speeds: Floats) -> float:
    """Return the highest of some speeds one after the other, (k,), at which nothing between the first and last is
    slower.

    Ramps at both ends do not count, since they lead up to it.
    """
    before, after = np.maximum.accumulate(speeds), np.maximum.accumulate(speeds[::-1])[::-1]
    return float(speeds.min(initial=before[-1], where=speeds < np.minimum(before, after)))


class PathBuilder:
    """Makes the path of a run; ``more_stops`` are rows after which the axes stop besides."""

    def __init__(self, run: Run, more_stops: Ints | None = None) -> None:
        n = len(run)
        self._run = run
        self._steps, self._length, self._rate = np.empty((n, 5)), np.empty(n), np.empty(n)
        self._used = 0
        self._counts: list[Ints] = []
        self._kinds = np.empty(n, np.uint8)
        self._moves = np.empty(n, np.bool_)
        self._more_stops = np.zeros(0, np.int64) if more_stops is None else more_stops

    def add(self, first: int, feeds: Floats, steps: Floats, counts: Ints, shares: Floats | None = None) -> None:
        """Add rows, in order.

        first    the first of k rows
        feeds    (4, k)  as ``RowFeeds`` has them
        steps    (m, 5)  how far each axis moves in each of their pieces
        counts   (k,)    how many pieces each row has
        shares   (m,)    share of its row that each piece is; None: each is its row
        """
        k = len(counts)
        length, rate = feeds[FeedRow.LENGTH], feeds[FeedRow.RATE]
        self._kinds[first : first + k] = feeds[FeedRow.COUNTS]
        self._moves[first : first + k] = length > 0.0
        if shares is not None:
            row = np.repeat(np.arange(k), counts)
            length, rate = length[row] * shares, rate[row]
        self._counts.append(counts.astype(np.int16) if shares is not None else np.ones(k, np.int16))
        part = slice(self._used, self._used + len(steps))
        self._make_room(part.stop, len(self._run) - first - k)
        self._steps[part], self._length[part], self._rate[part] = np.nan_to_num(steps), length, rate
        self._used = part.stop

    def _make_room(self, needed: int, to_come: int) -> None:
        if needed + to_come > len(self._length):
            more = needed + to_come + len(self._length) // 2 - len(self._length)
            self._steps = np.concatenate((self._steps, np.empty((more, 5))))
            self._length = np.concatenate((self._length, np.empty(more)))
            self._rate = np.concatenate((self._rate, np.empty(more)))

    def result(self) -> Path:
        """Return the whole path, once all rows have been added.

        The axes stand still for a dwell, a stop and a tool change, and where the feed begins to count another length.
        """
        run, n, m = self._run, len(self._run), self._used
        stop = exact_stop_rows(run)
        moving = np.flatnonzero(self._moves)
        stop[moving[:-1][np.diff(self._kinds[moving]) != 0]] = True
        rows = [event.before_row - 1 for event in run.events if event.kind in STOPS]
        stop[[row for row in rows if row >= 0]] = True
        stop[self._more_stops] = True
        tolerance = corner_tolerances(run).part(0, n) if n else np.zeros(0)
        counts, bends = np.zeros(0, np.int64), np.zeros(m, np.bool_)
        if m != n:
            counts = np.concatenate(self._counts).astype(np.int64)
            last = np.cumsum(counts) - 1
            stops, stop = stop, np.zeros(m, np.bool_)
            stop[last[stops]] = True
            bends[:] = True
            bends[last] = False
            tolerance = np.repeat(tolerance, counts)
        return Path(self._steps[:m], self._length[:m], self._rate[:m], tolerance, stop, bends, counts)
