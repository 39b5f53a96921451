"""The check `turns`: what frame statements leave on at a tool change and at the end is the frame, not the word."""

from pathlib import Path

import pytest

from tests.support.verifying import check
from trunnion import verify


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
