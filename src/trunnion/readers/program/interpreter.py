"""The part of interpreters that all families share: lines, scans, subprograms and comments.

A program is read in chunks of its file, and plain motion blocks are executed by the scan kernels. The whole text is
loaded as soon as a jump, a loop or a subprogram needs it.
"""

import re
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, Generic, TypeVar

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem, Severity
from trunnion.files import WriteProgress
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Comment, Diagnostic, Run
from trunnion.readers.control.row_recorder import ScannedRows
from trunnion.readers.control.virtual_control import VirtualControl
from trunnion.readers.program.error_tally import ErrorTally
from trunnion.readers.program.forms import form_of
from trunnion.readers.program.known_words import KnownWords, WordsBesideError
from trunnion.readers.program.limits import (
    CHARACTERS_PER_STEP,
    MAX_CALL_DEPTH,
    MAX_DIAGNOSTICS,
    MAX_SUBPROGRAMS,
    MOST_JUMPS_WITHOUT_CHOICE,
    SCANNED_BLOCKS_PER_STEP,
    StepCounter,
)
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.plain_lines import PlainLines
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.program.stated_words import stated_words
from trunnion.readers.program.subprograms import Subprograms
from trunnion.readers.program.unreached import UnreachedBlocks
from trunnion.readers.scan.buffers import ScanSettings
from trunnion.records import dataclass

#: Rows that are reserved before a scan if fewer than ``_MIN_FREE_ROWS`` are free.
_RESERVED_ROWS: Final = 65536
_MIN_FREE_ROWS: Final = 4096


#: A scan of fewer blocks takes longer than their interpretation; then so many lines are interpreted.
_FEW_BLOCKS: Final = 4
_LINES_WITHOUT_SCAN: Final = 16


#: Words that only a program has: it begins or ends.
_PROGRAM_WORDS: Final = re.compile(
    rb"^[ \t]*(?:[O:][ \t]*[0-9]|%[ \t]*[A-Z0-9]|PROC[ \t])|^[^(;\n]*?(?<![A-Z])M[ \t]*0*(?:2|30|17|99)(?![0-9])",
    re.IGNORECASE | re.MULTILINE,
)

#: A line that has more than an end of the program: a second end alone takes nothing away.
_NO_MERE_END: Final = re.compile(
    rb"^(?![ \t]*(?:N[ \t]*[0-9]+)?[ \t]*(?:M[ \t]*0*(?:2|30)|%)?[ \t]*(?:[(;].*)?\r?$).", re.IGNORECASE | re.MULTILINE
)


class ProgramEnd(Exception):  # noqa: N818 - the end of a program is no error
    """The program has ended."""


@dataclass(slots=True)
class ActiveProgram:
    """A program or subprogram that is being executed; ``file`` as in ``Run.file``."""

    source: SourceText
    file: int
    repeats: int = 1


A = TypeVar("A", bound=ActiveProgram)


class Interpreter(ABC, Generic[A]):
    """Runs one program on one machine; ``run`` may be called once.

    control   executes what the blocks program
    """

    #: The class of the texts of this language, which find the targets of its jumps.
    source_type: type[SourceText] = SourceText

    #: Endings of the names of subprograms, see ``Subprograms``, and what the control may write before a name.
    suffixes: tuple[str, ...] = ()
    prefix = ""

    #: Words with which blocks of this language run in another order than they stand in.
    jump_words: re.Pattern[bytes] = re.compile(rb"(?!)")

    #: How this language writes comments, what is around its texts, and the letter of program numbers.
    comment_signs = ("(", ")")
    text_sign = ""
    program_letter = ""

    #: Whether words stand in any order in a block, so that a declared one may stand among others.
    has_words_beside = True

    control: VirtualControl

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        slides = {machine.axes[column].name for column in machine.linear}
        if slides != {"X", "Y", "Z"}:
            raise InputError(Problem(machine.key, 0, Wording("NC121", "other_axes", axes=tuple(sorted(slides)))))
        self._path = path
        self._machine = machine
        self._options = options
        self._subprograms = Subprograms(options.subprograms, self.suffixes, self.prefix)
        self._counter = StepCounter(options.step_limit, self._open_sources, self._limit_error, self._positions_from)
        self._diagnostics: list[Diagnostic] = []
        self._unlisted = 0
        self._errors = ErrorTally()
        self._comments: list[Comment] = []
        self._sources: dict[Path, tuple[SourceText, int]] = {}
        self._files = [str(path)]
        self._stack: list[A] = []
        self._lines_without_scan = 0
        self._raw = ""
        self._form = form_of(machine)
        self._lines = PlainLines(self._form, self.comment_signs, self.text_sign, self.program_letter)
        self._unreached = UnreachedBlocks(self.jump_words, self._has_plain_words)
        self.control = self._make_control()
        self.control.start_with(self._form.start)
        self._known = KnownWords(machine, self.control, self._takes_positions, among_others=self.has_words_beside)

    @abstractmethod
    def _make_control(self) -> VirtualControl:
        """Return the virtual control."""

    @abstractmethod
    def _main_program(self, source: SourceText) -> A:
        """Return the program itself as an active one."""

    @abstractmethod
    def _execute_line(self, active: A, line: int, raw: str) -> None:
        """Execute a line."""

    @abstractmethod
    def _may_scan(self, source: SourceText) -> bool:
        """Whether the next line may be a plain block, so that a scan is worth starting."""

    @abstractmethod
    def _read_blocks(self, source: SourceText, limit: int) -> tuple[int, int]:
        """Read up to ``limit`` plain blocks to ``control.words``; returns their number, and the byte after them."""

    def _scan_settings(self) -> ScanSettings:
        return self.control.scan_settings()

    def _check_scanned(self, scanned: ScannedRows) -> None:
        """Report what is wrong with rows that a scan added."""

    def run(self, write_progress: WriteProgress | None = None) -> Run:
        """Execute the program; ``write_progress`` is that of its file if it is still being written."""
        main = self._text_of(self._path)
        if write_progress is not None:
            main.follow(write_progress)
        try:
            self._stack.append(self._main_program(main))
            self._execute()
        except ProgramEnd:
            if len(self._stack) <= 1:
                self._check_rest(main)
            else:
                self._check_behind_end(self._stack[0])
        finally:
            main.close()
            for source, _ in self._sources.values():
                source.close()
        self.control.end_contour()
        self.control.resolve_rows()
        diagnostics = [*self._diagnostics, *self._ends_of_dos(main)]
        if self._unlisted:
            more = Wording("NC150", "more", count=self._unlisted)
            diagnostics.append(Diagnostic(0, more, Severity.ERROR, self._files[0]))
        run = self.control.finish(self._files, self._comments, diagnostics)
        return replace(run, stated=stated_words(self._known.met, diagnostics, self._machine))

    def _ends_of_dos(self, main: SourceText) -> Iterator[Diagnostic]:
        """Yield a warning for each file that Ctrl-Z ends."""
        for source in (main, *(source for source, _ in self._sources.values())):
            if source.ctrl_z:
                wording = Wording("NC169", "ends_with_ctrl_z")
                yield Diagnostic(source.ctrl_z, wording, Severity.WARNING, str(source.path))

    def _check_rest(self, main: SourceText) -> None:
        """Report text behind the end of the main program that no jump and no call can reach."""
        first = main.line
        while not main.whole and main.fill():
            self.control.line = main.line
            if self._has_plain_words(main.next_line()):
                main.load()
                if main.search(self.jump_words):
                    return
                # A program that ended too early has an end behind its end, and a second one a beginning.
                is_program = bool(main.search(_PROGRAM_WORDS, first) and main.search(_NO_MERE_END, first))
                variant = "another_program" if is_program else "behind_end"
                self._note(Wording("NC161", variant), Severity.ERROR if is_program else Severity.WARNING)
                return

    @abstractmethod
    def _has_words(self, raw: str) -> bool:
        """Whether a line has anything but comments, marks of the transfer and its number."""

    def _has_plain_words(self, raw: str) -> bool:
        return self._has_words(self._lines.plain(raw))

    def _note(self, wording: Wording, severity: Severity) -> None:
        file = self._files[self.control.modal.file.current]
        if severity is Severity.ERROR:
            self._errors.add(file, self.control.line, wording)
        if len(self._diagnostics) >= MAX_DIAGNOSTICS:
            self._unlisted += 1
            return
        self._diagnostics.append(Diagnostic(self.control.line, wording, severity, file))

    # The loop

    def _execute(self) -> None:
        control = self.control
        while self._stack:
            active = self._stack[-1]
            source = active.source
            if (
                control.modal.file.current != active.file
            ):  # only now: the block that called is of its own file to its end
                control.modal.file.set(control.row, active.file)
            if not source.fill():
                self._end_of_source()
                continue
            if self._lines_without_scan:
                self._lines_without_scan -= 1
            elif not (control.preconditions or control.awaits_element) and self._may_scan(source):
                self._lines_without_scan = _LINES_WITHOUT_SCAN if self._scan(source) < _FEW_BLOCKS else 0
                if not source.fill():
                    continue
            line = source.line
            control.line, control.block_number = line, -1
            self._raw = raw = self._lines.plain(source.next_line())
            self._counter.count_blocks(1, len(raw))
            self._execute_known(active, line, raw) if self._known.any else self._execute_line(active, line, raw)
            if source.jumps_back > MOST_JUMPS_WITHOUT_CHOICE:
                raise self._limit_error(Wording("NC140", "jumps_without_choice"))
            self._counter.count_events(control.events)
            self._counter.check_resolutions(control.resolutions)
            self._counter.check_turns(control.turns)

    def _execute_known(self, active: A, line: int, raw: str) -> None:
        """Execute a line with the words that the definition declares."""
        try:
            rest, words = self._known.take(raw)
        except WordsBesideError as error:
            self._note(error.wording.within("reason_not_executed"), Severity.ERROR)
            return
        self._known.execute(words, before_motion=True)
        if rest is not None:
            self._execute_line(active, line, rest)
        self._known.execute(words, before_motion=False)

    def _takes_positions(self, codes: Sequence[str]) -> bool:
        """Whether one of the G and M codes and names of a block takes the positions in it."""
        return bool(codes)

    def _scan(self, source: SourceText) -> int:
        """Execute plain blocks, as many as follow each other; returns how many."""
        control, begin = self.control, source.line
        while source.fill():
            self._reserve_rows(source)
            limit = control.scan_limit()
            count, position = self._read_blocks(source, limit)
            plain = control.find_circles(count)
            if plain < count:
                count, position = plain, int(control.words.begin[plain])
            if count:
                control.line = source.line
                scanned = control.execute_scanned(count, self._scan_settings())
                self._check_scanned(scanned)
                self._record_scanned_comments(source, scanned.comments)
            size = position - source.position
            source.position, source.line = position, source.line + count
            control.line = source.line
            self._counter.count_blocks(-(-count // SCANNED_BLOCKS_PER_STEP), size - CHARACTERS_PER_STEP * count)
            if count < limit and position < len(source.buffer):
                break
        return source.line - begin

    def _reserve_rows(self, source: SourceText) -> None:
        columns = self.control.columns
        if columns.capacity - columns.n < _MIN_FREE_ROWS:
            # After the first rows, a little more than the program will have if it continues as it began.
            begun = columns.n > _RESERVED_ROWS // 2
            columns.reserve(_RESERVED_ROWS, int(1.02 * source.expected_rows(columns.n)) if begun else 0)

    # Comments

    def _record_scanned_comments(self, source: SourceText, comments: Ints) -> None:
        file = self.control.modal.file.current
        self._counter.count_records(len(comments), int((comments[:, 3] - comments[:, 2]).sum()))
        for line, row, start, end in comments.tolist():
            text = source.text_of(source.buffer[start:end].tobytes()).strip("\r")
            self._comments.append(Comment(line, row, text, file))

    def _record_comment(self, line: int, comment: str | None) -> None:
        if comment is not None:
            self._counter.count_records(1, len(comment))
            file = self.control.modal.file.current
            self._comments.append(Comment(line, self.control.row, comment.rstrip("\r"), file))

    # Limits

    def _positions_from(self, row: int) -> Floats:
        """X, Y, Z and the rotary words of the rows from one on, with the present work offset and tool, (n, 7)."""
        columns, modal = self.control.columns, self.control.modal
        rows = slice(row, columns.n)
        present = np.broadcast_to([modal.work_offset.current, modal.tool.current], (columns.n - row, 2))
        return np.hstack([columns.xyz[rows], columns.rotary[rows], present])

    def _open_sources(self) -> list[SourceText]:
        return [self._stack[0].source, *(source for source, _ in self._sources.values())]

    def _limit_error(self, wording: Wording) -> InputError:
        return InputError(Problem(self._files[self.control.modal.file.current], self.control.line, wording))

    def _check_depth(self) -> None:
        if len(self._stack) >= MAX_CALL_DEPTH:
            raise self._limit_error(Wording("NC141", "subprograms_too_deep", most=MAX_CALL_DEPTH))

    # Subprograms

    def _text_of(self, path: Path) -> SourceText:
        """Return the text of a program at its first line."""
        return self.source_type(path, encoding=self._options.encoding or "")

    def _open_subprogram(self, path: Path) -> tuple[SourceText, int]:
        """Return the text of a subprogram at its first line, and its index in ``Run.files``."""
        if path not in self._sources:
            if len(self._sources) >= MAX_SUBPROGRAMS:
                raise self._limit_error(Wording("NC140", "too_many_subprograms", most=MAX_SUBPROGRAMS))
            self._files.append(str(path))
            self._sources[path] = self._text_of(path), len(self._files) - 1
            source, file = self._sources[path]
        else:
            # A file may be active more than once: each time with a position of its own.
            source, file = self._sources[path][0].restarted(), self._sources[path][1]
        source.first_row = self.control.row
        return source, file

    def _lines_of(self, active: A) -> tuple[int, int | None]:
        """Return the first line of a program in its file, and the line behind its last; None: the end of the file."""
        return 1, None

    def _check_behind_return(self, active: A) -> None:
        """Report blocks of a subprogram behind its return, which is in the present line, that never run."""
        if len(self._stack) > 1:
            self._note_unreached(active, self._raw, "behind_return")

    def _check_behind_end(self, main: A) -> None:
        """Report blocks of the main program that never run, as the end of the program is in a subprogram."""
        if any(active.source.search(self.jump_words) for active in self._stack):
            return
        self.control.modal.file.set(self.control.row, main.file)
        self._note_unreached(main, "", "behind_ending_call")

    def _note_unreached(self, active: A, raw: str, variant: str) -> None:
        here = self.control.line
        line = self._unreached.behind(active.source, raw, *self._lines_of(active))
        if line:
            self.control.line = line
            self._note(Wording("NC161", variant), Severity.ERROR)
            self.control.line = here

    def _end_of_source(self) -> None:
        """End or repeat the active program, whose file has no more blocks."""
        self._leave_program()

    def _leave_program(self) -> None:
        """End or repeat the active program; raises ``ProgramEnd`` at the end of the main program."""
        active = self._stack[-1]
        active.repeats -= 1
        if active.repeats > 0:
            active.source.jump(1)
            self._counter.count_blocks(1)
            return
        self._stack.pop()
        if not self._stack:
            raise ProgramEnd  # ``run`` closes the main program
        if not active.source.whole:
            active.source.close()
        self.control.modal.file.set(self.control.row, self._stack[-1].file)
        self.control.line = self._stack[-1].source.line - 1
