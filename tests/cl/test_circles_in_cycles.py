"""CIRCLE and CYCLE at the same point: each point of a cycle is a hole, so that the circle would be lost."""

from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cli import main

CYCLE = "CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100"
CIRCLE = "CIRCLE/-35,0,20,0,0,1,5"


@pytest.mark.parametrize(
    ("lines", "line"),
    [
        ([CYCLE, CIRCLE, "GOTO/-30,0,20", "CYCLE/OFF"], 13),
        ([CYCLE, "GOTO/-40,0,20", CIRCLE, "GOTO/-30,0,20", "CYCLE/OFF"], 14),
        ([CIRCLE, CYCLE, "GOTO/-30,0,20", "CYCLE/OFF"], 13),
    ],
)
def test_a_circle_in_a_cycle_is_refused(
    lines: list[str], line: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl = tmp_path / "part.cls"
    text = "\n".join(["GOTO/-40,0,50", *lines]) + "\n"
    cl.write_text(CL_HEAD + text + CL_FOOT, encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(tmp_path / "part.mpf")]) != 0
    said = capsys.readouterr().err
    assert f"part.cls:{line}: error: C" in said, said
