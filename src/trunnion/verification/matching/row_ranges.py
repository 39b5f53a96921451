"""Many growing row numbers, kept as the unbroken stretches that they make: most programs have few."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Ints


@dataclass(frozen=True, slots=True, eq=False)
class RowRanges:
    """Row numbers, each larger than the one before; ``rows[k]`` is one of them, ``len(rows)`` how many there are.

    first   (m,) int64     the first number of each stretch
    begin   (m + 1,) int64 how many numbers come before it; at last, how many there are
    """

    first: Ints
    begin: Ints

    @staticmethod
    def of(stretches: Iterable[tuple[int, int]]) -> "RowRanges":
        """From stretches as (first number, how many)."""
        pairs = np.array([pair for pair in stretches if pair[1]], np.int64).reshape(-1, 2)
        return RowRanges(pairs[:, 0].copy(), np.concatenate(([0], np.cumsum(pairs[:, 1]))))

    @staticmethod
    def where(pieces: Iterable[tuple[int, Flags]]) -> "RowRanges":
        """Numbers of rows that have a flag; pieces as (number of the first row, flags), one after the other."""
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
        stretch = int(np.searchsorted(self.begin, k, "right")) - 1
        return int(self.first[stretch] + k - self.begin[stretch])

    def part(self, start: int, end: int) -> Ints:
        """The numbers from the ``start``-th to the one before the ``end``-th, (k,); fewer if there are fewer."""
        first, count = self._cut(start, end)
        if len(first) == 1:
            return np.arange(first[0], first[0] + count[0])
        behind = np.cumsum(count)
        return np.arange(behind[-1] if len(behind) else 0) + np.repeat(first - behind + count, count)

    def stretches(self, start: int, end: int) -> list[tuple[int, int]]:
        """The numbers of ``part`` as stretches, for ``of``."""
        first, count = self._cut(start, end)
        return list(zip(first.tolist(), count.tolist(), strict=True))

    def _cut(self, start: int, end: int) -> tuple[Ints, Ints]:
        """First number and length of the stretches from the ``start``-th to the one before the ``end``-th number."""
        start, end = max(start, 0), min(end, len(self))
        if start >= end:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        low = int(self.begin.searchsorted(start, "right")) - 1
        high = int(self.begin.searchsorted(end))
        bounds = np.minimum(np.maximum(self.begin[low : high + 1], start), end)
        return self.first[low:high] + bounds[:-1] - self.begin[low:high], bounds[1:] - bounds[:-1]

    def before(self, row: int) -> int:
        """How many of the numbers are less than a number."""
        stretch = int(np.searchsorted(self.first, row)) - 1
        if stretch < 0:
            return 0
        return int(min(self.begin[stretch] + row - self.first[stretch], self.begin[stretch + 1]))

    def __contains__(self, row: int) -> bool:
        k = self.before(row)
        return k < len(self) and self[k] == row
