"""Which motions a question is answered of: how many, and the first that is left out for each reason."""

from collections.abc import Iterable
from dataclasses import field

import numpy as np

from trunnion.arrays import Flags
from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class SeenRows:
    """Counts rows, chunk by chunk.

    checked   how many the question is answered of
    left_out  of the others the first row for each reason, by its reason
    """

    checked: int = 0
    left_out: dict[Wording, int] = field(default_factory=dict)

    def add(self, first: int, count: int, left_out: Iterable[tuple[Wording, Flags]]) -> None:
        """Add ``count`` rows from ``first`` on; of several reasons the first one counts."""
        seen = np.ones(count, np.bool_)
        for why, which in left_out:
            here = seen & which
            if here.any():
                self.left_out.setdefault(why, first + int(np.argmax(here)))
                seen &= ~which
        self.checked += int(np.count_nonzero(seen))
