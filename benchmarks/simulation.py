"""How fast stock is cut: ``python benchmarks/simulation.py``.

    tilting     100,000 five-axis blocks, ball R5 that tilts, 100 x 100 x 50 mm, cells of 0.2 mm
    wide        a million blocks, 200 x 200 x 50 mm, cells of 0.4 mm
    level       500,000 level segments of a flat mill, 100 x 60 x 20 mm, cells of 0.5 mm
    collisions  100,000 five-axis blocks, ten pairs of bodies of 5,120 facets (``collisions.py``)

Each case is cut in a process of its own. Seconds are those of cutting, kernels compiled; to read the program is not
part of them: the motions are made here, so that the figures are those of the removal alone. They are judged as on the
machine for which seconds are asked (``throughput.py``). ``--blocks N`` takes fewer blocks; seconds, memory and
growth are not judged then. Exit code 1 if a figure that is asked for is not met.
"""

import argparse
import json
import math
import os
import platform
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from throughput import HERE, MILLION, REFERENCE_SECONDS, Figure, make_cls, seconds_figure, table
from throughput import run as run_process
from trunnion.arrays import Floats
from trunnion.simulation.cutting.measurements import Chunk, rows_cut
from trunnion.simulation.cutting.removal import Cutter
from trunnion.simulation.cutting.sweeps import CHUNK_ROWS, RowSweeps
from trunnion.simulation.stock.solids import make_stock, stock_shape
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import ball, flat

COLLISIONS = "collisions"

#: Points of the naive post that says how fast the machine is.
NAIVE_POINTS = 100_000

#: Segments a second of each of 24 cores of chipbreaker, which cuts the level case in 43 s.
CHIPBREAKER = 500_000 / 43.0 / 24

#: Memory of the cutting itself in sizes of the dexels, and how much longer the second half of the blocks may take.
MEMORY_RATIO = 2.0
SMALL_STOCK = 2**24  # bytes of dexels; with fewer, what a few thousand blocks need weighs more
GROWTH_RATIO = 1.5


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


@dataclass(frozen=True, slots=True)
class Measured:
    """What a case took: wall and processor seconds, bytes of the dexels and of all that cutting needs.

    halves  wall seconds of the first and the second half of the blocks
    own     0 where the system does not tell
    """

    blocks: int
    rays: int
    seconds: float
    used: float
    halves: tuple[float, float]
    removed: float
    dexels: int
    own: int


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


def cut_case(case: Case, blocks: int, threads: int, cell: float) -> Measured:
    """Cut a case in this process."""
    tips, axes = path(case, blocks)
    pieces, _ = revolved_pieces(case.tool, 0.025 * cell)
    before = memory("VmRSS")
    x, y, z = case.sizes
    stock = make_stock(stock_shape(f"box:{x},{y},{z},0,0,{-z}"), cell)
    cutter = Cutter(stock, None, 0.1 * cell)
    volume, used = stock.volume, time.process_time()
    ticks = [time.perf_counter()]
    with ThreadPoolExecutor(threads) as executor:
        for first in range(0, blocks, CHUNK_ROWS):
            part = slice(first, min(first + CHUNK_ROWS, blocks))
            after = slice(part.start + 1, part.stop + 1)
            rows = np.arange(part.start, part.stop)
            sweeps = RowSweeps(part.start, part.stop, 1, rows, tips[part], tips[after], axes[part], axes[after])
            tiles = cutter.measure(sweeps, pieces, executor)
            for _ in rows_cut([Chunk(part.start, part.stop, 1, tiles)], {1: pieces}):
                pass
            ticks.append(time.perf_counter())
    used = time.process_time() - used
    dexels = sum(tile.ends.nbytes + tile.rows.nbytes + tile.normals.nbytes + tile.count.nbytes for tile in stock.tiles)
    middle = ticks[len(ticks) // 2]
    halves = (middle - ticks[0], ticks[-1] - middle) if len(ticks) > 2 else (math.nan, math.nan)
    own = max(0, memory("VmHWM") - before) if before else 0
    return Measured(
        blocks, stock.lattice.ray_count, ticks[-1] - ticks[0], used, halves, volume - stock.volume, dexels, own
    )


def memory(key: str) -> int:
    """Bytes of this process: ``VmRSS`` as they are, ``VmHWM`` at most; 0 where the system does not tell."""
    try:
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith(f"{key}:")), 0)


def measure(case: Case, blocks: int, threads: int) -> Measured:
    """Cut a case in a process of its own."""
    command = [sys.executable, __file__, "--alone", case.name, str(blocks), str(threads)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{case.name} failed\n{done.stderr}")
    return Measured(**json.loads(done.stdout))


def alone(name: str, blocks: int, threads: int) -> None:
    """Cut a case and print what was measured, for the process that has asked."""
    case = next(case for case in CASES if case.name == name)
    cut_case(case, 100, threads, 4.0)  # compiles the kernels, or loads them
    print(json.dumps(asdict(cut_case(case, blocks, threads, case.cell))))


def slowness() -> float:
    """How many times slower the naive post is here than where seconds are asked."""
    with tempfile.TemporaryDirectory(prefix="trunnion-simulation-") as folder:
        source, target = Path(folder) / "naive.cls", Path(folder) / "naive.mpf"
        make_cls(NAIVE_POINTS, source)
        command = [sys.executable, str(HERE / "naive_post.py"), str(source), str(target)]
        seconds = min(run_process(command).wall for _ in range(3))
    return seconds * MILLION / NAIVE_POINTS / REFERENCE_SECONDS


def figures_of(case: Case, one: Measured, threads: int, slower: float) -> list[Figure]:
    """Return the figures to judge of a case."""
    whole = one.blocks == case.blocks
    found = []
    if case.asked is not None:
        figure = seconds_figure(f"{case.name}, cut on {threads} cores", one.seconds, case.asked, slower)
        found.append(figure if whole else Figure(figure.what, figure.asked, figure.measured, None))
    else:
        rate = one.blocks / one.seconds / threads / CHIPBREAKER
        found.append(
            Figure(f"{case.name}, segments/s and core, trunnion / chipbreaker", "> 1", f"{rate:.0f}", rate > 1.0)
        )
    ratio = one.own / one.dexels
    measured = f"{ratio:.2f} ({one.own / 2**20:.0f} MiB)" if one.own else "not told by the system"
    judged = ratio <= MEMORY_RATIO if one.own and whole and one.dexels >= SMALL_STOCK else None
    found.append(Figure(f"{case.name}, memory of cutting / dexels", f"<= {MEMORY_RATIO:g}", measured, judged))
    growth = one.halves[1] / one.halves[0]
    # The second half of the level case cuts deeper.
    judged = growth <= GROWTH_RATIO if whole and case.tilts else None
    found.append(
        Figure(f"{case.name}, second half of the blocks / first", f"<= {GROWTH_RATIO:g}", f"{growth:.2f}", judged)
    )
    return found


def collision_figure(slower: float, blocks: int | None) -> Figure:
    """How long collisions of the bodies of a machine are looked for."""
    what, asked = "collisions of ten pairs of bodies", "<= 20 s"
    try:
        from collisions import BLOCKS, check_times
    except ModuleNotFoundError as error:  # python-fcl of the extra simulate
        return Figure(what, asked, f"skipped: no {error.name}", None)
    seconds = max(check_times(blocks or BLOCKS))
    figure = seconds_figure(what, seconds, 20.0, slower)
    return figure if blocks is None else Figure(what, asked, figure.measured, None)


def report(case: Case, one: Measured, threads: int) -> tuple[str, ...]:
    """Return a line of the table of cases."""
    return (
        case.name, f"{one.blocks:,}", f"{one.rays:,}", f"{one.seconds:.1f}", f"{one.used:.1f}",
        f"{one.blocks / one.seconds:,.0f}", f"{one.blocks / one.seconds / threads:,.0f}", f"{one.removed:,.0f}",
        f"{one.dexels / 2**20:.0f}", f"{one.own / 2**20:.0f}" if one.own else "-",
    )  # fmt: skip


def main() -> int:
    """Run the cases."""
    if sys.argv[1:2] == ["--alone"]:
        alone(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
        return 0
    names = [*(case.name for case in CASES), COLLISIONS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help=f"of {', '.join(names)}; all by default")
    parser.add_argument("--blocks", type=int, help="at most so many of each case")
    parser.add_argument("--threads", type=int, default=min(2, os.cpu_count() or 1), help="default: %(default)s")
    arguments = parser.parse_args()
    wanted = arguments.cases or names
    if unknown := [name for name in wanted if name not in names]:
        parser.error(f"no case {unknown[0]}; give one of {', '.join(names)}")
    print(f"{platform.platform()}, {os.cpu_count()} processors, Python {platform.python_version()}")
    slower = slowness()
    print(f"this machine is {slower:.2f} times slower than the one for which seconds are asked, by the naive post\n")
    rows: list[tuple[str, ...]] = [
        ("case", "blocks", "rays", "s", "processor s", "blocks/s", "per core", "mm³", "dexels MiB", "cutting MiB")
    ]
    figures: list[Figure] = []
    for case in CASES:
        if case.name in wanted:
            one = measure(case, min(case.blocks, arguments.blocks or case.blocks), arguments.threads)
            rows.append(report(case, one, arguments.threads))
            figures += figures_of(case, one, arguments.threads, slower)
    table(rows)
    if COLLISIONS in wanted:
        figures.append(collision_figure(slower, arguments.blocks))
    verdict = {True: "met", False: "NOT MET", None: "not judged"}
    print()
    table([("figure", "asked", "measured", ""), *((f.what, f.asked, f.measured, verdict[f.met]) for f in figures)])
    return 1 if any(figure.met is False for figure in figures) else 0


if __name__ == "__main__":
    sys.exit(main())
