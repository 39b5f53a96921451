"""Blocks of a way that repeat their position: reported, and lawful wherever the way is."""

import re
from pathlib import Path

import pytest

import trunnion

_CL = """\
TOOL PATH/{name},TOOL,D8
TLDATA/MILL,8,0,60,0,0
LOADTL/1
SPINDL/RPM,2000,CLW
RAPID
GOTO/{x},0,50,0,0,1
RAPID
GOTO/{x},0,5
FEDRAT/MMPM,200
GOTO/{x},0,-1
GOTO/20,0,-1
RAPID
GOTO/20,0,50
END-OF-PATH
"""


def _twice(block: str, number: str) -> str:
    """The block and its repetition, if it goes to a position."""
    goes = re.search(r"(?<![A-Z])[XYZ]\s?[-+=]?\.?\d", block) and not block.startswith((";", "("))
    return f"{block}\n{re.sub(number, '', block)}" if goes else block


@pytest.mark.parametrize("setting", ["same_tool=home", "same_tool=clearance", "first_approach=in_turn"])
@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"])
def test_repeated_blocks_of_ways_are_reported_and_pass(machine: str, setting: str, tmp_path: Path) -> None:
    settings = dict([setting.split("=")])
    cl, program = tmp_path / "two.cls", tmp_path / "two.nc"
    cl.write_text(_CL.format(name="ONE", x=0) + _CL.format(name="TWO", x=40), encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program, settings=settings)
    number = "^[0-9]+ " if machine == "dmu65" else "^N[0-9]+ "
    blocks = program.read_text(encoding="utf-8").splitlines()
    program.write_text("\n".join(_twice(block, number) for block in blocks) + "\n", encoding="utf-8")
    proof = trunnion.verify(program, machine=machine, cl=[cl], settings=settings)
    assert {check.key for check in proof.checks if not check.passed} == set()
    assert "blocks without motion" in next(check for check in proof.checks if check.key == "order").summary


def test_a_way_that_goes_on_below_the_clearance_fails_with_repeated_blocks_too(tmp_path: Path) -> None:
    cl, program = tmp_path / "two.cls", tmp_path / "two.nc"
    cl.write_text(_CL.format(name="ONE", x=0) + _CL.format(name="TWO", x=40), encoding="utf-8")
    settings = {"same_tool": "clearance"}
    trunnion.post(cl, machine="yl569", output=program, settings=settings)
    text = program.read_text(encoding="utf-8")
    assert text.count("Z60.") == 1
    program.write_text(text.replace("Z60.", "Z40.\nZ40."), encoding="utf-8")
    assert not trunnion.verify(program, machine="yl569", cl=[cl], settings=settings).passed
