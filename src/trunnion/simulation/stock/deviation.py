"""The finished stock against the design: what is left on it, and what is missing.

In:     stock as it is, and the stretches of the design and of the stock at the start along the same rays.
Out:    volumes, the greatest thickness, and the places where it is.
Units:  mm, workpiece frame.

The thickness at a ray is that of ``stretch_kernel``. At a place the smallest of the three bundles counts: a sliver that
is thin across a wall is long for the rays along the wall.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Floats2, Ints, Lines
from trunnion.jit import kernel
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans

#: Places that are told, and how many cells they are apart at least.
_MOST_PLACES: Final = 10
_APART: Final = 5.0


@dataclass(frozen=True, slots=True)
class Place:
    """A place in the workpiece frame, mm, and how thick what is wrong is there, mm."""

    at: tuple[float, float, float]
    thickness: float


@dataclass(frozen=True, slots=True)
class Excess:
    """What one solid has and the other has not: mm³, the greatest thickness in mm, and the thickest places."""

    volume: float
    largest: float
    places: tuple[Place, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Gouges:
    """Which rows made the surfaces at which something is missing: (k,) row, thickness in mm, and place (k, 3)."""

    row: Ints
    thickness: Floats
    place: Floats


def left_on(stock: Stock, design: tuple[Spans, Spans, Spans], limit: float) -> Excess:
    """What the stock has beyond the design; places thinner than ``limit`` are not told."""
    volume, place, thin, _ = _compared(stock, [stock.spans(bundle) for bundle in range(3)], list(design))
    return _excess(stock, volume, place, thin, limit)


def missing_from(
    stock: Stock, start: tuple[Spans, Spans, Spans], design: tuple[Spans, Spans, Spans], limit: float
) -> tuple[Excess, Gouges]:
    """What of the design was in the stock at the start, and is there no more; and the rows that took it away.

    A row is found by the surface that it has left there: what was cut deeper later, the later row did.
    """
    was = [_common(own, wanted) for own, wanted in zip(start, design, strict=True)]
    volume, place, thin, rows = _compared(stock, was, [stock.spans(bundle) for bundle in range(3)])
    deep = np.flatnonzero(thin > limit)
    row = np.concatenate((rows[deep, 0], rows[deep, 1]))
    known = row >= 0
    gouges = Gouges(row[known], np.tile(thin[deep], 2)[known], np.tile(place[deep], (2, 1))[known])
    return _excess(stock, volume, place, thin, limit), gouges


def _compared(stock: Stock, solid: list[Spans], other: list[Spans]) -> tuple[float, Floats, Floats, Ints]:
    """Volume of what only the first solid has; place, thickness and the rows at both ends of each stretch."""
    lattice, volume = stock.lattice, 0.0
    firsts, tables = [], []
    for bundle in range(3):
        first, table = _difference(solid[bundle], other[bundle])
        volume += stock.cell_area(bundle) * float((table[:, 1] - table[:, 0]).sum()) / 3.0
        firsts.append(first)
        tables.append(table)
    points, thickness, rows = [np.zeros((0, 3))], [np.zeros(0)], [np.zeros((0, 2), np.int64)]
    for bundle in range(3):
        axes = list(BUNDLE_AXES[bundle])
        u, v = lattice.ray_positions(bundle)
        ray = np.repeat(np.arange(len(firsts[bundle]) - 1), np.diff(firsts[bundle]))
        place = np.empty((len(ray), 3))
        place[:, axes[0]], place[:, axes[1]] = u[ray // len(v)], v[ray % len(v)]
        place[:, axes[2]] = tables[bundle][:, :2].mean(axis=1)
        thin = tables[bundle][:, 2].copy()
        for across in range(3):
            if across != bundle:
                cell = np.floor((place - lattice.low) / lattice.cell).astype(np.int64)
                cell = np.clip(cell, 0, np.array(lattice.counts) - 1)
                one, two, along = BUNDLE_AXES[across]
                at = cell[:, one] * lattice.counts[two] + cell[:, two]
                thinner_here(firsts[across], tables[across], at, place[:, along].copy(), thin)
        points.append(place)
        thickness.append(thin)
        rows.append(tables[bundle][:, 3:].astype(np.int64))
    return volume, np.concatenate(points), np.concatenate(thickness), np.concatenate(rows)


def _excess(stock: Stock, volume: float, place: Floats, thin: Floats, limit: float) -> Excess:
    largest = float(thin.max(initial=0.0))
    return Excess(volume, largest, _thickest(place, thin, limit, _APART * float(stock.lattice.cell.max())))


def _thickest(place: Floats, thickness: Floats, limit: float, apart: float) -> tuple[Place, ...]:
    """The thickest places, apart from each other."""
    kept: list[Place] = []
    chosen = np.zeros((0, 3))
    open_ = np.flatnonzero(thickness > limit)
    open_ = open_[np.argsort(-thickness[open_], kind="stable")]
    while len(open_) and len(kept) < _MOST_PLACES:
        at = place[open_[0]]
        x, y, z = at.tolist()
        kept.append(Place((x, y, z), float(thickness[open_[0]])))
        chosen = np.concatenate((chosen, at[None]))
        open_ = open_[np.linalg.norm(place[open_] - at, axis=1) >= apart]
    return tuple(kept)


def _common(one: Spans, two: Spans) -> Spans:
    """What both have."""
    counts = np.zeros(len(one.first) - 1, np.int64)
    arrays = one.first, one.ends, _slopes(one), two.first, two.ends, _slopes(two)
    common_stretches(*arrays, counts, np.zeros((0, 2)), np.zeros((0, 2)), True)
    first = np.concatenate(([0], np.cumsum(counts)))
    ends, slopes = np.zeros((first[-1], 2)), np.zeros((first[-1], 2))
    common_stretches(*arrays, first[:-1].copy(), ends, slopes, False)
    normals = np.zeros((2 * len(ends), 3), np.int8)
    normals[:, 2] = np.round(127.0 * slopes.ravel()).astype(np.int8)
    return Spans(first, ends.ravel(), normals)


def _slopes(spans: Spans) -> Floats:
    return np.asarray(np.abs(spans.normals[:, 2].astype(np.float64)) / 127.0)


def _difference(solid: Spans, other: Spans) -> tuple[Ints, Floats]:
    """Stretches of a solid outside another: first of each ray, and for each start, end, thickness, and the rows that
    cut the other where it ends below, and where it begins above; -1 for none."""
    counts = np.zeros(len(solid.first) - 1, np.int64)
    arrays = solid.first, solid.ends, _slopes(solid), other.first, other.ends, _slopes(other)
    difference_stretches(*arrays, other.rows, counts, np.zeros((0, 5)), True)
    first = np.concatenate(([0], np.cumsum(counts)))
    table = np.zeros((first[-1], 5))
    difference_stretches(*arrays, other.rows, first[:-1].copy(), table, False)
    return first, table


@kernel(writes="at table")
def difference_stretches(
    first: Ints,
    ends: Floats,
    slope: Floats,
    other_first: Ints,
    other_ends: Floats,
    other_slope: Floats,
    other_rows: Lines,
    at: Ints,
    table: Floats2,
    counting: bool,
) -> None:
    """Count the stretches of each ray outside another solid in ``at``; or write them, as ``_difference`` has them."""
    for ray in range(len(first) - 1):
        for s in range(first[ray], first[ray + 1]):
            start, from_slope, from_other = ends[2 * s], slope[2 * s], False
            for m in range(other_first[ray], other_first[ray + 1] + 1):
                last = m == other_first[ray + 1]
                end, to_slope, to_other = ends[2 * s + 1], slope[2 * s + 1], False
                if not last:
                    if other_ends[2 * m + 1] <= start:
                        continue
                    if other_ends[2 * m] < end:
                        end, to_slope, to_other = other_ends[2 * m], other_slope[2 * m], True
                if end - start > 1e-7:
                    if not counting:
                        k = at[ray]
                        table[k, 0], table[k, 1] = start, end
                        table[k, 2] = (end - start) * min(from_slope, to_slope)
                        table[k, 3] = other_rows[2 * m - 1] if from_other else -1.0
                        table[k, 4] = other_rows[2 * m] if to_other else -1.0
                    at[ray] += 1
                if last or other_ends[2 * m + 1] >= ends[2 * s + 1]:
                    break
                start, from_slope, from_other = other_ends[2 * m + 1], other_slope[2 * m + 1], True


@kernel(writes="at ends slopes")
def common_stretches(
    first: Ints,
    one: Floats,
    one_slope: Floats,
    other_first: Ints,
    other: Floats,
    other_slope: Floats,
    at: Ints,
    ends: Floats2,
    slopes: Floats2,
    counting: bool,
) -> None:
    """Count the stretches that both solids have in ``at``; or write their ends and the slopes there from there on."""
    for ray in range(len(first) - 1):
        for s in range(first[ray], first[ray + 1]):
            for m in range(other_first[ray], other_first[ray + 1]):
                start, end = max(one[2 * s], other[2 * m]), min(one[2 * s + 1], other[2 * m + 1])
                if end - start > 1e-7:
                    if not counting:
                        k = at[ray]
                        ends[k, 0], ends[k, 1] = start, end
                        slopes[k, 0] = one_slope[2 * s] if one[2 * s] >= other[2 * m] else other_slope[2 * m]
                        beyond = one[2 * s + 1] <= other[2 * m + 1]
                        slopes[k, 1] = one_slope[2 * s + 1] if beyond else other_slope[2 * m + 1]
                    at[ray] += 1


@kernel(writes="thin")
def thinner_here(first: Ints, table: Floats2, rays: Ints, along: Floats, thin: Floats) -> None:
    """Lower ``thin`` (n,) to the thickness of the stretch of ray ``rays[k]`` in which ``along[k]`` lies, if it does."""
    for k in range(len(rays)):
        for s in range(first[rays[k]], first[rays[k] + 1]):
            if table[s, 0] <= along[k] <= table[s, 1]:
                thin[k] = min(thin[k], table[s, 2])
