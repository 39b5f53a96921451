"""Whole turns of an endless axis without TCP mill rings; a point on the line of the CL file changes nothing."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS, YL569
from tests.support.verifying import check
from trunnion.verification import Verification

SOURCE = TESTS / "data" / "cases" / "contour.cls"

#: By machine: the block that cuts to (20, 12.5), and the next one, to Y25.
BLOCKS = {
    "yl569": ("N680 X20. Y12.5 Z-2.25", "N690 Y25."),
    "dmu65": ("53 L X+20 Y+12.5 Z-2.25", "54 L Y+25"),
    "matsuura_mx330": ("N350 X20. Y12.5 Z-2.25", "N360 Y25."),
    "haas_umc750": ("N330 X20. Y12.5 Z-2.25", "N340 Y25."),
    "xyzac_trt": ("N400 X20. Y12.5 Z-2.25", "N410 Y25."),
    "hs664rt": ("N2670 X20. Y12.5 Z-2.25", "N2680 Y25."),
}

#: Machines, and blocks in place of the cut (``{}``) that turn the table by whole turns: in the cut, or before it.
TURNS = [
    ("yl569", "C=IC(360)\n{}"), ("yl569", "{} C=IC(-360)"), ("yl569", "{} C=IC(720)"), ("yl569", "{} C=IC(2880)"),
    ("dmu65", "L IC+360\n{}"), ("dmu65", "{} IC-360"), ("matsuura_mx330", "G91 C360.\nG90 {}"),
    ("haas_umc750", "G91 C360.\nG90 {}"), ("xyzac_trt", "C360\n{}"), ("xyzac_trt", "{} C-360"),
    ("xyzac_trt", "{} C720"),
]  # fmt: skip


def changed(machine: str, old: str, new: str, folder: Path) -> Verification:
    """Verify the posted program with other blocks in place of one."""
    program = folder / "one.nc"
    trunnion.post(SOURCE, machine=machine, output=program)
    text = program.read_text(encoding="utf-8")
    assert f"{old}\n" in text
    program.write_text(text.replace(f"{old}\n", f"{new}\n", 1), encoding="utf-8")
    return trunnion.verify(program, machine=machine, cl=SOURCE)


@pytest.mark.third
@pytest.mark.parametrize(("machine", "blocks"), TURNS)
def test_a_whole_turn_in_the_cut_is_a_fault(machine: str, blocks: str, tmp_path: Path) -> None:
    cut = BLOCKS[machine][0]
    found = check(changed(machine, cut, blocks.format(cut), tmp_path), "span")
    assert not found.passed
    assert "turns by more than half a turn without TCP" in found.places[0].text


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("N500 G3 X-40. Y-5. I0.0 J10.", "N500 G3 X-40. Y-5. I0.0 J10. C=IC(360)"),
        ("N640 X10. Y10.", "N640 X10. Y10. C=IC(360)"),
        ("N670 G1 Z-2. S2000 F300.", "N670 G1 Z-2. S2000 F300. C=IC(360)"),
        ("N1210 Y50.", "N1210 Y50. C=IC(360)"),
    ],
    ids=["arc", "rapid", "plunge", "compensated"],
)
def test_no_motion_hides_a_whole_turn(old: str, new: str, tmp_path: Path) -> None:
    assert not check(changed("yl569", old, new, tmp_path), "span").passed


def test_a_whole_turn_on_the_axis_of_the_table_leaves_the_tip_where_it_is(tmp_path: Path) -> None:
    found = changed("yl569", "N580 Y0.0", "N580 Y0.0\nC=IC(360)", tmp_path)
    assert check(found, "span").passed


def test_a_control_that_takes_the_shorter_way_does_not_turn(tmp_path: Path) -> None:
    cut = BLOCKS["hs664rt"][0]
    assert check(changed("hs664rt", cut, f"C360.\n{cut}", tmp_path), "span").passed


@pytest.mark.parametrize("machine", BLOCKS)
def test_a_point_on_the_line_of_the_cl_file_is_taken(machine: str, tmp_path: Path) -> None:
    cut = BLOCKS[machine][1]
    on_line = cut.replace("25", "20").replace("N", "N9") if machine != "dmu65" else "L Y+20"
    found = changed(machine, cut, f"{on_line}\n{cut}", tmp_path)
    order = check(found, "order")
    assert order.passed
    assert "1 more on the way between them" in order.summary
    assert not [each.key for each in found.checks if not each.passed]


@pytest.mark.parametrize(
    ("words", "key"),
    [
        ("Y20. F999\nF300", "feed"), ("Y20. S1500\nS2000", "spindle"), ("Y20. D2\nD1", "tool"),
        ("Y20. G41\nG40", "compensation"), ("G0 Y20.\nG1", "order"), ("X20.05 Y20.\nX20.", "order"),
        ("Y20.\nY15.\n", "order"),
    ],
)  # fmt: skip
def test_such_a_point_is_judged_like_the_points_of_the_cl_file(words: str, key: str, tmp_path: Path) -> None:
    assert not check(changed("yl569", "N690 Y25.", f"{words} Y25.", tmp_path), key).passed


@pytest.mark.parametrize("orientation", ["ORIAXES", "ORIVECT"])
@pytest.mark.parametrize("turn", [360, 2880])
def test_with_tcp_a_whole_turn_takes_the_tool_axis_off_its_way(orientation: str, turn: int, tmp_path: Path) -> None:
    text = (YL569 / "3_blade_finish.expected.mpf").read_text(encoding="utf-8").replace("ORIAXES", orientation)
    cut = "N1480 X36.09145 Y-31.18886 Z-29.92124 B31.71514 C323.78877\n"
    assert cut in text
    program = tmp_path / "one.mpf"
    program.write_text(text.replace(cut, f"{cut}C=IC({turn})\n"), encoding="utf-8")
    found = trunnion.verify(program, machine="yl569", cl=YL569 / "3_blade_finish.cls")
    assert not check(found, "span").passed
