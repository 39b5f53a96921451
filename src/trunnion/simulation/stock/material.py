"""Stock as stretches of material along the rays of a lattice, in tiles.

A tile is at most 64 by 64 rays of one bundle with arrays of its own. One thread at a time works on it, so the material
is the same for any number of threads. Where a ray needs more stretches than its tile has room for, the tile gets room.

Memory: 4 bytes for each ray, and 15 for each of its ends of stretches, of which there is room for four at first.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints, Lines
from trunnion.records import dataclass
from trunnion.simulation.stock.lattice import BUNDLE_AXES, Lattice
from trunnion.simulation.stock.spans import Spans

#: Rays of a tile along u and along v.
TILE_RAYS: Final = 64

#: Room for stretches of a ray at first.
_STRETCHES: Final = 2

#: ``Tile.rows`` of an end that no motion has made.
UNCUT: Final = -1


@dataclass(slots=True, eq=False)
class Tile:
    """Some rays of a bundle, v fastest.

    u, v     where the rays are, mm
    count    (r,)         int32    stretches of each ray
    ends     (r, 2 s)     float64  their starts and ends along w, mm
    rows     (r, 2 s)     int32    rows of the run that made them, ``UNCUT`` for the stock itself
    normals  (r, 2 s, 3)  int8     unit normals out of the material in (u, v, w), in 127ths
    """

    bundle: int
    first_u: int
    first_v: int
    u: Floats
    v: Floats
    count: Lines
    ends: Floats
    rows: Lines
    normals: NDArray[np.int8]

    def fill(self, count: Ints | Lines, ends: Floats, rows: Ints | Lines, normals: NDArray[np.int8]) -> None:
        """Make these stretches its material: ``count`` (r,) of each ray, and of all ends one after another (m,) where
        they are, (m,) rows and (m, 3) normals.
        """
        room = max(_STRETCHES, int(count.max(initial=0)))
        used = np.repeat(np.arange(room) < count[:, None], 2, axis=1)
        self.count = count.astype(np.int32)
        self.ends = np.zeros(used.shape)
        self.rows = np.full(used.shape, UNCUT, np.int32)
        self.normals = np.zeros((*used.shape, 3), np.int8)
        self.ends[used], self.rows[used], self.normals[used] = ends, rows, normals

    def widen(self) -> None:
        """Make room for twice the stretches."""
        self.ends = np.concatenate((self.ends, np.zeros_like(self.ends)), axis=1)
        self.rows = np.concatenate((self.rows, np.full_like(self.rows, UNCUT)), axis=1)
        self.normals = np.concatenate((self.normals, np.zeros_like(self.normals)), axis=1)

    @property
    def box(self) -> Floats:
        """Lowest and highest u, v, w of its material, (6,), mm; without any, the lowest are above the highest."""
        some = np.flatnonzero(self.count)
        if not len(some):
            return np.array([math.inf, -math.inf] * 3)
        low, high = self.ends[some, 0].min(), self.ends[some, 2 * self.count[some] - 1].max()
        return np.array([self.u[0], self.u[-1], self.v[0], self.v[-1], low, high])

    def volume_per_area(self) -> float:
        """Return the length of all stretches together, mm."""
        used = np.arange(self.ends.shape[1] // 2) < self.count[:, None]
        return float((self.ends[:, 1::2] - self.ends[:, 0::2])[used].sum())

    def spans(self) -> Spans:
        """Its stretches."""
        used = np.repeat(np.arange(self.ends.shape[1] // 2) < self.count[:, None], 2, axis=1)
        return Spans(np.concatenate(([0], np.cumsum(self.count))), self.ends[used], self.normals[used], self.rows[used])


@dataclass(frozen=True, slots=True, eq=False)
class Stock:
    """Material: a lattice, and the tiles of its three bundles; or some of these, in their order."""

    lattice: Lattice
    tiles: tuple[Tile, ...]

    @staticmethod
    def of_spans(lattice: Lattice, spans: tuple[Spans, Spans, Spans], only: Iterable[int] | None = None) -> "Stock":
        """Stock that is given by the spans of each bundle; ``only``: the tiles of these numbers, which ascend."""
        corners = tile_corners(lattice)
        wanted = range(len(corners)) if only is None else only
        return Stock(lattice, tuple(_tile(lattice, *corners[number], spans) for number in wanted))

    def bundle(self, bundle: int) -> Iterator[Tile]:
        """Return the tiles of one bundle."""
        return (tile for tile in self.tiles if tile.bundle == bundle)

    def part(self, first: Ints, end: Ints) -> "Stock":
        """Return the stock along the rays through some cells only: from ``first`` to ``end`` (exclusive) along X, Y and
        Z.
        """
        lattice, cell = self.lattice, self.lattice.cell
        x, y, z = (end - first).tolist()
        own = Lattice(lattice.low + first * cell, lattice.low + end * cell, (x, y, z))
        spans = []
        for bundle in range(3):
            u, v, _ = BUNDLE_AXES[bundle]
            rays = np.arange(first[u], end[u])[:, None] * lattice.counts[v] + np.arange(first[v], end[v])
            spans.append(self.spans(bundle).at(rays.ravel()))
        return Stock.of_spans(own, (spans[0], spans[1], spans[2]))

    def cell_area(self, bundle: int) -> float:
        """Area that a ray of a bundle stands for, mm²."""
        u, v, _ = BUNDLE_AXES[bundle]
        cell = self.lattice.cell
        return float(cell[u] * cell[v])

    def spans(self, bundle: int) -> Spans:
        """Return the stretches of all rays of a bundle."""
        width = self.lattice.rays(bundle)[1]
        rays, counts, ends, normals, rows = [], [], [], [], []
        for tile in self.bundle(bundle):
            own = tile.spans()
            columns = tile.first_v + np.arange(len(tile.v))
            rays.append(((tile.first_u + np.arange(len(tile.u)))[:, None] * width + columns).ravel())
            counts.append(np.diff(own.first))
            ends.append(own.ends)
            normals.append(own.normals)
            rows.append(own.rows)
        ray, count = np.concatenate(rays), np.concatenate(counts)
        first = np.concatenate(([0], np.cumsum(count)))
        order = np.empty(len(ray), np.int64)
        order[ray] = np.arange(len(ray))
        return Spans(first, np.concatenate(ends), np.concatenate(normals), np.concatenate(rows)).at(order)

    @property
    def volume(self) -> float:
        """Volume of the material, mm³: the mean of the three bundles."""
        return sum(self.cell_area(tile.bundle) * tile.volume_per_area() for tile in self.tiles) / 3.0


def tile_corners(lattice: Lattice) -> list[tuple[int, int, int]]:
    """All tiles of a lattice in their order: the bundle of each, and its first ray along u and v."""
    corners = []
    for bundle in range(3):
        u, v = lattice.rays(bundle)
        corners += [(bundle, at_u, at_v) for at_u in range(0, u, TILE_RAYS) for at_v in range(0, v, TILE_RAYS)]
    return corners


def rays_of_tiles(lattice: Lattice, bundle: int, numbers: Iterable[int]) -> Ints:
    """Return the rays of a bundle that some tiles have, ascending."""
    corners = tile_corners(lattice)
    rays = [_rays(lattice, *corners[number]) for number in numbers if corners[number][0] == bundle]
    return np.sort(np.concatenate([*rays, np.zeros(0, np.int64)]))


def _rays(lattice: Lattice, bundle: int, first_u: int, first_v: int) -> Ints:
    """Return the rays of a tile."""
    rows, columns = lattice.rays(bundle)
    u, v = (np.arange(first, min(first + TILE_RAYS, end)) for first, end in ((first_u, rows), (first_v, columns)))
    return np.asarray((u[:, None] * columns + v).ravel(), np.int64)


def _tile(lattice: Lattice, bundle: int, first_u: int, first_v: int, whole: tuple[Spans, Spans, Spans]) -> Tile:
    u, v = (
        along[first : first + TILE_RAYS]
        for along, first in zip(lattice.ray_positions(bundle), (first_u, first_v), strict=True)
    )
    spans = whole[bundle].at(_rays(lattice, bundle, first_u, first_v))
    tile = Tile(bundle, first_u, first_v, u, v, *_no_room())
    tile.fill(np.diff(spans.first), spans.ends, np.full(len(spans.ends), UNCUT), spans.normals)
    return tile


def _no_room() -> tuple[Lines, Floats, Lines, NDArray[np.int8]]:
    return np.zeros(0, np.int32), np.zeros((0, 0)), np.zeros((0, 0), np.int32), np.zeros((0, 0, 3), np.int8)
