"""A slot in two depths, which a rapid enters, and a part whose slot is as deep as neither; for the viewer."""

from pathlib import Path
from typing import Any

import numpy as np

from tests.support.simulating import HEAD, STOCK, TOOL
from trunnion.simulation.meshes import TriangleMesh, save_mesh

#: The tool enters at rapid to X 9; the slot is 5 mm deep to X 30, then 3 mm. Rows count from that of G0 X-20.
PROGRAM = HEAD + "N50 G0 Z-5\nN55 G0 X4\nN60 G1 X25 F500\nN70 G1 Z-3\nN80 G1 X70\nN90 G0 Z20\nN95 G0 X80\nM5\nM30\n"

CELL = 0.5

#: The part across X: a block with a slot that is 4 mm deep.
_PROFILE = ((-20, -10), (20, -10), (20, 0), (5, 0), (5, -4), (-5, -4), (-5, 0), (-20, 0))
_CAP = np.array([[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [0, 5, 6], [0, 6, 7]])


def write_slot(folder: Path) -> tuple[Path, dict[str, Any]]:
    """The program, and what ``simulate`` and ``write_view`` are given with it."""
    program, part = folder / "slot.ngc", folder / "part.stl"
    program.write_text(PROGRAM, encoding="utf-8")
    save_mesh(_part(), part)
    return program, {"machine": "xyzac_trt", "stock": STOCK, "part": part, "tools": [TOOL], "cell": CELL}


def _part() -> TriangleMesh:
    corners = len(_PROFILE)
    vertices = np.array([(x, *point) for x in (0, 50) for point in _PROFILE], np.float64)
    here = np.arange(corners)
    after = (here + 1) % corners
    sides = [np.column_stack((here, after, after + corners)), np.column_stack((here, after + corners, here + corners))]
    mesh = TriangleMesh(vertices, np.concatenate((_CAP[:, ::-1], _CAP + corners, *sides)))
    assert mesh.volume > 0.0
    return mesh
