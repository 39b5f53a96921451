"""The interpreter of a CL file: statements one after the other become operations, and the file's length unit.

The meaning of each statement is in ``trunnion.cl.statements``; which words have it, in ``trunnion.cl.dialects``.
"""

import re
from dataclasses import replace

from trunnion.cl.builder import MoveColumns, OperationBuilder
from trunnion.cl.diagnostics import Diagnostics, StatementError
from trunnion.cl.dialect import Dialect, Handler
from trunnion.cl.glued_statements import GluedStatements
from trunnion.cl.scan import COMMENT, MAKES_ROW
from trunnion.cl.state import COORDINATE_SYSTEM, MM_PER_INCH, ReaderState
from trunnion.cl.statement import Statement, comments_of
from trunnion.cl.statements.cutcom_points import CutcomPoints
from trunnion.cl.statements.operations import LENGTH_UNITS
from trunnion.cl.word_classes import acts_on_machine, drives_tool, words_that_count
from trunnion.messages import Wording, phrase
from trunnion.model.clamping import Clamping
from trunnion.model.clamping_notices import may_be_notice, read_place
from trunnion.model.toolpath import Frame

#: Statements no longer than this are likely to come again, and their parsed form is kept; at most so many.
_CACHED_STATEMENT_BYTES = 64
_CACHE_SIZE = 4096

#: Comments on the clamping of the part that are kept.
_MOST_NOTICES = 100

#: A file that begins with more unknown statements, and no known one, is no CL file.
_MAX_UNKNOWN_STATEMENTS = 1000


#: What blocks of NC programs begin with.
_BLOCK_NUMBER = re.compile(r"/?N\d")


#: Coordinate systems that turn and shift nothing: nine numbers, three more for the origin, or rows of four.
_NO_SYSTEMS = (
    (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0),
)

#: What stands for a word that is none.
_NUMBER = re.compile(r"[-+.]?[0-9]")


class ClInterpreter:
    """Interprets the statements of one file."""

    def __init__(
        self, columns: MoveColumns, diagnostics: Diagnostics, dialect: Dialect, encoding: str, *, strict: bool
    ) -> None:
        self._state = ReaderState(columns, diagnostics, dialect, strict or dialect.is_strict)
        self._dialect = dialect
        self._diagnostics = diagnostics
        self._encoding = encoding
        self._words = words_that_count(dialect)
        self._glued = GluedStatements(dialect) if dialect.text.has_words else None
        self._is_behind_comment = False
        self._known_statements = 0
        self._unknown_statements = 0
        self._parse_cache: dict[bytes, tuple[Handler | None, Statement]] = {}
        self._notices: list[tuple[int, str]] = []

    def take_points_for(self, what: str | None) -> None:
        """Say what points under CUTCOM are where the file does not: a value of the setting ``cutcom``, or None."""
        self._state.own(CutcomPoints).asked = what

    @property
    def builders(self) -> list[OperationBuilder]:
        """The operations read so far."""
        return self._state.builders

    @property
    def part(self) -> str:
        """Name of the part."""
        return self._state.part

    @property
    def system(self) -> tuple[float, ...]:
        """The coordinate system of the points in that of the model as the file has it; empty if it has none."""
        return self._state.system

    def stock(self, unit: float) -> str:
        """Return the stock as ``--stock`` takes it, mm; empty if the file gives none.

        unit  of the file, mm
        """
        if self._state.stock is None:
            return ""
        kind, sizes = self._state.stock
        texts = (f"{size * unit:.9f}".rstrip("0").rstrip(".") for size in sizes)
        return f"{kind.lower()}:{','.join(texts)}"

    @property
    def states_system(self) -> bool:
        """Whether each operation with motion states by an MSYS where its points are in the absolute system."""
        moving = [builder for builder in self.builders if builder.stop > builder.first]
        return self._dialect.in_sections and all(COORDINATE_SYSTEM in builder.stated for builder in moving)

    def interpret(self, raw: bytes, line: int, row: int, mark: int) -> None:
        """Interpret one statement.

        raw   bytes of the statement, with its continuation lines
        line  its line
        row   row of the columns before which it stands; its own row if ``mark`` has ``MAKES_ROW``
        mark  marks of ``trunnion.cl.scan``
        """
        self._state.line = line
        self._state.row = row
        self._state.has_row = mark & MAKES_ROW != 0
        try:
            if mark & COMMENT:
                comment = raw[2:].decode(self._encoding, "replace").rstrip()
                if self._glued is not None:
                    self._glued.refuse_in_comment(comment)
                if not row and len(self._notices) < _MOST_NOTICES and may_be_notice(comment):
                    self._notices.append((line, comment))
                self._is_behind_comment = True
                if self._dialect.comment is not None:
                    self._dialect.comment(self._state, comment)
                return
            if self._is_behind_comment:
                self._is_behind_comment = False
                if self._dialect.after_comment is not None:
                    self._dialect.after_comment(self._state)
            handler, statement = self._parse_cache.get(raw) or self._look_up(raw)
            if handler is None:
                self._unknown_statement(statement)
            else:
                handler(self._state, statement)
                self._known_statements += 1
        except StatementError as error:
            self._diagnostics.error(line, error.wording)

    def finish(self, row: int, complete: bool, lines: int) -> None:
        """Close the last operation, and report a file that is cut off or has no motion.

        row       number of rows in the file
        complete  whether the last line has a line end
        lines     number of the last line
        """
        state = self._state
        state.row = row
        if self._dialect.after_comment is not None:
            self._dialect.after_comment(state)
        if state.direction is not None:
            state.direction.report_lost_arc(self._diagnostics)
        if self._dialect.has_end and row > max(state.end_row, 0) and not state.in_operation:
            self._report_cut_off(complete, lines)
        if not self._dialect.in_sections:
            if row > state.builder.first:
                state.close_operation()
        elif state.in_operation:
            builder = state.builder
            self._diagnostics.error(
                builder.line if complete else lines,
                Wording("CL130", "operation_no_end", builder=builder.name, lines=lines)
                if not complete
                else Wording("CL130", "operation_no_end_path", builder=builder.name),
            )
            state.close_operation()
        elif row > state.builder.first:
            state.report_motion_outside()
        if self._dialect.in_sections:
            self._report_lost_systems()
        if not self._known_statements and not row:
            raise self._diagnostics.nothing_known(Wording("CL110", "not_cl_file"))
        if not row and not self._diagnostics.has_errors:
            self._diagnostics.error(0, Wording("CL140", "no_motion_file"))
        if state.builders and state.builder.events:
            # What follows the last operation is done after its last row.
            last = state.builders[-1]
            last.events.extend(replace(event, row=last.stop - last.first) for event in state.builder.events)

    def clamping(self) -> Clamping | None:
        """How comments before the first point say that the part is clamped; those that are damaged are reported."""
        found = read_place(self._notices)
        for line, what in found.faults:
            self._diagnostics.remark(line, Wording("PLC250", "damaged_in_cl", fault=what))
        return found.clamping

    def _report_lost_systems(self) -> None:
        """Report operations without MSYS among others that have one: their points would move by as much as it says."""
        builders = [builder for builder in self._state.builders if builder.stop > builder.first]
        stating = [builder for builder in builders if COORDINATE_SYSTEM in builder.stated]
        if all(builder.frame == Frame() for builder in stating):
            return
        for builder in builders:
            if COORDINATE_SYSTEM not in builder.stated:
                self._diagnostics.error(
                    builder.line, Wording("CL430", "operation_no_msys", builder=builder.name, stating=stating[0].name)
                )

    def _report_cut_off(self, complete: bool, lines: int) -> None:
        end = self._dialect.end
        self._diagnostics.error(
            lines,
            Wording("CL130", "file_no_behind", end=end)
            if complete
            else Wording("CL130", "file_no_behind_last", end=end, lines=lines),
        )

    def knows_unit(self, given: str | None) -> bool:
        """Whether the user, UNITS or the feeds say the length unit of the file."""
        state = self._state
        return bool(given or state.length_unit or state.first_mm_feed or state.first_inch_feed)

    def unit(self, given: str | None) -> float:
        """Return the length unit of the file in mm: ``given`` by the user, else as UNITS or else the feeds say."""
        if given is not None:
            unit, stated = LENGTH_UNITS[given.upper()], self._state.length_unit
            if stated is not None and stated[0] != unit:
                self._diagnostics.remark(stated[1], Wording("CL420", "file_states_another", given=given.lower()))
            return unit
        if self._state.length_unit is not None:
            return self._state.length_unit[0]
        mm, inch = self._state.first_mm_feed, self._state.first_inch_feed
        if mm and inch:
            self._diagnostics.error(max(mm, inch), Wording("CL410", "feeds_mm_line", mm=mm, inch=inch))
        if inch and not mm:
            self._diagnostics.remark(inch, Wording("CL420", "all_feeds_inches"))
            return MM_PER_INCH
        return 1.0

    def _look_up(self, raw: bytes) -> tuple[Handler | None, Statement]:
        statement = self._dialect.text.parse(raw, self._encoding)
        if self._glued is not None:
            has_comments = not statement.text and b"$$" in raw
            self._glued.refuse(statement, comments_of(raw.decode(self._encoding, "replace")) if has_comments else ())
        entry = self._dialect.handlers.get(statement.major), statement
        if len(raw) <= _CACHED_STATEMENT_BYTES and len(self._parse_cache) < _CACHE_SIZE:
            self._parse_cache[raw] = entry
        return entry

    def _unknown_statement(self, statement: Statement) -> None:
        if not statement.source:
            return  # the end mark of a DOS file
        self._unknown_statements += 1
        if self._unknown_statements > _MAX_UNKNOWN_STATEMENTS and self._known_statements == 0 and self._state.row == 0:
            raise self._diagnostics.nothing_known(Wording("CL110", "not_cl_file"))
        if self._glued is None:
            self._state.note_unknown(statement, phrase("not_known", statement=statement.major))
            return
        found = acts_on_machine(statement.major, self._words)
        meant = found.meant if found else ()
        if statement.major.startswith("->") and found is None and not self._state.strict:
            self._diagnostics.remark(self._state.line, Wording("CL220", "comment_all_but", major=statement.major[:40]))
            return
        _refuse_no_word(statement)
        if drives_tool(statement.major):
            self._state.direction = None
            raise StatementError(Wording("CL250", "motion_cannot_read", major=statement.major))
        if found is None and self._dialect.alias is not None and _is_system(statement, 12) and not self._state.strict:
            self._dialect.alias(self._state, statement)
            return
        may_be_system = found is None and _is_system(statement, 9, 12) and statement.values not in _NO_SYSTEMS
        if may_be_system:
            what = phrase("may_be_system", statement=statement.major)
        elif found is not None and found.damaged:
            what = phrase("may_be_damaged", statement=statement.major, word=found.damaged)
        else:
            what = phrase("not_known", statement=statement.major)
        self._state.note_unknown(statement, what, acts=found is not None or may_be_system, meant=meant)


def _is_system(statement: Statement, *counts: int) -> bool:
    """Whether a statement has the numbers of a coordinate system, and nothing else."""
    return len(statement.values) in counts and not statement.words()


def _refuse_no_word(statement: Statement) -> None:
    """Refuse a statement without a word: it may be a motion."""
    name = statement.major
    if _BLOCK_NUMBER.match(name):
        raise StatementError(Wording("CL110", "begins_block_number", name=name[:20]))
    if name.startswith("#"):
        raise StatementError(Wording("CL110", "begins_variable", name=name.partition("=")[0][:20]))
    if "=" in name:
        raise StatementError(Wording("CL120", "defined_here_apt", name=name.partition("=")[0]))
    if name.startswith("IF("):
        raise StatementError(Wording("CL120", "if_statement_apt"))
    if name.isdigit() and "/" in statement.source:
        raise StatementError(Wording("CL120", "word_number_numbers", name=name))
    if not name or _NUMBER.match(name):
        raise StatementError(Wording("CL160", "numbers_without_word"))
