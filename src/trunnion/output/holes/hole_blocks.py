"""Hole-making cycles as blocks: the cycle becomes modal, or is called, at holes of one height."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Ints
from trunnion.controls.family_writer import EACH_HOLE, FIRST_HOLE, WordEvent
from trunnion.controls.vocabulary import CYCLE_CALL_WORD, HOLES_IN_PLANES, HOLES_SETTING
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CycleOn
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.holes.hole_groups import HoleRows, write_hole_groups
from trunnion.output.holes.holes_under_tcp import write_holes_under_tcp
from trunnion.planning.holes.cycles import Cycle, SpindleState, cycle_feed, cycle_from_event

#: Forces the block of a hole at which the tool already is.
_REPEAT_POSITION = {"X": True, "Y": True}


def write_holes(blocks: MotionBlockWriter, rows: HoleRows, phase: int, event: CycleOn) -> int:
    """Write the holes of a cycle; as ``MotionBlockWriter.write_rows``."""
    cycle = cycle_from_event(event)
    if rows.motion.mode is MachiningMode.TCP:
        return write_holes_under_tcp(blocks, rows, phase, cycle)
    heights = np.ascontiguousarray(rows.motion.operation.moves.tip[rows.first : rows.last, 2])
    holes = _Holes(blocks, rows.motion, cycle)
    return write_hole_groups(blocks, rows, heights, phase, lambda _, *group: holes.write(*group))


class _Holes:
    """Writes the holes of one cycle along Z.

    The tool goes to them at the height to which it was retracted last. It starts at the retract height where that
    height is not known, and is raised first where it is lower than the next holes need it.
    """

    def __init__(self, blocks: MotionBlockWriter, motion: Motion, cycle: Cycle) -> None:
        self._blocks, self._motion, self._cycle = blocks, motion, cycle
        self._control, self._family, self._writer = blocks.control, blocks.family, blocks.writer
        rapid = {word: int(column[0]) for word, column in self._rapid_columns(1).items()}
        self._rapid = rapid | {"feed": blocks.feeds.rapid_feed}

    def write(self, first: int, last: int, joining_events: Sequence[WordEvent], phase: int) -> int:
        """Write the holes of rows ``first`` to ``last``, all of one height; returns the phase comment written last."""
        blocks, cycle, moves = self._blocks, self._cycle, self._motion.operation.moves
        assert cycle.retract_height is not None
        top = float(moves.tip[first, 2])
        retract = top + cycle.retract_height
        positions = self._positions(first, last)
        first_position = {word: int(column[0]) for word, column in positions.items()}
        if first == 0:
            self._approach_first_hole(first_position, retract, joining_events)
        else:
            for event in joining_events:
                blocks.write_event(event)
        spindle = None if blocks.spindle is None else SpindleState(blocks.spindle.rpm, blocks.spindle.sense)
        feed, per_rev = cycle_feed(cycle, spindle, float(moves.feed[first]), bool(moves.per_rev[first]))
        lines = self._call_lines(top, spindle, feed, per_rev)
        if first > 0:
            self._move_to_start_height(first_position, top, retract, lines)
        ids, texts = blocks.phase_texts()
        phases = ids[moves.phase[first:last]]
        comments = np.where(phases != np.concatenate(([phase], phases[:-1])), phases, -1)
        self._write_cycle(lines, positions, feed, per_rev, comments, texts)
        blocks.write_lines(self._family.cycle_cancel())
        if self._control.holes_from == "initial":
            self._writer.forget("motion")
        blocks.tool_height = retract
        self._writer.forget("X", "Y", "Z")
        return int(phases[-1])

    def _positions(self, first: int, last: int) -> dict[str, Ints]:
        tip, counts = self._motion.operation.moves.tip, self._writer.word("X").format.counts
        return {word: counts(tip[first:last, c]) for c, word in enumerate("XY")}

    def _rapid_columns(self, rows: int) -> dict[str, Ints]:
        """Return the motion words of rapids: word -> (n,) int64 counts."""
        return self._family.row_words(np.ones(rows, np.bool_), np.zeros(rows, np.bool_), self._control.codes)

    def _call_lines(self, top: float, spindle: SpindleState | None, feed: float, per_rev: bool) -> list[str]:
        """Return the family's lines of the cycle; a cycle that is called hole by hole is defined with its own feed."""
        called = CYCLE_CALL_WORD in self._family.WORDS
        cycle = replace(self._cycle, feed=feed, per_rev=per_rev) if called else self._cycle
        settings = self._blocks.program.effective_settings() | {HOLES_SETTING: HOLES_IN_PLANES}
        return self._family.cycle_call(
            cycle, top, spindle, settings, self._control.number_formats(self._motion.three_axis)
        )

    # Heights

    def _approach_first_hole(
        self, position: Mapping[str, int], retract: float, joining_events: Sequence[WordEvent]
    ) -> None:
        """Go to the retract height over the first hole of a motion: in one block, or to X and Y first."""
        blocks = self._blocks
        block, first_words = {**self._rapid, **position}, blocks.first_block_words(self._motion)
        if blocks.xy_before_z:
            point = np.array([*self._motion.operation.moves.tip[0, :2], retract])
            first_words = blocks.legs.write(self._motion, point, block, first_words)
        block |= {"Z": self._writer.to_count("X", retract), **first_words}
        for event in joining_events:
            block |= blocks.event_words(event)
        blocks.write_block(block)
        blocks.tool_height, blocks.height_bound = retract, None

    def _move_to_start_height(
        self, position: Mapping[str, int], top: float, retract: float, lines: Sequence[str]
    ) -> None:
        """Go to the height from which the cycle starts: no lower, or exactly there if G80 must return to it."""
        blocks, needed = self._blocks, top + self._cycle.rapid_height
        one_by_one = any(EACH_HOLE in line for line in lines)
        exact = self._control.holes_from == "initial" and retract > needed and not one_by_one
        height = retract if exact or self._control.holes_from == "retract" else needed
        if blocks.height_bound is not None:
            blocks.tool_height = max(blocks.height_bound, height)
            blocks.write_block({**self._rapid, "Z": self._writer.to_count("X", blocks.tool_height)})
            blocks.height_bound = None
        here, there = self._writer.to_count("X", blocks.tool_height), self._writer.to_count("X", height)
        down = exact and here > there
        if down:  # over the hole first, and not at an angle
            blocks.write_block({**self._rapid, **position})
        if down or blocks.tool_height < height - 1e-9:
            blocks.write_block({**self._rapid, "Z": there})

    # The cycle

    def _write_cycle(
        self,
        lines: Sequence[str],
        positions: Mapping[str, Ints],
        feed: float,
        per_rev: bool,
        comments: Ints,
        texts: Sequence[str],
    ) -> None:
        """Write the lines of the cycle and its holes, in the form that the lines ask for.

        lines      as ``FamilyWriter.cycle_call`` returned them
        positions  counts of X and Y, (n,) int64 each
        comments   (n,) int64: index into ``texts`` of the phase comment before each hole, -1 for none
        """
        blocks, writer, codes = self._blocks, self._writer, self._control.codes
        feed_word, count = blocks.feeds.count(feed, per_rev)
        rapids = self._rapid_columns(len(positions["X"]))
        if CYCLE_CALL_WORD in self._family.WORDS:
            blocks.write_lines(lines)
            calls = np.full(len(positions["X"]), codes[CYCLE_CALL_WORD], np.int64)
            writer.write_table({**rapids, **positions, CYCLE_CALL_WORD: calls}, _REPEAT_POSITION, comments, texts)
            return
        if any(EACH_HOLE in line for line in lines):
            self._write_one_by_one(lines, positions, [texts[k] if k >= 0 else "" for k in comments.tolist()])
            return
        modes = {"plane": codes["plane_xy"]} if "plane" in self._family.WORDS else {}
        if "feed_mode" in self._family.WORDS:
            modes["feed_mode"] = blocks.feeds.use_mode(codes["feed_per_revolution" if per_rev else "feed_per_minute"])
        if any(FIRST_HOLE in line for line in lines):
            if modes:
                blocks.write_block(modes)
            blocks.write_lines([texts[comments[0]]] if comments[0] >= 0 else [])
            self._write_call_with_first_hole(lines, positions, {feed_word: count}, comments, texts)
        else:
            blocks.write_block(modes | {feed_word: count})
            blocks.write_lines(lines)
            writer.write_table({**rapids, **positions}, _REPEAT_POSITION, comments, texts)

    def _write_one_by_one(self, lines: Sequence[str], positions: Mapping[str, Ints], comments: Sequence[str]) -> None:
        """Write all lines for each hole, after its phase comment."""
        writer = self._writer
        for x, y, comment in zip(positions["X"].tolist(), positions["Y"].tolist(), comments, strict=True):
            position = f"{writer.print_word('X', x)} {writer.print_word('Y', y)}"
            hole = [line.replace(EACH_HOLE, position) for line in lines]
            self._blocks.write_lines([comment, *hole] if comment else hole)

    def _write_call_with_first_hole(
        self,
        lines: Sequence[str],
        positions: Mapping[str, Ints],
        feed: Mapping[str, int],
        comments: Ints,
        texts: Sequence[str],
    ) -> None:
        """Write the call of a cycle in the block of its first hole, with F if it is not active; then the other holes.

        Their blocks have only positions: any other motion word would end the cycle. ``feed`` is the word F, as a count.
        """
        writer = self._writer
        position = " ".join(writer.print_word(word, int(positions[word][0])) for word in "XY")
        changed = [word for word, count in feed.items() if writer.last_count(word) != count]
        end = "".join(f" {writer.print_word(word, feed[word])}" for word in changed)
        self._blocks.write_lines(
            [line.replace(FIRST_HOLE, position) + (end if FIRST_HOLE in line else "") for line in lines]
        )
        if len(positions["X"]) > 1:
            others = {word: column[1:] for word, column in positions.items()}
            writer.write_table(others, _REPEAT_POSITION, comments[1:], texts)
