"""Words of the spindle that no program should have, and what a program leaves on."""

from pathlib import Path

import pytest

import trunnion
from trunnion.verification import Verification

MACHINES = ["yl569", "dmu65", "hs664rt", "matsuura_mx330", "haas_umc750", "xyzac_trt"]

HEAD = (
    "%\nO0001\nG21 G17 G40 G80 G90 G94\nG49 G53 G0 Z0.\nT1 M6\nG54\nS1500 M3\nG0 X0. Y0.\nG43 H1 Z50.\nG1 Z-1. F200.\n"
)


def faults(found: Verification) -> dict[str, str]:
    failed = [check for check in found.checks if not check.passed]
    return {check.key: "; ".join((check.summary, *(place.text for place in check.places))) for check in failed}


def verified(folder: Path, text: str, machine: str = "matsuura_mx330") -> Verification:
    program = folder / "p.nc"
    program.write_text(HEAD + text + "M30\n%\n", encoding="utf-8")
    return trunnion.verify(program, machine=machine)


@pytest.mark.parametrize("machine", MACHINES)
def test_both_senses_and_a_start_that_nothing_needs(machine: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "p.cls", tmp_path / "p.nc"
    cl.write_text(
        "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
        "RAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,500\nGOTO/0,0,5\nRAPID\nGOTO/0,0,30\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    trunnion.post(cl, machine=machine, output=program)
    text = program.read_text(encoding="utf-8")
    assert trunnion.verify(program, machine=machine).passed
    program.write_text(text.replace("M5", "M3"), encoding="utf-8")
    assert "starts the spindle behind the last cut" in faults(trunnion.verify(program, machine=machine))["modal"]
    program.write_text(text.replace("M3", "M4 M3"), encoding="utf-8")
    found = faults(trunnion.verify(program, machine=machine))
    # LinuxCNC refuses such a block, which is not executed then.
    key, text = ("words", "M4") if machine == "xyzac_trt" else ("modal", "counter-clockwise and clockwise in one block")
    assert text in found[key]


def test_a_fanuc_takes_no_point_in_the_milliseconds_of_a_dwell(tmp_path: Path) -> None:
    end = "G0 Z50.\nM5\nG49 G53 G0 Z0.\n"
    cycle = "G82 X1. Z-2. R2. P{} F100.\nG80\n"
    for block in ("G4 P500.\n", cycle.format("200.")):
        assert "P of a dwell with a decimal point" in faults(verified(tmp_path, block + end))["words"]
        assert "words" not in faults(verified(tmp_path, block + end, "haas_umc750"))
    for block in ("G4 P500\n", "G4 X.5\n", "#1=500\nG4 P#1\n", "G4 P[0.5*1000.]\n", cycle.format("200")):
        assert faults(verified(tmp_path, block + end)) == {}, block


def test_a_length_and_a_plane_that_are_left_on_are_warned_of(tmp_path: Path) -> None:
    found = verified(tmp_path, "G0 Z50.\nM5\nG91 G28 Z0\n")
    assert found.passed
    said = "\n".join(map(str, found.remarks))
    assert "ends with G43 on, and the next program may begin with it" in said
    assert "[NC351]" in said
    assert "G43" not in "\n".join(map(str, verified(tmp_path, "G0 Z50.\nM5\nG49 G53 G0 Z0.\n").remarks))
    plane = "G0 Z50.\nG49\nG68.2 X0. Y0. Z0. I0. J10. K0.\nG53.1\nM5\nG53 G0 Z0.\n"
    assert "ends with G68.2 on" in "\n".join(map(str, verified(tmp_path, plane).remarks))
