"""How long a run takes: what each row asks for, within what the axes can do (``trunnion.machines.motion_time``).

A row at feed takes its length at its feed, and a rapid what its slowest axis needs; accelerations add ramps, with a
look ahead over corners. A dwell adds its seconds to the row at whose end the tool waits. How long a tool change or a
stop takes is not known, but the axes stop for them.
"""

import math
from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines.motion_time import row_seconds
from trunnion.model.run import PositionChunk, Run

#: Events for which the axes stand still.
_STOPS = ("dwell", "stop", "tool_change", "end")


class RunTimer:
    """Collects what determines the time of a run."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._steps = np.empty((len(run), 5))
        self._times = np.empty((4, len(run)))

    def add(self, first: int, end: int, positions: PositionChunk, times: Floats) -> None:
        """Add rows, in order, with the ``times`` that ``axis_motion_rows`` writes for them."""
        self._steps[first:end] = np.diff(positions.joints, axis=0)
        self._times[:, first:end] = times

    def result(self) -> tuple[Floats, Floats]:
        """Seconds, and speed of the tip in mm/min, of all rows, (n,) each.

        The axes stand still for a dwell, a stop and a tool change, and where the feed begins to count another length.
        """
        run = self._run
        length, feed, travel, counts = self._times
        moving = np.flatnonzero(length > 0.0)
        stop = np.zeros(len(run), np.bool_)
        stop[moving[:-1][np.diff(counts[moving]) != 0.0]] = True
        rows = [event.before_row - 1 for event in run.events if event.kind in _STOPS]
        stop[[row for row in rows if row >= 0]] = True
        seconds = row_seconds(run.machine, self._steps, length, feed, stop)
        with np.errstate(divide="ignore", invalid="ignore"):
            tip_feed = np.where(seconds > 0.0, 60.0 * travel / seconds, 0.0)
        for row, dwell in self._dwells():
            seconds[row] += dwell
        return seconds, tip_feed

    def _dwells(self) -> Iterator[tuple[int, float]]:
        """The row before each dwell, and its seconds; revolutions of a spindle of unknown speed take none."""
        last = len(self._run) - 1
        for event in self._run.events:
            if event.kind == "dwell" and isinstance(event.value, float) and math.isfinite(event.value) and last >= 0:
                rpm = float(self._run.state.rpm[min(event.before_row, last)]) if event.value < 0.0 else 60.0
                yield max(event.before_row - 1, 0), abs(event.value) * 60.0 / rpm if rpm > 0.0 else 0.0
