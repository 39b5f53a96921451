"""Four-axis jobs, posted for three controls and simulated to the form of the part."""

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import GOLDEN
from trunnion.simulation.meshes import box_mesh

ON_AXIS = "zero=-450,-203,-400"
MACHINES = (("desk_mill_a", "zero=-200,-90,-120"), ("haas_vf2_a", ON_AXIS), ("four_axis/klartext.toml", ON_AXIS))
#: Those whose controls have plane words besides.
WITH_PLANES = (*MACHINES, ("four_axis/fanuc.toml", ON_AXIS), ("four_axis/sinumerik.toml", ON_AXIS))

HEAD = (
    "$$-> TRUNNION / 1\nUNITS/MM\n$$-> STOCK / BOX,40,44,44,0,-22,-22\n{begin}"
    "$$-> TOOL / MILL,DIAMETER,10,LENGTH,50,FLUTE,30\n"
    "MSYS/0,0,0,1,0,0,0,1,0\nINTOL/0.005\nOUTTOL/0.005\nLOADTL/1\nSPINDL/RPM,3000,CLW\n"
)
END = "SPINDL/OFF\nEND-OF-PATH\nFINI\n"
#: Half of the width across two flats, mm.
HALF = 18.0


def goto(x: float, y: float, z: float, degrees: float) -> str:
    """A point beside the part as it is turned about X, and the tool axis there."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return f"GOTO/{x:.4f},{c * y - s * z:.6f},{s * y + c * z:.6f},0,{-s:.9f},{c:.9f}"


def flats() -> str:
    """Four flats, each milled with the tool across it: 3+1."""
    lines = [HEAD.format(begin="TOOL PATH/FLATS,TOOL,FLAT 10\n").rstrip()]
    for degrees in (0.0, 90.0, 180.0, 270.0):
        lines += [
            "RAPID",
            goto(-8.0, -18.0, 60.0, degrees),
            "RAPID",
            goto(-8.0, -18.0, HALF, degrees),
            "FEDRAT/MMPM,400",
        ]
        for k, y in enumerate((-18.0, -9.0, 0.0, 9.0, 18.0)):
            ends = (-8.0, 48.0) if k % 2 == 0 else (48.0, -8.0)
            lines += [goto(x, y, HALF, degrees) for x in ends]
        lines += ["RAPID", goto(48.0, 18.0, 60.0, degrees)]
    return "\n".join(lines) + "\n" + END


def planes() -> str:
    """The same four flats, each an operation in a plane of its own."""
    lines = [HEAD.partition("{begin}")[0].rstrip()]
    for degrees in (0, 90, 180, 270):
        c, s = round(math.cos(math.radians(degrees))), round(math.sin(math.radians(degrees)))
        head = HEAD.partition("{begin}")[2].replace(
            "MSYS/0,0,0,1,0,0,0,1,0", f"MSYS/0,{-s * HALF},{c * HALF},1,0,0,0,{c},{s}"
        )
        lines += [f"TOOL PATH/FLAT {degrees},TOOL,FLAT 10", head.rstrip()]
        lines += ["RAPID", "GOTO/-8,-18,42", "RAPID", "GOTO/-8,-18,0", "FEDRAT/MMPM,400"]
        for k, y in enumerate((-18.0, -9.0, 0.0, 9.0, 18.0)):
            lines += [f"GOTO/{x},{y},0" for x in ((-8.0, 48.0) if k % 2 == 0 else (48.0, -8.0))]
        lines += ["RAPID", "GOTO/48,18,42", "SPINDL/OFF", "END-OF-PATH"]
    return "\n".join(lines) + "\nFINI\n"


def rounds(radius: float) -> Sequence[str]:
    """A round bar, turned under the tool while it goes along: continuous motion of four axes."""
    lines = [HEAD.format(begin="TOOL PATH/ROUND,TOOL,FLAT 10\n").rstrip()]
    lines += ["RAPID", goto(-8.0, 0.0, 60.0, 0.0), "RAPID", goto(-8.0, 0.0, radius, 0.0), "FEDRAT/MMPM,400"]
    turns, steps = 19, 72
    for k in range(1, turns * steps + 1):
        lines.append(goto(-8.0 + 56.0 * k / (turns * steps), 0.0, radius, 360.0 * k / steps))
    return [*lines, "RAPID", goto(48.0, 0.0, 60.0, 360.0 * turns)]


@pytest.mark.parametrize("path", [flats, planes])
@pytest.mark.parametrize(("machine", "zero"), WITH_PLANES, ids=[name for name, _ in WITH_PLANES])
def test_flats_by_indexing_come_out_as_the_part(
    machine: str, zero: str, path: Callable[[], str], tmp_path: Path
) -> None:
    file = tmp_path / "flats.apt"
    file.write_text(path(), encoding="utf-8")
    key, value = zero.split("=")
    settings = {key: value, "tool_length": "60", "frame": "absolute"}
    named = GOLDEN / machine if "/" in machine else machine
    part = box_mesh(np.array((0.0, -HALF, -HALF)), np.array((40.0, HALF, HALF)), "part")
    result = trunnion.post(file, machine=named, settings=settings, simulation={"part": part, "cell": 0.8})
    assert result.passed
    assert result.run is not None
    found = result.simulation
    assert found is not None
    assert found.left is not None
    assert found.gouge is not None
    assert (found.left.largest, found.gouge.largest) == pytest.approx((0.0, 0.0), abs=0.1)
    assert found.removed == pytest.approx(40.0 * (44.0**2 - 36.0**2), rel=2e-3)


@pytest.mark.parametrize(("machine", "zero"), MACHINES, ids=[name for name, _ in MACHINES])
def test_a_bar_is_milled_round_by_four_axes_at_once(machine: str, zero: str, tmp_path: Path) -> None:
    file = tmp_path / "round.apt"
    file.write_text("\n".join(rounds(HALF)) + "\n" + END, encoding="utf-8")
    key, value = zero.split("=")
    named = GOLDEN / machine if "/" in machine else machine
    result = trunnion.post(file, machine=named, settings={key: value, "tool_length": "60"}, simulation={"cell": 0.8})
    assert result.passed
    assert result.simulation is not None
    # a flat bottom that touches the bar along a line leaves the bar alone between two points of the path
    assert result.simulation.removed == pytest.approx(40.0 * (44.0**2 - math.pi * HALF**2), rel=5e-3)
