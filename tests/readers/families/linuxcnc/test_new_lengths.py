"""A tool length that changes with TCP on and rotary axes turned makes the slides of a LinuxCNC jump."""

import pytest

from tests.support.reading import Runner
from trunnion.machines import load_machine

TURNED = "G21 G90 G54\nT1 M6\nG0 A-30 C40\n"
ROUND = "G21 G90 G54\nT1 M6\nG0 A0 C40\n"


@pytest.mark.parametrize(
    ("blocks", "lines"),
    [
        (TURNED + "M428\nG43 H1\nG0 X0 Y0 Z50\nM429\nG49", [5]),
        (TURNED + "G43 H1\nM428\nG0 X0 Y0 Z50\nM429\nG49", []),
        # C turns about the tool: it carries no length sideways. Whole turns carry none either.
        (ROUND + "M428\nG43 H1\nG0 X0 Y0 Z50", []),
        ("G21 G90 G54\nT1 M6\nG0 A360 C40\nM428\nG43 H1\nG0 X0 Y0 Z50", []),
        # The length is on already, or is off already.
        (TURNED + "G43 H1\nM428\nG43 H1\nG0 X0 Y0 Z50", []),
        (TURNED + "G43 H1\nM428\nG43\nG0 X0 Y0 Z50", []),
        (TURNED + "M428\nG49\nG0 X0 Y0 Z50", []),
        # H0 is that of the tool in the spindle, as rs274 with a tool table shows.
        (TURNED + "G43 H1\nM428\nG43 H0\nG0 X0 Y0 Z50", []),
        # Another length; the end of it; axes that turn with TCP on.
        (TURNED + "G43 H1\nM428\nG43 H2\nG0 X0 Y0 Z50", [6]),
        (TURNED + "G43 H1\nM428\nG0 X0 Y0 Z50\nG49\nM429", [7]),
        (ROUND + "G43 H1\nM428\nG0 X0 Y0 Z50\nG1 A5 F100\nG49", [8]),
        (ROUND + "G43 H1\nM428\nG1 A5 F100\nG1 A0\nG49", []),
    ],
)
def test_where_a_new_length_makes_the_slides_jump(blocks: str, lines: list[int], run: Runner) -> None:
    got = run(blocks + "\nM2\n", load_machine("xyzac_trt"))
    found = [each for each in got.errors if each.code == "NC364"]
    assert [each.line for each in found] == lines
    assert all("with TCP on and A turned:" in each.text for each in found)


def test_a_head_carries_the_length(run: Runner) -> None:
    text = "G21 G90 G54\nT1 M6\nG0 B20\nM428\nG43 H1\nG0 X0 Y0 Z50\nM2\n"
    got = run(text, load_machine("linuxcnc_5axis"))
    assert [each.line for each in got.errors if each.code == "NC364"] == [5]


@pytest.mark.parametrize("letter", "ABCUVW")
def test_an_offset_of_another_axis_than_a_slide_is_an_error(letter: str, run: Runner) -> None:
    for word in ("G43.1", "G43.2"):
        got = run(f"{ROUND}{word} {letter}1\nG0 X0 Y0 Z50\nM2\n", load_machine("xyzac_trt"))
        assert (4, "NC220") in [(each.line, each.code) for each in got.errors]
