"""Motion blocks: rows become tables of words, and events that are words join them.

In:     motions as they are written, row by row, with the events at them.
Out:    blocks through the block writer; what is in force between them is kept here.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import WordEvent
from trunnion.controls.vocabulary import ORIENT_BY_AXES_WORD, ORIENT_BY_VECTOR_WORD, TOOL_VECTOR_WORDS, VECTOR_LINE_WORD
from trunnion.controls.words import ABSENT, round_to_counts
from trunnion.errors import InputError, Problem
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Arcs, Coolant, Kind, LoadTool, Phase, SpindleOn
from trunnion.output.blocks.block_writer import BLOCK_NUMBER_BYTES, CHUNK, BlockWriter
from trunnion.output.blocks.surface_normals import contact_rows, normal_words
from trunnion.output.coordinates.axis_coordinates import AxisCoordinates, feed_rule, feed_words, to_axis_coordinates
from trunnion.output.coordinates.tool_vectors import first_row_at_other_pose, nearest_pose_is_planned, tool_vectors_at
from trunnion.output.program import Program, effective_setting, effective_settings, motion_block_words, rotary_counts

_PHASE_KEYS = {
    Phase.RAPID: "rapid",
    Phase.APPROACH: "approach",
    Phase.ENGAGE: "engage",
    Phase.CUT: "cut",
    Phase.STEPOVER: "stepover",
    Phase.RETRACT: "retract",
    Phase.DEPARTURE: "departure",
    Phase.TRAVERSE: "traverse",
}

#: Words that are said again where an operation goes on in another file, besides those that each row says for itself.
_REPEATED_WORDS = ("plane", "feed_mode", "cutter_comp", "speed", "edge", "spindle", "coolant")

#: Bytes of the lines that stand before a row of their own, at most: a phase, an arc's centre.
_ROW_LINES_BYTES = 256

#: Bytes of the lines before and behind the holes of a cycle, at most.
_CYCLE_LINES_BYTES = 1024

#: Manners in which X and Y of the program are across the tool.
_Z_ALONG_TOOL = (MachiningMode.THREE_AXIS, MachiningMode.TILTED)


class MotionBlockWriter:
    """The motion blocks of one program.

    writer   the block writer
    spindle  what the spindle was last told, also where it has been stopped since; None before
    coolant  its kind, as it was last told
    tool_height   of the tool along Z of the frame, at the last row written, mm
    height_bound  behind blocks that may be skipped: it is not above this, but may be below ``height``; None: it is
    there max_file_bytes  bytes that the rows of a file may come to; None: no matter how many
    on_file_full     is called where a file has no room for another row: it turns to the next one
    comes_level  whether the tool goes to X and Y of an operation's first point before it goes down
    """

    def __init__(self, program: Program, sink: BinaryIO, progress: Callable[[int], None]) -> None:
        self.program = program
        self.control = program.control
        self.family = program.control.family
        self.progress = progress
        self._column = {k: c for c, k in enumerate(program.machine.rotary)}
        self._rotary = (("primary", program.machine.primary), ("secondary", program.machine.secondary))
        self._words = motion_block_words(program, program.motions[0])
        self.writer = BlockWriter(sink, self._words, self.control.block_numbers)
        self.spindle: SpindleOn | None = None
        self.coolant = "OFF"
        self.tool_height = 0.0
        self.height_bound: float | None = None
        self.xy_before_z = False
        self._axis_coordinates: AxisCoordinates | None = None
        self._feed_mode = ABSENT
        self._tool = ""
        self._register = 0
        self._uses_vectors = False  # of this motion
        self._switches_orientation_mode = any(word.key == ORIENT_BY_VECTOR_WORD for word in self._words)
        self._words_to_repeat: dict[str, int] = {}
        self._orients_by_vector = ABSENT  # how the control goes to an orientation: 1 by the vector, 0 by the axes
        self.max_file_bytes: int | None = None
        self.on_file_full: Callable[[], None] = lambda: None
        rapid_feed = effective_setting(program, "rapid_feed")
        self.rapid_feed = self.to_count("feed", float(rapid_feed)) if rapid_feed else ABSENT

    def use_axis_coordinates(self, motion: Motion) -> Motion:
        """A motion in the words of its manner: without TCP these are slides. What follows is of this motion."""
        self._axis_coordinates = None
        if motion.mode is MachiningMode.WITHOUT_TCP:
            angle = self.control.number_formats(motion.three_axis)["angle"]
            self._axis_coordinates = to_axis_coordinates(self.program.machine, motion, angle.decimals)
            motion = self._axis_coordinates.motion
        return motion

    def begin_motion(self, motion: Motion, tool: str, goes_on: bool, *, xy_before_z: bool) -> None:
        """An operation begins, with its own formats of words.

        Parameters
        ----------
        motion
            What of it is made in one plane.
        tool
            How the program calls the tool.
        goes_on
            In another plane than before, and not from home.
        comes_level
            From where the tool has been drawn back, so that it goes to X and Y before it goes down, on controls that
            want it so.
        """
        self._tool = tool
        loads = [event for event in motion.operation.events if isinstance(event, LoadTool)]
        if loads:  # a tool that the run calls instead has its own
            self._register = 0 if effective_setting(self.program, "tool") else loads[-1].adjust
        self.xy_before_z = xy_before_z and self.control.level_approach and motion.mode in _Z_ALONG_TOOL
        self._words = motion_block_words(self.program, motion)
        self.writer.use_words(self._words)
        if not goes_on:
            self.writer.forget()
            for word, code in self.control.initial_modal_state.items():
                self.writer.remember(word, code)
        else:
            self.writer.forget("X", "Y", "Z", "feed")
        self._feed_mode = ABSENT
        self._orients_by_vector = 1
        self._uses_vectors = motion.mode is MachiningMode.TCP and self.control.uses_tool_vectors(self.program.settings)
        if self._uses_vectors and self.control.vectors_exclude_angles:
            self._uses_vectors = first_row_at_other_pose(self.program.machine, motion, self._words) < 0

    def assume_rotary_position(self, motion: Motion) -> None:
        """Templates have placed the rotary axes for a motion's first row."""
        for word, column in self._rotary:
            self.writer.remember(
                word, int(self._rotary_counts(motion.rotary[:1, self._column[column]], word, column)[0])
            )
        if self._uses_vectors:
            for word, counted in self._tool_vector_counts(motion.rotary[:1]).items():
                self.writer.remember(word, int(counted[0]))

    def use_feed_mode(self, mode: int) -> int:
        """What F means from here on; where that changes, F is said again. Returns ``mode``."""
        if mode != self._feed_mode:
            self.writer.forget("feed")
        self._feed_mode = mode
        return mode

    def write_lines(self, lines: Sequence[str]) -> None:
        """Lines of text, none longer than the control reads; what goes on in the next line is one block with it."""
        room = self.control.longest_line - BLOCK_NUMBER_BYTES
        for line in lines:
            if len(line.encode()) > room:
                what = f"a line has more than the {self.control.longest_line} bytes that {self.control.name} reads"
                raise InputError(Problem(self.program.file, 0, f"{what}: {line[:60]}…", "shorten the text"))
        sign, blocks, goes_on = self.control.continued, list[str](), False
        for line in lines:
            blocks[len(blocks) - goes_on :] = [f"{blocks[-1]}\n{line}" if goes_on else line]
            goes_on = bool(sign) and line.endswith(sign)
        self.writer.write_lines(blocks)

    def event_block(self, event: WordEvent) -> None:
        """Words of an event in a block of their own."""
        self.writer.write_table({word: np.array([code], np.int64) for word, code in self.event_words(event).items()})

    def event_words(self, event: WordEvent) -> dict[str, int]:
        """The words of an event that joins a motion block, as counts."""
        if isinstance(event, SpindleOn):
            self.spindle = event
        elif isinstance(event, Coolant):
            self.coolant = event.kind
        words = self.family.event_words(event, self.control.codes, self.control.coolant)
        return {word: self.to_count(word, value) for word, value in words.items()}

    def to_count(self, word: str, value: float) -> int:
        return int(round_to_counts(np.array([value]), self.writer.word(word).format.decimals)[0])

    def write_block(self, words: Mapping[str, int]) -> None:
        """One block of these words, as counts; nothing where all of them are in force."""
        self.writer.write_table({word: np.array([count], np.int64) for word, count in words.items()})

    def write_rows(self, motion: Motion, first: int, last: int, joining_events: Sequence[WordEvent], text: int) -> int:
        """Write rows ``first`` to ``last``; returns the index of the phase text that was printed last."""
        start = first
        while start < last:
            fitting = self._fitting_rows()
            if fitting < 1:
                self._continue_in_next_file()
                text, fitting = -1, self._fitting_rows()
            stop = min(start + max(1, fitting), last)
            text = self.write_chunk(motion, start, stop, [e for e in joining_events if start <= e.row < stop], text)
            self.progress(stop - start)
            start = stop
        return text

    def fitting_holes(self, motion: Motion, row: int, text: int) -> tuple[int, int]:
        """How many holes surely fit into the file from a row on, with what begins and ends their cycle: at least one.

        In a file that has no room left they do not begin: the next one begins where the tool stands. Returns the
        number, and the index of the phase text that was printed last.
        """
        fitting = self._fitting_rows(_CYCLE_LINES_BYTES)
        if fitting >= 1 or row == 0:
            return max(1, fitting), text
        self._continue_in_next_file()
        moves = motion.operation.moves
        tip, kind = moves.tip.copy(), moves.kind.copy()
        if motion.mode in _Z_ALONG_TOOL:
            tip[row - 1, 2] = self.tool_height
        kind[row - 1] = Kind.RAPID
        stands = replace(motion.operation, moves=replace(moves, tip=tip, kind=kind), arcs=Arcs.empty())
        text = self.write_chunk(replace(motion, operation=stands), row - 1, row, (), -1, repeat_point=True)
        return max(1, self._fitting_rows(_CYCLE_LINES_BYTES)), text

    def _fitting_rows(self, kept: int = 0) -> int:
        """So many rows surely fit into the file beside what is ``kept``, at least one where it must not end here.

        Radius compensation goes on to the end: the control looks ahead there, and not from file to file.
        """
        if self.max_file_bytes is None:
            return CHUNK
        widest = self.writer.widest_row + _ROW_LINES_BYTES
        fitting = min(CHUNK, (self.max_file_bytes - kept - self.writer.size) // widest)
        off = self.control.codes.get("comp_off", ABSENT)
        compensated = self.writer.modal_state().get("cutter_comp", off) != off
        return max(1, fitting) if compensated else fitting

    def _continue_in_next_file(self) -> None:
        """Go on in the next file: what is in force is said again in its first block, but for the tool's length and TCP,
        which some controls take as a motion."""
        known = self.writer.modal_state()
        self._words_to_repeat = {word: known[word] for word in _REPEATED_WORDS if word in known}
        self.on_file_full()
        self.writer.forget()
        self._feed_mode = ABSENT
        self._orients_by_vector = ABSENT

    def write_chunk(
        self,
        motion: Motion,
        start: int,
        stop: int,
        joining_events: Sequence[WordEvent],
        text: int,
        *,
        repeat_point: bool = False,
    ) -> int:
        """As ``write_rows``, all in one file; ``repeat_point``: a point at which the tool already stands gets its
        block."""
        moves, arcs, control = motion.operation.moves, motion.operation.arcs, self.control
        part = slice(start, stop)
        self.tool_height, self.height_bound = float(moves.tip[stop - 1, 2]), None
        rapid = moves.kind[part] == Kind.RAPID
        decimals = {word: self.writer.word(word).format.decimals for word in ("X", "feed")}
        columns = {
            word: round_to_counts(np.ascontiguousarray(moves.tip[part, c]), decimals["X"])
            for c, word in enumerate("XYZ")
        }
        forced: dict[str, bool | Ints] = {"X": np.ones(stop - start, np.int64)} if repeat_point else {}
        by_vector = self._uses_vectors
        state_after: dict[str, int] = {}
        if motion.plane is None:  # in a plane the rotary axes stand where they were put
            for word, axis in self._rotary:
                columns[word] = self._rotary_counts(motion.rotary[part, self._column[axis]], word, axis)
        touching = contact_rows(motion, part)
        if by_vector:
            state_after = self._orientation_words(motion, start, stop, columns, forced, touching)
        columns["feed"] = np.where(
            rapid, self.rapid_feed, round_to_counts(np.where(rapid, np.nan, moves.feed[part]), decimals["feed"])
        )
        columns |= self.family.row_words(rapid, moves.per_rev[part], control.codes)
        if (by_vector or touching.any()) and any(word.key == VECTOR_LINE_WORD for word in self._words):
            said = columns[TOOL_VECTOR_WORDS[0]] != ABSENT if by_vector else touching
            columns |= normal_words(moves, part, said & touching, self.writer)
            columns |= {VECTOR_LINE_WORD: np.where(said, 1, ABSENT), "line": np.where(said, ABSENT, columns["line"])}
            forced |= dict.fromkeys("XYZ", said.astype(np.int64))
        if self._axis_coordinates is not None:
            forced |= self._apply_axis_coordinates(self._axis_coordinates, moves.feed[part], part, rapid, columns)
        forced["feed"] = self._feed_mode_changes(columns, rapid)
        lines: dict[int, str] = {}
        elsewhere = np.zeros(stop - start, np.bool_)
        inside = np.flatnonzero((arcs.row >= start) & (arcs.row < stop))
        if len(inside):
            formats = {word.key: word.format for word in self._words}
            words = self.family.arc_words(arcs, moves.tip, inside, control.codes, formats, control.arcs.by_radius)
            at = arcs.row[inside] - start
            for word in (*TOOL_VECTOR_WORDS, VECTOR_LINE_WORD) if by_vector else ():  # the tool axis rests on a circle
                if word in columns:
                    columns[word][at] = ABSENT
            for word, column in words.columns.items():
                columns.setdefault(word, np.full(stop - start, ABSENT, np.int64))[at] = column
            for word, flag in words.forced.items():
                every = np.zeros(stop - start, np.int64)
                every[at] = flag
                forced[word] = every | forced.get(word, 0)
            lines = {row: line for row, line in zip(at.tolist(), words.lines or (), strict=False) if line}
            elsewhere = columns["X"] == ABSENT
            for word in "XYZ":  # where an arc's end was said by other words, the next block says its own whole
                forced[word] = np.concatenate(([0], elsewhere[:-1])).astype(np.int64) | forced.get(word, 0)
        if start == 0 and rapid[0] and self.xy_before_z:
            self.write_block({word: int(column[0]) for word, column in columns.items() if word != "Z"})
        if start == 0:
            self._set_words(columns, 0, self.first_block_words(motion))
        for event in joining_events:
            self._set_words(columns, event.row - start, self.event_words(event))
        if self._words_to_repeat:
            said = {word: int(column[0]) for word, column in columns.items()}
            self._set_words(
                columns, 0, {w: count for w, count in self._words_to_repeat.items() if said.get(w, ABSENT) == ABSENT}
            )
            self._words_to_repeat = {}
        ids, texts = self.phase_texts()
        wanted = ids[moves.phase[part]]
        before = np.concatenate(([text], wanted[:-1]))
        self.writer.write_table(columns, forced, np.where(wanted != before, wanted, -1), texts, lines)
        if elsewhere[-1]:
            self.writer.forget("X", "Y", "Z")
        for word, count in state_after.items():
            self.writer.remember(word, count)
        return int(wanted[-1])

    def first_block_words(self, motion: Motion) -> dict[str, int]:
        """What the control is told of the tool with the first motion, as counts."""
        said = {"orientation": "vector" if self._uses_vectors else "angles"}
        settings = effective_settings(self.program) | said
        words = self.family.first_block_words(motion, self._tool, self._register, settings)
        return {word: self.to_count(word, value) for word, value in words.items()}

    def _tool_vector_counts(self, rotary: Floats) -> dict[str, Ints]:
        """The tool axis as a vector, by where the rotary axes stand, however they lean; as counts."""
        decimals = self.writer.word(TOOL_VECTOR_WORDS[0]).format.decimals
        vectors = tool_vectors_at(self.program.machine, rotary)
        return {
            word: round_to_counts(np.ascontiguousarray(vectors[:, k]), decimals)
            for k, word in enumerate(TOOL_VECTOR_WORDS)
        }

    def _orientation_words(
        self,
        motion: Motion,
        start: int,
        stop: int,
        columns: dict[str, Ints],
        forced: dict[str, bool | Ints],
        touching: Flags,
    ) -> dict[str, int]:
        """Say orientations by vectors, and by rotary words where a control would take another position for the vector.

        All components or both rotary words stand where the orientation changes, and none where it does not, but for
        rows that are ``touching``: next to a surface's normal the vector always stands. Returns what is in force after
        the last row, however it was said.
        """
        rotary = motion.rotary[start:stop]
        vectors = self._tool_vector_counts(rotary)
        printed = np.column_stack(list(vectors.values())) / np.float64(
            10 ** self.writer.word(TOOL_VECTOR_WORDS[0]).format.decimals
        )
        before = np.concatenate((motion.rotary[max(start - 1, 0) : max(start, 1)], rotary[:-1]))
        half = 0.5 * 10.0 ** -self.writer.word("primary").format.decimals
        if self.control.vectors_exclude_angles:
            by_vector = np.ones(len(rotary), np.bool_)
        else:
            by_vector = nearest_pose_is_planned(self.program.machine, printed, rotary, before, half)
        words = vectors | {word: columns[word] for word, _ in self._rotary}
        changed = np.zeros(len(rotary), np.bool_)
        for word, column in words.items():
            changed |= column != np.concatenate(([self.writer.last_count(word)], column[:-1]))
        last = {word: int(column[-1]) for word, column in words.items()}
        by_vector |= ~changed  # the control is there already
        changed |= touching
        for word, column in words.items():
            said = changed & (by_vector if word in TOOL_VECTOR_WORDS else ~by_vector)
            columns[word] = np.where(said, column, ABSENT)
            forced[word] = said.astype(np.int64)
        rows = np.flatnonzero(changed)
        manners = by_vector[rows].astype(np.int64)
        if len(rows) and self._switches_orientation_mode:
            anew = rows[manners != np.concatenate(([self._orients_by_vector], manners[:-1]))]
            for word, which in ((ORIENT_BY_VECTOR_WORD, 1), (ORIENT_BY_AXES_WORD, 0)):
                columns[word] = np.full(len(rotary), ABSENT, np.int64)
                columns[word][anew[by_vector[anew] == which]] = 0
            self._orients_by_vector = int(manners[-1])
        return last

    def _rotary_counts(self, angle: Floats, word: str, column: int) -> Ints:
        return rotary_counts(self.program.machine, column, angle, self.writer.word(word).format.decimals)

    def _apply_axis_coordinates(
        self, slides: AxisCoordinates, feed: Floats, part: slice, rapid: Flags, columns: dict[str, Ints]
    ) -> dict[str, bool | Ints]:
        """Change the words of rows without TCP: the feed of blocks that turn, and the shorter way of endless axes.

        Returns which words are said though they may print as before: X in rapids, which without a slide would only
        place the rotary axes.
        """
        turning = slides.rotary_moves[part] & ~rapid
        rule = feed_rule(self.control, effective_settings(self.program))
        key = "inverse_feed" if rule == "inverse_time" else "feed"
        form = self.writer.word(key).format
        rate = round_to_counts(
            np.where(turning, feed_words(slides.select(part), feed, rule, form)[0], np.nan), form.decimals
        )
        if rule == "inverse_time":
            columns["feed"][turning] = ABSENT
            columns["feed_mode"][turning] = self.control.codes["feed_inverse_time"]
            columns[key] = rate
        else:
            rate[turning & (rate == self.rapid_feed)] += 1  # lines at that feed stand for rapids
            columns[key][turning] = rate[turning]
        for key, which in self._rotary:
            jumps = slides.wraps[part, self._column[which]]
            if jumps.any() and not self.control.shorter_way:  # which only controls do that have the word
                columns[f"{key}_shortest"] = np.where(jumps, columns[key], ABSENT)
                columns[key][jumps] = ABSENT
        return {"X": rapid.astype(np.int64)}

    def _feed_mode_changes(self, columns: Mapping[str, Ints], rapid: Flags) -> Ints:
        """(n,) 1 in the rows from which F means something else than before; there it is said, whatever its number."""
        changes = np.zeros(len(rapid), np.int64)
        cuts = np.flatnonzero(~rapid)
        if len(cuts) and "feed_mode" in columns:
            modes = columns["feed_mode"][cuts]
            changes[cuts] = modes != np.concatenate(([self._feed_mode], modes[:-1]))
            self._feed_mode = int(modes[-1])
        return changes

    def _set_words(self, columns: dict[str, Ints], row: int, words: Mapping[str, int]) -> None:
        """Put words onto a row."""
        for word, code in words.items():
            column = columns.setdefault(word, np.full(len(columns["X"]), ABSENT, np.int64))
            column[row] = code

    def phase_texts(self) -> tuple[Ints, list[str]]:
        """(9,) int64 index of the line for each ``Phase``, -1 for none, and the lines; equal lines share an index."""
        texts = [self.control.phases.get(_PHASE_KEYS.get(phase, ""), "") for phase in Phase]
        lines = list(dict.fromkeys(text for text in texts if text))
        return np.array([lines.index(text) if text else -1 for text in texts], np.int64), lines

    def restore_modal_state(self) -> None:
        """Say again what the program start put in force, as far as the operation has changed it."""
        columns = {word: np.array([code], np.int64) for word, code in self.control.initial_modal_state.items()}
        if columns:
            self.writer.write_table(columns)
