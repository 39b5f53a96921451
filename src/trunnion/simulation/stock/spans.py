"""The stretches of the rays of a bundle that lie within a solid.

In:     a box, a cylinder or a closed triangle mesh, and the lattice.
Out:    ``Spans``, ray after ray.
Units:  mm, workpiece frame; positions along a ray count from the zero of its axis.
"""

import math
from dataclasses import field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Flags, Floats, Floats2, Ints, Ints2, Lines
from trunnion.jit import inner, kernel
from trunnion.records import dataclass
from trunnion.simulation.stock.lattice import BUNDLE_AXES, Lattice

#: Rays pass a mesh this far aside, mm: corners of meshes lie on round coordinates, as rays do.
_ASIDE: Final = (3.1e-8, 7.7e-8)


@dataclass(frozen=True, slots=True, eq=False)
class Spans:
    """The stretches of r rays; those of ray k are ``first[k]`` to ``first[k + 1]``. Rays count with v fastest.

    first    (r + 1,)  int64
    ends     (2 m,)    float64  starts and ends along w, mm
    normals  (2 m, 3)  int8     unit normals out of the solid there in (u, v, w), in 127ths
    rows     (2 m,)    int32    rows of the runs that cut them, -1 where none did
    leaks    rays that pass an odd number of faces, and were left empty
    """

    first: Ints
    ends: Floats
    normals: NDArray[np.int8]
    rows: Lines = field(default_factory=lambda: np.zeros(0, np.int32))
    leaks: int = 0

    def __post_init__(self) -> None:
        if len(self.rows) != len(self.ends):
            object.__setattr__(self, "rows", np.full(len(self.ends), -1, np.int32))

    def at(self, rays: Ints) -> "Spans":
        """Return the spans of some rays."""
        sizes = np.diff(self.first)[rays]
        first = np.concatenate(([0], np.cumsum(sizes)))
        source = np.repeat(self.first[rays] - first[:-1], sizes) + np.arange(first[-1])
        both = np.column_stack((2 * source, 2 * source + 1)).ravel()
        return Spans(first, self.ends[both], self.normals[both], self.rows[both])

    def only(self, rays: Ints) -> "Spans":
        """Return the same rays, all of them empty but some, which ascend."""
        sizes = np.zeros(len(self.first) - 1, np.int64)
        sizes[rays] = np.diff(self.first)[rays]
        kept = self.at(rays)
        return Spans(np.concatenate(([0], np.cumsum(sizes))), kept.ends, kept.normals, kept.rows, self.leaks)


def no_spans(rays: int) -> Spans:
    """Rays without any."""
    return Spans(np.zeros(rays + 1, np.int64), np.zeros(0), np.zeros((0, 3), np.int8))


def box_spans(lattice: Lattice, bundle: int) -> Spans:
    """Return the box of the lattice itself."""
    w = BUNDLE_AXES[bundle][2]
    rays = math.prod(lattice.rays(bundle))
    ends = np.tile((lattice.low[w], lattice.high[w]), rays)
    normals = np.tile(np.array([[0, 0, -127], [0, 0, 127]], np.int8), (rays, 1))
    return Spans(np.arange(rays + 1), ends, normals)


def cylinder_spans(lattice: Lattice, bundle: int) -> Spans:
    """Return the upright cylinder with elliptic section that fills the box of the lattice."""
    middle, half = 0.5 * (lattice.low + lattice.high), 0.5 * (lattice.high - lattice.low)
    along_u, along_v = lattice.ray_positions(bundle)
    u, v = np.repeat(along_u, len(along_v)), np.tile(along_v, len(along_u))
    ends = np.empty((len(u), 2))
    if bundle == 2:
        rest = 1.0 - ((u - middle[0]) / half[0]) ** 2 - ((v - middle[1]) / half[1]) ** 2
        ends[:] = lattice.low[2], lattice.high[2]
        normals = np.tile(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]), (len(u), 1, 1))
    else:
        along = 0 if bundle == 0 else 1
        beside = u if bundle == 0 else v
        aside = 1 - along
        rest = 1.0 - ((beside - middle[aside]) / half[aside]) ** 2
        reach = half[along] * np.sqrt(np.maximum(rest, 0.0))
        ends[:, 0], ends[:, 1] = middle[along] - reach, middle[along] + reach
        slope = (beside - middle[aside]) / half[aside] ** 2
        normals = np.zeros((len(u), 2, 3))
        normals[:, :, 0 if bundle == 0 else 1] = slope[:, None]
        normals[:, :, 2] = np.column_stack((-reach, reach)) / half[along] ** 2
        normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-12)
    hit = rest > 0.0
    first = np.concatenate(([0], np.cumsum(hit)))
    return Spans(first, ends[hit].ravel(), np.round(127.0 * normals[hit].reshape(-1, 3)).astype(np.int8))


def mesh_spans(vertices: Floats, faces: Ints, lattice: Lattice, bundle: int) -> Spans:
    """Return the inside of a closed mesh whose faces turn left seen from outside.

    Parameters
    ----------
    vertices : (n, 3) float64, mm
    faces : (m, 3) int64
    """
    axes = list(BUNDLE_AXES[bundle])
    points = np.ascontiguousarray(vertices[:, axes])
    u, v = lattice.ray_positions(bundle)
    u, v = u + _ASIDE[0], v + _ASIDE[1]
    counts = np.zeros(len(u) * len(v), np.int64)
    nowhere = np.zeros((0, 4))
    mesh_crossings(points, faces, u, v, counts, np.zeros(0, np.int64), nowhere, True)
    first = np.concatenate(([0], np.cumsum(counts)))
    crossings = np.zeros((first[-1], 4))
    mesh_crossings(points, faces, u, v, counts, first[:-1].copy(), crossings, False)
    ray = np.repeat(np.arange(len(counts)), counts)
    crossings = crossings[np.lexsort((crossings[:, 0], ray))]
    kept, stretches = _closed(first, crossings)
    rows = crossings[kept]
    begin = np.concatenate(([0], np.cumsum(stretches)))
    leaks = int(np.count_nonzero(counts % 2))
    return Spans(begin, rows[:, 0].copy(), np.round(127.0 * rows[:, 1:]).astype(np.int8), leaks=leaks)


def _closed(first: Ints, crossings: Floats) -> tuple[Flags, Ints]:
    """Which crossings begin or end a stretch of the union of what overlaps, and the number of stretches of each ray."""
    kept = np.zeros(len(crossings), np.bool_)
    stretches = np.zeros(len(first) - 1, np.int64)
    pair_crossings(first, crossings, kept, stretches)
    return kept, stretches


@kernel(writes="kept stretches")
def pair_crossings(first: Ints, crossings: Floats2, kept: Flags, stretches: Ints) -> None:
    """Pair the crossings of each ray: where the last solid ends in which it is, a stretch ends.

    Rays whose crossings do not pair are left empty.
    """
    for ray in range(len(first) - 1):
        depth, pairs = 0, True
        for k in range(first[ray], first[ray + 1]):
            before = depth
            depth += 1 if crossings[k, 3] < 0.0 else -1
            kept[k] = (before == 0 and depth == 1) or (before == 1 and depth == 0)
            stretches[ray] += before == 1 and depth == 0
            pairs = pairs and depth >= 0
        if depth != 0 or not pairs:
            stretches[ray] = 0
            for k in range(first[ray], first[ray + 1]):
                kept[k] = False


@kernel(writes="counts crossings at")
def mesh_crossings(
    points: Floats2, faces: Ints2, u: Floats, v: Floats, counts: Ints, at: Ints, crossings: Floats2, counting: bool
) -> None:
    """Count the faces that each ray passes; or write (w, normal) of each, those of ray k from ``at[k]`` on.

    A ray through an edge or a corner passes exactly one of the faces that meet there: the side of an edge on which a
    ray lies is computed from the same numbers, in the same order, for both of its faces.
    """
    step_u = u[1] - u[0] if len(u) > 1 else 1.0
    step_v = v[1] - v[0] if len(v) > 1 else 1.0
    for face in range(len(faces)):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        abu, abv, abw = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
        acu, acv, acw = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
        nu, nv, nw = abv * acw - abw * acv, abw * acu - abu * acw, abu * acv - abv * acu
        if nw == 0.0:
            continue
        length = math.sqrt(nu * nu + nv * nv + nw * nw)
        low_u = min(points[a, 0], points[b, 0], points[c, 0])
        high_u = max(points[a, 0], points[b, 0], points[c, 0])
        low_v = min(points[a, 1], points[b, 1], points[c, 1])
        high_v = max(points[a, 1], points[b, 1], points[c, 1])
        for i in range(
            max(0, math.ceil((low_u - u[0]) / step_u - 1e-9)),
            min(len(u) - 1, math.floor((high_u - u[0]) / step_u + 1e-9)) + 1,
        ):
            for j in range(
                max(0, math.ceil((low_v - v[0]) / step_v - 1e-9)),
                min(len(v) - 1, math.floor((high_v - v[0]) / step_v + 1e-9)) + 1,
            ):
                side = _left_of(points, a, b, u[i], v[j])
                if _left_of(points, b, c, u[i], v[j]) != side or _left_of(points, c, a, u[i], v[j]) != side:
                    continue
                if side != (nw > 0.0):
                    continue
                ray = i * len(v) + j
                if counting:
                    counts[ray] += 1
                    continue
                k = at[ray]
                at[ray] += 1
                crossings[k, 0] = points[a, 2] - (nu * (u[i] - points[a, 0]) + nv * (v[j] - points[a, 1])) / nw
                crossings[k, 1], crossings[k, 2], crossings[k, 3] = nu / length, nv / length, nw / length


@inner
def _left_of(points: Floats, a: int, b: int, u: float, v: float) -> bool:
    """Whether a ray is left of the edge from a to b; on it, it is left of the edge from the lower number."""
    first, second = (a, b) if a < b else (b, a)
    turn = (points[second, 0] - points[first, 0]) * (v - points[first, 1]) - (points[second, 1] - points[first, 1]) * (
        u - points[first, 0]
    )
    left = turn >= 0.0
    return left if a < b else not left
