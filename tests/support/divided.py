"""A simulation that has everything to be found, for tests that divide it; and what two of them must have in common."""

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

import trunnion
from tests.support.simulating import HEAD, cuboid
from trunnion.jobs.observer import SILENT
from trunnion.jobs.simulate.shares import join_shares, simulate_share
from trunnion.results import to_data
from trunnion.simulation.cutting.shares import Share
from trunnion.simulation.meshes import TriangleMesh, save_mesh

#: Files beside the program.
PART, CLAMP = "wall.stl", "clamp.stl"

STOCK: Final = "box:50,40,10,0,-20,-10"
TOOLS: Final = ("1=flat:10,length=40,flutes=12,shank=12,holder=40x50", "2=ball:6,length=60,flutes=20")

#: Arguments of ``trunnion.simulate`` besides files.
GIVEN: Final[dict[str, Any]] = {"machine": "xyzac_trt", "stock": STOCK, "tools": TOOLS, "cell": 0.3, "near": 3.0}


def program() -> str:
    """Three slots side by side take a wall of the part with all that is around it, from above to below the stock.

    A rapid goes through stock, the shank goes into it, the spindle stands in a cut, a clamp is hit; two tools cut in
    turns, and the second one tilts and turns.
    """
    waves = "".join(
        f"G1 X{2 + 0.4 * k:g} Y{15 + k % 4:g} Z{-1 - 0.05 * k:g} A{k % 9:g} C{2 * k:g}\n" for k in range(60)
    )
    return (
        HEAD
        + "G0 X25 Y-17 Z20\nG0 Z-3\nG1 X30 F800\nG0 Z20\n"
        + "".join(f"G0 X-20 Y{y} Z20\nG1 Z-11\nG1 X30\nG1 X70\nG0 Z20\n" for y in (-6, 6, 0))
        + "T2 M6\nG43 H2\nS2000 M3\nG0 X-10 Y15 Z20\nG1 Z-1\n"
        + waves
        + "G0 Z30\nG0 A0 C0\n"
        + "T1 M6\nG43 H1\nG0 X-20 Y17 Z20\nM5\nG1 Z-2\nG1 X10\nM3 S500\nG1 Z-14.5\nG1 X20\nG0 Z20\nM5\nM30\n"
    )


def design() -> TriangleMesh:
    """Two blocks with a wall between them that touches neither."""
    boxes = [
        cuboid((0, -20, -10), (50, -11, 0)), cuboid((0, 11, -10), (50, 20, 0)), cuboid((0, -1, -10), (50, 1, 0)),
    ]  # fmt: skip
    vertices = np.concatenate([box.vertices for box in boxes])
    return TriangleMesh(vertices, np.concatenate([box.faces + 8 * k for k, box in enumerate(boxes)]))


def write_divided(folder: Path) -> tuple[Path, dict[str, Any]]:
    """The program and its files; arguments of ``trunnion.simulate``."""
    folder.mkdir(parents=True, exist_ok=True)
    nc = folder / "wall.ngc"
    nc.write_text(program(), encoding="utf-8")
    save_mesh(design(), folder / PART)
    save_mesh(cuboid((55, -20, -10), (60, 20, 5)), folder / CLAMP)
    return nc, {**GIVEN, "part": folder / PART, "fixtures": [folder / CLAMP]}


def shares_of(nc: Path, given: dict[str, Any], count: int) -> list[bytes]:
    """All shares of a simulation."""
    own: Any = {**given, "threads": 1}
    return [simulate_share(nc, Share(k, count), own, SILENT) for k in range(count)]


def joined(nc: Path, given: dict[str, Any], shares: Sequence[bytes]) -> trunnion.SimulationResult:
    """The simulation of its shares."""
    own: Any = {**given, "threads": 1}
    return join_shares(nc, shares, own, SILENT)


def facts(found: trunnion.SimulationResult) -> dict[str, object]:
    """All that is found, to the last bit."""
    cut = found.simulation
    spans = [cut.stock.spans(bundle) for bundle in range(3)]
    return {
        "data": json.dumps(to_data(replace(found, seconds=0.0))),
        "rows": [each.removed.tobytes() for each in cut.operations],
        "operations": [(each.first, each.end, each.gouged, each.findings, each.near) for each in cut.operations],
        "stock": [(each.first.tobytes(), each.ends.tobytes(), each.rows.tobytes()) for each in spans],
        "normals": [each.normals.tobytes() for each in spans],
        "design": (cut.left, cut.gouge, cut.lacking, cut.stock.volume),
    }


def write_jobs(folder: Path, tiles: int, files: Sequence[str] = ("wall.ngc",), more: str = "") -> Path:
    """A file of jobs beside the program, which simulates it, or copies of it, in shares."""
    given = {**GIVEN, "files": list(files), "tools": list(TOOLS), "part": PART, "fixtures": [CLAMP], "report": "json"}
    names = {"cell": "cell_mm", "near": "near_mm"}
    lines = [f"{names.get(key, key)} = {json.dumps(value)}" for key, value in given.items()]
    jobs = folder / f"jobs{tiles}.toml"
    text = f'results = "out{tiles}"\n[[job]]\naction = "simulate"\ntiles = {tiles}\n'
    jobs.write_text(text + "\n".join(lines) + f"\n{more}\n", encoding="utf-8")
    return jobs
