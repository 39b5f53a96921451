"""Rows of what a server notifies, in whatever order and parcels it sends it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.model.recording import Mark
from trunnion.twin.recording.rows import Reading, Row, RowMaker

COLUMNS = 3

#: At each time which columns change; steps of time in microseconds.
changes = st.lists(
    st.tuples(st.integers(1, 50_000), st.sets(st.integers(0, COLUMNS - 1), min_size=1)), min_size=1, max_size=30
)


@st.composite
def told(draw: st.DrawFn) -> tuple[list[Reading], list[tuple[list[Reading], bool]]]:
    """Readings in the order of their time, and the messages in which a server sends them."""
    stamp, readings = 1_000_000, list[Reading]()
    for step, columns in draw(changes):
        stamp += step
        readings += [Reading(column, float(len(readings) + column), stamp) for column in sorted(columns)]
    messages: list[tuple[list[Reading], bool]] = []
    first = 0
    while first < len(readings):
        end = draw(st.integers(first + 1, len(readings)))
        cycle = readings[first:end]
        if draw(st.booleans()):  # one variable after the other, as some servers send them
            cycle = sorted(cycle, key=lambda each: each.column)
        cut = draw(st.integers(0, len(cycle)))
        messages += [(cycle[:cut], True), (cycle[cut:], False)]
        first = end
    return readings, messages


def rows_of(maker: RowMaker, messages: list[tuple[list[Reading], bool]]) -> list[Row]:
    rows = []
    for k, (batch, more) in enumerate(messages):
        rows += maker.add(batch, 2_000_000 + 1000 * k, more=more)
    return rows + maker.flush()


@settings(max_examples=examples(150), deadline=None)
@given(told())
def test_each_time_has_a_row_with_what_all_columns_show_then(
    given_: tuple[list[Reading], list[tuple[list[Reading], bool]]],
) -> None:
    readings, messages = given_
    rows = rows_of(RowMaker(COLUMNS), messages)
    shown: dict[int, list[object]] = {}
    now: list[object] = [None] * COLUMNS
    for reading in readings:
        now[reading.column] = reading.value
        shown[reading.source or 0] = list(now)
    assert [(row.source, row.values) for row in rows] == list(shown.items())
    assert not any(row.marks for row in rows)


@settings(max_examples=examples(100), deadline=None)
@given(told(), told(), st.integers(3_000_000, 10**12))
def test_a_clock_that_is_set_back_is_marked_and_loses_nothing(
    before: tuple[list[Reading], list[tuple[list[Reading], bool]]],
    after: tuple[list[Reading], list[tuple[list[Reading], bool]]],
    back: int,
) -> None:
    ahead = [(
        [Reading(each.column, each.value, (each.source or 0) + back) for each in batch], more
    ) for batch, more in before[1]]  # fmt: skip
    maker = RowMaker(COLUMNS)
    rows = rows_of(maker, ahead) + rows_of(maker, after[1])
    stamps = [(each.source or 0) + back for each in before[0]] + [each.source for each in after[0]]
    assert [row.source for row in rows] == list(dict.fromkeys(stamps))
    first = next(k for k, row in enumerate(rows) if row.source == after[0][0].source)
    assert [k for k, row in enumerate(rows) if Mark.BACK in row.marks] == [first]


def test_a_clock_that_jumps_ahead_is_marked_but_not_values_that_come_late() -> None:
    maker, second = RowMaker(1), 1_000_000
    rows = []
    for k in range(10):
        rows += maker.add([Reading(0, float(k), k * second)], k * second + 5000)
    for k in range(10, 20):  # the network stalls: all come at once
        rows += maker.add([Reading(0, float(k), k * second)], 19 * second + 5000)
    for k in range(20, 30):  # an hour ahead
        rows += maker.add([Reading(0, float(k), (k + 3600) * second)], k * second + 5000)
    rows += maker.flush()
    assert [row.values[0] for row in rows] == [float(k) for k in range(30)]
    assert [k for k, row in enumerate(rows) if row.marks] == [20]
    assert rows[20].marks == [Mark.JUMP]


def test_after_a_break_nothing_is_known() -> None:
    maker = RowMaker(2)
    first = maker.add([Reading(0, 1.0, 10), Reading(1, 2.0, 10)], 20)
    rows = first + maker.broken(30) + maker.add([Reading(0, 3.0, 5)], 40) + maker.flush()
    assert [(row.source, row.values, row.marks) for row in rows] == [
        (10, [1.0, 2.0], []), (None, [None, None], [Mark.GAP]), (5, [3.0, None], []),
    ]  # fmt: skip
    assert rows[1].received == 30


def test_values_that_the_server_has_dropped_are_marked() -> None:
    maker = RowMaker(1)
    rows = maker.add([Reading(0, 1.0, 1), Reading(0, 9.0, 2, overflow=True)], 5) + maker.flush()
    assert [row.marks for row in rows] == [[], [Mark.LOST]]


@pytest.mark.parametrize("stamp", [None, 77])
def test_without_a_time_of_the_machine_that_of_the_server_counts(stamp: int | None) -> None:
    maker = RowMaker(1)
    rows = maker.add([Reading(0, 1.0, None, stamp)], 100) + maker.flush()
    assert (rows[0].source, rows[0].server, rows[0].received) == (None, stamp, 100)
