"""A kernel as it is called: what it takes, what it gives, and what it raises; Numba's own way judges its library."""

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from trunnion.arrays import Codes, Flags, Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.jit.judge import Judge
from trunnion.jit.kernels import Kernel
from trunnion.jit.library import Entry


class Part(NamedTuple):
    """A named tuple with all kinds of things in it."""

    values: Floats
    pair: tuple[int, float]
    flags: Flags
    on: bool


@inner
def _total(values: Any) -> Any:
    room = np.empty(len(values) + 1)
    room[0] = 0.0
    for k in range(len(values)):
        room[k + 1] = room[k] + values[k]
    return room[len(values)]


@kernel(writes="out counts")
def everything(
    part: Part, table: Floats2, pick: int, by: float, out: Floats, counts: tuple[Ints, Codes]
) -> tuple[int, float, bool]:
    """Read and write all kinds of arguments, with an array of its own, and give all kinds of results."""
    if pick < 0:
        raise ValueError("less than none", 7)
    for k in range(len(out)):
        out[k] = table[k, pick] / by + part.pair[1]
    counts[0][0] = part.pair[0] + len(part.values)
    counts[1][0] = 200
    return counts[0][0] + 1, _total(part.values), part.on and part.flags[1]


@kernel()
def pair_sum(parts: tuple[Floats, Floats]) -> float:
    """Sum two arrays."""
    found: float = _total(parts[0]) + _total(parts[1])
    return found


@kernel()
def yes(value: float) -> bool:
    """Give a truth."""
    return value > 0.0


@kernel(writes="out")
def nothing(out: Floats) -> None:
    """Give nothing."""
    out[:] = 1.0


def given(**changed: Any) -> list[Any]:
    """Return arguments of ``everything``."""
    part = Part(np.arange(4.0), (3, 0.5), np.array([False, True]), True)
    usual: dict[str, Any] = {
        "part": part, "table": np.arange(6.0).reshape(3, 2), "pick": 1, "by": 2.0, "out": np.zeros(3),
        "counts": (np.zeros(1, np.int64), np.zeros(1, np.uint8)),
    }  # fmt: skip
    return list((usual | changed).values())


def entry() -> Kernel:
    """Return the kernel as what it is."""
    found: Any = everything
    assert isinstance(found, Kernel)
    return found


def through_its_library(arguments: Sequence[Any]) -> Any:
    """Call ``everything``."""
    return entry()(*arguments)


@cache
def _judge() -> Judge:
    return entry().judge()


def through_numba(arguments: Sequence[Any]) -> Any:
    """Call ``everything`` as where no library is made."""
    return _judge()(arguments)


def read_only(size: int) -> Any:
    """Return ones that cannot be written to."""
    made = np.ones(size)
    made.flags.writeable = False
    return made


def test_a_kernel_takes_and_gives_what_its_signature_says() -> None:
    arguments = given()

    assert entry()(*arguments) == (8, 6.0, True)
    assert isinstance(entry()._entry, Entry)
    assert arguments[4].tolist() == [1.0, 2.0, 3.0]
    assert [each.tolist() for each in arguments[5]] == [[7], [200]]
    assert yes(1.0) is True
    assert yes(np.float64(-1.0)) is False
    nothing(arguments[4])
    assert arguments[4].tolist() == [1.0, 1.0, 1.0]


def test_numba_itself_gives_the_same() -> None:
    arguments, others = given(), given()

    assert entry()(*arguments) == entry().judge()(others)
    assert arguments[4].tobytes() == others[4].tobytes()


def test_what_is_read_may_have_any_layout_and_be_of_any_class() -> None:
    table = np.asfortranarray(np.arange(6.0).reshape(3, 2))
    table.flags.writeable = False
    usual = given()[0]
    part = usual._replace(values=np.arange(8.0)[::2].view(type("Mine", (np.ndarray,), {})), on=np.True_)
    swapped = np.frombuffer(b"\0" + np.arange(6.0).tobytes(), np.uint8)[1:].view(np.float64).reshape(3, 2)

    assert entry()(*given(table=table, part=part, pick=np.int64(1))) == (8, 12.0, True)
    assert not swapped.flags.aligned
    assert entry()(*given(table=swapped)) == (8, 6.0, True)


@pytest.mark.parametrize(
    "changed",
    [
        {"table": np.zeros((3, 2), np.float32)},
        {"table": np.zeros(3)},
        {"table": [[0.0, 1.0]] * 3, "pick": "1"},
        {"table": None},
        {"pick": 1.5},
        {"by": "2"},
        {"out": np.zeros(6)[::2]},
        {"out": [0.0, 0.0, 0.0]},
        {"out": np.zeros(3, ">f8")},
        {"out": np.broadcast_to(np.zeros(1), 3)},
        {"counts": (np.zeros(1, np.int64),)},
        {"part": (np.zeros(1), (1, 2.0), np.zeros(2, np.int64), True)},
        {"part": None},
        {"out": np.zeros(3)[::-1]},
        {"out": read_only(3)},
        {"out": read_only(0)},
        {"out": np.zeros((3, 1))},
        {"out": np.frombuffer(bytearray(25), np.uint8)[1:].view(np.float64)},
        {"table": np.float64(1.0)},
        {"table": np.zeros((3, 2), np.complex128)},
        {"table": np.zeros((3, 2), object)},
        {"table": np.zeros((3, 2), ">f8")},
        {"table": np.zeros((3, 2), [("x", np.float64)])},
        {"table": [[0, 1]] * 3},
    ],
)
@pytest.mark.parametrize("way", [through_its_library, through_numba])
def test_nothing_else_is_taken(changed: dict[str, Any], way: Callable[[Sequence[Any]], Any]) -> None:
    with pytest.raises(TypeError):
        way(given(**changed))


@pytest.mark.parametrize("way", [through_its_library, through_numba])
def test_another_number_of_arguments_is_not_taken(way: Callable[[Sequence[Any]], Any]) -> None:
    for arguments in (given()[:-1], given(table=[[0.0, 1.0]] * 3)[:-1], given(counts=[np.zeros(1, np.int64)])):
        with pytest.raises(TypeError):
            way(arguments)


@pytest.mark.parametrize("way", [through_its_library, through_numba])
def test_parts_that_nothing_else_keeps_live_until_the_kernel_has_read_them(
    way: Callable[[Sequence[Any]], Any],
) -> None:
    made = (part for part in (np.full(20_000, 1.5), (3, 0.5), np.array([False, True]), True))
    assert way(given(part=made)) == (20_004, 30_000.0, True)

    rows: Any = pair_sum
    for run in (rows, lambda parts: rows.judge()((parts,))):
        assert run(np.full((2, 500), 1.5)) == 1500.0
        assert run(np.full(500, value) for value in (1.0, 2.0)) == 1500.0
        assert run([np.full(500, 1.0), np.full(1000, 2.0)[::-2]]) == 1500.0


@pytest.mark.parametrize("way", [through_its_library, through_numba])
def test_empty_arrays_and_turned_ones_are_read_to_their_ends_and_no_further(
    way: Callable[[Sequence[Any]], Any],
) -> None:
    usual = given()[0]
    for values, total in (
        (np.empty(0), 0.0),
        (np.ones(9)[9:0:-2][:0], 0.0),
        (np.arange(4.0)[::-1], 6.0),
        (np.arange(9.0)[5:4:-3], 5.0),
        (np.broadcast_to(2.0, 3), 6.0),
        (read_only(4), 4.0),
    ):
        part = usual._replace(values=values)
        assert way(given(part=part, out=np.empty(0), table=np.empty((0, 2)))) == (len(values) + 4, total, True)
    turned = np.arange(6.0).reshape(3, 2)[::-1, ::-1]
    out = np.full(6, 9.0)
    way(given(table=turned, out=out[1:4]))
    assert out.tolist() == [9.0, 2.5, 1.5, 0.5, 9.0, 9.0]


def test_what_a_kernel_raises_is_raised() -> None:
    with pytest.raises(ZeroDivisionError, match="division by zero"):
        entry()(*given(by=0.0))
    with pytest.raises(ValueError, match="less than none") as raised:
        entry()(*given(pick=-1))
    assert raised.value.args == ("less than none", 7)


def resident_kb() -> int:
    """The memory of this process, kB."""
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    (now,) = (int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS"))
    return now


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for the memory of the process")
def test_arrays_of_a_kernel_are_given_back() -> None:
    big = Part(np.zeros(1_000_000), (3, 0.5), np.array([False, True]), True)
    before = resident_kb()
    for _ in range(300):
        entry()(*given(part=big))
    assert resident_kb() - before < 500_000  # 300 arrays of 8 MB are 2.4 GB


def test_kernels_may_run_as_plain_python() -> None:
    script = "import sys\nfrom trunnion.machines.links import link_rows\nprint(type(link_rows), 'numba' in sys.modules)"
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["<class", "'function'>", "False"]
