"""Control flow of a Fanuc program: conditions, jumps and loops."""

import re
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.fanuc.text import FanucText
from trunnion.readers.families.fanuc.variables import Variables
from trunnion.readers.rs274 import interpreter
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError, ExpressionReader
from trunnion.records import dataclass

_WORD = re.compile(r"IF|GOTO|WHILE|DO|END(?=[0-9#\[])")

#: A number, a variable, a function or a value in brackets, whose content is left out.
_VALUE: Final = r"[-+]*(?:[A-Z]*\[\]|#+(?:[0-9]+|_[A-Z0-9_]+|\[\])|[0-9]++(?:\.[0-9]*+)?+|\.[0-9]+)"
_NUMBER = re.compile(_VALUE)
_ASSIGNMENT = re.compile(rf"#+(?:[0-9]+|_[A-Z0-9_]+|\[\])={_VALUE}(?:(?:[-+*/]|MOD|AND|XOR|OR){_VALUE})*")

#: Block and loop numbers are smaller.
_HIGHEST: Final = 10**9


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program or subprogram that is being executed.

    line    its first line, for repeats
    begun   its O number has been read
    has_blocks  a block of it has been executed: the next O number is that of another program
    macro   it has local variables of its own
    modal   the macro of G66 that is called after every motion
    """

    source: FanucText
    line: int = 1
    begun: bool = False
    has_blocks: bool = False
    macro: bool = False
    modal: "ModalMacro | None" = None


@dataclass(frozen=True, slots=True)
class ModalMacro:
    """A macro of G66: its number, its repeats and its arguments."""

    number: int
    repeats: int
    arguments: dict[int, float]


class Flow:
    """Executes the keywords of control flow; the source is at the line after the block then."""

    def __init__(self, note: Note, variables: Variables) -> None:
        self._note = note
        # File and line of the jumps to block numbers that stand twice.
        self._jumps_to_doubled: set[tuple[int, int]] = set()
        self._variables = variables

    def accept(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> bool:
        """Execute a keyword if one comes next."""
        match = _WORD.match(reader.text, reader.at)
        if match is None:
            return False
        reader.at = match.end()
        {"IF": self._if, "GOTO": self._goto, "WHILE": self._while, "DO": self._do, "END": self._end}[match.group()](
            active, line, reader
        )
        if not reader.ended:
            raise BlockError(
                Wording("NC210", "stands_behind_condition", condition=match.group(), rest=repr(reader.rest))
            )
        return True

    def _holds(self, active: ActiveProgram, reader: ExpressionReader) -> bool:
        """Evaluate a condition; one with an error is taken as false."""
        begin = reader.at
        if "#" in reader.text:
            active.source.jumps_back = 0
        try:
            return bool(reader.bracket_value())
        except BlockError as error:
            self._note(Wording("NC143", "condition", reason=error.wording), Severity.ERROR)
            reader.at = _behind_bracket(reader.text, begin)
            return False

    def _if(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        holds = self._holds(active, reader)
        if reader.accept("GOTO"):
            end = _behind(_NUMBER, reader)
            if end < len(reader.text):
                reader.at = end
                return  # what stands there is reported, and nothing jumps
            if holds:
                self._goto(active, line, reader)
            reader.at = end
            return
        reader.expect("THEN")
        if not holds:
            reader.at = _behind(_ASSIGNMENT, reader)
            return
        reader.expect("#")
        key = reader.parameter_key()
        self._variables.set(key, reader.assigned_value())

    def _goto(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        if "#" in reader.text:
            active.source.jumps_back = 0
        self.jump(active, line, _whole(reader.signed_value()[0]))

    def jump(self, active: ActiveProgram, line: int, number: int) -> None:
        """Continue at a block number."""
        active.source.jump_without_choice(self.target(active, line, number))

    def target(self, active: ActiveProgram, line: int, number: int) -> int:
        """Return the line of a block number of the program of a line; report one that stands twice."""
        target = active.source.number(number, line)
        if target is None:
            raise BlockError(Wording("NC133", "missing_block", number=number))
        doubled = active.source.doubled_number(number, line)
        if doubled and (active.file, line) not in self._jumps_to_doubled:
            self._jumps_to_doubled.add((active.file, line))
            self._note(
                Wording("NC163", "doubled_number", number=number, first=doubled[0], second=doubled[1]), Severity.ERROR
            )
        return target

    def _while(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        holds = self._holds(active, reader)
        reader.expect("DO")
        _whole(reader.signed_value()[0])
        end = active.source.partner(line)
        if not holds:
            active.source.jump(end + 1)

    def _do(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        _whole(reader.signed_value()[0])
        active.source.partner(line)

    def _end(self, active: ActiveProgram, line: int, reader: ExpressionReader) -> None:
        _whole(reader.signed_value()[0])
        active.source.jump_without_choice(active.source.partner(line))


def _whole(value: float | None) -> int:
    if value is None or abs(value - round(value)) > 1e-6 or not 0 <= value < _HIGHEST:
        raise BlockError(Wording("NC210", "whole_number_missing"))
    return round(value)


def _behind(what: re.Pattern[str], reader: ExpressionReader) -> int:
    """Return where something ends of which nothing is evaluated: it may stand on a way that the program does not go."""
    places: list[int] = []
    at = reader.at
    while at < len(reader.text):
        places.append(at)
        at = _behind_bracket(reader.text, at) if reader.text[at] == "[" else at + 1
        if reader.text[places[-1]] == "[":
            places.append(at - 1)
    match = what.match("".join(reader.text[place] for place in places))
    return reader.at if match is None else [*places, len(reader.text)][match.end()]


def _behind_bracket(text: str, at: int) -> int:
    """Return the position after the bracket that opens at a position."""
    depth = 0
    for place in range(at, len(text)):
        depth += {"[": 1, "]": -1}.get(text[place], 0)
        if depth == 0:
            return place + 1
    return len(text)


def assign(variables: Variables, block: Block) -> None:
    """Execute the assignments of a block."""
    for key, value in block.assignments:
        variables.set(key, value)
