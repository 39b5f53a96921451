"""Programs of the RS274 kind, block by block: what their families have in common."""

import math
import re
from abc import abstractmethod
from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.model.run import ProgrammedWord
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.program import interpreter
from trunnion.readers.program.interpreter import Interpreter, ProgramEnd
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, g_code_text, split_line
from trunnion.readers.rs274.control import CLOCKWISE, COUNTER, Rs274Control
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.scan.buffers import FEEDS, ROW
from trunnion.readers.scan.letter_blocks import scan_blocks

#: G codes, in tenths, and what they set.
MOTIONS: Final = {0: RAPID, 10: LINEAR, 20: CLOCKWISE, 30: COUNTER}
PLANES: Final = {170: 2, 180: 1, 190: 0}
FEED_MODES: Final = {930: 93, 940: 94, 950: 95}

#: Radius compensation: left of the path, right of it, off.
RADIUS_COMPENSATION: Final = {400: 0, 410: 1, 411: 1, 412: 1, 420: -1, 421: -1, 422: -1}
CANCEL: Final = 800

#: M codes that are events as they are: kind and value.
EVENTS: Final = {
    0: ("stop", None),
    1: ("optional_stop", None),
    3: ("spindle", "clockwise"),
    4: ("spindle", "counter-clockwise"),
    5: ("spindle", "off"),
    7: ("coolant", "mist"),
    8: ("coolant", "flood"),
    9: ("coolant", "off"),
    19: ("spindle", "oriented"),
}
SPINDLE: Final = {3: 1, 4: -1, 5: 0}
CHANGE: Final = 6
PROGRAM_ENDS: Final = frozenset({2, 30})

#: Letters of axes; a machine has five of them.
AXES: Final = "XYZABCUVW"

#: Whether a line may be plain: a look at its beginning saves starting the kernel in vain.
_PLAIN_START = re.compile(
    rb"[ \t]*(?:N[0-9]+[ \t]*)?(?:[\r\n]|G[ \t]*0?[01](?![0-9.])|[A-FXYZ][ \t]*[-+.0-9])", re.IGNORECASE
)
_PREFIX_LENGTH: Final = 48


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program or subprogram being executed.

    row        the row at which it began
    percents   lines with a percent sign so far
    """

    row: int = 0
    percents: int = 0


A = TypeVar("A", bound=ActiveProgram)


class Rs274Interpreter(Interpreter[A]):
    """Runs one program of this kind; families say what their blocks mean.

    ``motion`` is the G code in tenths that blocks without one of their own carry on, -1 for none.
    """

    #: Whether a semicolon begins a comment.
    semicolon = False

    motion = 0

    @property
    @abstractmethod
    def control(self) -> Rs274Control:
        """The virtual control."""

    @abstractmethod
    def _execute_block(self, active: A, line: int, text: str) -> None:
        """Execute a block without its comments; BlockError says why it cannot be done."""

    # Lines

    def _execute_line(self, active: A, line: int, raw: str) -> None:
        try:
            parts = split_line(raw, semicolon=self.semicolon)
        except BlockError as error:
            self._note(f"not understood: {error}: the block is not executed", Severity.ERROR)
            return
        self.control.block_number = parts.number
        try:
            if parts.text.startswith("%"):
                self._percent(active)
            elif parts.text and not (parts.block_skip and self._skip):
                self._execute_block(active, line, parts.text)
        except BlockError as error:
            self._note(f"not understood: {error}: the block is not executed", Severity.ERROR)
        finally:
            for comment in parts.comments:
                self._record_comment(line, comment)
                self._handle_comment(comment)

    def _handle_comment(self, comment: str) -> None:
        """Look at what a comment says, where that is more than a comment."""

    def _percent(self, active: A) -> None:
        """Begin or end what is transferred."""
        active.percents += 1
        if active.percents > 1 or self.control.row > active.row:
            self._end_of_file(active)

    def _end_of_file(self, active: A) -> None:
        """End at a percent sign."""
        raise ProgramEnd

    # Plain blocks

    def _may_scan(self, text: SourceText) -> bool:
        control = self.control
        if self.motion not in (0, 10) or not control.absolute:
            return False
        return _PLAIN_START.match(text.buffer[text.position : text.position + _PREFIX_LENGTH].tobytes()) is not None

    @property
    @abstractmethod
    def _table(self) -> Codes:
        """What bytes mean to the kernel now."""

    def _scan_blocks(self, text: SourceText) -> None:
        control = self.control
        first = control.columns.n
        inverse = control.feed_mode.current == 93
        before = float(control.commanded[3])
        control.kind = MOTIONS[self.motion]
        scan_blocks(
            text.buffer,
            len(text.buffer),
            self._table,
            False,
            control.length_unit,
            1.0 if inverse else control.feed_unit,
            control.default_turn_rules,
            control.position_map,
            control.vector_map,
            control.counters,
            control.commanded,
            control.scan_target(),
            control.scan_records,
        )
        self.motion = 10 * control.kind
        self._check_feeds(first, before, inverse)

    def _check_feeds(self, first: int, before: float, inverse: bool) -> None:
        """Say where the kernel made lines without a feed."""
        control = self.control
        c, target = control.columns, control.scan_target()
        rows = slice(first, int(control.counters[ROW]))
        lines = target.kind[rows] != 0
        if inverse:
            lines &= (target.programmed[rows] & int(ProgrammedWord.FEED)) == 0
            missing = np.flatnonzero(lines) + first
        else:
            noted = int(control.counters[FEEDS])
            feeds = np.append(before, control.scan_records.feed_values[:noted])
            if (feeds > 0.0).all():
                return
            begins = np.append(first, control.scan_records.feed_rows[:noted])
            held = feeds[np.searchsorted(begins, np.arange(rows.start, rows.stop), "right") - 1]
            missing = np.flatnonzero(lines & ~(held > 0.0)) + first
        here = control.line
        for row in missing.tolist():
            control.line = int(c.line[row - c.base])
            self._note("a line without a feed", Severity.ERROR)
        control.line = here

    # Words

    def _report_repeated_word(self, letter: str) -> None:
        self._note(f"{letter} is written twice: the last one counts", Severity.ERROR)

    def _modal_g_code(self, code: int) -> bool:
        """Carry out a G code that all of them have; False if it is another one."""
        control = self.control
        if code in MOTIONS:
            self.motion = code
        elif code in PLANES:
            control.plane_axis = PLANES[code]
        elif code in (200, 210):
            control.set_units(code == 200, True)
        elif code in (900, 910):
            control.absolute = code == 900
        elif code in FEED_MODES:
            control.feed_mode.set(control.row, FEED_MODES[code])
        else:
            return False
        return True

    def _report_g_code(self, code: int, named: dict[int, tuple[str, bool]], silent: frozenset[int]) -> None:
        """Say that a G code is known and not simulated, or not known."""
        if code in RADIUS_COMPENSATION:
            self.control.compensation.set(self.control.row, RADIUS_COMPENSATION[code])
        if code in named:
            text, grave = named[code]
            self._note(f"{g_code_text(code)}: {text}", Severity.ERROR if grave else Severity.WARNING)
        elif code not in silent:
            self._note(f"unknown word {g_code_text(code)}", Severity.ERROR)

    def _axis_words(self, block: Block) -> dict[str, AxisWord]:
        """Words of the machine's axes; those of others are findings."""
        axes: dict[str, AxisWord] = {}
        for letter in AXES:
            value = block.take(letter)
            if value is None:
                continue
            if letter in "XYZ" or letter in self.control.rotary_names:
                axes[letter] = value, PositionMode.MODAL
            else:
                self._note(f"{letter}: the machine has no such axis", Severity.ERROR)
        return axes

    def _feed_and_speed(self, block: Block) -> None:
        control = self.control
        feed = block.take("F")
        if feed is not None:
            if feed < 0.0:
                raise BlockError("a feed below zero")
            control.commanded[3] = feed if control.feed_mode.current == 93 else feed * control.feed_unit
        speed = block.take("S")
        if speed is not None:
            control.rpm.set(control.row, abs(speed))
            control.add_event("speed", abs(speed))

    def _move(self, block: Block, axes: dict[str, AxisWord], *, turns: int = 0, machine_frame: bool = False) -> None:
        """Make the motion in force: a line or a circle."""
        control = self.control
        control.kind = MOTIONS[self.motion]
        params: dict[str, float] = {}
        if control.kind > LINEAR:
            params = {letter: value for letter in "IJKR" if (value := block.take(letter)) is not None}
        written = "F" in block.words
        self._check_feed(written)
        control.move(
            axes, None, circle=control.circle(params, turns), machine_frame=machine_frame, feed_written=written
        )

    def _check_feed(self, written: bool) -> None:
        control = self.control
        if control.kind == RAPID:
            return
        feed = float(control.commanded[3])
        missing = math.isnan(feed) or feed <= 0.0 or (control.feed_mode.current == 93 and not written)
        if missing:
            self._note("a line without a feed" if control.kind == LINEAR else "a circle without a feed", Severity.ERROR)

    def _common_m_code(self, code: int) -> bool:
        """Carry out an M code that all of them have; False if it is another one."""
        control = self.control
        if code in SPINDLE:
            control.spindle.set(control.row, SPINDLE[code])
        if code in EVENTS:
            control.add_event(*EVENTS[code])
        elif code == CHANGE:
            control.change_tool()
        elif code in PROGRAM_ENDS:
            control.add_event("end", f"M{code}")
            raise ProgramEnd
        else:
            return False
        return True

    def _report_unused_words(self, block: Block) -> None:
        """Say which words had no use."""
        for letter in block.unused():
            self._note(f"{letter} has no use in this block", Severity.ERROR)
