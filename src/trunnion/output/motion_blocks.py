"""Motion blocks: rows become tables of words, and events that are words join them.

In:     motions as they are written, row by row, with the events at them.
Out:    blocks through the block writer; what is in force between them is kept here.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.definition import AXIS_VECTOR, BY_AXES, BY_VECTOR, VECTOR_LINE
from trunnion.controls.family import WordEvent
from trunnion.controls.words import ABSENT, counts
from trunnion.errors import InputError, Problem
from trunnion.model.motion import Manner, Motion
from trunnion.model.toolpath import Arcs, Coolant, Kind, LoadTool, Phase, SpindleOn
from trunnion.output.axis_coordinates import Slides, feed_rule, feeds, slides_of
from trunnion.output.block_writer import CHUNK, ROOM_OF_NUMBER, BlockWriter
from trunnion.output.program import Program, angle_counts, setting_of, settings_of, words_of
from trunnion.output.surface_normals import normal_words, touching_rows
from trunnion.output.tool_vectors import first_elsewhere, leads_there, vectors_of

_PHASE_TEXT = {
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
_SAID_AGAIN = ("plane", "feed_mode", "cutter_comp", "speed", "edge", "spindle", "coolant")

#: Bytes of the lines that stand before a row of their own, at most: a phase, an arc's centre.
_LINES_OF_A_ROW = 256

#: Bytes of the lines before and behind the holes of a cycle, at most.
_LINES_OF_A_CYCLE = 1024

#: Manners in which X and Y of the program are across the tool.
_LEVEL = (Manner.THREE_AXIS, Manner.TILTED)


class Blocks:
    """The motion blocks of one program.

    writer   the block writer
    spindle  what the spindle was last told, also where it has been stopped since; None before
    coolant  its kind, as it was last told
    height   of the tool along Z of the frame, at the last row written, mm
    highest  behind blocks that may be skipped: it is not above this, but may be below ``height``; None: it is there
    largest  bytes that the rows of a file may come to; None: no matter how many
    full     is called where a file has no room for another row: it turns to the next one
    comes_level  whether the tool goes to X and Y of an operation's first point before it goes down
    """

    def __init__(self, program: Program, sink: BinaryIO, progress: Callable[[int], None]) -> None:
        self.program = program
        self.control = program.control
        self.family = program.control.family
        self.progress = progress
        self._column = {k: c for c, k in enumerate(program.machine.rotary)}
        self._rotary = (("primary", program.machine.primary), ("secondary", program.machine.secondary))
        self._words = words_of(program, program.motions[0])
        self.writer = BlockWriter(sink, self._words, self.control.numbers)
        self.spindle: SpindleOn | None = None
        self.coolant = "OFF"
        self.height = 0.0
        self.highest: float | None = None
        self.comes_level = False
        self._slides: Slides | None = None
        self._feed_mode = ABSENT
        self._tool = ""
        self._register = 0
        self._vectors = False  # of this motion
        self._turns_over = any(word.key == BY_VECTOR for word in self._words)
        self._again: dict[str, int] = {}
        self._by_vector = ABSENT  # how the control goes to an orientation: 1 by the vector, 0 by the axes
        self.largest: int | None = None
        self.full: Callable[[], None] = lambda: None
        rapid_feed = setting_of(program, "rapid_feed")
        self.rapid_feed = self.count("feed", float(rapid_feed)) if rapid_feed else ABSENT

    def slid(self, motion: Motion) -> Motion:
        """A motion in the words of its manner: without TCP these are slides. What follows is of this motion."""
        self._slides = None
        if motion.manner is Manner.WITHOUT_TCP:
            angle = self.control.number_formats(motion.three_axis)["angle"]
            self._slides = slides_of(self.program.machine, motion, angle.decimals)
            motion = self._slides.motion
        return motion

    def begin(self, motion: Motion, tool: str, goes_on: bool, *, comes_level: bool) -> None:
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
            self._register = 0 if setting_of(self.program, "tool") else loads[-1].adjust
        self.comes_level = comes_level and self.control.level_approach and motion.manner in _LEVEL
        self._words = words_of(self.program, motion)
        self.writer.use(self._words)
        if not goes_on:
            self.writer.forget()
            for word, code in self.control.in_force.items():
                self.writer.remember(word, code)
        else:
            self.writer.forget("X", "Y", "Z", "feed")
        self._feed_mode = ABSENT
        self._by_vector = 1
        self._vectors = motion.manner is Manner.TCP and self.control.by_vectors(self.program.settings)
        if self._vectors and self.control.only_vectors:
            self._vectors = first_elsewhere(self.program.machine, motion, self._words) < 0

    def rotary_stand(self, motion: Motion) -> None:
        """Templates have placed the rotary axes for a motion's first row."""
        for word, column in self._rotary:
            self.writer.remember(
                word, int(self._angle_counts(motion.rotary[:1, self._column[column]], word, column)[0])
            )
        if self._vectors:
            for word, counted in self._axis_counts(motion.rotary[:1]).items():
                self.writer.remember(word, int(counted[0]))

    def use_feed_mode(self, mode: int) -> int:
        """What F means from here on; where that changes, F is said again. Returns ``mode``."""
        if mode != self._feed_mode:
            self.writer.forget("feed")
        self._feed_mode = mode
        return mode

    def lines(self, lines: Sequence[str]) -> None:
        """Lines of text, none longer than the control reads; what goes on in the next line is one block with it."""
        room = self.control.longest_line - ROOM_OF_NUMBER
        for line in lines:
            if len(line.encode()) > room:
                what = f"a line has more than the {self.control.longest_line} bytes that {self.control.name} reads"
                raise InputError(Problem(self.program.file, 0, f"{what}: {line[:60]}…", "shorten the text"))
        sign, blocks, goes_on = self.control.continued, list[str](), False
        for line in lines:
            blocks[len(blocks) - goes_on :] = [f"{blocks[-1]}\n{line}" if goes_on else line]
            goes_on = bool(sign) and line.endswith(sign)
        self.writer.lines(blocks)

    def event_block(self, event: WordEvent) -> None:
        """Words of an event in a block of their own."""
        self.writer.table({word: np.array([code], np.int64) for word, code in self.event_words(event).items()})

    def event_words(self, event: WordEvent) -> dict[str, int]:
        """The words of an event that joins a motion block, as counts."""
        if isinstance(event, SpindleOn):
            self.spindle = event
        elif isinstance(event, Coolant):
            self.coolant = event.kind
        words = self.family.event_words(event, self.control.codes, self.control.coolant)
        return {word: self.count(word, value) for word, value in words.items()}

    def count(self, word: str, value: float) -> int:
        return int(counts(np.array([value]), self.writer.word(word).format.decimals)[0])

    def block(self, words: Mapping[str, int]) -> None:
        """One block of these words, as counts; nothing where all of them are in force."""
        self.writer.table({word: np.array([count], np.int64) for word, count in words.items()})

    def rows(self, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int) -> int:
        """Write rows ``first`` to ``last``; returns the index of the phase text that was printed last."""
        start = first
        while start < last:
            fitting = self._fitting()
            if fitting < 1:
                self._turn_over()
                text, fitting = -1, self._fitting()
            stop = min(start + max(1, fitting), last)
            text = self.chunk(motion, start, stop, [e for e in joining if start <= e.row < stop], text)
            self.progress(stop - start)
            start = stop
        return text

    def holes(self, motion: Motion, row: int, text: int) -> tuple[int, int]:
        """How many holes surely fit into the file from a row on, with what begins and ends their cycle: at least one.

        In a file that has no room left they do not begin: the next one begins where the tool stands. Returns the
        number, and the index of the phase text that was printed last.
        """
        fitting = self._fitting(_LINES_OF_A_CYCLE)
        if fitting >= 1 or row == 0:
            return max(1, fitting), text
        self._turn_over()
        moves = motion.operation.moves
        tip, kind = moves.tip.copy(), moves.kind.copy()
        if motion.manner in _LEVEL:
            tip[row - 1, 2] = self.height
        kind[row - 1] = Kind.RAPID
        stands = replace(motion.operation, moves=replace(moves, tip=tip, kind=kind), arcs=Arcs.none())
        text = self.chunk(replace(motion, operation=stands), row - 1, row, (), -1, anew=True)
        return max(1, self._fitting(_LINES_OF_A_CYCLE)), text

    def _fitting(self, kept: int = 0) -> int:
        """So many rows surely fit into the file beside what is ``kept``, at least one where it must not end here.

        Radius compensation goes on to the end: the control looks ahead there, and not from file to file.
        """
        if self.largest is None:
            return CHUNK
        widest = self.writer.widest_row + _LINES_OF_A_ROW
        fitting = min(CHUNK, (self.largest - kept - self.writer.size) // widest)
        off = self.control.codes.get("comp_off", ABSENT)
        compensated = self.writer.in_force().get("cutter_comp", off) != off
        return max(1, fitting) if compensated else fitting

    def _turn_over(self) -> None:
        """Go on in the next file: what is in force is said again in its first block, but for the tool's length and TCP,
        which some controls take as a motion."""
        known = self.writer.in_force()
        self._again = {word: known[word] for word in _SAID_AGAIN if word in known}
        self.full()
        self.writer.forget()
        self._feed_mode = ABSENT
        self._by_vector = ABSENT

    def chunk(
        self, motion: Motion, start: int, stop: int, joining: Sequence[WordEvent], text: int, *, anew: bool = False
    ) -> int:
        """As ``rows``, all in one file; ``anew``: a point at which the tool already stands gets its block."""
        moves, arcs, control = motion.operation.moves, motion.operation.arcs, self.control
        part = slice(start, stop)
        self.height, self.highest = float(moves.tip[stop - 1, 2]), None
        rapid = moves.kind[part] == Kind.RAPID
        decimals = {word: self.writer.word(word).format.decimals for word in ("X", "feed")}
        columns = {
            word: counts(np.ascontiguousarray(moves.tip[part, c]), decimals["X"]) for c, word in enumerate("XYZ")
        }
        forced: dict[str, bool | Ints] = {"X": np.ones(stop - start, np.int64)} if anew else {}
        by_vector = self._vectors
        in_force: dict[str, int] = {}
        if motion.plane is None:  # in a plane the rotary axes stand where they were put
            for word, axis in self._rotary:
                columns[word] = self._angle_counts(motion.rotary[part, self._column[axis]], word, axis)
        touching = touching_rows(motion, part)
        if by_vector:
            in_force = self._orient(motion, start, stop, columns, forced, touching)
        columns["feed"] = np.where(
            rapid, self.rapid_feed, counts(np.where(rapid, np.nan, moves.feed[part]), decimals["feed"])
        )
        columns |= self.family.row_words(rapid, moves.per_rev[part], control.codes)
        if (by_vector or touching.any()) and any(word.key == VECTOR_LINE for word in self._words):
            said = columns[AXIS_VECTOR[0]] != ABSENT if by_vector else touching
            columns |= normal_words(moves, part, said & touching, self.writer)
            columns |= {VECTOR_LINE: np.where(said, 1, ABSENT), "line": np.where(said, ABSENT, columns["line"])}
            forced |= dict.fromkeys("XYZ", said.astype(np.int64))
        if self._slides is not None:
            forced |= self._words_of_slides(self._slides, moves.feed[part], part, rapid, columns)
        forced["feed"] = self._feed_anew(columns, rapid)
        lines: dict[int, str] = {}
        elsewhere = np.zeros(stop - start, np.bool_)
        inside = np.flatnonzero((arcs.row >= start) & (arcs.row < stop))
        if len(inside):
            formats = {word.key: word.format for word in self._words}
            words = self.family.arc_words(arcs, moves.tip, inside, control.codes, formats, control.arcs_by_radius)
            at = arcs.row[inside] - start
            for word in (*AXIS_VECTOR, VECTOR_LINE) if by_vector else ():  # the tool axis rests on a circle
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
        if start == 0 and rapid[0] and self.comes_level:
            self.block({word: int(column[0]) for word, column in columns.items() if word != "Z"})
        if start == 0:
            self._join(columns, 0, self.first_words(motion))
        for event in joining:
            self._join(columns, event.row - start, self.event_words(event))
        if self._again:
            said = {word: int(column[0]) for word, column in columns.items()}
            self._join(columns, 0, {w: count for w, count in self._again.items() if said.get(w, ABSENT) == ABSENT})
            self._again = {}
        ids, texts = self.phase_texts()
        wanted = ids[moves.phase[part]]
        before = np.concatenate(([text], wanted[:-1]))
        self.writer.table(columns, forced, np.where(wanted != before, wanted, -1), texts, lines)
        if elsewhere[-1]:
            self.writer.forget("X", "Y", "Z")
        for word, count in in_force.items():
            self.writer.remember(word, count)
        return int(wanted[-1])

    def first_words(self, motion: Motion) -> dict[str, int]:
        """What the control is told of the tool with the first motion, as counts."""
        said = {"orientation": "vector" if self._vectors else "angles"}
        settings = settings_of(self.program) | said
        words = self.family.first_words(motion, self._tool, self._register, settings)
        return {word: self.count(word, value) for word, value in words.items()}

    def _axis_counts(self, rotary: Floats) -> dict[str, Ints]:
        """The tool axis as a vector, by where the rotary axes stand, however they lean; as counts."""
        decimals = self.writer.word(AXIS_VECTOR[0]).format.decimals
        vectors = vectors_of(self.program.machine, rotary)
        return {word: counts(np.ascontiguousarray(vectors[:, k]), decimals) for k, word in enumerate(AXIS_VECTOR)}

    def _orient(
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
        vectors = self._axis_counts(rotary)
        printed = np.column_stack(list(vectors.values())) / np.float64(
            10 ** self.writer.word(AXIS_VECTOR[0]).format.decimals
        )
        before = np.concatenate((motion.rotary[max(start - 1, 0) : max(start, 1)], rotary[:-1]))
        half = 0.5 * 10.0 ** -self.writer.word("primary").format.decimals
        if self.control.only_vectors:
            by_vector = np.ones(len(rotary), np.bool_)
        else:
            by_vector = leads_there(self.program.machine, printed, rotary, before, half)
        words = vectors | {word: columns[word] for word, _ in self._rotary}
        changed = np.zeros(len(rotary), np.bool_)
        for word, column in words.items():
            changed |= column != np.concatenate(([self.writer.printed(word)], column[:-1]))
        last = {word: int(column[-1]) for word, column in words.items()}
        by_vector |= ~changed  # the control is there already
        changed |= touching
        for word, column in words.items():
            said = changed & (by_vector if word in AXIS_VECTOR else ~by_vector)
            columns[word] = np.where(said, column, ABSENT)
            forced[word] = said.astype(np.int64)
        rows = np.flatnonzero(changed)
        manners = by_vector[rows].astype(np.int64)
        if len(rows) and self._turns_over:
            anew = rows[manners != np.concatenate(([self._by_vector], manners[:-1]))]
            for word, which in ((BY_VECTOR, 1), (BY_AXES, 0)):
                columns[word] = np.full(len(rotary), ABSENT, np.int64)
                columns[word][anew[by_vector[anew] == which]] = 0
            self._by_vector = int(manners[-1])
        return last

    def _angle_counts(self, angle: Floats, word: str, column: int) -> Ints:
        return angle_counts(self.program.machine, column, angle, self.writer.word(word).format.decimals)

    def _words_of_slides(
        self, slides: Slides, feed: Floats, part: slice, rapid: Flags, columns: dict[str, Ints]
    ) -> dict[str, bool | Ints]:
        """Change the words of rows without TCP: the feed of blocks that turn, and the shorter way of endless axes.

        Returns which words are said though they may print as before: X in rapids, which without a slide would only
        place the rotary axes.
        """
        turning = slides.turns[part] & ~rapid
        rule = feed_rule(self.control, settings_of(self.program))
        key = "inverse_feed" if rule == "inverse_time" else "feed"
        form = self.writer.word(key).format
        rate = counts(np.where(turning, feeds(slides.at(part), feed, rule, form)[0], np.nan), form.decimals)
        if rule == "inverse_time":
            columns["feed"][turning] = ABSENT
            columns["feed_mode"][turning] = self.control.codes["feed_inverse_time"]
            columns[key] = rate
        else:
            rate[turning & (rate == self.rapid_feed)] += 1  # lines at that feed stand for rapids
            columns[key][turning] = rate[turning]
        for key, which in self._rotary:
            jumps = slides.shortest[part, self._column[which]]
            if jumps.any() and not self.control.shorter_way:  # which only controls do that have the word
                columns[f"{key}_shortest"] = np.where(jumps, columns[key], ABSENT)
                columns[key][jumps] = ABSENT
        return {"X": rapid.astype(np.int64)}

    def _feed_anew(self, columns: Mapping[str, Ints], rapid: Flags) -> Ints:
        """(n,) 1 in the rows from which F means something else than before; there it is said, whatever its number."""
        changes = np.zeros(len(rapid), np.int64)
        cuts = np.flatnonzero(~rapid)
        if len(cuts) and "feed_mode" in columns:
            modes = columns["feed_mode"][cuts]
            changes[cuts] = modes != np.concatenate(([self._feed_mode], modes[:-1]))
            self._feed_mode = int(modes[-1])
        return changes

    def _join(self, columns: dict[str, Ints], row: int, words: Mapping[str, int]) -> None:
        """Put words onto a row."""
        for word, code in words.items():
            column = columns.setdefault(word, np.full(len(columns["X"]), ABSENT, np.int64))
            column[row] = code

    def phase_texts(self) -> tuple[Ints, list[str]]:
        """(9,) int64 index of the line for each ``Phase``, -1 for none, and the lines; equal lines share an index."""
        texts = [self.control.phases.get(_PHASE_TEXT.get(phase, ""), "") for phase in Phase]
        lines = list(dict.fromkeys(text for text in texts if text))
        return np.array([lines.index(text) if text else -1 for text in texts], np.int64), lines

    def back_in_force(self) -> None:
        """Say again what the program start put in force, as far as the operation has changed it."""
        columns = {word: np.array([code], np.int64) for word, code in self.control.in_force.items()}
        if columns:
            self.writer.table(columns)
