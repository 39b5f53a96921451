"""Numba's ``njit``, for functions whose machine code is kept: it is loaded without preparing Numba for compiling.

To compile, Numba must know all that Python and NumPy can do, and it learns that before it looks whether a function was
compiled earlier: a fifth of the time in which a small file is posted, and 25 MB, for nothing. Machine code needs only
the addresses of the functions that give it memory. What has to be compiled after all is compiled as ever, for the
compiler sees to it that it is prepared.

This rests on parts of Numba that are not promised. Where they are missing, Numba's own way is taken.
"""

from collections.abc import Callable
from functools import cache, cached_property
from typing import Any, TypeVar

import llvmlite.binding
import numba
import numpy as np
from numba.core import caching
from numba.core.runtime import nrt

Kernel = TypeVar("Kernel", bound=Callable[..., Any])

#: Kernels that go over bytes keep places as unsigned numbers: Numba asks of every signed index whether it counts from
#: the end, which takes a third of their time. A sum of signed and unsigned would be a float: add ``ONE``, and come
#: back with ``signed``.
unsigned: Any = np.uint64
signed: Any = np.int64
ONE: Any = np.uint64(1)

#: Name -> address of the functions that give machine code its memory.
_MEMORY: dict[str, int] = getattr(getattr(nrt, "_nrt", None), "c_helpers", {})

_KNOWN = bool(_MEMORY) and hasattr(caching.FunctionCache, "_load_overload")


def njit(**options: Any) -> Callable[[Kernel], Kernel]:
    """Compile a function as ``numba.njit`` does, with its options; with ``cache`` its machine code is kept."""
    kept = options.pop("cache", False)

    def compiled(function: Kernel) -> Kernel:
        kernel: Any = numba.njit(**options)(function)
        if kept and hasattr(kernel, "_cache") and _KNOWN:
            kernel._cache = _MachineCode(function)
        elif kept and hasattr(kernel, "enable_caching"):
            kernel.enable_caching()
        return kernel  # type: ignore[no-any-return]

    return compiled


def load(*kernels: Any) -> None:
    """Load what is kept of kernels now, while there is time, and not when they are first called.

    Kernels of which nothing is kept stay as they are.
    """
    for kernel in kernels:
        code = getattr(kernel, "_cache", None)
        for signature in code.signatures(kernel) if isinstance(code, _MachineCode) else ():
            kernel.compile(signature)


class _MachineCode:
    """The machine code of one kernel, by the types of its arguments: a cache as Numba's dispatchers want one.

    Files are looked for when the kernel is first called. Most are called by other kernels only, and stand in theirs.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    @cached_property
    def _files(self) -> Any:
        files: Any = caching.FunctionCache
        return files(self._function)

    @property
    def cache_path(self) -> str:
        """The folder."""
        path: str = self._files.cache_path
        return path

    def signatures(self, kernel: Any) -> list[Any]:
        """The types for which machine code is kept; none where Numba keeps its list in a way that is not known."""
        try:
            kept = self._files._cache_file._load_index()
            codegen = kernel.targetctx.codegen()
            return [key[0] for key in kept if key == self._files._index_key(key[0], codegen)]
        except (AttributeError, TypeError, LookupError):
            return []

    def load_overload(self, signature: Any, context: Any) -> Any:
        """What was compiled for a signature, or None."""
        _link_memory()
        with self._files._guard_against_spurious_io_errors():
            return self._files._load_overload(signature, context)

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Keep what was compiled for a signature."""
        self._files.save_overload(signature, compiled)

    def flush(self) -> None:
        """Throw away what is kept."""
        self._files.flush()


@cache
def _link_memory() -> None:
    """Let machine code find the functions that give it memory, as Numba's own runtime does it."""
    for name, address in _MEMORY.items():
        llvmlite.binding.add_symbol(name if name.startswith("_") else f"NRT_{name}", address)
