"""The motions that drill one hole, and what may be wrong with them.

Heights are as in ``trunnion.verification.expected.holes``.
"""

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class HoleFault:
    """A row of the run, the value found there, and what is wrong."""

    row: int
    value: float
    said: Wording


@dataclass(frozen=True, slots=True, eq=False)
class DrillMotions:
    """The rows that drill a hole, (k,) each.

    row        rows of the run
    kind       a ``Kind`` each; a motion that a CL point asks for counts as a rapid
    height     of the tip at their ends
    by_motion  they are motions of the program itself, not of a cycle
    """

    row: Ints
    kind: Codes
    height: Floats
    by_motion: bool

    @property
    def bottom(self) -> int:
        """Index of the deepest row."""
        return int(np.argmin(self.height))

    def fault(self, k: int, value: float, said: Wording) -> HoleFault:
        """Return a fault at the k-th row."""
        return HoleFault(int(self.row[k]), value, said)
