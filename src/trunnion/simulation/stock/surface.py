"""The surface of stock as a closed mesh with sharp edges: dual contouring.

In:     ``Stock``.
Out:    a ``TriangleMesh``, seen from outside.
Units:  mm, workpiece frame.

The rays of all three bundles meet in the centres of the cells. Between two neighbouring centres, one in the material
and one not, lies the end of a stretch, with its normal. Eight centres are the corners of a cube; each cube with such
ends gets the vertex that is nearest to all their planes (Ju, Losasso, Schaefer, Warren 2002), and each end a
quadrilateral between the four cubes around it. Every edge belongs to two facets.
"""

import math
from typing import Annotated, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans

#: Votes of bundles, or normals in 127ths.
Votes2: TypeAlias = Annotated[NDArray[np.int8], 2]

#: Directions in which the planes of a cube differ by less than this do not place its vertex: edges of less than 8 deg.
_FLAT: Final = 0.005

#: Decimals of vertices, mm, and part of the way to the middle of its cube by which one that is not alone is moved.
_DECIMALS: Final = 6
_ASIDE: Final = 2e-3

#: How often centres are filled so that no edge has four facets; every round leaves fewer such places.
_ROUNDS: Final = 50


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceGrid:
    """The surface of stock before it becomes triangles; the stock has ``counts`` cells along X, Y and Z.

    inside    (counts + 2) bool   which centres of cells are in the material, with a layer around them that is not
    cubes     (n,)       int64    cubes of eight centres that the surface passes, in the order of X, Y and Z, Z fastest,
                                  as places among counts + 1
    lows      (n, 3)     float64  their lowest corners, mm
    vertices  (n, 3)     float64  the vertex of each, in it, mm
    quads     (m, 4)     int64    its quadrilaterals, as numbers of vertices, seen from outside
    """

    inside: NDArray[np.bool_]
    cubes: Ints
    lows: Floats
    vertices: Floats
    quads: Ints


def stock_surface(stock: Stock) -> TriangleMesh:
    """Return the surface of stock: closed, its edges sharp, within a cell of the ends of all stretches.

    Where two bodies touch along an edge of a cell only, that cell is filled.
    """
    grid = surface_grid(stock)
    return TriangleMesh(grid.vertices, _triangles(grid.vertices, grid.quads), "stock")


def surface_grid(stock: Stock) -> SurfaceGrid:
    """Return the surface of stock, as ``stock_surface`` has it, on its grid."""
    spans = [stock.spans(bundle) for bundle in range(3)]
    inside = _without_touching_edges(_centres(stock, spans))
    cubes: list[Ints] = []
    points: list[Floats] = []
    normals: list[Floats] = []
    leaves: list[Flags] = []
    for bundle in range(3):
        corners, point, normal, leaving = _ends(stock, spans[bundle], inside, bundle)
        cubes.append(corners)
        points.append(point)
        normals.append(normal)
        leaves.append(leaving)
    around, point, normal = np.concatenate(cubes), np.concatenate(points), np.concatenate(normals)
    used, vertex = np.unique(around, return_inverse=True)
    lows = _cubes(stock, inside.shape, used)
    vertices = _vertices(stock, lows, vertex.reshape(-1, 4), point, normal)
    vertices = _apart(vertices, lows + 0.5 * stock.lattice.cell)
    quads = vertex.reshape(-1, 4)
    leaving = np.concatenate(leaves)
    quads = np.where(leaving[:, None], quads, quads[:, ::-1])
    return SurfaceGrid(inside, used, lows, vertices, quads)


def _centres(stock: Stock, spans: list[Spans]) -> NDArray[np.bool_]:
    """Which centres are in the material, with a layer around them that is not: two of three bundles say so."""
    lattice = stock.lattice
    votes = np.zeros(tuple(count + 2 for count in lattice.counts), np.int8)
    for bundle in range(3):
        u, v, w = BUNDLE_AXES[bundle]
        own = np.zeros((lattice.counts[u] * lattice.counts[v], lattice.counts[w]), np.int8)
        cell = lattice.cell
        fill_centres(
            spans[bundle].first, spans[bundle].ends, float(lattice.low[w] + 0.5 * cell[w]), float(cell[w]), own
        )
        shaped = own.reshape(lattice.counts[u], lattice.counts[v], lattice.counts[w])
        votes[1:-1, 1:-1, 1:-1] += np.transpose(shaped, np.argsort((u, v, w)))
    return np.asarray(votes >= 2)


def _without_touching_edges(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Fill centres so that no four neighbours in a plane are in the material and not by turns."""
    for _ in range(_ROUNDS):
        changed = False
        for one, two in ((0, 1), (1, 2), (0, 2)):
            a, b, c, d = (_shifted(inside, one, two, i, j) for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)))
            first, second = a & d & ~b & ~c, b & c & ~a & ~d
            if first.any() or second.any():
                changed = True
                _shifted(inside, one, two, 1, 0)[first] = True
                _shifted(inside, one, two, 0, 0)[second] = True
        if not changed:
            break
    inside[[0, -1]] = inside[:, [0, -1]] = inside[:, :, [0, -1]] = False
    return inside


def _shifted(inside: NDArray[np.bool_], one: int, two: int, i: int, j: int) -> NDArray[np.bool_]:
    """All centres but the last (0) or the first (1) along two axes."""
    part = [slice(None)] * 3
    part[one] = slice(1, None) if i else slice(None, -1)
    part[two] = slice(1, None) if j else slice(None, -1)
    return inside[tuple(part)]


def _ends(stock: Stock, spans: Spans, inside: NDArray[np.bool_], bundle: int) -> tuple[Ints, Floats, Floats, Flags]:
    """Where material begins or ends between neighbours along a bundle.

    Returns the cubes around each end, (m, 4), as places in the grid of cubes, in the sense of u to v; the ends (m, 3),
    their normals (m, 3), and whether material ends there along w.
    """
    lattice, (u, v, w) = stock.lattice, BUNDLE_AXES[bundle]
    turned = np.transpose(inside, (u, v, w))
    at = np.argwhere(turned[:, :, :-1] != turned[:, :, 1:])
    leaving = turned[at[:, 0], at[:, 1], at[:, 2]]
    cell = lattice.cell
    low = lattice.low - 0.5 * cell
    point = np.empty((len(at), 3))
    point[:, u], point[:, v] = low[u] + at[:, 0] * cell[u], low[v] + at[:, 1] * cell[v]
    height, found = np.empty(len(at)), np.zeros((len(at), 3))
    ray = (at[:, 0] - 1) * lattice.counts[v] + at[:, 1] - 1
    nearest_ends(
        spans.first, spans.ends, spans.normals, ray, low[w] + at[:, 2] * cell[w], float(cell[w]), leaving, height, found
    )
    point[:, w] = height
    normal = np.empty_like(found)
    normal[:, u], normal[:, v], normal[:, w] = found.T
    sizes = np.array(inside.shape) - 1
    cubes = np.empty((len(at), 4), np.int64)
    for k, (i, j) in enumerate(((-1, -1), (0, -1), (0, 0), (-1, 0))):
        place = np.empty((3, len(at)), np.int64)
        place[u], place[v], place[w] = at[:, 0] + i, at[:, 1] + j, at[:, 2]
        cubes[:, k] = (place[0] * sizes[1] + place[1]) * sizes[2] + place[2]
    return cubes, point, normal, np.asarray(leaving)


def _cubes(stock: Stock, shape: tuple[int, ...], used: Ints) -> Floats:
    """Return the lowest corners of cubes, (n, 3), mm."""
    sizes = np.array(shape) - 1
    grid = np.column_stack((used // (sizes[1] * sizes[2]), used // sizes[2] % sizes[1], used % sizes[2]))
    return np.asarray(stock.lattice.low + (grid - 0.5) * stock.lattice.cell)


def _vertices(stock: Stock, lows: Floats, vertex: Ints, point: Floats, normal: Floats) -> Floats:
    """Return the point of each cube that is nearest to the planes of its ends, and to their mean; within the stock's
    box.
    """
    count = len(lows)
    flat, four = vertex.ravel(), np.repeat(np.arange(len(point)), 4)
    ends = np.bincount(flat, minlength=count).astype(np.float64)

    def total(values: Floats) -> Floats:
        return np.asarray(np.bincount(flat, values[four], count))

    middle = np.column_stack([total(point[:, k]) for k in range(3)]) / ends[:, None]
    offset = np.einsum("ij,ij->i", normal, point)
    matrix = np.empty((count, 3, 3))
    right = np.empty((count, 3))
    for i in range(3):
        for j in range(i, 3):
            matrix[:, i, j] = matrix[:, j, i] = total(normal[:, i] * normal[:, j])
        right[:, i] = total(normal[:, i] * offset)
    right -= np.einsum("nij,nj->ni", matrix, middle)
    values, vectors = np.linalg.eigh(matrix)
    kept = values > _FLAT * values[:, 2:]
    inverse = np.where(kept, 1.0 / np.where(kept, values, 1.0), 0.0)
    along = np.einsum("nji,nj->ni", vectors, right) * inverse
    place = middle + np.einsum("nij,nj->ni", vectors, along)
    # Cubes at the faces of the stock reach beyond them, and so may the point between a face and a flat edge to it.
    lowest, highest = np.maximum(lows, stock.lattice.low), np.minimum(lows + stock.lattice.cell, stock.lattice.high)
    return np.asarray(np.clip(place, lowest, highest))


def _apart(vertices: Floats, middles: Floats) -> Floats:
    """Return the vertices, with those that would be one in a file moved towards the middles of their cubes.

    Files have single precision, and their readers make equal corners one: where two cubes have the same vertex, edges
    of four facets would come of it.
    """
    vertices = np.round(vertices, _DECIMALS)
    for attempt in range(1, _ROUNDS):
        order = np.lexsort(vertices.astype(np.float32).T)
        ordered = vertices[order].astype(np.float32)
        equal = (ordered[1:] == ordered[:-1]).all(axis=1)
        if not equal.any():
            break
        again = order[np.concatenate((equal, [False])) | np.concatenate(([False], equal))]
        moved = vertices[again] + attempt * _ASIDE * (middles[again] - vertices[again])
        vertices[again] = np.round(moved, _DECIMALS)
    return vertices


def _triangles(vertices: Floats, quads: Ints) -> Ints:
    """Two triangles for each quadrilateral, along its shorter diagonal."""
    a, b, c, d = quads.T
    one = np.linalg.norm(vertices[a] - vertices[c], axis=1)
    other = np.linalg.norm(vertices[b] - vertices[d], axis=1)
    shorter = (one <= other)[:, None]
    first = np.where(shorter, np.column_stack((a, b, c)), np.column_stack((a, b, d)))
    second = np.where(shorter, np.column_stack((a, c, d)), np.column_stack((b, c, d)))
    return np.concatenate((first, second))


@kernel(writes="centres")
def fill_centres(first: Ints, ends: Floats, lowest: float, step: float, centres: Votes2) -> None:
    """Mark the centres of each ray that are within its stretches; the first is at ``lowest``."""
    for ray in range(len(first) - 1):
        for s in range(first[ray], first[ray + 1]):
            begin = max(0, math.ceil((ends[2 * s] - lowest) / step))
            end = min(centres.shape[1] - 1, math.floor((ends[2 * s + 1] - lowest) / step))
            for k in range(begin, end + 1):
                centres[ray, k] = 1


@kernel(writes="height normal")
def nearest_ends(
    first: Ints,
    ends: Floats,
    normals: Votes2,
    ray: Ints,
    low: Floats,
    step: float,
    leaving: Flags,
    height: Floats,
    normal: Floats2,
) -> None:
    """Find where the material of rays ends (``leaving``) or begins between ``low`` and the next centre.

    Two other rays may have outvoted the ray at a centre that its end passes by a little: that end, at most half a step
    away, is taken, at the centre. Without one it is taken to be half-way, and across the ray.
    """
    rays = len(first) - 1
    for k in range(len(ray)):
        height[k] = low[k] + 0.5 * step
        normal[k, 0], normal[k, 1], normal[k, 2] = 0.0, 0.0, 1.0 if leaving[k] else -1.0
        if not 0 <= ray[k] < rays:
            continue
        nearest = 0.5 * step
        for s in range(first[ray[k]], first[ray[k] + 1]):
            at = 2 * s + 1 if leaving[k] else 2 * s
            beyond = max(low[k] - ends[at], ends[at] - low[k] - step, 0.0)
            if beyond > nearest:
                continue
            nearest = beyond
            height[k] = min(max(ends[at], low[k]), low[k] + step)
            length = 0.0
            for axis in range(3):
                length += float(normals[at, axis]) ** 2
            if length > 0.0:
                for axis in range(3):
                    normal[k, axis] = normals[at, axis] / math.sqrt(length)
