"""Kernels by Numba's own way: where no library can be made, and to compare libraries with."""

import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numba
from numba.extending import overload, register_jitable

from trunnion.jit.arguments import Array, Kind, Parts, fitted
from trunnion.jit.inner_functions import INNER

_NUMBERS = {int: numba.int64, float: numba.float64, bool: numba.boolean}

_config: Any = numba.config

_tuple_of: Callable[..., Any] = numba.types.BaseTuple.from_types

#: Functions that Numba knows, by their identity: they live as long as their modules.
_registered: set[int] = set()

#: Held while ``numba.config.CACHE_DIR``, which is the process's, is that of one kernel.
_enabling = threading.Lock()


def register(*functions: Callable[..., Any]) -> None:
    """Let Numba compile functions into those that call them; before anything is compiled, all inner ones."""
    for function, is_inlined in [*INNER, *((each, False) for each in functions)]:
        if id(function) in _registered:
            continue
        _registered.add(id(function))
        if is_inlined:
            _inline(function)
        else:
            register_jitable(function)


def _inline(function: Any) -> None:
    """Let Numba copy a function into its callers.

    What has these two attributes is copied before types are known, as Numba's own ``njit(inline="always")`` does, which
    takes half the time; an ``overload`` is copied afterwards, should another Numba not look at them.
    """
    overload(function, inline="always", strict=False)(lambda *_, **__: function)
    function.targetoptions, function.py_func = {"inline": "always"}, function


def element_type(array: Array) -> Any:
    """Return Numba's type of an array's elements."""
    return numba.from_dtype(array.dtype)


def numba_type(kind: Kind) -> Any:
    """Return Numba's type of an argument."""
    if isinstance(kind, Array):
        return numba.types.Array(element_type(kind), kind.dimensions, "C", readonly=not kind.is_written)
    if isinstance(kind, Parts):
        return _tuple_of([numba_type(part) for part in kind.kinds], None if kind.made is tuple else kind.made)
    return _NUMBERS[kind]


class Judge:
    """A kernel that Numba compiles and calls."""

    def __init__(
        self, function: Callable[..., Any], kinds: Sequence[Kind], options: dict[str, Any], folder: Path | None = None
    ) -> None:
        """Compile it, or load what Numba keeps in a folder of the kernel's own, if there is one."""
        register()
        self._kinds = kinds
        self._dispatcher = numba.njit(nogil=True, **options)(function)
        if folder is not None:
            with _enabling:
                chosen, _config.CACHE_DIR = _config.CACHE_DIR, str(folder)
                try:
                    self._dispatcher.enable_caching()
                except RuntimeError:  # "no locator available": the folder cannot be written to
                    pass
                finally:
                    _config.CACHE_DIR = chosen
        try:
            self._dispatcher.compile(tuple(map(numba_type, kinds)))
        except OSError:
            if not self._dispatcher.signatures:  # it was compiled before it was written
                raise
        self._dispatcher.disable_compile()

    def __call__(self, arguments: Sequence[Any]) -> Any:
        """Run it."""
        return self._dispatcher(*map(_given, self._kinds, fitted(self._kinds, arguments)))


def _given(kind: Kind, value: Any) -> Any:
    """Return a fitted argument as Numba takes it: read-only arrays must be so where the kernel's type says it."""
    if isinstance(kind, Parts):
        parts = tuple(map(_given, kind.kinds, value))
        return parts if kind.made is tuple else kind.made(*parts)
    if isinstance(kind, Array) and not kind.is_written:
        value.flags.writeable = False  # it is a view
    return bool(value) if kind is bool else value
