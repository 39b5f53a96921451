"""A simulation judges the travel of its programs, where zero and tool length are known."""

import json
import re
from pathlib import Path

import pytest

from tests.support.locations import ROOT
from trunnion.cli import main

#: Z of the workpiece zero -> whether the program keeps Z within its travel.
_ZEROS = {"0,0,-100": True, "0,0,-400": False}

_PROGRAM = "G17 G90 G71 G94 G40 G54\nT1\nM6\nG0 X0 Y0 Z50 D1 S900 M3\nZ5\nG1 Z-1 F100\nX10\nG0 Z50\nM30\n"


@pytest.mark.parametrize("zero", [None, *_ZEROS])
def test_travel_is_judged_in_text_and_data(
    zero: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, report = tmp_path / "a.mpf", tmp_path / "a.json"
    program.write_text(_PROGRAM, encoding="utf-8")
    known = [] if zero is None else ["--zero", zero, "--tool-length", "110"]
    stock = ["--stock", "box:40,40,10,-20,-20,-9.5", "--cell", "2", "--tool", "1=flat:10,length=60,flutes=30"]
    code = main(["simulate", str(program), "--machine", "yl569", *stock, *known, "--report", str(report)])
    found = json.loads(report.read_text(encoding="utf-8"))
    (travel,) = found["travel"]
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith(f"{program}: travel")]
    assert [travel["state"] in line and travel["summary"] in line for line in lines] == [True]
    within = zero is None or _ZEROS[zero]
    if not within:  # the table may be in the way elsewhere
        assert (code, found["passed"]) == (1, False)
    assert travel["state"] == ("not checked" if zero is None else "ok" if within else "FAIL")


def test_the_verdict_says_what_it_stands_on_and_what_was_not_checked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tables = re.split(r"(?m)^(?=\[)", (ROOT / "src/trunnion/machines/library/yl569.toml").read_text(encoding="utf-8"))
    bare = "".join(table for table in tables if not table.startswith("[[body]]"))
    machine, program = tmp_path / "bare.toml", tmp_path / "a.mpf"
    page, data = tmp_path / "a.html", tmp_path / "a.json"
    machine.write_text(bare.replace("[-250, 250]\n", "[-250, 250] # measure:\n", 1), encoding="utf-8")
    program.write_text(_PROGRAM, encoding="utf-8")
    stock = ["--stock", "box:40,40,9,200,200,-9.5", "--cell", "2", "--tool", "1=flat:10,length=60,flutes=30"]
    asked = ["simulate", str(program), "--machine", str(machine), *stock]
    known = ["--zero", "0,0,-100", "--tool-length", "110"]
    assert main([*asked, *known, "--report", str(page), "--json", str(data)]) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    grounds = (
        "stands on 2 values nobody measured; assumed: the control starts with TRAFOOF, CYCLE800(); "
        "assumed: B and C at home at line 6"
    )
    why = "collisions with the machine: not checked (the definition of the machine states no bodies)"
    assert last == f"Passed in part: nothing found; {why}; {grounds}"
    assert grounds in page.read_text(encoding="utf-8")
    found = json.loads(data.read_text(encoding="utf-8"))
    assert found["not_checked"] == ["the definition of the machine states no bodies"]
    assert [len(found["not_measured"]), *found["assumed"]] == [2, "TRAFOOF", "CYCLE800()"]
    assert found["axes_from_home"] == "B and C at home at line 6"
    assert main(asked) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert "travel of the axes: not checked (no workpiece zero stated, no tool length stated)" in last
