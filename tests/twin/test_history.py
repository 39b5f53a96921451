"""The history of a number, against a list of all that was."""

import asyncio
from datetime import UTC, datetime, timedelta

from asyncua import ua
from hypothesis import given
from hypothesis import strategies as st

from trunnion.twin.opcua.history import NumberHistory, TwinHistory

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


@given(
    steps=st.lists(st.integers(1, 1000), max_size=60), kept=st.integers(1, 40), first=st.integers(0, 20_000),
    span=st.integers(0, 20_000),
)  # fmt: skip
def test_it_keeps_the_last_values_in_order(steps: list[int], kept: int, first: int, span: int) -> None:
    history, all_of_it, time = NumberHistory(kept), [], 0
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
    storage.numbers[node] = NumberHistory(kind=ua.VariantType.UInt32)
    storage.numbers[node].add(1, 7)
    values, _ = asyncio.run(storage.read_node_history(node, at(0.0), at(1.0), 0))
    assert [(each.Value.Value, each.Value.VariantType) for each in values] == [(7, ua.VariantType.UInt32)]


def test_clients_read_it_forwards_backwards_and_in_parts() -> None:
    storage, node = TwinHistory(), ua.NodeId("x", 2)
    storage.numbers[node] = NumberHistory()
    for k in range(25_000):
        storage.numbers[node].add(k * 1000, float(k))

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
