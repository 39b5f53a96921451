"""Programs, line by line: what is common to the interpreters of all families.

A program runs from chunks of its file, plain motion blocks inside the scan kernel of its language. The first jump, loop
or subprogram that needs it makes the whole text be held. Everything that a program could do without end has a limit.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Generic, TypeVar

from trunnion.arrays import Ints
from trunnion.errors import InputError, Problem, Severity
from trunnion.files import WriteProgress
from trunnion.machines import Machine
from trunnion.model.run import Comment, Diagnostic, Run
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.virtual_control import VirtualControl
from trunnion.readers.program.source_text import SourceText, Subprograms, decode
from trunnion.readers.scan.buffers import COMMENTS, LINE, POSITION

#: Blocks a program may execute besides going once through its files.
DEFAULT_STEP_LIMIT: Final = 2_000_000

#: Findings that are kept one by one; the rest is counted.
MAX_DIAGNOSTICS: Final = 10_000

#: So many characters of a block, or of a text that is kept, count as one more: real ones are shorter.
CHARACTERS_PER_STEP: Final = 128

#: Subprograms that one program may call.
MAX_SUBPROGRAMS: Final = 1000

#: Subprograms inside subprograms.
MAX_CALL_DEPTH: Final = 16

#: Rows there is room for when the kernel starts, and fewer than which are too few.
_RESERVED_ROWS: Final = 65536
_MIN_FREE_ROWS: Final = 4096


class ProgramEnd(Exception):  # noqa: N818 - the end of a program is no error
    """The program has ended."""


@dataclass(slots=True)
class ActiveProgram:
    """A program or subprogram being executed; file as in ``Run.file``."""

    source: SourceText
    file: int
    repeats: int = 1


A = TypeVar("A", bound=ActiveProgram)


class Interpreter(ABC, Generic[A]):
    """Runs one program on one machine; ``run`` may be called once."""

    #: How texts of this language find their own places.
    source_type: type[SourceText] = SourceText

    def __init__(self, path: Path, machine: Machine, named: Subprograms, *, step_limit: int, skip: bool) -> None:
        slides = {machine.axes[column].name for column in machine.linear}
        if slides != {"X", "Y", "Z"}:
            what = f"has slides {', '.join(sorted(slides))}"
            raise InputError(Problem(machine.key, 0, what, "this reader needs X, Y and Z"))
        self._path = path
        self._subprograms = named
        self._skip = skip
        self._step_limit = step_limit
        self._steps = 0
        self._record_count = 0
        self._events_counted = 0
        self._findings: list[Diagnostic] = []
        self._unlisted = 0
        self._comments: list[Comment] = []
        self._sources: dict[Path, tuple[SourceText, int]] = {}
        self._file = StepColumnBuilder(0)
        self._files = [str(path)]
        self._stack: list[A] = []

    @property
    @abstractmethod
    def control(self) -> VirtualControl:
        """The virtual control that does what blocks say."""

    @abstractmethod
    def _main_program(self, text: SourceText) -> A:
        """Return the activation of the program itself."""

    @abstractmethod
    def _execute_line(self, active: A, line: int, raw: str) -> None:
        """Execute a line."""

    @abstractmethod
    def _may_scan(self, text: SourceText) -> bool:
        """Whether it is worth starting the kernel at the next line."""

    @abstractmethod
    def _scan_blocks(self, text: SourceText) -> None:
        """Let the kernel take plain blocks."""

    def run(self, write_progress: WriteProgress | None = None) -> Run:
        """Execute the program; ``write_progress`` says how far its file has come if it is still being written."""
        main = self.source_type(self._path)
        if write_progress is not None:
            main.follow(write_progress)
        try:
            self._stack.append(self._main_program(main))
            self._execute()
        except ProgramEnd:
            pass
        finally:
            main.close()
            for text, _ in self._sources.values():
                text.close()
        self.control.resolve_rows()
        diagnostics = list(self._findings)
        if self._unlisted:
            diagnostics.append(Diagnostic(0, f"and {self._unlisted} findings more", Severity.ERROR, self._files[0]))
        return self.control.finish(self._files, self._comments, diagnostics)

    def _note(self, text: str, severity: Severity) -> None:
        if len(self._findings) >= MAX_DIAGNOSTICS:
            self._unlisted += 1
            return
        file = self._files[self._file.current]
        self._findings.append(Diagnostic(self.control.line, text, severity, file))

    # The loop

    def _execute(self) -> None:
        control = self.control
        while self._stack:
            active = self._stack[-1]
            text = active.source
            if not text.fill():
                self._leave_program()
                continue
            if self._may_scan(text):
                self._scan(text)
                if not text.fill():
                    continue
            line = text.line
            control.line, control.block_number = line, -1
            raw = text.next_line()
            self._count_blocks(1 + len(raw) // CHARACTERS_PER_STEP)
            self._execute_line(active, line, raw)
            self._count_events()

    def _scan(self, text: SourceText) -> None:
        """Let the kernel take plain blocks, as many as there are."""
        control = self.control
        columns = control.columns
        while text.fill():
            if columns.capacity - columns.n < _MIN_FREE_ROWS:
                # A little more than there will be if the program goes on as it began, once it is known how it does.
                begun = columns.n > _RESERVED_ROWS // 2
                columns.reserve(_RESERVED_ROWS, int(1.02 * text.expected_rows(columns.n)) if begun else 0)
            control.before_scan(text.position, text.line)
            self._scan_blocks(text)
            control.after_scan()
            self._record_scanned_comments(text, control.scan_records.comments[: control.counters[COMMENTS]])
            line = int(control.counters[LINE])
            taken = line - text.line
            size = int(control.counters[POSITION]) - text.position
            text.position, text.line = int(control.counters[POSITION]), line
            control.line = line
            self._count_blocks(taken + max(size - CHARACTERS_PER_STEP * taken, 0) // CHARACTERS_PER_STEP)
            if text.position < len(text.buffer) and not control.full:
                return

    def _record_scanned_comments(self, text: SourceText, table: Ints) -> None:
        file = self._file.current
        self._count_records(len(table), int((table[:, 3] - table[:, 2]).sum()))
        for line, row, start, end in table.tolist():
            words = decode(text.buffer[start:end].tobytes()).strip("\r")
            self._comments.append(Comment(line, row, words, file))

    def _record_comment(self, line: int, comment: str | None) -> None:
        if comment is not None:
            self._count_records(1, len(comment))
            self._comments.append(Comment(line, self.control.row, comment, self._file.current))

    # Limits

    def _count_blocks(self, blocks: int) -> None:
        """Count executed blocks. Going once through each file is free."""
        self._steps += blocks
        if self._steps <= self._step_limit:
            return
        main = self._stack[0].source
        texts = [text for text, _ in self._sources.values()]
        allowed = self._step_limit + main.known_lines + sum(text.known_lines for text in texts)
        allowed += sum(text.size // CHARACTERS_PER_STEP for text in (main, *texts))
        if self._steps > allowed:
            raise self._limit_error(f"executes more than {self._step_limit} blocks")

    def _count_records(self, texts: int, characters: int) -> None:
        """Count comments and events, which are kept. What each file says once is free."""
        self._record_count += texts + characters // CHARACTERS_PER_STEP
        if self._record_count <= self._step_limit:
            return
        files = (self._stack[0].source, *(text for text, _ in self._sources.values()))
        if self._record_count > self._step_limit + sum(text.size for text in files):
            raise self._limit_error(f"makes more than {self._step_limit} comments and events")

    def _count_events(self) -> None:
        new = self.control.events[self._events_counted :]
        if new:
            self._events_counted += len(new)
            self._count_records(
                len(new), sum(len(event.value) for event in new if isinstance(event.value, str | tuple))
            )

    def _limit_error(self, what: str) -> InputError:
        return self._stack[-1].source.problem(self.control.line, f"the program {what}", "does it end?")

    # Subprograms

    def _check_depth(self) -> None:
        if len(self._stack) >= MAX_CALL_DEPTH:
            raise self._stack[-1].source.problem(
                self.control.line, f"calls subprograms deeper than {MAX_CALL_DEPTH} levels", "does one call itself?"
            )

    def _open_subprogram(self, path: Path) -> tuple[SourceText, int]:
        """Return the text of a subprogram, at its first line, and its place in ``Run.files``; rows are now its own."""
        if path not in self._sources:
            if len(self._sources) >= MAX_SUBPROGRAMS:
                raise self._limit_error(f"calls more than {MAX_SUBPROGRAMS} subprograms")
            self._files.append(str(path))
            self._sources[path] = self.source_type(path), len(self._files) - 1
            text, file = self._sources[path]
        else:
            # The same file may be active more than once: each activation has its own place in it.
            text, file = self._sources[path][0].restarted(), self._sources[path][1]
        text.first_row = self.control.row
        self._file.set(self.control.row, file)
        return text, file

    def _leave_program(self) -> None:
        """End of a subprogram, or of the program."""
        active = self._stack[-1]
        active.repeats -= 1
        if active.repeats > 0:
            active.source.jump(1)
            self._count_blocks(1)
            return
        self._stack.pop()
        if not active.source.whole:
            active.source.close()
        if not self._stack:
            raise ProgramEnd
        self._file.set(self.control.row, self._stack[-1].file)
        self.control.line = self._stack[-1].source.line - 1
