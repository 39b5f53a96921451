"""Blocks of holes: a cycle made modal, or called, at positions of one height each."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Ints
from trunnion.control.blocks import Blocks
from trunnion.control.definition import CALL
from trunnion.control.family import FIRST_HOLE, WordEvent
from trunnion.control.program import settings_of
from trunnion.nc import counts
from trunnion.plan import Motion
from trunnion.plan.holes import Cycle, Turning, cycle_of, feed_of
from trunnion.toolpath import CycleOn


def write_holes(
    blocks: Blocks, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: CycleOn
) -> int:
    """Rows ``first`` to ``last`` as holes, with the events that join them; arguments and result as ``Blocks.rows``."""
    said = cycle_of(cycle)
    decimals = blocks.writer.word("X").format.decimals
    tops = counts(np.ascontiguousarray(motion.operation.moves.tip[first:last, 2]), decimals)
    begins = {0, *(np.flatnonzero(np.diff(tops)) + 1).tolist(), *(e.row - first for e in joining if e.row >= first)}
    ends = sorted(k for k in begins if k < last - first)
    for k, end in zip(ends, [*ends[1:], last - first], strict=True):
        here = [event for event in joining if event.row == first + k]
        text = _of_one_height(blocks, motion, first + k, first + end, here, text, said)
    blocks.progress(last - first)
    return text


def _of_one_height(
    blocks: Blocks, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: Cycle
) -> int:
    """Holes of one height.

    The tool goes to them at the height to which it was drawn back. It begins at the retract height where nothing
    says how high it is, and is drawn up first where it is lower than the next holes want it.
    """
    moves, control, writer = motion.operation.moves, blocks.control, blocks.writer
    assert cycle.retract is not None
    top = float(moves.tip[first, 2])
    retract = top + cycle.retract
    decimals = writer.word("X").format.decimals
    places = {word: counts(np.ascontiguousarray(moves.tip[first:last, c]), decimals) for c, word in enumerate("XY")}
    n = last - first
    rapids = blocks.family.row_words(np.ones(n, np.bool_), np.zeros(n, np.bool_), control.codes)
    rapid = {word: int(column[0]) for word, column in rapids.items()} | {"feed": blocks.rapid_feed}
    place = {word: int(column[0]) for word, column in places.items()}
    for event in joining:
        if first > 0:
            blocks.event_block(event)
    if first == 0:
        _approach(blocks, motion, place, rapid, retract, joining)
    else:
        _to_height(blocks, place, rapid, top + cycle.above, retract)
    turning = None if blocks.spindle is None else Turning(blocks.spindle.rpm, blocks.spindle.sense)
    feed, per_rev = feed_of(cycle, turning, float(moves.feed[first]), bool(moves.per_rev[first]))
    ids, texts = blocks.phase_texts()
    wanted = ids[moves.phase[first:last]]
    spoken = np.where(wanted != np.concatenate(([text], wanted[:-1])), wanted, -1)
    formats, settings = control.number_formats(motion.three_axis), settings_of(blocks.program)
    said_anew = {"X": True, "Y": True}  # a point at which the tool already stands gets its block
    if CALL in blocks.family.WORDS:
        said = replace(cycle, feed=feed, per_rev=per_rev)
        blocks.lines(blocks.family.hole_call(said, top, turning, settings, formats))
        calls = np.full(n, control.codes[CALL], np.int64)
        writer.table({**rapids, **places, CALL: calls}, said_anew, spoken, texts)
    else:
        lines = blocks.family.hole_call(cycle, top, turning, settings, formats)
        if any(FIRST_HOLE in line for line in lines):
            _called_with_hole(blocks, lines, places, blocks.count("feed", feed), per_rev)
        else:
            mode = blocks.use_feed_mode(control.codes["feed_per_revolution" if per_rev else "feed_per_minute"])
            plane = {"feed_mode": mode, "plane": control.codes["plane_xy"], "feed": blocks.count("feed", feed)}
            blocks.block(plane)
            blocks.lines(lines)
            writer.table({**places, "motion": rapids["motion"]}, said_anew, spoken, texts)
        blocks.lines(blocks.family.hole_end())
    blocks.height = retract
    writer.forget("X", "Y", "Z")
    return int(wanted[-1])


def _approach(
    blocks: Blocks,
    motion: Motion,
    place: Mapping[str, int],
    rapid: Mapping[str, int],
    retract: float,
    joining: Sequence[WordEvent],
) -> None:
    """To the retract height over the first hole, in one block or across the tool first."""
    block = {**rapid, **place}
    if blocks.control.level_approach:
        blocks.block(block)
    block |= {"Z": blocks.count("X", retract), **blocks.first_words(motion)}
    for event in joining:
        block |= blocks.event_words(event)
    blocks.block(block)
    blocks.height = retract


def _to_height(
    blocks: Blocks, place: Mapping[str, int], rapid: Mapping[str, int], above: float, retract: float
) -> None:
    """From the height of the last row or hole to the one at which the control begins to go to holes.

    A control that draws the tool back to where the cycle found it (``holes_from = "start"``) has to be there; it comes
    down over the first hole.
    """
    low = above if blocks.control.holes_from == "above" else retract
    if blocks.height < low - 1e-9:
        blocks.block({**rapid, "Z": blocks.count("X", low)})
    elif blocks.control.holes_from == "start" and retract > above + 1e-9 and blocks.height > retract + 1e-9:
        blocks.block({**rapid, **place})
        blocks.block({**rapid, "Z": blocks.count("X", retract)})


def _called_with_hole(
    blocks: Blocks, lines: Sequence[str], places: Mapping[str, Ints], feed: int, per_rev: bool
) -> None:
    """The call of a cycle in the block of its first hole, with F where it is not in force; then the others.

    The blocks of holes say nothing but where they are: any other motion word would end the cycle.
    """
    writer, codes = blocks.writer, blocks.control.codes
    block = {"plane": codes["plane_xy"]}
    if "feed_mode" in blocks.family.WORDS:
        block["feed_mode"] = blocks.use_feed_mode(codes["feed_per_revolution" if per_rev else "feed_per_minute"])
    blocks.block(block)
    place = " ".join(writer.said(word, int(places[word][0])) for word in "XY")
    end = "" if writer.printed("feed") == feed else f" {writer.said('feed', feed)}"
    blocks.lines([line.replace(FIRST_HOLE, place) + (end if FIRST_HOLE in line else "") for line in lines])
    if len(places["X"]) > 1:
        writer.table({word: column[1:] for word, column in places.items()}, {"X": True, "Y": True})
