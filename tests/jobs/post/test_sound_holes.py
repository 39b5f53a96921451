"""Holes of sound CL files go through on every control; a drill that is dragged sideways does not."""

from pathlib import Path

import pytest

from tests.support.locations import ROOT
from tests.support.posting import CLEAR, FOOT, Post
from tests.support.posting import post as post
from trunnion.cli import main

CASES = ROOT / "tests" / "data" / "cases" / "pile"

#: One machine of each control.
MACHINES = ("yl569", "matsuura_mx330", "haas_umc750", "dmu65", "linuxcnc_5axis", "hs664rt")

SPOT_DRILL = "DRILL,10.0000,0.0000,75.0000,90.0000,0.0000"


def posted(text: str, folder: Path, *arguments: str, machine: str = "yl569") -> int:
    cl = folder / "part.apt"
    cl.write_text(text, encoding="utf-8")
    return main(["post", str(cl), "--machine", machine, "--output", str(folder / "part.nc"), *arguments])


@pytest.mark.parametrize("machine", MACHINES)
def test_pecks_and_operations_that_meet_pass(machine: str, tmp_path: Path) -> None:
    names = ("F1_peck_rest_rounding", "F2_hole_by_motion_next_op_same_point", "F2b_plain_drill_cycles_off")
    for name in names:
        assert posted((CASES / f"{name}.apt").read_text(encoding="utf-8"), tmp_path, machine=machine) == 0, name


@pytest.mark.parametrize("depth", [11.0004, 11.0031, 11.0049, 13.0002])
def test_a_last_peck_may_be_as_short_as_the_program_prints(depth: float, tmp_path: Path) -> None:
    text = (CASES / "F1_peck_rest_rounding.apt").read_text(encoding="utf-8")
    assert posted(text.replace("11.0032", str(depth)), tmp_path, machine="matsuura_mx330") == 0


def test_a_hole_that_lost_its_cycle_is_refused(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    text = (CASES / "R4_cure_loses_hole.apt").read_text(encoding="utf-8")
    assert posted(text, tmp_path) == 1
    assert "10MM SPOT DRILL moves sideways at a feed" in capfd.readouterr().err
    assert posted(text, tmp_path, "--set", "drills_sideways=allowed") == 0


def test_the_cure_of_a_cycle_that_goes_on_makes_all_holes(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    text = (CASES / "R4_cycle_over_ops.apt").read_text(encoding="utf-8")
    assert posted(text, tmp_path) == 2
    assert "the whole CYCLE before them" in capfd.readouterr().err
    cycle = next(line for line in text.splitlines() if line.startswith("CYCLE/DRILL"))
    cured = text.replace("20.,30.,0\n", "20.,30.,0\nCYCLE/OFF\n").replace(
        "GOTO/140.,50.,0\n", f"{cycle}\nGOTO/140.,50.,0\n"
    )
    assert posted(cured, tmp_path) == 0
    assert "3 holes" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("tool", "name", "refused"),
    [
        ("DRILL,10.0000,0.0000,75.0000,118.0000,0.0000", "D10", True),
        (SPOT_DRILL, "D10", False),
        ("MILL,10.0000,0.0000,75.0000,0.0000,0.0000", "D10", False),
        ("MILL,10.0000,0.0000,75.0000,0.0000,0.0000", "M10 TAP", True),
        ("MILL,10.0000,0.0000,75.0000,0.0000,0.0000", "TAPER_MILL", False),
    ],
)
def test_what_cuts_along_its_axis_alone(post: Post, tool: str, name: str, refused: bool) -> None:
    head = CLEAR.replace("MILL,10.0000,0.0000,75.0000,0.0000,0.0000", tool).replace("TOOL,D10", f"TOOL,{name}")
    for end, is_cut in (("10.0,0.0,5.0", True), ("10.0,0.0,50.0", False)):
        code, _, err = post.all(f"{head}FEDRAT/MMPM,500.0\nGOTO/{end}\n{FOOT}")
        assert ("moves sideways" in err, code) == ((True, 1) if refused and is_cut else (False, 0)), err


@pytest.mark.parametrize("cycle", ["DRILL", "TAP"])
def test_a_tool_that_drills_or_taps_does_not_mill(post: Post, cycle: str) -> None:
    tool = SPOT_DRILL if cycle == "DRILL" else "MILL,10.0000,0.0000,75.0000,0.0000,0.0000"
    head = CLEAR.replace("MILL,10.0000,0.0000,75.0000,0.0000,0.0000", tool)
    feed = "MMPR,1.5" if cycle == "TAP" else "MMPM,100"
    hole = f"CYCLE/{cycle},RAPTO,3,FEDTO,-10,{feed},RTRCTO,50\nGOTO/5.0,0.0,0.0\nCYCLE/OFF\n"
    code, _, err = post.all(f"{head}{hole}FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n{FOOT}")
    assert code == 1
    assert "moves sideways" in err


@pytest.mark.parametrize("machine", MACHINES)
def test_a_dwell_that_is_too_short_is_rounded_up(
    machine: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    text = f"{CLEAR}FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\nDELAY/0.0004\nGOTO/20.0,0.0,5.0\n{FOOT}"
    assert posted(text, tmp_path, machine=machine) == 0
    assert "a dwell of 0.0004 is shorter than the control can wait" in capfd.readouterr().err
