"""Where two solids differ along the rays of a lattice.

In:     the stretches of both along the same rays.
Out:    what only the first has, with its thickness, and what both have.
Units:  mm, workpiece frame.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints, Lines
from trunnion.jit import kernel
from trunnion.records import dataclass
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans

#: ``Stretches.rows`` at an end of the solid itself.
OWN_END: Final = -1


@dataclass(frozen=True, slots=True, eq=False)
class Stretches:
    """What one solid has and another has not, as m stretches of rays; ``volume`` is that of all of them, mm³.

    bundle, ray  (m,)    of which ray
    ends         (m, 2)  where it begins and ends along the ray, mm
    place        (m, 3)  its middle, mm
    thickness    (m,)    mm
    rows         (m, 2)  rows that cut the other solid at both ends; below 0 for none
    slopes       (m, 2)  how far the surfaces there are across the ray: |cosine| of the angle between ray and normal
    is_cut       (m,)    a row cut the other solid here, as one of the three bundles sees
    """

    volume: float
    bundle: Ints
    ray: Ints
    ends: Floats
    place: Floats
    thickness: Floats
    rows: Ints
    slopes: Floats
    is_cut: Flags


def compare_solids(stock: Stock, solid: list[Spans], other: list[Spans]) -> Stretches:
    """Return what only the first solid has."""
    lattice, volume = stock.lattice, 0.0
    firsts, tables = [], []
    for bundle in range(3):
        first, table = difference(solid[bundle], other[bundle])
        volume += stock.cell_area(bundle) * float((table[:, 1] - table[:, 0]).sum()) / 3.0
        firsts.append(first)
        tables.append(table)
    places, thickness, rays, cut = [], [], [], []
    for bundle in range(3):
        axes = list(BUNDLE_AXES[bundle])
        u, v = lattice.ray_positions(bundle)
        ray = np.repeat(np.arange(len(firsts[bundle]) - 1), np.diff(firsts[bundle]))
        place = np.empty((len(ray), 3))
        place[:, axes[0]], place[:, axes[1]] = u[ray // len(v)], v[ray % len(v)]
        place[:, axes[2]] = tables[bundle][:, :2].mean(axis=1)
        thin = tables[bundle][:, 2].copy()
        is_cut: Flags = np.asarray((tables[bundle][:, 3:5] >= 0.0).any(axis=1))
        for across in range(3):
            if across != bundle:
                cell = np.floor((place - lattice.low) / lattice.cell).astype(np.int64)
                cell = np.clip(cell, 0, np.array(lattice.counts) - 1)
                one, two, along = BUNDLE_AXES[across]
                at = cell[:, one] * lattice.counts[two] + cell[:, two]
                thinner_here(firsts[across], tables[across], at, place[:, along].copy(), thin, is_cut)
        places.append(place)
        thickness.append(thin)
        rays.append(ray)
        cut.append(is_cut)
    table = np.concatenate(tables)
    return Stretches(
        volume, np.repeat(np.arange(3), list(map(len, tables))), np.concatenate(rays), table[:, :2],
        np.concatenate(places), np.concatenate(thickness), table[:, 3:5].astype(np.int64), table[:, 5:],
        np.concatenate(cut),
    )  # fmt: skip


def common(one: Spans, two: Spans) -> Spans:
    """Return what both have."""
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


def difference(solid: Spans, other: Spans) -> tuple[Ints, Floats]:
    """Stretches of a solid outside another: first of each ray, and for each start, end, thickness, and the rows that
    cut the other where it ends below, and where it begins above, below 0 for none; and the slopes at both ends."""
    counts = np.zeros(len(solid.first) - 1, np.int64)
    arrays = solid.first, solid.ends, _slopes(solid), other.first, other.ends, _slopes(other)
    difference_stretches(*arrays, other.rows, counts, np.zeros((0, 7)), True)
    first = np.concatenate(([0], np.cumsum(counts)))
    table = np.zeros((first[-1], 7))
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
                        # An end of the solid itself is -1, one of the other that nothing has cut -2.
                        table[k, 3] = -1.0
                        if from_other:
                            table[k, 3] = other_rows[2 * m - 1] if other_rows[2 * m - 1] >= 0 else -2.0
                        table[k, 4] = -1.0
                        if to_other:
                            table[k, 4] = other_rows[2 * m] if other_rows[2 * m] >= 0 else -2.0
                        table[k, 5], table[k, 6] = from_slope, to_slope
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


@kernel(writes="thin is_cut")
def thinner_here(first: Ints, table: Floats2, rays: Ints, along: Floats, thin: Floats, is_cut: Flags) -> None:
    """Lower ``thin`` (n,) to the thickness of the stretch of ray ``rays[k]`` in which ``along[k]`` lies, if it does,
    and note in ``is_cut`` (n,) whether a row has cut an end of it.
    """
    for k in range(len(rays)):
        for s in range(first[rays[k]], first[rays[k] + 1]):
            if table[s, 0] <= along[k] <= table[s, 1]:
                thin[k] = min(thin[k], table[s, 2])
                is_cut[k] = is_cut[k] or table[s, 3] >= 0.0 or table[s, 4] >= 0.0
