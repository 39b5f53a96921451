"""Texts of stops: as messages, without what breaks lines, and in as many lines as the control needs."""

from pathlib import Path

import pytest

import trunnion

_CL = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,5.0
RAPID
GOTO/0.0,0.0,50.0
{word}/{text}
RAPID
GOTO/0.0,0.0,60.0
SPINDL/OFF
END-OF-PATH
"""

_MACHINES = ("yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt")


@pytest.mark.parametrize("machine", _MACHINES)
@pytest.mark.parametrize("word", ["STOP", "OPSTOP", "DISPLY"])
def test_no_text_breaks_a_line_or_fills_one(machine: str, word: str, tmp_path: Path) -> None:
    source = tmp_path / "part.cls"
    source.write_text(_CL.format(word=word, text="LOOK\u2028HERE\u2029AND\x85THERE" + "X" * 5000), encoding="utf-8")
    result = trunnion.post(source, machine=machine)
    assert result.passed
    assert result.text is not None
    lines = result.text.split("\n")
    assert max(map(len, lines)) <= 512
    assert len(result.text.splitlines()) == len(lines) - result.text.endswith("\n")
    assert any("LOOK HERE AND THERE" in line for line in lines)
