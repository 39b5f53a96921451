"""The digest of a kernel: it changes with everything that is compiled into it."""

from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from trunnion.jit.arguments import argument_kinds
from trunnion.jit.inner_functions import inlined, inner
from trunnion.jit.kernels import Kernel


class _One(NamedTuple):
    size: int = 1


class _Two(NamedTuple):
    size: int = 2


_Two.__qualname__ = _One.__qualname__


def _package(value: int) -> ModuleType:
    module = ModuleType("trunnion")
    module.__dict__["VALUE"] = value
    return module


def _digest(source: str, **names: Any) -> str:
    exec(f"def example(x: float) -> float:\n    return {source}", names)
    return Kernel(names["example"], frozenset()).digest


def _function(source: str, *, mark: Any = inner) -> Any:
    names: dict[str, Any] = {}
    exec(source, names)
    return mark(names["helper"])


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (_digest("x * 1.5 + 23.0"), _digest("x * 1.52 + 3.0")),
        (_digest("x * K", K=1), _digest("x * K", K=2)),
        (_digest("x * K", K=0.0), _digest("x * K", K=-0.0)),
        (_digest("x * K", K=1), _digest("x * K", K=True)),
        (_digest("x * A + B", A=1, B=2), _digest("x * A + B", A=2, B=1)),
        (_digest("x * K[0] + K[1]", K=(1.5, 23.0)), _digest("x * K[0] + K[1]", K=(1.52, 3.0))),
        (_digest("x * N().size", N=_One), _digest("x * N().size", N=_Two)),
        (_digest("x * m.VALUE", m=_package(1)), _digest("x * m.VALUE", m=_package(2))),
        (
            _digest("f(x)", f=_function("def helper(x): return x")),
            _digest("f(x)", f=_function("def helper(x): return x", mark=inlined)),
        ),
        *(
            (_digest("f(x)", f=_function(one)), _digest("f(x)", f=_function(other)))
            for one, other in (
                ("def helper(x): return -x", "def helper(x): return x"),
                ("def helper(x, k=1): return k * x", "def helper(x, k=2): return k * x"),
                ("def helper(x, *, k=1): return k * x", "def helper(x, *, k=2): return k * x"),
            )
        ),
    ],
)
def test_another_value_is_another_digest(one: str, other: str) -> None:
    assert one != other


def test_the_same_is_the_same() -> None:
    assert _digest("x * K", K=np.arange(3.0)) == _digest("x * K", K=np.arange(3.0))


def test_an_alias_of_an_array_type_is_the_type() -> None:
    def plain(values: np.ndarray[tuple[Any, ...], np.dtype[np.float64]]) -> None: ...
    def alias(values: NDArray[np.float64]) -> None: ...

    assert argument_kinds(alias, frozenset()) == argument_kinds(plain, frozenset())
