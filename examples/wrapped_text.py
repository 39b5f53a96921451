"""Engrave a word around a bar on a four-axis mill: CL text in Trunnion's profile, the proven program, the cut stock.

python examples/wrapped_text.py [folder]
"""

import math
import sys
from pathlib import Path

import trunnion
from trunnion.simulation.meshes import TriangleMesh, cylinder_mesh

RADIUS, DEPTH, HEIGHT = 20.0, 0.6, 8.0  # of the bar along X, of the cut, of the letters, mm

#: The workpiece zero lies on the axis of the table, and the length of the tool.
ON_AXIS = {"zero": "-450,-203,-400", "tool_length": "60"}

#: Letters as strokes in a square: along the bar, and around it.
LETTERS = {
    "T": (((0.0, 1.0), (1.0, 1.0)), ((0.5, 1.0), (0.5, 0.0))),
    "R": (((0.0, 0.0), (0.0, 1.0), (0.8, 1.0), (1.0, 0.75), (0.8, 0.5), (0.0, 0.5)), ((0.5, 0.5), (1.0, 0.0))),
    "U": (((0.0, 1.0), (0.0, 0.3), (0.3, 0.0), (0.7, 0.0), (1.0, 0.3), (1.0, 1.0)),),
    "N": (((0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)),),
    "I": (((0.5, 0.0), (0.5, 1.0)),),
    "O": (
        ((0.3, 0.0), (0.0, 0.3), (0.0, 0.7), (0.3, 1.0), (0.7, 1.0), (1.0, 0.7), (1.0, 0.3), (0.7, 0.0), (0.3, 0.0)),
    ),
}


def goto(along: float, around: float, radius: float) -> str:
    """Return a point at a radius, with the tool axis through the axis of the bar."""
    angle = around / RADIUS
    j, k = math.sin(angle), math.cos(angle)
    return f"GOTO/{along:.5f},{radius * j:.5f},{radius * k:.5f},0,{j:.8f},{k:.8f}"


def engraved(word: str) -> str:
    """Return CL text that engraves a word: it reads around the bar."""
    lines = [
        "$$-> TRUNNION / 1", "PARTNO/BAR", "UNITS/MM",
        f"TOOL PATH/{word},TOOL,BALL 2", "$$-> TOOL / MILL,DIAMETER,2,CORNER,1,LENGTH,40,FLUTE,6",
        "MSYS/0,0,0,1,0,0,0,1,0", "INTOL/0.005", "OUTTOL/0.005", "LOADTL/1", "SPINDL/RPM,6000,CLW",
    ]  # fmt: skip
    clear, bottom = 1.6 * RADIUS, RADIUS - DEPTH
    for place, letter in enumerate(word):
        first = 1.4 * HEIGHT * place
        for stroke in LETTERS[letter]:
            (u, v), *others = [(10.0 + HEIGHT * (1.0 - v), first + HEIGHT * u) for u, v in stroke]
            lines += ["RAPID", goto(u, v, clear), "FEDRAT/MMPM,300", goto(u, v, bottom)]
            lines += [goto(u, v, bottom) for u, v in others]
            lines += ["RAPID", goto(*(others[-1]), clear)]
    return "\n".join([*lines, "SPINDL/OFF", "END-OF-PATH", "FINI"]) + "\n"


def main(folder: Path) -> None:
    """Write the CL file, post it for a Haas with a rotary table, prove it, and cut the stock."""
    file = folder / "wrapped_text.apt"
    file.write_text(engraved("TRUNNION"), encoding="utf-8")
    upright = cylinder_mesh(2.0 * RADIUS, 0.0, 30.0)
    bar = TriangleMesh(upright.vertices[:, (2, 0, 1)], upright.faces)  # along X
    result = trunnion.post(
        file,
        machine="haas_vf2_a",
        output=folder / "wrapped_text.nc",
        settings=ON_AXIS,
        simulation={"stock": bar, "cell": 0.5},
    )
    assert result.simulation is not None
    print(result, f"{result.simulation.removed:.0f} mm³ removed, findings: {len(result.simulation.findings)}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
