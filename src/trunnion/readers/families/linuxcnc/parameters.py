"""Parameters of a LinuxCNC program, and its arithmetic."""

import math
from collections.abc import Callable
from typing import Final

from trunnion.readers.rs274.expressions import COMMON, Arithmetic, BlockError, Value

#: The highest parameter.
MAX_NUMBER: Final = 5602

#: Parameters of a subprogram's own.
LOCAL_COUNT: Final = 30

#: Names that a program may have at most.
MAX_VARIABLES: Final = 50_000

#: Numbers nearer than this are equal.
EQUAL: Final = 1e-4


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
        case "**":
            return float(a**b)
        case "MOD":
            rest = math.fmod(a, b)
            return rest + abs(b) if rest < 0.0 else rest
        case "AND":
            return float(bool(a) and bool(b))
        case "OR":
            return float(bool(a) or bool(b))
        case "XOR":
            return float(bool(a) != bool(b))
        case "EQ":
            return float(abs(a - b) < EQUAL)
        case "NE":
            return float(abs(a - b) > EQUAL)
        case "GT":
            return float(a > b)
        case "GE":
            return float(a >= b)
        case "LT":
            return float(a < b)
        case _:
            assert name == "LE"
            return float(a <= b)


ARITHMETIC: Final = Arithmetic(
    levels=(
        ("AND", "OR", "XOR"),
        ("EQ", "NE", "GT", "GE", "LT", "LE"),
        ("+", "-"),
        ("*", "/", "MOD"),
        ("**",),
    ),
    operate=_operate,
    functions={**COMMON, "FIX": math.floor, "FUP": math.ceil},
    pairs={"ATAN": lambda y, x: math.degrees(math.atan2(y, x))},
)


class Parameters:
    """What ``#`` names: numbers, names of a subprogram's own, names with an underscore, and what the control sets.

    ``system_value`` returns the value of a parameter that the control itself sets, None for one that it does not.
    """

    def __init__(self, system_value: Callable[[int | str], float | None]) -> None:
        self._system_value = system_value
        self._numbers: dict[int, float] = {}
        self._global: dict[str, float] = {}
        self._local: list[dict[str, float]] = [{}]
        self._kept: list[dict[int, float]] = []

    def value(self, key: int | str) -> Value:
        """Return a value; a number that nobody set is 0."""
        found = self._find(key)
        if found is not None:
            return found
        if isinstance(key, str):
            raise BlockError(f"#<{key}> has no value")
        if not 1 <= key <= MAX_NUMBER:
            raise BlockError(f"#{key} is not from 1 to {MAX_NUMBER}")
        if key > 5000:
            raise BlockError(f"#{key} is a value that only the control knows")
        return 0.0

    def is_set(self, key: int | str) -> bool:
        """Whether EXISTS holds."""
        return self._find(key) is not None

    def _find(self, key: int | str) -> float | None:
        if isinstance(key, int):
            return self._numbers.get(key, self._system_value(key))
        table = self._global if key.startswith("_") else self._local[-1]
        return table.get(key, self._system_value(key))

    def set(self, key: int | str, value: float) -> None:
        """Set a parameter."""
        if isinstance(key, int):
            if not 1 <= key <= MAX_NUMBER:
                raise BlockError(f"#{key} is not from 1 to {MAX_NUMBER}")
            if key > 5000:
                raise BlockError(f"#{key} is set by the control, not by programs")
            self._numbers[key] = value
            return
        table = self._global if key.startswith("_") else self._local[-1]
        table[key] = value
        if len(table) > MAX_VARIABLES:
            raise BlockError(f"a program has more than {MAX_VARIABLES} names")

    def enter(self, arguments: list[float]) -> None:
        """Begin a subprogram: #1 to #30 are its own, and so are names without an underscore."""
        self._kept.append({k: self._numbers[k] for k in range(1, LOCAL_COUNT + 1) if k in self._numbers})
        self._local.append({})
        for k in range(1, LOCAL_COUNT + 1):
            self._numbers.pop(k, None)
        for k, value in enumerate(arguments, 1):
            self._numbers[k] = value

    def leave(self) -> None:
        """End a subprogram."""
        self._local.pop()
        for k in range(1, LOCAL_COUNT + 1):
            self._numbers.pop(k, None)
        self._numbers.update(self._kept.pop())
