"""The columns of a run while its program runs: dense ones, and builders of compact ones."""

from array import array
from bisect import bisect_right
from typing import Any, Final, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.columns import RampColumn, StepColumn

T = TypeVar("T", int, float, bool)

#: Rows that may be unresolved at a time: the length of the buffers that only these rows need.
MAX_UNRESOLVED_ROWS: Final = 16384


class RowBuffer:
    """The dense columns of a run; ``n`` rows are in use, and the axis positions of the first ``resolved`` are final.

    ``xyz`` is the tool tip or the slide positions, as in ``Run.xyz``. The rotary columns of unresolved rows hold the
    programmed values, or NaN. Four columns hold only the rows from ``base`` on, row ``base + k`` at index k: line and
    number of the block, its programmed vector or NaN, and the turn rule of its rotary words (see
    ``trunnion.model.axis_positions``). When these are full, ``clear`` empties them.
    """

    def __init__(self, capacity: int = 4096) -> None:
        self.n = 0
        self.resolved = 0
        self.base = 0
        self.kind = np.empty(capacity, np.uint8)
        self.programmed = np.empty(capacity, np.uint8)
        self.xyz = np.empty((capacity, 3))
        self.rotary = np.empty((capacity, 2))
        self.line = np.empty(MAX_UNRESOLVED_ROWS, np.int64)
        self.block_number = np.empty(MAX_UNRESOLVED_ROWS, np.int64)
        self.vector = np.empty((MAX_UNRESOLVED_ROWS, 3))
        self.turn_rule = np.empty(MAX_UNRESOLVED_ROWS, np.uint8)
        self.lines = RampColumnBuilder()
        self.block_numbers = RampColumnBuilder()

    _GROWING = ("kind", "programmed", "xyz", "rotary")

    @property
    def capacity(self) -> int:
        """Number of rows that fit."""
        return len(self.kind)

    @property
    def free(self) -> int:
        """Number of rows that fit before ``clear`` must be called."""
        return MAX_UNRESOLVED_ROWS - (self.n - self.base)

    def clear(self) -> None:
        """Compact lines and block numbers, and empty the buffers of unresolved rows; all rows must be resolved."""
        self.lines.extend(self.line[: self.n - self.base])
        self.block_numbers.extend(self.block_number[: self.n - self.base])
        self.base = self.n

    def reserve(self, rows: int, expected: int = 0) -> None:
        """Make room for ``rows`` more rows, or for ``expected`` rows in all if that is more.

        Memory that is never written to costs nothing, copying rows does: a good estimate of the length pays. Columns
        are copied one after another, so that little memory is held twice.
        """
        needed = self.n + rows
        if needed <= self.capacity:
            return
        size = max(needed, expected, self.capacity + self.capacity // 2)
        for name in self._GROWING:
            old = getattr(self, name)
            new = np.empty((size, *old.shape[1:]), old.dtype)
            new[: self.n] = old[: self.n]
            setattr(self, name, new)


class RampColumnBuilder:
    """Builds a ``RampColumn``."""

    def __init__(self) -> None:
        self._n = 0
        self._ramps: list[Ints] = []

    def extend(self, values: Ints) -> None:
        """Append rows."""
        if not len(values):
            return
        step = np.diff(values)
        # A row that breaks the even sequence begins a ramp; the row after it gives the increment, whatever it is.
        uneven = np.flatnonzero(np.diff(step)) + 2
        place = np.arange(len(uneven))
        lead = np.maximum.accumulate(np.where(np.diff(uneven, prepend=-1) > 1, place, 0))
        begin = np.concatenate(([0], uneven[(place - lead) % 2 == 0]))
        self._ramps.append(np.stack((self._n + begin, values[begin], np.append(step, 0)[begin])))
        self._n += len(values)

    def ramps(self) -> RampColumn:
        """Return the column of all appended rows."""
        return RampColumn(self._n, *np.concatenate((np.zeros((3, 0), np.int64), *self._ramps), axis=1))


class StepColumnBuilder(Generic[T]):
    """Builds a ``StepColumn``; knows the value in force."""

    def __init__(self, value: T) -> None:
        self._rows = array("q", [0])
        self._values: array[Any] = array("d" if isinstance(value, float) else "q", [value])

    @property
    def current(self) -> T:
        """The value in force."""
        current: T = self._values[-1]
        return current

    def set(self, row: int, value: T) -> None:
        """Let ``value`` hold from ``row`` on."""
        if _same_value(value, self._values[-1]):
            return
        if self._rows[-1] == row:
            self._values[-1] = value
            if len(self._values) > 1 and _same_value(self._values[-2], value):
                self._rows.pop()
                self._values.pop()
            return
        self._rows.append(row)
        self._values.append(value)

    def part(self, first: int, end: int) -> Flags:
        """Return whether the value is other than 0 in the rows from ``first`` to before ``end``, (end - first,)."""
        change = bisect_right(self._rows, first) - 1
        bounds = np.append(np.clip(np.array(self._rows[change:]), first, end), end)
        return np.repeat(np.array(self._values[change:], np.bool_), np.diff(bounds))

    def extend(self, rows: Ints, values: Floats) -> None:
        """Append changes at ascending rows beyond the last change; every value differs from the one before it."""
        self._rows.frombytes(rows.tobytes())
        self._values.frombytes(values.tobytes())

    def steps(self, n: int, dtype: type[np.generic]) -> StepColumn:
        """Return the column with n rows; nothing may be added afterwards."""
        values: NDArray[Any] = np.frombuffer(self._values, self._values.typecode)
        return StepColumn(n, np.frombuffer(self._rows, np.int64), values.astype(dtype, copy=False))


def _same_value(one: float, two: float) -> bool:
    """Whether two values are the same; unknown (NaN) equals unknown."""
    return one == two or (one != one and two != two)
