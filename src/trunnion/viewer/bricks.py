"""The surface of stock in bricks, as the browser gets it: which centres are material, and where each vertex is.

In:     ``SurfaceGrid``.
Out:    ``BrickFrame``: bytes by brick; those that changed, as one message.
Units:  mm; places within a cell in 254ths of it.

A brick is 32 cubes of the grid a side, and takes along the last layer of the bricks before it, so that its facets need
no other one. Its bytes are the 34 x 34 x 34 centres, one bit each, then x, y and z of the vertex of each cube that has
centres of both kinds, in the order of X, Y and Z, Z fastest. From these the browser makes the facets of dual contouring
(``web/stock.js``). A brick without surface has no bytes.

A message is int32 words: the rows that are cut, the rows of the frame that it changes (-1: of none, all bricks are in
it), the number of bricks; then number and length of each, and their bytes.
"""

from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.records import dataclass
from trunnion.simulation.stock.surface import SurfaceGrid

#: Cubes of a brick along each side.
SIDE: Final = 32

#: Without a frame before it.
NOTHING: Final = -1


@dataclass(frozen=True, slots=True, eq=False)
class BrickFrame:
    """A surface: the rows after which it is so, and the bytes of its bricks by their numbers, Z fastest."""

    rows: int
    bricks: Mapping[int, bytes]


@dataclass(frozen=True, slots=True, eq=False)
class BrickRange:
    """Bricks from ``first`` to ``end`` (exclusive), and those in all, along X, Y and Z, (3,) each."""

    first: Ints
    end: Ints
    many: Ints

    @staticmethod
    def whole(counts: tuple[int, int, int]) -> "BrickRange":
        """All bricks of a lattice."""
        many = -(-(np.array(counts) + 1) // SIDE)
        return BrickRange(np.zeros(3, np.int64), many, many)

    @staticmethod
    def around(low: Ints, high: Ints, counts: tuple[int, int, int]) -> "BrickRange":
        """Return the bricks whose bytes depend on the cells ``low`` to ``high`` (inclusive)."""
        many = BrickRange.whole(counts).many
        # A centre is a corner of the cubes before and after it; a cell is one of the four beside an edge that touches.
        first = np.clip((low - 2) // SIDE, 0, many - 1)
        return BrickRange(first, np.clip((high + 3) // SIDE + 1, first + 1, many), many)

    def cells(self, beyond: int, counts: tuple[int, int, int]) -> tuple[Ints, Ints]:
        """Return the cells that they take and so many beyond: from the first to the end (exclusive)."""
        low, high = SIDE * self.first - 2 - beyond, SIDE * self.end + beyond
        return np.clip(low, 0, counts), np.clip(high, 0, counts)


def brick_frame(grid: SurfaceGrid, cell: Floats, rows: int) -> BrickFrame:
    """Put a surface into bricks."""
    counts = np.array(grid.inside.shape) - 2
    x, y, z = counts.tolist()
    return BrickFrame(rows, dict(_bricks(grid, cell, BrickRange.whole((x, y, z)), np.zeros(3, np.int64))))


def changed_frame(
    before: BrickFrame, grid: SurfaceGrid, cell: Floats, rows: int, own: BrickRange, first: Ints
) -> BrickFrame:
    """Return a frame of which only some bricks differ from the one before; ``grid`` begins at the cell ``first``."""
    new = dict(_bricks(grid, cell, own, first))
    numbers = set(_numbers(own).tolist())
    kept = {number: bytes_ for number, bytes_ in before.bricks.items() if number not in numbers}
    return BrickFrame(rows, kept | new)


def brick_values(grid: SurfaceGrid, values: Floats) -> Floats:
    """Values of vertices in the order in which the bricks have them; the last layers are in several."""
    x, y, z = (np.array(grid.inside.shape) - 2).tolist()
    numbers = _vertex_numbers(grid, BrickRange.whole((x, y, z)), np.zeros(3, np.int64))
    found = [values[one] for _, one in numbers if len(one)]
    return np.concatenate(found) if found else np.zeros(0)


def message(frame: BrickFrame, before: BrickFrame | None) -> bytes:
    """Return what makes a frame of the one before it."""
    old: Mapping[int, bytes] = {} if before is None else before.bricks
    new = {number: own for number, own in frame.bricks.items() if old.get(number) != own}
    new |= {number: b"" for number in old if number not in frame.bricks}
    numbers = sorted(new)
    head = [frame.rows, NOTHING if before is None else before.rows, len(numbers)]
    words = np.array([*head, *(word for number in numbers for word in (number, len(new[number])))], "<i4")
    return words.tobytes() + b"".join(new[number] for number in numbers)


def _numbers(own: BrickRange) -> Ints:
    """Return the numbers of bricks, Z fastest."""
    i, j, k = (np.arange(first, end) for first, end in zip(own.first, own.end, strict=True))
    _, y, z = own.many.tolist()
    return np.asarray(((i[:, None, None] * y + j[:, None]) * z + k).ravel())


def _placed(values: NDArray[Any], own: BrickRange, first: Ints, blank: int, size: int) -> NDArray[Any]:
    """Centres or cubes of a grid that begins at the cell ``first``, in an array that begins where the bricks do."""
    shape = SIDE * (own.end - own.first) + size
    at = first - SIDE * own.first + 1
    low, high = np.maximum(at, 0), np.minimum(at + values.shape, shape)
    found = np.full(tuple(shape), blank, values.dtype)
    into = tuple(slice(one, end) for one, end in zip(low, high, strict=True))
    found[into] = values[tuple(slice(one, end) for one, end in zip(low - at, high - at, strict=True))]
    return found


def _vertex_numbers(grid: SurfaceGrid, own: BrickRange, first: Ints) -> Iterator[tuple[tuple[slice, ...], Ints]]:
    """For each brick, where its cubes are in an array of all, and the numbers of its vertices."""
    sizes = np.array(grid.inside.shape) - 1
    vertex = np.full(int(sizes.prod()), -1, np.int64)
    vertex[grid.cubes] = np.arange(len(grid.cubes))
    placed = _placed(vertex.reshape(tuple(sizes)), own, first, -1, 1)
    for at in np.ndindex(*(own.end - own.first).tolist()):
        part = tuple(slice(SIDE * k, SIDE * k + SIDE + 1) for k in at)
        inner = placed[part].ravel()
        yield part, inner[inner >= 0]


def _bricks(grid: SurfaceGrid, cell: Floats, own: BrickRange, first: Ints) -> Iterator[tuple[int, bytes]]:
    """Yield number and bytes of each brick that has a surface."""
    centres = _placed(grid.inside, own, first, 0, 2)
    places = np.round(254.0 * (grid.vertices - grid.lows) / cell).clip(0, 254).astype(np.uint8)
    for number, (part, vertices) in zip(_numbers(own).tolist(), _vertex_numbers(grid, own, first), strict=True):
        if len(vertices):
            around = tuple(slice(each.start, each.stop + 1) for each in part)
            yield number, _bytes(centres[around], places[vertices].T)


def _bytes(centres: Flags, places: Codes) -> bytes:
    return np.packbits(centres, bitorder="little").tobytes() + places.tobytes()
