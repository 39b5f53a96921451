"""A line of RS274/NGC: its comments, its words with their values worked out, and what it sets."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

#: The longest line; the control itself stops at 256 characters.
LONGEST: Final = 4096

#: Brackets inside each other.
DEEPEST: Final = 40

#: Numbered parameters of the program; those above belong to the control.
HIGHEST: Final = 5000

#: Named parameters that a program may have.
MOST: Final = 10_000

_NUMBER = re.compile(r"[0-9]+\.?[0-9]*|\.[0-9]+")
_NAME = re.compile(r"[A-Z]+")
_OPERATOR = re.compile(r"\*\*|[-+*/]|MOD|EQ|NE|GE|GT|LE|LT|AND|OR|XOR")
_MOST_DIGITS: Final = 40


class BlockError(Exception):
    """Why a block is not understood, in words."""


@dataclass(slots=True)
class Block:
    """What a line says: G words by ten times their number, M words, other words by letter, parameters to set."""

    number: int = -1
    g: list[int] = field(default_factory=list)
    m: list[int] = field(default_factory=list)
    words: dict[str, float] = field(default_factory=dict)
    sets: list[tuple[str, float]] = field(default_factory=list)


class Parameters:
    """Numbered parameters, 0 where nobody set them, and named ones."""

    def __init__(self) -> None:
        self._values: dict[str, float] = {}

    def __getitem__(self, name: str) -> float:
        if name.isdigit():
            if not 1 <= int(name) <= HIGHEST:
                raise BlockError(f"#{name} is known to the control alone")
            return self._values.get(name, 0.0)
        if name not in self._values:
            raise BlockError(f"#<{name.lower()}> has no value that the program says")
        return self._values[name]

    def __setitem__(self, name: str, value: float) -> None:
        if name.isdigit() and not 1 <= int(name) <= HIGHEST:
            raise BlockError(f"#{name} belongs to the control")
        if len(self._values) >= HIGHEST + MOST:
            raise BlockError("the program has too many parameters")
        self._values[name] = value


def split_comments(line: str) -> tuple[str, list[str]]:
    """Return the code of a line in capitals and without blanks, and its comments.

    Raises
    ------
    BlockError
        If a parenthesis is not closed.
    """
    if "(" not in line and ";" not in line and ")" not in line:
        return "".join(line.upper().split()), []
    code: list[str] = []
    comments: list[str] = []
    at = 0
    while at < len(line):
        match = re.compile(r"[(;)]").search(line, at)
        if match is None:
            code.append(line[at:])
            break
        code.append(line[at : match.start()])
        if match.group() == ";":
            comments.append(line[match.end() :])
            break
        end = line.find(")", match.end())
        if match.group() == ")" or end < 0:
            raise BlockError("a parenthesis opens or closes no comment")
        comments.append(line[match.end() : end])
        at = end + 1
    return "".join("".join(code).upper().split()), comments


def read_block(code: str, parameters: Parameters) -> Block:
    """Read the words of a line, which has no blanks and no comments.

    Raises
    ------
    BlockError
        At what is not understood; nothing of the line has had an effect.
    """
    block = Block()
    reader = _Reader(code, parameters)
    number = re.match(r"N([0-9]{1,15})(?:\.[0-9]*)?", code)
    if number:
        block.number, reader.at = int(number[1]), number.end()
    while reader.at < len(code):
        letter = code[reader.at]
        reader.at += 1
        if letter == "#":
            name = reader.name_of_parameter()
            reader.expect("=")
            block.sets.append((name, reader.value()))
        elif not letter.isalpha():
            raise BlockError(f"{code[reader.at - 1 : reader.at + 19]} is no word")
        else:
            _put(block, letter, reader.value())
    return block


def _put(block: Block, letter: str, value: float) -> None:
    if letter == "G":
        code = round(10.0 * value)
        if not 0 <= code < 10_000 or abs(code - 10.0 * value) > 1e-6:
            raise BlockError(f"G{value:g} is no word")
        block.g.append(code)
    elif letter == "M":
        if value != int(value) or not 0 <= value < 1000:
            raise BlockError(f"M{value:g} is no word")
        block.m.append(int(value))
    elif letter in block.words:
        raise BlockError(f"{letter} is written twice")
    else:
        block.words[letter] = value


def _of_degrees(work: Callable[[float], float]) -> Callable[[float], float]:
    return lambda x: work(math.radians(x))


_FUNCTIONS: Final[dict[str, Callable[[float], float]]] = {
    "ABS": abs,
    "ACOS": lambda x: math.degrees(math.acos(x)),
    "ASIN": lambda x: math.degrees(math.asin(x)),
    "COS": _of_degrees(math.cos),
    "EXP": math.exp,
    "FIX": lambda x: float(math.floor(x)),
    "FUP": lambda x: float(math.ceil(x)),
    "LN": math.log,
    "ROUND": lambda x: float(math.floor(x + 0.5)),
    "SIN": _of_degrees(math.sin),
    "SQRT": math.sqrt,
    "TAN": _of_degrees(math.tan),
}

#: Operators from tight to loose; those of one row from left to right.
_LEVELS: Final[tuple[dict[str, Callable[[float, float], float]], ...]] = (
    {"**": math.pow},
    {"*": lambda a, b: a * b, "/": lambda a, b: a / b, "MOD": lambda a, b: a - b * math.floor(a / b)},
    {"+": lambda a, b: a + b, "-": lambda a, b: a - b},
    {
        "EQ": lambda a, b: float(a == b), "NE": lambda a, b: float(a != b), "GT": lambda a, b: float(a > b),
        "GE": lambda a, b: float(a >= b), "LT": lambda a, b: float(a < b), "LE": lambda a, b: float(a <= b),
    },
    {
        "AND": lambda a, b: float(bool(a) and bool(b)), "OR": lambda a, b: float(bool(a) or bool(b)),
        "XOR": lambda a, b: float(bool(a) != bool(b)),
    },
)  # fmt: skip


class _Reader:
    """Values of a line, from a place on."""

    def __init__(self, code: str, parameters: Parameters) -> None:
        self.code = code
        self.at = 0
        self._parameters = parameters
        self._depth = 0

    def expect(self, text: str) -> None:
        if not self.code.startswith(text, self.at):
            raise BlockError(f"{text} is missing")
        self.at += len(text)

    def value(self) -> float:
        """A number, a parameter, a function or an expression in brackets."""
        self._depth += 1
        if self._depth > DEEPEST:
            raise BlockError(f"nests deeper than {DEEPEST} levels")
        try:
            found = self._value()
        except (ValueError, OverflowError, ZeroDivisionError):
            raise BlockError("a function has no value here") from None
        finally:
            self._depth -= 1
        if not abs(found) < 1e15:
            raise BlockError("a value is larger than any machine needs")
        return found

    def _value(self) -> float:
        sign = 1.0
        if self.code[self.at : self.at + 1] in ("+", "-"):
            sign = -1.0 if self.code[self.at] == "-" else 1.0
            self.at += 1
        number = _NUMBER.match(self.code, self.at)
        if number:
            self.at = number.end()
            if len(number.group()) > _MOST_DIGITS:
                raise BlockError(f"a number has more than {_MOST_DIGITS} digits")
            return sign * float(number.group())
        if self.code.startswith("[", self.at):
            self.at += 1
            found = self._expression(len(_LEVELS) - 1)
            self.expect("]")
            return sign * found
        if self.code.startswith("#", self.at):
            self.at += 1
            return sign * self._parameters[self.name_of_parameter()]
        name = _NAME.match(self.code, self.at)
        if name is None or not self.code.startswith("[", name.end()):
            raise BlockError("a value is missing")
        self.at = name.end()
        argument = self.value()
        if name.group() == "ATAN":
            self.expect("/")
            return sign * math.degrees(math.atan2(argument, self.value()))
        if name.group() not in _FUNCTIONS:
            raise BlockError(f"{name.group()} is no function")
        return sign * _FUNCTIONS[name.group()](argument)

    def name_of_parameter(self) -> str:
        """What stands behind #: a number, <name>, or a value that is the number."""
        if self.code.startswith("<", self.at):
            end = self.code.find(">", self.at)
            if end < 0 or end - self.at > 100:
                raise BlockError("> is missing")
            name = self.code[self.at + 1 : end]
            self.at = end + 1
            if not name or name.isdigit():
                raise BlockError(f"<{name}> is no name")
            return name
        number = self.value()
        if number != int(number) or number < 0.0:
            raise BlockError(f"#{number:g} is no parameter")
        return str(int(number))

    def _expression(self, level: int) -> float:
        if level < 0:
            return self.value()
        found = self._expression(level - 1)
        while True:
            operator = _OPERATOR.match(self.code, self.at)
            if operator is None or operator.group() not in _LEVELS[level]:
                return found
            self.at = operator.end()
            found = _LEVELS[level][operator.group()](found, self._expression(level - 1))
