"""Expressions of languages of the RS274 kind: numbers, ``#`` parameters, and arithmetic in square brackets.

Expressions are evaluated while they are read, by recursive descent. Their nesting is limited, so that no program can
exhaust the stack. A value may be None: that of an unset parameter, in languages that distinguish it from 0.
"""

import math
import operator
import re
from collections.abc import Callable, Collection, Mapping
from functools import cache
from typing import Final, Protocol

from trunnion.messages import Wording
from trunnion.readers.control.worded_error import WordedError
from trunnion.records import dataclass

#: How deep brackets and signs may nest.
MAX_NESTING: Final = 40

#: Larger numbers are mistakes of the program.
MAX_VALUE: Final = 1e300

_NUMBER = re.compile(r"[0-9]+\.?[0-9]*|\.[0-9]+")
_NAME = re.compile(r"<([^<>#\[\]]{1,80})>")

#: What a number without a sign begins with.
_FIGURES: Final = frozenset("0123456789.")

Value = float | None


class BlockError(WordedError):
    """The reason why a block is not executed."""


class Parameters(Protocol):
    """Where expressions look up parameters."""

    def value(self, key: int | str) -> Value:
        """Return the value of a parameter by number or name, or raise BlockError."""
        ...

    def is_set(self, key: int | str) -> bool:
        """Whether a parameter has a value."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Arithmetic:
    """The operations of a language; one without any takes nothing but numbers.

    levels                    binary operators by precedence, lowest first
    operators                 what each operator does with two numbers
    functions                 functions of one number in brackets
    pairs                     functions of two numbers, ``NAME[a]/[b]`` or ``NAME[a,b]``
    assigns_without_brackets  the right side of an assignment may be an expression without brackets
    compare_unset             evaluates a comparison with an unset value, None for other operators
    asks_for_parameters       ``EXISTS[#<name>]`` asks whether a parameter is there
    one_sign                  a value with two signs is an alarm
    """

    levels: tuple[tuple[str, ...], ...]
    operators: Mapping[str, Callable[[float, float], float]]
    functions: Mapping[str, Callable[[float], float]]
    pairs: Mapping[str, Callable[[float, float], float]]
    assigns_without_brackets: bool = False
    compare_unset: Callable[[str, Value, Value], float | None] | None = None
    asks_for_parameters: bool = False
    one_sign: bool = False


#: What a language has that knows no expressions.
NO_ARITHMETIC: Final = Arithmetic(levels=(), operators={}, functions={}, pairs={})


class ExpressionReader:
    """Reads a block, in capitals and without blanks, from a position on; evaluates its expressions."""

    def __init__(self, text: str, arithmetic: Arithmetic, parameters: Parameters) -> None:
        self.text = text
        self.at = 0
        self._arithmetic = arithmetic
        self._parameters = parameters
        self._depth = 0

    @property
    def ended(self) -> bool:
        """Whether the block is read to its end."""
        return self.at >= len(self.text)

    @property
    def rest(self) -> str:
        """The rest of the block, cut short for messages."""
        return self.text[self.at : self.at + 40]

    def accept(self, text: str) -> bool:
        """Read a text if it comes next."""
        if self.text.startswith(text, self.at):
            self.at += len(text)
            return True
        return False

    def expect(self, text: str) -> None:
        """Read a text that must come next."""
        if not self.accept(text):
            raise BlockError(
                Wording("NC210", "missing_before", expected=text, rest=repr(self.rest))
                if self.rest
                else Wording("NC210", "missing_at_end", expected=text)
            )

    def letter(self) -> str:
        """Read one character."""
        self.at += 1
        return self.text[self.at - 1]

    def number(self) -> tuple[float, bool]:
        """Read a number; returns it, and whether it is written without a point."""
        match = _NUMBER.match(self.text, self.at)
        if match is None:
            raise BlockError(
                Wording("NC210", "number_missing_before", rest=repr(self.rest))
                if self.rest
                else Wording("NC210", "number_missing_at_end")
            )
        self.at = match.end()
        value = float(match.group())
        if value > MAX_VALUE:
            raise BlockError(Wording("NC215", "number_too_large"))
        return value, "." not in match.group()

    def _behind_sign(self) -> tuple[Value, bool]:
        """Read a value behind a sign."""
        if self._arithmetic.one_sign and self.text[self.at : self.at + 1] in ("+", "-"):
            raise BlockError(Wording("NC210", "number_missing_before", rest=repr(self.rest)))
        return self.signed_value()

    def signed_value(self) -> tuple[Value, bool]:
        """Read the value of a word; returns it, and whether it is a number without a point."""
        if self.text[self.at : self.at + 1] in _FIGURES:
            return self.number()
        if self._arithmetic is NO_ARITHMETIC:
            return self._plain_number()
        self._deeper()
        try:
            if self.accept("-"):
                value, whole = self._behind_sign()
                return (None if value is None else -value), whole
            if self.accept("+"):
                return self._behind_sign()
            if self.text.startswith("[", self.at):
                return self.bracket(), False
            if self.accept("#"):
                return self._parameters.value(self.parameter_key()), False
            name = self._function()
            if name:
                return self._call(name), False
            return self.number()
        finally:
            self._depth -= 1

    def _plain_number(self) -> tuple[Value, bool]:
        """Read a number with its sign, in a language that has no other values."""
        sign = -1.0 if self.accept("-") else 1.0
        if sign > 0.0:
            self.accept("+")
        if self.rest[:1] in ("[", "#"):
            raise BlockError(Wording("NC220", "parameters_not_simulated"))
        value, whole = self.number()
        return sign * value, whole

    def parameter_key(self) -> int | str:
        """Read the number or name of a parameter, after its ``#``."""
        match = _NAME.match(self.text, self.at)
        if match is not None:
            self.at = match.end()
            return match.group(1)
        value, _ = self.signed_value()
        if value is None or abs(value - round(value)) > 1e-4 or not 0 <= round(value) < 10_000_000:
            raise BlockError(Wording("NC210", "parameter_needs_whole_number"))
        return round(value)

    def bracket(self) -> Value:
        """Read an expression in square brackets."""
        self.expect("[")
        value = self._level(0)
        self.expect("]")
        return value

    def assigned_value(self) -> Value:
        """Read the equals sign of an assignment and the value after it."""
        self.expect("=")
        return self._level(0) if self._arithmetic.assigns_without_brackets else self.signed_value()[0]

    def bracket_value(self) -> float:
        """Read an expression in square brackets; an unset value counts as 0."""
        return _or_zero(self.bracket())

    def _level(self, level: int) -> Value:
        """Read an expression of operators that bind at least as closely as those of a level."""
        left = self.signed_value()[0]
        operators, levels = _operators(self._arithmetic)
        while (match := operators.match(self.text, self.at)) is not None:
            symbol = match.group()
            own = levels[symbol]
            if own < level:
                break
            self.at = match.end()
            left = self._apply(symbol, left, self._level(own + 1))
        return left

    def _apply(self, symbol: str, left: Value, right: Value) -> float:
        compare = self._arithmetic.compare_unset
        if compare is not None:
            answer = compare(symbol, left, right)
            if answer is not None:
                return answer
        return _evaluate(lambda: self._arithmetic.operators[symbol](_or_zero(left), _or_zero(right)), symbol)

    def _function(self) -> str:
        match = _functions(self._arithmetic).match(self.text, self.at)
        if match is None:
            return ""
        self.at = match.end()
        return match.group()

    def _call(self, name: str) -> float:
        if name == "EXISTS":
            self.expect("[")
            self.expect("#")
            key = self.parameter_key()
            self.expect("]")
            return 1.0 if self._parameters.is_set(key) else 0.0
        pairs = self._arithmetic.pairs
        if name not in pairs:
            value = self.bracket_value()
            return _evaluate(lambda: self._arithmetic.functions[name](value), name)
        self.expect("[")
        first = _or_zero(self._level(0))
        if self.accept(","):
            second = _or_zero(self._level(0))
            self.expect("]")
        else:
            self.expect("]")
            self.expect("/")
            second = self.bracket_value()
        return _evaluate(lambda: pairs[name](first, second), name)

    def _deeper(self) -> None:
        self._depth += 1
        if self._depth > MAX_NESTING:
            raise BlockError(Wording("NC210", "expressions_too_deep", most=MAX_NESTING))


@cache
def _operators(arithmetic: Arithmetic) -> tuple[re.Pattern[str], dict[str, int]]:
    """Return what finds the next operator, and the level of each; ``*`` is not half of ``**``."""
    levels = {name: level for level, names in enumerate(arithmetic.levels) for name in names}
    return _any_of(levels), levels


@cache
def _functions(arithmetic: Arithmetic) -> re.Pattern[str]:
    """Return what finds the name of a function."""
    asking = ("EXISTS",) if arithmetic.asks_for_parameters else ()
    return _any_of((*arithmetic.functions, *arithmetic.pairs, *asking))


def _any_of(names: Collection[str]) -> re.Pattern[str]:
    """Return what finds the longest of the names that come next; nothing where a language has none."""
    return re.compile("|".join(re.escape(name) for name in sorted(names, key=len, reverse=True)) or "(?!)")


def _or_zero(value: Value) -> float:
    return 0.0 if value is None else value


def _evaluate(operation: Callable[[], float], name: str) -> float:
    """Evaluate an operation; BlockError if it has no finite value."""
    try:
        value = operation()
    except (ValueError, OverflowError, ZeroDivisionError):
        raise BlockError(Wording("NC215", "no_value_here", name=name)) from None
    if isinstance(value, complex) or not abs(value) <= MAX_VALUE:
        raise BlockError(Wording("NC215", "no_value_here", name=name))
    return float(value)


def round_half_away(value: float) -> float:
    """Round to a whole number; halves away from zero."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


#: Operators that all these languages share; comparisons give 1 or 0.
COMMON_OPERATORS: Final[Mapping[str, Callable[[float, float], float]]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "GT": lambda a, b: float(a > b),
    "GE": lambda a, b: float(a >= b),
    "LT": lambda a, b: float(a < b),
    "LE": lambda a, b: float(a <= b),
}

#: Functions that all these languages share; angles in degrees.
COMMON_FUNCTIONS: Final[Mapping[str, Callable[[float], float]]] = {
    "ABS": abs,
    "ACOS": lambda a: math.degrees(math.acos(a)),
    "ASIN": lambda a: math.degrees(math.asin(a)),
    "COS": lambda a: math.cos(math.radians(a)),
    "EXP": math.exp,
    "LN": math.log,
    "ROUND": round_half_away,
    "SIN": lambda a: math.sin(math.radians(a)),
    "SQRT": math.sqrt,
    "TAN": lambda a: math.tan(math.radians(a)),
}
