"""Subprograms and macros of a Fanuc program."""

import re
from abc import abstractmethod
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.families.fanuc import words
from trunnion.readers.families.fanuc.control import FanucControl
from trunnion.readers.families.fanuc.flow import ActiveProgram, Flow, ModalMacro
from trunnion.readers.families.fanuc.settings import Settings, settings_of
from trunnion.readers.families.fanuc.text import SUFFIXES, FanucText
from trunnion.readers.families.fanuc.variables import Variables
from trunnion.readers.program.declared_variables import DeclaredVariables
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.readers.program.known_words import beginning_call
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, Number, g_code_text
from trunnion.readers.rs274.expressions import BlockError, Value
from trunnion.readers.rs274.word_interpreter import WordInterpreter
from trunnion.readers.rs274.word_table import Word

#: How often a subprogram may be repeated by one call.
_MAX_REPEATS: Final = 1_000_000_000

#: How deep macros may nest, from the manual (B-63684EN).
_MAX_MACRO_DEPTH: Final = 4


class CallInterpreter(WordInterpreter[ActiveProgram]):
    """Executes calls and returns."""

    control: FanucControl

    source_type = FanucText
    suffixes = SUFFIXES

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        self.jump_words = _jump_words(settings_of(machine))
        super().__init__(path, machine, options)
        declared = DeclaredVariables(self.control.settings.variables, self._note)
        self._variables = Variables(self._system_value, self._set_system_value, declared)
        self._flow = Flow(self._note, self._variables)
        # The program and the line of the present block.
        self._here: tuple[ActiveProgram, int]

    def _text_of(self, path: Path) -> SourceText:
        text = super()._text_of(path)
        assert isinstance(text, FanucText)
        if "%" in self._form.has("program_numbers"):
            text.number_by_percent()
        return text

    def _lines_of(self, active: ActiveProgram) -> tuple[int, int | None]:
        return active.source.program_lines(max(active.source.line - 1, active.line))

    def _make_control(self) -> FanucControl:
        settings = settings_of(self._machine)
        return FanucControl(self._machine, self._note, settings, shortest=self._options.shortest)

    def _main_program(self, source: SourceText) -> ActiveProgram:
        assert isinstance(source, FanucText)
        if line := source.skip_text():
            self.control.line = line
            self._note(Wording("NC170", "text_before_percent"), Severity.WARNING)
        return ActiveProgram(source, 0)

    @abstractmethod
    def _system_value(self, key: int) -> float | None:
        """Return the value of a system variable; None for one that is not simulated."""

    def _set_system_value(self, key: int, value: Value) -> bool:
        """Stop at a message of #3006, and report an alarm of #3000; the blocks behind it are read all the same."""
        if key == words.MESSAGE_VARIABLE:
            self.control.note_wait(Wording("NC226", "stops_with_message", key=key), f"#{key}")
            self.control.add_event("stop")
        elif key == words.ALARM_VARIABLE:
            number = "" if value is None else f" {value:g}"
            self._note(Wording("NC226", "raises_alarm", key=key, number=number), Severity.ERROR)
        return key in (words.MESSAGE_VARIABLE, words.ALARM_VARIABLE)

    def _macro(self, active: ActiveProgram, block: Block) -> None:
        """G65 and G66: a macro with arguments, called now or after every motion."""
        number, repeats = block.take("P"), block.take("L")
        if number is None:
            raise BlockError(Wording("NC210", "call_macro_needs_p"))
        self._words_beside_macro(block)
        arguments: dict[int, float] = {}
        for letter, word in block.words.items():
            if letter in "PL":
                continue
            block.take(letter)
            if letter not in words.ARGUMENTS:
                self._note(Wording("NC215", "not_argument_macro", letter=letter), Severity.ERROR)
                continue
            arguments[words.ARGUMENTS[letter]] = self._argument(letter, word)
        if block.m:
            arguments[words.ARGUMENTS["M"]] = float(block.m[0])
        macro = ModalMacro(_program_number(number), _repeats(repeats), arguments)
        if words.MODAL_MACRO in block.g:
            active.modal = macro
        else:
            self._enter_subprogram(macro.number, macro.repeats, macro.arguments)

    def _words_beside_macro(self, block: Block) -> None:
        """Execute the modes beside G65 and G66; refuse other codes, and a second M word: the first is an argument."""
        name = g_code_text(next(code for code in block.g if code in words.MACROS))
        for other in self.table.words("G", [code for code in block.g if code not in words.MACROS]):
            if other.letters or not other.moves:
                raise BlockError(Wording("NC210", "block_takes_no", block=name, word=other.text))
            self._execute_word(other, block)
        if len(block.m) > 1:
            raise BlockError(Wording("NC210", "block_takes_no", block=name, word=f"M{block.m[1]}"))

    def _argument(self, letter: str, word: Number) -> float:
        if word.whole and word.value and not self.control.settings.calculator and letter not in "DEHMST":
            self._note(Wording("NC217", "argument_without_point_taken_written", letter=letter), Severity.WARNING)
        return word.value

    def _call_modal_macro(self) -> None:
        modal = self._here[0].modal
        if modal is not None:
            self._enter_subprogram(modal.number, modal.repeats, dict(modal.arguments))

    def _call(self, word: Word, block: Block) -> None:
        """M98: P is the program, L the number of repeats; without L the digits of P before those of the program."""
        number, repeats = block.take("P"), block.take("L")
        if number is None:
            raise BlockError(Wording("NC210", "m98_needs_p"))
        program = _program_number(number)
        programs = 10**self.control.settings.program_digits
        if repeats is None and program >= programs:
            repeats = float(program // programs)
            program %= programs
        self._enter_subprogram(program, _repeats(repeats), None)

    def _local_call(self, word: Word, block: Block) -> None:
        """Call the part of this program from block number P to its M99, L times."""
        active, line = self._here
        number, repeats = block.take("P"), _repeats(block.take("L"))
        if number is None:
            raise BlockError(Wording("NC210", "call_local_subprogram_needs_p"))
        begin = self._flow.target(active, line, _program_number(number))
        if repeats < 1:
            return
        self._check_depth()
        part = ActiveProgram(active.source.restarted(), active.file, repeats)
        part.row, part.line, part.begun = self.control.row, begin, True
        part.source.jump(begin)
        self._stack.append(part)

    def _jump_on_input(self, word: Word, block: Block) -> None:
        """Report a jump that depends on an input of the machine: it cannot be followed."""
        target, number = block.take("P"), block.take("Q")
        own = next(f"M{code}" for code, meaning in self.control.own_words.m.items() if meaning == word.code)
        if target is None:
            wording = Wording("NC222", "jump_on_some_input", word=own)
        elif number is None:
            wording = Wording("NC222", "jump_to_on_some_input", word=own, target=target)
        else:
            wording = Wording("NC222", "jump_to_on_input", word=own, target=target, input=number)
        self._note(wording, Severity.ERROR)

    def _enter_subprogram(self, number: int, repeats: int, arguments: dict[int, float] | None) -> None:
        """Start a program of this file or a subprogram file; a macro if there are ``arguments``."""
        if repeats < 1:
            return
        self._check_depth()
        entered, begin = self._find_program(number, repeats)
        entered.row, entered.line = self.control.row, begin
        entered.begun = entered.source.program(number) is not None
        entered.source.jump(begin)
        entered.macro = arguments is not None
        if arguments is not None:
            self._variables.enter(arguments)
            if self._variables.depth > _MAX_MACRO_DEPTH:
                self._note(Wording("NC141", "macros_too_deep", most=_MAX_MACRO_DEPTH), Severity.WARNING)
        self._stack.append(entered)

    def _find_program(self, number: int, repeats: int) -> tuple[ActiveProgram, int]:
        """Return a program and its first line; the control has one of a number."""
        here = self._stack[-1]
        begin = here.source.program(number)
        names = (f"O{number:04d}", f"O{number:05d}", f"O{number}", f"{number:04d}", f"{number}")
        paths = list(dict.fromkeys(path for name in names if (path := self._subprograms.find(name))))
        files = tuple(path.name for path in paths)
        own = self._stack[0].source
        if len(files) > 1:
            raise BlockError(Wording("NC132", "files_of_one_number", number=number, files=files))
        if files and isinstance(own, FanucText) and own.program(number) is not None:
            raise BlockError(Wording("NC132", "number_in_both", number=number, file=files[0]))
        if begin is not None:
            return ActiveProgram(here.source.restarted(), here.file, repeats), begin
        if not paths:
            if call := beginning_call(self._raw, r"(?:G6[56]|M198|M98)[ \t]*P[0-9]+"):
                raise BlockError(Wording("NC132", "missing_called_number", number=number, call=call))
            raise BlockError(Wording("NC132", "missing_subprogram_number", number=number))
        source, file = self._open_subprogram(paths[0])
        assert isinstance(source, FanucText)
        begin = source.program(number)
        if begin is None and (others := source.numbers()):
            raise BlockError(Wording("NC132", "other_number_in_file", file=files[0], number=number, others=others))
        return ActiveProgram(source, file, repeats), begin or 1

    def _return(self, word: Word, block: Block) -> None:
        """M99: return, to block P of the caller; the main program would start again without end."""
        active, line = self._here
        target = block.take("P")
        if len(self._stack) < 2:
            if target is not None:
                self._flow.jump(active, line, _program_number(target))
                return
            # No event "end": the control goes on at the first block.
            self._note(Wording("NC162", "m99_begins_program_anew_without"), Severity.WARNING)
            raise ProgramEnd
        depth = len(self._stack)
        self._check_behind_return(active)
        self._leave_program()
        if target is not None and len(self._stack) < depth:
            caller = self._stack[-1]
            self._flow.jump(caller, caller.source.line - 1, _program_number(target))

    def _leave_program(self) -> None:
        active = self._stack[-1]
        if active.repeats > 1:
            active.repeats -= 1
            active.percents = 0
            active.source.jump(active.line)
            self._counter.count_blocks(1)
            return
        super()._leave_program()
        if active.macro:
            self._variables.leave()


def _jump_words(settings: Settings) -> re.Pattern[bytes]:
    """Return what the words begin with that lead to other blocks on a control."""
    jumps = [code for code, meaning in settings.words.m.items() if meaning in (words.LOCAL_CALL, words.JUMP_ON_INPUT)]
    own = "".join(f"|M[ \\t]*0*{code}(?![0-9])" for code in jumps)
    return re.compile(rf"GOTO|IF[ \t]*\[|WHILE{own}".encode(), re.IGNORECASE)


def _program_number(number: float) -> int:
    if number != int(number) or not 0 <= number < 1e9:
        raise BlockError(Wording("NC210", "p_not_number_program_block"))
    return int(number)


def _repeats(repeats: float | None) -> int:
    if repeats is None:
        return 1
    if repeats != int(repeats) or not 0 <= repeats <= _MAX_REPEATS:
        raise BlockError(Wording("NC210", "l_not_how_often"))
    return int(repeats)
