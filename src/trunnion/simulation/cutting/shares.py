"""A simulation in shares: each has some tiles of the stock and cuts them with the whole program, wherever that is.

In:     what the tiles of a share measure (``Chunk``), and the tiles in the end.
Out:    a share as bytes; and of all shares the chunks that one process would have had, and its stock.
Units:  mm, workpiece frame.

No tile looks at another one while it is cut, so that a share is exactly what these tiles are without it. Joined, what
tiles measured comes in the order of tiles again: volumes are added in the same order, and equal to the last bit.

A share is a ZIP archive with a file for each chunk and each tile; in each of these NumPy's arrays (``.npy``) stand one
after another. Reading it runs no code, and its checksums tell whether it is damaged. No more memory is taken for one of
these files than lattice and rows allow, whatever sizes it claims to have.
"""

import heapq
import itertools
import math
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from io import BytesIO
from typing import IO, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trunnion.model.run import Run
from trunnion.simulation.cutting.measurements import Chunk, ColumnMeasured, TileMeasured, column_count, is_volume
from trunnion.simulation.cutting.sweeps import MOST_PIECES, tool_ranges
from trunnion.simulation.stock.lattice import BUNDLE_AXES, Lattice
from trunnion.simulation.stock.material import TILE_RAYS, Stock, Tile, tile_corners
from trunnion.simulation.tools.pieces import RevolvedPieces

#: zlib's level: higher ones make it hardly smaller, and take several times as long.
_LEVEL: Final = 1

#: Types of the arrays of a chunk and of a tile, and what a row of each is.
_CHUNK: Final = ((np.dtype(np.int32), (3,)), (np.dtype(np.int32), ()), (np.dtype(float), ()), (np.dtype(float), (3,)))
_TILE: Final = ((np.dtype(np.int32), ()), (np.dtype(float), ()), (np.dtype(np.int32), ()), (np.dtype(np.int8), (3,)))

#: Bytes that the headers of a file's arrays take at most.
_HEADERS: Final = 4096

#: Stretches that a ray may have: some for each of its cells, far more than material is ever divided into.
_LEAST_STRETCHES, _STRETCHES_OF_CELL = 1024, 16


_Kind = tuple[np.dtype[Any], tuple[int, ...]]


class Share(NamedTuple):
    """One of several shares, counted from 0."""

    number: int
    of: int


class DamagedShareError(ValueError):
    """A share is not as it was written, or belongs to another simulation."""


def tiles_of(share: Share, lattice: Lattice) -> list[int]:
    """Return the numbers of the tiles of a share, ascending.

    Neighbours, which the same rows reach, go to different shares, and so do the tiles of a line along u or v: a program
    cuts here or there, and mostly near one side of the rays.
    """
    numbers, before = list[int](), 0
    for bundle in range(3):
        along_u, along_v = (math.ceil(rays / TILE_RAYS) for rays in lattice.rays(bundle))
        step = 1 if share.of <= along_u else next(k for k in itertools.count(along_u) if math.gcd(k, share.of) == 1)
        for k in range(along_u * along_v):
            if (k // along_v + step * (k % along_v) + before) % share.of == share.number:
                numbers.append(before + k)
        before += along_u * along_v
    return numbers


class ShareWriter:
    """Makes the bytes of a share; ``numbers`` are those of its tiles."""

    def __init__(self, numbers: Sequence[int]) -> None:
        self._numbers = numbers
        self._bytes = BytesIO()
        self._archive = zipfile.ZipFile(self._bytes, "w", zipfile.ZIP_DEFLATED, compresslevel=_LEVEL)

    def add(self, job: int, chunk: Chunk) -> None:
        """Add what the tiles measure in a chunk of rows of a job; chunks of a job come in their order."""
        columns = [(measured.tile, column) for measured in chunk.tiles for column in measured.columns]
        blocks = [(self._numbers[tile], column.column, len(column.row)) for tile, column in columns]
        rows, values, places = ([getattr(each, name) for _, each in columns] for name in ("row", "value", "place"))
        self._write(
            _chunk_name(job, chunk.first),
            np.array(blocks, np.int32).reshape(-1, 3),
            np.concatenate([*rows, np.zeros(0, np.int64)]).astype(np.int32),
            np.concatenate([*values, np.zeros(0)]),
            np.concatenate([*places, np.zeros((0, 3))]),
        )

    def finish(self, stock: Stock) -> bytes:
        """Add the finished tiles; the whole share."""
        for number, tile in zip(self._numbers, stock.tiles, strict=True):
            spans = tile.spans()
            self._write(_tile_name(number), tile.count, spans.ends, spans.rows, spans.normals)
        self._archive.close()
        return self._bytes.getvalue()

    def _write(self, name: str, *arrays: NDArray[Any]) -> None:
        content = BytesIO()
        for array in arrays:
            np.lib.format.write_array(content, array, allow_pickle=False)
        # The time of a member is always the same one, so that equal shares are equal bytes.
        self._archive.writestr(zipfile.ZipInfo(name), content.getvalue(), zipfile.ZIP_DEFLATED, _LEVEL)


class JoinedShares:
    """All shares of a simulation.

    Raises
    ------
    DamagedShareError
        Here and in all that reads them, if they cannot be used.
    """

    def __init__(self, contents: Sequence[bytes]) -> None:
        try:
            self._archives = [zipfile.ZipFile(BytesIO(content)) for content in contents]
        except (zipfile.BadZipFile, ValueError, OSError, RuntimeError) as error:
            raise DamagedShareError(str(error)) from None

    def chunks(
        self,
        job: int,
        run: Run,
        tools: Mapping[int, RevolvedPieces],
        end: int,
        lattice: Lattice,
        progress: Callable[[int, int], None] | None = None,
    ) -> Iterator[Chunk]:
        """Yield the chunks of a job as ``removal.measure`` would, which knows the arguments."""
        bundles = [bundle for bundle, _, _ in tile_corners(lattice)]
        for first, last, tool in tool_ranges(run, end):
            if tool in tools:
                name, room = _chunk_name(job, first), (range(first, last), column_count(tools[tool]))
                each = [_measured(archive, name, bundles, *room) for archive in self._archives]
                yield Chunk(first, last, tool, heapq.merge(*each, key=lambda measured: measured.tile))
            if progress:
                progress(last, end)

    def finish(self, stock: Stock) -> None:
        """Give stock that nothing has cut the tiles that the shares have left of it."""
        for number, tile in enumerate(stock.tiles):
            cells = stock.lattice.counts[BUNDLE_AXES[tile.bundle][2]]
            most = _LEAST_STRETCHES + _STRETCHES_OF_CELL * cells
            name = _tile_name(number)
            archive = next((each for each in self._archives if name in each.NameToInfo), None)
            if archive is None:
                raise DamagedShareError(f"no share has {name}")
            rays, ends = len(tile.count), 2 * len(tile.count) * most
            _put(tile, most, *_read(archive, name, _TILE, (rays, ends, ends, ends)))


def _chunk_name(job: int, first: int) -> str:
    return f"job {job} row {first}"


def _tile_name(number: int) -> str:
    return f"tile {number}"


def _read(archive: zipfile.ZipFile, name: str, kinds: Sequence[_Kind], most: Sequence[int]) -> list[NDArray[Any]]:
    """Return the arrays of a member, of ``kinds`` and with at most so many rows each."""
    try:
        info = archive.getinfo(name)
        if info.compress_type not in (zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED):
            raise ValueError("it is packed otherwise")
        sizes = (rows * kind.itemsize * math.prod(shape) for rows, (kind, shape) in zip(most, kinds, strict=True))
        if info.file_size > _HEADERS + sum(sizes):
            raise ValueError("it is larger than it can be")
        with archive.open(info) as content:
            arrays = [_array(content, *kind, rows) for kind, rows in zip(kinds, most, strict=True)]
            if content.read(1):  # at the end its checksum is compared, too
                raise ValueError("it has more than it can have")
        return arrays
    except (zipfile.BadZipFile, zlib.error, KeyError, ValueError, EOFError, OSError, RuntimeError) as error:
        raise DamagedShareError(f"{name}: {error}") from None
    except MemoryError:
        raise DamagedShareError(f"{name}: it takes more memory than there is") from None


def _array(content: IO[bytes], kind: np.dtype[Any], shape: tuple[int, ...], most: int) -> NDArray[Any]:
    """Return the next array of a member, with at most so many rows; what it says of its size must be there."""
    if np.lib.format.read_magic(content) != (1, 0):
        raise ValueError("it was written otherwise")
    said, is_fortran, found_kind = np.lib.format.read_array_header_1_0(content)
    if (said[1:], found_kind) != (shape, kind) or not said or (is_fortran and shape) or not 0 <= said[0] <= most:
        raise ValueError("it has other arrays")
    size = said[0] * math.prod(shape) * kind.itemsize
    data = content.read(size)
    if len(data) != size:
        raise ValueError("it is cut short")
    return np.frombuffer(data, kind).reshape(said)


def _measured(
    archive: zipfile.ZipFile, name: str, bundles: Sequence[int], rows: range, most_columns: int
) -> Iterator[TileMeasured]:
    """Yield what the tiles of a share measured in a chunk of rows."""
    most_blocks = len(bundles) * most_columns
    most = most_blocks * len(rows) * MOST_PIECES
    blocks, row, value, place = _read(archive, name, _CHUNK, (most_blocks, most, most, most_blocks * len(rows)))
    is_own = len(blocks) == len(row) == len(value) == len(place) == 0
    if len(blocks) and np.all(blocks[:, :2] >= 0) and np.all(blocks[:, 2] > 0):
        depths = blocks[~np.array([is_volume(each) for each in blocks[:, 1].tolist()]), 2]
        is_own = bool(
            blocks[:, 0].max() < len(bundles) and blocks[:, 1].max() < most_columns
            and blocks[:, 2].sum(dtype=np.int64) == len(row) == len(value) and depths.sum(dtype=np.int64) == len(place)
            and rows.start <= row.min() and row.max() < rows.stop
        )  # fmt: skip
    if not is_own:
        raise DamagedShareError(f"{name} belongs to another simulation")
    columns: list[ColumnMeasured] = []
    at = placed = 0
    for k, (tile, column, count) in enumerate(blocks.tolist()):
        own = slice(at, at + count)
        places = slice(placed, placed if is_volume(column) else placed + count)
        columns.append(ColumnMeasured(column, row[own].astype(np.int64), value[own], place[places]))
        at, placed = own.stop, places.stop
        if k + 1 == len(blocks) or blocks[k + 1, 0] != tile:
            yield TileMeasured(tile, bundles[tile], tuple(columns))
            columns = []


def _put(tile: Tile, most: int, count: NDArray[Any], *spans: NDArray[Any]) -> None:
    """Make the material of a tile what a share has left of it, at most so many stretches of each ray."""
    is_own = count.shape == tile.count.shape and count.min() >= 0 and count.max() <= most
    if not is_own or any(len(each) != 2 * int(count.sum(dtype=np.int64)) for each in spans):
        raise DamagedShareError("a tile has other rays than the stock")
    tile.fill(count, *spans)
