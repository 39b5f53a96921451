"""Holes that a cycle of another kind makes: drilled, reamed, bored, stopped, lifted off, by hand."""

from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cli import main
from trunnion.model.run import Run
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.matching import hole_matching
from trunnion.verification.matching.hole_matching import MatchedHole

HOLES = """RAPID
GOTO/0,0,30
CYCLE/{cycle}
GOTO/50,0,0
GOTO/60,0,0
CYCLE/OFF
RAPID
GOTO/0,0,30
"""
DRILL = "DRILL,RAPTO,3,FEDTO,-10,MMPM,100"
REAM = "REAM,RAPTO,3,FEDTO,-10,MMPM,100"
DRAG = "BORE,DRAG,RAPTO,3,FEDTO,-10,MMPM,100"
TAP = "TAP,RAPTO,3,FEDTO,-10,MMPR,1"
DEEP = "DRILL,DEEP,RAPTO,3,FEDTO,-10,STEP,4,MMPM,100"

#: Machine, cycle of the CL file, what is written, what it becomes.
CHANGED = [
    ("matsuura_mx330", DRILL, "G81", "G86"),
    ("matsuura_mx330", DRILL, "G81", "G88"),
    ("matsuura_mx330", DRAG, "G86", "G81"),
    ("matsuura_mx330", REAM, "G85", "G84"),
    ("xyzac_trt", DRILL, "G81", "G86 P0"),
    ("xyzac_trt", DRAG, "G86", "G82"),
    ("xyzac_trt", REAM, "G85", "G84"),
    ("hs664rt", DRILL, "G81", "G86"),
    ("hs664rt", REAM, "G85", "G84"),
    ("yl569", DRILL, "CYCLE81(", "CYCLE87("),
    ("yl569", DRAG, ",3,0.0,0,0,0.0)", ",4,0.0,0,0,0.0)"),
    ("yl569", DEEP, ",0.0,0,0,1,1,3,", ",0.0,9,0,1,1,3,"),
    ("yl569", DEEP, ",0.0,0,0,1,1,3,", ",0.0,0,9,1,1,3,"),
    ("dmu65", DRILL, "M99", "M99\nCYCL CALL"),
    ("dmu65", DEEP, "M99", "M99\nL M99"),
    ("dmu65", TAP, "M99", "M99\nCALL LBL 1\nLBL 1\nCYCL CALL\nLBL 0"),
]


@pytest.mark.parametrize(("machine", "cycle", "written", "becomes"), CHANGED)
def test_a_cycle_of_another_kind_is_a_fault(
    machine: str, cycle: str, written: str, becomes: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL_HEAD + HOLES.format(cycle=cycle) + CL_FOOT, encoding="utf-8")
    assert main(["post", str(cl), "--machine", machine, "--output", str(program)]) == 0
    text = program.read_text(encoding="utf-8")
    assert written in text, text
    program.write_text(text.replace(written, becomes), encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", str(program), "--machine", machine, "--cl", str(cl)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert "holes" in [line.split()[0] for line in lines if line.split()[1:2] == ["FAIL"]]


def test_the_holes_of_a_run_are_searched_for_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The matching and several checks ask for them, and each run has its own."""
    searched: list[Run] = []
    search = hole_matching._search_holes

    def counted(run: Run, expected: ExpectedPath | None) -> list[MatchedHole]:
        searched.append(run)
        return search(run, expected)

    monkeypatch.setattr(hole_matching, "_search_holes", counted)
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CL_HEAD + HOLES.format(cycle=DRILL) + CL_FOOT, encoding="utf-8")
    assert trunnion.post(cl, machine="xyzac_trt", output=program).passed
    assert trunnion.verify(program, machine="xyzac_trt", cl=cl).passed
    assert len(searched) == len(set(searched)) == 2


@pytest.mark.parametrize(("rounding", "passes"), [("0.04", True), ("0.4", False)])
def test_rounding_is_held_to_what_any_work_wants_without_a_tolerance(
    rounding: str, passes: bool, tmp_path: Path
) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    head = CL_HEAD.replace("INTOL/0.01\nOUTTOL/0.01\n", "")
    cl.write_text(head + HOLES.format(cycle=DRILL) + CL_FOOT, encoding="utf-8")
    assert trunnion.post(cl, machine="haas_umc750", output=program).passed
    text = program.read_text(encoding="utf-8").replace(" G54\n", f" G54\nG187 E{rounding}\n", 1)
    program.write_text(text, encoding="utf-8")
    assert trunnion.verify(program, machine="haas_umc750", cl=cl).passed is passes
