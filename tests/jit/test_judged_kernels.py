"""The library of each kernel does what Numba's own way does, to the last bit, on what the tests of properties make up.

A kernel without inputs fails: its test stands in ``tests/support/kernel_inputs.py``.
"""

import inspect
from contextlib import suppress
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Any
from unittest import SkipTest

import numpy as np
import pytest

from tests.support import kernel_judge
from tests.support.kernel_inputs import INPUTS
from tests.support.kernel_judge import compared
from trunnion.arrays import Floats, Ints
from trunnion.controls.words import round_column
from trunnion.jit.ahead import all_kernels
from trunnion.jit.kernels import Kernel

#: Calls that are compared.
_CALLS = 24


class Enough(SkipTest):  # which Hypothesis lets through, and draws no more
    """A kernel has been compared often enough."""


def test_every_kernel_has_a_test_that_makes_up_its_arguments() -> None:
    pytest.importorskip("scipy")
    named = [name for names in INPUTS.values() for name in names]

    assert sorted(named) == sorted(each.name.removeprefix("trunnion.") for each in all_kernels())


#: Kernels and their tests; every other one is left to nightly, as Numba compiles each anew.
_CASES = [
    pytest.param(name, test, id=name, marks=[pytest.mark.nightly] * (k % 2))
    for k, (name, test) in enumerate((name, test) for test, names in INPUTS.items() for name in names)
]


@pytest.mark.parametrize(("name", "test"), _CASES)
def test_a_library_gives_and_writes_the_bits_of_numba(
    name: str,
    test: tuple[str, ...],
    tmp_path: Path,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    room, _, own = f"trunnion.{name}".rpartition(".")
    kernel, run, calls = getattr(import_module(room), own), Kernel.__call__, 0

    def judged(self: Kernel, *arguments: Any) -> Any:
        nonlocal calls
        if self is not kernel:
            return run(self, *arguments)
        found = compared(self, arguments)
        calls += 1
        if calls >= _CALLS:
            raise Enough(name)
        return found

    module = import_module(f"tests.{test[0]}")
    function = getattr(module, test[1])
    fixtures = {"tmp_path": tmp_path, "tmp_path_factory": tmp_path_factory, "monkeypatch": monkeypatch}
    given = {key: value for key, value in fixtures.items() if key in inspect.signature(function).parameters}
    for word in test[2:]:
        key, _, value = word.partition("=")
        given[key] = value.strip("'") if "'" in value else attrgetter(value)(module)
    monkeypatch.setattr(Kernel, "__call__", judged)
    with suppress(Enough):
        function(**given)
    assert calls > 0, f"{'.'.join(test[:2])} does not call {name}"


@pytest.mark.parametrize(("bit", "same"), [(0, True), (1, False)])
def test_a_difference_of_one_bit_is_seen(bit: int, same: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    kernel: Any = round_column

    def judge(arguments: tuple[Floats, float, Ints]) -> None:
        value, scale, out = arguments
        kernel.py_func(value, scale, out)
        out[-1] ^= bit

    monkeypatch.setitem(kernel_judge._judges, kernel.name, judge)
    arguments = np.array([1.5, -2.25, np.nan]), 100.0, np.empty(3, np.int64)
    if same:
        assert compared(kernel, arguments) is None
    else:
        with pytest.raises(AssertionError, match="writes other bits than Numba"):
            compared(kernel, arguments)
