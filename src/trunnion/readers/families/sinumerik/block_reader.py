"""Reads blocks of a Sinumerik program: sorts their words and assigns variables; the interpreter does the rest."""

from collections.abc import Sequence
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.sinumerik import fields
from trunnion.readers.families.sinumerik.block import Block, Call
from trunnion.readers.families.sinumerik.expressions import OPERATORS, ExpressionError, ExpressionReader, Value, whole
from trunnion.readers.families.sinumerik.tokens import Token, TokenKind
from trunnion.readers.families.sinumerik.value_words import as_number, keep_value
from trunnion.readers.families.sinumerik.variables import Variables
from trunnion.readers.families.sinumerik.words import (
    ACTIVE,
    CORNER_FEEDS,
    CORNERS,
    FEED_GROUP,
    FLOW,
    FRAMES,
    G_NO_MOTION,
    NOT_SIMULATED,
    ORIENTATION,
    POSITION_MODES,
    TOOL_FRAMES,
    TYPES,
    WAITS,
    WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT_CALLS,
    WITHOUT_PATH_EFFECT_VALUES,
)

#: Higher feeds, in any unit, are mistakes of the program.
MAX_FEED: Final = 1e9

#: Words without a value that the interpreter executes.
_MODES: Final = (
    FRAMES
    | ORIENTATION
    | WITHOUT_PATH_EFFECT
    | TOOL_FRAMES
    | frozenset({"SUPA", "CIP", "CT", "POLY", "TRAFOOF", "TRAORI"})
)

#: Words with a value that belong to circles and frames.
_PARAMS: Final = frozenset({"CR", "TURN", "AR", "ANG", "RPL"})

#: Where a block holds the words of which it has one at most.
_HELD: Final = {"T": "tool", "S": "speed", "F": "feed", "D": "edge"}

#: The value of a word and its mode.
_Word = tuple[Value, PositionMode]


class BlockReader:
    """Reads the words of one block after another."""

    def __init__(self, rotary: tuple[str, ...], note: Note) -> None:
        self._axes = frozenset({"X", "Y", "Z", *rotary})
        self._note = note

    def read(self, tokens: tuple[Token, ...], at: int, variables: Variables) -> Block:
        """Read from a token on; at a word that is not understood, report it and ignore the rest of the block."""
        block = Block()
        reader = ExpressionReader(tokens, variables, at)
        while (token := reader.token) is not None:
            before = reader.at
            try:
                if token.kind is TokenKind.LETTER:
                    self._letter(reader, block, variables)
                elif token.kind is TokenKind.NAME:
                    self._name(reader, block, variables)
                else:
                    raise ExpressionError(Wording("NC210", "unexpected", token=token.text))
            except ExpressionError as error:
                self._note(error.wording.within("not_understood", text=_text(tokens, before)), Severity.ERROR)
                break
        return block

    # Letters

    def _letter(self, reader: ExpressionReader, block: Block, variables: Variables) -> None:
        letter = reader.peek()
        start = reader.at
        reader.at += 1
        plain = reader.plain_number()
        value: Value
        if plain is not None:
            name, extension, value, mode = letter, "", plain, PositionMode.MODAL
        else:
            extension = self._extension(reader)
            if letter == "R" and (extension or reader.peek() == "["):
                reader.at = start + 1
                self._parameter(reader, variables)
                return
            name = letter + extension
            value, mode = self._value(reader)
        if name in self._axes:
            self._axis(block, name, as_number(value), mode)
        elif isinstance(value, str) and name != "T":
            raise ExpressionError(Wording("NC210", "takes_number_not_text", name=name))
        else:
            self._address(reader, block, (letter, extension), (value, mode))

    def _extension(self, reader: ExpressionReader) -> str:
        """Read digits between a letter and an equals sign, as in A3= or S2=; returns them, or nothing."""
        token = reader.token
        if (
            token is not None
            and token.kind is TokenKind.NUMBER
            and token.text.isdigit()
            and len(token.text) <= 5
            and reader.peek(1) == "="
        ):
            reader.at += 1
            return token.text
        return ""

    def _parameter(self, reader: ExpressionReader, variables: Variables) -> None:
        if reader.peek() == "[":
            index = reader.index()
            if len(index) != 1:
                raise ExpressionError(Wording("NC210", "r_needs_number"))
            number = index[0]
        else:
            token = reader.token
            assert token is not None
            number = whole(token.value)
            reader.at += 1
        reader.expect("=")
        variables.set_parameter(number, reader.number())

    def _value(self, reader: ExpressionReader) -> _Word:
        """Read the value of a word: a number, or = and an expression, which may be in AC() or a similar function."""
        if reader.accept("="):
            mode = reader.peek()
            if mode in POSITION_MODES and reader.peek(1) == "(":
                reader.at += 2
                value = reader.number()
                reader.expect(")")
                return value, PositionMode(mode)
            return reader.value(), PositionMode.MODAL
        number = reader.plain_number()
        if number is None:
            raise ExpressionError(Wording("NC210", "number_missing"))
        return number, PositionMode.MODAL

    def _axis(self, block: Block, name: str, value: float, mode: PositionMode) -> None:
        self._once(name, name in block.axes)
        block.axes[name] = value, mode

    def _once(self, word: str, is_there: bool) -> None:
        """Report a word that its block has already: the control stops there (alarm 12010)."""
        if is_there:
            self._note(Wording("NC212", "twice_in_block", word=word), Severity.ERROR)

    def _address(self, reader: ExpressionReader, block: Block, address: tuple[str, str], word: _Word) -> None:
        """Execute a word that is no axis; ``address`` is its letter and the digits after it."""
        letter, extension = address
        value, mode = word
        master_spindle = extension in ("", "0", "1")
        if (extension == "" or (master_spindle and letter in "TS")) and (held := _HELD.get(letter)):
            self._once(letter, getattr(block, held) is not None)
        if letter == "T" and master_spindle:
            block.tool = value if isinstance(value, str) else f"{_code(as_number(value), 'T')}"
            return
        number = as_number(value)
        match address:
            case (("M" | "S"), _) if not master_spindle:
                # M2=3 and S2=100 address spindle 2; only the master spindle is simulated.
                text = f"M{extension}={_code(number, 'M')}" if letter == "M" else f"S{extension}="
                self._note(Wording("NC221", "speaks_another_spindle_not_followed", text=text), Severity.WARNING)
                block.said.append((letter, f"{extension}={number:g}"))
            case "G", "":
                block.g.append(_code(number, "G"))
            case "M", _:
                block.m.append(_code(number, "M"))
            case "S", _:
                if number < 0.0:
                    raise ExpressionError(Wording("NC215", "speed_below_zero"))
                block.speed = number
            case "F", "":
                if not 0.0 <= number <= MAX_FEED:
                    raise ExpressionError(Wording("NC215", "feed_out_of_range", most=MAX_FEED))
                block.feed = number
            case "D", "":
                block.edge = _code(number, "D")
            case "H", _:
                block.h.append(number)
            case (("I" | "J" | "K"), ("" | "1")):
                self._once(letter + extension, letter + extension in block.params)
                block.params[letter + extension] = number, mode
            case (("A" | "B" | "C"), "3"):
                self._once(f"{letter}3=", letter in block.vector)
                block.vector[letter] = number
            case (("A" | "B" | "C"), ("4" | "5")):
                pass  # Surface normals are for radius compensation, which is not simulated.
            case (("L" | "P"), ""):
                self._subprogram_word(reader, block, letter, number)
            case (("A" | "B" | "C" | "X" | "Y" | "Z" | "U" | "V" | "W"), _) if G_NO_MOTION.intersection(block.g):
                pass  # Those of G74 and G75 are the machine's own axes, as in X1=0.
            case (("A" | "B" | "C" | "X" | "Y" | "Z" | "U" | "V" | "W"), ""):
                self._note(Wording("NC230", "axis_value_not_executed", axis=letter, value=number), Severity.ERROR)
            case _:
                self._note(
                    Wording("NC211", "unknown_extended_word", letter=letter, extension=extension, number=number),
                    Severity.ERROR,
                )

    @staticmethod
    def _subprogram_word(reader: ExpressionReader, block: Block, letter: str, number: float) -> None:
        """Execute L, the number of a subprogram, or P, its repeats."""
        if letter == "L":
            digits = reader.tokens[reader.at - 1].text
            if not digits.isdigit():
                raise ExpressionError(Wording("NC210", "subprogram_whole_number"))
            block.calls.append(Call(f"L{digits}"))
            return
        if not block.calls:
            raise ExpressionError(Wording("NC210", "p_counts_nothing_here"))
        block.calls[-1].repeats = _code(number, "P")

    # Names

    def _name(self, reader: ExpressionReader, block: Block, variables: Variables) -> None:
        name = reader.peek()
        follows = reader.peek(1)
        reader.at += 1
        if name in self._axes and follows == "=":
            value, mode = self._value(reader)
            self._axis(block, name, as_number(value), mode)
        elif name in _PARAMS and follows == "=":
            value, mode = self._value(reader)
            block.params[name] = as_number(value), mode
        elif name in CORNERS | CORNER_FEEDS and follows == "=":
            self._once(name, name in block.corner)
            block.corner[name] = _size(as_number(self._value(reader)[0]), name)
        elif name == "PO" and follows == "[":
            self._polynomial(reader, block)
        elif name == "PL" and follows == "=":
            block.interval = as_number(self._value(reader)[0])
        elif name in WITHOUT_PATH_EFFECT_VALUES and follows in ("=", "["):
            axis = _skip(reader, "[", "]") if follows == "[" else ""
            if reader.accept("="):
                value = self._value(reader)[0]
                keep_value(block, name, value)
                block.said.append((name, f"{axis}={value}"))
        elif name == "SPOS" and follows in ("=", "["):
            self._spindle_position(reader, block)
        elif name in NOT_SIMULATED:
            self._subprograms(reader, name)
        elif follows in ("=", "["):
            self._assignment(reader, name, variables)
        elif name == "TRAORI":
            block.words.append(name)
            if follows == "(":
                block.traori = reader.arguments()
        elif name == FEED_GROUP and follows == "(":
            self._feed_group(reader)
        elif name in WITHOUT_PATH_EFFECT_CALLS and follows == "(":
            block.said.append((name, _skip(reader, "(", ")")))
            if name in WAITS:
                block.waits.append(name)
        elif name in _MODES:
            block.words.append(name)
        elif name in FLOW or name in TYPES or name in OPERATORS or name in POSITION_MODES:
            raise ExpressionError(Wording("NC210", "cannot_stand_here", name=name))
        elif name in ACTIVE and name not in ("MSG", "SETAL"):
            raise ExpressionError(Wording("NC210", "word_needs_value", word=name))
        else:
            block.calls.append(read_call(reader, name, variables))

    def _spindle_position(self, reader: ExpressionReader, block: Block) -> None:
        """Read where SPOS turns the spindle; another one is not followed."""
        spindle = _skip(reader, "[", "]") if reader.peek() == "[" else ""
        reader.expect("=")
        value = as_number(self._value(reader)[0])
        block.said.append(("SPOS", f"{spindle}={value:g}"))
        if spindle in ("", "[0]", "[1]"):
            block.words.append("SPOS")
        else:
            text = f"SPOS{spindle}="
            self._note(Wording("NC221", "speaks_another_spindle_not_followed", text=text), Severity.WARNING)

    @staticmethod
    def _feed_group(reader: ExpressionReader) -> None:
        """Read the axes that F counts for: none, which are those that it always counts for, or the slides."""
        reader.expect("(")
        start = reader.at
        axes = set()
        while not reader.accept(")"):
            axes.add(reader.peek())
            reader.at += 1
            if not reader.accept(",") and reader.peek() != ")":
                raise ExpressionError(Wording("NC210", "fgroup_takes_names_axes"))
        if axes and axes != {"X", "Y", "Z"}:
            axis_names = _text(reader.tokens, start, reader.at - 1)
            raise ExpressionError(Wording("NC220", "feed_group_not_simulated", axes=axis_names))

    @staticmethod
    def _polynomial(reader: ExpressionReader, block: Block) -> None:
        """Read the end and the coefficients of an axis: ``[X]=(end,a2,a3)``."""
        reader.expect("[")
        axis = "" if reader.peek() == "]" else reader.peek()
        reader.at += bool(axis)
        reader.expect("]")
        reader.expect("=")
        if reader.peek() != "(":
            raise ExpressionError(Wording("NC210", "po_takes_values_parentheses"))
        values = reader.arguments()
        if axis in block.polynomials or not values or any(value is None for value in values):
            raise ExpressionError(Wording("NC210", "po_takes_end_coefficients_once", axis=axis))
        block.polynomials[axis] = [as_number(value) for value in values if value is not None]

    def _subprograms(self, reader: ExpressionReader, name: str) -> None:
        """Read and report a word that is not simulated, with everything that belongs to it."""
        start = reader.at - 1
        if reader.peek() == "(":
            _skip(reader, "(", ")")
        elif reader.peek() == "[":
            _skip(reader, "[", "]")
        value = self._value(reader)[0] if reader.peek() == "=" else None
        if name == "TCARR" and value == 0.0:
            return
        self._note(
            Wording("NC220", "known_not_simulated", words=_text(reader.tokens, start, reader.at)), Severity.ERROR
        )

    def _assignment(self, reader: ExpressionReader, name: str, variables: Variables) -> None:
        if name.startswith("$"):
            raise ExpressionError(Wording("NC220", "system_variable_not_simulated", name=name))
        index = reader.index()
        reader.expect("=")
        if not fields.assign(reader, variables, name, index):
            self._note(Wording("NC223", "no_definition", name=name), Severity.ERROR)


def read_call(reader: ExpressionReader, name: str, variables: Variables) -> Call:
    """Read the arguments of a call, after its name; a whole field has no value."""
    if reader.peek() != "(":
        return Call(name)
    active = Call(name)
    reader.at += 1
    if reader.accept(")"):
        return active
    while True:
        start = reader.at
        if reader.peek() in (",", ")"):
            active.arguments.append(None)
        elif reader.peek(1) in (",", ")") and variables.size(reader.peek()):
            active.arguments.append(None)
            reader.at += 1
        else:
            active.arguments.append(reader.value())
        active.argument_texts.append(_text(reader.tokens, start, reader.at))
        if reader.accept(")"):
            return active
        reader.expect(",")


def _skip(reader: ExpressionReader, opening: str, closing: str) -> str:
    """Skip brackets and their contents; returns their text, without blanks."""
    start = reader.at
    reader.expect(opening)
    depth = 1
    while depth:
        if reader.token is None:
            raise ExpressionError(Wording("NC210", "closing_missing", closing=closing))
        depth += {opening: 1, closing: -1}.get(reader.peek(), 0)
        reader.at += 1
    return _text(reader.tokens, start, reader.at).replace(" ", "")


def _size(number: float, name: str) -> float:
    if not 0.0 <= number <= MAX_FEED:
        raise ExpressionError(Wording("NC215", "below_zero", word=name, value=number))
    return number


def _code(number: float, letter: str) -> int:
    if number != int(number) or not 0 <= number < 1e9:
        raise ExpressionError(Wording("NC210", "takes_whole_number", letter=letter))
    return int(number)


def _text(tokens: Sequence[Token], start: int, end: int | None = None) -> str:
    """Return the text of tokens, shortened."""
    parts = [f'"{t.text}"' if t.kind is TokenKind.TEXT else t.text for t in tokens[start:end]]
    text = " ".join(parts) if len(parts) < 20 else " ".join(parts[:20]) + " ..."
    return text[:200]
