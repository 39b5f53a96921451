"""How fast stock is cut: ``python benchmarks/simulation.py``, all figures printed.

    tilting     100,000 five-axis blocks, ball R5 that tilts, 100 x 100 x 50 mm, cells of 0.2 mm; at most 60 s are asked
    wide        a million blocks, 200 x 200 x 50 mm, cells of 0.4 mm; at most 120 s are asked
    level       500,000 level segments of a flat mill, 100 x 60 x 20 mm, cells of 0.5 mm

``--blocks N`` takes fewer: time grows with their number. Seconds are those of cutting, kernels compiled; read the
program is not part of them. The motions are made here, not read, so that the figures are those of the removal alone.
"""

import argparse
import math
import os
import resource
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats
from trunnion.simulation.cutting.removal import Cutter
from trunnion.simulation.cutting.sweeps import CHUNK_ROWS, RowSweeps
from trunnion.simulation.stock.solids import make_stock, stock_shape
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import ball, flat


@dataclass(frozen=True, slots=True)
class Case:
    """A path over stock of some sizes, mm."""

    name: str
    blocks: int
    sizes: tuple[float, float, float]
    cell: float
    tool: ToolShape
    tilts: bool
    asked: float | None


CASES = (
    Case("tilting", 100_000, (100.0, 100.0, 50.0), 0.2, ball(10.0, flute_length=20.0, length=60.0), True, 60.0),
    Case("wide", 1_000_000, (200.0, 200.0, 50.0), 0.4, ball(10.0, flute_length=20.0, length=60.0), True, 120.0),
    Case("level", 500_000, (100.0, 60.0, 20.0), 0.5, flat(6.0, flute_length=20.0, length=60.0), False, None),
)


def path(case: Case, blocks: int) -> tuple[Floats, Floats]:
    """Tips and tool axes of a zigzag over the stock, as many as the whole case has rows, cut off after ``blocks``."""
    rows = max(2, round(math.sqrt(case.blocks * case.sizes[1] / case.sizes[0]) * 0.9))
    k = np.arange(blocks + 1)
    per = case.blocks / rows
    row, part = np.floor(k / per), k / per - np.floor(k / per)
    x = case.sizes[0] * np.where(row % 2, 1.0 - part, part)
    y = case.sizes[1] * row / rows
    if not case.tilts:
        z = -1.0 - np.floor(10.0 * row / rows)
        return np.column_stack((x, y, z)), np.tile((0.0, 0.0, 1.0), (len(k), 1))
    z = -6.0 + 3.0 * np.sin(x / 12.0) * np.cos(y / 15.0)
    tilt, turn = np.radians(15.0 + 14.0 * np.sin(x / 20.0 + y / 30.0)), np.radians(40.0 * np.sin(y / 25.0))
    axis = np.column_stack((np.sin(tilt) * np.sin(turn), -np.sin(tilt) * np.cos(turn), np.cos(tilt)))
    return np.column_stack((x, y, z)), axis


def run(case: Case, blocks: int, threads: int) -> None:
    """Cut a case and print its figures."""
    x, y, z = case.sizes
    stock = make_stock(stock_shape(f"box:{x},{y},{z},0,0,{-z}"), case.cell)
    tips, axes = path(case, blocks)
    pieces, _ = revolved_pieces(case.tool, 0.025 * case.cell)
    cutter = Cutter(stock, None, 0.1 * case.cell)
    before, begin, used = stock.volume, time.perf_counter(), time.process_time()
    with ThreadPoolExecutor(threads) as executor:
        for first in range(0, blocks, CHUNK_ROWS):
            part = slice(first, min(first + CHUNK_ROWS, blocks))
            after = slice(part.start + 1, part.stop + 1)
            rows = np.arange(part.start, part.stop)
            sweeps = RowSweeps(part.start, part.stop, 1, rows, tips[part], tips[after], axes[part], axes[after])
            cutter.cut(sweeps, pieces, executor)
    seconds, used = time.perf_counter() - begin, time.process_time() - used
    rays = stock.lattice.ray_count
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    dexels = sum(tile.ends.nbytes + tile.rows.nbytes + tile.normals.nbytes + tile.count.nbytes for tile in stock.tiles)
    asked = f" (asked {case.asked:.0f})" if case.asked else ""
    print(
        f"{case.name}: {blocks} blocks, {rays} rays of {case.cell} mm, {threads} threads: {seconds:.1f} s{asked},"
        f" {used:.1f} s of processor, {blocks / seconds:.0f} blocks/s, {before - stock.volume:.0f} mm³;"
        f" rays {dexels / 2**20:.0f} MiB,"
        f" process {memory:.0f} MiB"
    )


def main() -> None:
    """Run the cases."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", choices=[*(case.name for case in CASES), []], help="all by default")
    parser.add_argument("--blocks", type=int, help="at most so many of each case")
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()
    run(CASES[0], 100, 1)  # compiles the kernels
    for case in CASES:
        if not arguments.cases or case.name in arguments.cases:
            run(case, min(case.blocks, arguments.blocks or case.blocks), arguments.threads)


if __name__ == "__main__":
    main()
