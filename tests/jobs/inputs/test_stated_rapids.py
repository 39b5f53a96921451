"""The setting ``feed_rapid_from``: lines at a high feed that stand for rapids; and what the head says of it."""

from pathlib import Path

import pytest

import trunnion
from trunnion.model.toolpath import Kind

_CL = """TOOL PATH/A,TOOL,B10
TLDATA/MILL,10,5,35,0,0
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
INTOL/0.01
OUTTOL/0.01
FEDRAT/MMPM,5000
GOTO/0,0,50,0,0,1
GOTO/0,0,5
FEDRAT/MMPM,250
GOTO/0,0,0
{cut}GOTO/10,0,0
FEDRAT/MMPM,6000
GOTO/10,0,50
END-OF-PATH
"""
MACHINES = ["yl569", "dmu65", "mikron_600u", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"]
BOTH = {"spindle": "-8000", "feed_rapid_from": "5000"}


@pytest.fixture
def part(tmp_path: Path) -> Path:
    source = tmp_path / "a.cls"
    source.write_text(_CL.format(cut=""), encoding="utf-8")
    return source


@pytest.mark.parametrize("machine", MACHINES)
def test_lines_at_the_feed_or_above_it_are_rapids(machine: str, part: Path, tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    done = trunnion.post(part, machine=machine, output=program, settings=BOTH)
    assert done.passed
    assert [Kind(kind) for kind in done.toolpaths[0].operations[0].moves.kind] == [0, 0, 1, 1, 0]
    said = [str(problem) for problem in done.problems]
    assert any("3 lines of operation A at 5000 mm/min or more are rapids" in each for each in said)
    assert any("operation A has no spindle speed of its own" in each for each in said)
    text = program.read_text(encoding="utf-8").upper()
    assert "LINES FROM 5000 MM/MIN ON ARE RAPIDS, BY SETTING" in text
    assert "SPINDLE OF A BY SETTING, 8000 REV/MIN COUNTER-CLOCKWISE" in text
    proof = trunnion.verify(program, machine=machine, cl=[part], settings=BOTH)
    assert proof.passed
    without = trunnion.verify(program, machine=machine, cl=[part], settings={"spindle": "-8000"})
    assert not without.passed


def test_an_operation_can_have_a_feed_of_its_own(part: Path) -> None:
    done = trunnion.post(part, machine="yl569", settings={"spindle": "A:900", "feed_rapid_from": "90000,A:6000"})
    assert [Kind(kind) for kind in done.toolpaths[0].operations[0].moves.kind] == [1, 1, 1, 1, 0]


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("7000", "no line of the CL files has"),
        ("A:7000", "has no line at that feed"),
        ("B:5000", "none of that name"),
        ("250", "without a cut"),
        ("fast", "MM_MIN or OPERATION:MM_MIN"),
        ("0", "MM_MIN or OPERATION:MM_MIN"),
        ("5000,6000", "two values"),
    ],
)
def test_what_makes_no_sense_is_refused(value: str, said: str, part: Path) -> None:
    with pytest.raises(trunnion.InputError, match=said):
        trunnion.post(part, machine="yl569", settings={"spindle": "8000", "feed_rapid_from": value})


def test_rapids_within_compensation_are_refused(part: Path) -> None:
    part.write_text(_CL.format(cut="CUTCOM/LEFT\n"), encoding="utf-8")
    settings = {"spindle": "8000", "feed_rapid_from": "5000", "cutcom": "contour"}
    with pytest.raises(trunnion.InputError, match="within CUTCOM"):
        trunnion.post(part, machine="yl569", settings=settings)


def test_holes_at_that_feed_stay_holes(part: Path) -> None:
    cycle = "RAPID\nGOTO/0,0,20\nCYCLE/DRILL,RAPTO,3,FEDTO,-2,MMPM,6000\nGOTO/0,0,0\nCYCLE/OFF\n"
    part.write_text(_CL.format(cut=cycle), encoding="utf-8")
    done = trunnion.post(part, machine="yl569", settings=BOTH)
    assert done.passed
    assert done.verification is not None
    assert any(check.key == "holes" and "1 hole" in str(check.answer) for check in done.verification.checks)


def test_without_the_settings_it_is_as_before(part: Path) -> None:
    with pytest.raises((trunnion.InputError, trunnion.RefusedError), match="CTL510"):
        trunnion.post(part, machine="yl569")


@pytest.mark.parametrize("machine", MACHINES)
def test_a_surface_speed_is_told_with_the_speed_that_it_becomes(machine: str, part: Path, tmp_path: Path) -> None:
    text = part.read_text(encoding="utf-8").replace("FEDRAT/MMPM,5000", "SPINDL/SMM,20,CLW\nFEDRAT/MMPM,5000")
    part.write_text(text, encoding="utf-8")
    done = trunnion.post(part, machine=machine, output=tmp_path / "a.nc")
    assert done.passed
    said = [str(problem) for problem in done.problems if problem.code == "CL735"]
    assert len(said) == 1
    assert "the surface speed 20 m/min becomes 637 rev/min, by the diameter 10 mm" in said[0]
    assert "SPINDLE OF A CONVERTED, 637 REV/MIN OF 20 M/MIN AT 10 MM" in (tmp_path / "a.nc").read_text().upper()
