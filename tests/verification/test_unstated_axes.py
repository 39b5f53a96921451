"""Rapids of the CL file behind a way home: none is lost, or changed in its order, where home is not known."""

import re
from itertools import pairwise
from pathlib import Path

import pytest

import trunnion

CL = """TOOL PATH/HOLES,TOOL,D10
TLDATA/MILL,10.0,0,75,0,0
MSYS/0,0,0,1,0,0,0,1,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100
GOTO/0,0,0
GOTO/10,20,0
CYCLE/OFF
RAPID
GOTO/10,20,60
RAPID
GOTO/10,80,80,0,0.5,0.8660254
RAPID
GOTO/40,80,80,0,0.5,0.8660254
RAPID
GOTO/40,60,50,0,0.5,0.8660254
CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100
GOTO/10,40,0
GOTO/30,40,0
CYCLE/OFF
END-OF-PATH
"""

#: Motions in the workpiece, in the words of all controls.
_MOVE = re.compile(r"(^|[ ])[XYZ][-+.\d]")
_OTHERS = ("SUPA", "G53", "M91", "CYCL", "(", ";", "G68")


def changed(lines: list[str]) -> list[tuple[str, list[str]]]:
    """The program without one motion, and with two in the other order."""
    moves = [k for k, line in enumerate(lines) if _MOVE.search(line) and not any(each in line for each in _OTHERS)]
    found = [(f"without {lines[k]}", [*lines[:k], *lines[k + 1 :]]) for k in moves]
    for one, other in pairwise(moves):
        swapped = list(lines)
        swapped[one], swapped[other] = lines[other], lines[one]
        found.append((f"{lines[one]} behind {lines[other]}", swapped))
    return found


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "hs664rt", "xyzac_trt"])
def test_no_rapid_behind_a_way_home_is_lost_where_its_numbers_are_those_of_home(machine: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL, encoding="utf-8")
    lines = (trunnion.post(cl, machine=machine).text or "").splitlines()
    passed = []
    for what, text in changed(lines):
        program.write_text("\n".join(text) + "\n", encoding="utf-8")
        if trunnion.verify(program, machine=machine, cl=cl).passed:
            passed.append(what)
    assert not passed


def test_the_fault_names_the_axes(tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.mpf"
    cl.write_text(CL, encoding="utf-8")
    text = trunnion.post(cl, machine="yl569").text or ""
    lost = re.sub(r"N\d+ G0 X0\.0 Y0\.0\n", "", text, count=1).replace("Z50. ", "G0 Z50. ")
    assert lost.count("\n") == text.count("\n") - 1
    program.write_text(lost, encoding="utf-8")
    order = next(c for c in trunnion.verify(program, machine="yl569", cl=cl).checks if c.key == "order")
    assert "goes to a CL point without X and Y, which the program does not state behind its way home" in order.summary
    placed = trunnion.verify(program, machine="yl569", cl=cl, zero=(0, 0, -150), tool_length=100.0)
    order = next(c for c in placed.checks if c.key == "order")
    assert "without X and Y" not in order.summary, "where home is known, so is the way"
