"""The lattice of rays on which stock is kept: three bundles, parallel to X, Y and Z, through the centres of cells.

Units:  mm, workpiece frame.

Bundle k has rays parallel to axis k. In its own coordinates (u, v, w) w counts along the rays: u, v, w are Y, Z, X for
bundle 0, Z, X, Y for bundle 1 and X, Y, Z for bundle 2, so that all three systems are right-handed. Cells divide the
stock's box exactly. No face of the box contains a ray.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass

#: Axes u, v, w of each bundle.
BUNDLE_AXES: Final = ((1, 2, 0), (2, 0, 1), (0, 1, 2))


@dataclass(frozen=True, slots=True, eq=False)
class Lattice:
    """The cells of a box.

    low, high  (3,) corners of the box, mm
    counts     cells along X, Y and Z
    """

    low: Floats
    high: Floats
    counts: tuple[int, int, int]

    @staticmethod
    def of_box(low: Floats, high: Floats, cell: float) -> "Lattice":
        """Divide a box into cells that are at most ``cell`` wide, mm."""
        size = np.asarray(high, np.float64) - np.asarray(low, np.float64)
        x, y, z = (max(1, math.ceil(length / cell - 1e-9)) for length in size)
        return Lattice(np.asarray(low, np.float64), np.asarray(high, np.float64), (x, y, z))

    @property
    def cell(self) -> Floats:
        """Width of a cell along X, Y and Z, (3,), mm."""
        return np.asarray((self.high - self.low) / np.array(self.counts))

    def rays(self, bundle: int) -> tuple[int, int]:
        """Return number of rays of a bundle along its u and v."""
        u, v, _ = BUNDLE_AXES[bundle]
        return self.counts[u], self.counts[v]

    @property
    def ray_count(self) -> int:
        """Number of rays of all bundles."""
        return sum(math.prod(self.rays(bundle)) for bundle in range(3))

    def ray_positions(self, bundle: int) -> tuple[Floats, Floats]:
        """Where the rays of a bundle are along u, and along v, mm."""
        u, v, _ = BUNDLE_AXES[bundle]
        cell = self.cell
        first, second = (self.low[k] + (np.arange(self.counts[k]) + 0.5) * cell[k] for k in (u, v))
        return first, second
