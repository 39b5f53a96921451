"""How far points are off the exact surfaces of an impeller.

In:     points of a mesh or of faces.
Out:    their distances.
Units:  mm.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import Fillet
from trunnion.impeller.impeller import Impeller, rotated

#: A point so near to a surface is on it, mm.
_CLOSE: Final = 1e-6


def off_surfaces(impeller: Impeller, points: Floats, fillets: Sequence[tuple[Blade, Fillet]]) -> Floats:
    """How far points (k, 3) are from the nearest exact surface, (k,) mm.

    ``fillets`` are those of the blade, and of the splitter if there is one; the path of their ball is taken as chords
    between their stations.
    """
    stock = impeller.definition.stock
    radius = np.hypot(points[:, 0], points[:, 1])
    turned = [radius - stock.diameter / 2.0, points[:, 2] - stock.top, points[:, 2] - stock.bottom]
    if stock.bore:
        turned.append(radius - stock.bore / 2.0)
    turned += [impeller.hub.distances(points)[0], impeller.shroud.distances(points)[0]]
    off = np.abs(np.stack(turned)).min(axis=0)
    for blade, angle in impeller.blades():
        rows = np.flatnonzero(off > _CLOSE)
        back = rotated(points[rows], -angle)
        fillet = next(found for own, found in fillets if own is blade)
        found = np.minimum(
            np.abs(_from_path(fillet, back) - impeller.definition.fillet), np.abs(blade.distances(back)[0])
        )
        off[rows] = np.minimum(off[rows], found)
    return np.asarray(off)


def _from_path(fillet: Fillet, points: Floats) -> Floats:
    """Distance (k,) of points to the path of a fillet's ball, mm: chords between its stations."""
    centre = np.vstack((fillet.centre, fillet.centre[:1])) if fillet.is_closed else fillet.centre
    _, nearest = import_extra("scipy.spatial", "impeller").cKDTree(centre).query(points)
    best = np.full(len(points), np.inf)
    for first in (nearest - 1, nearest):
        k = np.clip(first, 0, len(centre) - 2)
        along = centre[k + 1] - centre[k]
        square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-24)
        share = np.clip(np.einsum("ij,ij->i", points - centre[k], along) / square, 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(points - centre[k] - share[:, None] * along, axis=1))
    return best
