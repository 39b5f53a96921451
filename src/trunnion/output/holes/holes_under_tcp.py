"""Blocks of holes under TCP: the tool turns from hole to hole, and a cycle drills along it.

In:     rows that are holes, each with a tool axis of its own.
Out:    a position block over each hole, at the retract height along the tool, and the lines of its cycle. Heights of a
        cycle count along the tool axis from the work offset's zero, where the frame has its zero that is turned to it.

On the way from hole to hole the tip goes straight. That way must be above the point of one of both holes all the time,
seen along its axis; where it is not, the CL file has to say a way round.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.family_writer import EACH_HOLE, WordEvent
from trunnion.controls.words import round_to_counts
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, Operation
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.program import effective_settings
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, SpindleState, cycle_feed, cycle_from_event

#: Tool axes are the same when no component differs by more than this.
_SAME = 1e-7

#: Heights are the same within this, mm.
_NEAR = 1e-6


def write_holes_under_tcp(
    blocks: MotionBlockWriter,
    motion: Motion,
    first: int,
    last: int,
    joining_events: Sequence[WordEvent],
    text: int,
    cycle: CycleOn,
) -> int:
    """Rows ``first`` to ``last`` as holes along the tool, with the events that join them; as
    ``MotionBlockWriter.write_rows``."""
    said = cycle_from_event(cycle)
    moves = motion.operation.moves
    heights = np.einsum("ij,ij->i", moves.tip[first:last], moves.axis[first:last])
    printed = round_to_counts(heights, blocks.writer.word("X").format.decimals)
    ends = {0, *(np.flatnonzero(np.diff(printed)) + 1).tolist(), *(e.row - first for e in joining_events), last - first}
    over = replace(
        motion, operation=replace(motion.operation, moves=replace(moves, tip=_retracted_tips(motion.operation)))
    )
    starts = sorted(k for k in ends if 0 <= k <= last - first)
    for k, end in pairwise(starts):
        row = first + k
        while row < first + end:
            fitting, text = blocks.fitting_holes(over, row, text)
            stop, here = min(row + fitting, first + end), [event for event in joining_events if event.row == row]
            text = _write_equal_heights(blocks, over, row, stop, here, text, said, float(heights[k]))
            row = stop
    blocks.progress(last - first)
    return text


def _write_equal_heights(
    blocks: MotionBlockWriter,
    over: Motion,
    first: int,
    last: int,
    joining_events: Sequence[WordEvent],
    text: int,
    cycle: Cycle,
    top: float,
) -> int:
    """Holes whose points are as far along their axes; ``over``: the motion with its tips over them."""
    moves, control = over.operation.moves, blocks.control
    if first == 0:
        text = blocks.write_chunk(over, 0, 1, joining_events, text)
    else:
        for event in joining_events:
            blocks.event_block(event)
        text = _retract_along_tool(blocks, over, first, cycle, text)
    turning = None if blocks.spindle is None else SpindleState(blocks.spindle.rpm, blocks.spindle.sense)
    feed, per_rev = cycle_feed(cycle, turning, float(moves.feed[first]), bool(moves.per_rev[first]))
    formats = control.number_formats(over.three_axis)
    lines = blocks.family.cycle_call(cycle, top, turning, effective_settings(blocks.program), formats)
    code = control.codes["feed_per_revolution" if per_rev else "feed_per_minute"]
    blocks.write_block({"feed_mode": blocks.use_feed_mode(code), "feed": blocks.to_count("feed", feed)})
    if EACH_HOLE in lines:
        after = [line for line in lines if line != EACH_HOLE]
        for row in range(first, last):
            text = blocks.write_chunk(over, row, row + 1, (), text, repeat_point=True)
            blocks.write_lines(after)
        return text
    blocks.write_lines(lines)
    text = blocks.write_chunk(over, first, last, (), text, repeat_point=True)
    blocks.write_lines(blocks.family.cycle_cancel())
    return text


def _retract_along_tool(blocks: MotionBlockWriter, over: Motion, first: int, cycle: Cycle, text: int) -> int:
    """Draw the tool back at rapid, along its axis, where it is lower than the next hole with this axis wants it."""
    moves = over.operation.moves
    assert cycle.retract_height is not None
    axis, before = moves.axis[first], moves.tip[first - 1]
    lacks = float((moves.tip[first] - before) @ axis) - cycle.retract_height + cycle.rapid_height
    if np.abs(moves.axis[first - 1] - axis).max() > _SAME or lacks < _NEAR:
        return text
    tip, kind = moves.tip.copy(), moves.kind.copy()
    tip[first - 1], kind[first - 1] = before + lacks * axis, Kind.RAPID
    raised = replace(over, operation=replace(over.operation, moves=replace(moves, tip=tip, kind=kind)))
    return blocks.write_chunk(raised, first - 1, first, (), text)


def check_holes_under_tcp(operation: Operation) -> Iterator[HoleCycleError]:
    """Why holes cannot be made one after the other along a tool that turns between them."""
    moves, left = operation.moves, _retracted_tips(operation)
    cycles = _cycle_by_row(operation)
    for row, cycle in cycles.items():
        line = int(moves.line[row])
        if moves.kind[row] != Kind.RAPID:
            yield HoleCycleError("a retreat of the rotary axes among holes", "leave the setting holes out", line)
        if row == 0:
            continue
        before = cycles.get(row - 1)
        turned = bool(np.abs(moves.axis[row] - moves.axis[row - 1]).max() > _SAME)
        way = left[row - 1], left[row]
        spare = _clearance(way, moves.tip[row], moves.axis[row], cycle.rapid_height)
        if turned and before is not None:
            lowest = _lowest_clearance(
                spare, _clearance(way, moves.tip[row - 1], moves.axis[row - 1], before.rapid_height)
            )
        elif turned or moves.kind[row - 1] != Kind.RAPID:
            lowest = spare[0]
        else:
            continue
        if lowest < -_NEAR:
            what = f"on the straight way to this hole the tool would be {-lowest:.3f} mm below the height of RAPTO"
            yield HoleCycleError(what, "put RAPID points between the holes, or raise RTRCTO", line)


def _cycle_by_row(operation: Operation) -> dict[int, Cycle]:
    """Rows that are holes, each with what its cycle asks for."""
    events = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [event.row for event in events[1:]] + [len(operation.moves)]
    found: dict[int, Cycle] = {}
    for event, end in zip(events, ends, strict=True):
        if isinstance(event, CycleOn):
            found |= dict.fromkeys(range(event.row, end), cycle_from_event(event))
    return found


def _retracted_tips(operation: Operation) -> Floats:
    """(n, 3): where the tip is left at each row: drawn back along the tool, where the row is a hole."""
    back = np.zeros(len(operation.moves))
    for row, cycle in _cycle_by_row(operation).items():
        back[row] = cycle.retract_height or 0.0
    return np.asarray(operation.moves.tip + back[:, None] * operation.moves.axis)


def _clearance(way: tuple[Floats, Floats], point: Floats, axis: Floats, above: float) -> tuple[float, float]:
    """How much higher than ``above`` over a hole the ends of a way are, mm."""
    here, there = way
    return float((here - point) @ axis) - above, float((there - point) @ axis) - above


def _lowest_clearance(one: tuple[float, float], other: tuple[float, float]) -> float:
    """The least, on a straight way, of the greater of two heights, which are given at its ends."""
    apart = one[0] - other[0], one[1] - other[1]
    ends = min(max(one[0], other[0]), max(one[1], other[1]))
    if apart[0] * apart[1] >= 0.0:
        return ends
    part = apart[0] / (apart[0] - apart[1])
    return min(ends, one[0] + part * (one[1] - one[0]))
