"""Columns that are kept by what changes, against lists."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from trunnion.readers.control.row_buffer import RampColumnBuilder, StepColumnBuilder

NUMBERS = st.lists(st.sampled_from([-1, 0, 1, 5, 10, 11, 12, 13, 20, 999_999_999_999_999]), max_size=30)
CLIMBS = st.lists(st.tuples(st.integers(-1, 50), st.integers(-3, 10), st.integers(1, 6)), max_size=8).map(
    lambda ramps: [value + step * k for value, step, length in ramps for k in range(length)]
)


@given(numbers=NUMBERS | CLIMBS, piece=st.integers(1, 40))
def test_a_climb_gives_back_what_was_added(numbers: list[int], piece: int) -> None:
    climb = RampColumnBuilder()
    for start in range(0, len(numbers), piece):
        climb.extend(np.array(numbers[start : start + piece], np.int64))
    ramps = climb.ramps()
    assert ramps.column(np.int64).tolist() == numbers
    assert [ramps[row] for row in range(len(ramps))] == numbers
    assert [ramps[row - len(ramps)] for row in range(len(ramps))] == numbers


def test_even_numbers_are_one_ramp_and_a_leap_begins_another() -> None:
    climb = RampColumnBuilder()
    climb.extend(np.array([10, 20, 30, 40, 70, 80, 90, 90, 90], np.int64))
    assert climb.ramps().rows.tolist() == [0, 4, 7]


@given(
    st.lists(st.tuples(st.integers(0, 4), st.sampled_from([0.0, 1.0, 2.5, float("nan")])), max_size=12),
    st.integers(0, 40),
    st.integers(-2, 45),
    st.integers(0, 45),
)
def test_steps_are_the_values_that_were_set(changes: list[tuple[int, float]], n: int, start: int, length: int) -> None:
    column, values, row = StepColumnBuilder(0.0), [0.0] * n, 0
    for gap, value in changes:
        row += gap
        column.set(row, value)
        values[row:] = [value] * max(n - row, 0)
    steps = column.steps(n, np.float64)
    np.testing.assert_array_equal(steps.column(), values)
    np.testing.assert_array_equal(steps.at(np.arange(n)), values)
    np.testing.assert_array_equal([steps[k] for k in range(n)], values)
    first, end = max(min(start, n), 0), max(min(start + length, n), 0)
    np.testing.assert_array_equal(steps.part(first, end), values[first:end])
    known = [value for value in values if value == value]
    assert set(steps.distinct()[~np.isnan(steps.distinct())].tolist()) == set(known)
    assert steps.rows_with(1.0).tolist() == [k for k, value in enumerate(values) if value == 1.0]
    assert steps.rows_changing_to(1.0) == [k for k in range(n) if values[k] == 1.0 and (k == 0 or values[k - 1] != 1.0)]
