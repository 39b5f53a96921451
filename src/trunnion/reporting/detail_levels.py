"""Fewer points that show the same from afar, for programs too long to draw point by point.

A level cuts the time of the program into equal buckets. Of each it keeps the first row, the last, and the rows where
each column is lowest and highest. They are real rows, so every point drawn has a block of its own.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass
from trunnion.reporting.plot_series import PlotSeries, SingleFloats

#: Programs with no more points than this are drawn as they are, and so are stretches of longer ones.
MAX_DIRECT_POINTS = 40_000

#: Buckets of the coarsest level, and the factor from one level to the next.
COARSEST_BUCKETS, BUCKET_FACTOR = 1_000, 3

#: With fewer buckets than this in view, the page takes the next finer level.
BUCKETS_IN_VIEW = 600


@dataclass(frozen=True, slots=True, eq=False)
class DetailLevel:
    """The points that stand for all, as indices (k,), and the number of buckets they come from."""

    buckets: int
    rows: Ints


def detail_levels(series: PlotSeries) -> Iterator[DetailLevel]:
    """Yield levels from coarse to fine, none for short programs.

    A stretch too short for the finest level has at most ``MAX_DIRECT_POINTS`` points, and is drawn as it is.
    """
    if len(series) <= MAX_DIRECT_POINTS:
        return
    time = series.time()
    buckets = COARSEST_BUCKETS
    while True:
        yield DetailLevel(buckets, extreme_rows(tuple(series.values.values()), bucket_of(time, buckets)))
        if len(series) * BUCKETS_IN_VIEW <= MAX_DIRECT_POINTS * buckets:
            return
        buckets *= BUCKET_FACTOR


def bucket_of(time: Floats, buckets: int) -> Ints:
    """Bucket of each point, (n,) int64, increasing: equal pieces of ``time`` (n,)."""
    whole = time[-1] - time[0]
    if whole <= 0.0:
        return np.zeros(len(time), np.int64)
    bucket: Ints = np.minimum((time - time[0]) / whole * buckets, buckets - 1).astype(np.int64)
    return bucket


def extreme_rows(columns: Sequence[SingleFloats], bucket: Ints) -> Ints:
    """Rows to keep, increasing: of each bucket the first, the last, and the first at each column's extremes.

    columns   (n,) float32 each; NaN counts as 0
    bucket    (n,) int64, increasing
    """
    starts = np.flatnonzero(np.diff(bucket, prepend=bucket[0] - 1))
    sizes = np.diff(starts, append=len(bucket))
    keep = np.zeros(len(bucket), np.bool_)
    keep[starts] = True
    keep[starts + sizes - 1] = True
    for each in columns:
        column = np.nan_to_num(each)
        for extreme in (np.minimum, np.maximum):
            hits = np.flatnonzero(column == np.repeat(extreme.reduceat(column, starts), sizes))
            keep[hits[np.searchsorted(hits, starts)]] = True
    return np.flatnonzero(keep)


def select_rows(series: PlotSeries, rows: Ints) -> PlotSeries:
    """Return a series of these points only, at their times as closely as float32 differences give them."""
    return replace(
        series,
        seconds=np.diff(series.time()[rows], prepend=0.0).astype(np.float32),
        values={name: column[rows] for name, column in series.values.items()},
        lines={name: column[rows] for name, column in series.lines.items()},
    )
