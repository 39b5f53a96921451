"""The columns of a run while its program runs: rows as they are added, and builders of columns stored by changes."""

from array import array
from typing import Any, Final, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints
from trunnion.model.columns import RampColumn, StepColumn

T = TypeVar("T", int, float, bool)

#: Rows that may be unresolved at a time; the buffers of what only they need have this length.
MAX_UNRESOLVED_ROWS: Final = 16384


class RowBuffer:
    """The dense columns of a run while it is being made; ``n`` rows are in use, the first ``resolved`` for good.

    ``xyz`` is the tool tip or the values of the slides, as ``Run.xyz``. The rotary columns of rows that are not
    settled hold the programmed values or NaN. Some columns have only the rows from ``base`` on, that of row
    ``base + k`` at k: line and number of the block, its programmed vector (or NaN) in ``vector``, and in ``turn_rule``
    how its rotary words want to be reached (see ``trunnion.model.axis_positions``). When they are full, ``clear`` takes
    them away.
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
        """Rows there is room for."""
        return len(self.kind)

    @property
    def full(self) -> bool:
        """Whether there is room for no more rows before ``clear``."""
        return self.n - self.base == MAX_UNRESOLVED_ROWS

    def clear(self) -> None:
        """Keep lines and numbers in another form, and begin anew; the rows must be settled."""
        self.lines.extend(self.line[: self.n - self.base])
        self.block_numbers.extend(self.block_number[: self.n - self.base])
        self.base = self.n

    def reserve(self, rows: int, expected: int = 0) -> None:
        """Make room for this many rows more, or for ``expected`` rows in all if that is more.

        Room that nobody writes to costs nothing, rows that are copied do: who knows how long the program is says so.
        One column goes after another, so that little is held twice.
        """
        wanted = self.n + rows
        if wanted <= self.capacity:
            return
        size = max(wanted, expected, self.capacity + self.capacity // 2)
        for name in self._GROWING:
            old = getattr(self, name)
            new = np.empty((size, *old.shape[1:]), old.dtype)
            new[: self.n] = old[: self.n]
            setattr(self, name, new)


class RampColumnBuilder:
    """A column of ``RampColumn`` while it is being made."""

    def __init__(self) -> None:
        self._n = 0
        self._ramps: list[Ints] = []

    def extend(self, values: Ints) -> None:
        """Add rows."""
        if not len(values):
            return
        step = np.diff(values)
        # A row that does not go on evenly begins a ramp; the row after it says how steep that is, whatever it is.
        uneven = np.flatnonzero(np.diff(step)) + 2
        place = np.arange(len(uneven))
        lead = np.maximum.accumulate(np.where(np.diff(uneven, prepend=-1) > 1, place, 0))
        begin = np.concatenate(([0], uneven[(place - lead) % 2 == 0]))
        self._ramps.append(np.stack((self._n + begin, values[begin], np.append(step, 0)[begin])))
        self._n += len(values)

    def ramps(self) -> RampColumn:
        """The column, with as many rows as were added."""
        return RampColumn(self._n, *np.concatenate((np.zeros((3, 0), np.int64), *self._ramps), axis=1))


class StepColumnBuilder(Generic[T]):
    """A column of ``StepColumn`` while it is being made."""

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

    def extend(self, rows: Ints, values: Floats) -> None:
        """Add changes at growing rows, all beyond the last one; each value another one than that before it."""
        self._rows.frombytes(rows.tobytes())
        self._values.frombytes(values.tobytes())

    def steps(self, n: int, dtype: type[np.generic]) -> StepColumn:
        """The column, when it has n rows; nothing may be added afterwards."""
        values: NDArray[Any] = np.frombuffer(self._values, self._values.typecode)
        return StepColumn(n, np.frombuffer(self._rows, np.int64), values.astype(dtype, copy=False))


def _same_value(one: float, two: float) -> bool:
    """Whether two values are the same; not known (NaN) is the same as not known."""
    return one == two or (one != one and two != two)
