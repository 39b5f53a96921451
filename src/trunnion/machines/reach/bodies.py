"""The body that the tips of one rotary position fill while the slides go through their travel."""

from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines.forward import forward
from trunnion.machines.machine import Machine
from trunnion.records import dataclass

#: A slide goes so far to find its direction, mm: with less the rounding of positions would count.
_FAR: Final = 1024.0

#: Slides that span less than this, by the volume of their unit vectors, are dependent, as in the inverse map.
_FLAT: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class PoseBodies:
    """Parallelepipeds of k rotary positions: what lies between three pairs of planes.

    normal   (k, 3, 3) float64  unit vector square to each pair of planes, workpiece frame
    low      (k, 3) float64     distance of the lower plane of each pair from the workpiece zero, along the normal, mm
    high     (k, 3) float64     of the upper plane
    corners  (k, 8, 3) float64  mm
    volume   (k,) float64       mm^3, exact; 0 where the slides are linearly dependent, and then no planes are meant
    """

    normal: Floats
    low: Floats
    high: Floats
    corners: Floats
    volume: Floats

    @property
    def solid(self) -> Flags:
        """Which have a volume, (k,)."""
        return np.asarray(self.volume > 0.0)

    def select(self, which: Flags) -> "PoseBodies":
        """Return some of them."""
        return PoseBodies(
            self.normal[which], self.low[which], self.high[which], self.corners[which], self.volume[which]
        )


def pose_bodies(machine: Machine, rotary: Floats) -> PoseBodies:
    """Return the bodies that the tips of rotary positions fill.

    machine  its slides have finite limits
    rotary   (k, 2) float64, deg: in the order of ``machine.rotary``
    """
    count, slides = len(rotary), list(machine.linear)
    joints = np.zeros((4, count, 5))
    joints[:, :, list(machine.rotary)] = rotary
    for k, slide in enumerate(slides):
        joints[k + 1, :, slide] = _FAR
    tips = forward(machine, joints.reshape(-1, 5))[0].reshape(4, count, 3)
    origin, ways = tips[0], np.moveaxis(tips[1:] - tips[0], 0, 1) / _FAR  # (k, slide, 3)
    limits = machine.limits[slides]
    size = np.abs(np.linalg.det(ways))
    flat = size < _FLAT
    # Row i of the inverse is square to both other slides, and its product with a way along slide i is that way.
    inverse = np.moveaxis(np.linalg.inv(np.where(flat[:, None, None], np.eye(3), ways)), 1, 2)
    length = np.linalg.norm(inverse, axis=2)
    normal = inverse / length[:, :, None]
    base = np.einsum("kij,kj->ki", normal, origin)
    corners = np.array(list(product(*limits.tolist())))
    return PoseBodies(
        normal,
        base + limits[:, 0] / length,
        base + limits[:, 1] / length,
        origin[:, None, :] + np.einsum("cs,ksj->kcj", corners, ways),
        np.where(flat, 0.0, size * float(np.prod(limits[:, 1] - limits[:, 0]))),
    )
