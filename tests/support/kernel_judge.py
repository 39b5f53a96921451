"""Each call of a kernel is made twice, by its library and by Numba's own way, and must give the same bits.

A plugin of pytest: ``python -m pytest -p tests.support.kernel_judge PATHS``. ``KERNELS_JUDGED`` names a file for the
names of the kernels that were compared.
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
    if self._entry is None:
        self.prepare()
    assert isinstance(self._entry, Entry), f"{self.name} has no library"
    _calls[self.name] = _calls.get(self.name, 0) + 1
    if _calls[self.name] > _MOST:
        return self._entry(arguments)
    if self.name not in _judges:
        _judges[self.name] = self.judge()
    others = copy.deepcopy(arguments)
    theirs = _outcome(_judges[self.name], others)
    mine = copy.deepcopy(arguments)
    ours = _outcome(self._entry, mine)
    assert ours == theirs, f"{self.name} gives {ours}, Numba {theirs}"
    assert _bits(mine) == _bits(others), f"{self.name} writes other bits than Numba"
    return self._entry(arguments)


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
