"""The worst values of many rows, collected chunk by chunk."""

from dataclasses import field

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class WorstRows:
    """The largest value of many rows, and the rows beyond a limit.

    value, row  the largest value and its row, -1 where no value is above 0
    count       how many rows are beyond ``limit``
    rows        up to ``max_rows`` of them as (row, value), worst first
    """

    limit: float
    max_rows: int
    value: float = 0.0
    row: int = -1
    count: int = 0
    rows: list[tuple[int, float]] = field(default_factory=list)

    def add(self, first: int, values: Floats) -> None:
        """Add the values of consecutive rows from ``first`` on."""
        if not len(values):
            return
        k = int(np.argmax(values))
        if values[k] > self.value:
            self.value, self.row = float(values[k]), first + k
        if values[k] <= self.limit:
            return
        beyond = np.flatnonzero(values > self.limit)
        self.count += len(beyond)
        worst = beyond[np.argsort(-values[beyond], kind="stable")[: self.max_rows]]
        found = [*self.rows, *((first + int(k), float(values[k])) for k in worst)]
        self.rows = sorted(found, key=lambda row_and_value: -row_and_value[1])[: self.max_rows]
