"""Programs with capitals in their comments, in other encodings and with other line ends, back to CL files."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD

CL = (
    HEAD.replace("RAPID\n", "PAINT/COLOR,186\nRAPID\n").replace("FEDRAT", "PAINT/COLOR,42\nFEDRAT")
    + "PAINT/COLOR,31\nGOTO/20.0,0.0,5.0\nPAINT/COLOR,37\nGOTO/20.0,0.0,20.0\n" + FOOT
)  # fmt: skip


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "xyzac_trt", "hs664rt"])
def test_a_program_is_understood_whatever_its_text_is(machine: str, tmp_path: Path) -> None:
    source = tmp_path / "part.cls"
    source.write_text(CL.replace("OP1", "GRÖSSE"), encoding="utf-8")
    found = []
    for settings in ({}, {"comments": "capitals", "line_ends": "crlf", "encoding": "latin-1"}):
        program = tmp_path / "part.nc"
        assert trunnion.post(source, machine=machine, output=program, settings=settings).passed
        found.append(trunnion.convert(program, machine=machine, to_cl=True, zero=(0, 0, 0)).text)
    assert found[0] == found[1]
