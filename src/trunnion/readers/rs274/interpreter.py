"""The part of interpreters that languages of the RS274 kind share."""

import math
import re
from abc import abstractmethod
from pathlib import Path
from typing import Final, TypeVar

import numpy as np

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import iso_m_codes
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_recorder import ScannedRows
from trunnion.readers.control.start_modes import CENTRES, MOTION
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.program import interpreter
from trunnion.readers.program.coolant_words import coolant_of
from trunnion.readers.program.interpreter import Interpreter, ProgramEnd
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274 import arc_vectors
from trunnion.readers.rs274.block import Block, split_line
from trunnion.readers.rs274.control import CLOCKWISE, COUNTER_CLOCKWISE, Rs274Control
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.scan.buffers import BlockModes
from trunnion.readers.scan.letter_blocks import read_blocks
from trunnion.records import dataclass

#: G codes, in tenths: those of motions and what they set, and the one that ends cycles.
MOTIONS: Final = {0: RAPID, 10: LINEAR, 20: CLOCKWISE, 30: COUNTER_CLOCKWISE}
CANCEL: Final = 800

#: How the definition says that M2 and M30 of a subprogram end only that.
_RETURNS: Final = ("end_in_subprogram", "returns")

#: How it says that a circle is not modal.
_LINE_BEHIND_CIRCLES: Final = ("behind_circles", "line")

#: Letters of axes; a machine has five of them.
AXES: Final = "XYZABCUVW"

#: Beginnings of lines that may be plain blocks, so that a scan is worth starting, with circles and without.
_PLAIN_START, _PLAIN_LINE = (
    re.compile(
        rb"[ \t]*(?:N[0-9]+[ \t]*)?(?:[\r\n]|G[ \t]*0?[%s](?![0-9.])|[A-FXYZ][ \t]*[-+.0-9])" % motions, re.IGNORECASE
    )
    for motions in (b"0-3", b"01")
)
_PREFIX_LENGTH: Final = 48


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program or subprogram that is being executed.

    row        the row at which it began
    percents   lines with a percent sign so far
    """

    row: int = 0
    percents: int = 0


A = TypeVar("A", bound=ActiveProgram)


class Rs274Interpreter(Interpreter[A]):
    """Runs one program of this kind; families define what their blocks mean.

    motion_code   the G code in tenths, of a motion or a cycle, that holds for blocks without one of their own
    """

    #: Whether a semicolon begins a comment.
    semicolon = False

    motion_code = 0

    control: Rs274Control

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        self.control.arc_vectors = self._form.one.get(arc_vectors.KEY, "")

    @abstractmethod
    def _execute_block(self, active: A, line: int, text: str) -> None:
        """Execute a block without its comments; BlockError if that is impossible."""

    # Lines

    def _execute_line(self, active: A, line: int, raw: str) -> None:
        try:
            parts = split_line(raw, semicolon=self.semicolon)
        except BlockError as error:
            self._report_block(error)
            return
        self.control.block_number = parts.number
        try:
            if parts.text.startswith("%"):
                self._percent(active)
            elif parts.text and not (parts.skip_level >= 0 and self._options.skips(parts.skip_level)):
                if parts.skip_level >= 0:
                    self.control.add_event("block_skip", float(parts.skip_level))
                self._execute_block(active, line, parts.text)
        except BlockError as error:
            self._report_block(error)
        finally:
            for comment in parts.comments:
                self._record_comment(line, comment)
                self._handle_comment(comment)

    def _has_words(self, raw: str) -> bool:
        try:
            text = split_line(raw, semicolon=self.semicolon).text
        except BlockError:
            return True
        return bool(text) and not text.startswith("%")

    def _report_block(self, error: BlockError) -> None:
        self._note(error.wording.within("reason_not_executed"), Severity.ERROR)

    def _handle_comment(self, comment: str) -> None:
        """Act on a comment that has a meaning for the control."""

    def _percent(self, active: A) -> None:
        """Begin or end the file transfer."""
        active.percents += 1
        if active.percents > 1 or self.control.row > active.row:
            self._end_of_file(active)

    def _end_of_file(self, active: A) -> None:
        """End the program at a percent sign."""
        raise ProgramEnd

    # Plain blocks

    def _may_scan(self, source: SourceText) -> bool:
        circles = self._plane_of_circles >= 0
        motions = (0, 10, 20, 30) if circles else (0, 10)
        if self.motion_code not in motions or not self.control.absolute or MOTION not in self.control.said_from:
            return False
        beginning = source.buffer[source.position : source.position + _PREFIX_LENGTH].tobytes()
        return (_PLAIN_START if circles else _PLAIN_LINE).match(beginning) is not None

    @property
    @abstractmethod
    def _letter_table(self) -> Codes:
        """The table of ``letter_blocks`` for the present modes."""

    def _read_blocks(self, source: SourceText, limit: int) -> tuple[int, int]:
        modes = BlockModes(MOTIONS[self.motion_code], False, self._plane_of_circles)
        return read_blocks(source.buffer, source.position, limit, self._letter_table, modes, self.control.words)

    @property
    def _plane_of_circles(self) -> int:
        """The normal axis of the plane in which I J K are plain centres; -1: they are something else."""
        control = self.control
        plain = control.relative_centres and not control.arc_vectors
        return control.plane_axis if plain and not self._form.is_so(*_LINE_BEHIND_CIRCLES) else -1

    @property
    def _inverse_time(self) -> bool:
        return self.control.modal.feed_mode.current == 93

    def _check_scanned(self, scanned: ScannedRows) -> None:
        """Report lines and circles without a feed."""
        control, columns = self.control, self.control.columns
        self.motion_code = 10 * control.motion
        rows = scanned.rows
        kinds = columns.kind[rows.start : rows.stop]
        lines, circles = kinds != Kind.RAPID, kinds == Kind.ARC
        if circles.any():
            control.relied_from.setdefault(CENTRES, rows.start + int(circles.argmax()))
        if self._inverse_time:
            with_feed = (columns.programmed[rows.start : rows.stop] & int(ProgrammedWord.FEED)) != 0
            missing = np.flatnonzero(lines & ~with_feed) + rows.start
        else:
            feeds = np.append(scanned.feed_before, scanned.feed_values)
            if (feeds > 0.0).all():
                return
            begins = np.append(rows.start, scanned.feed_rows)
            feed = feeds[np.searchsorted(begins, np.arange(rows.start, rows.stop), "right") - 1]
            missing = np.flatnonzero(lines & ~(feed > 0.0)) + rows.start
        here = control.line
        for row in missing.tolist():
            control.line = int(columns.line[row - columns.base])
            variant = "circle_without_feed" if columns.kind[row] == Kind.ARC else "line_without_feed"
            self._note(Wording("NC240", variant), Severity.ERROR)
        control.line = here

    # Words

    def _report_repeated_word(self, letter: str) -> None:
        self._note(Wording("NC212", "last_counts", word=letter), Severity.ERROR)

    def _axis_words(self, block: Block) -> dict[str, AxisWord]:
        """Return the words of the machine's axes; report those of other axes."""
        axes: dict[str, AxisWord] = {}
        for letter in AXES:
            if letter not in block.words:
                continue
            value = block.words[letter].value
            block.used.add(letter)
            if letter in "XYZ" or letter in self.control.rotary_names:
                axes[letter] = value, PositionMode.MODAL
            else:
                self._note(Wording("NC230", "no_such_axis", axis=letter), Severity.ERROR)
        return axes

    def _feed_and_speed(self, block: Block) -> None:
        control = self.control
        feed = block.take("F")
        if feed is not None:
            if feed < 0.0:
                raise BlockError(Wording("NC215", "feed_below_zero"))
            control.programmed_feed = feed if self._inverse_time else feed * control.feed_unit
        speed = block.take("S")
        if speed is not None:
            if speed < 0.0:
                raise BlockError(Wording("NC215", "speed_below_zero"))
            control.modal.rpm.set(control.row, speed)
            control.add_event("speed", speed)

    def _common_m_code(self, code: int) -> bool:
        """Execute an M code that all these languages share; False if it is another one."""
        control = self.control
        if code in iso_m_codes.EVENTS:
            kind, value = iso_m_codes.EVENTS[code]
            control.add_event(kind, coolant_of(control.machine, code, value) if kind == "coolant" else value)
        elif code == iso_m_codes.TOOL_CHANGE:
            control.change_tool()
        elif code in iso_m_codes.PROGRAM_ENDS and len(self._stack) > 1 and self._form.is_so(*_RETURNS):
            self._leave_program()
        elif code in iso_m_codes.PROGRAM_ENDS:
            control.report_unused_offsets()
            control.report_trailing_modes()
            if left := control.left_on():
                control.report_left(left)
            for word in self._may_be_left_on():
                control.report_left_on(word)
            control.add_event("end", f"M{code}")
            raise ProgramEnd
        else:
            return False
        return True

    def _may_be_left_on(self) -> list[str]:
        """Return the words in force at the end of the program that the control may keep for the next one."""
        return []

    def _report_unused_words(self, block: Block) -> None:
        for letter in block.unused():
            block.used.add(letter)
            self._note(Wording("NC213", "unused_word", word=letter), Severity.ERROR)

    # Motion

    def _move(self, block: Block, axes: dict[str, AxisWord], *, turns: int = 0) -> None:
        """Execute the motion in force, a line or a circle."""
        control = self.control
        control.motion = MOTIONS[self.motion_code]
        circle_words: dict[str, float] = {}
        if control.motion > LINEAR:
            circle_words = {letter: value for letter in "IJKR" if (value := block.take(letter)) is not None}
            if "R" not in circle_words:
                control.relied_from.setdefault(CENTRES, control.row)
        control.move(axes, None, circle=control.circle(circle_words, turns), feed_written=self._check_feed(block))
        if control.motion > LINEAR and self._form.is_so(*_LINE_BEHIND_CIRCLES):
            self.motion_code, control.motion = 10, LINEAR

    def _check_feed(self, block: Block) -> bool:
        """Report a motion without a feed; returns whether the block has an F word."""
        control, written = self.control, "F" in block.words
        if control.motion != RAPID:
            feed = control.programmed_feed
            if math.isnan(feed) or feed <= 0.0 or (self._inverse_time and not written):
                variant = "line_without_feed" if control.motion == LINEAR else "circle_without_feed"
                self._note(Wording("NC240", variant), Severity.ERROR)
        return written
