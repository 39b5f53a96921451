"""Blocks of holes: a cycle made modal, or called, at positions of one height each."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Ints
from trunnion.controls.family_writer import EACH_HOLE, FIRST_HOLE, WordEvent
from trunnion.controls.vocabulary import CYCLE_CALL_WORD, HOLES_IN_PLANES, HOLES_SETTING
from trunnion.controls.words import round_to_counts
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CycleOn
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.holes.holes_under_tcp import write_holes_under_tcp
from trunnion.output.program import effective_settings
from trunnion.planning.holes.cycles import Cycle, SpindleState, cycle_feed, cycle_from_event


def write_holes(
    blocks: MotionBlockWriter,
    motion: Motion,
    first: int,
    last: int,
    joining_events: Sequence[WordEvent],
    text: int,
    cycle: CycleOn,
) -> int:
    """Rows ``first`` to ``last`` as holes, with the events that join them; arguments and result as
    ``MotionBlockWriter.write_rows``."""
    if motion.mode is MachiningMode.TCP:
        return write_holes_under_tcp(blocks, motion, first, last, joining_events, text, cycle)
    said = cycle_from_event(cycle)
    place = blocks.writer.word("X").format.decimals
    tops = round_to_counts(np.ascontiguousarray(motion.operation.moves.tip[first:last, 2]), place)
    begins = {
        0,
        *(np.flatnonzero(np.diff(tops)) + 1).tolist(),
        *(e.row - first for e in joining_events if e.row >= first),
    }
    ends = sorted(k for k in begins if k < last - first)
    for k, end in zip(ends, [*ends[1:], last - first], strict=True):
        row = first + k
        while row < first + end:
            fitting, text = blocks.fitting_holes(motion, row, text)
            stop, here = min(row + fitting, first + end), [event for event in joining_events if event.row == row]
            text = _write_equal_heights(blocks, motion, row, stop, here, text, said)
            row = stop
    blocks.progress(last - first)
    return text


def _write_equal_heights(
    blocks: MotionBlockWriter,
    motion: Motion,
    first: int,
    last: int,
    joining_events: Sequence[WordEvent],
    text: int,
    cycle: Cycle,
) -> int:
    """Holes of one height.

    The tool goes to them at the height to which it was drawn back. It begins at the retract height where nothing
    says how high it is, and is drawn up first where it is lower than the next holes want it.
    """
    moves, control, writer = motion.operation.moves, blocks.control, blocks.writer
    assert cycle.retract_height is not None
    top = float(moves.tip[first, 2])
    retract = top + cycle.retract_height
    decimals = writer.word("X").format.decimals
    places = {
        word: round_to_counts(np.ascontiguousarray(moves.tip[first:last, c]), decimals) for c, word in enumerate("XY")
    }
    n = last - first
    rapids = blocks.family.row_words(np.ones(n, np.bool_), np.zeros(n, np.bool_), control.codes)
    rapid = {word: int(column[0]) for word, column in rapids.items()} | {"feed": blocks.rapid_feed}
    over_first = {word: int(column[0]) for word, column in places.items()}
    for event in joining_events:
        if first > 0:
            blocks.event_block(event)
    if first == 0:
        _approach_first_hole(blocks, motion, over_first, rapid, retract, joining_events)
    turning = None if blocks.spindle is None else SpindleState(blocks.spindle.rpm, blocks.spindle.sense)
    feed, per_rev = cycle_feed(cycle, turning, float(moves.feed[first]), bool(moves.per_rev[first]))
    ids, texts = blocks.phase_texts()
    wanted = ids[moves.phase[first:last]]
    phase_lines = np.where(wanted != np.concatenate(([text], wanted[:-1])), wanted, -1)
    formats, settings = (
        control.number_formats(motion.three_axis),
        effective_settings(blocks.program) | {HOLES_SETTING: HOLES_IN_PLANES},
    )
    called = CYCLE_CALL_WORD in blocks.family.WORDS
    said = replace(cycle, feed=feed, per_rev=per_rev) if called else cycle
    lines = blocks.family.cycle_call(said, top, turning, settings, formats)
    each = any(EACH_HOLE in line for line in lines)
    if first > 0:
        exact = control.holes_from == "initial" and retract > top + cycle.rapid_height and not each
        low = retract if exact or control.holes_from == "retract" else top + cycle.rapid_height
        _move_to_height(blocks, rapid, over_first, low, exact)
    repeat_position = {"X": True, "Y": True}  # a point at which the tool already stands gets its block
    if called:
        blocks.write_lines(lines)
        calls = np.full(n, control.codes[CYCLE_CALL_WORD], np.int64)
        writer.write_table({**rapids, **places, CYCLE_CALL_WORD: calls}, repeat_position, phase_lines, texts)
    else:
        plane = {"plane": control.codes["plane_xy"]}
        if "feed_mode" in blocks.family.WORDS and not each:
            code = control.codes["feed_per_revolution" if per_rev else "feed_per_minute"]
            plane["feed_mode"] = blocks.use_feed_mode(code)
        if each:
            _write_one_by_one(blocks, lines, places, [texts[k] if k >= 0 else "" for k in phase_lines.tolist()])
        elif any(FIRST_HOLE in line for line in lines):
            blocks.write_block(plane)
            blocks.write_lines([texts[phase_lines[0]]] if phase_lines[0] >= 0 else [])
            _write_call_with_first_hole(blocks, lines, places, blocks.to_count("feed", feed), phase_lines, texts)
        else:
            blocks.write_block(plane | {"feed": blocks.to_count("feed", feed)})
            blocks.write_lines(lines)
            writer.write_table({**places, "motion": rapids["motion"]}, repeat_position, phase_lines, texts)
        blocks.write_lines(blocks.family.cycle_cancel())
        if control.holes_from == "initial":
            writer.forget("motion")
    blocks.tool_height = retract
    writer.forget("X", "Y", "Z")
    return int(wanted[-1])


def _approach_first_hole(
    blocks: MotionBlockWriter,
    motion: Motion,
    place: Mapping[str, int],
    rapid: Mapping[str, int],
    retract: float,
    joining_events: Sequence[WordEvent],
) -> None:
    """To the retract height over the first hole, in one block or across the tool first."""
    block = {**rapid, **place}
    if blocks.xy_before_z:
        blocks.write_block(block)
    block |= {"Z": blocks.to_count("X", retract), **blocks.first_block_words(motion)}
    for event in joining_events:
        block |= blocks.event_words(event)
    blocks.write_block(block)
    blocks.tool_height, blocks.height_bound = retract, None


def _move_to_height(
    blocks: MotionBlockWriter, rapid: Mapping[str, int], place: Mapping[str, int], low: float, exact: bool
) -> None:
    """No lower than ``low`` before the tool goes to the first hole, or ``exact`` there: as heights are printed."""
    if blocks.height_bound is not None:
        blocks.tool_height = max(blocks.height_bound, low)
        blocks.write_block({**rapid, "Z": blocks.to_count("X", blocks.tool_height)})
        blocks.height_bound = None
    here, there = blocks.to_count("X", blocks.tool_height), blocks.to_count("X", low)
    down = exact and here > there
    if down:  # over the hole first, and not aslant
        blocks.write_block({**rapid, **place})
    if down or blocks.tool_height < low - 1e-9:
        blocks.write_block({**rapid, "Z": there})


def _write_one_by_one(
    blocks: MotionBlockWriter, lines: Sequence[str], places: Mapping[str, Ints], phase_lines: Sequence[str]
) -> None:
    """All lines for each hole, after what is spoken there."""
    writer = blocks.writer
    for x, y, before in zip(places["X"].tolist(), places["Y"].tolist(), phase_lines, strict=True):
        place = f"{writer.print_word('X', x)} {writer.print_word('Y', y)}"
        blocks.write_lines([before, *(line.replace(EACH_HOLE, place) for line in lines)][not before :])


def _write_call_with_first_hole(
    blocks: MotionBlockWriter,
    lines: Sequence[str],
    places: Mapping[str, Ints],
    feed: int,
    phase_lines: Ints,
    texts: Sequence[str],
) -> None:
    """The call of a cycle in the block of its first hole, with F where it is not in force; then the others.

    The blocks of holes say nothing but where they are: any other motion word would end the cycle.
    """
    writer = blocks.writer
    place = " ".join(writer.print_word(word, int(places[word][0])) for word in "XY")
    end = "" if writer.last_count("feed") == feed else f" {writer.print_word('feed', feed)}"
    blocks.write_lines([line.replace(FIRST_HOLE, place) + (end if FIRST_HOLE in line else "") for line in lines])
    if len(places["X"]) > 1:
        others = {word: column[1:] for word, column in places.items()}
        writer.write_table(others, {"X": True, "Y": True}, phase_lines[1:], texts)
