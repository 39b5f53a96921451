"""A program that leaves the part in the midst of a cut, or stops in a hole, is no proven one."""

from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import check
from trunnion import verify
from trunnion.errors import Severity

CASES = Path(__file__).parents[1] / "data" / "cases"


def changed(folder: Path, name: str, old: str, new: str) -> Path:
    """Return a copy of a program in which one line is another."""
    text = (CASES / name).read_text()
    assert f"\n{old}\n" in text
    file = folder / name
    file.write_text(text.replace(f"\n{old}\n", f"\n{new}\n" if new else "\n"))
    return file


@pytest.mark.parametrize(
    ("left", "fault"),
    [
        ("M242", True),
        ("G290 Z-50.", True),
        ("G290 Z-50.\nZ9.", False),  # stated again
        ("", False),
    ],
)
def test_no_cut_goes_on_where_the_way_of_a_slide_is_not_known(left: str, fault: bool, tmp_path: Path) -> None:
    program = changed(tmp_path, "m242_in_cut.nc", "M242\nN950 Y13.", f"{left}\nN950 Y13." if left else "N950 Y13.")
    for cl in ((), (CASES / "tilted.cls",)):
        found = check(verify(program, machine="hs664rt", cl=cl), "modal")
        assert any("cuts from a position of the machine" in place.text for place in found.places) is fault


@pytest.mark.parametrize(
    ("machine", "lines", "fault"),
    [
        ("matsuura_mx330", "G53 G0 Z0.\nG1 X9. F100.", True),
        ("matsuura_mx330", "G91 G28 Z0.\nG90 G1 X9. F100.", True),
        ("matsuura_mx330", "G91 G30 Z0.\nG90 G1 X9. F100.", True),
        ("matsuura_mx330", "G53 G0 Z0.\nG0 Z5.\nG1 X9. F100.", False),
        ("yl569", "SUPA G0 Z0 D0\nG1 X9 F100", True),
        ("yl569", "SUPA G0 Z0 D0\nG0 Z5 D1\nG1 X9 F100", False),
        ("linuxcnc_5axis", "G53 G0 Z0\nG1 X9 F100", True),
        ("linuxcnc_5axis", "G28\nG1 X9 F100", True),
    ],
)
def test_every_family_states_a_position_again(machine: str, lines: str, fault: bool, tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    head = (
        "%\nO1\nG21 G90 G54\n"
        if machine == "matsuura_mx330"
        else "G71 G90 G54\n"
        if machine == "yl569"
        else "G21 G90 G54\n"
    )
    program.write_text(f"{head}S100 M3\nG0 X1. Y1.\nG0 Z5.\nG1 Z-1. F100.\n{lines}\nM30\n")
    found = check(verify(program, machine=machine), "modal")
    assert any("cuts from a position of the machine" in place.text for place in found.places) is fault


@pytest.mark.parametrize(("word", "fault"), [("M0", True), ("M1", True), ("M60", True), ("T4 M6", True), ("", False)])
def test_nothing_stops_in_a_hole_made_by_motion(word: str, fault: bool, tmp_path: Path) -> None:
    program = changed(tmp_path, "stop_in_hole_made_by_motion.nc", "M0", word)
    found = check(verify(program, machine="linuxcnc_5axis", cl=CASES / "holes.cls"), "stops")
    assert bool(found.places) is fault


def test_a_simulation_refuses_cuts_from_where_nobody_knows() -> None:
    stock, tools = "box:200,200,60,-100,-100,-60", ["7=ball:8,length=60", "8=ball:6,length=60"]
    found = trunnion.simulate(CASES / "m242_in_cut.nc", machine="hs664rt", stock=stock, tools=tools)
    assert [(remark.code, remark.severity) for remark in found.remarks if remark.code == "SIM143"] == [
        ("SIM143", Severity.ERROR)
    ]


@pytest.mark.parametrize(
    ("first", "fault"),
    [
        ("", False),  # where the program begins
        ("G0 X1. Y1. Z5.\nG1 Z-1. F100.\nX2.\nG0 Z5.\n", False),
        ("G0 X1. Y1. Z5.\nG1 Z-1. F100.\nX2.\nZ5. F8000.\n", False),  # its rapids are feeds
        ("G0 X1. Y1. Z5.\nG1 Z-1. F100.\nX2.\n", True),  # in the midst of a cut
        ("G0 X1. Y1. Z5.\nG1 Z-1. F100.\n", True),
    ],
)
@pytest.mark.parametrize(
    ("home", "is_home"), [("G53 G0 Z0.", True), ("G91 G28 Z0.\nG90", True), ("G53 G0 Z-9.", False)]
)
def test_a_feed_along_the_table_at_home_is_none(
    first: str, fault: bool, home: str, is_home: bool, tmp_path: Path
) -> None:
    """A post whose rapids are written as feeds goes above the part so."""
    program = tmp_path / "a.nc"
    head = "%\nO1\nG21 G90 G54 G94\nS100 M3\n"
    program.write_text(f"{head}{first}{home}\nG1 X9. Y9. F8000.\nZ5.\nZ-1. F100.\nX12.\nZ5. F8000.\nM30\n")
    found = check(verify(program, machine="matsuura_mx330"), "modal")
    assert any("cuts from a position of the machine" in place.text for place in found.places) is (fault or not is_home)
