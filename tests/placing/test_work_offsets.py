"""What a control's work offset is, by its reader: the machine position of the gauge point on the workpiece zero.

docs/placing.md has it as an example for each family.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.model.run import Run

CL = (
    "TOOL PATH/FACE,TOOL,D10\nTLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000\n"
    "MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000\n"
    "PAINT/PATH\nLOAD/TOOL,1,ADJUST,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\n"
    "FEDRAT/MMPM,500.0\nGOTO/0.0,0.0,0.0\nGOTO/10.0,0.0,0.0\nRAPID\nGOTO/10.0,0.0,50.0\nEND-OF-PATH\n"
)
ZERO = (10.0, -20.0, 30.0)
LENGTH = 120.0


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"])
def test_with_the_tip_on_the_zero_the_slides_stand_a_tool_length_above_the_offset(tmp_path: Path, machine: str) -> None:
    """Rotary axes at zero: the offset is the zero less the gauge point, and holds for every tool."""
    cl, program = tmp_path / "face.cls", tmp_path / "face.nc"
    cl.write_text(CL, "utf-8")
    trunnion.post(cl, machine=machine, output=program, settings={"zero": ZERO, "tool_length": LENGTH}, force=True)
    loaded = trunnion.load_machine(machine)
    offset = np.array(ZERO) - np.array(loaded.spindle_point)
    for length in (LENGTH, 75.5):
        run = trunnion.read_program(program, machine=set_up_machine(loaded, ZERO, length))
        (row,) = np.flatnonzero((np.abs(run.tip).max(axis=1) < 1e-6) & ~run.machine_frame)[:1]
        assert np.abs(run.rotary[row]).max() == 0.0
        assert np.array(loaded.spindle_direction).tolist() == [0.0, 0.0, 1.0]
        slides = [float(run.joints[row, run.machine.column(name)]) for name in "XYZ"]
        assert slides == pytest.approx([*offset[:2], offset[2] + length], abs=1e-6)


def _last_slides(path: Path, text: str, machine: str, zero: tuple[float, float, float] | None) -> list[float]:
    path.write_text(text)
    loaded = replace(trunnion.load_machine(machine), workpiece_zero=zero, tool_length=LENGTH)
    run: Run = trunnion.read_program(path, machine=loaded)
    assert not run.errors
    return [float(run.joints[-1, run.machine.column(name)]) for name in "XYZ"]


@pytest.mark.parametrize(
    ("machine", "head"),
    [
        ("xyzac_trt", "G21 G90 G17 G40 G49\nT1 M6\n{offset}G54 G43 H1\n"),
        ("matsuura_mx330", "%\nO0001\nG21 G90 G17 G40 G49\nT1 M6\n{offset}G54 G43 H1\n"),
        ("haas_umc750", "%\nO00001\nG21 G90 G17 G40 G49\nT1 M6\n{offset}G54 G43 H1\n"),
    ],
)
def test_an_offset_that_a_program_writes_is_the_zero_less_the_gauge_point(
    tmp_path: Path, machine: str, head: str
) -> None:
    x, y, z = np.array(ZERO) - np.array(trunnion.load_machine(machine).spindle_point)
    path = "G0 X5. Y6. Z70.\nM30\n"
    known = _last_slides(tmp_path / "a.nc", head.format(offset="") + path, machine, ZERO)
    written = f"G10 L2 P1 X{x} Y{y} Z{z}\n"
    said = _last_slides(tmp_path / "a.nc", head.format(offset=written) + path, machine, (1.0, 1.0, 1.0))
    assert said == pytest.approx(known, abs=1e-9)
    assert known == pytest.approx([x + 5.0, y + 6.0, z + 70.0 + LENGTH])
