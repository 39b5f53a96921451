"""What the control makes of radius compensation, by what its register holds: a difference, or the radius."""

from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
import pytest

import trunnion
from tests.support.verifying import check
from trunnion.compensation.centre_runs import run_of_centre
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import compensated_stretches
from trunnion.verification import Check

#: A pocket of 92 by 60 mm finished along the path of the centre of a cutter of 12 mm, with CUTCOM.
POCKET = Path(__file__).parents[1] / "golden/compensation/pocket.cls"
Holds: TypeAlias = Literal["difference", "radius"]

MACHINES = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "linuxcnc_5axis", "hs664rt")


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pockets")
    found = {}
    for machine in MACHINES:
        found[machine] = folder / f"{machine}.nc"
        settings = {"radius_register": "difference"}
        posted = trunnion.post(POCKET, machine=machine, output=found[machine], settings=settings)
        assert posted.verification is not None
        assert check(posted.verification, "compensation").state == "ok"
    return found


def compensation(program: Path, machine: str, holds: Holds | None) -> Check:
    found = trunnion.verify(program, machine=machine, cl=POCKET, radius_register=holds)
    return check(found, "compensation")


@pytest.mark.parametrize("machine", MACHINES)
def test_the_radius_in_the_register_of_a_centre_line_is_a_doubled_radius(
    machine: str, programs: dict[str, Path]
) -> None:
    assert compensation(programs[machine], machine, "difference").state == "ok"
    unknown = compensation(programs[machine], machine, None)
    assert unknown.state == "not checked"
    assert "radius_register" in unknown.told
    doubled = compensation(programs[machine], machine, "radius")
    assert doubled.state == "FAIL"
    assert "compensates by 6.000 mm" in doubled.summary


@pytest.mark.parametrize("word", ["KONT", "CUT3DC"])
def test_a_doubled_radius_fails_however_the_control_rounds_corners(
    word: str, programs: dict[str, Path], tmp_path: Path
) -> None:
    program = tmp_path / "corners.mpf"
    program.write_text(programs["yl569"].read_text().replace("G41 ", f"{word} G41 "))
    assert compensation(program, "yl569", "difference").state != "FAIL"
    assert "compensates by 6.000 mm" in compensation(program, "yl569", "radius").summary


@pytest.mark.parametrize("holds", ["unknown", "difference", "radius"])
@pytest.mark.parametrize(
    ("machine", "word", "block"), [("yl569", "TOFFR=1", "G41 "), ("dmu65", "TOOL CALL DR+1", " RL ")]
)
def test_a_radius_added_within_compensation_fails_whatever_the_register_holds(
    machine: str, word: str, block: str, holds: str, programs: dict[str, Path], tmp_path: Path
) -> None:
    lines = programs[machine].read_text().splitlines()
    at = next(k for k, line in enumerate(lines) if block in f"{line} ") + 2
    program = tmp_path / f"added{programs[machine].suffix}"
    program.write_text("\n".join([*lines[:at], word, *lines[at:], ""]))
    found = trunnion.verify(program, machine=machine, cl=POCKET, radius_register=holds)  # type: ignore[arg-type]
    assert check(found, "tool").state == "FAIL"
    if holds != "unknown":
        assert check(found, "compensation").state == "FAIL"


def test_klartext_takes_the_radius_off_that_of_the_tool_table(tmp_path: Path) -> None:
    program = tmp_path / "pocket.h"
    posted = trunnion.post(POCKET, machine="dmu65", output=program, settings={"radius_register": "radius"})
    assert posted.passed
    text = program.read_text()
    assert "TOOL CALL 1 Z S5300 DR-6\n" in text
    assert "; radius compensation of tool 1: enter the radius in the tool table\n" in text
    assert compensation(program, "dmu65", "radius").state == "ok"
    assert compensation(program, "dmu65", "difference").state == "FAIL"
    longer = tmp_path / "longer.h"
    longer.write_text(text.replace("DR-6", "DR-5"))
    assert compensation(longer, "dmu65", "radius").state == "FAIL"


def test_heads_say_radius_or_diameter_as_the_control_takes_it(programs: dict[str, Path]) -> None:
    def entered(machine: str) -> str:
        return " ".join(programs[machine].read_text().replace("(", "").replace(")", "").split())

    assert "enter the diameter minus 12 mm in the tool table" in entered("linuxcnc_5axis")
    assert "ENTER THE RADIUS MINUS 6 MM IN D1, TWICE THAT IF SETTING 40 IS DIAMETER" in entered("haas_umc750")
    assert "ENTER THE RADIUS MINUS 6 MM IN D1, TWICE THAT IF BIT 2 OF PARAMETER 5004 IS 1" in entered("matsuura_mx330")


def test_the_entry_counts_as_the_program_does(tmp_path: Path) -> None:
    program = tmp_path / "pocket.nc"
    trunnion.post(POCKET, machine="haas_umc750", output=program, settings={"units": "inch"})
    said = " ".join(program.read_text().replace("(", "").replace(")", "").split())
    assert "ENTER THE RADIUS MINUS 0.23622 INCH IN D1" in said


@pytest.mark.parametrize("machine", MACHINES)
def test_a_conversion_says_once_what_to_enter(machine: str, programs: dict[str, Path], tmp_path: Path) -> None:
    again = tmp_path / f"again{programs[machine].suffix}"
    settings = {"radius_register": "difference"}
    trunnion.convert(programs[machine], machine=machine, to_machine=machine, output=again, settings=settings)
    assert again.read_text().lower().count("radius compensation of tool") == 1


def test_a_side_that_is_wrong_and_an_end_that_is_lost_fail(programs: dict[str, Path], tmp_path: Path) -> None:
    text = programs["yl569"].read_text()
    for old, new in (("G41", "G42"), ("G40 Y-14.", "Y-14.")):
        assert old in text
        wrong = tmp_path / "wrong.mpf"
        wrong.write_text(text.replace(old, new))
        assert compensation(wrong, "yl569", "difference").state == "FAIL"


def test_travel_is_that_of_the_centre(programs: dict[str, Path]) -> None:
    """Six millimetres inside the pocket, which is 80 by 48 mm for the centre."""

    def travel(holds: Holds) -> str:
        found = trunnion.verify(programs["yl569"], machine="yl569", cl=POCKET, radius_register=holds)
        return check(found, "travel").summary

    assert "it needs 80.000 of 500" in travel("difference")
    assert "it needs 68.000 of 500" in travel("radius")


def test_the_run_of_the_centre_has_rows_for_what_is_inserted(programs: dict[str, Path]) -> None:
    """Outside: circles about the corners of the lead-in; the rows of the program keep their lines and events."""
    run = trunnion.read_program(programs["yl569"], machine="yl569")
    (stretch,) = compensated_stretches(run)
    found = run_of_centre(run, [(stretch, -6.0)])
    real, added = found.run, len(found.run) - len(run)
    assert not found.faults
    assert added == 1
    assert real.line[found.row_of].tolist() == run.line.tolist()
    assert [event.kind for event in real.events] == [event.kind for event in run.events]
    assert real.tip[found.row_of[stretch.end]] == pytest.approx(run.tip[stretch.end])
    assert np.abs(real.tip[found.row_of[stretch.first : stretch.end], :2]).max() == pytest.approx(46.0)
    assert sorted(set(np.round(real.arcs.radius, 6).tolist())) == [4.0, 6.0, 16.0]
    assert run_of_centre(run, [(stretch, 11.0)]).faults[0][1] is Fault.TIGHT


def test_a_path_with_g41_1_states_its_radius(tmp_path: Path) -> None:
    program = tmp_path / "stated.ngc"
    program.write_text(
        "G21 G17 G90 G40 G49\nT1 M6\nG43 H1\nG54 G0 X-20 Y0 Z50\nG1 Z0 F100\nG41.1 D6 X0 Y0\nY20\nX20\n"
        "G40 X30 Y30\nM2\n"
    )
    run = trunnion.read_program(program, machine="linuxcnc_5axis")
    assert run.state.stated_radius[int(next(compensated_stretches(run)).first)] == 3.0
    found = trunnion.simulate(
        program,
        machine="linuxcnc_5axis",
        stock="box:20,20,10,0,0,-10",
        tools=["1=flat:6,length=60,flutes=20"],
        cell=1.0,
    )
    assert "SIM147" not in {remark.code for remark in found.remarks}


@pytest.mark.parametrize(("holds", "wide"), [("difference", 46.0), ("radius", 40.0)])
def test_a_simulation_cuts_along_the_path_of_the_centre(holds: Holds, wide: float, programs: dict[str, Path]) -> None:
    found = trunnion.simulate(
        programs["yl569"], machine="yl569", stock="box:120,80,10,-60,-40,-9", radius_register=holds, cell=2.0,
        tools=["1=flat:12,length=75,flutes=30"],
    )  # fmt: skip
    assert {remark.code for remark in found.remarks}.isdisjoint({"SIM147", "NC221"})
    walls = [end for tile in found.simulation.stock.tiles if tile.bundle == 0 for end in tile.ends.ravel().tolist()]
    assert max(end for end in walls if end < 55.0) == pytest.approx(wide, abs=0.2)


def test_a_simulation_says_where_nobody_has_stated_the_register(programs: dict[str, Path]) -> None:
    found = trunnion.simulate(
        programs["yl569"], machine="yl569", stock="box:120,80,10,-60,-40,-9", cell=2.0,
        tools=["1=flat:12,length=75,flutes=30"],
    )  # fmt: skip
    assert "SIM147" in {remark.code for remark in found.remarks}


def test_corners_of_sinumerik_are_as_the_program_says(tmp_path: Path, programs: dict[str, Path]) -> None:
    text = programs["yl569"].read_text()
    for words, style in (("G450 ", 1), ("G451 ", 2), ("KONT ", 0), ("DISC=50 ", 0), ("DISC=0 ", 1)):
        program = tmp_path / "corners.mpf"
        program.write_text(text.replace("G41 ", f"{words}G41 "))
        run = trunnion.read_program(program, machine="yl569")
        assert next(compensated_stretches(run)).style == style, words
