"""Programs whose cuts theory knows: circles in three planes, a bore on a helix, a cone on a tilting table."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.arrays import Floats
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock

HEAD = "G21 G90 G17 G40 G49 G80\nT1 M6\nG43 H1\nS1000 M3\n"
CELLS = [1.0, 0.7, 0.45]


def cut_by(folder: Path, program: str, stock: str, tool: str, cell: float, **arguments: object) -> Stock:
    """What a program leaves of the stock on a mill with a tilting table."""
    nc = folder / "theory.ngc"
    nc.write_text(f"{HEAD}{program}\nM5\nM2\n", encoding="ascii")
    given = {"machine": "xyzac_trt", "stock": stock, "tools": [f"1={tool}"], "cell": cell} | arguments
    found = trunnion.simulate(nc, **given)  # type: ignore[arg-type]
    assert not [each for each in found.remarks if "line" in each.what], found.remarks
    return found.simulation.stock


def cut_ends(stock: Stock) -> Floats:
    """Ends of stretches that the tool made, (n, 3), mm."""
    points = []
    for bundle, axes in enumerate(BUNDLE_AXES):
        spans, (u, v) = stock.spans(bundle), stock.lattice.ray_positions(bundle)
        ray = np.repeat(np.arange(len(spans.first) - 1), 2 * np.diff(spans.first))
        place = np.empty((len(ray), 3))
        place[:, list(axes)] = np.column_stack((u[ray // len(v)], v[ray % len(v)], spans.ends))
        points.append(place[spans.rows >= 0])
    return np.concatenate(points)


def check(stock: Stock, volume: float, area: float, off: Callable[[Floats], Floats]) -> None:
    """Compare with theory: the volume left, the area of what was cut, and how far points are from its surface."""
    cell = float(stock.lattice.cell.max())
    tolerance = 0.1 * cell
    # A plane may lie half a cell off for two of three bundles, and is exact for the third.
    assert abs(stock.volume - volume) <= (cell / 3.0 + tolerance) * area
    points = cut_ends(stock)
    assert len(points) > 500
    assert np.abs(off(points)).max() <= tolerance


@pytest.mark.parametrize("cell", CELLS)
def test_a_full_circle_across_the_tool_leaves_a_ring(tmp_path: Path, cell: float) -> None:
    program = "G0 X10 Y0 Z5\nG1 Z-4 F500\nG17 G2 X10 Y0 I-10 J0\nG0 Z20"
    stock = cut_by(tmp_path, program, "box:40,40,10,-20,-20,-10", "flat:8,length=60,flutes=30", cell)

    def off(points: Floats) -> Floats:
        radius = np.hypot(points[:, 0], points[:, 1])
        return np.minimum(np.abs(np.abs(radius - 10.0) - 4.0), np.abs(points[:, 2] + 4.0))

    bottom = math.pi * (14.0**2 - 6.0**2)
    check(stock, 16000.0 - 4.0 * bottom, bottom + 8.0 * math.pi * (14.0 + 6.0), off)


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(
    ("along", "across", "program", "box"),
    [
        (0, 1, "G0 X14 Y0 Z0\nG18 G2 X14 Z0 I-14 K0 F500", "box:40,10,20,-20,-5,-20"),
        (1, 0, "G0 X0 Y14 Z0\nG19 G3 Y14 Z0 J-14 K0 F500", "box:10,40,20,-5,-20,-20"),
    ],
    ids=["G18", "G19"],
)
def test_a_full_circle_along_the_tool_leaves_a_torus(
    tmp_path: Path, along: int, across: int, program: str, box: str, cell: float
) -> None:
    # The centre of the ball goes round Z4, 4 mm above the stock: below, it leaves the outer half of a torus between two
    # flat walls, and its flutes clear what is above.
    stock = cut_by(tmp_path, f"{program}\nG0 Z30", box, "ball:8,length=60,flutes=50", cell)

    def off(points: Floats) -> Floats:
        ring = np.hypot(points[:, along], points[:, 2] - 4.0) - 14.0
        torus = np.abs(np.hypot(np.maximum(ring, 0.0), points[:, across]) - 4.0)
        return np.minimum(torus, np.abs(np.abs(points[:, across]) - 4.0))

    widths = np.linspace(-4.0, 4.0, 20001)
    outer = 14.0 + np.sqrt(16.0 - widths**2)
    segment = outer**2 * np.arccos(4.0 / outer) - 4.0 * np.sqrt(outer**2 - 16.0)  # of a disc, 4 mm below its centre
    angle = np.arccos(4.0 / outer)
    rim = 2.0 * outer * angle * 4.0 / np.maximum(np.sqrt(16.0 - widths**2), 1e-3)  # its arc, across the torus
    area = float(np.trapezoid(rim, widths)) + 2.0 * float(segment[0])
    check(stock, 8000.0 - float(np.trapezoid(segment, widths)), area, off)


@pytest.mark.parametrize("cell", CELLS)
def test_a_bore_on_a_helix(tmp_path: Path, cell: float) -> None:
    # Five turns down to Z-7.5, and one that levels the bottom.
    turns = "\n".join(f"G3 X5 Y0 I-5 J0 Z{-1.5 * k:g}" for k in range(1, 6))
    program = f"G0 X5 Y0 Z2\nG1 Z0 F500\n{turns}\nG3 X5 Y0 I-5 J0\nG0 Z20"
    stock = cut_by(tmp_path, program, "box:30,30,10,-15,-15,-10", "flat:10,length=60,flutes=30", cell)

    def off(points: Floats) -> Floats:
        return np.minimum(np.abs(np.hypot(points[:, 0], points[:, 1]) - 10.0), np.abs(points[:, 2] + 7.5))

    check(stock, 9000.0 - 750.0 * math.pi, math.pi * (100.0 + 150.0), off)


@pytest.mark.parametrize("cell", CELLS)
def test_a_cone_is_milled_by_a_flank_on_a_tilting_table(tmp_path: Path, cell: float) -> None:
    # The table is tilted by 30 degrees about X through Y20 Z10 of the machine and turns once about its Z; the tool
    # stands still. At C0 its tip is at Y30 Z-12 of the workpiece, so deep that its bottom leaves the stock alone: the
    # flank makes a cone that narrows upwards. Where the tip is on the machine is written out here, as LinuxCNC has it.
    lean, zero = math.radians(30.0), -100.0
    y, z = 30.0 - 20.0, -12.0 + zero - 10.0
    down = f"Z{10.0 - y * math.sin(lean) + z * math.cos(lean) - zero:.9f}"
    in_ = f"Y{20.0 + y * math.cos(lean) + z * math.sin(lean):.9f}"
    program = f"G0 Z90\nG0 A-30 C0\nG0 X0 Y90\nG0 {down}\nG1 {in_} F500\nG1 C360 F1000\nG0 Y90\nG0 Z90"
    setup = {"zero": f"0,0,{zero:g}", "tool_length": 60}
    stock = cut_by(tmp_path, program, "cylinder:40,15", "flat:10,length=60,flutes=45", cell, **setup)

    def radius(height: Floats) -> Floats:
        """Of the cone: the tool's axis, less its radius, which is seen across."""
        return 30.0 - (height + 12.0) * math.tan(lean) - 5.0 / math.cos(lean)

    def off(points: Floats) -> Floats:
        return np.asarray((np.hypot(points[:, 0], points[:, 1]) - radius(points[:, 2])) * math.cos(lean))

    below, above = radius(np.array([0.0, 15.0]))
    volume = math.pi * 15.0 / 3.0 * (below**2 + below * above + above**2)
    check(stock, volume, math.pi * (below + above) * 15.0 / math.cos(lean), off)
