"""The path length that F refers to in blocks whose rotary axes turn without TCP.

With TCP, and where no rotary axis turns, it is the path of the tool tip. Without TCP every control has a rule of its
own; the reader of its family sets it, and ``docs/reader.md`` gives the source of each rule.
"""

from enum import IntEnum
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

#: Rotary axes that turn by no more than this, degrees, count as still.
NO_ROTATION: Final = 1e-9

#: Slides that move by less than this, mm, count as still.
_NO_TRAVEL: Final = 1e-9

#: The share of a block over which the speed at its start is measured.
_START_SHARE: Final = 1e-5


class FeedPath(IntEnum):
    """The rule of a control.

    SLIDES  the path of the slides, with which the rotary axes arrive; where no slide moves, the degrees of the axis
            that turns farthest
    AXES    all axes together as one path, a degree counting as a millimetre
    TIP     the path that the tip would cover at the speed that it has at the start of the block
    ENDS    the straight line between the tips at both ends; where they are one, the degrees of the axis that turns
            farthest
    """

    SLIDES = 0
    AXES = 1
    TIP = 2
    ENDS = 3


def feed_path_lengths(machine: Machine, before: Floats, after: Floats, path: Codes) -> Floats:
    """Return the lengths that F refers to for k motions of the axes, (k,) mm or degrees; length over F is the time.

    before, after  (k, 5) float64: axis values at both ends, rotary values with all turns
    path           (k,) uint8: A ``FeedPath`` for each motion
    """
    steps = after - before
    slides = np.linalg.norm(steps[:, list(machine.linear)], axis=1)
    turned = np.abs(steps[:, list(machine.rotary)]).max(axis=1)
    length: Floats = np.where(slides < _NO_TRAVEL, turned, slides)
    together = path == FeedPath.AXES
    length[together] = np.linalg.norm(steps[together], axis=1)
    at_start = path == FeedPath.TIP
    if at_start.any():
        tip, shortly_after = (
            forward(machine, before[at_start] + share * steps[at_start])[0] for share in (0.0, _START_SHARE)
        )
        length[at_start] = np.linalg.norm(shortly_after - tip, axis=1) / _START_SHARE
    at_ends = path == FeedPath.ENDS
    if at_ends.any():
        way = np.linalg.norm(forward(machine, after[at_ends])[0] - forward(machine, before[at_ends])[0], axis=1)
        length[at_ends] = np.where(way < _NO_TRAVEL, turned[at_ends], way)
    return length


def row_feed_path_lengths(run: Run, rows: Ints) -> Floats:
    """Return the lengths that F in mm/min refers to in rows, (k,), in any order; NaN where it is the tip's path."""
    length = np.full(len(rows), np.nan)
    without_tcp = ~run.state.tcp.at(rows) & (run.state.feed_path.at(rows) != FeedPath.ENDS)
    if not without_tcp.any():
        return length
    candidates = np.flatnonzero(without_tcp & (run.kind[rows] == Kind.LINEAR) & (run.state.feed_mode.at(rows) == 94))
    if not len(candidates):
        return length
    before = run.rotary[rows[candidates] - 1]
    before[rows[candidates] < 1] = run.start[list(run.machine.rotary)]
    turning = candidates[np.abs(run.rotary[rows[candidates]] - before).max(axis=1) > NO_ROTATION]
    if len(turning):
        those = rows[turning]
        ends = run.positions(those - 1).joints, run.positions(those).joints
        path = run.state.feed_path.at(those)
        for machine, at in run.by_machine(those):
            length[turning[at]] = feed_path_lengths(machine, ends[0][at], ends[1][at], path[at])
    return length
