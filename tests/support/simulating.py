"""A slot in a block, for tests of ``trunnion.simulate``."""

from pathlib import Path

import numpy as np

import trunnion
from tests.support.sweeps import CUBE, CUBE_FACES
from trunnion.simulation.meshes import TriangleMesh

HEAD = "G21 G90 G17 G40 G49 G80\nT1 M6\nG43 H1\nS1000 M3\nG0 X-20 Y0 Z20\n"
SLOT = HEAD + "N50 G0 Z-5\nN60 G1 X70 F500\nN70 G0 Z20\nM5\nM30\n"
STOCK = "box:50,40,10,0,-20,-10"
TOOL = "1=flat:10,length=60,flutes=20,holder=40x50"


def simulate(tmp_path: Path, program: str, **arguments: object) -> trunnion.SimulationResult:
    nc = tmp_path / "part.ngc"
    nc.write_text(program)
    given: dict[str, object] = {"machine": "xyzac_trt", "stock": STOCK, "tools": [TOOL], "cell": 0.5} | arguments
    return trunnion.simulate(nc, **given)  # type: ignore[arg-type]


def cuboid(low: tuple[float, float, float], high: tuple[float, float, float]) -> TriangleMesh:
    return TriangleMesh(np.array(low) + CUBE * (np.array(high) - np.array(low)), CUBE_FACES)


def slotted(depth: float) -> TriangleMesh:
    """The stock with a slot of 10 mm along X: three boxes that touch."""
    boxes = [
        cuboid((0, -20, -10), (50, -5, 0)), cuboid((0, 5, -10), (50, 20, 0)), cuboid((0, -5, -10), (50, 5, -depth)),
    ]  # fmt: skip
    vertices = np.concatenate([box.vertices for box in boxes])
    return TriangleMesh(vertices, np.concatenate([box.faces + 8 * k for k, box in enumerate(boxes)]))
