"""A first approach without TCP in two halves that state their height: above all points it passes, below it fails."""

from pathlib import Path

import pytest

import trunnion

CL = """UNITS/MM
TOOL PATH/SLOT,TOOL,D10
TLDATA/MILL,10,0,60,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/-20,7,20,0,0,1
FEDRAT/MMPM,500
GOTO/-20,7,-5
GOTO/70,7,-5
RAPID
GOTO/70,7,20
END-OF-PATH
"""

POSTED = {
    "haas_umc750": "N80 G0 X-20. Y7.\nN90 G43 H1 Z20.\n",
    "mikron_600u": "20 L X-20 Y+7 Z+20 FMAX\n",
}

#: Machine, the first approach in halves, and whether it is sound.
HALVES = [
    ("haas_umc750", "G0 G43 H1 X-20. Z20.\nG0 Y7.\n", True),
    ("haas_umc750", "G0 G43 H1 X-20. Z-3.\nG0 Y7.\nZ20.\n", False),
    ("haas_umc750", "G0 G43 H1 X-20. Z-3.\nG0 Y7. Z20.\n", False),
    ("mikron_600u", "20 L X-20 Z+20 FMAX\n20 L Y+7 FMAX\n", True),
    ("mikron_600u", "20 L X-20 Z+30 FMAX\n20 L Y+7 Z+30 FMAX\n20 L Z+20 FMAX\n", True),
    ("mikron_600u", "20 L X-20 Z-3 FMAX\n20 L Y+7 FMAX\n20 L Z+20 FMAX\n", False),
]


@pytest.mark.parametrize(("machine", "halves", "is_sound"), HALVES)
def test_halves_with_a_height_are_judged_without_tcp(machine: str, halves: str, is_sound: bool, tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL, encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    text = program.read_text(encoding="utf-8")
    assert POSTED[machine] in text
    program.write_text(text.replace(POSTED[machine], halves), encoding="utf-8")
    found = trunnion.verify(program, machine=machine, cl=cl)
    assert [check.key for check in found.checks if not check.passed] == ([] if is_sound else ["order"])
