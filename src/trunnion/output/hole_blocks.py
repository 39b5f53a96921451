"""Blocks of holes: a cycle made modal, or called, at positions of one height each."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Ints
from trunnion.controls.definition import CALL
from trunnion.controls.family import EACH_HOLE, FIRST_HOLE, HOLES, IN_PLANES, WordEvent
from trunnion.controls.words import counts
from trunnion.model.motion import Manner, Motion
from trunnion.model.toolpath import CycleOn
from trunnion.output.hole_positions import write_positions
from trunnion.output.motion_blocks import Blocks
from trunnion.output.program import settings_of
from trunnion.planning.holes.cycles import Cycle, Turning, cycle_of, feed_of


def write_holes(
    blocks: Blocks, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: CycleOn
) -> int:
    """Rows ``first`` to ``last`` as holes, with the events that join them; arguments and result as ``Blocks.rows``."""
    if motion.manner is Manner.TCP:
        return write_positions(blocks, motion, first, last, joining, text, cycle)
    said = cycle_of(cycle)
    place = blocks.writer.word("X").format.decimals
    tops = counts(np.ascontiguousarray(motion.operation.moves.tip[first:last, 2]), place)
    begins = {0, *(np.flatnonzero(np.diff(tops)) + 1).tolist(), *(e.row - first for e in joining if e.row >= first)}
    ends = sorted(k for k in begins if k < last - first)
    for k, end in zip(ends, [*ends[1:], last - first], strict=True):
        row = first + k
        while row < first + end:
            fitting, text = blocks.holes(motion, row, text)
            stop, here = min(row + fitting, first + end), [event for event in joining if event.row == row]
            text = _of_one_height(blocks, motion, row, stop, here, text, said)
            row = stop
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
    over_first = {word: int(column[0]) for word, column in places.items()}
    for event in joining:
        if first > 0:
            blocks.event_block(event)
    if first == 0:
        _approach(blocks, motion, over_first, rapid, retract, joining)
    turning = None if blocks.spindle is None else Turning(blocks.spindle.rpm, blocks.spindle.sense)
    feed, per_rev = feed_of(cycle, turning, float(moves.feed[first]), bool(moves.per_rev[first]))
    ids, texts = blocks.phase_texts()
    wanted = ids[moves.phase[first:last]]
    spoken = np.where(wanted != np.concatenate(([text], wanted[:-1])), wanted, -1)
    formats, settings = control.number_formats(motion.three_axis), settings_of(blocks.program) | {HOLES: IN_PLANES}
    called = CALL in blocks.family.WORDS
    said = replace(cycle, feed=feed, per_rev=per_rev) if called else cycle
    lines = blocks.family.hole_call(said, top, turning, settings, formats)
    each = any(EACH_HOLE in line for line in lines)
    if first > 0:
        exact = control.holes_from == "initial" and retract > top + cycle.above and not each
        low = retract if exact or control.holes_from == "retract" else top + cycle.above
        _stand(blocks, rapid, over_first, low, exact)
    said_anew = {"X": True, "Y": True}  # a point at which the tool already stands gets its block
    if called:
        blocks.lines(lines)
        calls = np.full(n, control.codes[CALL], np.int64)
        writer.table({**rapids, **places, CALL: calls}, said_anew, spoken, texts)
    else:
        plane = {"plane": control.codes["plane_xy"]}
        if "feed_mode" in blocks.family.WORDS and not each:
            code = control.codes["feed_per_revolution" if per_rev else "feed_per_minute"]
            plane["feed_mode"] = blocks.use_feed_mode(code)
        if each:
            _one_by_one(blocks, lines, places, [texts[k] if k >= 0 else "" for k in spoken.tolist()])
        elif any(FIRST_HOLE in line for line in lines):
            blocks.block(plane)
            blocks.lines([texts[spoken[0]]] if spoken[0] >= 0 else [])
            _called_with_hole(blocks, lines, places, blocks.count("feed", feed), spoken, texts)
        else:
            blocks.block(plane | {"feed": blocks.count("feed", feed)})
            blocks.lines(lines)
            writer.table({**places, "motion": rapids["motion"]}, said_anew, spoken, texts)
        blocks.lines(blocks.family.hole_end())
        if control.holes_from == "initial":
            writer.forget("motion")
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
    if blocks.comes_level:
        blocks.block(block)
    block |= {"Z": blocks.count("X", retract), **blocks.first_words(motion)}
    for event in joining:
        block |= blocks.event_words(event)
    blocks.block(block)
    blocks.height, blocks.highest = retract, None


def _stand(blocks: Blocks, rapid: Mapping[str, int], place: Mapping[str, int], low: float, exact: bool) -> None:
    """No lower than ``low`` before the tool goes to the first hole, or ``exact`` there: as heights are printed."""
    if blocks.highest is not None:
        blocks.height = max(blocks.highest, low)
        blocks.block({**rapid, "Z": blocks.count("X", blocks.height)})
        blocks.highest = None
    here, there = blocks.count("X", blocks.height), blocks.count("X", low)
    down = exact and here > there
    if down:  # over the hole first, and not aslant
        blocks.block({**rapid, **place})
    if down or blocks.height < low - 1e-9:
        blocks.block({**rapid, "Z": there})


def _one_by_one(blocks: Blocks, lines: Sequence[str], places: Mapping[str, Ints], spoken: Sequence[str]) -> None:
    """All lines for each hole, after what is spoken there."""
    writer = blocks.writer
    for x, y, before in zip(places["X"].tolist(), places["Y"].tolist(), spoken, strict=True):
        place = f"{writer.said('X', x)} {writer.said('Y', y)}"
        blocks.lines([before, *(line.replace(EACH_HOLE, place) for line in lines)][not before :])


def _called_with_hole(
    blocks: Blocks,
    lines: Sequence[str],
    places: Mapping[str, Ints],
    feed: int,
    spoken: Ints,
    texts: Sequence[str],
) -> None:
    """The call of a cycle in the block of its first hole, with F where it is not in force; then the others.

    The blocks of holes say nothing but where they are: any other motion word would end the cycle.
    """
    writer = blocks.writer
    place = " ".join(writer.said(word, int(places[word][0])) for word in "XY")
    end = "" if writer.printed("feed") == feed else f" {writer.said('feed', feed)}"
    blocks.lines([line.replace(FIRST_HOLE, place) + (end if FIRST_HOLE in line else "") for line in lines])
    if len(places["X"]) > 1:
        others = {word: column[1:] for word, column in places.items()}
        writer.table(others, {"X": True, "Y": True}, spoken[1:], texts)
