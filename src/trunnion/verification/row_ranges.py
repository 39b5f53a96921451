"""Many increasing row numbers, stored as the unbroken ranges that they form: most programs have few."""

from collections.abc import Iterable, Iterator

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.records import dataclass

#: Rows that are worked on at a time, so that their columns stay in the processor's cache.
CHUNK = 8192

#: The same for flags and other columns of a byte.
_FLAG_CHUNK = 65536


def chunk_bounds(count: int) -> Iterator[tuple[int, int]]:
    """First row and end (exclusive) of the chunks of ``count`` rows, in order, for work on flags."""
    for start in range(0, count, _FLAG_CHUNK):
        yield start, min(start + _FLAG_CHUNK, count)


@dataclass(frozen=True, slots=True, eq=False)
class RowRanges:
    """Row numbers, each larger than the one before; ``rows[k]`` is the k-th of them and ``len(rows)`` their number.

    first   (m,) int64     the first number of each range
    begin   (m + 1,) int64 how many numbers come before each range; at the end, how many there are
    """

    first: Ints
    begin: Ints

    @staticmethod
    def from_ranges(ranges: Iterable[tuple[int, int]]) -> "RowRanges":
        """From ranges as (first number, count), in order."""
        pairs = np.array([pair for pair in ranges if pair[1]], np.int64).reshape(-1, 2)
        return RowRanges(pairs[:, 0].copy(), np.concatenate(([0], np.cumsum(pairs[:, 1]))))

    @staticmethod
    def from_flags(pieces: Iterable[tuple[int, Flags]]) -> "RowRanges":
        """Return the rows whose flag is set; consecutive pieces as (number of the first row, flags)."""
        first, count = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
        for start, flags in pieces:
            edges = np.flatnonzero(np.diff(flags, prepend=False, append=False)).reshape(-1, 2)
            first.append(start + edges[:, 0])
            count.append(edges[:, 1] - edges[:, 0])
        return RowRanges(np.concatenate(first), np.concatenate(([0], np.cumsum(np.concatenate(count)))))

    def __len__(self) -> int:
        return int(self.begin[-1])

    def __getitem__(self, k: int) -> int:
        k = k if k >= 0 else len(self) + k
        if not 0 <= k < len(self):
            raise IndexError(k)
        which = int(np.searchsorted(self.begin, k, "right")) - 1
        return int(self.first[which] + k - self.begin[which])

    def __contains__(self, row: int) -> bool:
        k = self.count_before(row)
        return k < len(self) and self[k] == row

    def rows(self, start: int, end: int) -> Ints:
        """Return the ``start``-th number to the one before the ``end``-th, (k,); fewer where there are no more."""
        first, count = self._clip(start, end)
        if len(first) == 1:
            return np.arange(first[0], first[0] + count[0])
        behind = np.cumsum(count)
        return np.arange(behind[-1] if len(behind) else 0) + np.repeat(first - behind + count, count)

    def ranges(self, start: int, end: int) -> list[tuple[int, int]]:
        """Return the numbers of ``rows`` as (first number, count)."""
        first, count = self._clip(start, end)
        return list(zip(first.tolist(), count.tolist(), strict=True))

    def _clip(self, start: int, end: int) -> tuple[Ints, Ints]:
        """First number and length of the ranges from the ``start``-th number to the one before the ``end``-th."""
        start, end = max(start, 0), min(end, len(self))
        if start >= end:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        low = int(self.begin.searchsorted(start, "right")) - 1
        high = int(self.begin.searchsorted(end))
        bounds = np.minimum(np.maximum(self.begin[low : high + 1], start), end)
        return self.first[low:high] + bounds[:-1] - self.begin[low:high], bounds[1:] - bounds[:-1]

    def count_before(self, row: int) -> int:
        """How many of the numbers are less than ``row``."""
        which = int(np.searchsorted(self.first, row)) - 1
        if which < 0:
            return 0
        return int(min(self.begin[which] + row - self.first[which], self.begin[which + 1]))
