"""Recording over cut cables, servers that end and start again, clocks that jump: nothing is lost, gaps are marked."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.support.opcua_servers import BEGIN, NODES, Cable, Machine, serving, write_nodes
from trunnion.errors import InputError, Problem
from trunnion.files import resolve_output
from trunnion.model.recording import Mark, Recording
from trunnion.twin.recording.client import Access
from trunnion.twin.recording.feed import MachineFeed
from trunnion.twin.recording.files import RecordingWriter
from trunnion.twin.recording.nodes import load_nodes
from trunnion.twin.recording.reading import read_recording

TICK = 20_000
HOUR = 3_600_000_000


class Recorder:
    """Records into a file beside a test that watches it."""

    def __init__(self, folder: Path, port: int) -> None:
        self.file = folder / "recorded.csv"
        self.told: list[Problem] = []
        access = Access(f"opc.tcp://127.0.0.1:{port}/")
        self._feed = MachineFeed(access, load_nodes(write_nodes(folder)), 0.0, self.told.append)
        self._task: asyncio.Task[None] | None = None
        self._last = 0.0
        self.gaps = 0

    async def __aenter__(self) -> "Recorder":
        await self._feed.open()
        self._writer = RecordingWriter(resolve_output(self.file), self._feed.names, self._feed.texts)
        self._task = asyncio.create_task(self._go_on())
        return self

    async def __aexit__(self, *_: object) -> None:
        assert self._task is not None
        self._task.cancel()
        await asyncio.gather(self._task, return_exceptions=True)
        await self._feed.close()
        self._writer.add(self._feed.rest())
        self._writer.close()

    async def _go_on(self) -> None:
        async for rows in self._feed.rows():
            self._writer.add(rows)
            self.gaps += sum(Mark.GAP in row.marks for row in rows)
            values = [row.values[0] for row in rows if isinstance(row.values[0], float)]
            self._last = float(values[-1]) if values else self._last

    async def until(self, reached: Callable[[], bool]) -> None:
        """Wait until something is recorded; it fails where the recorder has failed."""
        assert self._task is not None
        while not reached():
            assert not self._task.done(), self._task.result()
            await asyncio.sleep(0.01)

    async def has(self, x: float) -> None:
        """Wait until a value of X is recorded."""
        await self.until(lambda: self._last == x)


async def move(machine: Machine, first: int, end: int, offset: int = 0) -> None:
    """Show steps ``first`` to ``end``: X counts them, C changes at every third."""
    for k in range(first, end):
        values: dict[str, object] = {"x": float(k), "block": ["", f"N{k}", ""]}
        await machine.show(BEGIN + k * TICK + offset, values | ({"c": -float(k)} if k % 3 == 0 else {}))
        await asyncio.sleep(0.0)


def steps(recording: Recording) -> list[int]:
    """The steps that were recorded; each is whole."""
    found = recording.values["X"]
    rows = np.flatnonzero(np.isfinite(found) & (found > 0.0))
    for row in rows.tolist():
        k = int(found[row])
        assert recording.texts["block"][row] == f"N{k}"
        if np.isfinite(recording.values["C"][row]) and recording.values["C"][row]:
            assert recording.values["C"][row] == -(k - k % 3)
    return [int(found[row]) for row in rows.tolist()]


def test_a_cut_cable_loses_nothing_that_was_shown_and_leaves_a_gap(tmp_path: Path) -> None:
    async def run() -> Recorder:
        async with serving() as (machine, port), Cable(port).laid() as cable:
            async with Recorder(tmp_path, cable.port) as recorder:
                await move(machine, 1, 200)
                await recorder.has(199.0)
                cable.cut()
                await recorder.until(lambda: recorder.gaps == 1)
                await move(machine, 200, 300)
                cable.mend()
                await recorder.until(lambda: len(recorder.told) == 2)
                await move(machine, 300, 400)
                await recorder.has(399.0)
            return recorder

    recorder = asyncio.run(run())
    recording = read_recording(recorder.file)
    assert steps(recording) == [*range(1, 200), *range(299, 400)]
    gap = [row for row, marks in recording.marks.items() if Mark.GAP in marks]
    assert len(gap) == 1
    assert recording.values["X"][gap[0] - 1] == 199.0
    assert [problem.what.partition(";")[0] for problem in recorder.told] == [
        "the connection is broken", "connected again",
    ]  # fmt: skip
    assert "gone" not in recording.values
    stamps = {round(x): int(t) for x, t in zip(recording.values["X"], recording.source, strict=True) if x > 0}
    assert all(stamps[k] == BEGIN + k * TICK for k in (*range(1, 200), *range(300, 400)))


@pytest.mark.nightly
def test_a_server_that_ends_and_starts_again_is_recorded_on(tmp_path: Path) -> None:
    async def run() -> Recorder:
        async with serving() as (machine, port):
            recorder = Recorder(tmp_path, port)
            await recorder.__aenter__()
            await move(machine, 1, 100)
            await recorder.has(99.0)
        await recorder.until(lambda: recorder.gaps == 1)
        async with serving(port) as (machine, _):
            await recorder.until(lambda: len(recorder.told) == 2)
            await move(machine, 150, 200)
            await recorder.has(199.0)
            await recorder.__aexit__()
        return recorder

    recorder = asyncio.run(run())
    recording = read_recording(recorder.file)
    assert steps(recording) == [*range(1, 100), *range(150, 200)]
    assert sum(Mark.GAP in marks for marks in recording.marks.values()) == 1


def test_clocks_that_jump_lose_nothing_and_are_marked(tmp_path: Path) -> None:
    async def run() -> Recorder:
        async with serving() as (machine, port), Recorder(tmp_path, port) as recorder:
            await move(machine, 1, 100)
            await recorder.has(99.0)
            await move(machine, 100, 200, offset=-HOUR)
            await recorder.has(199.0)
            await move(machine, 200, 300, offset=HOUR)
            await recorder.has(299.0)
        return recorder

    recording = read_recording(asyncio.run(run()).file)
    assert steps(recording) == list(range(1, 300))
    marked = {int(recording.values["X"][row]): marks for row, marks in recording.marks.items()}
    assert marked == {100: (Mark.BACK,), 200: (Mark.JUMP,)}
    elapsed = recording.elapsed()
    assert (np.diff(elapsed) >= 0.0).all()
    assert elapsed[-1] < 3600.0


def test_what_is_not_there_is_told_at_once_with_what_there_is(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(NODES + '[columns.Y]\npath = "x/no"\n[columns.Z]\nid = "z"\n', encoding="utf-8")

    async def run() -> None:
        async with serving() as (_, port):
            feed = MachineFeed(Access(f"opc.tcp://127.0.0.1:{port}/"), load_nodes(file), 0.0)
            try:
                await feed.open()
            finally:
                await feed.close()

    with pytest.raises(InputError) as caught:
        asyncio.run(run())
    assert [problem.file for problem in caught.value.problems] == ["x/no", "nsu=urn:tests:machine;s=z"]
    assert "in x there is nothing" in str(caught.value)


def test_nobody_at_the_address_is_an_error_of_input(tmp_path: Path) -> None:
    nodes = load_nodes(write_nodes(tmp_path))
    with pytest.raises(InputError, match="cannot be connected to"):
        asyncio.run(MachineFeed(Access("opc.tcp://127.0.0.1:1/"), nodes, 20.0).open())
