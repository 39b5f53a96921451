"""Control flow of a Sinumerik program: conditions, loops, jumps, and definitions of variables.

Of a loop only its lines are known: its end jumps back to its beginning, which evaluates the condition again.
"""

import re
from collections.abc import Callable
from dataclasses import field
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.sinumerik import fields
from trunnion.readers.families.sinumerik.block import Call
from trunnion.readers.families.sinumerik.expressions import ExpressionError, ExpressionReader
from trunnion.readers.families.sinumerik.text import SinumerikText
from trunnion.readers.families.sinumerik.tokens import TokenKind, split_comment, tokenize
from trunnion.readers.families.sinumerik.variables import Variables
from trunnion.readers.families.sinumerik.words import TYPES
from trunnion.readers.program import interpreter
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class ActiveProgram(interpreter.ActiveProgram):
    """A program or subprogram that is being executed, and its modal cycle or subprogram (MCALL).

    procedure   the line of its PROC, 0 for none
    header_end  the last of the lines without a block with which the file begins
    repeated    how often a REPEAT or REPEATB has gone to its label, by its line
    sections    the last line of each part that is being repeated, and the line of its REPEAT or REPEATB
    """

    source: SinumerikText
    variables: Variables = field(default_factory=Variables)
    modal: Call | None = None
    procedure: int = 0
    header_end: int = 0
    repeated: dict[int, int] = field(default_factory=dict)
    sections: list[tuple[int, int]] = field(default_factory=list)

    def end_section(self, line: int) -> None:
        """Go back to what repeats a part behind the last line of that."""
        if self.sections and self.sections[-1][0] == line:
            self.source.jump(self.sections.pop()[1])


#: What a condition that never changes consists of, besides numbers.
_CONSTANT: Final = frozenset({"TRUE", "FALSE", "=", "==", "<", ">", "<>", "<=", ">=", "(", ")", "+", "-", "*", "/"})

Handler = Callable[[ExpressionReader, ActiveProgram, int], None]


class Flow:
    """Executes the keywords of control flow; a handler gets a reader at the token after the keyword, and the line."""

    def __init__(self, note: Note) -> None:
        self._note = note
        self.handlers: dict[str, Handler] = {
            "IF": self._if,
            "ELSE": self._else,
            "ENDIF": self._paired,
            "FOR": self._for,
            "ENDFOR": self._end_for,
            "WHILE": self._while,
            "ENDWHILE": self._end_while,
            "LOOP": self._paired,
            "ENDLOOP": self._end_loop,
            "REPEAT": self._repeat,
            "REPEATB": self._repeat_part,
            "UNTIL": self._until,
            "CASE": self._case,
            "DEF": self._def,
            "EXTERN": self._declare,
            **dict.fromkeys(("GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS"), self._goto),
        }

    def _paired(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        """Check that the keyword has its counterpart, and continue."""
        reader.expect_end()
        active.source.partner(line)

    def _declare(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        """Read the declaration of a subprogram in a file of its own: ``EXTERN CONT1(REAL, INT)``."""
        reader.at += 1
        if reader.accept("("):
            while reader.token is not None and not reader.accept(")"):
                reader.at += 1
        reader.expect_end()

    def _if(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        active.source.jumps_back = 0
        try:
            holds = bool(reader.number())
        except ExpressionError as error:
            self._note(Wording("NC143", "if", reason=error.wording), Severity.ERROR)
            while reader.token is not None and not reader.peek().startswith("GOTO"):
                reader.at += 1
            holds = False
        if reader.token is not None:
            word = reader.peek()
            if not word.startswith("GOTO"):
                raise ExpressionError(Wording("NC210", "jump_must_follow_condition"))
            self._goto_from(reader, active, line, taken=holds)
            return
        middle, end = active.source.partner(line)
        if not holds:
            active.source.jump((middle or end) + 1)

    def _else(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.expect_end()
        active.source.jump(active.source.partner(line)[1] + 1)

    def _while(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        end = active.source.partner(line)[1]
        if any(
            token.kind is not TokenKind.NUMBER and token.text not in _CONSTANT for token in reader.tokens[reader.at :]
        ):
            active.source.jumps_back = 0
        try:
            holds = bool(reader.number())
            reader.expect_end()
        except ExpressionError:
            active.source.jump(end + 1)
            raise
        if not holds:
            active.source.jump(end + 1)

    def _end_while(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.expect_end()
        active.source.jump_without_choice(active.source.partner(line)[1])

    def _end_loop(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.expect_end()
        active.source.jump_without_choice(active.source.partner(line)[1] + 1)

    def _repeat(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        if reader.token is not None:
            self._repeat_part(reader, active, line)
        else:
            active.source.partner(line)

    def _repeat_part(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        """Execute a part of the program again, n times, and go on behind this block.

        REPEAT LABEL P=n: from a label to the label ENDLABEL, or to here; REPEAT LABEL LAST P=n: to the block of LAST;
        REPEATB LABEL P=n: the block of the label alone.
        """
        one_block = reader.tokens[reader.at - 1].text == "REPEATB"
        names = []
        while (token := reader.token) is not None and token.kind is TokenKind.NAME:
            names.append(token.text.upper())
            reader.at += 1
        times = 1.0
        if reader.accept("P"):
            reader.expect("=")
            times = reader.number()
        active.source.load()
        wrong = not 1 <= len(names) <= 2 - one_block
        part = None if wrong else active.source.repeated_part(tuple(names), line, one_block=one_block)
        if reader.token is not None or part is None or times < 0.0 or times != int(times):
            raise ExpressionError(Wording("NC220", "repeating_part_program_labels_not"))
        done = active.repeated.pop(line, 0)
        if done < times:
            active.repeated[line] = done + 1
            active.source.jumps_back = 0
            active.sections.append((part[1], line))
            active.source.jump(part[0])

    def _until(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        begin = active.source.partner(line)[1]
        active.source.jumps_back = 0
        holds = reader.number()
        reader.expect_end()
        if not holds:
            active.source.jump(begin + 1)

    def _for(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        end = active.source.partner(line)[1]
        try:
            name, index = self._loop_variable(reader)
            reader.expect("=")
            value = reader.number()
            reader.expect("TO")
            last = reader.number()
            reader.expect_end()
        except ExpressionError:
            active.source.jump(end + 1)
            raise
        self._set(active, name, index, value)
        if value > last:
            active.source.jump(end + 1)

    def _end_for(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.expect_end()
        begin = active.source.partner(line)[1]
        active.source.jumps_back = 0
        head = self._loop_head(active, begin)
        name, index = self._loop_variable(head)
        head.expect("=")
        head.number()
        head.expect("TO")
        last = head.number()
        value = self._get(active, name, index) + 1.0
        self._set(active, name, index, value)
        active.source.jump(begin + 1 if value <= last else line + 1)

    def _loop_head(self, active: ActiveProgram, begin: int) -> ExpressionReader:
        """Return a reader at the loop variable of the FOR block of a line."""
        here = active.source.line
        active.source.jump(begin)
        statement, _ = split_comment(active.source.next_line())
        active.source.jump(here)
        tokens = tokenize(statement)
        at = next((k for k, token in enumerate(tokens) if token.text == "FOR"), len(tokens))
        return ExpressionReader(tokens, active.variables, at + 1)

    def _loop_variable(self, reader: ExpressionReader) -> tuple[str, tuple[int, ...]]:
        name = reader.peek()
        if not name or name == "=":
            raise ExpressionError(Wording("NC210", "needs_variable"))
        reader.at += 1
        token = reader.token
        if name == "R" and token is not None and token.kind is TokenKind.NUMBER:
            reader.at += 1
            return name, (int(min(token.value, 1e6)),)
        index = reader.index()
        if name == "R" and len(index) != 1:
            raise ExpressionError(Wording("NC210", "r_needs_number"))
        return name, index

    def _get(self, active: ActiveProgram, name: str, index: tuple[int, ...]) -> float:
        if name == "R":
            return active.variables.parameter(index[0])
        value = active.variables.variable(name, index)
        if isinstance(value, str):
            raise ExpressionError(Wording("NC210", "is_text", name=name))
        return value

    def _set(self, active: ActiveProgram, name: str, index: tuple[int, ...], value: float) -> None:
        if name == "R":
            active.variables.set_parameter(index[0], value)
        elif not active.variables.assign(name, index, value):
            self._note(Wording("NC223", "no_definition", name=name), Severity.ERROR)

    def _goto(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        reader.at -= 1
        self._goto_from(reader, active, line)

    def _goto_from(
        self, reader: ExpressionReader, active: ActiveProgram, line: int, *, taken: bool = True, is_last: bool = True
    ) -> None:
        """Execute the jump that comes next, unless it is not ``taken``; it is the last of its block, or may be."""
        word = reader.peek()
        reader.at += 1
        active.source.load()
        if word == "GOTOS":
            if is_last:
                reader.expect_end()
            if taken:
                active.source.jump_without_choice(1)
            return
        forward, backward = word in ("GOTO", "GOTOF", "GOTOC"), word in ("GOTO", "GOTOB", "GOTOC")
        target, found = self._target(reader, active, line, forward=forward, backward=backward)
        if is_last:
            reader.expect_end()
        if not taken:
            return
        if found is not None:
            active.source.jump_without_choice(found)
        elif word != "GOTOC":
            self._note(Wording("NC133", "missing_target", target=target, word=word), Severity.ERROR)
            raise ProgramEnd

    def _target(
        self, reader: ExpressionReader, active: ActiveProgram, line: int, *, forward: bool, backward: bool
    ) -> tuple[str, int | None]:
        token = reader.token
        if token is None:
            return "", None
        reader.at += 1
        following = reader.token
        if token.text == "N" and following is not None and following.text.isdigit():
            reader.at += 1
            number = int(min(following.value, 1e15))
            return f"N{number}", active.source.number(number, line, forward=forward, backward=backward)
        name = token.text.upper()
        if token.kind is TokenKind.NAME and token.text in active.variables:
            active.source.jumps_back = 0
            name = (active.variables.text(token.text) or "").upper()
        elif token.kind is TokenKind.NUMBER and token.text.isdigit():
            number = int(min(token.value, 1e15))
            return name, active.source.number(number, line, forward=forward, backward=backward)
        if re.fullmatch(r"N[0-9]{1,9}", name):
            return name, active.source.number(int(name[1:]), line, forward=forward, backward=backward)
        return name[:80], active.source.label(name, line, forward=forward, backward=backward)

    def _case(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        active.source.jumps_back = 0
        value = reader.number()
        reader.expect("OF")
        taken_at = -1
        while reader.token is not None:
            taken = reader.accept("DEFAULT") or reader.number() == value
            if not reader.peek().startswith("GOTO"):
                raise ExpressionError(Wording("NC210", "jump_must_follow_value"))
            if taken and taken_at < 0:
                taken_at = reader.at
            self._goto_from(reader, active, line, taken=False, is_last=False)
        if taken_at >= 0:
            reader.at = taken_at
            self._goto_from(reader, active, line, is_last=False)

    def _def(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        kind = reader.peek()
        while kind and kind not in TYPES and kind != ",":
            reader.at += 1
            kind = reader.peek()
        if kind not in TYPES:
            raise ExpressionError(Wording("NC210", "def_needs_type"))
        reader.at += 1
        if kind == "STRING":
            reader.index()
        while True:
            self._define(reader, active, kind, line)
            if reader.token is None:
                return
            reader.expect(",")

    def _define(self, reader: ExpressionReader, active: ActiveProgram, kind: str, line: int) -> None:
        name = reader.peek()
        token = reader.token
        if token is None or token.kind not in (TokenKind.NAME, TokenKind.LETTER):
            raise ExpressionError(Wording("NC210", "def_needs_name"))
        reader.at += 1
        number = reader.token
        if name == "R" and number is not None and number.kind is TokenKind.NUMBER:
            # R parameters need no declaration, but some programs have one.
            reader.at += 1
            value = reader.number() if reader.accept("=") else 0.0
            active.variables.set_parameter(int(min(number.value, 1e6)), value)
            return
        if token.kind is not TokenKind.NAME:
            raise ExpressionError(Wording("NC210", "not_name_variable", name=name))
        size = reader.index()
        active.variables.define(kind, name, place=(line, reader.at), size=size)
        if reader.accept("="):
            fields.define(reader, active.variables, name, self._note)

    def define_parameters(self, reader: ExpressionReader, active: ActiveProgram) -> None:
        """Define the parameters of the PROC line with the arguments of the call."""
        variables = active.variables
        handed = variables.arguments
        if any(token.text == "SAVE" for token in reader.tokens[reader.at :]):
            self._note(Wording("NC220", "save_g_words_come_back"), Severity.ERROR)
        reader.at += 1
        if not reader.accept("("):
            return
        place = 0
        while not reader.accept(")"):
            by_name = reader.accept("VAR")
            kind = reader.peek()
            reader.at += 1
            if kind == "STRING":
                reader.index()
            name = reader.peek()
            if kind not in TYPES or not name:
                raise ExpressionError(Wording("NC210", "parameter_type_name"))
            reader.at += 1
            if reader.peek() == "[":
                variables.take_field(kind, name, place, _bounds(reader), copies=not by_name)
            elif field := variables.named_field(place):
                raise ExpressionError(Wording("NC210", "parameter_is_value", name=name, given=field))
            else:
                default = reader.value() if reader.accept("=") else None
                given = handed[place] if place < len(handed) else None
                if given is None or not by_name or not variables.take_variable(kind, name, place):
                    variables.define(kind, name, default if given is None else given)
                    if by_name and given is not None:
                        fault = Wording(
                            "NC220", "variable_comes_back", name=name, given=variables.argument_texts[place]
                        )
                        self._note(fault, Severity.ERROR)
            place += 1
            reader.accept(",")
        if len(handed) > place:
            self._note(Wording("NC215", "too_many_arguments", given=len(handed), takes=place), Severity.ERROR)


def _bounds(reader: ExpressionReader) -> tuple[int | None, ...]:
    """Read the size of a field that is a parameter, as in ``[3]``, ``[]`` or ``[,]``; None where it is open."""
    reader.expect("[")
    found = list[int | None]()
    while True:
        found.append(None if reader.peek() in (",", "]") else reader.integer())
        if reader.accept("]"):
            return tuple(found)
        reader.expect(",")
