"""Feeds with more digits than a control prints: they pass as printed, and no further from what is asked."""

import re
from pathlib import Path

import pytest

from tests.support.verifying import check
from trunnion import post, verify

#: A feed between two printed ones on every control, in mm/min and in inch/min, and a hole with it.
_PATH = """UNITS/MM
MULTAX/ON
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,371.18137
GOTO/0,0,0,0,0,1
GOTO/30,0,0,0,0,1
RAPID
GOTO/30,0,50,0,0,1
CYCLE/DRILL,RAPTO,3.0,FEDTO,-5.0,RTRCTO,20.0,MMPM,670.56137
GOTO/10,10,0,0,0,1
CYCLE/OFF
RAPID
GOTO/10,10,50,0,0,1
FINI
"""

MACHINES = ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"]

#: Those with a control that counts in inches as well.
_INCHES = ["yl569", "matsuura_mx330", "haas_umc750", "xyzac_trt"]


@pytest.mark.parametrize(
    ("machine", "units"), [*((each, "mm") for each in MACHINES), *((each, "inch") for each in _INCHES)]
)
def test_what_is_posted_is_verified(machine: str, units: str, tmp_path: Path) -> None:
    path, program = tmp_path / "part.cls", tmp_path / "part.nc"
    path.write_text(_PATH, encoding="utf-8")
    post(path, machine=machine, output=program, settings={"units": units} if units == "inch" else {})
    proven = verify(program, machine=machine, cl=[path])
    assert proven.passed, [each.summary for each in proven.checks if not each.passed]


@pytest.mark.parametrize("machine", MACHINES)
def test_the_next_feed_but_one_is_a_fault(machine: str, tmp_path: Path) -> None:
    path, program = tmp_path / "part.cls", tmp_path / "part.nc"
    path.write_text(_PATH, encoding="utf-8")
    post(path, machine=machine, output=program)
    text = program.read_text(encoding="utf-8")
    changed, count = re.subn(r"F371(?:\.\d+)?", "F373", text)
    assert count
    program.write_text(changed, encoding="utf-8")
    assert not check(verify(program, machine=machine, cl=[path]), "feed").passed
