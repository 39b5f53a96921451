"""Parameters and arithmetic of LinuxCNC programs."""

import math
from collections.abc import Callable
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.program.declared_variables import DeclaredVariables
from trunnion.readers.rs274.expressions import COMMON_FUNCTIONS, COMMON_OPERATORS, Arithmetic, BlockError, Value

#: The highest parameter.
MAX_NUMBER: Final = 5602

#: Number of numbered parameters that each subprogram has for itself.
LOCAL_COUNT: Final = 30

#: Named parameters that a program may have.
MAX_VARIABLES: Final = 50_000

#: Comparisons take numbers that differ by less as equal.
EQUAL: Final = 1e-4


def _modulo(a: float, b: float) -> float:
    """Return the remainder, never negative."""
    remainder = math.fmod(a, b)
    return remainder + abs(b) if remainder < 0.0 else remainder


ARITHMETIC: Final = Arithmetic(
    levels=(
        ("AND", "OR", "XOR"),
        ("EQ", "NE", "GT", "GE", "LT", "LE"),
        ("+", "-"),
        ("*", "/", "MOD"),
        ("**",),
    ),
    operators={
        **COMMON_OPERATORS,
        "**": lambda a, b: a**b,
        "MOD": _modulo,
        "AND": lambda a, b: float(bool(a) and bool(b)),
        "OR": lambda a, b: float(bool(a) or bool(b)),
        "XOR": lambda a, b: float(bool(a) != bool(b)),
        "EQ": lambda a, b: float(abs(a - b) < EQUAL),
        "NE": lambda a, b: float(abs(a - b) > EQUAL),
    },
    functions={**COMMON_FUNCTIONS, "FIX": math.floor, "FUP": math.ceil},
    pairs={"ATAN": lambda y, x: math.degrees(math.atan2(y, x))},
    asks_for_parameters=True,
)


class Parameters:
    """The parameters of a running program: numbered, named local, named global (with an underscore), and system ones.

    Numbered and global ones keep what earlier programs have written, but for the arguments of a subprogram: what
    neither the program nor the definition sets is not known.

    system_value   returns a parameter that the control sets, None for one that is not simulated
    declared       the values that the definition declares
    """

    def __init__(self, system_value: Callable[[int | str], float | None], declared: DeclaredVariables) -> None:
        self._system_value = system_value
        self._declared = declared
        self._numbers: dict[int, float] = {}
        self._global: dict[str, float] = {}
        self._local: list[dict[str, float]] = [{}]
        self._kept: list[dict[int, float]] = []

    def value(self, key: int | str) -> Value:
        """Return the value of a parameter; an argument that a call leaves out is 0."""
        found = self._find(key)
        if found is not None:
            return found
        if isinstance(key, str):
            if not key.startswith("_"):
                raise BlockError(Wording("NC223", "parameter_without_value", key=key))
            return self._declared_value(f"#<{key.lower()}>")
        if not 1 <= key <= MAX_NUMBER:
            raise BlockError(Wording("NC215", "number_out_of_range", key=key, most=MAX_NUMBER))
        if key > 5000:
            raise BlockError(Wording("NC222", "only_control_knows", key=key))
        if self._kept and key <= LOCAL_COUNT:
            return 0.0
        return self._declared_value(f"#{key}")

    def is_set(self, key: int | str) -> bool:
        """Whether a parameter exists (EXISTS).

        Only of local names does the program alone decide. Others outlive programs: BlockError where neither the
        program nor the definition gives one a value.
        """
        if isinstance(key, str) and not key.startswith("_"):
            return self._find(key) is not None
        self.value(key)
        return True

    def _declared_value(self, name: str) -> float:
        """Return what the definition declares of what outlives programs; BlockError if it declares nothing."""
        declared = self._declared.get(name)
        if declared is None:
            raise BlockError(Wording("NC223", "no_value_in_program", name=name))
        return declared

    def _find(self, key: int | str) -> float | None:
        if isinstance(key, int):
            return self._numbers.get(key, self._system_value(key))
        table = self._global if key.startswith("_") else self._local[-1]
        return table.get(key, self._system_value(key))

    def set(self, key: int | str, value: float) -> None:
        """Set a parameter."""
        if isinstance(key, int):
            if not 1 <= key <= MAX_NUMBER:
                raise BlockError(Wording("NC215", "number_out_of_range", key=key, most=MAX_NUMBER))
            if key > 5000:
                raise BlockError(Wording("NC223", "set_by_control", key=key))
            self._numbers[key] = value
            self._declared.set(f"#{key}", value, outlives=key > LOCAL_COUNT)
            return
        table = self._global if key.startswith("_") else self._local[-1]
        table[key] = value
        if key.startswith("_"):
            self._declared.set(f"#<{key.lower()}>", value, outlives=True)
        if len(table) > MAX_VARIABLES:
            raise BlockError(Wording("NC210", "too_many_names", most=MAX_VARIABLES))

    def enter(self, arguments: list[float]) -> None:
        """Start a subprogram, which has #1 to #30 and names without an underscore for itself."""
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
