"""Variables of macros, and their arithmetic. Unset local variables are empty, and so is #0.

Common variables keep what earlier programs and the operator have written: what neither the program nor the definition
sets is not known.
"""

import math
from collections.abc import Callable
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.program.declared_variables import DeclaredVariables
from trunnion.readers.rs274.expressions import (
    COMMON_FUNCTIONS,
    COMMON_OPERATORS,
    Arithmetic,
    BlockError,
    Value,
    round_half_away,
)

#: Number of local variables, the first common ones, those of them that stay when the control is off, and system ones.
LOCAL_COUNT: Final = 33
COMMON_FROM: Final = 100
KEPT_FROM: Final = 500
SYSTEM_FROM: Final = 1000

#: Comparisons take numbers that differ by no more as equal.
_EQUAL: Final = 1e-8

_LARGEST_BITS: Final = 2**31


def _bits(value: float) -> int:
    number = round(value)
    if abs(value - number) > 1e-6 or abs(number) >= _LARGEST_BITS:
        raise BlockError(Wording("NC210", "logic_needs_whole_numbers"))
    return number


def _compare_empty(name: str, a: Value, b: Value) -> float | None:
    """Compare with EQ or NE, which distinguish empty from 0; None for other operators and for values."""
    if name not in ("EQ", "NE") or (a is not None and b is not None):
        return None
    same = a is None and b is None
    return float(same == (name == "EQ"))


def _atan(y: float, x: float) -> float:
    """Return the angle from 0 to 360 degrees, the default setting of the control."""
    return math.degrees(math.atan2(y, x)) % 360.0


ARITHMETIC: Final = Arithmetic(
    levels=(("EQ", "NE", "GT", "GE", "LT", "LE"), ("+", "-", "OR", "XOR"), ("*", "/", "AND", "MOD")),
    operators={
        **COMMON_OPERATORS,
        "MOD": math.fmod,
        "AND": lambda a, b: float(_bits(a) & _bits(b)),
        "OR": lambda a, b: float(_bits(a) | _bits(b)),
        "XOR": lambda a, b: float(_bits(a) ^ _bits(b)),
        "EQ": lambda a, b: float(abs(a - b) <= _EQUAL),
        "NE": lambda a, b: float(abs(a - b) > _EQUAL),
    },
    functions={
        **COMMON_FUNCTIONS,
        "SQR": math.sqrt,
        "RND": round_half_away,
        "FIX": math.trunc,
        "FUP": lambda a: math.copysign(math.ceil(abs(a)), a),
    },
    pairs={"ATAN": _atan, "POW": lambda a, b: a**b},
    assigns_without_brackets=True,
    compare_unset=_compare_empty,
    one_sign=True,
)


class Variables:
    """The variables of a running program.

    system_value       returns a system variable, None for one that is not simulated
    set_system_value   acts on a value that a program gives a system variable; returns whether it is one that acts
    declared           the values that the definition declares
    """

    def __init__(
        self,
        system_value: Callable[[int], float | None],
        set_system_value: Callable[[int, Value], bool],
        declared: DeclaredVariables,
    ) -> None:
        self._system_value = system_value
        self._set_system_value = set_system_value
        self._declared = declared
        self._common: dict[int, Value] = {}
        self._local: list[dict[int, float]] = [{}]

    def value(self, key: int | str) -> Value:
        """Return the value of a variable, None for an empty one."""
        if isinstance(key, str):
            raise BlockError(Wording("NC223", "named_variable", key=key))
        if key == 0:
            return None
        if key <= LOCAL_COUNT:
            return self._local[-1].get(key)
        if COMMON_FROM <= key < SYSTEM_FROM:
            return self._common_value(key)
        value = self._system_value(key)
        if value is None:
            raise BlockError(Wording("NC222", "only_control_knows", key=key))
        return value

    def _common_value(self, key: int) -> Value:
        """Return the value of a common variable; the operator or another program has set those that are not ours."""
        if key in self._common:
            return self._common[key]
        value = self._declared.get(f"#{key}")
        if value is None:
            raise BlockError(Wording("NC223", "no_value_in_program", name=f"#{key}"))
        return value

    def is_set(self, key: int | str) -> bool:
        """Whether a variable is not empty."""
        return self.value(key) is not None

    def set(self, key: int | str, value: Value) -> None:
        """Set a variable, or make it empty; one of the control may act on it."""
        if isinstance(key, int) and key >= SYSTEM_FROM and self._set_system_value(key, value):
            return
        if isinstance(key, str) or not (0 < key <= LOCAL_COUNT or COMMON_FROM <= key < SYSTEM_FROM):
            raise BlockError(Wording("NC223", "variable_not_set_by_programs", key=key))
        if key > LOCAL_COUNT:
            self._common[key] = value
            self._declared.set(f"#{key}", value, outlives=key >= KEPT_FROM)
        elif value is None:
            self._local[-1].pop(key, None)
        else:
            self._local[-1][key] = value

    @property
    def depth(self) -> int:
        """The number of nested macros."""
        return len(self._local) - 1

    def enter(self, arguments: dict[int, float]) -> None:
        """Start a macro, whose local variables are the arguments."""
        self._local.append(arguments)

    def leave(self) -> None:
        """End a macro."""
        self._local.pop()
