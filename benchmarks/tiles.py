"""A simulation divided by tiles: ``PYTHONPATH=. python benchmarks/tiles.py [--blocks N] [--shares 2,4,8,16]``.

A five-axis program of N blocks (20,000 by default; a ball that tilts, over a block of 100 x 100 x 50 mm in cells of
0.2 mm, with a part) is simulated by one process with one thread, then in so many shares, one after another in this
process. Prints processor seconds of the whole, of the shares and of joining them, and their bytes; and from these what
many cores would give. Exit code 1 if a joined result differs from the undivided one in anything.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

import trunnion
from simulation import CASES, path
from trunnion.jobs.observer import SILENT
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.shares import join_shares, simulate_share
from trunnion.results import to_data
from trunnion.simulation.cutting.shares import Share
from trunnion.simulation.meshes import save_mesh
from trunnion.simulation.meshes.primitives import box_mesh

HEAD = """TOOL PATH/MILL,TOOL,BALL
TLDATA/MILL,10.0000,5.0000,60.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
LOAD/TOOL,1
SPINDL/RPM,8000,CLW
RAPID
"""

Result = TypeVar("Result")


def measured(work: Callable[[], Result]) -> tuple[Result, float]:
    """Return a result, and the processor seconds that it took."""
    used = time.process_time()
    return work(), time.process_time() - used


def make_program(folder: Path, blocks: int) -> Path:
    """Return the program of the tilting case of ``simulation.py``, posted."""
    case = next(each for each in CASES if each.name == "tilting")
    tips, axes = path(replace(case, blocks=blocks), blocks)
    points = [",".join(f"{number:.6f}" for number in row) for row in np.column_stack((tips, axes)).tolist()]
    lines = [f"GOTO/{points[0]}", "FEDRAT/MMPM,2000.0000", *(f"GOTO/{each}" for each in points[1:]), "END-OF-PATH"]
    source = folder / "tilting.cls"
    source.write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    program = folder / "tilting.mpf"
    trunnion.post(source, machine="yl569", output=program, force=True)
    return program


def same(one: SimulationResult, other: SimulationResult) -> bool:
    """Whether two results are equal to the last bit: data, findings, volumes of rows, stock."""
    texts = [json.dumps(to_data(replace(each, seconds=0.0))) for each in (one, other)]
    rows = [[each.removed for each in found.simulation.operations] for found in (one, other)]
    stocks = [[found.simulation.stock.spans(bundle) for bundle in range(3)] for found in (one, other)]
    return (
        texts[0] == texts[1]
        and all(np.array_equal(a, b) for a, b in zip(*rows, strict=True))
        and all(
            np.array_equal(getattr(a, name), getattr(b, name))
            for a, b in zip(*stocks, strict=True)
            for name in ("first", "ends", "rows", "normals")
        )
    )


def divided(program: Path, given: Any, count: int, whole: SimulationResult, seconds: float) -> bool:
    """Simulate in shares, and print what it took; whether the result is that of the whole."""
    shares = [measured(partial(simulate_share, program, Share(k, count), given, SILENT)) for k in range(count)]
    contents, used = [content for content, _ in shares], [own for _, own in shares]
    found, joining = measured(lambda: join_shares(program, contents, given, SILENT))
    is_same = same(whole, found)
    longest, together = max(used), sum(used)
    print(
        f"{count:6} {together:10.1f} {longest:10.1f} {longest * count / together:8.2f} {joining:8.1f} "
        f"{sum(map(len, contents)) / 1e6:8.1f} {max(map(len, contents)) / 1e6:8.1f} "
        f"{seconds / (longest + joining):8.1f}  {'' if is_same else 'DIFFERS'}",
        flush=True,
    )
    return is_same


def main() -> int:
    """Measure, and judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--blocks", type=int, default=20_000)
    parser.add_argument("--cell", type=float, default=0.2)
    parser.add_argument("--shares", default="1,2,4,8,16", help="default: %(default)s")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="trunnion-tiles-") as temporary:
        folder = Path(temporary)
        part = folder / "part.stl"
        save_mesh(box_mesh(np.array([0.0, 0.0, -50.0]), np.array([100.0, 100.0, -9.2])), part)
        program = make_program(folder, asked.blocks)
        given = {
            "machine": trunnion.load_machine("yl569"), "stock": "box:100,100,50,0,0,-50", "part": part,
            "tools": ["1=ball:10,length=60,flutes=20"], "cell": asked.cell, "threads": 1,
        }  # fmt: skip
        trunnion.simulate(program, **{**given, "cell": 4.0})  # compiles the kernels, or loads them
        whole, seconds = measured(lambda: trunnion.simulate(program, **given))
        tiles, rays = len(whole.simulation.stock.tiles), whole.simulation.stock.lattice.ray_count
        print(
            f"{asked.blocks} blocks, {rays} rays in {tiles} tiles; undivided {seconds:.1f} s of processor time, ",
            end="",
        )
        print(f"{len(whole.findings)} findings, {whole.removed:.0f} mm³")
        print("shares  together s  longest s  /mean   join s       MB  largest   faster")
        results = [divided(program, given, int(count), whole, seconds) for count in asked.shares.split(",")]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
