"""The finished stock against the design: what is left on it, and what is missing.

In:     stock as it is, and the stretches of the design and of the stock at the start along the same rays.
Out:    volumes, the greatest thickness, and the places where it is.
Units:  mm, workpiece frame.

The thickness at a ray is that of ``stretch_kernel``. At a place the smallest of the three bundles counts: a sliver that
is thin across a wall is long for the rays along the wall. What is missing is not thicker than twice the way from its
middle to the surface that is gone.
"""

import math
from dataclasses import replace
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.records import dataclass
from trunnion.results import Figure, Millimetres
from trunnion.simulation.stock.differences import OWN_END, Stretches, common, compare_solids
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans

#: Places that are told, and how many cells they are apart at least.
_MOST_PLACES: Final = 10
_APART: Final = 5.0

#: A surface whose normal is so near to a ray, as a cosine, is flat across the cell.
_ACROSS: Final = 0.99

#: Buckets of the surface along its longest side.
_BUCKETS: Final = 64


@dataclass(frozen=True, slots=True)
class ExcessPlace:
    """A place in the workpiece frame, mm, and how thick what is wrong is there, mm."""

    at: Annotated[tuple[float, float, float], Figure("place")]
    thickness: Annotated[float, Figure("depth", unit="mm")]


@dataclass(frozen=True, slots=True)
class Excess:
    """What one solid has and the other has not: mm³, the greatest thickness in mm, and the thickest places."""

    volume: Annotated[float, Figure(unit="mm3", after="largest_mm")]
    largest: Millimetres
    places: tuple[ExcessPlace, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Gouges:
    """Which rows made the surfaces at which something is missing: (k,) row, thickness in mm, and place (k, 3).

    whole  what is missing altogether, so that no surface tells who took it; None where there is none
    """

    row: Ints
    thickness: Floats
    place: Floats
    whole: tuple[Spans, Spans, Spans] | None = None


def left_on(stock: Stock, design: tuple[Spans, Spans, Spans], limit: float) -> Excess:
    """Return what the stock has beyond the design; places thinner than ``limit`` are not told."""
    found = compare_solids(stock, [stock.spans(bundle) for bundle in range(3)], list(design))
    return _excess(stock, found, limit)


def lacking_at_start(stock: Stock, design: tuple[Spans, Spans, Spans], limit: float) -> Excess:
    """Return what of the design is not in stock that nothing has cut yet; places thinner than ``limit`` are
    not told.
    """
    found = compare_solids(stock, list(design), [stock.spans(bundle) for bundle in range(3)])
    return _excess(stock, replace(found, thickness=_from_surface(stock, found, limit)), limit)


def missing_from(
    stock: Stock, start: tuple[Spans, Spans, Spans], design: tuple[Spans, Spans, Spans], limit: float
) -> tuple[Excess, Gouges]:
    """Return what of the design was in the stock at the start, and is there no more; and the rows that took it away.

    A row is found by the surface that it has left there: what was cut deeper later, the later row did.
    """
    was = [common(own, wanted) for own, wanted in zip(start, design, strict=True)]
    found = compare_solids(stock, was, [stock.spans(bundle) for bundle in range(3)])
    found = replace(found, thickness=_from_surface(stock, found, limit))
    deep = np.flatnonzero(found.thickness > limit)
    row = np.concatenate((found.rows[deep, 0], found.rows[deep, 1]))
    known = row >= 0
    gouges = Gouges(
        row[known], np.tile(found.thickness[deep], 2)[known], np.tile(found.place[deep], (2, 1))[known],
        _whole(stock, found, deep),
    )  # fmt: skip
    return _excess(stock, found, limit), gouges


def _from_surface(stock: Stock, found: Stretches, limit: float) -> Floats:
    """Return the thickness of what is missing, and twice the way from its middle to the surface that is gone, if that
    is less.

    Where a block gouges floor and wall, rays along both see neither: what is missing is long there in all bundles.
    """
    thin = found.thickness.copy()
    deep = np.flatnonzero(thin > limit)
    if not len(deep):
        return thin
    points, halves = [], []
    for side in range(2):
        own = deep[found.rows[deep, side] == OWN_END]
        point, half = found.place[own].copy(), np.tile(0.5 * stock.lattice.cell, (len(own), 1))
        point[np.arange(len(own)), found.bundle[own]] = found.ends[own, side]
        half[np.arange(len(own)), found.bundle[own]] = 0.0
        half[found.slopes[own, side] < _ACROSS] = 0.0
        points.append(point)
        halves.append(half)
    surface, patch = np.concatenate(points), np.concatenate(halves)
    if not len(surface):
        return thin
    low = surface.min(axis=0)
    step = max(float((surface.max(axis=0) - low).max()) / _BUCKETS, float(stock.lattice.cell.max()))
    bucket = np.floor((surface - low) / step).astype(np.int64)
    x, y, z = (bucket.max(axis=0) + 1).tolist()
    number = (bucket[:, 0] * y + bucket[:, 1]) * z + bucket[:, 2]
    order = np.argsort(number, kind="stable")
    first = np.searchsorted(number[order], np.arange(x * y * z + 1))
    nearer = thin[deep]
    twice_to_surface(found.place[deep], surface[order], patch[order], first, low, step, np.array([x, y, z]), nearer)
    thin[deep] = nearer
    return thin


def _whole(stock: Stock, found: Stretches, deep: Ints) -> tuple[Spans, Spans, Spans] | None:
    """Return the deep stretches of which no ray knows what took them, for nothing is left around them; None without
    any.
    """
    gone = deep[~found.is_cut[deep]]
    if not len(gone):
        return None
    spans = []
    for bundle in range(3):
        own = gone[found.bundle[gone] == bundle]
        counts = np.bincount(found.ray[own], minlength=math.prod(stock.lattice.rays(bundle)))
        normals = np.zeros((2 * len(own), 3), np.int8)
        normals[:, 2] = 127
        spans.append(Spans(np.concatenate(([0], np.cumsum(counts))), found.ends[own].ravel(), normals))
    return spans[0], spans[1], spans[2]


def _excess(stock: Stock, found: Stretches, limit: float) -> Excess:
    largest = float(found.thickness.max(initial=0.0))
    apart = _APART * float(stock.lattice.cell.max())
    return Excess(found.volume, largest, _thickest(found.place, found.thickness, limit, apart))


def _thickest(place: Floats, thickness: Floats, limit: float, apart: float) -> tuple[ExcessPlace, ...]:
    """Return the thickest places, apart from each other."""
    kept: list[ExcessPlace] = []
    chosen = np.zeros((0, 3))
    open_ = np.flatnonzero(thickness > limit)
    open_ = open_[np.argsort(-thickness[open_], kind="stable")]
    while len(open_) and len(kept) < _MOST_PLACES:
        at = place[open_[0]]
        x, y, z = at.tolist()
        kept.append(ExcessPlace((x, y, z), float(thickness[open_[0]])))
        chosen = np.concatenate((chosen, at[None]))
        open_ = open_[np.linalg.norm(place[open_] - at, axis=1) >= apart]
    return tuple(kept)


@kernel(writes="thin")
def twice_to_surface(
    places: Floats2, surface: Floats2, patch: Floats2, first: Ints, low: Floats, step: float, counts: Ints, thin: Floats
) -> None:
    """Lower ``thin`` (n,) to twice the distance from ``places`` (n, 3) to the nearest piece of a surface, mm.

    A piece reaches by ``patch`` (m, 3) to both sides of its point. The points in bucket k of a grid, cubes of ``step``
    from ``low`` on, z fastest, are ``first[k]`` to ``first[k + 1]``.
    """
    for k in range(len(places)):
        middle_x = min(max(math.floor((places[k, 0] - low[0]) / step), 0), counts[0] - 1)
        middle_y = min(max(math.floor((places[k, 1] - low[1]) / step), 0), counts[1] - 1)
        middle_z = min(max(math.floor((places[k, 2] - low[2]) / step), 0), counts[2] - 1)
        best = (0.5 * thin[k]) ** 2
        ring = 0
        # Pieces of the next ring are farther away than the rings within, but for their own size.
        while ring <= 1 or ((ring - 2) * step) ** 2 < best:
            if ring > max(counts[0], counts[1], counts[2]):
                break
            for x in range(max(middle_x - ring, 0), min(middle_x + ring, counts[0] - 1) + 1):
                for y in range(max(middle_y - ring, 0), min(middle_y + ring, counts[1] - 1) + 1):
                    inner = abs(x - middle_x) < ring and abs(y - middle_y) < ring
                    for z in range(max(middle_z - ring, 0), min(middle_z + ring, counts[2] - 1) + 1):
                        if inner and abs(z - middle_z) < ring:
                            continue
                        bucket = (x * counts[1] + y) * counts[2] + z
                        for p in range(first[bucket], first[bucket + 1]):
                            dx = max(abs(surface[p, 0] - places[k, 0]) - patch[p, 0], 0.0)
                            dy = max(abs(surface[p, 1] - places[k, 1]) - patch[p, 1], 0.0)
                            dz = max(abs(surface[p, 2] - places[k, 2]) - patch[p, 2], 0.0)
                            best = min(best, dx * dx + dy * dy + dz * dz)
            ring += 1
        thin[k] = min(thin[k], 2.0 * math.sqrt(best))
