"""Control flow of a LinuxCNC program: its O words."""

import re
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import field
from pathlib import Path
from typing import NamedTuple

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.families.linuxcnc.control import LinuxcncControl
from trunnion.readers.families.linuxcnc.parameters import ARITHMETIC, LOCAL_COUNT, Parameters
from trunnion.readers.families.linuxcnc.text import SUFFIXES, LinuxcncText, Structure
from trunnion.readers.program.declared_variables import DeclaredVariables
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.rs274 import interpreter
from trunnion.readers.rs274.block import block_reader, split_line
from trunnion.readers.rs274.expressions import BlockError, ExpressionReader
from trunnion.readers.rs274.word_interpreter import WordInterpreter
from trunnion.records import dataclass

_KEYWORD = re.compile(r"SUB|ENDSUB|IF|ELSEIF|ELSE|ENDIF|WHILE|ENDWHILE|DO|REPEAT|ENDREPEAT|BREAK|CONTINUE|CALL|RETURN")


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program or subprogram that is being executed.

    counters   remaining repeats of REPEAT loops, by their line
    """

    source: LinuxcncText
    counters: dict[int, int] = field(default_factory=dict)


class OWord(NamedTuple):
    """An O word, and the reader of the text after its keyword."""

    active: ActiveProgram
    line: int
    label: str
    reader: ExpressionReader

    @property
    def structure(self) -> Structure:
        """The control structure that the O word belongs to."""
        return self.active.source.structure(self.line)

    def jump(self, line: int) -> None:
        """Continue at a line."""
        self.active.source.jump_without_choice(line)

    def choose(self) -> None:
        """Note that a condition or a count decides, unless it is always the same."""
        if "#" in self.reader.text:
            self.active.source.jumps_back = 0


class OWordInterpreter(WordInterpreter[ActiveProgram]):
    """Executes branches, loops and subprograms."""

    control: LinuxcncControl

    source_type = LinuxcncText
    suffixes = SUFFIXES
    jump_words = re.compile(rb"\bO[ \t]*(?:<[^<>\n]*>|[0-9]+)[ \t]*(?:IF|WHILE|DO|REPEAT)", re.IGNORECASE)

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        declared = DeclaredVariables(self.control.declared, self._note, self.control.leave_variable)
        self._parameters = Parameters(self._system_value, declared)
        self._returned: float | None = None
        self._handlers: dict[str, Callable[[OWord], None]] = {
            "SUB": lambda word: word.jump(word.structure.end + 1),
            "ENDSUB": self._return,
            "RETURN": self._early_return,
            "CALL": self._call,
            "IF": self._if,
            "ELSEIF": self._end_branch,
            "ELSE": self._end_branch,
            "ENDIF": self._check_structure,
            "WHILE": self._while,
            "ENDWHILE": lambda word: word.jump(word.structure.begin),
            "DO": self._check_structure,
            "REPEAT": self._repeat,
            "ENDREPEAT": self._end_repeat,
            "BREAK": lambda word: word.jump(word.structure.end + 1),
            "CONTINUE": self._continue,
        }

    @abstractmethod
    def _system_value(self, key: int | str) -> float | None:
        """Return a parameter that the control sets, by number or name; None for one that is not simulated."""

    def _o_word(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        label = self._label(reader)
        if _KEYWORD.match(reader.text, reader.at) is None:
            if not reader.ended:
                raise BlockError(Wording("NC210", "no_o_word", found=repr(reader.rest)))
            return
        # All letters belong to the keyword: what follows it is in brackets.
        keyword = re.match("[A-Z]+", reader.text[reader.at :])
        assert keyword is not None
        name = keyword.group()
        reader.at += len(name)
        handler = self._handlers.get(name)
        if handler is None:
            raise BlockError(Wording("NC210", "no_o_word", found=name[:40]))
        handler(OWord(active, line, label, reader))
        if not reader.ended:
            self._note(Wording("NC210", "not_understood_behind", name=name, rest=repr(reader.rest)), Severity.ERROR)

    @staticmethod
    def _label(reader: ExpressionReader) -> str:
        begin = reader.at
        if reader.accept("<"):
            end = reader.text.find(">", begin)
            if end < 0:
                raise BlockError(Wording("NC210", "name_o_word_does_not"))
            reader.at = end + 1
            return reader.text[begin : end + 1]
        value, _ = reader.signed_value()
        if value is None or value != int(value) or not 0 <= value < 1e9:
            raise BlockError(Wording("NC210", "o_word_needs_whole_number"))
        return str(int(value))

    @staticmethod
    def _check_structure(word: OWord) -> None:
        """See that the O word belongs to a structure."""
        assert word.structure is not None

    # Subprograms

    def _return(self, word: OWord) -> None:
        if len(self._stack) < 2:
            raise BlockError(Wording("NC210", "end_subprogram_outside"))
        self._returned = None
        if not word.reader.ended:
            self._returned = word.reader.bracket_value()
        self._leave_program()

    def _early_return(self, word: OWord) -> None:
        """Return before the end; from here to the next O word nothing runs."""
        self._check_behind_return(word.active)
        self._return(word)

    def _lines_of(self, active: ActiveProgram) -> tuple[int, int | None]:
        return active.source.line, active.source.next_o_word(active.source.line)

    def _leave_program(self) -> None:
        depth = len(self._stack)
        super()._leave_program()
        if len(self._stack) < depth:
            self._parameters.leave()

    def _call(self, word: OWord) -> None:
        arguments: list[float] = []
        while not word.reader.ended and len(arguments) < LOCAL_COUNT:
            arguments.append(word.reader.bracket_value())
        self._check_depth()
        entered, begin = self._find_subprogram(word.active, word.label)
        entered.row = self.control.row
        entered.source.jump(begin + 1)
        self._parameters.enter(arguments)
        self._stack.append(entered)

    def _find_subprogram(self, active: ActiveProgram, label: str) -> tuple[ActiveProgram, int]:
        """Return a subprogram of this file or of another one, and its first line."""
        here = active.source.subprogram(label)
        if here is not None:
            return ActiveProgram(active.source.restarted(), active.file), here.begin
        path = self._subprograms.find(label.strip("<>"))
        if path is None:
            raise BlockError(Wording("NC132", "missing_subprogram", label=label[:80]))
        source, file = self._open_subprogram(path)
        assert isinstance(source, LinuxcncText)
        found = source.subprogram(label)
        if found is None:
            raise BlockError(Wording("NC132", "file_without_subprogram", path=path.name, label=label[:80]))
        return ActiveProgram(source, file), found.begin

    # Branches and loops

    def _if(self, word: OWord) -> None:
        structure = word.structure
        word.choose()
        if self._is_true(word.reader):
            return
        for branch in structure.branches:
            condition = self._condition_of(word.active, branch)
            if condition is None or (condition.accept("ELSEIF") and self._is_true(condition)):
                word.jump(branch + 1)
                return

    def _condition_of(self, active: ActiveProgram, line: int) -> ExpressionReader | None:
        """Return a reader at the ELSEIF of a line; None at an ELSE or ENDIF."""
        here = active.source.line
        active.source.jump(line)
        text = split_line(active.source.next_line(), semicolon=True).text
        active.source.jump(here)
        reader = block_reader(text, ARITHMETIC, self._parameters)
        reader.expect("O")
        self._label(reader)
        return reader if reader.text.startswith("ELSEIF", reader.at) else None

    def _is_true(self, reader: ExpressionReader) -> bool:
        """Evaluate a condition; one with an error is taken as false."""
        try:
            return bool(reader.bracket_value())
        except BlockError as error:
            self._note(Wording("NC143", "condition", reason=error.wording), Severity.ERROR)
            reader.at = len(reader.text)
            return False

    @staticmethod
    def _end_branch(word: OWord) -> None:
        """End the branch that was executed, at the beginning of the next one."""
        word.reader.at = len(word.reader.text)
        word.jump(word.structure.end + 1)

    def _while(self, word: OWord) -> None:
        structure = word.structure
        word.choose()
        is_true = self._is_true(word.reader)
        if structure.word == "DO":
            if is_true:
                word.jump(structure.begin + 1)
        elif not is_true:
            word.jump(structure.end + 1)

    def _repeat(self, word: OWord) -> None:
        structure = word.structure
        repeats = 0
        try:
            repeats = int(min(max(word.reader.bracket_value(), 0.0), 1e12))
        except BlockError as error:
            self._note(Wording("NC143", "repeat", reason=error.wording), Severity.ERROR)
            word.reader.at = len(word.reader.text)
        if repeats < 1:
            word.jump(structure.end + 1)
        word.active.counters[word.line] = repeats

    @staticmethod
    def _end_repeat(word: OWord) -> None:
        begin, counters = word.structure.begin, word.active.counters
        word.active.source.jumps_back = 0
        counters[begin] = counters.get(begin, 0) - 1
        if counters[begin] > 0:
            word.jump(begin + 1)

    @staticmethod
    def _continue(word: OWord) -> None:
        structure = word.structure
        word.jump(structure.begin if structure.word == "WHILE" else structure.end)
