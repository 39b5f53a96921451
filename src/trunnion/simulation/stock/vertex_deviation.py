"""How far the vertices of a stock's surface are from the design: what its points in the same cell say.

In:     the surface as points, and the vertices of its mesh.
Out:    a deviation for each vertex.
Units:  mm.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.simulation.stock.lattice import Lattice
from trunnion.simulation.stock.surface_points import SurfacePoints

#: Where points are looked for, one after another, in cells from that of the vertex.
_AROUND: Final = ((0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))


def vertex_deviation(points: SurfacePoints, vertices: Floats, lattice: Lattice) -> Floats:
    """Return the greatest deviation of the points in the cell of each vertex, (n,), or in one beside it; else 0."""
    found = np.zeros(len(vertices))
    if points.deviation is None or not len(points.place):
        return found
    order = np.argsort(np.abs(points.deviation), kind="stable")
    keys = _keys(lattice, points.place[order])
    # Of the points of a cell the last one, which deviates most, stays.
    last = np.argsort(keys, kind="stable")
    ends = np.flatnonzero(np.diff(keys[last], append=-1))
    cells, greatest = keys[last][ends], points.deviation[order][last][ends]
    open_ = np.ones(len(vertices), np.bool_)
    for step in _AROUND:
        wanted = _keys(lattice, vertices + step * lattice.cell)
        at = np.clip(np.searchsorted(cells, wanted), 0, len(cells) - 1)
        hit = open_ & (cells[at] == wanted)
        found[hit] = greatest[at[hit]]
        open_ &= ~hit
    return found


def _keys(lattice: Lattice, places: Floats) -> Ints:
    """Return a number for the cell of each place, also for those around the lattice."""
    cell = np.floor((places - lattice.low) / lattice.cell + 1e-6).astype(np.int64) + 2
    _, y, z = lattice.counts
    return np.asarray((cell[:, 0] * (y + 5) + cell[:, 1]) * (z + 5) + cell[:, 2])
