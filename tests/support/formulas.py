"""Formulas as printed, evaluated by Python's own mathematics; and chains that no shipped machine has."""

import math
from collections.abc import Iterable, Mapping
from typing import Any, Final

from trunnion.formulas.steps import Formula

_FUNCTIONS: Final = {
    "cos": lambda angle: math.cos(math.radians(angle)),
    "sin": lambda angle: math.sin(math.radians(angle)),
    "acos": lambda value: math.degrees(math.acos(min(1.0, max(-1.0, value)))),
    "asin": lambda value: math.degrees(math.asin(min(1.0, max(-1.0, value)))),
    "atan2": lambda y, x: math.degrees(math.atan2(y, x)),
    "sqrt": math.sqrt,
    "__builtins__": {},
}


def evaluated(formulas: Iterable[Formula], values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of formulas, each with those before it, and all that was known."""
    known = dict(values)
    for each in formulas:
        known[each.name] = eval(each.text, {**_FUNCTIONS, **known})
    return known


def _axis(name: str, kind: str, carries: str, direction: list[float], point: list[float] | None = None) -> str:
    text = f'[[axis]]\nname = "{name}"\nkind = "{kind}"\ncarries = "{carries}"\ndirection = {direction}\n'
    ends = "limits_mm = [-500, 500]\n" if kind == "linear" else "limits_deg = [-120, 120]\n"
    return f"{text}{ends}" + (f"point_mm = {point or [0.0, 0.0, 0.0]}\n" if kind == "rotary" else "")


def _machine(*axes: str, spindle: str = "[0, 0, 1]") -> str:
    return f'schema = 1\nname = "odd"\n[spindle]\ndirection = {spindle}\n' + "".join(axes)


_X, _Y, _Z = (
    _axis(name, "linear", "tool", direction)
    for name, direction in (("X", [1.0, 0.0, 0.0]), ("Y", [0.0, 1.0, 0.0]), ("Z", [0.0, 0.0, 1.0]))
)
_C = _axis("C", "rotary", "part", [0.0, 0.0, 1.0], [10.0, 20.0, 30.0])

#: Definitions by what is odd about their chains.
ODD_MACHINES: Final = {
    "quill": _machine(
        _X, _Y, _axis("C", "rotary", "tool", [0, 0, 1], [0, 0, 300]),
        _axis("B", "rotary", "tool", [0, 1, 0], [5, 0, 200]), _Z,
    ),
    "rotary axis between linear ones": _machine(
        _C, _X.replace('"tool"', '"part"'), _axis("B", "rotary", "part", [0, 1, 0], [0, 0, -50]), _Y, _Z
    ),
    "measured rotary axes": _machine(
        _axis("C", "rotary", "part", [0.001, 0.002, 1], [10, 20, 30]),
        _axis("A", "rotary", "part", [1, 0.0003, -0.0002], [0, 20, 30]), _X, _Y, _Z,
    ),
    "measured linear axes": _machine(
        _C, _axis("A", "rotary", "part", [1, 0, 0], [0, 20, 30]), _axis("X", "linear", "tool", [1, 0.0001, 0]),
        _axis("Y", "linear", "tool", [0.0002, 1, 0]), _axis("Z", "linear", "tool", [0, 0.0003, 1]),
    ),
    "nutated head of 50 degrees": _machine(
        _X, _Y, _Z, _axis("C", "rotary", "tool", [0, 0, 1], [0, 0, 100]),
        _axis("B", "rotary", "tool", [0, -0.7660444431, 0.6427876097], [0, 0, 200]),
    ),
    "nutated table": _machine(_C, _axis("B", "rotary", "part", [0, -1, 1], [1, 5, 9]), _X, _Y, _Z),
    "fork about X then Y": _machine(
        _X, _Y, _Z, _axis("A", "rotary", "tool", [1, 0, 0], [0, 0, 200]),
        _axis("B", "rotary", "tool", [0, 1, 0], [0, 10, 200]),
    ),
    "spindle along X": _machine(
        _C, _X, _Y, _Z, _axis("B", "rotary", "tool", [0, 1, 0], [100, 0, 0]), spindle="[1, 0, 0]"
    ),
    "everything askew": _machine(
        _X, _Y, _Z, _axis("C", "rotary", "tool", [0.3, 0.1, 1], [0, 0, 100]),
        _axis("B", "rotary", "tool", [0.2, -0.7, 0.6], [3, 0, 200]), spindle="[0.1, 0.02, 1]",
    ),
    "names that formulas use": _machine(
        _axis("L", "rotary", "part", [0, 0, 1]), _axis("k", "rotary", "part", [1, 0, 0], [0, 3, 0]), _X, _Y, _Z
    ),
}  # fmt: skip
