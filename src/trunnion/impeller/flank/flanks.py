"""A flank: points and normals of a grid on one side of a blade.

Units: mm.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Flank:
    """A grid on a flank: the first index goes along the blade, the second from its lower to its upper end.

    points   (n, m, 3)
    normals  (n, m, 3) unit vectors to the side of the cutter
    """

    points: Floats
    normals: Floats

    def flat(self) -> Floats:
        """All points (n · m, 3)."""
        return self.points.reshape(-1, 3)

    def smoothed(self, share: float) -> "Flank":
        """Return the same points with the mean of the normals over so large a share of the flank's length."""
        count = len(self.normals)
        half = max(int(share * count / 2.0), 1)
        total = np.concatenate((np.zeros((1, *self.normals.shape[1:])), np.cumsum(self.normals, axis=0)))
        first, last = np.maximum(np.arange(count) - half, 0), np.minimum(np.arange(count) + half + 1, count)
        mean = (total[last] - total[first]).mean(axis=1, keepdims=True)
        mean /= np.maximum(np.linalg.norm(mean, axis=2), 1e-9)[:, :, None]
        return Flank(self.points, np.broadcast_to(mean, self.points.shape))
