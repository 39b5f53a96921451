"""What nobody has said of a program that is checked without CL files, and what is too odd to be taken for meant."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.messages import Wording, phrase
from trunnion.model.programmed_words import POSITION_WORDS
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.spindle_work import SpindleTask
from trunnion.model.toolpath import Kind
from trunnion.verification.alone.cuts import ToolStretch, is_between_cuts, tool_stretches
from trunnion.verification.alone.lengths import odd_lengths
from trunnion.verification.context import Context
from trunnion.verification.results import Place

#: A rotary axis that is no further off whole turns is not turned, degrees.
_TURNED: Final = 1e-3

#: No tool cuts with more in a revolution, mm; the largest milling cutters are far below.
_MOST_PER_TURN: Final = 50.0

#: Feeds per minute below this are rather meant per revolution, mm/min.
_LEAST_PER_MINUTE: Final = 1.0

#: Pitches of threads that taps have, mm.
_LEAST_PITCH, _GREATEST_PITCH = 0.2, 8.0


def absurd_feeds(context: Context, cuts: Ints) -> Iterator[Place]:
    """Yield the first cut whose feed per revolution no tool stands."""
    run = context.run
    wrong = cuts[(run.state.feed_mode.at(cuts) == 95) & (run.state.feed.at(cuts) > _MOST_PER_TURN)]
    if len(wrong):
        row = int(wrong[0])
        yield context.place(row, 0.0, Wording("modal", "feed_per_turn", feed=float(run.state.feed[row])))


def left_open(context: Context, cuts: Ints) -> Iterator[Wording]:
    """Yield what is left open."""
    yield from odd_lengths(context, cuts)
    yield from _odd_tools(context, cuts)
    yield from _odd_feeds(context, cuts)
    yield from _unasked(context, cuts)
    yield from _odd_threads(context)


def turned_without_plane(context: Context, cuts: Ints) -> Iterator[Wording]:
    """Yield the first cut under turned rotary axes with neither TCP nor plane, where nobody has stated the zero."""
    run = context.run
    rows = cuts[~run.state.xyz_is_tip.at(cuts)]
    if run.machine.workpiece_zero is not None or not len(rows):
        return
    rotary = run.rotary[rows]
    turned = rows[(np.abs(rotary - 360.0 * np.rint(rotary / 360.0)) > _TURNED).any(axis=1)]
    if len(turned):
        yield phrase("cuts_turned", block=context.block_name(int(turned[0])))


def _odd_tools(context: Context, cuts: Ints) -> Iterator[Wording]:
    """Yield tools that are only selected, changes to none, tools that cut nothing, and what is left from another."""
    run = context.run
    last = int(cuts[-1]) if len(cuts) else -1
    changed = {str(event.value) for event in run.events if event.kind == "tool_change"}
    selected = False
    for event in run.events:
        name = str(event.value or "")
        row = min(event.before_row, len(run) - 1)
        if event.kind == "tool_change" and not selected and name and event.before_row <= last:
            yield phrase("change_to_none", block=context.block_name(row))
        if event.kind == "tool" and name not in ("", "0", *changed) and event.before_row <= last:
            changed.add(name)
            yield phrase("tool_only_selected", tool=name, block=context.block_name(row))
        selected = event.kind == "tool" or (selected and event.kind != "tool_change")
    before: ToolStretch | None = None
    for stretch in tool_stretches(run, cuts):
        turning = None if len(stretch.cuts) else _turning_at_part(run, stretch)
        if turning is not None:
            yield phrase("tool_cuts_nothing", tool=stretch.tool, block=context.block_name(turning))
        if before is not None and len(stretch.cuts) and before.tool != stretch.tool:
            yield from _left_from_other(context, stretch)
        before = stretch


def _turning_at_part(run: Run, stretch: ToolStretch) -> int | None:
    """Return the first motion of a tool at the part with the spindle on; None: it has none."""
    rows = np.arange(stretch.first, stretch.end)
    at_part = ~run.state.machine_frame.at(rows) & (run.state.spindle.at(rows) != 0)
    at_part &= (run.programmed[rows] & int(POSITION_WORDS)) != 0
    return int(rows[np.argmax(at_part)]) if at_part.any() else None


def _left_from_other(context: Context, stretch: ToolStretch) -> Iterator[Wording]:
    """Yield speed and feed with which a tool cuts first, where they were written for the tool before."""
    run, row = context.run, int(stretch.cuts[0])
    speeds = [event.before_row for event in run.events if event.kind == "speed"]
    if speeds and not any(stretch.first <= each <= row for each in speeds):
        yield phrase("speed_of_other", block=context.block_name(row), tool=stretch.tool)
    programmed = run.programmed[stretch.first : row + 1]
    feed = run.state.feed
    is_own = (programmed & int(ProgrammedWord.FEED)).any() or feed[row] != feed[stretch.first]
    if programmed[-1] and not is_own:
        yield phrase("feed_of_other", block=context.block_name(row), tool=stretch.tool)


def _odd_feeds(context: Context, cuts: Ints) -> Iterator[Wording]:
    """Yield the first cut with a feed per minute that looks like one per revolution."""
    run = context.run
    slow = cuts[(run.state.feed_mode.at(cuts) == 94) & (run.state.feed.at(cuts) < _LEAST_PER_MINUTE)]
    if len(slow):
        row = int(slow[0])
        yield phrase("feed_too_slow", feed=float(run.state.feed[row]), block=context.block_name(row))


def _unasked(context: Context, cuts: Ints) -> Iterator[Wording]:
    """Yield words that change a tool, its sense, its path or its cut, and that a CL file would have to ask for."""
    run = context.run
    asked = dict[str, int]()
    for event in run.events:
        row = min(event.before_row, len(run) - 1)
        if event.kind == "delta" and isinstance(event.value, tuple) and event.value[1]:
            asked.setdefault(f"{event.value[0]} {float(event.value[1]):g}", row)
        elif event.kind == "tolerance" and event.value == np.inf:
            asked.setdefault("G64", row)
        elif event.kind == "stop" and is_between_cuts(cuts, event.before_row):
            asked.setdefault("M60" if event.value == "pallet" else "M0", row)
    threads = [(hole.first, hole.end) for hole in run.spindle_holes if hole.work.task is SpindleTask.TAP]
    counter = cuts[run.state.spindle.at(cuts) < 0]
    for first, end in threads:
        counter = counter[(counter < first) | (counter >= end)]
    if len(counter):
        asked.setdefault("M4", int(counter[0]))
    values = tuple(phrase("unasked_value", value=each, block=context.block_name(row)) for each, row in asked.items())
    if values:
        yield phrase("unasked_values", values=values)


def _odd_threads(context: Context) -> Iterator[Wording]:
    """Yield the first thread of which nothing says that the tap is held rigidly, and the first with an odd pitch."""
    run, code = context.run, context.settings.rigid_tap
    threads = [hole for hole in run.spindle_holes if hole.work.task is SpindleTask.TAP]
    if code is not None:
        words = [event.before_row for event in run.events if event.kind == "m" and event.value == code]
        changes = [event.before_row for event in run.events if event.kind == "tool_change"]
        for hole in threads:
            since = max((row for row in changes if row <= hole.first), default=0)
            if not hole.work.floating and not any(since <= row <= hole.first + 1 for row in words):
                yield phrase("thread_not_rigid", word=f"M{code}", block=context.block_name(hole.first))
                break
    for hole in threads:
        pitch = abs(hole.work.pitch)
        if np.isnan(pitch):
            pitch = _pitch_of_feed(run, hole.first, hole.end)
        if not (np.isnan(pitch) or _LEAST_PITCH <= pitch <= _GREATEST_PITCH):
            yield phrase("odd_pitch", pitch=float(pitch), block=context.block_name(hole.first))
            break


def _pitch_of_feed(run: Run, first: int, end: int) -> float:
    """Return the pitch that feed and speed of a thread make, mm; NaN: not known."""
    for row in range(first, end):
        if run.kind[row] != Kind.RAPID and run.state.rpm[row] > 0.0:
            per_turn = 1.0 if run.state.feed_mode[row] == 95 else float(run.state.rpm[row])
            return float(run.state.feed[row]) / per_turn
    return float("nan")
