"""Expressions of a Sinumerik: numbers, texts, comparisons, functions, R parameters and variables.

Expressions are evaluated while they are read, by recursive descent. Their nesting is limited, so that no program can
exhaust the stack. The precedence of operators is the control's: comparisons come last.
"""

import math
from collections.abc import Callable, Sequence
from typing import Final, Protocol

from trunnion.messages import Wording
from trunnion.readers.control.worded_error import WordedError
from trunnion.readers.families.sinumerik.tokens import Token, TokenKind

Value = float | str

#: How deep parentheses and signs may nest.
MAX_NESTING: Final = 40

#: The longest text that a concatenation may give.
MAX_TEXT_LENGTH: Final = 1000

#: Larger numbers are mistakes of the program.
MAX_VALUE: Final = 1e300


class ExpressionError(WordedError):
    """The reason why an expression has no value."""


class Names(Protocol):
    """Where expressions look up variables."""

    def variable(self, name: str, index: tuple[int, ...]) -> Value:
        """Return the value of a variable, or raise ExpressionError."""
        ...

    def parameter(self, number: int) -> float:
        """Return the value of an R parameter."""
        ...


#: Binary operators by precedence, lowest first.
_LEVELS: Final[tuple[frozenset[str], ...]] = (
    frozenset({"==", "<>", "<", ">", "<=", ">="}),
    frozenset({"<<"}),
    frozenset({"OR"}),
    frozenset({"XOR"}),
    frozenset({"AND"}),
    frozenset({"B_OR"}),
    frozenset({"B_XOR"}),
    frozenset({"B_AND"}),
    frozenset({"+", "-"}),
    frozenset({"*", "/", "DIV", "MOD"}),
)

#: Tokens that are known by their text.
_WRITTEN: Final = frozenset({TokenKind.SIGN, TokenKind.NAME, TokenKind.LETTER})

#: The level of each operator.
_LEVEL_OF: Final = {operator: level for level, names in enumerate(_LEVELS) for operator in names}

#: Names of operators, which are no variables.
OPERATORS: Final = frozenset({"DIV", "MOD", "AND", "OR", "XOR", "NOT", "B_AND", "B_OR", "B_XOR", "B_NOT"})


def _round(value: float) -> float:
    """Round to a whole number; halves away from zero, as the control does."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


def _atan2(y: float, x: float) -> float:
    return math.degrees(math.atan2(y, x))


#: Functions by name: the number of arguments, and the function; angles in degrees.
FUNCTIONS: Final[dict[str, tuple[int, Callable[..., float]]]] = {
    "SIN": (1, lambda a: math.sin(math.radians(a))),
    "COS": (1, lambda a: math.cos(math.radians(a))),
    "TAN": (1, lambda a: math.tan(math.radians(a))),
    "ASIN": (1, lambda a: math.degrees(math.asin(a))),
    "ACOS": (1, lambda a: math.degrees(math.acos(a))),
    "ATAN2": (2, _atan2),
    "SQRT": (1, math.sqrt),
    "ABS": (1, abs),
    "POT": (1, lambda a: a * a),
    "TRUNC": (1, math.trunc),
    "ROUND": (1, _round),
    "ROUNDUP": (1, math.ceil),
    "LN": (1, math.log),
    "EXP": (1, math.exp),
    "MINVAL": (2, min),
    "MAXVAL": (2, max),
    "BOUND": (3, lambda low, high, value: min(max(value, low), high)),
}


class ExpressionReader:
    """Reads tokens from a position on, and evaluates expressions."""

    def __init__(self, tokens: Sequence[Token], names: Names, at: int = 0) -> None:
        self.tokens = tokens
        self.names = names
        self.at = at
        self._depth = 0

    @property
    def token(self) -> Token | None:
        """The next token, None at the end."""
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def peek(self, ahead: int = 0) -> str:
        """Return the text of a sign, name or letter ahead; empty for anything else."""
        at = self.at + ahead
        if at >= len(self.tokens):
            return ""
        token = self.tokens[at]
        return token.text if token.kind in _WRITTEN else ""

    def accept(self, text: str) -> bool:
        """Read a sign or name if it comes next."""
        if self.peek() == text:
            self.at += 1
            return True
        return False

    def plain_number(self) -> float | None:
        """Read a number, or one with a sign, that is the value of the letter before it.

        None if something else follows, which is not read: digits before an equals sign belong to the name of a word.
        """
        tokens, at, sign = self.tokens, self.at, 1.0
        if at < len(tokens) and tokens[at].kind is TokenKind.SIGN and tokens[at].text in ("-", "+"):
            sign = -1.0 if tokens[at].text == "-" else 1.0
            at += 1
        if at >= len(tokens) or tokens[at].kind is not TokenKind.NUMBER:
            return None
        if at + 1 < len(tokens) and tokens[at + 1].text == "=":
            return None
        self.at = at + 1
        return sign * tokens[at].value

    def expect(self, text: str) -> None:
        """Read a sign that must come next."""
        if not self.accept(text):
            found = self.token
            raise ExpressionError(
                Wording("NC210", "expected_found", expected=text, found=found.text if found else "the end of the block")
            )

    def expect_end(self) -> None:
        """Refuse further words: none of them would be executed."""
        if self.token is not None:
            words = " ".join(token.text for token in self.tokens[self.at : self.at + 20])[:200]
            raise ExpressionError(Wording("NC212", "behind_statement", words=words))

    def number(self) -> float:
        """Read an expression whose value must be a number."""
        value = self.value()
        if isinstance(value, str):
            raise ExpressionError(Wording("NC210", "text_for_number", value=value[:40]))
        return value

    def integer(self) -> int:
        """Read an expression whose value must be a whole number."""
        return whole(self.number())

    def value(self) -> Value:
        """Read an expression."""
        return self._binary(0)

    def arguments(self) -> list[Value | None]:
        """Read arguments as in ``(a, , b)``; omitted ones are None."""
        values: list[Value | None] = []
        self.expect("(")
        if self.accept(")"):
            return values
        while True:
            values.append(None if self.peek() in (",", ")") else self.value())
            if self.accept(")"):
                return values
            self.expect(",")

    def index(self) -> tuple[int, ...]:
        """Read an index as in ``[i]`` or ``[i, j]`` if it comes next."""
        if not self.accept("["):
            return ()
        found = [self.integer()]
        while self.accept(","):
            found.append(self.integer())
        self.expect("]")
        return tuple(found)

    def _binary(self, level: int) -> Value:
        """Read an expression of operators that bind at least as closely as those of a level."""
        left = self._unary()
        while (own := _LEVEL_OF.get(operator := self.peek(), -1)) >= level:
            self.at += 1
            left = _apply(operator, left, self._binary(own + 1))
        return left

    def _unary(self) -> Value:
        self._depth += 1
        if self._depth > MAX_NESTING:
            raise ExpressionError(Wording("NC210", "nests_too_deep", most=MAX_NESTING))
        try:
            return self._primary()
        finally:
            self._depth -= 1

    def _primary(self) -> Value:
        token = self.token
        if token is None:
            raise ExpressionError(Wording("NC210", "value_missing_end_block"))
        self.at += 1
        match token.kind, token.text:
            case TokenKind.NUMBER, _:
                return token.value
            case TokenKind.TEXT, text:
                return text
            case TokenKind.SIGN, "(":
                value = self._binary(0)
                self.expect(")")
                return value
            case TokenKind.SIGN, "-":
                return -_numeric(self._unary())
            case TokenKind.SIGN, "+":
                return _numeric(self._unary())
            case TokenKind.NAME, "NOT":
                return float(not _numeric(self._unary()))
            case TokenKind.NAME, "B_NOT":
                return float(~whole(_numeric(self._unary())))
            case TokenKind.LETTER, "R":
                return self._parameter()
            case ((TokenKind.NAME | TokenKind.LETTER), name):
                if name in FUNCTIONS and self.peek() == "(":
                    return self._function(name)
                return self.names.variable(name, self.index())
        raise ExpressionError(Wording("NC210", "not_a_value", found=token.text))

    def _parameter(self) -> float:
        token = self.token
        if token is not None and token.kind is TokenKind.NUMBER:
            self.at += 1
            return self.names.parameter(whole(token.value))
        index = self.index()
        if len(index) != 1:
            raise ExpressionError(Wording("NC210", "r_needs_number"))
        return self.names.parameter(index[0])

    def _function(self, name: str) -> float:
        count, function = FUNCTIONS[name]
        arguments = [_numeric(value) for value in self.arguments() if value is not None]
        if len(arguments) != count:
            raise ExpressionError(
                Wording("NC210", "wrong_number_of_arguments", name=name, count=count, given=len(arguments))
            )
        try:
            return _sound(float(function(*arguments)))
        except (ValueError, OverflowError, ZeroDivisionError):
            raise ExpressionError(Wording("NC215", "no_value_here", name=name)) from None


def whole(value: float) -> int:
    """Return a number without its decimals, for indices and counters."""
    if not abs(value) < 1e15:
        raise ExpressionError(Wording("NC210", "not_usable_whole_number", value=value))
    return int(value)


def _numeric(value: Value) -> float:
    if isinstance(value, str):
        raise ExpressionError(Wording("NC210", "text_for_number", value=value[:40]))
    return value


def _sound(value: float) -> float:
    if not abs(value) < MAX_VALUE:
        raise ExpressionError(Wording("NC210", "no_finite_value"))
    return value


def _apply(operator: str, left: Value, right: Value) -> Value:
    if operator == "<<":
        text = _text(left) + _text(right)
        if len(text) > MAX_TEXT_LENGTH:
            raise ExpressionError(Wording("NC210", "text_too_long"))
        return text
    if operator in ("==", "<>") and isinstance(left, str) and isinstance(right, str):
        return float((left == right) == (operator == "=="))
    return _sound(_arithmetic(operator, _numeric(left), _numeric(right)))


def _text(value: Value) -> str:
    return value if isinstance(value, str) else f"{value:.10g}"


def _arithmetic(operator: str, a: float, b: float) -> float:
    match operator:
        case "+":
            return a + b
        case "-":
            return a - b
        case "*":
            return a * b
        case "/" | "DIV" | "MOD":
            return _divide(operator, a, b)
        case "==":
            return float(a == b)
        case "<>":
            return float(a != b)
        case "<":
            return float(a < b)
        case ">":
            return float(a > b)
        case "<=":
            return float(a <= b)
        case ">=":
            return float(a >= b)
        case "AND":
            return float(bool(a) and bool(b))
        case "OR":
            return float(bool(a) or bool(b))
        case "XOR":
            return float(bool(a) != bool(b))
        case "B_AND":
            return float(whole(a) & whole(b))
        case "B_OR":
            return float(whole(a) | whole(b))
        case _:
            return float(whole(a) ^ whole(b))


def _divide(operator: str, a: float, b: float) -> float:
    if b == 0.0:
        raise ExpressionError(Wording("NC210", "divides_zero"))
    if operator == "/":
        return a / b
    return float(math.trunc(_sound(a / b))) if operator == "DIV" else math.fmod(a, b)
