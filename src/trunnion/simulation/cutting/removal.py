"""Cutting: a run removes material from stock, and what happened in each row is measured.

In:     stock, a run, the pieces of each tool, and the design if it is known.
Out:    the stock that is left; for each row the volume removed and how deep the tool went where it must not.
Units:  mm, workpiece frame.

The rows are taken in chunks. For each chunk the sweeps that may reach a tile are listed, and the tiles are cut side by
side, each by one thread and in the order of the program: the result does not depend on the number of threads.

How deep something is in something else is measured along the rays of all three bundles; the depth is the smallest of
the three greatest thicknesses.
"""

import os
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.simulation.cutting.cut_kernel import CutterTable, Sweeps, bin_sweeps, cut_tile
from trunnion.simulation.cutting.measurements import Chunk, TileMeasured, column_count, tile_measured
from trunnion.simulation.cutting.stretch_kernel import Rays
from trunnion.simulation.cutting.sweeps import RowSweeps, SweepSizes, row_sweeps, tool_ranges
from trunnion.simulation.cutting.tool_table import element_table, piece_list
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock, Tile
from trunnion.simulation.stock.spans import Spans, no_spans
from trunnion.simulation.tools.pieces import RevolvedPieces


@dataclass(frozen=True, slots=True, eq=False)
class CutRows:
    """The rows of a run that cut.

    start, end  at which to begin, which the stock must have been cut up to, and to end
    idle        those that must not cut, (n,) of the run: rapids, and those in which the spindle stands; None: all may
    offset      what is added to the numbers of rows in ``Tile.rows``
    """

    start: int
    end: int
    idle: Flags | None = None
    offset: int = 0


def measure(
    cutter: "Cutter",
    run: Run,
    tools: Mapping[int, RevolvedPieces],
    rows: CutRows,
    *,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Iterator[Chunk]:
    """Cut stock with the rows of a run, and yield what the tiles measure: each chunk is cut while its tiles are taken.

    The stock is changed. It may have some tiles only: no tile looks at another one. ``rows_cut`` makes of the chunks
    what each row did.

    cutter    the material, and how it is cut
    run       the program
    tools     the pieces of each tool, by its index in ``run.tools``. Rows of a tool that is not there are not simulated
    rows      those that cut
    threads   how many tiles are cut at a time; by default as many as there are processors
    progress  is called with rows done and rows in all
    """
    end = rows.end
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as executor:
        for first, last, tool in tool_ranges(run, end, rows.start):
            if tool in tools:
                sweeps = row_sweeps(run, first, last, cutter.sizes(tools[tool]))
                advance = _part_of(progress, first, last, end)
                tiles = cutter.measure(sweeps, tools[tool], executor, rows.idle, rows.offset, advance)
                yield Chunk(first, last, tool, tiles)
            if progress:
                progress(last, end)


def _part_of(
    progress: Callable[[int, int], None] | None, first: int, last: int, end: int
) -> Callable[[float], None] | None:
    """Return what tells of a part of the rows ``first`` to ``last`` (exclusive) of ``end``."""
    return None if progress is None else lambda part: progress(first + int(part * (last - first)), end)


class _Task(NamedTuple):
    """A tile by its number, the sweeps of some rows in its bundle, and those that may reach it."""

    tile: int
    sweeps: Sweeps
    wanted: Ints


class Cutter:
    """Cuts stock with sweeps.

    design     the finished part as spans of the same lattice
    tolerance  how far motions may be off, mm
    """

    def __init__(self, stock: Stock, design: tuple[Spans, Spans, Spans] | None, tolerance: float) -> None:
        self._stock = stock
        self._tolerance = tolerance
        self._rays = [_rays(stock, tile, design) for tile in stock.tiles]
        self._boxes = [tile.box for tile in stock.tiles]

    def sizes(self, pieces: RevolvedPieces) -> SweepSizes:
        """Return what motions of a tool are divided for."""
        lattice = self._stock.lattice
        cuts = pieces.cuts if pieces.cuts.any() else np.ones_like(pieces.cuts)
        reach, radius = float(pieces.bounds[cuts, 1].max()), float(pieces.bounds[cuts, 2].max())
        whole = float(pieces.bounds[:, 1].max())
        size = float(np.linalg.norm(lattice.high - lattice.low))
        return SweepSizes(max(reach, radius, 0.5 * whole), radius, self._tolerance, 2.0 * size + whole)

    def measure(
        self,
        sweeps: RowSweeps,
        pieces: RevolvedPieces,
        executor: ThreadPoolExecutor,
        idle: Flags | None = None,
        offset: int = 0,
        advance: Callable[[float], None] | None = None,
    ) -> Iterator[TileMeasured]:
        """Cut with the sweeps of some rows, and yield what each tile that is reached has measured, in their order.

        ``advance`` is called with the part that is done, others are those of ``CutRows``.
        """
        at_rest = np.zeros(len(sweeps.row), np.bool_) if idle is None else idle[sweeps.row]
        low, high = float(pieces.bounds[:, 0].min()), float(pieces.bounds[:, 1].max())
        boxes = _boxes(sweeps, low, high, float(pieces.bounds[:, 2].max()))
        columns, table = column_count(pieces), element_table(pieces)
        tool = CutterTable(piece_list(pieces, table), table, pieces.cuts, pieces.section)
        tasks: list[_Task] = []
        for bundle in range(3):
            axes = BUNDLE_AXES[bundle]
            own = Sweeps(sweeps.poses(axes), sweeps.row + offset, at_rest)
            which = [k for k, tile in enumerate(self._stock.tiles) if tile.bundle == bundle]
            lists = _lists(
                boxes[:, [2 * axes[0], 2 * axes[0] + 1, 2 * axes[1], 2 * axes[1] + 1, 2 * axes[2], 2 * axes[2] + 1]],
                np.array([self._boxes[k] for k in which]).reshape(-1, 6),
            )
            tasks += [_Task(k, own, wanted) for k, wanted in zip(which, lists, strict=True) if len(wanted)]
        # Longest first: no processor waits at the end for one that has begun a long task last.
        longest = sorted(tasks, key=lambda task: -len(task.wanted))
        running = {
            task.tile: executor.submit(self._cut_tile, task, sweeps.row[task.wanted], tool, columns) for task in longest
        }
        done, whole = 0, sum(len(task.wanted) for task in tasks)
        try:
            for task in tasks:
                yield running.pop(task.tile).result()
                done += len(task.wanted)
                if advance:
                    advance(done / whole)
        finally:
            for future in running.values():
                future.cancel()

    def _cut_tile(self, task: _Task, rows: Ints, tool: CutterTable, columns: int) -> TileMeasured:
        """Cut a tile; ``rows`` are those of the run to which its sweeps belong."""
        k, sweeps, wanted = task
        tile = self._stock.tiles[k]
        measured, places = np.zeros((len(wanted), columns)), np.zeros((len(wanted), columns, 3))
        done = 0
        while True:
            done = cut_tile(
                self._rays[k], tile.count, tile.ends, tile.rows, tile.normals, sweeps, wanted, done, tool,
                0.01 * self._tolerance, measured, places,
            )  # fmt: skip
            if done == len(wanted):
                break
            tile.widen()
        self._boxes[k] = tile.box
        return tile_measured(k, tile.bundle, rows, measured, places)


def _rays(stock: Stock, tile: Tile, design: tuple[Spans, Spans, Spans] | None) -> Rays:
    area = stock.cell_area(tile.bundle)
    if design is None:
        spans = no_spans(len(tile.count))
    else:
        width = stock.lattice.rays(tile.bundle)[1]
        columns = tile.first_v + np.arange(len(tile.v))
        rays = ((tile.first_u + np.arange(len(tile.u)))[:, None] * width + columns).ravel()
        spans = design[tile.bundle].at(rays)
    return Rays(tile.u, tile.v, area, spans.first, spans.ends)


def _boxes(sweeps: RowSweeps, low: float, high: float, widest: float) -> Floats:
    """Boxes around the cylinder in which the whole tool is: lowest and highest x, y and z of each sweep, (m, 6)."""
    boxes = np.empty((len(sweeps.row), 6))
    boxes[:, 0::2], boxes[:, 1::2] = np.inf, -np.inf
    for tip, axis in ((sweeps.start, sweeps.axis), (sweeps.end_tip, sweeps.end_axis)):
        across = widest * np.sqrt(np.maximum(0.0, 1.0 - axis * axis))
        boxes[:, 0::2] = np.minimum(boxes[:, 0::2], tip + np.minimum(low * axis, high * axis) - across)
        boxes[:, 1::2] = np.maximum(boxes[:, 1::2], tip + np.maximum(low * axis, high * axis) + across)
    return boxes


def _lists(boxes: Floats, tiles: Floats) -> list[Ints]:
    """Return the sweeps that may reach each tile, in order."""
    counts = np.zeros(len(tiles), np.int64)
    bin_sweeps(boxes, tiles, np.full(1, -1), counts)
    first = np.concatenate(([0], np.cumsum(counts)))
    flat = np.empty(first[-1], np.int64)
    bin_sweeps(boxes, tiles, first, flat)
    return [flat[first[k] : first[k + 1]] for k in range(len(tiles))]
