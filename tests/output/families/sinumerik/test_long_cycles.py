"""Drilling cycles in the long form of an 840D sl: written by a setting, and the same holes as in the classic form."""

import re
from pathlib import Path

import pytest

from tests.support.locations import YL569
from tests.support.proof import unproven
from trunnion import diff
from trunnion.cli import main

CL = YL569.with_name("yl569_cycles") / "long_cycles.cls"
GOLDEN = CL.with_name("long_cycles.expected.mpf")


def test_the_long_form_is_the_one_that_it_was(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    code = main(["post", str(CL), "--machine", "yl569", "--output", "-", "--set", "cycle_form=long"])
    out, err = capfdbinary.readouterr()
    assert (code, unproven(err.decode())) == (0, "")
    assert out == GOLDEN.read_bytes()


def test_the_long_form_is_the_classic_one_by_diff(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    classic = tmp_path / "classic.mpf"
    assert main(["post", str(CL), "--machine", "yl569", "--output", str(classic)]) == 0
    assert diff(classic, GOLDEN, machine="yl569").same


def calls() -> list[tuple[int, str]]:
    lines = GOLDEN.read_text(encoding="utf-8").splitlines()
    return [(k, line) for k, line in enumerate(lines) if re.search(r"CYCLE8\d", line) and "CYCLE832" not in line]


@pytest.mark.parametrize("mode", [0, 1])
def test_a_mode_for_the_shank_or_another_plane_fails(
    mode: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    lines = GOLDEN.read_text(encoding="utf-8").splitlines()
    for at, line in calls():
        head, _, last = line.rpartition(",0,1,")
        wrong = head + (",1,1," if mode == 0 else ",0,2,") + last
        file = tmp_path / "wrong.mpf"
        file.write_text("\n".join([*lines[:at], wrong, *lines[at + 1 :]]) + "\n", encoding="utf-8")
        assert main(["verify", str(file), "--cl", str(CL), "--machine", "yl569"]) != 0, wrong
    capfd.readouterr()


@pytest.mark.parametrize("kind", ["DEEP", "BRKCHP"])
@pytest.mark.parametrize("step", ["10,3,2", "10,4,1", "5,1,0.5", "10,3,3", "10,6,4"])
def test_pecks_that_no_cycle_drills_are_made_as_motion(
    kind: str, step: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl = tmp_path / "pecks.cls"
    cl.write_text(
        "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
        f"RAPID\nGOTO/0,0,60,0,0,1\nCYCLE/DRILL,{kind},STEP,{step},RAPTO,3,FEDTO,-40,RTRCTO,20,MMPM,100\n"
        "GOTO/16,8,0\nCYCLE/OFF\nRAPID\nGOTO/16,8,60\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    program = tmp_path / "pecks.mpf"
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(program)]) == 0
    by_cycle = step in ("10,3,3", "10,6,4")
    assert ("CYCLE83(" in program.read_text(encoding="utf-8")) == by_cycle
    assert ("no peck of CYCLE83 is shorter than its DAM" in capsys.readouterr().err) != by_cycle
