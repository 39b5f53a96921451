"""Subprograms of a Sinumerik program: calls, modal calls and returns."""

import re
from collections.abc import Sequence
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.families.sinumerik.block import Call
from trunnion.readers.families.sinumerik.block_reader import read_call
from trunnion.readers.families.sinumerik.control import SinumerikControl
from trunnion.readers.families.sinumerik.expressions import ExpressionError, ExpressionReader
from trunnion.readers.families.sinumerik.flow import ActiveProgram, Flow, Handler
from trunnion.readers.families.sinumerik.text import SUFFIXES, SinumerikText
from trunnion.readers.families.sinumerik.tokens import TokenKind
from trunnion.readers.families.sinumerik.variables import Variables
from trunnion.readers.families.sinumerik.words import CYCLES_NOT_SIMULATED
from trunnion.readers.program.interpreter import Interpreter
from trunnion.readers.program.known_words import beginning_call

#: What the control may put before the name of a program.
_PREFIX: Final = "_N_"

#: So many letters of a call are shown.
_LONGEST_SHOWN: Final = 80


class CallInterpreter(Interpreter[ActiveProgram]):
    """Executes calls of subprograms, and the keywords of control flow."""

    source_type = SinumerikText
    suffixes = SUFFIXES
    prefix = _PREFIX
    jump_words = re.compile(
        rb"(?<![A-Z0-9_])(?:GOTO[FBCS]?|IF|CASE|FOR|WHILE|LOOP|REPEATB?)(?![A-Z0-9_])", re.IGNORECASE
    )

    control: SinumerikControl

    def _flow_handlers(self) -> dict[str, Handler]:
        """Return what executes each keyword of control flow."""
        flow = Flow(self._note)

        def begin(reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
            self._check_procedure(active, line)
            flow.define_parameters(reader, active)

        return {
            **flow.handlers,
            "PROC": begin,
            "ENDPROC": self._end_procedure,
            "RET": self._return,
            "MCALL": self._modal_call,
            "EXTCALL": self._external_call,
            "CALL": self._external_call,
        }

    def _check_procedure(self, active: ActiveProgram, line: int) -> None:
        """Report a PROC that is not the first block of its program."""
        if active.procedure == line:
            return
        is_second, active.procedure = active.procedure > 0, line
        if is_second or any(map(self._has_words, active.source.lines_before(line))):
            self._note(Wording("NC160", "proc_not_first", word="PROC"), Severity.ERROR)

    def _end_procedure(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.expect_end()
        if not active.procedure:
            self._note(Wording("NC160", "endproc_without_proc"), Severity.ERROR)

    def _call_one(self, calls: Sequence[Call]) -> None:
        """Call the subprogram of a block, after everything else in the block is executed."""
        if len(calls) > 1:
            self._note(Wording("NC212", "several_subprograms_block_only_first"), Severity.ERROR)
        for call in calls[:1]:
            self._enter_subprogram(call)

    def _enter_subprogram(self, call: Call) -> None:
        """Start a subprogram, one of the files given by the user."""
        path = self._subprograms.find(call.name)
        if path is None and (does := CYCLES_NOT_SIMULATED.get(call.name)):
            fault = Wording("NC220", "cycle_known_not_simulated", number=call.name, cycle=does)
            self._note(fault.within("cycle_not_executed"), Severity.ERROR)
            return
        if path is None:
            begins = beginning_call(self._raw, re.escape(call.name)) and len(call.name) <= _LONGEST_SHOWN
            variant = "unknown_or_missing_word" if begins else "unknown_or_missing"
            self._note(Wording("NC132", variant, call=call.name[:_LONGEST_SHOWN]), Severity.ERROR)
            return
        if call.repeats < 1:
            return
        self._check_depth()
        outer = self._stack[-1].variables
        variables = Variables(outer.declared, outer)
        # The PROC line reads the arguments when it is executed.
        variables.pass_arguments(call.arguments, call.argument_texts)
        source, file = self._open_subprogram(path)
        assert isinstance(source, SinumerikText)
        self._stack.append(ActiveProgram(source, file, call.repeats, variables=variables))

    def _return(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.expect_end()  # RET("LABEL") goes on elsewhere than behind the call
        self._check_behind_return(active)
        self._leave_program()

    def _modal_call(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        token = reader.token
        if token is None:
            active.modal = None
            return
        if token.kind is TokenKind.LETTER and token.text == "L":
            reader.at += 1
            number = reader.token
            if number is None or not number.text.isdigit():
                raise ExpressionError(Wording("NC210", "subprogram_number"))
            reader.at += 1
            reader.expect_end()
            active.modal = Call(f"L{number.text}")
            return
        if token.kind is not TokenKind.NAME:
            raise ExpressionError(Wording("NC210", "name_must_follow"))
        reader.at += 1
        call = read_call(reader, token.text, active.variables)
        reader.expect_end()
        active.modal = call

    def _external_call(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        in_parentheses = reader.accept("(")
        value = reader.value()
        if in_parentheses:
            reader.expect(")")
        if not isinstance(value, str):
            raise ExpressionError(Wording("NC210", "takes_program_name"))
        reader.expect_end()
        self._enter_subprogram(Call(value))
