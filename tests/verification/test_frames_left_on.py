"""The check `turns`: what frame statements leave on at a tool change and at the end is the frame, not the word."""

from pathlib import Path

import pytest

from tests.support.verifying import check
from trunnion import read_program, verify


@pytest.mark.parametrize(
    ("statements", "left"),
    [
        ("TRANS X10", True),
        ("TRANS X0 Y0 Z0", False),
        ("TRANS X10\nTRANS X0", False),
        ("TRANS X10\nATRANS X-10", False),
        ("TRANS X.1\nATRANS X.2\nATRANS X-.3", False),
        ("TRANS X10\nATRANS X-9", True),
        ("TRANS X10\nATRANS X0", True),
        ("ATRANS X0", False),
        ("ROT Z30\nAROT Z-30", False),
        ("ROT Z30\nAROT Z-20", True),
        ("ROT Z0", False),
        ("TRANS X10\nAROT Z30\nAROT Z-30", True),
        ("MIRROR X0", True),
        ("MIRROR X0\nAMIRROR X0", False),
        ("SCALE X2\nASCALE X.5", False),
    ],
)
@pytest.mark.parametrize("where", ["T2 M6\nTRANS\nG0 X2\nM30", "M30"])
def test_a_frame_that_changes_nothing_is_off(statements: str, left: bool, where: str, tmp_path: Path) -> None:
    file = tmp_path / "a.mpf"
    file.write_text(f"T1 M6\nG54 D1\nG0 X1 Y1 Z50\n{statements}\nG0 X1 Y1 Z60\n{where}\n", encoding="utf-8")
    assert check(verify(file, machine="yl569"), "turns").passed is not left


def test_rotary_axes_may_turn_where_a_rotation_was_turned_back(tmp_path: Path) -> None:
    file = tmp_path / "a.mpf"
    for angle, passes in ((-30, True), (-20, False)):
        text = (
            f"T1 M6\nG54 D1\nG0 X1 Y1 Z50\nTRANS X1\nAROT Z30\nAROT Z{angle}\nSUPA G0 Z0 D0\nG0 B20 C10\nTRANS\nM30\n"
        )
        file.write_text(text, encoding="utf-8")
        places = check(verify(file, machine="yl569"), "turns").places
        assert any("in a tilted plane" in place.text for place in places) is not passes


LEVEL = 'CYCLE800(0,"TC1",0,57,0,0,0,0,0,0,0,0,0,1)'
TILT = 'CYCLE800(0,"TC1",0,57,0,0,0,0,30,0,0,0,0,1)'


def left_on(folder: Path, text: str, machine: str) -> list[str]:
    """What the check ``turns`` tells of planes and frames that stay on."""
    file = folder / "a.nc"
    file.write_text(text + "\n", encoding="utf-8")
    places = check(verify(file, machine=machine), "turns").places
    return [place.text for place in places if place.text.startswith(("ends the program", "changes the tool"))]


@pytest.mark.parametrize(
    ("end", "told"),
    [
        (LEVEL, ""),
        ("TRANS X5\n" + LEVEL, ""),
        (f"{LEVEL}\nTRANS X5", "with a frame on, which was switched on in line 9"),
        (f"{LEVEL}\nROT Z5", "in a tilted plane, which was switched on in line 9"),
        (f"{LEVEL}\n{TILT}", "in a tilted plane, which was switched on in line 9"),
        (f"{TILT}\nTRANS X5", "in a tilted plane, which was switched on in line 8"),
        (f"{TILT}\nROT Z5\nATRANS X5", "in a tilted plane, which was switched on in line 8"),
        ("CYCLE800()\nROT Z5\nATRANS X5", "in a tilted plane, which was switched on in line 9"),
        (LEVEL.replace(",57,0", ",57,7"), "in a tilted plane, which was switched on in line 8"),
        (LEVEL.replace('(0,"TC1",0', '(0,"TC1",1'), "in a tilted plane, which was switched on in line 8"),
    ],
)
@pytest.mark.parametrize("last", ["M30", "T2 M6\nCYCLE800()\nTRANS\nM30"])
def test_a_swivel_back_to_zero_ends_the_plane(tmp_path: Path, end: str, told: str, last: str) -> None:
    head = f"T1 M6\nG54 D1\nG0 X1 Y1 Z50\n{TILT}\nG0 X1 Y1 Z60\nSUPA G0 Z0 D0\nD1\n"
    expected = [f"{'ends the program' if last == 'M30' else 'changes the tool'} {told}"] if told else []
    assert left_on(tmp_path, f"{head}{end}\n{last}", "yl569") == expected


@pytest.mark.parametrize(
    ("end", "told"),
    [
        ("G68.2 X0 Y0 Z0 I0 J0 K0\nG53.1", False),
        ("G68.2 X0 Y0 Z0 I30. J0 K-30.\nG53.1", False),
        ("G68.2 X0 Y0 Z0 I0 J30. K0\nG53.1", True),
        ("G68.2 X5. Y0 Z0 I0 J0 K0\nG53.1", True),
    ],
)
def test_a_level_plane_of_a_fanuc_is_none(tmp_path: Path, end: str, told: bool) -> None:
    text = f"%\nO0001\nG21 G17 G90 G94 G40 G80 G54\nT1 M6\nG0 X0. Y0.\nG53 G0 Z0.\n{end}\nM30\n%"
    expected = ["ends the program in a tilted plane, which was switched on in line 7"] if told else []
    assert left_on(tmp_path, text, "matsuura_mx330") == expected


@pytest.mark.parametrize(
    ("plane", "told"),
    [
        ("PLANE SPATIAL SPA+0 SPB+0 SPC+0 STAY", False),
        ("PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY", True),
        ("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+0 C+0", False),
        ("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+30 C+0", True),
    ],
)
def test_a_level_plane_of_klartext_is_none(tmp_path: Path, plane: str, told: bool) -> None:
    file = tmp_path / "a.h"
    head = "BEGIN PGM A MM\nTOOL CALL 1 Z S500\nL X+0 Y+0 R0 FMAX\nL X+9 F100\nL Z+560 R0 FMAX M91"
    text = f"{head}\n{plane}\nEND PGM A MM\n"
    file.write_text(text, encoding="utf-8")
    run = read_program(file, machine="dmu65")
    assert [each.text.split(":")[0] for each in run.diagnostics if each.code == "NC351"] == (
        ["ends with a tilted plane on"] if told else []
    )
