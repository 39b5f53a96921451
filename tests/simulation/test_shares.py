"""A simulation in shares is that of one process, to the last bit."""

import tracemalloc
from collections import Counter
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZIP_LZMA, ZIP_STORED, ZipFile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.divided import TOOLS, facts, joined, shares_of, write_divided
from tests.support.examples import examples
from tests.support.simulating import HEAD
from trunnion.errors import InputError
from trunnion.simulation.cutting import shares as shares_module
from trunnion.simulation.cutting import sweeps
from trunnion.simulation.cutting.shares import DamagedShareError, JoinedShares, Share, tiles_of
from trunnion.simulation.cutting.stretch_kernel import MET_IDLE, REMOVED
from trunnion.simulation.simulator import SimulatedProgram, cut_share, simulate
from trunnion.simulation.stock import material
from trunnion.simulation.stock.deviation import missing_from
from trunnion.simulation.stock.lattice import Lattice
from trunnion.simulation.stock.solids import make_stock
from trunnion.simulation.stock.spans import Spans

Given = dict[str, Any]


@pytest.fixture(scope="module")
def rich(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Given, trunnion.SimulationResult]:
    nc, given = write_divided(tmp_path_factory.mktemp("divided"))
    return nc, given, trunnion.simulate(nc, **given, threads=2)


def test_the_simulation_that_is_divided_here_has_everything(
    rich: tuple[Path, Given, trunnion.SimulationResult],
) -> None:
    found = rich[2]
    kinds = {each.kind for each in found.findings}
    assert kinds >= {"rapid through stock", "gouge", "cuts with the spindle off", "shank into stock", "collision"}
    assert found.near
    assert [each.tool for each in found.operations] == ["1", "2", "1"]
    cut = found.simulation
    assert Counter(tile.bundle for tile in cut.stock.tiles) == {0: 3, 1: 3, 2: 9}
    shape, lattice = cut.model.part, cut.stock.lattice
    assert shape is not None
    start = make_stock(cut.model.stock, cut.model.cell)
    whole = missing_from(
        cut.stock, (start.spans(0), start.spans(1), start.spans(2)),
        (shape.spans(lattice, 0), shape.spans(lattice, 1), shape.spans(lattice, 2)), cut.model.limit,
    )[1].whole  # fmt: skip
    assert whole is not None  # a wall that is gone, of which the rows that took it are found by cutting it again


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
def test_any_number_of_shares_gives_what_one_process_gives(
    rich: tuple[Path, Given, trunnion.SimulationResult], count: int
) -> None:
    nc, given, whole = rich
    assert facts(joined(nc, given, shares_of(nc, given, count))) == facts(whole)


def test_a_part_that_is_clamped_otherwise_than_it_is_drawn_is_divided_too(
    rich: tuple[Path, Given, trunnion.SimulationResult],
) -> None:
    nc, given, whole = rich
    turned = {**given, "turn": 60.0, "zero": (0.0, 0.0, 0.0), "cell": 1.0}
    found = trunnion.simulate(nc, **turned)
    assert found.removed != pytest.approx(whole.removed, rel=0.05)
    assert facts(joined(nc, turned, shares_of(nc, turned, 2))) == facts(found)


@pytest.mark.third
@pytest.mark.parametrize("sizes", [(1, 1, 1), (64, 64, 64), (65, 200, 700), (1000, 130, 10)])
@pytest.mark.parametrize("count", [1, 2, 3, 7, 50])
def test_each_tile_is_dealt_out_once_and_evenly(sizes: tuple[int, int, int], count: int) -> None:
    lattice = Lattice(np.zeros(3), np.ones(3), sizes)
    dealt = [tiles_of(Share(k, count), lattice) for k in range(count)]
    assert sorted(tile for own in dealt for tile in own) == list(range(len(material.tile_corners(lattice))))
    assert all(own == sorted(own) for own in dealt)
    assert max(map(len, dealt)) <= 2 * len(material.tile_corners(lattice)) / count + 3


@pytest.mark.parametrize("count", [2, 4, 8])
def test_a_band_of_tiles_along_an_axis_is_work_for_all_shares(count: int) -> None:
    lattice = Lattice(np.zeros(3), np.ones(3), (64 * 16, 64 * 16, 64))
    for along in (1, 2):
        for at in range(16):
            band = [
                k
                for k, corner in enumerate(material.tile_corners(lattice))
                if corner[0] == 2 and corner[along] == 64 * at
            ]
            most = max(len({*band} & {*tiles_of(Share(k, count), lattice)}) for k in range(count))
            assert most == len(band) / count


_number = st.integers(-12, 12)
_line = st.one_of(
    st.tuples(st.sampled_from(["G0", "G1"]), _number, _number, st.integers(-7, 3)).map(
        lambda each: f"{each[0]} X{each[1]} Y{each[2]} Z{each[3]}"
    ),
    st.tuples(st.sampled_from(["G0", "G1"]), st.integers(-20, 20), st.integers(-90, 90)).map(
        lambda each: f"{each[0]} A{each[1]} C{each[2]}"
    ),
    st.tuples(_number, st.integers(3, 9)).map(lambda each: f"G2 X{each[0]} Y{each[0]} R{4 * each[1]}"),
    st.sampled_from(["T1 M6\nG43 H1", "T2 M6\nG43 H2", "M5", "M3"]),
)


@settings(max_examples=examples(15), deadline=None)
@given(lines=st.lists(_line, min_size=1, max_size=12), count=st.integers(1, 9), chunk=st.integers(1, 9))
def test_any_program_in_any_number_of_shares_gives_what_one_process_gives(
    small: Callable[[str], trunnion.SimulationResult], lines: list[str], count: int, chunk: int
) -> None:
    found = small(HEAD + "F500\n" + "\n".join(lines) + "\nM5\nM30\n")
    cut = found.simulation
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sweeps, "CHUNK_ROWS", chunk)
        whole = simulate(cut.model, cut.programs)
        parts = [cut_share(cut.model, cut.programs, Share(k, count), threads=1) for k in range(count)]
        again = simulate(cut.model, cut.programs, shares=JoinedShares(parts))
    for name in ("left", "gouge", "lacking"):
        assert getattr(again, name) == getattr(whole, name)
    assert again.stock.volume == whole.stock.volume
    for one, other in zip(again.operations, whole.operations, strict=True):
        assert (one.first, one.end, one.findings, one.near, one.gouged) == (
            other.first, other.end, other.findings, other.near, other.gouged,
        )  # fmt: skip
        assert one.removed.tobytes() == other.removed.tobytes()
    for one_tile, tile in zip(again.stock.tiles, whole.stock.tiles, strict=True):
        assert np.array_equal(one_tile.count, tile.count)
        for name in ("ends", "rows", "normals"):
            assert np.array_equal(getattr(one_tile.spans(), name), getattr(tile.spans(), name))


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Simulates programs over a small block with a part, in tiles of 8 by 8 rays."""
    folder = tmp_path_factory.mktemp("small")
    _, files = write_divided(folder)
    given = {
        "machine": "xyzac_trt", "stock": "box:24,24,6,-12,-12,-6", "part": files["part"], "cell": 1.0, "near": 1.0,
        "tools": ["1=flat:8,length=30,flutes=4,shank=10", "2=ball:6,length=40,flutes=10"],
    }  # fmt: skip

    def simulated(text: str) -> trunnion.SimulationResult:
        nc = folder / "any.ngc"
        nc.write_text(text, encoding="utf-8")
        return trunnion.simulate(nc, **given)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(material, "TILE_RAYS", 8)
        patch.setattr(shares_module, "TILE_RAYS", 8)
        yield simulated


def _tampered(share: bytes, at: float, value: int) -> bytes:
    k = int(at * (len(share) - 1))
    return share[:k] + bytes([share[k] ^ value]) + share[k + 1 :]


@settings(max_examples=examples(20), deadline=None)
@given(at=st.floats(0.0, 1.0), value=st.integers(1, 255), cuts=st.booleans())
def test_a_damaged_share_is_told_or_harmless(small: Any, at: float, value: int, cuts: bool) -> None:
    cut = small(HEAD + "G1 X-5 Y3 Z-3 F500\nG1 X8\nG0 Y-9\nM30\n").simulation
    parts = [cut_share(cut.model, cut.programs, Share(k, 2), threads=1) for k in range(2)]
    parts[1] = parts[1][: int(at * (len(parts[1]) - 1))] if cuts else _tampered(parts[1], at, value)
    try:
        again = simulate(cut.model, cut.programs, shares=JoinedShares(parts))
    except DamagedShareError:
        return
    assert not cuts
    for one, other in zip(again.stock.tiles, cut.stock.tiles, strict=True):
        assert np.array_equal(one.spans().ends, other.spans().ends)


def test_shares_of_another_simulation_are_refused(small: Any) -> None:
    cut = small(HEAD + "G1 X-5 Y3 Z-3 F500\nG1 X8\nM30\n").simulation
    other = small(HEAD + "G1 X-5 Y3 Z-3 F500\nG1 X8\nT2 M6\nG43 H2\nG1 X0 Z-1\nM30\n").simulation
    parts = [cut_share(cut.model, cut.programs, Share(k, 2), threads=1) for k in range(2)]
    for wrong in (parts[:1], [parts[0], b""], [parts[0], parts[0]]):
        with pytest.raises(DamagedShareError):
            simulate(cut.model, cut.programs, shares=JoinedShares(wrong))
    with pytest.raises(DamagedShareError):
        simulate(other.model, other.programs, shares=JoinedShares(parts))
    shorter = [SimulatedProgram(job.run, job.tools, job.end - 1) for job in cut.programs]
    with pytest.raises(DamagedShareError):
        simulate(cut.model, shorter, shares=JoinedShares(parts))


def test_what_no_tile_knows_alone_is_not_divided(rich: tuple[Path, Given, trunnion.SimulationResult]) -> None:
    nc, given, _ = rich
    with pytest.raises(InputError, match=r"first finding.*SIM116"):
        shares_of(nc, {**given, "stop_at": "first"}, 2)
    tools = '["' + '", "'.join(TOOLS) + '"]'
    project = nc.parent / "two.toml"
    setup = f'[[simulation.setup]]\nname = "NAME"\nprograms = ["wall.ngc"]\ntools = {tools}\n'
    project.write_text(
        f'[simulation]\nmachine = "xyzac_trt"\nstock = "{given["stock"]}"\n'
        + setup.replace("NAME", "front") + setup.replace("NAME", "back"),
        encoding="utf-8",
    )  # fmt: skip
    for divide in (lambda: shares_of(project, {}, 2), lambda: joined(project, {}, [])):
        with pytest.raises(InputError, match=r"2, each.*SIM116"):
            divide()


def _npy(shape: tuple[int, ...], kind: Any, data: bytes = b"") -> bytes:
    """An array as NumPy writes it, whose header says what it likes."""
    content = BytesIO()
    said = {"descr": np.lib.format.dtype_to_descr(np.dtype(kind)), "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(content, said)
    return content.getvalue() + data


def _tile(arrays: dict[str, bytes], packed: int = ZIP_DEFLATED) -> bytes:
    content = BytesIO()
    with ZipFile(content, "w", packed) as archive:
        archive.writestr("tile 0", b"".join(arrays.values()))
    return content.getvalue()


def _small_stock() -> material.Stock:
    """A tile of four rays with one stretch each."""
    lattice = Lattice(np.zeros(3), np.ones(3), (1, 2, 2))
    spans = Spans(np.arange(5), np.tile([0.0, 1.0], 4), np.zeros((8, 3), np.int8), np.full(8, -1, np.int32))
    return material.Stock.of_spans(lattice, (spans, spans, spans), only=[0])


#: What the tile of four rays is that has one stretch of each ray.
_SOUND = {
    "count": _npy((4,), np.int32, np.ones(4, np.int32).tobytes()), "ends": _npy((8,), float, bytes(64)),
    "rows": _npy((8,), np.int32, bytes(32)), "normals": _npy((8, 3), np.int8, bytes(24)),
}  # fmt: skip


@pytest.mark.third
@pytest.mark.parametrize("wrong", [
    {"count": _npy((4_000_000_000, 30), np.int32)},
    {"ends": _npy((4_000_000_000,), float)},
    {"normals": _npy((4_000_000_000, 3), np.int8)},
    {"normals": _npy((8, 3), np.int8, bytes(100_000_000))},
    {"ends": _npy((8,), object, bytes(64))},
    {"ends": _npy((8,), np.float32, bytes(32))},
    {"ends": _npy((2, 4), float, bytes(64))},
    {"ends": _npy((), float, bytes(64))},
    {"ends": _npy((-8,), float, bytes(64))},
    {"rows": _npy((9,), np.int32, bytes(36))},
    {"count": _npy((4,), np.int32, np.array([1, 1, -1, 3], np.int32).tobytes())},
    {"count": _npy((4,), np.int32, np.array([0, 0, 0, 2**31 - 1], np.int32).tobytes())},
    {  # four rays may have as many together, one of them may not
        "count": _npy((4,), np.int32, np.array([0, 0, 0, 4000], np.int32).tobytes()),
        "ends": _npy((8000,), float, bytes(64000)), "rows": _npy((8000,), np.int32, bytes(32000)),
        "normals": _npy((8000, 3), np.int8, bytes(24000)),
    },
])  # fmt: skip
@pytest.mark.parametrize("packed", [ZIP_DEFLATED, ZIP_STORED])
def test_no_share_takes_more_memory_than_its_tiles_can(wrong: dict[str, bytes], packed: int) -> None:
    stock = _small_stock()
    JoinedShares([_tile(_SOUND)]).finish(stock)
    shares = JoinedShares([_tile({**_SOUND, **wrong}, packed)])
    tracemalloc.start()
    with pytest.raises(DamagedShareError):
        shares.finish(stock)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 1_000_000


def _chunk(blocks: list[list[int]], rows: list[int], values: int, places: int) -> bytes:
    content = BytesIO()
    with ZipFile(content, "w", ZIP_DEFLATED) as archive:
        archive.writestr(
            "chunk",
            _npy((len(blocks), 3), np.int32, np.array(blocks, np.int32).tobytes())
            + _npy((len(rows),), np.int32, np.array(rows, np.int32).tobytes())
            + _npy((values,), float, bytes(8 * values)) + _npy((places, 3), float, bytes(24 * places)),
        )  # fmt: skip
    return content.getvalue()


@pytest.mark.third
@pytest.mark.parametrize("wrong", [
    ([[3, REMOVED, 2]], [5, 6], 2, 0),
    ([[-1, REMOVED, 2]], [5, 6], 2, 0),
    ([[0, 9, 2]], [5, 6], 2, 2),
    ([[0, REMOVED, 2]], [4, 6], 2, 0),
    ([[0, REMOVED, 2]], [5, 15], 2, 0),
    ([[0, REMOVED, 1]], [5, 6], 2, 0),
    ([[0, REMOVED, 3], [1, REMOVED, -1]], [5, 6], 2, 0),
    ([[0, REMOVED, 2]], [5, 6], 3, 0),
    ([[0, REMOVED, 2]], [5, 6], 2, 2),
    ([[0, MET_IDLE, 2]], [5, 6], 2, 1),
    ([], [5], 1, 0),
    ([[0, REMOVED, 1]] * 28, [5] * 28, 28, 0),
])  # fmt: skip
def test_a_chunk_that_no_share_of_these_rows_can_have_is_refused(wrong: tuple[Any, ...]) -> None:
    def measured(*chunk: Any) -> list[Any]:
        archive = ZipFile(BytesIO(_chunk(*chunk)))
        return list(shares_module._measured(archive, "chunk", [0, 1, 2], range(5, 15), 9))

    (sound,) = measured([[0, REMOVED, 2], [0, MET_IDLE, 1]], [5, 6, 14], 3, 1)
    assert [len(each.row) for each in sound.columns] == [2, 1]
    with pytest.raises(DamagedShareError):
        measured(*wrong)


def test_a_share_that_is_packed_otherwise_is_refused() -> None:
    # Reading such ones takes memory as they say themselves.
    with pytest.raises(DamagedShareError, match="packed"):
        JoinedShares([_tile(_SOUND, ZIP_LZMA)]).finish(_small_stock())


def test_a_share_for_which_there_is_no_memory_is_damaged(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> bytes:
        raise MemoryError

    shares = JoinedShares([_tile(_SOUND)])
    monkeypatch.setattr(ZipFile, "open", full)
    with pytest.raises(DamagedShareError, match="memory"):
        shares.finish(_small_stock())
