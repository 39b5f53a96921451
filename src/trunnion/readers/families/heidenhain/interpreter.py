"""Interpreter of Klartext programs."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.coordinates import INCH
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.families.heidenhain import program_frame
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.flow import ActiveProgram
from trunnion.readers.families.heidenhain.fn_functions import ASSIGNED, assign
from trunnion.readers.families.heidenhain.lexer import MAX_LENGTH, split_line, words
from trunnion.readers.families.heidenhain.machine_functions import tool_block
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters
from trunnion.readers.families.heidenhain.path_blocks import Block, only, read_block
from trunnion.readers.families.heidenhain.path_interpreter import PathInterpreter
from trunnion.readers.families.heidenhain.plane_blocks import plane_block, tcpm_block
from trunnion.readers.families.heidenhain.scan_kernel import read_blocks
from trunnion.readers.families.heidenhain.settings import variables_of
from trunnion.readers.families.heidenhain.text import KlartextText
from trunnion.readers.families.heidenhain.words import (
    BLOCKS_NOT_SIMULATED,
    M_CALL,
    M_MACHINE,
    M_SECOND_MACHINE,
    PATHS,
)
from trunnion.readers.program.declared_variables import DeclaredVariables
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText

#: Feeds of inch programs count in tenths of an inch.
_TENTH: Final = 0.1 * INCH

#: Beginnings of lines that may be plain blocks, so that a scan is worth starting.
_PLAIN_START = re.compile(rb"[ \t]*(?:[0-9]+[ \t]*)?(?:;|[Ll][Nn]?[ \t])")
_PREFIX_LENGTH: Final = 32

_CYCLE_DEFINITION = re.compile(r"CYCLE?[ \t]*DEF(?![A-Z])")
#: Further lines of an older cycle, which are skipped with its title or not at all.
_LATER_LINE = re.compile(r"CYCLE?[ \t]*DEF[ \t]*[0-9]{1,3}\.(?!0(?![0-9]))[0-9]")
_CYCLE = re.compile(r"[ \t]*(DEF|CALL)(?![A-Z])")
_CORNER = re.compile(r"[ \t]*FORM[ \t]+0\.([12])(?![0-9])[ \t]*[XYZ]?(?=[ \t])")
_COORDINATE = re.compile(r"(I?)([XYZ])[ \t]*([+-]?[ \t]*(?:[0-9]{1,9}[.,]?[0-9]{0,9}|[.,][0-9]{1,9}))")
_KEYWORD = re.compile(r"([A-Z]+)")
_PATH = re.compile(rf"({'|'.join(sorted(PATHS, key=len, reverse=True))})(?=[ \t]|$)")


class HeidenhainInterpreter(PathInterpreter):
    """Runs one Klartext program on one machine."""

    comment_signs = (";", "")
    text_sign = '"'
    has_words_beside = False

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        # The lines so far of a block that continues over several lines, and its first line and number.
        self._block_parts: list[str] = []
        self._block_length = 0
        self._block_start = 0, -1
        self._skips_block = False
        # Whether the last block began with a slash.
        self._has_skip_sign = False
        # The first corner of the stock (BLK FORM 0.1).
        self._stock_corner: dict[str, float] = {}
        # The last block that was split into words: of which program, and its number.
        self._last_block: tuple[ActiveProgram | None, int] = None, -1
        self._handlers: dict[str, Callable[[ActiveProgram, str], None]] = {
            "BEGIN": self._begin_program,
            "END": self._end_program,
            "BLK": self._block_form,
            "TOOL": self._tool,
            "CYCL": self._cycle,
            "CYCLE": self._cycle,
            "CALL": self._call,
            "LBL": self._label,
            "FN": self._fn,
            "PLANE": self._plane,
            "FUNCTION": self._function,
            "CC": self._pole,
            "RND": self._rounding,
            "CHF": self._chamfer,
            "APPR": self._approach,
            "DEP": self._departure,
            "STOP": self._stop,
        }

    def _make_control(self) -> HeidenhainControl:
        return HeidenhainControl(self._machine, self._note, shortest=self._options.shortest)

    def _main_program(self, source: SourceText) -> ActiveProgram:
        assert isinstance(source, KlartextText)
        declared = DeclaredVariables(variables_of(self._machine), self._note)
        self._main = ActiveProgram(source, 0, parameters=Parameters(declared))
        return self._main

    def _may_scan(self, source: SourceText) -> bool:
        if (
            self._block_parts
            or self._definitions.is_open
            or self._m_functions.modal_call
            or self.control.modal.compensation.current
        ):
            return False
        beginning = source.buffer[source.position : source.position + _PREFIX_LENGTH]
        return _PLAIN_START.match(beginning.tobytes()) is not None

    def _read_blocks(self, source: SourceText, limit: int) -> tuple[int, int]:
        control = self.control
        vectors = control.tip_programmed and not control.at_ends
        return read_blocks(source.buffer, source.position, limit, control.letter_table, vectors, control.words)

    # Lines and blocks

    def _execute_line(self, active: ActiveProgram, line: int, raw: str) -> None:
        if len(raw) > MAX_LENGTH:
            self._block_parts.clear()
            self._note(Wording("NC214", "long_line", most=MAX_LENGTH), Severity.ERROR)
            return
        parts = split_line(raw)
        if self._block_parts and parts.number >= 0 and not ASSIGNED.match(parts.statement):
            self._note(Wording("NC210", "block_before_goes_new_begins"), Severity.ERROR)
            self._finish_block(active)
            self.control.line = line
        if not self._block_parts:
            self._block_start, self._block_length = (line, parts.number), 0
            self._skips_block = parts.block_skip and self._options.skips(1)
        continued = bool(self._block_parts)
        within_cycle = not continued and _LATER_LINE.match(parts.statement) is not None
        if (continued and parts.block_skip) or (within_cycle and parts.block_skip is not self._has_skip_sign):
            self._note(Wording("NC210", "skip_within_block"), Severity.ERROR)
        if parts.block_skip and not self._skips_block:
            self.control.add_event("block_skip", 1.0)
        if parts.statement:
            if not continued:
                self._has_skip_sign = parts.block_skip
            self._block_parts.append(parts.statement)
            self._block_length += len(parts.statement)
        elif parts.continues and not self._block_parts:
            self._note(Wording("NC210", "ends_line_without_words_takes"), Severity.ERROR)
        try:
            if not (parts.continues and self._block_parts):
                self._finish_block(active)
            elif self._block_length > MAX_LENGTH:
                self._block_parts.clear()
                self._note(Wording("NC214", "long_block_not_executed", most=MAX_LENGTH), Severity.ERROR)
        finally:
            self._record_comment(line, parts.comment)

    def _finish_block(self, active: ActiveProgram) -> None:
        """Execute the block of the lines so far."""
        statement = " ".join(self._block_parts)
        self._block_parts.clear()
        if not statement or self._skips_block:
            return
        self.control.line, self.control.block_number = self._block_start
        if not statement.startswith("BEGIN"):
            active.has_blocks = True
        try:
            self._statement(active, statement)
        except KlartextError as error:
            self._note(error.wording.within("block_not_understood", text=statement[:80]), Severity.ERROR)

    def _leave_program(self) -> None:
        if self._block_parts:
            # The last line announces a continuation that does not follow.
            self._finish_block(self._stack[-1])
            return
        program_frame.check_end_of_file(self._stack[-1], self._note_at_last_line(self._stack[-1].source))
        if len(self._stack) > 1:
            self._report_doubled_labels(self._stack[-1].source)
        super()._leave_program()

    def _note_at_last_line(self, source: SourceText) -> Note:
        """Return what notes faults at the line that was read last."""

        def note(wording: Wording, severity: Severity) -> None:
            self.control.line = source.line - 1
            self._note(wording, severity)

        return note

    def _check_rest(self, main: SourceText) -> None:
        note = self._note_at_last_line(main)
        program_frame.check_rest(self._main, main, note, self._raw)
        program_frame.check_end_of_file(self._main, note)
        self._report_doubled_labels(self._main.source)

    def _has_words(self, raw: str) -> bool:
        return bool(split_line(raw).statement)

    def _statement(self, active: ActiveProgram, statement: str) -> None:
        path, assigned = _PATH.match(statement), ASSIGNED.match(statement)
        if not _CYCLE_DEFINITION.match(statement):
            self._definitions.end_lines()
        (program, before), self._last_block = self._last_block, (active, self._block_start[1])
        if assigned is not None and program is active and self._block_start[1] < 0 <= before:
            raise KlartextError(Wording("NC210", "line_cycle_whose_cycl_def"))
        if path is not None:
            self._path_block(active, path[0], statement[path.end() :])
            return
        if assigned is not None:
            assign(assigned[1], statement[assigned.end() :], active.parameters)
            return
        match = _KEYWORD.match(statement)
        keyword = "" if match is None else match[0]
        if keyword in self._handlers:
            self._handlers[keyword](active, statement[len(keyword) :])
        elif keyword in BLOCKS_NOT_SIMULATED:
            self._note(
                Wording("NC220", "block_not_simulated", keyword=keyword, does=BLOCKS_NOT_SIMULATED[keyword]),
                Severity.ERROR,
            )
        else:
            self._paraxial_block(active, statement)

    def _block_form(self, active: ActiveProgram, rest: str) -> None:
        """BLK FORM 0.1 and 0.2: opposite corners of the stock. Other forms of stock are not read."""
        which = _CORNER.match(rest)
        for word in words(rest, 0 if which is None else which.end()):
            if word.name == "M" if which is None else word.name not in ("X", "Y", "Z") or word.operand is None:
                raise KlartextError(Wording("NC210", "block_takes_no", block="BLK FORM", word=word.name or word.text))
        if which is None:
            return
        found = _COORDINATE.findall(rest[which.end() :])
        if len({name for _, name, _ in found}) < len(found):
            raise KlartextError(Wording("NC212", "written_twice", word="BLK FORM"))
        low = self._stock_corner if which[1] == "2" else {}
        corner = {
            name: float(re.sub(r"[ \t]", "", number).replace(",", ".")) * self.control.length_unit
            + (low.get(name, 0.0) if incremental else 0.0)
            for incremental, name, number in found
        }
        if which[1] == "1":
            self._stock_corner = corner
        elif corner.keys() == low.keys() == set("XYZ"):
            self.control.add_event("stock", (*(low[name] for name in "XYZ"), *(corner[name] for name in "XYZ")))

    def _begin_program(self, active: ActiveProgram, rest: str) -> None:
        if not rest.split()[:1] == ["PGM"]:
            raise KlartextError(Wording("NC210", "begin_needs_pgm"))
        program_frame.begin(active, rest.split(), self.control.row, self._note)
        unit = rest.split()[-1]
        if unit not in ("MM", "INCH"):
            self._note(Wording("NC160", "begin_pgm_without_mm_inch"), Severity.ERROR)
        self.control.set_units(unit == "INCH", False)
        self.control.feed_unit = _TENTH if unit == "INCH" else 1.0

    def _end_program(self, active: ActiveProgram, rest: str) -> None:
        self._block_parts.clear()
        program_frame.end(active, rest.split(), self._note)
        if len(self._stack) == 1:
            self.control.end_program("END PGM")
        self._check_behind_return(active)
        self._leave_program()

    def _stop(self, active: ActiveProgram, rest: str) -> None:
        block = read_block(words(rest), active.parameters)
        only(block.written, "M", "STOP")
        self._refuse_m_of_positions(block, "STOP")
        self._m_functions.execute_before_motion(block)
        self.control.add_event("stop")
        self._m_functions.execute_after_motion(block)

    @staticmethod
    def _refuse_m_of_positions(block: Block, word: str) -> None:
        """Refuse M91, M92 and M99 in a block without a position of its own."""
        only((f"M{code}" for code, _ in block.m if code in (M_MACHINE, M_SECOND_MACHINE, M_CALL)), (), word)

    # Tools and cycles

    def _tool(self, active: ActiveProgram, rest: str) -> None:
        feed = tool_block(self.control, rest, active.parameters)
        if feed is not None:
            self._tool_feed = feed

    def _cycle(self, active: ActiveProgram, rest: str) -> None:
        match = _CYCLE.match(rest)
        if match is None:
            raise KlartextError(Wording("NC210", "cycl_needs_def_call"))
        rest = rest[match.end() :]
        if match[1] == "DEF":
            self._definitions.define(rest, active.parameters)
            if self._definitions.pattern is not None:
                self._drill_pattern(active, self._definitions.pattern)
        else:
            self._cycle_call(active, rest)

    def _cycle_call(self, active: ActiveProgram, rest: str) -> None:
        control = self.control
        call_words = words(rest)
        first = call_words[0].name if call_words else ""
        if first == "PAT":
            self._note(Wording("NC220", "cycl_call_pat_point_patterns"), Severity.ERROR)
            return
        with_position = first == "POS"
        block = read_block(call_words[1:] if with_position else call_words, active.parameters)
        name = "CYCL CALL POS" if with_position else "CYCL CALL"
        only(block.written, {"F", "M", *(("X", "Y", "Z", "FMAX", "MAX") if with_position else ())}, name)
        self._refuse_m_of_positions(block, name)
        self._m_functions.execute_before_motion(block)
        if block.feed is not None:
            control.programmed_feed = block.feed * control.feed_unit
        if with_position:
            control.motion = LINEAR if block.feed is not None and not block.rapid else RAPID
            control.move(block.axes, None, feed_written=block.feed is not None)
        self._drill(active)
        self._m_functions.execute_after_motion(block)

    # Planes

    def _plane(self, active: ActiveProgram, rest: str) -> None:
        self.control.add_event("plane", rest.strip())
        self.control.judge_within_compensation(" ".join(("PLANE", *rest.split()[:1])))
        plane_block(self.control, words(rest), active.parameters)

    def _function(self, active: ActiveProgram, rest: str) -> None:
        match rest.split():
            case ["TCPM", *_]:
                tcpm_block(self.control, words(rest.replace("TCPM", "", 1)), self._note)
            case ["RESET", "TCPM"]:
                self.control.switch_tcp_by("FUNCTION TCPM", on=False)
                self.control.spatial_angles_active = False
                self.control.set_tcp(False)
            case ["MODE", "MILL"]:
                pass
            case _:
                self._note(Wording("NC220", "function_not_simulated", text=rest[:60]), Severity.ERROR)
