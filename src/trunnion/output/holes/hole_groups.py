"""Holes of one cycle in groups: those of one height follow each other, and each file gets as many as fit."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.family_writer import WordEvent
from trunnion.controls.words import NumberFormat
from trunnion.model.frames import TURNING_NOISE
from trunnion.model.motion import Motion
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.records import dataclass

#: Writes holes of one height in one file: the first row of that height, the rows from and to, the events at the first
#: of them, and the phase comment that was written last; returns the new one.
WriteGroup = Callable[[int, int, int, Sequence[WordEvent], int], int]


@dataclass(frozen=True, slots=True, eq=False)
class HoleRows:
    """Rows ``first`` to ``last`` (excluded) of a motion, which are holes, and the events that join their blocks."""

    motion: Motion
    first: int
    last: int
    joining_events: Sequence[WordEvent]


def write_hole_groups(
    blocks: MotionBlockWriter, rows: HoleRows, heights: Floats, phase: int, write_group: WriteGroup
) -> int:
    """Write holes; a new group begins where the printed height changes and at every event.

    heights  (n,) float64: of the n holes, mm
    phase    index of the phase comment that was written last

    int  index of the phase comment that was written last
    """
    motion, first, last, joining_events = rows.motion, rows.first, rows.last, rows.joining_events
    noise = 0.0 if motion.plane is None else TURNING_NOISE
    changes = [first + k for k in _changes(heights, blocks.writer.word("X").format, noise)]
    edges = {first, last, *changes, *(event.row for event in joining_events if first <= event.row <= last)}
    for begin, end in pairwise(sorted(edges)):
        row = begin
        while row < end:
            fitting, phase = blocks.fitting_holes(motion, row, phase)
            stop = min(row + fitting, end)
            phase = write_group(begin, row, stop, [event for event in joining_events if event.row == row], phase)
            row = stop
    blocks.progress(last - first)
    return phase


def _changes(heights: Floats, number_format: NumberFormat, noise: float) -> list[int]:
    """Return indices of the holes whose height prints otherwise than that of the first of their group, by more than
    noise.
    """
    printed = number_format.counts(heights)
    changes, first = list[int](), 0
    for k in (1 + np.flatnonzero(np.diff(printed))).tolist():
        if printed[k] != printed[first] and abs(heights[k] - heights[first]) > noise:
            changes.append(k)
            first = k
    return changes
