"""Functions that only kernels call. Numba is told of them before it compiles, and not imported for it."""

from collections.abc import Callable
from typing import Any, Final, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., Any])

#: All of them, and whether they are copied into their callers.
INNER: Final[list[tuple[Callable[..., Any], bool]]] = []


def inner(function: Function) -> Function:
    """Compile a function into the kernels that call it. Called from Python, it is the plain function."""
    INNER.append((function, False))
    return function


def inlined(function: Function) -> Function:
    """Copy a function into the kernels that call it before they are compiled, for functions shorter than a call."""
    INNER.append((function, True))
    cast(Any, function).is_inlined = True
    return function
