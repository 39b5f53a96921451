"""Row numbers stored as ranges, against a list of them."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from trunnion.verification.row_ranges import RowRanges

FLAGS = st.lists(st.booleans(), max_size=40)


@given(flags=FLAGS, piece=st.integers(1, 50), start=st.integers(-3, 45), length=st.integers(0, 45))
def test_rows_are_the_numbers_of_the_rows_that_have_a_flag(
    flags: list[bool], piece: int, start: int, length: int
) -> None:
    numbers = [row for row, flag in enumerate(flags) if flag]
    column = np.array(flags, np.bool_)
    rows = RowRanges.from_flags((first, column[first : first + piece]) for first in range(0, len(flags), piece))
    assert [rows[k] for k in range(len(rows))] == numbers
    assert [rows[k - len(rows)] for k in range(len(rows))] == numbers
    begin, end = max(start, 0), max(start, 0) + length
    assert rows.rows(begin, end).tolist() == numbers[begin:end]
    assert rows.count_before(start) == sum(number < start for number in numbers)
    assert (start in rows) == (start in numbers)


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(0, 4)), max_size=8))
def test_rows_can_be_made_from_ranges(gaps: list[tuple[int, int]]) -> None:
    ranges, at = [], 0
    for gap, count in gaps:
        ranges.append((at + gap, count))
        at += gap + count
    rows = RowRanges.from_ranges(ranges)
    wanted = [first + k for first, count in ranges for k in range(count)]
    assert rows.rows(0, len(rows)).tolist() == wanted
