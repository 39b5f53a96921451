"""The registers of tool length and radius: those of LOAD/TOOL and CUTCOM, or of the tool, and no others."""

from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cli import main

CUT = """GOTO/10,0,5
CUTCOM/LEFT{register}
GOTO/30,10,5
GOTO/30,20,5
CUTCOM/OFF
GOTO/40,40,5
RAPID
GOTO/40,40,30
"""
HEAD = CL_HEAD.replace("LOAD/TOOL,1,ADJUST,1", "LOAD/TOOL,1,ADJUST,17")
SECOND = """TOOL PATH/OP2,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
INTOL/0.01
OUTTOL/0.01
SPINDL/RPM,1000.0000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """Where a program goes, beside its CL file."""
    return tmp_path / "part.nc"


def post(machine: str, program: Path, text: str) -> str:
    """Post a CL file; returns the program."""
    program.with_suffix(".cls").write_text(text, encoding="utf-8")
    cl = str(program.with_suffix(".cls"))
    assert main(["post", cl, "--machine", machine, "--output", str(program)]) == 0
    return program.read_text(encoding="utf-8")


def failed(machine: str, program: Path, text: str, capsys: pytest.CaptureFixture[str]) -> set[str]:
    """The checks that fail for a changed program."""
    program.write_text(text, encoding="utf-8")
    capsys.readouterr()
    main(["verify", str(program), "--machine", machine, "--cl", str(program.with_suffix(".cls"))])
    lines = capsys.readouterr().out.splitlines()
    return {line.split()[0] for line in lines if line.split()[1:2] == ["FAIL"]}


@pytest.mark.parametrize("machine", ["matsuura_mx330", "xyzac_trt"])
def test_the_register_of_load_tool_is_the_length_that_is_called(
    machine: str, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = post(machine, program, HEAD + CUT.format(register="") + CL_FOOT + SECOND + CUT.format(register="") + CL_FOOT)
    assert text.count(" H17") == 2
    assert " H1 " not in text
    assert failed(machine, program, text, capsys) == set()
    for other in ("H7", "H1"):
        assert failed(machine, program, text.replace("H17", other), capsys) == {"tool"}


@pytest.mark.parametrize(
    ("machine", "register", "written", "becomes"),
    [
        ("matsuura_mx330", "", "G41 D1", "G41 D2"),
        ("matsuura_mx330", "", "G41 D1", "G41"),
        ("matsuura_mx330", ",5", "G41 D5", "G41 D1"),
        ("xyzac_trt", "", "G41", "G41 D2"),
        ("hs664rt", "", "G41", "G41 D2"),
    ],
)
def test_the_radius_of_another_register_is_a_fault(
    machine: str, register: str, written: str, becomes: str, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = post(machine, program, CL_HEAD + CUT.format(register=register) + CL_FOOT)
    assert text.count(written) == 1
    assert failed(machine, program, text, capsys) == set()
    assert failed(machine, program, text.replace(written, becomes), capsys) == {"compensation"}


def test_the_radius_of_the_tool_may_be_named_on_linuxcnc(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = post("xyzac_trt", program, CL_HEAD + CUT.format(register="") + CL_FOOT)
    assert failed("xyzac_trt", program, text.replace("G41", "G41 D1"), capsys) == set()
