"""Control flow of a Klartext program: labels, calls, and jumps of FN functions."""

import re
from dataclasses import field
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.fn_functions import acting_function, execute
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, canonical
from trunnion.readers.families.heidenhain.text import SUFFIXES, KlartextText
from trunnion.readers.program import interpreter
from trunnion.readers.program.interpreter import Interpreter, ProgramEnd
from trunnion.readers.program.known_words import beginning_call
from trunnion.records import dataclass

#: How deep calls of labels may nest.
MAX_LABEL_DEPTH: Final = 20

_LABEL = re.compile(r"(Q[LR]?[0-9]{1,4})|([0-9]{1,5})")
_PARAMETER = re.compile(r"Q[LR]?[0-9]")
_CALL = re.compile(r"[ \t]*(LBL|PGM)(?![A-Z])")


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program that is being executed.

    returns       lines after the calls of its labels
    repeats_left  repeats that are left, by the line of the call
    name          of BEGIN PGM, None before it
    unit          of BEGIN PGM, MM or INCH; empty: not said
    has_blocks    whether a block came before it
    ended         whether END PGM has come
    """

    source: KlartextText
    parameters: Parameters = field(default_factory=Parameters)
    returns: list[int] = field(default_factory=list)
    repeats_left: dict[int, int] = field(default_factory=dict)
    name: str | None = None
    unit: str = ""
    has_blocks: bool = False
    ended: bool = False


class FlowInterpreter(Interpreter[ActiveProgram]):
    """Executes LBL, CALL and FN."""

    source_type = KlartextText
    suffixes = SUFFIXES
    jump_words = re.compile(rb"LBL|GOTO", re.IGNORECASE)

    control: HeidenhainControl

    def _label(self, active: ActiveProgram, rest: str) -> None:
        active.source.pass_label(self._raw, self.control.line)
        if _label_name(rest, active.parameters) == "0" and active.returns:
            active.source.jump(active.returns.pop())

    def _call(self, active: ActiveProgram, rest: str) -> None:
        match = _CALL.match(rest)
        if match is None:
            raise KlartextError(Wording("NC210", "call_needs_lbl_pgm"))
        rest = rest[match.end() :].strip()
        if match[1] == "PGM":
            self._enter_program(rest.strip('"'))
            return
        label, repeated, repeats = rest.partition("REP")
        active.source.load()
        here = active.source.line
        target = self._line_of(active, label)
        if repeated:
            counts = [int(_label_name(count, active.parameters)) for count in repeats.split("/")]
            self._repeat(active, here, target, counts[0])
            return
        if len(active.returns) >= MAX_LABEL_DEPTH:
            too_deep = Wording("NC141", "labels_too_deep", most=MAX_LABEL_DEPTH)
            raise active.source.problem(self.control.line, too_deep)
        active.returns.append(here)
        active.source.jump(target)

    def _report_doubled_labels(self, source: KlartextText) -> None:
        """Report labels that are set more than once: the control checks a whole program before it runs."""
        here = self.control.line
        for name, line, first in source.take_doubled_labels():
            self.control.line = line
            shown = name if name.isdigit() else f'"{name[:40]}"'
            self._note(Wording("NC163", "doubled_label", label=shown, line=first), Severity.ERROR)
        self.control.line = here

    @staticmethod
    def _repeat(active: ActiveProgram, here: int, target: int, repeats: int) -> None:
        active.source.jumps_back = 0
        left = active.repeats_left.setdefault(here, repeats)
        if left > 0:
            active.repeats_left[here] = left - 1
            active.source.jump(target)
        else:
            del active.repeats_left[here]

    def _line_of(self, active: ActiveProgram, label: str) -> int:
        """Return the line of a label; a missing one ends the program."""
        name = _label_name(label, active.parameters)
        found = active.source.label(name)
        if found is None:
            self._note(Wording("NC133", "missing_label", name=name[:60]), Severity.ERROR)
            raise ProgramEnd
        return found

    def _enter_program(self, name: str) -> None:
        """Call a program, one of the files given by the user."""
        path = self._subprograms.find(name)
        if path is None:
            call = beginning_call(self._raw, r"CALL PGM[ \t]+[^\s;\"]+")
            missing = Wording("NC132", "missing_program", name=name[:80])
            called = Wording("NC132", "missing_called_program", name=name[:80], call=call)
            self._note(called if call else missing, Severity.ERROR)
            return
        self._check_depth()
        outer = self._stack[-1].parameters
        parameters = Parameters(outer.declared, outer)
        source, file = self._open_subprogram(path)
        assert isinstance(source, KlartextText)
        self._stack.append(ActiveProgram(source, file, parameters=parameters))

    def _fn(self, active: ActiveProgram, rest: str) -> None:
        if _PARAMETER.search(rest):
            active.source.jumps_back = 0
        label = execute(rest, active.parameters, self._note)
        if (number := acting_function(rest)) is not None:
            self.control.add_event("unasked", f"FN {number}")
            self.control.say_once(f"FN {number}")
        if label is not None:
            active.source.load()
            active.source.jump_without_choice(self._line_of(active, label))


def _label_name(text: str, parameters: Parameters) -> str:
    """Return the name of a label: its number, or its name in capitals."""
    text = text.strip()
    if text[:1] == '"':
        return text.strip('"').upper()
    match = _LABEL.fullmatch(text)
    if match is None:
        raise KlartextError(Wording("NC210", "label_number_name_quotes"))
    number = parameters[canonical(match[1])] if match[1] else float(match[2])
    if number != int(number) or number < 0.0:
        raise KlartextError(Wording("NC210", "not_label", number=number))
    return str(int(number))
