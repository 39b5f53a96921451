"""The spindle in time: it speeds up and slows down evenly, as fast as the machine's definition states.

A change begins when the row before it has ended. Rapids go on meanwhile; the first motion at feed waits until a spindle
that stood, or turned the other way, has its speed. Without a stated acceleration the spindle takes no time.
Units: seconds, rev/min; negative speeds are counter-clockwise (M4).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind


@dataclass(frozen=True, slots=True, eq=False)
class SpindleSpeeds:
    """Changes of the speed in time, ascending.

    seconds   (k,)  when each begins
    before    (k,)  speed there
    target    (k,)  speed that it leads to
    rate      rev/min per second; infinite where none is stated
    """

    seconds: Floats
    before: Floats
    target: Floats
    rate: float

    def at(self, seconds: Floats) -> Floats:
        """Return the speeds at some times, (k,)."""
        if not len(self.seconds):
            return np.zeros(len(seconds))
        k = np.searchsorted(self.seconds, seconds, "left") - 1
        known = np.maximum(k, 0)
        change = self.target[known] - self.before[known]
        done = _moved(change, seconds - self.seconds[known], self.rate)
        return np.where(k < 0, 0.0, self.before[known] + done)

    def end(self) -> float:
        """Second at which the last change has come to its end."""
        if not len(self.seconds) or not np.isfinite(self.rate):
            return 0.0
        return float(self.seconds[-1] + abs(self.target[-1] - self.before[-1]) / self.rate)


def _moved(change: Floats, seconds: Floats, rate: float) -> Floats:
    """How far a speed has come towards its target."""
    if not np.isfinite(rate):
        return change
    return np.asarray(np.sign(change) * np.minimum(np.abs(change), rate * np.maximum(seconds, 0.0)))


def spindle_targets(run: Run) -> tuple[Ints, Floats]:
    """The rows before which the speed changes, ascending, and the speeds from there on; n: the end of the program."""
    state, n = run.state, len(run)
    columns = [(np.minimum(column.rows, n), column.values) for column in (state.rpm, state.spindle)]
    rows = np.unique(np.concatenate([each for each, _ in columns]))
    rpm, sense = (values[np.searchsorted(each, rows, "right") - 1] for each, values in columns)
    speed = np.asarray(rpm * sense, np.float64)
    changes = np.flatnonzero(np.diff(speed, prepend=0.0) != 0.0)
    return rows[changes], speed[changes]


def waiting_rows(run: Run) -> Iterator[tuple[int, int]]:
    """Yield the changes for which a motion at feed waits, by their places in ``spindle_targets``, and that row."""
    rows, speed = spindle_targets(run)
    feeds = np.flatnonzero(run.kind != Kind.RAPID)
    before = np.concatenate((np.zeros(1), speed[:-1]))
    for k in np.flatnonzero((speed != 0.0) & (speed * before <= 0.0)).tolist():
        at = int(np.searchsorted(feeds, rows[k]))
        until = rows[k + 1] if k + 1 < len(rows) else len(run)
        if at < len(feeds) and feeds[at] < until:
            yield k, int(feeds[at])
