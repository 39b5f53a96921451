"""Where a LinuxCNC program goes on: its O words."""

import re
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.readers.families.linuxcnc.parameters import ARITHMETIC, LOCAL_COUNT, Parameters
from trunnion.readers.families.linuxcnc.text import SUFFIXES, LinuxcncText
from trunnion.readers.program.source_text import Subprograms
from trunnion.readers.rs274 import interpreter
from trunnion.readers.rs274.block import block_reader, split_line
from trunnion.readers.rs274.expressions import BlockError, ExpressionReader
from trunnion.readers.rs274.interpreter import Rs274Interpreter

_KEYWORD = re.compile(r"SUB|ENDSUB|IF|ELSEIF|ELSE|ENDIF|WHILE|ENDWHILE|DO|REPEAT|ENDREPEAT|BREAK|CONTINUE|CALL|RETURN")


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program or subprogram being executed, and how often its REPEAT loops have still to run, by line."""

    source: LinuxcncText
    counters: dict[int, int] = field(default_factory=dict)


class OWordInterpreter(Rs274Interpreter[ActiveProgram]):
    """Branches, loops and subprograms; what blocks say besides is for the class below."""

    def __init__(
        self, path: Path, machine: Machine, *, subprograms: Sequence[Path], step_limit: int, skip: bool
    ) -> None:
        named = Subprograms(subprograms, SUFFIXES)
        super().__init__(path, machine, named, step_limit=step_limit, skip=skip)
        self._parameters = Parameters(self._system_value)
        self._returned: float | None = None

    @abstractmethod
    def _system_value(self, key: int | str) -> float | None:
        """Return what the control itself puts behind a number or name; None if it is none of its own."""

    def _o_word(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        label = self._label(reader)
        match = _KEYWORD.match(reader.text, reader.at)
        if match is None:
            if not reader.ended:
                raise BlockError(f"no O word: {reader.rest!r}")
            return
        # The longest word that fits: the text goes on with a bracket or not at all.
        word = re.match("[A-Z]+", reader.text[reader.at :])
        assert word is not None
        name = word.group()
        reader.at += len(name)
        handler = {
            "SUB": self._skip_sub,
            "ENDSUB": self._return,
            "RETURN": self._return,
            "CALL": self._call,
            "IF": self._if,
            "ELSEIF": self._past_branches,
            "ELSE": self._past_branches,
            "ENDIF": self._nothing,
            "WHILE": self._while,
            "ENDWHILE": self._again,
            "DO": self._nothing,
            "REPEAT": self._repeat,
            "ENDREPEAT": self._end_repeat,
            "BREAK": self._break,
            "CONTINUE": self._continue,
        }.get(name)
        if handler is None:
            raise BlockError(f"no O word: {name[:40]}")
        handler(active, line, reader, label)
        if not reader.ended:
            self._note(f"not understood behind {name}: {reader.rest!r}", Severity.ERROR)

    @staticmethod
    def _label(reader: ExpressionReader) -> str:
        begin = reader.at
        if reader.accept("<"):
            end = reader.text.find(">", begin)
            if end < 0:
                raise BlockError("the name of an O word does not end")
            reader.at = end + 1
            return reader.text[begin : end + 1]
        value, _ = reader.signed_value()
        if value is None or value != int(value) or not 0 <= value < 1e9:
            raise BlockError("an O word needs a whole number or a name")
        return str(int(value))

    def _nothing(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        active.source.structure(line)

    def _skip_sub(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        active.source.jump(active.source.structure(line).end + 1)

    def _return(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        if len(self._stack) < 2:
            raise BlockError("the end of a subprogram outside one")
        self._returned = None
        if not reader.ended:
            self._returned = reader.bracket_value()
        self._leave_program()

    def _leave_program(self) -> None:
        deep = len(self._stack)
        super()._leave_program()
        if len(self._stack) < deep:
            self._parameters.leave()

    def _call(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        arguments: list[float] = []
        while not reader.ended and len(arguments) < LOCAL_COUNT:
            arguments.append(reader.bracket_value())
        self._check_depth()
        here = active.source.subprogram(label)
        if here is not None:
            self._file.set(self.control.row, active.file)
            entered = ActiveProgram(active.source.restarted(), active.file)
            begin = here.begin
        else:
            path = self._subprograms.find(label.strip("<>"))
            if path is None:
                raise BlockError(f"missing subprogram O{label[:80]}; name its file")
            text, file = self._open_subprogram(path)
            assert isinstance(text, LinuxcncText)
            found = text.subprogram(label)
            if found is None:
                self._file.set(self.control.row, active.file)
                raise BlockError(f"{path.name} holds no O{label[:80]} SUB")
            entered, begin = ActiveProgram(text, file), found.begin
        entered.row = self.control.row
        entered.source.jump(begin + 1)
        self._parameters.enter(arguments)
        self._stack.append(entered)

    def _if(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        structure = active.source.structure(line)
        if self._holds(reader):
            return
        for branch in structure.branches:
            head = self._head(active, branch)
            if head is None or (head.accept("ELSEIF") and self._holds(head)):
                active.source.jump(branch + 1)
                return

    def _head(self, active: ActiveProgram, line: int) -> ExpressionReader | None:
        """Return a reader at the ELSEIF of a line; None at an ELSE or at the end."""
        here = active.source.line
        active.source.jump(line)
        text = split_line(active.source.next_line(), semicolon=True).text
        active.source.jump(here)
        reader = block_reader(text, ARITHMETIC, self._parameters)
        reader.expect("O")
        self._label(reader)
        return reader if reader.text.startswith("ELSEIF", reader.at) else None

    def _holds(self, reader: ExpressionReader) -> bool:
        """Return a condition; one that cannot be worked out does not hold."""
        try:
            return bool(reader.bracket_value())
        except BlockError as error:
            self._note(f"not understood: {error}: taken as not fulfilled", Severity.ERROR)
            reader.at = len(reader.text)
            return False

    def _past_branches(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        """A branch that was executed ends here."""
        reader.at = len(reader.text)
        active.source.jump(active.source.structure(line).end + 1)

    def _while(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        structure = active.source.structure(line)
        holds = self._holds(reader)
        if structure.word == "DO":
            if holds:
                active.source.jump(structure.begin + 1)
        elif not holds:
            active.source.jump(structure.end + 1)

    def _again(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        active.source.jump(active.source.structure(line).begin)

    def _repeat(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        structure = active.source.structure(line)
        times = 0
        try:
            times = int(min(max(reader.bracket_value(), 0.0), 1e12))
        except BlockError as error:
            self._note(f"not understood: {error}: not repeated", Severity.ERROR)
            reader.at = len(reader.text)
        if times < 1:
            active.source.jump(structure.end + 1)
        active.counters[line] = times

    def _end_repeat(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        begin = active.source.structure(line).begin
        active.counters[begin] = active.counters.get(begin, 0) - 1
        if active.counters[begin] > 0:
            active.source.jump(begin + 1)

    def _break(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        active.source.jump(active.source.structure(line).end + 1)

    def _continue(self, active: ActiveProgram, line: int, reader: ExpressionReader, label: str) -> None:
        structure = active.source.structure(line)
        active.source.jump(structure.begin if structure.word == "WHILE" else structure.end)
