"""How far the turn of a rotary axis without TCP leads the tip off a circle.

Units: mm, degrees.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.machines.forward import forward

#: Places on an arc at which it is sampled.
_PLACES: Final = 17


def off_arcs(machine: Machine, joints: Floats, rotary: Ints, rows: Ints) -> Floats:
    """How far the turn within arcs leads the tip off, at least, (k,) mm: as if the slides stood at one of its ends."""
    off = np.zeros(len(rows))
    shares = np.linspace(0.0, 1.0, _PLACES)[:, None]
    for k, row in enumerate(rows.tolist()):
        step = joints[row + 1, rotary] - joints[row, rotary]
        step *= min(1.0, 360.0 / float(np.abs(step).max()))
        for end in (row, row + 1):
            turned = np.tile(joints[end], (len(shares), 1))
            turned[:, rotary] += shares * step * (1.0 if end == row else -1.0)
            tips = forward(machine, turned)[0]
            off[k] = max(off[k], float(np.linalg.norm(tips - tips[0], axis=1).max()))
    return off
