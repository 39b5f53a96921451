"""The columns of the plots, their levels of detail, and their encoding."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from tests.support.page_columns import decode_column
from tests.support.reports import blade, waves
from trunnion.reporting.column_encoding import encode_column
from trunnion.reporting.detail_levels import (
    BUCKETS_IN_VIEW,
    MAX_DIRECT_POINTS,
    bucket_of,
    detail_levels,
    extreme_rows,
    select_rows,
)
from trunnion.reporting.plot_series import collect_series

SINGLES = st.floats(-1e6, 1e6, width=32)


def extreme_rows_naive(columns: list[NDArray[np.float32]], bucket: list[int]) -> list[int]:
    """The reference implementation of ``extreme_rows``, bucket by bucket."""
    keep: set[int] = set()
    for name in sorted(set(bucket)):
        rows = [row for row, at in enumerate(bucket) if at == name]
        keep |= {rows[0], rows[-1]}
        for column in columns:
            keep |= {min(rows, key=lambda row: (column[row], row)), min(rows, key=lambda row: (-column[row], row))}
    return sorted(keep)


@given(
    data=st.data(),
    n=st.integers(1, 60),
    steps=st.lists(st.integers(0, 2), min_size=60, max_size=60),
)
def test_levels_keep_the_extremes_of_every_bucket(data: st.DataObject, n: int, steps: list[int]) -> None:
    few = st.sampled_from([-1.0, 0.0, 1.0]) | SINGLES
    columns = [data.draw(arrays.arrays(np.float32, n, elements=few)) for _ in range(2)]
    bucket = np.cumsum(np.array(steps[:n], np.int64))
    rows = extreme_rows(columns, bucket)
    assert rows.tolist() == extreme_rows_naive(columns, bucket.tolist())
    for at in np.unique(bucket):
        for column in columns:
            every, some = column[bucket == at], column[rows[bucket[rows] == at]]
            assert (every.min(), every.max()) == (some.min(), some.max())


@given(arrays.arrays(np.float64, st.integers(1, 50), elements=st.floats(0, 1e4)), st.integers(1, 20))
def test_buckets_are_pieces_of_equal_time(seconds: NDArray[np.float64], buckets: int) -> None:
    time = np.cumsum(seconds)
    bucket = bucket_of(time, buckets)
    assert (np.diff(bucket) >= 0).all()
    assert bucket.min() >= 0
    assert bucket.max() < buckets
    width = (time[-1] - time[0]) / buckets
    assert (np.abs(time - time[0] - (bucket + 0.5) * width) <= width * 0.5 + 1e-6).all()


def test_levels_grow_finer_until_a_stretch_can_be_drawn_as_it_is() -> None:
    series = collect_series(waves(400_000))
    found = list(detail_levels(series))
    assert len(found) == 3
    assert [len(level.rows) for level in found] == sorted(len(level.rows) for level in found)
    assert len(series) / found[-1].buckets * BUCKETS_IN_VIEW <= MAX_DIRECT_POINTS
    assert not list(detail_levels(collect_series(blade())))


def test_a_level_spans_the_same_time_and_shows_real_blocks() -> None:
    series = collect_series(waves(60_000))
    level = next(detail_levels(series))
    coarse = select_rows(series, level.rows)
    assert abs(coarse.time()[-1] - series.time()[-1]) < 1e-3
    assert np.array_equal(coarse.lines["block"], level.rows)
    for name, column in series.values.items():
        assert (coarse.values[name].min(), coarse.values[name].max()) == (column.min(), column.max())


def test_rotary_speeds_are_the_turn_of_each_motion_over_its_time() -> None:
    verification = blade()
    series = collect_series(verification)
    run, before = verification.run, verification.run.start[1]
    for row in range(len(run)):
        turn, seconds = abs(run.joints[row, 1] - before), verification.seconds[row]
        wanted = turn / seconds * 60 if seconds > 0 else 0.0
        assert series.values["speed1"][row + 1] == np.float32(wanted)
        before = run.joints[row, 1]


def test_the_tool_changes_are_marked() -> None:
    assert collect_series(blade()).tool_changes == ((2, "2"),)


@given(
    arrays.arrays(np.int32, st.integers(0, 40))
    | arrays.arrays(np.float32, st.integers(0, 40), elements=st.floats(width=32))
)
def test_what_is_packed_comes_back_bit_by_bit(column: NDArray[np.int32] | NDArray[np.float32]) -> None:
    assert np.array_equal(decode_column(encode_column(column)), column.view(np.int32))
