"""Within radius compensation the control must see the next corner: no stop, few blocks without motion."""

from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import CL_FOOT
from trunnion.errors import TrunnionError

POCKET = """UNITS/MM
TOOL PATH/POCKET,TOOL,MILL_D10
TLDATA/MILL,10,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,5,ADJUST,5
SPINDL/RPM,6000,CLW
COOLNT/FLOOD
RAPID
GOTO/30,30,50,0,0,1
RAPID
GOTO/30,30,3
FEDRAT/MMPM,200
GOTO/30,30,-5
CUTCOM/LEFT
GOTO/30,0,-5
GOTO/60,0,-5
{corner}GOTO/60,60,-5
GOTO/0,30,-5
CUTCOM/OFF
GOTO/30,30,-5
RAPID
GOTO/30,30,50
"""
LIFTS = "GOTO/60,0,-4\nGOTO/60,0,-5\n"


def _posted(machine: str, corner: str, folder: Path) -> Path:
    cl, program = folder / "pocket.cls", folder / "pocket.nc"
    cl.write_text(POCKET.format(corner=corner) + CL_FOOT, encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    return program


@pytest.mark.parametrize(
    ("machine", "corner", "what"),
    [
        ("matsuura_mx330", "STOP\n", "pocket.cls:18: error: STOP within CUTCOM"),
        ("haas_umc750", "OPSTOP\n", "pocket.cls:18: error: OPSTOP within CUTCOM"),
        ("xyzac_trt", "STOP\n", "STOP within CUTCOM"),
        ("yl569", "STOP\n", "STOP within CUTCOM"),
        ("matsuura_mx330", "DELAY/1\nCOOLNT/OFF\n", "pocket.cls:19: error: more than 1 block without motion"),
        ("matsuura_mx330", LIFTS, "pocket.cls:19: error: more than 1 block without motion"),
        ("hs664rt", "SPINDL/RPM,7000,CLW\nCOOLNT/OFF\n", "more than 1 block without motion"),
        ("yl569", "DELAY/1\n" * 4, "pocket.cls:21: error: more than 3 blocks without motion"),
    ],
    ids=["m-stop", "haas-opstop", "linuxcnc-stop", "sin-stop", "m-two", "m-lifts", "fidia-two", "sin-four"],
)
def test_what_hides_the_corner_is_refused(machine: str, corner: str, what: str, tmp_path: Path) -> None:
    with pytest.raises(TrunnionError) as refused:
        _posted(machine, corner, tmp_path)
    assert what in str(refused.value)
    assert not (tmp_path / "pocket.nc").exists()


def test_what_the_control_reads_across_is_taken(tmp_path: Path) -> None:
    _posted("dmu65", "STOP\nDELAY/1\nCOOLNT/OFF\n", tmp_path)
    _posted("xyzac_trt", "DELAY/1\nCOOLNT/OFF\n", tmp_path)
    program = _posted("matsuura_mx330", "PPRINT/A\nPPRINT/B\nDELAY/1\n", tmp_path)
    text = program.read_text(encoding="utf-8")
    dwell = next(line for line in text.splitlines() if "G4 P" in line)
    for more, faults in {"": 0, "\nM9": 1, "\nM1": 2, "\n(ONLY A COMMENT)": 0, "\nG90": 1, "\nZ-4.\nZ-5.": 1}.items():
        program.write_text(text.replace(dwell, dwell + more), encoding="utf-8")
        found = trunnion.verify(program, machine="matsuura_mx330")
        modal = next(check for check in found.checks if check.key == "modal")
        assert sum("next corner" in place.text for place in modal.places) == faults, more
