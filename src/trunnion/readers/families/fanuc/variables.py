"""Variables of macros, and their arithmetic. A variable that nobody set is empty, and so is #0."""

import math
from collections.abc import Callable
from typing import Final

from trunnion.readers.rs274.expressions import COMMON, Arithmetic, BlockError, Value, round_half_away

#: Local variables of a macro, common ones, and the first that the control itself sets.
LOCAL_COUNT: Final = 33
COMMON_FROM: Final = 100
SYSTEM_FROM: Final = 1000

#: Numbers nearer than this are one to comparisons.
_EQUAL: Final = 1e-8

_LARGEST_BITS: Final = 2**31


def _bits(value: float) -> int:
    number = round(value)
    if abs(value - number) > 1e-6 or abs(number) >= _LARGEST_BITS:
        raise BlockError("AND, OR and XOR need whole numbers")
    return number


def _operate(name: str, a: float, b: float) -> float:
    match name:
        case "+":
            return a + b
        case "-":
            return a - b
        case "*":
            return a * b
        case "/":
            return a / b
        case "MOD":
            return math.fmod(a, b)
        case "AND":
            return float(_bits(a) & _bits(b))
        case "OR":
            return float(_bits(a) | _bits(b))
        case "XOR":
            return float(_bits(a) ^ _bits(b))
        case "EQ":
            return float(abs(a - b) <= _EQUAL)
        case "NE":
            return float(abs(a - b) > _EQUAL)
        case "GT":
            return float(a > b)
        case "GE":
            return float(a >= b)
        case "LT":
            return float(a < b)
        case _:
            assert name == "LE"
            return float(a <= b)


def _compare_empty(name: str, a: Value, b: Value) -> float | None:
    """EQ and NE tell an empty variable from a 0; other operators take it as 0."""
    if name not in ("EQ", "NE") or (a is not None and b is not None):
        return None
    same = a is None and b is None
    return float(same == (name == "EQ"))


def _atan(y: float, x: float) -> float:
    """Angle from 0 to 360 degrees, as the control is delivered."""
    return math.degrees(math.atan2(y, x)) % 360.0


ARITHMETIC: Final = Arithmetic(
    levels=(("EQ", "NE", "GT", "GE", "LT", "LE"), ("+", "-", "OR", "XOR"), ("*", "/", "AND", "MOD")),
    operate=_operate,
    functions={
        **COMMON,
        "SQR": math.sqrt,
        "RND": round_half_away,
        "FIX": math.trunc,
        "FUP": lambda a: math.copysign(math.ceil(abs(a)), a),
    },
    pairs={"ATAN": _atan, "POW": lambda a, b: float(a**b)},
    assigns_without_brackets=True,
    compare_unset=_compare_empty,
)


class Variables:
    """What ``#`` names; ``system_value`` returns what the control itself sets, None for what it does not."""

    def __init__(self, system_value: Callable[[int], float | None]) -> None:
        self._system_value = system_value
        self._common: dict[int, float] = {}
        self._local: list[dict[int, float]] = [{}]

    def value(self, key: int | str) -> Value:
        """Return a value, None for an empty one."""
        if isinstance(key, str):
            raise BlockError(f"#<{key}>: variables have numbers here")
        if key == 0:
            return None
        if key <= LOCAL_COUNT:
            return self._local[-1].get(key)
        if COMMON_FROM <= key < SYSTEM_FROM:
            return self._common.get(key)
        value = self._system_value(key)
        if value is None:
            raise BlockError(f"#{key} is a value that only the control knows")
        return value

    def is_set(self, key: int | str) -> bool:
        """Whether a variable is not empty."""
        return self.value(key) is not None

    def set(self, key: int | str, value: Value) -> None:
        """Set a variable, or make it empty."""
        if isinstance(key, str) or not (0 < key <= LOCAL_COUNT or COMMON_FROM <= key < SYSTEM_FROM):
            raise BlockError(f"#{key} is not a variable that programs set")
        table = self._local[-1] if key <= LOCAL_COUNT else self._common
        if value is None:
            table.pop(key, None)
        else:
            table[key] = value

    @property
    def depth(self) -> int:
        """How many macros are inside each other now."""
        return len(self._local) - 1

    def enter(self, arguments: dict[int, float]) -> None:
        """Begin a macro with local variables of its own."""
        self._local.append(arguments)

    def leave(self) -> None:
        """End it."""
        self._local.pop()
