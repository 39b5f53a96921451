"""What is compiled into a kernel: its own code, the functions it calls in whatever module, and their constants."""

from collections.abc import Iterator, Sequence
from enum import Enum
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np


def ingredients(value: Any, seen: set[int] | None = None) -> Iterator[bytes]:
    """Everything that is compiled into a function, or that a constant consists of, as bytes.

    ``seen`` are the functions that have been gone through. Constants of other kinds than those here Numba does not
    compile, but for functions and numbers of other packages.
    """
    seen = set() if seen is None else seen
    if isinstance(value, FunctionType):
        if id(value) not in seen:
            seen.add(id(value))
            yield from _of_function(value, seen)
    elif hasattr(value, "py_func"):  # a kernel
        yield from ingredients(value.py_func, seen)
    elif isinstance(value, CodeType):
        yield value.co_code
        yield repr((value.co_names, value.co_varnames)).encode()
        yield from ingredients(value.co_consts, seen)
    elif isinstance(value, np.ndarray | np.generic):
        yield repr((value.dtype, value.shape)).encode()
        yield value.tobytes()
    elif isinstance(value, type):
        members = [(name, one.value) for name, one in value.__members__.items()] if issubclass(value, Enum) else ()
        yield repr((value.__qualname__, getattr(value, "_fields", ()), members)).encode()
        yield from ingredients(list(getattr(value, "_field_defaults", {}).items()), seen)
    elif isinstance(value, tuple | list):
        for part in value:
            yield from ingredients(part, seen)
        yield b"end"
    elif isinstance(value, frozenset):
        yield from sorted(repr(part).encode() for part in value)
    elif isinstance(value, int | float | complex | str | bytes | None):
        yield repr(value).encode()


def _of_function(function: FunctionType, seen: set[int]) -> Iterator[bytes]:
    if hasattr(function, "is_inlined"):
        yield b"inlined"
    keyword_defaults = sorted((function.__kwdefaults__ or {}).items())
    yield from ingredients((function.__code__, function.__defaults__, keyword_defaults), seen)
    for cell in function.__closure__ or ():
        yield from ingredients(cell.cell_contents, seen)
    for code in _codes(function.__code__):
        for name in code.co_names:
            if name in function.__globals__:
                yield name.encode()
                yield from ingredients(_in_module(function.__globals__[name], code.co_names), seen)


def _codes(code: CodeType) -> Iterator[CodeType]:
    """Yield a function's code and that of the functions in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _in_module(value: Any, names: Sequence[str]) -> Any:
    """Return what a function may take by these names from a module of this package; any other value itself."""
    if isinstance(value, ModuleType) and value.__name__.partition(".")[0] == "trunnion":
        return [getattr(value, name) for name in names if hasattr(value, name)]
    return value
