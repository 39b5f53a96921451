"""The surface of stock as points, and how far each is from the design.

In:     stock, and the design along the same rays.
Out:    ``SurfacePoints``.
Units:  mm, workpiece frame.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints, Lines
from trunnion.records import dataclass
from trunnion.simulation.stock.differences import Stretches, compare_solids
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans

#: Ends of stretches that differ by less than this are the same, mm.
_SAME_END: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class SurfacePoints:
    """The surface of stock where rays pass it, k points.

    place      (k, 3)  mm
    normal     (k, 3)  unit vectors out of the material
    area       (k,)    mm² that a point stands for: together, the surface
    deviation  (k,)    mm of material beyond the design there, negative where something is missing; None without design
    row        (k,)    row of the run that made it, ``UNCUT`` for the stock itself
    """

    place: Floats
    normal: Floats
    area: Floats
    deviation: Floats | None
    row: Lines


def surface_points(stock: Stock, design: tuple[Spans, Spans, Spans] | None) -> SurfacePoints:
    """Return the surface of stock as points, with how far each is from the design."""
    wholes = [stock.spans(bundle) for bundle in range(3)]
    over = None if design is None else compare_solids(stock, wholes, list(design))
    under = None if design is None else compare_solids(stock, list(design), wholes)
    parts = []
    for bundle in range(3):
        axes, spans = list(BUNDLE_AXES[bundle]), wholes[bundle]
        u, v = stock.lattice.ray_positions(bundle)
        ray = np.repeat(np.arange(len(spans.first) - 1), 2 * np.diff(spans.first))
        place, normal = np.empty((len(ray), 3)), np.empty((len(ray), 3))
        place[:, axes] = np.column_stack((u[ray // len(v)], v[ray % len(v)], spans.ends))
        normal[:, axes] = spans.normals / 127.0
        off = np.zeros(len(ray))
        if over is not None and under is not None:
            off += _at_ends(over, bundle, ray, spans.ends) - _at_ends(under, bundle, ray, spans.ends)
        area = stock.cell_area(bundle) * np.abs(spans.normals[:, 2]) / 127.0
        parts.append((place, normal, area, off, spans.rows))
    place, normal, area, off, row = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return SurfacePoints(place, normal, area, off if design is not None else None, row)


def _at_ends(found: Stretches, bundle: int, ray: Ints, ends: Floats) -> Floats:
    """Return the thickness of the stretch that begins or ends at each end of a ray; 0 where none does."""
    own = np.flatnonzero(found.bundle == bundle)
    if not len(own) or not len(ends):
        return np.zeros(len(ends))
    low = min(float(ends.min()), float(found.ends[own].min())) - 1.0
    size = max(float(ends.max()), float(found.ends[own].max())) - low + 1.0
    keys = np.concatenate((found.ray[own], found.ray[own])) * size + found.ends[own].T.ravel() - low
    values = np.tile(found.thickness[own], 2)
    order = np.argsort(keys, kind="stable")
    keys, values = keys[order], values[order]
    wanted = ray * size + ends - low
    at = np.clip(np.searchsorted(keys, wanted - _SAME_END), 0, len(keys) - 1)
    return np.where(np.abs(keys[at] - wanted) <= _SAME_END, values[at], 0.0)
