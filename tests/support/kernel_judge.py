"""Kernels called twice, by their libraries and by Numba's own way, which must give and write the same bits.

As a plugin of pytest, each call of a kernel is judged: ``python -m pytest -p tests.support.kernel_judge PATHS``.
``KERNELS_JUDGED`` names a file for the names of the kernels that were compared.
"""

import copy
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trunnion.jit.judge import Judge
from trunnion.jit.kernels import Kernel
from trunnion.jit.library import Entry

#: Calls of one kernel that are compared: from then on a loop calls it.
_MOST = 200

_judges: dict[str, Judge] = {}
_calls: dict[str, int] = {}


def compared(kernel: Kernel, arguments: Any) -> Any:
    """Return what a kernel gives for arguments, which it may write to; fails if Numba gives or writes other bits."""
    entry = library_of(kernel)
    if kernel.name not in _judges:
        _judges[kernel.name] = kernel.judge()
    others = copy.deepcopy(arguments)
    theirs = _outcome(_judges[kernel.name], others)
    mine = copy.deepcopy(arguments)
    ours = _outcome(entry, mine)
    assert ours == theirs, f"{kernel.name} gives {ours}, Numba {theirs}"
    assert _bits(mine) == _bits(others), f"{kernel.name} writes other bits than Numba"
    return entry(arguments)


def library_of(kernel: Kernel) -> Entry:
    """Return the library of a kernel, made if need be."""
    if kernel._entry is None:
        kernel.prepare()
    assert isinstance(kernel._entry, Entry), f"{kernel.name} has no library"
    return kernel._entry


def _bits(value: Any) -> Any:
    """Return a value so that equal ones have equal bits."""
    if isinstance(value, tuple):
        return tuple(map(_bits, value))
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, value.tobytes()
    return type(value), np.float64(value).tobytes() if isinstance(value, float) else value


def _outcome(run: Any, arguments: Any) -> Any:
    try:
        return _bits(run(arguments))
    except Exception as error:
        return type(error), error.args


def _judged(self: Kernel, *arguments: Any) -> Any:
    _calls[self.name] = _calls.get(self.name, 0) + 1
    if _calls[self.name] > _MOST:
        return library_of(self)(arguments)
    return compared(self, arguments)


@pytest.hookimpl
def pytest_configure() -> None:
    """Compare from now on."""
    Kernel.__call__ = _judged  # type: ignore[method-assign]


@pytest.hookimpl
def pytest_unconfigure() -> None:
    """Say what was compared."""
    file = os.environ.get("KERNELS_JUDGED")
    if file:
        Path(file).write_text("\n".join(sorted(_judges)), encoding="utf-8")
