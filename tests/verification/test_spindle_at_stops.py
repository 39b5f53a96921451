"""At a STOP of the CL file the spindle stands: a program that has lost its M5 there is found, on every control."""

import re
from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD, check
from trunnion import verify
from trunnion.cli import main

CL = CL_HEAD + "GOTO/0.0,0.0,5.0\nGOTO/10.0,0.0,5.0\nSTOP\nGOTO/20.0,0.0,5.0\nGOTO/20.0,0.0,50.0\n" + CL_FOOT
_M5, _STOP = re.compile(r"\bM0?5\b"), re.compile(r"\bM00?\b|\bSTOP\b")


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt"])
def test_a_stop_whose_m5_is_missing_is_found(machine: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL, encoding="utf-8")
    assert main(["post", str(cl), "--machine", machine, "--output", str(program)]) == 0
    lines = program.read_text(encoding="utf-8").splitlines()
    stop = next(k for k, line in enumerate(lines) if _STOP.search(line.split(";")[0]))
    m5 = next(k for k in range(stop, -1, -1) if _M5.search(lines[k]))
    assert stop - m5 <= 1
    lines[m5] = _M5.sub("", lines[m5])
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    found = check(verify(program, machine=machine, cl=cl), "stops")
    assert not found.passed
    assert "while the spindle turns" in found.summary
    assert found.places[0].nc_line == stop + 1
