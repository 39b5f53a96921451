"""How long a run takes: what each row asks for, within what the axes can do (``trunnion.machines.motion_time``).

A row at feed takes its length at its feed, a rapid what its slowest axis needs, and both the ramps that accelerations
ask for, with a look ahead over the corners. A dwell takes what it says, before the next row; what a change of the tool
or a stop takes nobody knows here, but the axes stop for them.
"""

import math
from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines.motion_time import row_seconds
from trunnion.model.run import PositionChunk, Run

#: What the axes stand still for.
_STOPS = ("dwell", "stop", "tool_change", "end")


class RunTimer:
    """Gathers what the time of a run is worked out from."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._steps = np.empty((len(run), 5))
        self._times = np.empty((4, len(run)))

    def take(self, first: int, end: int, poses: PositionChunk, times: Floats) -> None:
        """Add rows, in order, with what ``axis_motion_rows`` writes of their times."""
        self._steps[first:end] = np.diff(poses.joints, axis=0)
        self._times[:, first:end] = times

    def result(self) -> tuple[Floats, Floats]:
        """Seconds, and speed of the tip in mm/min, of all rows.

        The axes stand still for a dwell, a stop and a change of the tool, and where what the feed means changes.
        """
        run = self._run
        length, rate, way, meant = self._times
        moving = np.flatnonzero(length > 0.0)
        stop = np.zeros(len(run), np.bool_)
        stop[moving[:-1][np.diff(meant[moving]) != 0.0]] = True
        rows = [event.before_row - 1 for event in run.events if event.kind in _STOPS]
        stop[[row for row in rows if row >= 0]] = True
        seconds = row_seconds(run.machine, self._steps, length, rate, stop)
        with np.errstate(divide="ignore", invalid="ignore"):
            tip_feed = np.where(seconds > 0.0, 60.0 * way / seconds, 0.0)
        for row, dwell in self._dwells():
            seconds[row] += dwell
        return seconds, tip_feed

    def _dwells(self) -> Iterator[tuple[int, float]]:
        """The row that each dwell makes longer, and seconds; turns of a spindle whose speed is not known take none."""
        last = len(self._run) - 1
        for event in self._run.events:
            if event.kind == "dwell" and isinstance(event.value, float) and math.isfinite(event.value) and last >= 0:
                row = min(event.before_row, last)
                rpm = float(self._run.state.rpm[row]) if event.value < 0.0 else 60.0
                yield row, abs(event.value) * 60.0 / rpm if rpm > 0.0 else 0.0
