"""The history of a value, against a list of all that was."""

import asyncio
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from asyncua import Client, ua
from hypothesis import given
from hypothesis import strategies as st

from tests.support.twins import served
from trunnion.twin.opcua.history import TwinHistory, ValueHistory

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


@given(
    steps=st.lists(st.integers(1, 1000), max_size=60), kept=st.integers(1, 40), first=st.integers(0, 20_000),
    span=st.integers(0, 20_000),
)  # fmt: skip
def test_it_keeps_the_last_values_in_order(steps: list[int], kept: int, first: int, span: int) -> None:
    history, all_of_it, time = ValueHistory(kept), [], 0
    for k, step in enumerate(steps):
        time += step
        history.add(time, float(k))
        all_of_it.append((time, float(k)))
    times, values = history.between(first, first + span)
    wanted = [each for each in all_of_it[-kept:] if first <= each[0] <= first + span]
    assert list(zip(times.tolist(), values.tolist(), strict=True)) == wanted


def at(seconds: float) -> datetime:
    return EPOCH + timedelta(seconds=seconds)


def test_a_history_of_numbers_of_a_type_has_that_type() -> None:
    storage, node = TwinHistory(), ua.NodeId("x", 2)
    storage.of_node[node] = ValueHistory(kind=ua.VariantType.UInt32)
    storage.of_node[node].add(1, 7)
    values, _ = asyncio.run(storage.read_node_history(node, at(0.0), at(1.0), 0))
    assert [(each.Value.Value, each.Value.VariantType) for each in values] == [(7, ua.VariantType.UInt32)]


def test_long_texts_come_in_as_many_answers_as_they_need(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.twin.opcua.history._MOST_CHARACTERS", 20)
    storage, node = TwinHistory(), ua.NodeId("x", 2)
    storage.of_node[node] = ValueHistory(kept=4, kind=ua.VariantType.String)
    texts = [["", "N1", "N2"], ["N1", "N2", "x" * 100], ["N2", "x" * 100, ""], ["", "N3", ""], ["N3", "N4", ""]]
    for k, each in enumerate(texts):
        storage.of_node[node].add(k, each)
    found, answers = list[list[str]](), list[int]()
    more: datetime | None = at(0.0)
    while more is not None:
        values, more = asyncio.run(storage.read_node_history(node, more, at(1.0), 0))
        answers.append(len(values))
        found += [value.Value.Value for value in values]
    assert found == texts[1:]
    assert answers == [1, 1, 2]


#: A dwell, a message, the same block twice, the second of them without time, a stop.
WORKED = 'N10 G1 X50 F3000\n\tN20 G4 F1 ; 半\nN30 MSG("半")\nN40 X0\nN50 X50\nN50 X50\nN60 M0\nN70 X10\nN80 M30\n'


def test_a_client_reads_which_blocks_ran_in_a_whole_job(tmp_path: Path) -> None:
    """With their times, and the lines around them, though the job was held and stopped."""
    file = tmp_path / "job.mpf"
    file.write_text(f"N1 G40 G17 G710 G94 G90 G60\nN3 G54 D1\n{WORKED}", encoding="utf-8")
    path = "ns=3;s=CncInterface.CncChannelList.Channel1"

    async def until(client: Client, *states: str) -> None:
        while await client.get_node("ns=3;s=Twin.State").read_value() not in states:
            await asyncio.sleep(0.02)

    async def job(address: str) -> tuple[list[ua.DataValue], list[ua.DataValue], bool]:
        async with Client(address) as client:
            twin, blocks = client.get_node("ns=3;s=Twin"), client.get_node(f"{path}.ActProgramBlock")
            await twin.call_method("3:Start")
            await twin.call_method("3:Hold")
            await twin.call_method("3:Start")
            await until(client, "stopped")
            await twin.call_method("3:Start")
            await until(client, "ended")
            historizing = await blocks.read_attribute(ua.AttributeIds.Historizing)
            lines = client.get_node(f"{path}.ActProgramFileOffset")
            told = [await node.read_raw_history(at(0.0), datetime.now(UTC)) for node in (blocks, lines)]
            return told[0], told[1], historizing.Value.Value

    with served(file, "--hold", "--speed", "2") as twin:
        blocks, lines, is_kept = asyncio.run(job(twin.opcua))
    assert is_kept
    assert {value.Value.VariantType for value in blocks} == {ua.VariantType.String}
    texts = ["", *(line.strip() for line in file.read_text(encoding="utf-8").split("\n"))]
    shown = [(value.SourceTimestamp, value.Value.Value) for value in blocks]
    wanted = [(value.SourceTimestamp, value.Value.Value) for value in lines]
    assert [(when, texts[line - 1 : line + 2]) for when, line in wanted if line] == shown[1:]
    assert [line for _, line in wanted if line] == [3, 4, 6, 7, 8, 9, 10, 11]  # all but the message


def test_clients_read_it_forwards_backwards_and_in_parts() -> None:
    storage, node = TwinHistory(), ua.NodeId("x", 2)
    storage.of_node[node] = ValueHistory()
    for k in range(25_000):
        storage.of_node[node].add(k * 1000, float(k))

    def read(start: datetime | None, end: datetime | None, most: int = 0) -> tuple[list[float], datetime | None]:
        values, more = asyncio.run(storage.read_node_history(node, start, end, most))
        return [value.Value.Value for value in values], more

    assert read(at(0.001), at(0.003)) == ([1.0, 2.0, 3.0], None)
    assert read(at(0.003), at(0.001)) == ([3.0, 2.0, 1.0], None)
    assert read(None, at(0.003), 2) == ([3.0, 2.0], None)
    assert read(at(24.998), None) == ([24_998.0, 24_999.0], None)
    found, more = read(at(0.0), at(30.0))
    while more is not None:
        part, more = read(more, at(30.0))
        found += part
    assert found == [float(k) for k in range(25_000)]
