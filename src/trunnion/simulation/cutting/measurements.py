"""What tiles measure while sweeps pass through them, and what rows did by all of them together.

In:     of each tile the rows in which it measured anything (``TileMeasured``), one tile after another.
Out:    ``RowsCut``: volumes and depths of consecutive rows.
Units:  mm, mm³, workpiece frame.

Volumes are added up in the order in which tiles come, and within a tile in that of its sweeps: the same tiles in the
same order give the same numbers to the last bit, whoever has cut them.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass
from trunnion.simulation.cutting.stretch_kernel import GOUGED, MET, MET_IDLE, REMOVED
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.tools.pieces import RevolvedPieces


@dataclass(frozen=True, slots=True, eq=False)
class Depths:
    """How deep something went in each of k rows, mm, and where: (k,) and (k, 3); NaN places where it did not."""

    depth: Floats
    place: Floats


@dataclass(frozen=True, slots=True, eq=False)
class RowsCut:
    """What consecutive rows from ``first`` on did, with the tool of index ``tool``.

    removed  (k,) mm³ of stock
    gouged   (k,) mm³ of the design
    idle     how deep the cutter went into the stock in rapids, and with the spindle standing
    met      for each section of the tool that does not cut, how deep it went into the stock
    """

    first: int
    tool: int
    removed: Floats
    gouged: Floats
    idle: Depths
    met: Mapping[int, Depths]


class ColumnMeasured(NamedTuple):
    """One thing that a tile measured, and where it is not zero.

    column  which: of ``stretch_kernel``
    row     (k,)    rows of the run, ascending; of volumes one for each sweep, of depths each row once
    value   (k,)    mm³ of each sweep, or the greatest depth of each row, mm
    place   (k, 3)  where that depth is, in coordinates of the bundle; of volumes (0, 3)
    """

    column: int
    row: Ints
    value: Floats
    place: Floats


class TileMeasured(NamedTuple):
    """What a tile of a bundle measured in consecutive rows."""

    tile: int
    bundle: int
    columns: tuple[ColumnMeasured, ...]


class Chunk(NamedTuple):
    """The rows ``first`` to ``end`` (exclusive) of a run, cut with the tool of index ``tool``.

    tiles  what each of them measured, in their order; to be taken before the next chunk
    """

    first: int
    end: int
    tool: int
    tiles: Iterator[TileMeasured]


def rows_cut(chunks: Iterable[Chunk], tools: Mapping[int, RevolvedPieces]) -> Iterator[RowsCut]:
    """Yield what the rows of each chunk did; ``tools`` are the pieces of each tool by its index."""
    for chunk in chunks:
        total = RowTotals(chunk.first, chunk.end, chunk.tool, tools[chunk.tool])
        for measured in chunk.tiles:
            total.add(measured)
        yield total.result()


def is_volume(column: int) -> bool:
    """Whether values of a column add up; of all others the greatest counts."""
    return column in (REMOVED, GOUGED)


def tile_measured(tile: int, bundle: int, row: Ints, measured: Floats, places: Floats) -> TileMeasured:
    """Keep what is not zero of what ``cut_tile`` has measured in sweeps of rows ``row`` (k,)."""
    columns = np.flatnonzero(measured.any(axis=0)).tolist()
    return TileMeasured(tile, bundle, tuple(_column(column, row, measured[:, column], places) for column in columns))


def _column(column: int, row: Ints, value: Floats, places: Floats) -> ColumnMeasured:
    some = np.flatnonzero(value)
    if is_volume(column):
        return ColumnMeasured(column, row[some], value[some], np.zeros((0, 3)))
    order = some[np.lexsort((value[some], row[some]))]
    last = order[np.concatenate((row[order][1:] != row[order][:-1], [True]))]
    return ColumnMeasured(column, row[last], value[last], places[last, column])


class RowTotals:
    """What tiles have measured in the rows ``first`` to ``end`` (exclusive), put together."""

    def __init__(self, first: int, end: int, tool: int, pieces: RevolvedPieces) -> None:
        self._first, self._tool, self._pieces = first, tool, pieces
        count, columns = end - first, column_count(pieces)
        self._sums = np.zeros((2, count))
        self._greatest = np.zeros((3, count, columns))
        self._places = np.full((3, count, columns, 3), np.nan)

    def add(self, measured: TileMeasured) -> None:
        """Add what a tile measured; tiles come in their order."""
        for column, row, value, place in measured.columns:
            at = row - self._first
            if is_volume(column):
                np.add.at(self._sums[column], at, value)
                continue
            own = measured.bundle, at, column
            better = value > self._greatest[own]
            own = measured.bundle, at[better], column
            self._greatest[own] = value[better]
            self._places[own] = _from_bundle(measured.bundle, place[better])

    def result(self) -> RowsCut:
        """Return what the rows did."""
        sections = sorted(set(self._pieces.section[~self._pieces.cuts].tolist()))
        return RowsCut(
            self._first,
            self._tool,
            self._sums[REMOVED] / 3.0,
            self._sums[GOUGED] / 3.0,
            self._depths(MET_IDLE),
            {section: self._depths(MET + section) for section in sections},
        )

    def _depths(self, column: int) -> Depths:
        """Return the smallest of what the bundles have seen."""
        lengths = np.where(self._greatest[:, :, column] > 0.0, self._greatest[:, :, column], np.inf)
        bundle = lengths.argmin(axis=0)
        rows = np.arange(lengths.shape[1])
        depth = lengths[bundle, rows]
        return Depths(np.where(np.isfinite(depth), depth, 0.0), self._places[bundle, rows, column])


def column_count(pieces: RevolvedPieces) -> int:
    """How many things are measured with a tool."""
    return MET + int(pieces.section.max()) + 1


def _from_bundle(bundle: int, places: Floats) -> Floats:
    """Coordinates of a bundle as those of the workpiece frame."""
    found = np.empty_like(places)
    found[:, list(BUNDLE_AXES[bundle])] = places
    return found
