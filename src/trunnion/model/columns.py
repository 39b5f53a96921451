"""Columns of a run in compact form: values that change seldom, and whole numbers that increase evenly."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Ints, distinct
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class StepColumn:
    """A column of n rows that changes seldom: ``values[k]`` holds from row ``rows[k]`` on.

    rows     (m,) int64, ascending; the first is 0, and the last ones may be n or more
    values   (m,)
    """

    n: int
    rows: Ints
    values: NDArray[Any]

    @staticmethod
    def constant(n: int, value: float, dtype: type[np.generic]) -> "StepColumn":
        """Return a column with one value throughout."""
        return StepColumn(n, np.zeros(1, np.int64), np.array([value], dtype))

    def __len__(self) -> int:
        return self.n

    def __getitem__(self, row: int) -> Any:
        """Return the value of one row, counted from the end if negative."""
        row = row if row >= 0 else self.n + row
        if not 0 <= row < self.n:
            raise IndexError(row)
        return self.values[np.searchsorted(self.rows, row, "right") - 1].item()

    def at(self, rows: Ints) -> NDArray[Any]:
        """Return the values of rows in any order, (k,)."""
        if not len(rows):
            return self.values[:0].copy()
        low, high = np.searchsorted(self.rows, (rows.min(), rows.max()), "right").tolist()
        if low == high:  # no change lies between them
            return np.full(len(rows), self.values[low - 1])
        return np.asarray(self.values[np.searchsorted(self.rows, rows, "right") - 1])

    def part(self, first: int, end: int) -> NDArray[Any]:
        """Return the values of consecutive rows, (end - first,)."""
        if len(self.rows) == 1:
            return np.full(end - first, self.values[0])
        low = int(self.rows.searchsorted(first, "right")) - 1
        high = max(int(self.rows.searchsorted(end)), low + 1)
        if high == low + 1:
            return np.full(end - first, self.values[low])
        bounds = np.append(self.rows[low:high], end)
        bounds[0] = first
        return np.repeat(self.values[low:high], np.diff(bounds))

    def column(self) -> NDArray[Any]:
        """Return the whole column, (n,), read-only."""
        whole = self.part(0, self.n)
        whole.setflags(write=False)
        return whole

    def distinct(self) -> NDArray[Any]:
        """Return the values that occur, each once, ascending."""
        return distinct(self.values[: np.searchsorted(self.rows, self.n)])

    def rows_changing_to(self, value: float) -> list[int]:
        """Return the rows at which the column changes to a value."""
        return [int(self.rows[k]) for k in np.flatnonzero(self.values == value) if self.rows[k] < self.n]

    def rows_with(self, value: float) -> Ints:
        """Return the rows that have a value, ascending."""
        ends = np.minimum(np.append(self.rows[1:], self.n), self.n)
        found = [np.arange(self.rows[k], ends[k]) for k in np.flatnonzero(self.values == value).tolist()]
        return np.concatenate((np.zeros(0, np.int64), *found))


@dataclass(frozen=True, slots=True, eq=False)
class RampColumn:
    """A column of n whole numbers that mostly increase evenly, as line and block numbers do.

    It is ``values[k]`` at row ``rows[k]`` and increases by ``steps[k]`` with every row after it; all (m,) int64.
    """

    n: int
    rows: Ints
    values: Ints
    steps: Ints

    def __len__(self) -> int:
        return self.n

    def __getitem__(self, row: int) -> int:
        row = row if row >= 0 else self.n + row
        if not 0 <= row < self.n:
            raise IndexError(row)
        k = int(np.searchsorted(self.rows, row, "right")) - 1
        return int(self.values[k] + self.steps[k] * (row - self.rows[k]))

    def column(self, dtype: type[np.generic]) -> NDArray[Any]:
        """Return the whole column, (n,), read-only."""
        length = np.diff(self.rows, append=self.n)
        column = np.repeat(self.steps, length)
        column *= np.arange(self.n) - np.repeat(self.rows, length)
        column += np.repeat(self.values, length)
        whole = column.astype(dtype, copy=False)
        whole.setflags(write=False)
        return whole
