"""The finished stock of one part on three controls, and the pictures of the docs:
``python -m benchmarks.finished_stock [IMPELLER.ngc]``, from the project's folder.

LinuxCNC's impeller of seven blades (``impeller-7bl-xyzac.ngc``) is converted for a Sinumerik and for a Heidenhain on
machines of other kinematics; each program cuts a plain cylinder, and the three stocks are compared along all rays.
Exit code 1 if they differ by a cell anywhere. Draws ``docs/pictures/impeller.png``, and without the impeller
``docs/pictures/deviation.png``: the YL569 hub, roughed with a tool that is too large, against the finished part.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import trunnion
from trunnion.arrays import Floats, Ints
from trunnion.simulation.meshes import picture
from trunnion.simulation.stock.deviation import Excess, left_on
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans
from trunnion.simulation.stock.surface import stock_surface

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
GOLDEN = ROOT / "tests" / "golden" / "yl569"

#: The program calls no tool; a ball mill of 6 mm is taken, and a cylinder that its first rapid clears.
BLANK, BALL = "cylinder:76,34,-8", "1=ball:6,length=75,flutes=60"
MACHINES = ("xyzac_trt", "yl569", "dmu65")

#: Of a picture of deviations: the greatest one, mm, and its colours: too little material, none or little, too much.
MOST = 1.0
GOUGED, SOUND, LEFT = (0.90, 0.10, 0.08), (0.80, 0.80, 0.80), (0.10, 0.35, 0.90)

Bundles = tuple[Spans, Spans, Spans]


def bundles(stock: Stock) -> Bundles:
    """Return the stretches of all rays."""
    return stock.spans(0), stock.spans(1), stock.spans(2)


def difference(one: Stock, other: Stock, limit: float) -> tuple[Excess, Excess]:
    """Return what either stock has beyond the other, on the same rays."""
    return left_on(one, bundles(other), limit), left_on(other, bundles(one), limit)


def converted(impeller: Path, folder: Path) -> dict[str, Path]:
    """Return the program for each machine: the first one with a work offset and a tool call, which it leaves
    to others.
    """
    own = folder / "impeller.ngc"
    own.write_text("G54\nT1 M6\n" + impeller.read_text(encoding="utf-8"), encoding="utf-8")
    found = {MACHINES[0]: own}
    for machine in MACHINES[1:]:
        result = trunnion.convert(own, machine=MACHINES[0], to_machine=machine, output=folder / f"{machine}.nc")
        print(f"{machine}: {result}")
        found[machine] = folder / f"{machine}.nc"
    return found


def nearest(spans: Spans, ray: Ints, height: Floats, lowest: float, far: float) -> Ints:
    """Return the end of the stretches of rays that is nearest to heights, -1 on rays without any."""
    owner = np.repeat(np.arange(len(spans.first) - 1), 2 * np.diff(spans.first))
    after = np.searchsorted(owner * far + spans.ends - lowest, ray * far + height - lowest)
    found, best = np.full(len(ray), -1), np.full(len(ray), np.inf)
    for at in (after - 1, after):
        near = np.clip(at, 0, len(owner) - 1)
        way = np.where(owner[near] == ray, np.abs(height - spans.ends[near]), np.inf)
        found = np.where(way < best, near, found)
        best = np.minimum(best, way)
    return found


def deviations(points: Floats, stock: Stock, design: Bundles) -> Floats:
    """How far the surface of stock is out of a design at points of it, (n,), mm; negative inside.

    Of the rays through the cell of a point, those count that leave the stock within a cell of it: from there to the
    nearest end of the design, across the surface, and of the three bundles the least.
    """
    lattice, best = stock.lattice, np.full(len(points), np.inf)
    cell = np.clip(np.floor((points - lattice.low) / lattice.cell).astype(np.int64), 0, np.array(lattice.counts) - 1)
    far = 10.0 * float((lattice.high - lattice.low).max())
    for own, wanted, (u, v, w) in zip(bundles(stock), design, BUNDLE_AXES, strict=True):
        ray, lowest = cell[:, u] * lattice.counts[v] + cell[:, v], float(lattice.low[w])
        here = nearest(own, ray, points[:, w], lowest, far)
        there = nearest(wanted, ray, own.ends[here], lowest, far)
        counts = (here >= 0) & (np.abs(own.ends[here] - points[:, w]) <= lattice.cell[w])
        way = (own.ends[here] - wanted.ends[there]) * own.normals[here, 2] / 127.0
        way = np.where(there >= 0, way, far)  # nothing of the design is on this ray
        best = np.where(counts & (np.abs(way) < np.abs(best)), way, best)
    return np.where(np.isfinite(best), best, 0.0)


def coloured(way: Floats, limit: float) -> Floats:
    """Colours of deviations, (n, 3); those up to ``limit`` have that of a sound surface."""
    share = np.clip((np.abs(way) - limit) / (MOST - limit), 0.0, 1.0)[:, None] ** 0.5
    return np.asarray((1.0 - share) * SOUND + share * np.where((way > 0.0)[:, None], LEFT, GOUGED))


def cut(programs: Sequence[Path], machine: str, stock: str, tools: Sequence[str], cell: float) -> Stock:
    """Return the stock that programs leave."""
    begin = time.perf_counter()
    found = trunnion.simulate(programs, machine=machine, stock=stock, tools=tools, cell=cell)
    seconds = time.perf_counter() - begin
    print(f"{machine}: {found.removed:.1f} mm³ removed, {len(found.findings)} findings, {seconds:.1f} s")
    return found.simulation.stock


def hub(cell: float) -> None:
    """Draw the hub, roughed with a ball mill of 11 in place of 10 mm, in the colours of its deviation."""
    programs = [GOLDEN / f"{name}.expected.mpf" for name in ("1_contour_rough", "2_hub_rough", "3_blade_finish")]
    flat, ball = "1=flat:16,length=75,flutes=40", "2=ball:{},length=75,flutes=40"
    box = "cylinder:108,30,-30"
    design = bundles(cut(programs, "yl569", box, [flat, ball.format(10)], cell))
    stock = cut(programs[:2], "yl569", box, [flat, ball.format(11)], cell)
    mesh = stock_surface(stock)
    drawn = picture(mesh, colours=coloured(deviations(mesh.vertices, stock, design), 0.2 * cell), azimuth=-30.0)
    (PICTURES / "deviation.png").write_bytes(drawn)


def impeller(program: Path, cell: float, fine: float) -> bool:
    """Compare the stocks of three machines, and draw one; whether they are equal within a cell."""
    sound = True
    with tempfile.TemporaryDirectory() as name:
        programs = converted(program, Path(name))
        stocks = {machine: cut([path], machine, BLANK, [BALL], cell) for machine, path in programs.items()}
        for machine in MACHINES[1:]:
            more, less = difference(stocks[MACHINES[0]], stocks[machine], 0.0)
            worst = max(more.largest, less.largest)
            print(f"{MACHINES[0]} and {machine}: {worst:.3f} mm apart at most, {more.volume + less.volume:.2f} mm³")
            sound = sound and worst < cell
        drawn = picture(stock_surface(cut([programs[MACHINES[0]]], MACHINES[0], BLANK, [BALL], fine)), elevation=40.0)
        (PICTURES / "impeller.png").write_bytes(drawn)
    return sound


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Compare and draw finished stocks.")
    parser.add_argument("impeller", nargs="?", type=Path, help="impeller-7bl-xyzac.ngc of LinuxCNC; else left out")
    parser.add_argument("--cell", type=float, default=0.5, help="cell of the comparison, mm")
    parser.add_argument("--fine", type=float, default=0.25, help="cell of the pictures, mm")
    arguments = parser.parse_args()
    hub(arguments.fine)
    return 0 if arguments.impeller is None or impeller(arguments.impeller, arguments.cell, arguments.fine) else 1


if __name__ == "__main__":
    sys.exit(main())
