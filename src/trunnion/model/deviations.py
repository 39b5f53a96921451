"""Where a program intentionally differs from its CL file.

The planner writes this record and verification reads it, so it stands where both may import it. It holds claims and
nothing else: verification works out by itself which of them it accepts
(``trunnion.verification.deviations.declared_deviations``).
"""

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Deviations:
    """Rows of one operation, ascending, at which it is not made as its CL file has it.

    max_lean       degrees by which the tool axis may lean at ``leaned_rows``
    leaned_rows    (k,) int64      rows of the CL file's operation
    leaned_rotary  (k, 2) float64  displayed positions of the rotary axes there, degrees
    slowed_rows    (m,) int64      rows with a lower feed
    slowed_feed    (m,) float64    that feed, in the unit of the CL file's feed
    reached_rows   (r,) int64      rows that have the feed that the axes reach there, and not that of the CL file
    reached_feed   (r,) float64    that feed, mm/min
    """

    max_lean: float
    leaned_rows: Ints
    leaned_rotary: Floats
    slowed_rows: Ints
    slowed_feed: Floats
    reached_rows: Ints
    reached_feed: Floats

    @staticmethod
    def none() -> "Deviations":
        """No row differs."""
        rows, feed = np.zeros(0, np.int64), np.zeros(0)
        return Deviations(0.0, rows, np.zeros((0, 2)), rows, feed, rows, feed)

    @property
    def is_empty(self) -> bool:
        """Whether no row differs."""
        return not (len(self.leaned_rows) or len(self.slowed_rows) or len(self.reached_rows))

    def without_rows(self, removed: Flags) -> "Deviations":
        """Return the deviations of the remaining rows, renumbered, once ``removed`` (n,) bool rows are taken out."""
        new_row = np.cumsum(~removed) - 1
        lean, slow, reach = (~removed[rows] for rows in (self.leaned_rows, self.slowed_rows, self.reached_rows))
        return Deviations(
            self.max_lean,
            new_row[self.leaned_rows[lean]],
            self.leaned_rotary[lean],
            new_row[self.slowed_rows[slow]],
            self.slowed_feed[slow],
            new_row[self.reached_rows[reach]],
            self.reached_feed[reach],
        )
