"""The spindle where events need it: it changes among the holes of a cycle, or stands in a dwell of revolutions."""

from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cli import main

LEFT_HAND = """RAPID
GOTO/0,0,30
CYCLE/TAP,RAPTO,3,FEDTO,-8,MMPR,1
GOTO/-35,0,20
SPINDL/RPM,200,{second}
GOTO/-30,0,20
CYCLE/OFF
RAPID
GOTO/-30,0,60
"""
DWELL = """GOTO/-40,0,20
SPINDL/OFF
DELAY/3,REV
SPINDL/RPM,1800,CLW
GOTO/-30,0,20
"""
MACHINES = ["yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt"]


@pytest.mark.parametrize("second", ["CCLW", "CLW"])
def test_each_thread_of_a_cycle_has_its_own_spindle(
    second: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL_HEAD + LEFT_HAND.format(second=second) + CL_FOOT, encoding="utf-8")
    code = main(["post", str(cl), "--machine", "hs664rt", "--output", str(program)])
    said = capsys.readouterr().err
    assert (code == 0) is (second == "CLW"), said
    assert ("left hand" in said) is (second == "CCLW")


@pytest.mark.parametrize("machine", MACHINES)
def test_a_dwell_of_revolutions_needs_a_turning_spindle(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL_HEAD + DWELL + CL_FOOT, encoding="utf-8")
    assert main(["post", str(cl), "--machine", machine, "--output", str(program)]) != 0
    assert "part.cls:13: error: a dwell in spindle revolutions while the spindle stands" in capsys.readouterr().err
    assert not program.exists()
