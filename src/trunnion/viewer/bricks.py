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
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
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


def brick_frame(grid: SurfaceGrid, cell: Floats, rows: int) -> BrickFrame:
    """Put a surface into bricks."""
    return BrickFrame(rows, {number: _bytes(*own) for number, own in _bricks(grid, cell)})


def brick_values(grid: SurfaceGrid, values: Floats) -> Floats:
    """Values of vertices in the order in which the bricks have them; the last layers are in several."""
    padded = _padded(grid)
    found = [values[one] for _, one in _vertex_numbers(grid, padded) if len(one)]
    return np.concatenate(found) if found else np.zeros(0)


def message(frame: BrickFrame, before: BrickFrame | None) -> bytes:
    """What makes a frame of the one before it."""
    old: Mapping[int, bytes] = {} if before is None else before.bricks
    new = {number: own for number, own in frame.bricks.items() if old.get(number) != own}
    new |= {number: b"" for number in old if number not in frame.bricks}
    numbers = sorted(new)
    head = [frame.rows, NOTHING if before is None else before.rows, len(numbers)]
    words = np.array([*head, *(word for number in numbers for word in (number, len(new[number])))], "<i4")
    return words.tobytes() + b"".join(new[number] for number in numbers)


def _padded(grid: SurfaceGrid) -> Flags:
    """The centres with a layer before and as many after as the bricks need."""
    cubes = np.array(grid.inside.shape) - 1
    padded = np.zeros(tuple(SIDE * -(-cubes // SIDE) + 2), np.bool_)
    x, y, z = grid.inside.shape
    padded[1 : x + 1, 1 : y + 1, 1 : z + 1] = grid.inside
    return padded


def _vertex_numbers(grid: SurfaceGrid, padded: Flags) -> Iterator[tuple[int, Ints]]:
    """The number of each brick, and those of its vertices."""
    sizes = np.array(grid.inside.shape) - 1
    vertex = np.full(tuple(np.array(padded.shape) - 1), -1, np.int32)
    x, y, z = sizes
    own = np.full(x * y * z, -1, np.int32)
    own[grid.cubes] = np.arange(len(grid.cubes), dtype=np.int32)
    vertex[1 : x + 1, 1 : y + 1, 1 : z + 1] = own.reshape(x, y, z)
    many = (np.array(padded.shape) - 2) // SIDE
    for number, (i, j, k) in enumerate(np.ndindex(*many.tolist())):
        part = tuple(slice(SIDE * at, SIDE * at + SIDE + 1) for at in (i, j, k))
        inner = vertex[part].ravel()
        yield number, inner[inner >= 0].astype(np.int64)


def _bricks(grid: SurfaceGrid, cell: Floats) -> Iterator[tuple[int, tuple[Flags, Codes]]]:
    """Number, centres and places of vertices, (3, m), of each brick that has any."""
    padded = _padded(grid)
    places = np.round(254.0 * (grid.vertices - grid.lows) / cell).clip(0, 254).astype(np.uint8)
    many = (np.array(padded.shape) - 2) // SIDE
    for number, vertices in _vertex_numbers(grid, padded):
        if len(vertices):
            at = np.unravel_index(number, many)
            part = tuple(slice(SIDE * int(k), SIDE * int(k) + SIDE + 2) for k in at)
            yield number, (padded[part], places[vertices].T)


def _bytes(centres: Flags, places: Codes) -> bytes:
    return np.packbits(centres, bitorder="little").tobytes() + places.tobytes()
