"""Q parameters, and formulas."""

import math
import re
from collections.abc import Callable
from functools import partial
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.worded_error import WordedError
from trunnion.readers.program.declared_variables import NOTHING_DECLARED, DeclaredVariables

#: How deep parentheses and signs may nest.
MAX_NESTING: Final = 40

#: Parameters can have no larger values.
MAX_VALUE: Final = 1e10

_TOKEN = re.compile(r"[ \t]*(?:(Q[LR]?[0-9]{1,4})|([0-9]+[.,]?[0-9]*|[.,][0-9]+)|([A-Z]+)|([-+*/^%()]))")


class KlartextError(WordedError):
    """The reason why a block is not executed."""


class Parameters:
    """The parameters of a program: Q and QR are shared by all programs, QL are local to each.

    declared   the values that the definition declares
    """

    def __init__(self, declared: DeclaredVariables = NOTHING_DECLARED, shared: "Parameters | None" = None) -> None:
        self.declared = declared
        self._forgotten: set[str] = set() if shared is None else shared._forgotten
        self._values: dict[str, float] = {} if shared is None else shared._values
        self._local: dict[str, float] = {}

    def _table(self, name: str) -> dict[str, float]:
        return self._local if name.startswith("QL") else self._values

    def get(self, name: str) -> float | None:
        """Return the value of a parameter, None if it is not known."""
        value = self._table(name).get(name)
        return value if value is not None or name in self._forgotten else self.declared.get(name)

    def __getitem__(self, name: str) -> float:
        value = self.get(name)
        if value is None:
            raise KlartextError(Wording("NC223", "no_value_in_program", name=name))
        return value

    def __setitem__(self, name: str, value: float) -> None:
        self._table(name)[name] = checked(value)
        self.declared.set(name, value, outlives=name.startswith("QR"))

    def forget(self, name: str) -> None:
        """Mark the value of a parameter as not known."""
        self._table(name).pop(name, None)
        if name in self.declared:
            self._forgotten.add(name)


def checked(value: float) -> float:
    """Return a value that a parameter can have; KlartextError for others."""
    if not abs(value) <= MAX_VALUE:
        raise KlartextError(Wording("NC215", "value_too_large"))
    return value


def canonical(name: str) -> str:
    """Return the name of a parameter without leading zeros."""
    letter_table = name.rstrip("0123456789")
    return f"{letter_table}{int(name[len(letter_table) :])}"


def _power_of(base: float, exponent: float) -> float:
    if base < 0.0 and exponent != int(exponent):
        raise ValueError
    return math.pow(base, exponent)


def _tangent(x: float) -> float:
    if math.isclose(math.cos(math.radians(x)), 0.0, abs_tol=1e-12):
        raise KlartextError(Wording("NC210", "infinite_tangent", angle=x))
    return math.tan(math.radians(x))


#: Functions of one value; angles in degrees.
FUNCTIONS: Final[dict[str, Callable[[float], float]]] = {
    "SIN": lambda x: math.sin(math.radians(x)),
    "COS": lambda x: math.cos(math.radians(x)),
    "TAN": _tangent,
    "ASIN": lambda x: math.degrees(math.asin(x)),
    "ACOS": lambda x: math.degrees(math.acos(x)),
    "ATAN": lambda x: math.degrees(math.atan(x)),
    "SQRT": math.sqrt,
    "SQ": lambda x: x * x,
    "LN": math.log,
    "LOG": math.log10,
    "EXP": math.exp,
    "NEG": lambda x: -x,
    "INT": lambda x: float(math.trunc(x)),
    "FRAC": lambda x: x - math.trunc(x),
    "ABS": abs,
    "SGN": lambda x: float((x > 0.0) - (x < 0.0)),
}


def formula(text: str, parameters: Parameters) -> float:
    """Evaluate a formula, such as ``SQ 3 + (Q2 - 4) ^ 2``.

    Powers come first, then multiplication and division, then addition. A function applies to the value after it.
    """
    parser = _Parser(text, parameters)
    value = parser.sum()
    if parser.token is not None:
        raise KlartextError(Wording("NC210", "nothing_may_follow", token=parser.token[:20]))
    return checked(value)


class _Parser:
    """Evaluates a formula while it reads it, by recursive descent."""

    def __init__(self, text: str, parameters: Parameters) -> None:
        self._tokens: list[str] = []
        at = 0
        text = text.rstrip()
        while at < len(text):
            match = _TOKEN.match(text, at)
            if match is None:
                raise KlartextError(Wording("NC210", "no_part_of_formula", found=text[at : at + 20].strip()))
            self._tokens.append(match.group().strip())
            at = match.end()
        self._at = 0
        self._depth = 0
        self._parameters = parameters

    @property
    def token(self) -> str | None:
        return self._tokens[self._at] if self._at < len(self._tokens) else None

    def _take(self) -> str:
        token = self.token
        if token is None:
            raise KlartextError(Wording("NC210", "value_missing"))
        self._at += 1
        return token

    def sum(self) -> float:
        value = self._product()
        while self.token in ("+", "-"):
            value = checked(value + self._product() if self._take() == "+" else value - self._product())
        return value

    def _product(self) -> float:
        value = self._power()
        while self.token in ("*", "/", "%"):
            operator, other = self._take(), self._power()
            if operator == "*":
                value = checked(value * other)
            elif other == 0.0:
                raise KlartextError(Wording("NC210", "divides_zero"))
            else:
                value = checked(value / other) if operator == "/" else math.fmod(value, other)
        return value

    def _power(self) -> float:
        value = self._factor()
        while self.token == "^":
            self._take()
            exponent = self._factor()
            value = guarded(partial(_power_of, value, exponent), "^")
        return value

    def _factor(self) -> float:
        self._depth += 1
        if self._depth > MAX_NESTING:
            raise KlartextError(Wording("NC210", "nests_too_deep", most=MAX_NESTING))
        try:
            return self._value(self._take())
        finally:
            self._depth -= 1

    def _value(self, token: str) -> float:
        if token in ("+", "-"):
            return self._factor() if token == "+" else -self._factor()
        if token == "(":
            value = self.sum()
            if self._take() != ")":
                raise KlartextError(Wording("NC210", "parenthesis_not_closed"))
            return value
        if token == "PI":
            return math.pi
        if token in FUNCTIONS:
            argument = self._factor()
            return guarded(lambda: FUNCTIONS[token](argument), token)
        if token[0] == "Q" and token[-1].isdigit():
            return self._parameters[canonical(token)]
        if token[0].isdigit() or token[0] in ".,":
            return checked(float(token.replace(",", ".")))
        raise KlartextError(Wording("NC210", "no_part_of_formula", found=token[:20]))


def guarded(function: Callable[[], float], name: str) -> float:
    """Evaluate a function; KlartextError if it has no value."""
    try:
        return checked(function())
    except (ValueError, OverflowError, ZeroDivisionError):
        raise KlartextError(Wording("NC215", "no_value_here", name=name)) from None
