"""Drilling cycles under TCP: the tool turns from hole to hole, and a cycle drills along it.

In:     rows that are holes, each with its own tool axis.
Out:    a position block over each hole, at the retract height along the tool, and the lines of its cycle. Heights of a
        cycle are measured along the tool axis from the zero of the work offset, about which the frame turns.

From hole to hole the tip goes straight. All along that path it must be above the point of one of the two holes, seen
along that hole's axis; where it is not, the CL file must have points between.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.family_writer import EACH_HOLE, WordEvent
from trunnion.messages import Wording
from trunnion.model.frames import without_turning_noise
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, Operation
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.holes.hole_groups import HoleRows, write_hole_groups
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, SpindleState, cycle_feed, cycle_from_event

#: Tool axes are equal if no component differs by more.
_SAME_AXIS = 1e-7

#: Heights are equal within this, mm.
_SAME_HEIGHT = 1e-6


def write_holes_under_tcp(blocks: MotionBlockWriter, rows: HoleRows, phase: int, cycle: Cycle) -> int:
    """Write holes along the tool; as ``MotionBlockWriter.write_rows``."""
    operation, first = rows.motion.operation, rows.first
    tip, axis = operation.moves.tip[first : rows.last], operation.moves.axis[first : rows.last]
    heights = without_turning_noise(np.einsum("ij,ij->i", tip, axis))
    moves = replace(operation.moves, tip=_retracted_tips(operation))
    retracted = replace(rows.motion, operation=replace(operation, moves=moves))
    holes = _Holes(blocks, retracted, cycle)
    return write_hole_groups(
        blocks,
        replace(rows, motion=retracted),
        heights,
        phase,
        lambda begin, *group: holes.write(float(heights[begin - first]), *group),
    )


class _Holes:
    """Writes the holes of one cycle; ``motion`` has the tips retracted over them."""

    def __init__(self, blocks: MotionBlockWriter, motion: Motion, cycle: Cycle) -> None:
        self._motion = motion
        self._blocks, self._cycle = blocks, cycle

    def write(self, top: float, first: int, last: int, joining_events: Sequence[WordEvent], phase: int) -> int:
        """Write the holes of rows ``first`` to ``last``, whose points are at ``top`` along their axes, mm.

        Returns the index of the phase comment that was written last.
        """
        blocks, motion, moves = self._blocks, self._motion, self._motion.operation.moves
        if first == 0:
            phase = blocks.write_chunk(motion, 0, 1, joining_events, phase)
        else:
            for event in joining_events:
                blocks.write_event(event)
            phase = self._raise(first, phase)
        spindle = None if blocks.spindle is None else SpindleState(blocks.spindle.rpm, blocks.spindle.sense)
        feed, per_rev = cycle_feed(self._cycle, spindle, float(moves.feed[first]), bool(moves.per_rev[first]))
        formats = blocks.control.number_formats(motion.three_axis)
        settings = blocks.program.effective_settings()
        lines = blocks.family.cycle_call(self._cycle, top, spindle, settings, formats)
        mode = blocks.control.codes["feed_per_revolution" if per_rev else "feed_per_minute"]
        feed_word, count = blocks.feeds.count(feed, per_rev)
        blocks.write_block({"feed_mode": blocks.feeds.use_mode(mode), feed_word: count})
        if EACH_HOLE in lines:
            hole = [line for line in lines if line != EACH_HOLE]
            for row in range(first, last):
                phase = blocks.write_chunk(motion, row, row + 1, (), phase, repeat_point=True)
                blocks.write_lines(hole)
            return phase
        blocks.write_lines(lines)
        phase = blocks.write_chunk(motion, first, last, (), phase, repeat_point=True)
        blocks.write_lines(blocks.family.cycle_cancel())
        return phase

    def _raise(self, first: int, phase: int) -> int:
        """Raise the tool along its axis at rapid, if it is lower than the next hole with the same axis needs it."""
        moves = self._motion.operation.moves
        assert self._cycle.retract_height is not None
        axis, before = moves.axis[first], moves.tip[first - 1]
        missing = float((moves.tip[first] - before) @ axis) - self._cycle.retract_height + self._cycle.rapid_height
        if np.abs(moves.axis[first - 1] - axis).max() > _SAME_AXIS or missing < _SAME_HEIGHT:
            return phase
        tip, kind = moves.tip.copy(), moves.kind.copy()
        tip[first - 1], kind[first - 1] = before + missing * axis, Kind.RAPID
        raised = replace(self._motion.operation, moves=replace(moves, tip=tip, kind=kind))
        return self._blocks.write_chunk(replace(self._motion, operation=raised), first - 1, first, (), phase)


def check_holes_under_tcp(operation: Operation) -> Iterator[HoleCycleError]:
    """Yield why holes cannot be drilled one after the other while the tool turns between them."""
    moves, left = operation.moves, _retracted_tips(operation)
    cycles = _cycle_by_row(operation)
    for row, cycle in cycles.items():
        line = int(moves.line[row])
        if row == 0:
            continue
        before = cycles.get(row - 1)
        axis_changes = bool(np.abs(moves.axis[row] - moves.axis[row - 1]).max() > _SAME_AXIS)
        path = left[row - 1], left[row]
        clearance = _clearance(path, moves.tip[row], moves.axis[row], cycle.rapid_height)
        if axis_changes and before is not None:
            of_last_hole = _clearance(path, moves.tip[row - 1], moves.axis[row - 1], before.rapid_height)
            lowest = _lowest_clearance(clearance, of_last_hole)
        elif axis_changes or moves.kind[row - 1] != Kind.RAPID:
            lowest = clearance[0]
        else:
            continue
        if lowest < -_SAME_HEIGHT:
            yield HoleCycleError(Wording("CTL380", "straight_way_hole", lowest=-lowest), line)


def _cycle_by_row(operation: Operation) -> dict[int, Cycle]:
    """Return the cycle of every row that is a hole."""
    events = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [event.row for event in events[1:]] + [len(operation.moves)]
    found: dict[int, Cycle] = {}
    for event, end in zip(events, ends, strict=True):
        if isinstance(event, CycleOn):
            found |= dict.fromkeys(range(event.row, end), cycle_from_event(event))
    return found


def _retracted_tips(operation: Operation) -> Floats:
    """(n, 3): where the tip is after each row: at holes, retracted along the tool."""
    height = np.zeros(len(operation.moves))
    for row, cycle in _cycle_by_row(operation).items():
        height[row] = cycle.retract_height or 0.0
    return np.asarray(operation.moves.tip + height[:, None] * operation.moves.axis)


def _clearance(path: tuple[Floats, Floats], point: Floats, axis: Floats, rapid_height: float) -> tuple[float, float]:
    """How far the ends of a path are above the rapid height over a hole, mm."""
    start, end = path
    return float((start - point) @ axis) - rapid_height, float((end - point) @ axis) - rapid_height


def _lowest_clearance(one: tuple[float, float], other: tuple[float, float]) -> float:
    """Return the least, along a straight path, of the greater of two clearances, each given at both ends."""
    difference = one[0] - other[0], one[1] - other[1]
    ends = min(max(one[0], other[0]), max(one[1], other[1]))
    if difference[0] * difference[1] >= 0.0:
        return ends
    crossing = difference[0] / (difference[0] - difference[1])
    return min(ends, one[0] + crossing * (one[1] - one[0]))
