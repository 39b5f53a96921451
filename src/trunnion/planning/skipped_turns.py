"""Turns of the tool past blocks that may be skipped: with the skip switch on they have no points between.

In:     a motion before and after points were inserted between its rows.
Out:    where the tool turns farther behind skipped blocks than one block may.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import BlockSkip, Kind
from trunnion.planning.linearization.default_points import rows_off_path
from trunnion.planning.request import PreparedOperation
from trunnion.planning.rotary_positions import continuous_positions
from trunnion.planning.skipped_ways import Stretch, skipped_stretches, way_skipped

#: Smaller rotary motion is none, degrees.
_STILL: Final = 1e-3


def turns_past_skipped(prepared: PreparedOperation, motion: Motion, linearized: Motion) -> Iterator[Problem]:
    """Yield the stretches past which the tool turns too far, or behind which there are points of the way from them.

    Those points stand in blocks that are not skipped: with the switch on the tool would go to them from elsewhere.

    motion      the rows of an operation, or a part of it
    linearized  the same with points between
    """
    operation = motion.operation
    for stretch in skipped_stretches(operation):
        if not 0 < stretch.first < stretch.end < len(operation.moves):
            continue
        if motion.mode.goes_straight:
            if _turns(motion, stretch) or _has_points_behind(motion, linearized, stretch):
                said = Wording("CTL460", "turn_skipped", on=stretch.on)
                yield Problem(prepared.file, int(operation.moves.line[stretch.end]), said)
        elif _leaves_circle(prepared, motion, stretch) or _has_points_behind(motion, linearized, stretch):
            yield way_skipped(prepared.file, operation, stretch)


def _turns(motion: Motion, stretch: Stretch) -> bool:
    """Whether a rotary axis turns from the row before a stretch to the CL point behind it, or on the way to it."""
    line = motion.operation.moves.line[stretch.end - 1 :]
    behind = stretch.end + int(np.argmax(line[1:] != line[0]))  # rows of that way have the line of the row before
    turns = motion.rotary[stretch.end : behind + 1] - motion.rotary[stretch.first - 1]
    return float(np.abs(turns).max()) > _STILL


def _has_points_behind(motion: Motion, linearized: Motion, stretch: Stretch) -> bool:
    """Whether points were inserted between the last row of a stretch and the one behind it."""
    wanted, after = motion.operation.moves.tip[stretch.end], linearized.operation
    ends = (event for event in after.events if isinstance(event, BlockSkip) and not event.on)
    begin = next(event.row for event in ends if event.line == stretch.off)
    return not np.array_equal(after.moves.tip[begin], wanted)


def _leaves_circle(prepared: PreparedOperation, motion: Motion, stretch: Stretch) -> bool:
    """Whether the rotary axes, turning evenly past a stretch into a cut, lead the tool axis too far off its path."""
    moves, machine = motion.operation.moves, prepared.request.machine
    rows = np.array([stretch.first - 1, stretch.end])
    if moves.kind[stretch.end] == Kind.RAPID or not motion.mode.is_simultaneous:
        return False
    positions = continuous_positions(machine, motion.rotary[rows])
    tolerance = prepared.request.options.default_axis_tolerance.of(motion.operation)
    return bool(len(rows_off_path(machine, moves.select(rows), positions, tolerance)))
