"""The rows of a program whose tool's centre goes elsewhere than its blocks say.

In:     a verification, whose columns have a row for each motion of the program, and the run of the tool's centre.
Out:    the same columns, rows and places for the rows of that run: what is inserted before a row belongs to it.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.verification.results import OperationRows


@dataclass(frozen=True, eq=False)
class DrivenRows:
    """The run of the tool's centre, and where the rows of the program end in it (``CentreRun``)."""

    run: Run
    row_of: Ints

    @cached_property
    def own(self) -> Ints:
        """The row of the program to which each row belongs, (n,)."""
        return np.searchsorted(self.row_of, np.arange(len(self.run)))

    def column(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return a column of the program's rows for these; an empty one stays."""
        return values[self.own] if len(values) else values

    def seconds(self, values: Floats) -> Floats:
        """Return the times of rows: that of each row of the program is shared by the ways of what belongs to it."""
        if len(values) == len(self.run) or not len(values):
            return values
        tip = self.run.positions(np.arange(-1, len(self.run))).tip
        way = np.linalg.norm(np.diff(tip, axis=0), axis=1) + 1e-9
        return np.asarray(values[self.own] * way / np.bincount(self.own, way)[self.own])

    def row(self, row: int) -> int:
        """Return where a row of the program ends; the row before which something stands may be behind the last."""
        if row < 0:
            return row
        return int(self.row_of[row]) if row < len(self.row_of) else row + len(self.run) - len(self.row_of)

    def operations(self, operations: Iterable[OperationRows]) -> Iterator[OperationRows]:
        """Yield operations of the program with these rows."""
        for each in operations:
            first = self.row(each.first - 1) + 1 if each.first else 0
            yield replace(each, first=first, end=self.row(each.end - 1) + 1 if each.end else 0)
