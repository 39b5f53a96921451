"""Motion blocks: the rows of a motion become tables of words, and events that are words join them.

In:     motions as they are written, row by row, with the events at them.
Out:    blocks, through the block writer.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import BinaryIO, Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import FamilyWriter, WordEvent
from trunnion.controls.template import Template
from trunnion.controls.vocabulary import RADIUS_NUMBER_WORD, TOOL_VECTOR_WORDS, VECTOR_LINE_WORD
from trunnion.controls.words import ABSENT, WordRangeError
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Arcs, Coolant, CutterComp, Kind, LoadTool, SpindleOn
from trunnion.output.blocks.block_table import BlockTable
from trunnion.output.blocks.block_writer import CHUNK, BlockWriter
from trunnion.output.blocks.feeds import FEED_WORDS, FeedWords
from trunnion.output.blocks.first_leg import FirstLegs
from trunnion.output.blocks.line_texts import LineTexts
from trunnion.output.blocks.orientation import OrientationWords
from trunnion.output.blocks.phase_comments import phase_comments
from trunnion.output.blocks.surface_normals import add_vector_lines, contact_rows
from trunnion.output.changed_words import ChangedCoolant, ChangedWords
from trunnion.output.coordinates.approach_leg import ApproachLegs
from trunnion.output.coordinates.axis_coordinates import AxisCoordinates, to_axis_coordinates
from trunnion.output.program import Program
from trunnion.output.tool_calls import edge_setting

#: Words that are repeated where an operation continues in another file, besides those that every row has.
_REPEATED_WORDS: Final = ("plane", "feed_mode", "cutter_comp", "speed", "edge", "spindle", "coolant")

#: Bytes of the lines before a single row at most: a phase comment, the centre of an arc.
_ROW_LINES_BYTES: Final = 256

#: Bytes of the lines before and behind the holes of a cycle at most.
_CYCLE_LINES_BYTES: Final = 1024

#: Machining modes in which the tool lies along Z of the program.
_Z_ALONG_TOOL: Final = (MachiningMode.THREE_AXIS, MachiningMode.TILTED)


class MotionBlockWriter:
    """Writes the motion blocks of a program.

    writer          the block writer
    spindle         the last spindle start, also after the spindle has stopped; None before the first
    coolant         the kind of the last coolant command; ``coolant_may_run``: OFF, by a command that may be skipped
    feeds           F and the active feed mode
    tool_height     Z of the tool after the last row, mm
    height_bound    after blocks that may be skipped: the tool may be lower than ``tool_height``, but not higher than
                    this, mm; None: it is at ``tool_height``
    xy_before_z     the tool goes to X and Y of the motion's first point before it goes down
    first_leg       where it goes first instead, (3,) mm in the coordinates of the blocks; None: nowhere
    max_file_bytes  bytes up to which rows may fill a file; None: no limit
    on_file_full    called where a file has no room for another row; it switches to the next file
    """

    def __init__(self, program: Program, sink: BinaryIO, progress: Callable[[int], None]) -> None:
        self.program = program
        self.control = program.control
        self.family: FamilyWriter = program.control.family
        self.progress = progress
        self._words = program.block_words(program.motions[0])
        numbers, increments = self.control.block_numbers, program.increments
        self.writer = BlockWriter(sink, self._words, numbers, program.text_form, increments)
        self.passages: list[tuple[BinaryIO, int, tuple[str, ...], Template]] = []  # sink, line, texts, template
        self.feeds = FeedWords(program, self.writer)
        self._orientation = OrientationWords(program, self.writer, self._words)
        self._axis_coordinates: AxisCoordinates | None = None
        self.spindle: SpindleOn | None = None
        self.coolant, self.coolant_may_run = "OFF", False
        self.tool_height = 0.0
        self.height_bound: float | None = None
        self.xy_before_z = False
        self.first_leg: Floats | None = None
        self.max_file_bytes: int | None = None
        self.on_file_full: Callable[[], None] = lambda: None
        self._file, self._tool = program.file, ""
        self._compensated = False
        self._length_register = self._radius_offset = 0
        self._words_to_repeat: dict[str, int] = {}
        self._texts = LineTexts(program)
        self.legs = FirstLegs(ApproachLegs(program), self.writer)

    # Motions

    def use_axis_coordinates(self, motion: Motion) -> Motion:
        """Return the motion in the coordinates of its blocks: without TCP, those of the linear axes.

        The rows that are written next must be those of the returned motion.
        """
        self._axis_coordinates = None
        if motion.mode is MachiningMode.WITHOUT_TCP:
            angle = self.control.number_formats(motion.three_axis)["angle"]
            self._axis_coordinates = to_axis_coordinates(self.program.machine_of(motion), motion, angle.decimals)
            motion = self._axis_coordinates.motion
        return motion

    def begin_motion(self, motion: Motion, tool: str, *, from_plane: bool, retracted: bool) -> None:
        """Begin a motion, with the word formats of its mode.

        motion      an operation, or the part of it in one plane
        tool        the tool as the program calls it
        from_plane  the tool comes from another plane of the operation, and not from home
        retracted   the tool has been retracted, so that it goes to X and Y before it goes along the tool axis: in
                    planes, and in three-axis operations on controls with ``level_approach``
        """
        self._file = self.program.file_of(motion.operation)
        self._tool = tool
        self._radius_offset = int(self.program.effective_setting("radius_offset", motion.operation) or 0)
        loads = [event for event in motion.operation.events if isinstance(event, LoadTool)]
        if loads:  # a tool that the run's settings name has its own register
            self._length_register = 0 if self.program.effective_setting("tool", motion.operation) else loads[-1].adjust
        in_plane = motion.mode is MachiningMode.TILTED
        level = in_plane or (self.control.level_approach and motion.mode is MachiningMode.THREE_AXIS)
        self.xy_before_z, self.first_leg = retracted and level, None
        self._words = self.program.block_words(motion)
        self.writer.use_words(self._words)
        if from_plane:
            self.writer.forget("X", "Y", "Z", *FEED_WORDS)
        else:
            self.writer.forget()
            for word, code in self.control.initial_modal_state.items():
                self.writer.remember(word, code)
        self.feeds.forget_mode()
        self._orientation.begin_motion(motion, self._words)

    def assume_rotary_position(self, motion: Motion) -> None:
        """Take it that templates have moved the rotary axes to a motion's first row."""
        self._orientation.assume_position(motion.rotary[0])

    def first_block_words(self, motion: Motion) -> dict[str, int]:
        """Return the family's words for the first motion block, as counts."""
        orientation = {"orientation": "vector" if self._orientation.uses_vectors else "angles"}
        settings = self.program.effective_settings(motion.operation) | orientation
        if "edge" in settings:
            settings["edge"] = edge_setting(self.program, motion.operation, self._length_register)
        words = self.family.first_block_words(motion, self._tool, self._length_register, settings)
        return {word: self.writer.to_count(word, value) for word, value in words.items()}

    def restore_modal_state(self) -> None:
        """Write again what the program start made active, where the operation has changed it."""
        self._compensated = False
        if self.control.initial_modal_state:
            self.write_block(self.control.initial_modal_state)

    # Lines and single blocks

    def write_lines(self, lines: Sequence[str], *, as_they_are: bool = False, source: Template | None = None) -> None:
        """Write lines of text, each a block; a line that ends with the continuation sign shares that of the next.

        What a template of the user's has printed, the ``source``, is noted with its place.

        Comments that are longer than the control can read continue in the next line; they get capitals where these are
        asked for, unless lines are to stay ``as_they_are``.

        Raises ``InputError`` if another line is, or has a character that the program's encoding lacks.
        """
        self.writer.end_increments()
        sign, blocks, continues = self.control.continued, list[str](), False
        own = source if source is not None and source.is_of_user else None
        file, at = own.place_of(0) if own is not None else (self._file, 0)
        for line in self._texts.whole(lines, file, at, as_they_are=as_they_are):
            blocks[len(blocks) - continues :] = [f"{blocks[-1]}\n{line}" if continues else line]
            continues = bool(sign) and line.endswith(sign)
        if own is not None:
            self.passages.append((*self.writer.place, tuple("\n".join(blocks).split("\n")), own))
        self.writer.write_lines(blocks)

    def write_block(self, words: Mapping[str, int]) -> None:
        """Write one block of words, as counts; none if all of them are active."""
        self.writer.write_words(words)

    def write_event(self, event: WordEvent) -> None:
        """Write the words of an event as a block of its own."""
        words = self.event_words(event)
        if isinstance(event, CutterComp) and self._is_on_arc(words):
            words["motion"] = self.writer.to_count("motion", self.control.codes["linear"])
        try:
            self.write_block(words)
        except WordRangeError as error:
            raise error.at(self._file, event.line) from None

    def _is_on_arc(self, words: Mapping[str, int]) -> bool:
        """Whether G2 or G3 may be in force where compensation is switched: controls stop with an alarm there."""
        if "cutter_comp" not in words:
            return False
        motion = self.writer.modal_state().get("motion")
        arcs = [self.control.codes[f"arc_{way}"] for way in ("clockwise", "counterclockwise")]
        return motion is None or motion in [self.writer.to_count("motion", code) for code in arcs]

    def needs_motion(self, event: WordEvent | ChangedWords) -> bool:
        """Whether the words of an event make no block alone, as ``RL`` does not."""
        if not isinstance(event, CutterComp):
            return isinstance(event, ChangedWords)
        words = self.family.event_words(event, self.control.codes, self.control.coolant)
        return bool(words) and all(self.writer.word(key).bare for key in words)

    def event_words(self, event: WordEvent | ChangedWords) -> dict[str, int]:
        """Return the words of an event that joins a motion block, as counts."""
        if isinstance(event, ChangedWords):
            return dict(event.words)
        if isinstance(event, SpindleOn):
            self.spindle = event
        elif isinstance(event, Coolant):
            self.coolant, self.coolant_may_run = event.kind, False
        elif isinstance(event, CutterComp):
            # Where the block of CUTCOM/OFF may be skipped, it may stay on.
            self._compensated = event.side != "OFF" or (self._compensated and self.writer.skips_blocks)
            if event.side != "OFF" and not event.register and self._names_radius:
                event = replace(event, register=int(self._tool) + self._radius_offset)
        words = self.family.event_words(event, self.control.codes, self.control.coolant)
        changed = dict(event.changed) if isinstance(event, ChangedCoolant) else {}
        return {word: self.writer.to_count(word, value) for word, value in words.items()} | changed

    @property
    def _names_radius(self) -> bool:
        """Whether radius compensation names a register: that of the tool, if the CL file names no other."""
        return RADIUS_NUMBER_WORD in self.family.WORDS and self._tool.isdigit()

    def phase_texts(self) -> tuple[Ints, list[str]]:
        """Return an index of each ``Phase`` into the phase comments, -1 for none, (9,) int64; and the comments."""
        numbers, lines = phase_comments(self.control.phases)
        return numbers, self._texts.spelled(lines, self._file)

    # Rows

    def write_rows(
        self, motion: Motion, first: int, last: int, joining_events: Sequence[WordEvent | ChangedWords], phase: int
    ) -> int:
        """Write rows ``first`` to ``last`` (excluded), in as many files as they need.

        ``phase`` is the index of the phase comment that was written last; returns the new one.
        """
        start = first
        while start < last:
            fitting = self._fitting_rows()
            if fitting < 1:
                self._continue_in_next_file()
                phase, fitting = -1, self._fitting_rows()
            stop = min(start + max(1, fitting), last)
            events = [event for event in joining_events if start <= event.row < stop]
            phase = self.write_chunk(motion, start, stop, events, phase)
            self.progress(stop - start)
            start = stop
        return phase

    def write_chunk(
        self,
        motion: Motion,
        start: int,
        stop: int,
        joining_events: Sequence[WordEvent | ChangedWords],
        phase: int,
        *,
        repeat_point: bool = False,
    ) -> int:
        """Write rows as ``write_rows`` does, all into the present file.

        ``repeat_point``: also a point at which the tool already is gets a block.
        """
        moves, rows = motion.operation.moves, slice(start, stop)
        self.tool_height, self.height_bound = float(moves.tip[stop - 1, 2]), None
        rapid = np.asarray(moves.kind[rows] == Kind.RAPID)
        table, other_end = self.words_of_rows(motion, rows, rapid)
        if repeat_point:
            table.force("X", np.ones(stop - start, np.bool_))
        if start == 0:
            first_words = self.first_block_words(motion)
            if rapid[0] and (self.xy_before_z or self.first_leg is not None):
                words = table.words_of_row(0)
                first_words = self.legs.write(motion, moves.tip[0], words, first_words, self.first_leg)
                if self._axis_coordinates is not None:
                    table.write_if_changed("X", 0)  # Z moves alone behind the leg
            table.set_words(0, first_words)
        for event in joining_events:
            table.set_words(event.row - start, self.event_words(event))
        table.set_missing(0, self._words_to_repeat)
        self._words_to_repeat = {}
        ids, texts = self.phase_texts()
        phases = ids[moves.phase[rows]]
        changes = phases != np.concatenate(([phase], phases[:-1]))
        relative = table.relative_rows(start) if motion.mode in _Z_ALONG_TOOL else None
        comments = np.where(changes, phases, -1), texts
        try:
            self.writer.write_table(table.columns, table.forced, *comments, table.lines, relative)
        except WordRangeError as error:
            raise error.at(self._file, int(moves.line[start + error.row])) from None
        if other_end:
            self.writer.forget("X", "Y", "Z")
        self._orientation.remember_state()
        return int(phases[-1])

    def words_of_rows(self, motion: Motion, rows: slice, rapid: Flags) -> tuple[BlockTable, bool]:
        """Return the words of rows, events aside; and whether the last row's end is not in X Y Z (but in an angle)."""
        table = self._table_of_rows(motion, rows, rapid)
        return table, self._add_arcs(table, motion, rows)

    def _table_of_rows(self, motion: Motion, rows: slice, rapid: Flags) -> BlockTable:
        """Return the words of rows as if none were an arc."""
        moves, table = motion.operation.moves, BlockTable(len(rapid))
        for c, word in enumerate("XYZ"):
            table.columns[word] = self.writer.word(word).format.counts(moves.tip[rows, c])
        contact = contact_rows(motion, rows)
        self._orientation.add_words(table, motion, rows, contact)
        self.feeds.add_words(table, moves, rows, rapid)
        uses_vectors = self._orientation.uses_vectors
        if (uses_vectors or contact.any()) and any(word.key == VECTOR_LINE_WORD for word in self._words):
            add_vector_lines(table, moves, rows, contact, uses_vectors, self.writer)
        if self._axis_coordinates is not None:
            self.feeds.add_words_without_tcp(table, self._axis_coordinates, moves, rows, rapid)
            self._add_shortest_words(table, self._axis_coordinates, rows)
            table.force("X", rapid)  # a rapid without a linear axis would only place the rotary axes
        self.feeds.force_at_mode_changes(table, rapid)
        return table

    def _add_shortest_words(self, table: BlockTable, motion: AxisCoordinates, rows: slice) -> None:
        """Write the words for the shorter way where an endless axis crosses the end of its displayed turn."""
        for word in self.program.rotary_words():
            crosses = motion.wraps[rows, word.column]
            if crosses.any() and not self.control.shorter_way:  # such controls need no words for it
                table.columns[f"{word.key}_shortest"] = np.where(crosses, table.columns[word.key], ABSENT)
                table.columns[word.key][crosses] = ABSENT

    def _add_arcs(self, table: BlockTable, motion: Motion, rows: slice) -> bool:
        """Turn rows into arcs; returns whether the last row's end is not in X Y Z (but in an angle, say)."""
        moves, arcs = motion.operation.moves, motion.operation.arcs
        inside = np.flatnonzero((arcs.row >= rows.start) & (arcs.row < rows.stop))
        if not len(inside):
            return False
        formats = {word.key: word.format for word in self._words}
        words = self.family.arc_words(arcs, moves.tip, inside, self.control.codes, formats, self.control.arcs.by_radius)
        at = arcs.row[inside] - rows.start
        if self._orientation.uses_vectors:  # the tool axis is constant along an arc
            for word in (*TOOL_VECTOR_WORDS, VECTOR_LINE_WORD):
                if word in table.columns:
                    table.columns[word][at] = ABSENT
        for word, column in words.columns.items():
            table.column(word)[at] = column
        for word, flags in words.forced.items():
            every = np.zeros(table.rows, np.int64)
            every[at] = flags
            table.force(word, every)
        table.lines |= {row: line for row, line in zip(at.tolist(), words.lines or (), strict=False) if line}
        if self.family.INCREMENTS is not None and not self.family.INCREMENTS.circles:
            table.absolute |= set(at.tolist())
        other_end = table.columns["X"] == ABSENT
        table.absolute |= set((np.flatnonzero(other_end) + 1).tolist())
        return table.write_in_full_behind(other_end, "XYZ")

    # Files

    def fitting_holes(self, motion: Motion, row: int, phase: int) -> tuple[int, int]:
        """Return how many holes from a row on surely fit into the file, with the lines of their cycle: at least one.

        Where there is no room, the operation continues in the next file, with a block at which the tool already is.
        Also returns the index of the phase comment that was written last.
        """
        fitting = self._fitting_rows(_CYCLE_LINES_BYTES)
        if fitting >= 1 or row == 0:
            return max(1, fitting), phase
        self._continue_in_next_file()
        moves = motion.operation.moves
        tip, kind = moves.tip.copy(), moves.kind.copy()
        if motion.mode in _Z_ALONG_TOOL:
            tip[row - 1, 2] = self.tool_height
        kind[row - 1] = Kind.RAPID
        here = replace(motion.operation, moves=replace(moves, tip=tip, kind=kind), arcs=Arcs.empty())
        phase = self.write_chunk(replace(motion, operation=here), row - 1, row, (), -1, repeat_point=True)
        return max(1, self._fitting_rows(_CYCLE_LINES_BYTES)), phase

    def _fitting_rows(self, reserve: int = 0) -> int:
        """How many rows surely fit into the file beside ``reserve`` bytes; at least one where it must not end here.

        Radius compensation must end in the file in which it began: the control looks ahead within one file only.
        """
        if self.max_file_bytes is None:
            return CHUNK
        widest = self.writer.widest_row + _ROW_LINES_BYTES
        fitting = min(CHUNK, (self.max_file_bytes - reserve - self.writer.size) // widest)
        return max(1, fitting) if self._compensated else fitting

    def _continue_in_next_file(self) -> None:
        """Continue in the next file, whose first block repeats what is active.

        It does not repeat the tool length and TCP, which some controls take for a motion.
        """
        active = self.writer.modal_state()
        self._words_to_repeat = {word: active[word] for word in _REPEATED_WORDS if word in active}
        self.on_file_full()
        self.writer.forget()
        self.feeds.forget_mode()
        self._orientation.begin_file()
