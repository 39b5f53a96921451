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
from trunnion.controls.family import EACH_HOLE, WordEvent
from trunnion.controls.words import counts
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, Operation
from trunnion.output.motion_blocks import Blocks
from trunnion.output.program import settings_of
from trunnion.planning.holes.cycles import Cycle, CycleError, Turning, cycle_of, feed_of

#: Tool axes are the same when no component differs by more than this.
_SAME = 1e-7

#: Heights are the same within this, mm.
_NEAR = 1e-6


def write_positions(
    blocks: Blocks, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: CycleOn
) -> int:
    """Rows ``first`` to ``last`` as holes along the tool, with the events that join them; as ``Blocks.rows``."""
    said = cycle_of(cycle)
    moves = motion.operation.moves
    heights = np.einsum("ij,ij->i", moves.tip[first:last], moves.axis[first:last])
    printed = counts(heights, blocks.writer.word("X").format.decimals)
    ends = {0, *(np.flatnonzero(np.diff(printed)) + 1).tolist(), *(e.row - first for e in joining), last - first}
    over = replace(motion, operation=replace(motion.operation, moves=replace(moves, tip=_left(motion.operation))))
    starts = sorted(k for k in ends if 0 <= k <= last - first)
    for k, end in pairwise(starts):
        row = first + k
        while row < first + end:
            fitting, text = blocks.holes(over, row, text)
            stop, here = min(row + fitting, first + end), [event for event in joining if event.row == row]
            text = _of_one_height(blocks, over, row, stop, here, text, said, float(heights[k]))
            row = stop
    blocks.progress(last - first)
    return text


def _of_one_height(
    blocks: Blocks,
    over: Motion,
    first: int,
    last: int,
    joining: Sequence[WordEvent],
    text: int,
    cycle: Cycle,
    top: float,
) -> int:
    """Holes whose points are as far along their axes; ``over``: the motion with its tips over them."""
    moves, control = over.operation.moves, blocks.control
    if first == 0:
        text = blocks.chunk(over, 0, 1, joining, text)
    else:
        for event in joining:
            blocks.event_block(event)
        text = _up(blocks, over, first, cycle, text)
    turning = None if blocks.spindle is None else Turning(blocks.spindle.rpm, blocks.spindle.sense)
    feed, per_rev = feed_of(cycle, turning, float(moves.feed[first]), bool(moves.per_rev[first]))
    formats = control.number_formats(over.three_axis)
    lines = blocks.family.hole_call(cycle, top, turning, settings_of(blocks.program), formats)
    code = control.codes["feed_per_revolution" if per_rev else "feed_per_minute"]
    blocks.block({"feed_mode": blocks.use_feed_mode(code), "feed": blocks.count("feed", feed)})
    if EACH_HOLE in lines:
        after = [line for line in lines if line != EACH_HOLE]
        for row in range(first, last):
            text = blocks.chunk(over, row, row + 1, (), text, anew=True)
            blocks.lines(after)
        return text
    blocks.lines(lines)
    text = blocks.chunk(over, first, last, (), text, anew=True)
    blocks.lines(blocks.family.hole_end())
    return text


def _up(blocks: Blocks, over: Motion, first: int, cycle: Cycle, text: int) -> int:
    """Draw the tool back at rapid, along its axis, where it is lower than the next hole with this axis wants it."""
    moves = over.operation.moves
    assert cycle.retract is not None
    axis, before = moves.axis[first], moves.tip[first - 1]
    lacks = float((moves.tip[first] - before) @ axis) - cycle.retract + cycle.above
    if np.abs(moves.axis[first - 1] - axis).max() > _SAME or lacks < _NEAR:
        return text
    tip, kind = moves.tip.copy(), moves.kind.copy()
    tip[first - 1], kind[first - 1] = before + lacks * axis, Kind.RAPID
    raised = replace(over, operation=replace(over.operation, moves=replace(moves, tip=tip, kind=kind)))
    return blocks.chunk(raised, first - 1, first, (), text)


def check_positions(operation: Operation) -> Iterator[CycleError]:
    """Why holes cannot be made one after the other along a tool that turns between them."""
    moves, left = operation.moves, _left(operation)
    cycles = _cycles(operation)
    for row, cycle in cycles.items():
        line = int(moves.line[row])
        if moves.kind[row] != Kind.RAPID:
            yield CycleError("a retreat of the rotary axes among holes", "leave the setting holes out", line)
        if row == 0:
            continue
        before = cycles.get(row - 1)
        turned = bool(np.abs(moves.axis[row] - moves.axis[row - 1]).max() > _SAME)
        way = left[row - 1], left[row]
        spare = _spare(way, moves.tip[row], moves.axis[row], cycle.above)
        if turned and before is not None:
            lowest = _lowest(spare, _spare(way, moves.tip[row - 1], moves.axis[row - 1], before.above))
        elif turned or moves.kind[row - 1] != Kind.RAPID:
            lowest = spare[0]
        else:
            continue
        if lowest < -_NEAR:
            what = f"on the straight way to this hole the tool would be {-lowest:.3f} mm below the height of RAPTO"
            yield CycleError(what, "put RAPID points between the holes, or raise RTRCTO", line)


def _cycles(operation: Operation) -> dict[int, Cycle]:
    """Rows that are holes, each with what its cycle asks for."""
    events = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [event.row for event in events[1:]] + [len(operation.moves)]
    found: dict[int, Cycle] = {}
    for event, end in zip(events, ends, strict=True):
        if isinstance(event, CycleOn):
            found |= dict.fromkeys(range(event.row, end), cycle_of(event))
    return found


def _left(operation: Operation) -> Floats:
    """(n, 3): where the tip is left at each row: drawn back along the tool, where the row is a hole."""
    back = np.zeros(len(operation.moves))
    for row, cycle in _cycles(operation).items():
        back[row] = cycle.retract or 0.0
    return np.asarray(operation.moves.tip + back[:, None] * operation.moves.axis)


def _spare(way: tuple[Floats, Floats], point: Floats, axis: Floats, above: float) -> tuple[float, float]:
    """How much higher than ``above`` over a hole the ends of a way are, mm."""
    here, there = way
    return float((here - point) @ axis) - above, float((there - point) @ axis) - above


def _lowest(one: tuple[float, float], other: tuple[float, float]) -> float:
    """The least, on a straight way, of the greater of two heights, which are given at its ends."""
    apart = one[0] - other[0], one[1] - other[1]
    ends = min(max(one[0], other[0]), max(one[1], other[1]))
    if apart[0] * apart[1] >= 0.0:
        return ends
    part = apart[0] / (apart[0] - apart[1])
    return min(ends, one[0] + part * (one[1] - one[0]))
