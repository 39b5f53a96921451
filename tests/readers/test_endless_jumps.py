"""Loops without a condition that could end them are found after few blocks, however far they move the tool."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError

FANUC, LINUXCNC, KLARTEXT = "%\nO1\nG21 G54\n#1=0\n", "G21 G54\n#1=0\n", "BEGIN PGM A MM\nTOOL CALL 1 Z S9\nQ1 = 0\n"
ENDLESS = {
    "yl569": [
        "R1=0\nLOOP\nR1=R1+1\nG1 X=R1 F9\nENDLOOP",
        "R1=0\nONE:\nR1=R1+1\nG1 X=R1 F9\nGOTOB ONE",
        "R1=0\nWHILE TRUE\nR1=R1+1\nG1 X=R1 F9\nENDWHILE",
    ],
    "matsuura_mx330": [
        f"{FANUC}N10 #1=#1+1\nG1 X#1 F9.\nGOTO10",
        f"{FANUC}WHILE[1EQ1]DO1\n#1=#1+1\nG1 X#1 F9.\nEND1",
    ],
    "xyzac_trt": [f"{LINUXCNC}o1 while [1]\n#1=[#1+1]\nG1 X#1 F9\no1 endwhile"],
    "dmu65": [f"{KLARTEXT}LBL 1\nQ1 = Q1 + 1\nL X+Q1 F9\nFN 9: IF +1 EQU +1 GOTO LBL 1\nEND PGM A MM"],
}
SOUND = {
    "yl569": [
        "R1=0\nLOOP\nR1=R1+1\nG1 X=R1/9 F9\nIF R1>300 GOTOF DONE\nENDLOOP\nDONE:\nM30",
        "R1=0\nFOR R1=1 TO 300\nG1 X=R1/9 F9\nENDFOR\nM30",
        "R1=0\nWHILE R1<300\nR1=R1+1\nG1 X=R1/9 F9\nENDWHILE\nM30",
    ],
    "matsuura_mx330": [
        f"{FANUC}N10 #1=#1+1\nG1 X[#1/9] F9.\nIF[#1GT300]GOTO20\nGOTO10\nN20 M30\n%",
        f"{FANUC}WHILE[#1LT300]DO1\n#1=#1+1\nG1 X[#1/9] F9.\nEND1\nM30\n%",
    ],
    "xyzac_trt": [
        f"{LINUXCNC}o1 while [#1 LT 300]\n#1=[#1+1]\nG1 X[#1/9] F9\no1 endwhile\nM2",
        f"{LINUXCNC}o1 repeat [300]\n#1=[#1+1]\nG1 X[#1/9] F9\no1 endrepeat\nM2",
    ],
    "dmu65": [
        f"{KLARTEXT}LBL 1\nQ1 = Q1 + 1\nL X+Q1 F9\nCALL LBL 1 REP 300\nEND PGM A MM",
        f"{KLARTEXT}LBL 1\nQ1 = Q1 + 1\nL X+Q1 F9\nFN 12: IF +Q1 LT +300 GOTO LBL 1\nEND PGM A MM",
    ],
}


def cases(programs: dict[str, list[str]]) -> list[tuple[str, str]]:
    return [(machine, text) for machine, texts in programs.items() for text in texts]


@pytest.mark.parametrize(("machine", "text"), cases(ENDLESS), ids=range(len(cases(ENDLESS))))
def test_jumps_that_nothing_ends_are_found(machine: str, text: str, tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text(f"{text}\n")
    with pytest.raises(InputError, match="jumps back again and again"):
        trunnion.read_program(tmp_path / "part.nc", machine=machine)


@pytest.mark.parametrize(("machine", "text"), cases(SOUND), ids=range(len(cases(SOUND))))
def test_loops_that_end_run_to_their_end(machine: str, text: str, tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text(f"{text}\n")
    run = trunnion.read_program(tmp_path / "part.nc", machine=machine)
    assert [error for error in run.errors if "feed" not in error.text] == []
    assert 300 <= len(run) <= 302
