"""Subprograms and macros of a Fanuc program."""

from abc import abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.readers.families.fanuc import words
from trunnion.readers.families.fanuc.flow import ActiveProgram, Flow, ModalMacro
from trunnion.readers.families.fanuc.settings import settings_of
from trunnion.readers.families.fanuc.text import SUFFIXES, FanucText
from trunnion.readers.families.fanuc.variables import Variables
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.readers.program.source_text import Subprograms
from trunnion.readers.rs274.block import Block, Number
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import Rs274Interpreter

#: Times that a subprogram may be called at once.
_MOST_CALLS: Final = 1_000_000_000

#: Macros inside each other, as the manual has it (B-63684EN).
_MOST_MACROS: Final = 4

#: Programs of a number of at most four digits: more are how often they run.
_FOUR: Final = 10_000


class CallInterpreter(Rs274Interpreter[ActiveProgram]):
    """Calls and returns; what blocks say besides is for the class below."""

    def __init__(
        self, path: Path, machine: Machine, *, subprograms: Sequence[Path], step_limit: int, skip: bool
    ) -> None:
        named = Subprograms(subprograms, SUFFIXES)
        super().__init__(path, machine, named, step_limit=step_limit, skip=skip)
        self._settings = settings_of(machine)
        self._variables = Variables(self._system_value)
        self._flow = Flow(self._note, self._variables)

    @abstractmethod
    def _system_value(self, key: int) -> float | None:
        """Return what the control itself puts behind a number; None if it is none of its own."""

    def _macro(self, active: ActiveProgram, block: Block) -> None:
        """G65 and G66: a macro with arguments, now or after every motion."""
        number, times = block.take("P"), block.take("L")
        if number is None:
            raise BlockError("the call of a macro needs P")
        arguments: dict[int, float] = {}
        for letter, word in block.words.items():
            if letter in "PL":
                continue
            block.take(letter)
            if letter not in words.ARGUMENTS:
                self._note(f"{letter} is no argument of a macro", Severity.ERROR)
                continue
            arguments[words.ARGUMENTS[letter]] = self._argument(letter, word)
        if block.m:
            arguments[words.ARGUMENTS["M"]] = float(block.m[0])
        macro = ModalMacro(_program(number), _times(times), arguments)
        if words.MODAL_MACRO in block.g:
            active.modal = macro
        else:
            self._enter_subprogram(macro.number, macro.times, macro.arguments)

    def _argument(self, letter: str, word: Number) -> float:
        if word.whole and word.value and not self._settings.calculator and letter not in "DEHMST":
            self._note(f"argument {letter} without a point: taken as it is written", Severity.WARNING)
        return word.value

    def _call_modal(self, active: ActiveProgram) -> None:
        if active.modal is not None:
            self._enter_subprogram(active.modal.number, active.modal.times, dict(active.modal.arguments))

    def _call(self, block: Block) -> None:
        """M98: P is the number, L how often; without L the digits before the last four."""
        number, times = block.take("P"), block.take("L")
        if number is None:
            raise BlockError("M98 needs P")
        program = _program(number)
        if times is None and program >= _FOUR:
            times = float(program // _FOUR)
            program %= _FOUR
        self._enter_subprogram(program, _times(times), None)

    def _enter_subprogram(self, number: int, times: int, arguments: dict[int, float] | None) -> None:
        """Begin a subprogram: of this file, or of those that were named."""
        if times < 1:
            return
        self._check_depth()
        here = self._stack[-1]
        begin = here.source.program(number)
        if begin is not None:
            entered = ActiveProgram(here.source.restarted(), here.file, times)
        else:
            path = next(
                (
                    path
                    for name in (f"O{number:04d}", f"O{number}", f"{number:04d}", f"{number}")
                    if (path := self._subprograms.find(name))
                ),
                None,
            )
            if path is None:
                raise BlockError(f"missing subprogram O{number:04d}; name its file")
            text, file = self._open_subprogram(path)
            assert isinstance(text, FanucText)
            entered = ActiveProgram(text, file, times)
            begin = text.program(number) or 1
        entered.row, entered.line = self.control.row, begin
        entered.begun = entered.source.program(number) is not None
        entered.source.jump(begin)
        entered.macro = arguments is not None
        if arguments is not None:
            self._variables.enter(arguments)
            if self._variables.depth > _MOST_MACROS:
                what = f"macros inside each other deeper than {_MOST_MACROS} levels: controls may have no more"
                self._note(what, Severity.WARNING)
        self._stack.append(entered)

    def _return(self, active: ActiveProgram, line: int, block: Block) -> None:
        """M99: back, P the block there that goes on; in the program itself it would begin anew without end."""
        target = block.take("P")
        if len(self._stack) < 2:
            if target is not None:
                self._flow.jump(active, line, _program(target))
                return
            self._note("M99 begins the program anew without end: it ends here", Severity.WARNING)
            self.control.add_event("end", "M99")
            raise ProgramEnd
        deep = len(self._stack)
        self._leave_program()
        if target is not None and len(self._stack) < deep:
            caller = self._stack[-1]
            self._flow.jump(caller, caller.source.line - 1, _program(target))

    def _leave_program(self) -> None:
        active = self._stack[-1]
        if active.repeats > 1:
            active.repeats -= 1
            active.percents = 0
            active.source.jump(active.line)
            self._count_blocks(1)
            return
        super()._leave_program()
        if active.macro:
            self._variables.leave()


def _program(number: float) -> int:
    if number != int(number) or not 0 <= number < 1e9:
        raise BlockError("P is not the number of a program or block")
    return int(number)


def _times(times: float | None) -> int:
    if times is None:
        return 1
    if times != int(times) or not 0 <= times <= _MOST_CALLS:
        raise BlockError("L is not how often")
    return int(times)
