"""Columns that grow, and values that change seldom, kept by the rows at which they change."""

from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints

T = TypeVar("T", int, float, bool)


class Columns:
    """The dense columns of a run while it is being made; ``n`` rows are in use.

    ``way`` says per row how its rotary words want to be reached (two nibbles, see ``trunnion.reader.poses``). Until a
    row is settled, ``tip`` holds what the block said (tip, or slide values), ``axis`` a programmed vector or NaN, and
    the rotary columns of ``joints`` the programmed values or NaN.
    """

    def __init__(self, capacity: int = 4096) -> None:
        self.n = 0
        self.block = np.empty(capacity, np.int32)
        self.number = np.empty(capacity, np.int64)
        self.kind = np.empty(capacity, np.uint8)
        self.programmed = np.empty(capacity, np.uint8)
        self.way = np.empty(capacity, np.uint8)
        self.feed = np.empty(capacity)
        self.tip = np.empty((capacity, 3))
        self.axis = np.empty((capacity, 3))
        self.joints = np.empty((capacity, 5))

    _NAMES = ("block", "number", "kind", "programmed", "way", "feed", "tip", "axis", "joints")

    @property
    def capacity(self) -> int:
        """Rows there is room for."""
        return len(self.block)

    def reserve(self, rows: int) -> None:
        """Make room for this many rows more. One column after another, so that little is held twice."""
        wanted = self.n + rows
        if wanted <= self.capacity:
            return
        size = max(wanted, self.capacity + self.capacity // 2)
        for name in self._NAMES:
            old = getattr(self, name)
            new = np.empty((size, *old.shape[1:]), old.dtype)
            new[: self.n] = old[: self.n]
            setattr(self, name, new)


class Changes(Generic[T]):
    """A value for every row, kept as the rows from which it holds."""

    def __init__(self, value: T) -> None:
        self.rows: list[int] = [0]
        self.values: list[T] = [value]

    @property
    def now(self) -> T:
        """The value in force."""
        return self.values[-1]

    def set(self, row: int, value: T) -> None:
        """Let ``value`` hold from ``row`` on."""
        if value == self.values[-1]:
            return
        if self.rows[-1] == row:
            self.values[-1] = value
            if len(self.values) > 1 and self.values[-2] == value:
                self.rows.pop()
                self.values.pop()
            return
        self.rows.append(row)
        self.values.append(value)

    def column(self, n: int, dtype: type[np.generic]) -> NDArray[Any]:
        """One value a row, (n,)."""
        rows: Ints = np.minimum(np.array([*self.rows, n], np.int64), n)
        return np.repeat(np.array(self.values, dtype), np.diff(rows))


def affine(linear: Floats, shift: Floats) -> Floats:
    """(3, 4) float64 from (3, 3) and (3,): applied as ``m[:, :3] @ p + m[:, 3]``."""
    return np.ascontiguousarray(np.column_stack((linear, shift)))
