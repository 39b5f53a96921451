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


#: A hole that motions drill, as four families write it; ``%s`` stands at its bottom.
HOLES = {
    "haas_umc750": "%%\nO00001\nG21 G17 G40 G49 G80 G90 G94\nT3 M6\nG54\nG0 X10. Y10. S1500 M3\nG43 H3 Z25. M8\n"
    "G0 Z3.\nG1 Z-9.8 F150.\n%s\nG0 Z25.\nM9\nM5\nG53 G0 Z0.\nM30\n%%\n",
    "yl569": 'G71 G90 G17 G40 G54\nT="3" M6\nG0 X10 Y10 Z25 S1500 D1 M3 M8\nG0 Z3\nG1 Z-9.8 F150\n%s\nG0 Z25\nM9\nM5\n'
    "M30\n",
    "dmu65": "0 BEGIN PGM A MM\nTOOL CALL 3 Z S1500\nL X+10 Y+10 Z+25 FMAX M3\nM8\nL Z+3 FMAX\nL Z-9.8 F150\n%s\n"
    "L Z+25 FMAX\nM9\nM5\nM30\nEND PGM A MM\n",
}
HOLE = (
    "UNITS/MM\nLOAD/TOOL,3\nCUTTER/8\nSPINDL/1500,CLW\nCOOLNT/FLOOD\nRAPID\nGOTO/10,10,25\n"
    "CYCLE/DRILL,FEDTO,9.8,MMPM,150,RAPTO,3,RTRCTO,25\nGOTO/10,10,0\nCYCLE/OFF\nFINI\n"
)


CUT = (
    "UNITS/MM\nLOAD/TOOL,3\nCUTTER/8\nSPINDL/1500,CLW\nRAPID\nGOTO/10,10,25\nFEDRAT/150,MMPM\n"
    "GOTO/10,10,-1\nGOTO/20,10,-1\nFINI\n"
)


@pytest.mark.parametrize(("word", "fault"), [("M60", True), ("M77", False), ("", False)])
def test_no_workpiece_is_changed_within_an_operation(word: str, fault: bool, tmp_path: Path) -> None:
    program, cl = tmp_path / "a.nc", tmp_path / "a.cls"
    program.write_text(
        f'G71 G90 G17 G40 G54\nT="3" M6\nG0 X10 Y10 Z25 S1500 D1 M3\nG1 Z-1 F150\n{word}\nX20\nG0 Z25\nM5\nM30\n'
    )
    cl.write_text(CUT)
    found = check(verify(program, machine="yl569", cl=cl), "stops")
    assert any("changes the workpiece" in place.text for place in found.places) is fault


def test_linuxcnc_keeps_coolant_on_until_the_tool_has_left_a_hole(tmp_path: Path) -> None:
    program, cl = tmp_path / "a.ngc", tmp_path / "a.cls"
    cl.write_text(HOLE)
    for word in ("M9", ""):
        program.write_text(
            "G21 G17 G40 G49 G80 G90 G94\nT3 M6\nG54\nG0 X10 Y10 S1500 M3\nG43 H3 Z25 M8\nG0 Z3\nG1 Z-9.8 F150\n"
            f"{word}\nG0 Z25\nM9\nM5\nG53 G0 Z0\nM2\n"
        )
        found = check(verify(program, machine="linuxcnc_5axis", cl=cl), "coolant")
        assert any("hole" in place.text for place in found.places) is bool(word)


@pytest.mark.parametrize("machine", HOLES)
@pytest.mark.parametrize(
    ("word", "named", "known"),
    [
        ("M60", "stops", ""),
        ("M77", "stops", ""),
        ("M77", "", '[control.known]\nM77 = "no effect: a lamp"\n'),
        ("M9", "coolant", ""),
    ],
)
def test_every_family_keeps_unknown_words_and_coolant_out_of_a_hole(
    machine: str, word: str, named: str, known: str, tmp_path: Path
) -> None:
    program, cl, toml = tmp_path / "a.nc", tmp_path / "a.cls", tmp_path / "ours.toml"
    program.write_text(HOLES[machine] % word)
    cl.write_text(HOLE)
    toml.write_text(f'extends = "{machine}"\n{known}')
    report = verify(program, machine=str(toml), cl=cl)
    of_hole = [name for name in ("stops", "coolant") if any("hole" in p.text for p in check(report, name).places)]
    assert of_hole == ([named] if named else [])


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
