"""What F per minute counts in a block in which rotary axes turn and nobody holds the tip.

With TCP, and where no rotary axis turns, that is the tip's way. Without TCP each control has its own rule; the readers
of the families say which, and docs/reader.md from where it is known.
"""

from enum import IntEnum
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

#: Rotary axes that turn by less than this, degrees, stand still.
NO_ROTATION: Final = 1e-9

#: Slides that move by less than this, mm, rest.
_NO_TRAVEL: Final = 1e-9

#: Share of a block over which the speed at its start is taken.
_START_SHARE: Final = 1e-5


class FeedPath(IntEnum):
    """The rule of a control.

    SLIDES  the way of the slides, and the rotary axes arrive with them; where no slide moves, the degrees of the axis
            that turns farthest
    AXES    all axes together as one way, a degree as a millimetre
    TIP     the way that the tip would make at the speed that it has at the block's start
    """

    SLIDES = 0
    AXES = 1
    TIP = 2


def feed_path_lengths(machine: Machine, before: Floats, after: Floats, path: Codes) -> Floats:
    """(k,) float64: what F counts on k ways of the axes, mm or degrees; it takes that over F to go them.

    Parameters
    ----------
    before, after : (k, 5) float64
        Axis values at both ends, as they wind.
    path : (k,) uint8
        A ``FeedPath`` for each.
    """
    steps = after - before
    slides = np.linalg.norm(steps[:, list(machine.linear)], axis=1)
    turned = np.abs(steps[:, list(machine.rotary)]).max(axis=1)
    way: Floats = np.where(slides < _NO_TRAVEL, turned, slides)
    together = path == FeedPath.AXES
    way[together] = np.linalg.norm(steps[together], axis=1)
    start = path == FeedPath.TIP
    if start.any():
        tip, on = (forward(machine, before[start] + share * steps[start])[0] for share in (0.0, _START_SHARE))
        way[start] = np.linalg.norm(on - tip, axis=1) / _START_SHARE
    return way


def row_feed_path_lengths(run: Run, rows: Ints) -> Floats:
    """(k,) float64: what F per minute counts in rows, in any order, where that is not the tip's way; else NaN."""
    way = np.full(len(rows), np.nan)
    without = ~run.state.tcp.at(rows)
    if not without.any():
        return way
    free = np.flatnonzero(without & (run.kind[rows] == Kind.LINEAR) & (run.state.feed_mode.at(rows) == 94))
    if not len(free):
        return way
    before = run.rotary[rows[free] - 1]
    before[rows[free] < 1] = run.start[list(run.machine.rotary)]
    led = free[np.abs(run.rotary[rows[free]] - before).max(axis=1) > NO_ROTATION]
    if len(led):
        there = rows[led]
        ends = run.positions(there - 1).joints, run.positions(there).joints
        way[led] = feed_path_lengths(run.machine, *ends, run.state.feed_path.at(there))
    return way
