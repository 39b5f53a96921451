"""What is compiled into a kernel: its own code, the functions it calls in whatever module, and their constants."""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from enum import Enum
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any, TypeAlias

import numpy as np

#: What stands for the code of a function.
CodeOf: TypeAlias = Callable[[FunctionType], Iterator[bytes]]


def of_bytecode(function: FunctionType) -> Iterator[bytes]:
    """Yield what Python made of a function: it differs from version to version."""
    for code in _codes(function.__code__):
        yield code.co_code
        yield repr((code.co_names, code.co_varnames)).encode()
        yield from ingredients([each for each in code.co_consts if not isinstance(each, CodeType)])


def of_source(function: FunctionType) -> Iterator[bytes]:
    """Yield what stands for the file that a function is in: the same for all versions of Python.

    Raises ``OSError`` where the file cannot be read.
    """
    yield _file_digest(function.__code__.co_filename)


@cache
def _file_digest(file: str) -> bytes:
    return hashlib.sha256(Path(file).read_bytes()).digest()


def ingredients(value: Any, code_of: CodeOf = of_bytecode, seen: set[int] | None = None) -> Iterator[bytes]:
    """Everything that is compiled into a function, or that a constant consists of, as bytes.

    ``seen`` are the functions that have been gone through. Constants of other kinds than those here Numba does not
    compile, but for functions and numbers of other packages.
    """
    seen = set() if seen is None else seen
    if isinstance(value, FunctionType):
        if id(value) not in seen:
            seen.add(id(value))
            yield from _of_function(value, code_of, seen)
    elif hasattr(value, "py_func"):  # a kernel
        yield from ingredients(value.py_func, code_of, seen)
    elif isinstance(value, np.ndarray | np.generic):
        yield repr((value.dtype, value.shape)).encode()
        yield value.tobytes()
    elif isinstance(value, type):
        members = [(name, one.value) for name, one in value.__members__.items()] if issubclass(value, Enum) else ()
        yield repr((value.__qualname__, getattr(value, "_fields", ()), members)).encode()
        yield from ingredients(list(getattr(value, "_field_defaults", {}).items()), code_of, seen)
    elif isinstance(value, tuple | list):
        for part in value:
            yield from ingredients(part, code_of, seen)
        yield b"end"
    elif isinstance(value, frozenset):
        yield from sorted(repr(part).encode() for part in value)
    elif isinstance(value, int | float | complex | str | bytes | None):
        yield repr(value).encode()


def _of_function(function: FunctionType, code_of: CodeOf, seen: set[int]) -> Iterator[bytes]:
    if hasattr(function, "is_inlined"):
        yield b"inlined"
    yield from code_of(function)
    keyword_defaults = sorted((function.__kwdefaults__ or {}).items())
    yield from ingredients((function.__defaults__, keyword_defaults), code_of, seen)
    for cell in function.__closure__ or ():
        yield from ingredients(cell.cell_contents, code_of, seen)
    names = sorted({name for code in _codes(function.__code__) for name in code.co_names})
    for name in names:
        if name in function.__globals__:
            yield name.encode()
            yield from ingredients(_in_module(function.__globals__[name], names), code_of, seen)


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
