"""The block form of a program whose stock is known: the box around it, as it is clamped.

In:     stock as it is drawn, as the simulation takes it, and how the part is clamped.
Out:    the corners, as the setting ``blank`` has them.
Units:  mm, coordinates of the program.
"""

from pathlib import Path

import numpy as np

from trunnion.model.clamping import Clamping
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.solids import stock_shape
from trunnion.simulation.turned_parts import as_clamped


def corners_of_stock(stock: str | Path | TriangleMesh, clamping: Clamping) -> str:
    """Return the lower and the upper corner of the box around stock, as ``X,Y,Z,X,Y,Z``.

    Raises ``InputError`` if it states none.
    """
    low, high = as_clamped(stock_shape(stock).as_mesh(), clamping.rotation).bounds
    return ",".join(f"{value:.4f}" for value in np.concatenate((low, high)).tolist())
