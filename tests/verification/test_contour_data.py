"""Points of the contour: the program holds them as they are, and the control adds the radius of the tool."""

from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.verifying import check
from trunnion.verification import Check

FOLDER = Path(__file__).parents[1] / "golden/compensation"

#: The contour of the pocket whose centre line is ``pocket.cls``, and a boss of 40 by 30 mm; cutters of 12 mm.
POCKET, BOSS = FOLDER / "contour_pocket.cls", FOLDER / "contour_boss.cls"

MACHINES = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "linuxcnc_5axis", "hs664rt")

#: Of a Fidia nobody knows how it compensates.
UNKNOWN = "hs664rt"


def posted(cl: Path, machine: str, output: Path, **settings: str) -> trunnion.PostResult:
    return trunnion.post(cl, machine=machine, output=output, settings=settings)


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[str, Path], Path]:
    """Programs of which nobody has stated what the register holds."""
    folder = tmp_path_factory.mktemp("contours")
    found = {}
    for machine in MACHINES:
        for cl in (POCKET, BOSS):
            found[machine, cl] = folder / f"{machine}-{cl.stem}.nc"
            result = posted(cl, machine, found[machine, cl])
            assert result.verification is not None
            own = check(result.verification, "compensation")
            assert (own.state, "radius_register" in own.told) == ("not checked", True), machine
            assert len(result.entered) == 1
            assert "enter the radius in " in result.entered[0]
            assert "enter the radius in " in found[machine, cl].read_text().lower()
    return found


def compensation(program: Path, machine: str, cl: Path = POCKET, **given: Any) -> Check:
    return check(trunnion.verify(program, machine=machine, cl=cl, **given), "compensation")


@pytest.mark.parametrize("machine", MACHINES)
def test_the_register_must_hold_the_radius(machine: str, programs: dict[tuple[str, Path], Path]) -> None:
    for cl in (POCKET, BOSS):
        program = programs[machine, cl]
        by_radius = compensation(program, machine, cl, radius_register="radius")
        if machine == UNKNOWN:
            assert (by_radius.state, "is not known" in by_radius.told) == ("not checked", True)
        else:
            assert by_radius.state == "ok"
        along = compensation(program, machine, cl, radius_register="difference")
        assert along.state == "FAIL"
        assert "its centre must go 6.000 mm beside them" in along.summary
        assert compensation(program, machine, cl).state == "not checked"


@pytest.mark.parametrize("machine", [machine for machine in MACHINES if machine != UNKNOWN])
def test_another_side_and_a_lost_end_fail(machine: str, programs: dict[tuple[str, Path], Path], tmp_path: Path) -> None:
    text = programs[machine, BOSS].read_text()
    on, other, off = (" RL", " RR", " R0") if machine == "dmu65" else ("G41", "G42", "G40")
    head, begin, rest = text.partition(on)
    for name, wrong in (("side", head + other + rest), ("end", head + begin + rest.replace(off, ""))):
        assert begin
        program = tmp_path / f"{name}.nc"
        program.write_text(wrong)
        assert compensation(program, machine, BOSS, radius_register="radius").state == "FAIL", name


def test_the_centre_goes_along_the_centre_line(programs: dict[tuple[str, Path], Path]) -> None:
    """The contour is 92 by 60 mm, its centre line 80 by 48 mm; travel follows it but where a difference is stated."""
    program = programs["yl569", POCKET]
    for holds, x, y in (("radius", 80, 48), ("unknown", 80, 48), ("difference", 92, 60)):
        found = trunnion.verify(program, machine="yl569", cl=POCKET, radius_register=holds)  # type: ignore[arg-type]
        summary = check(found, "travel").summary
        assert f"it needs {x}.000 of 500" in summary, holds
        assert f"it needs {y}.000 of 300" in summary, holds


def test_a_simulation_cuts_the_contour(programs: dict[tuple[str, Path], Path]) -> None:
    found = trunnion.simulate(
        programs["yl569", POCKET], machine="yl569", stock="box:120,80,10,-60,-40,-9", radius_register="radius",
        cell=2.0, tools=["1=flat:12,length=75,flutes=30"],
    )  # fmt: skip
    walls = [end for tile in found.simulation.stock.tiles if tile.bundle == 0 for end in tile.ends.ravel().tolist()]
    assert max(end for end in walls if end < 55.0) == pytest.approx(46.0, abs=0.2)


@pytest.mark.parametrize("holds", ["unknown", "radius"])
def test_a_corner_that_is_too_small_for_the_tool_is_refused(holds: str, tmp_path: Path) -> None:
    cl = tmp_path / "tight.cls"
    text = POCKET.read_text().replace("TLDATA/MILL,12.", "TLDATA/MILL,40.").replace(",12.0000,0.0000\n", ",40.,0.\n")
    cl.write_text(text)
    with pytest.raises(trunnion.RefusedError, match="the tool does not fit"):
        posted(cl, "yl569", tmp_path / "tight.mpf", radius_register=holds)


def test_klartext_takes_nothing_off_for_a_contour(tmp_path: Path) -> None:
    program = tmp_path / "pocket.h"
    assert posted(POCKET, "dmu65", program, radius_register="radius").passed
    text = program.read_text()
    assert "TOOL CALL 1 Z S5300\n" in text
    taken_off = tmp_path / "taken_off.h"
    taken_off.write_text(text.replace("TOOL CALL 1 Z S5300", "TOOL CALL 1 Z S5300 DR-6"))
    assert compensation(taken_off, "dmu65", radius_register="radius").state == "FAIL"


def test_a_setting_says_what_a_file_does_not(tmp_path: Path) -> None:
    cl, program = tmp_path / "pocket.cls", tmp_path / "pocket.mpf"
    cl.write_text(POCKET.read_text().replace("$$ contact contour data\n", ""))
    assert "enter the radius minus 6 mm" in posted(cl, "yl569", program).entered[0]
    settings = {"cutcom": "contour", "radius_register": "radius"}
    assert "enter the radius in" in posted(cl, "yl569", program, **settings).entered[0]
    assert compensation(program, "yl569", cl, radius_register="radius").state == "FAIL"
    assert compensation(program, "yl569", cl, radius_register="radius", cutcom="contour").state == "ok"
    with pytest.raises(trunnion.InputError, match="cutcom=centreline that they are those of the tool's centre"):
        posted(POCKET, "yl569", program, cutcom="centreline")


def test_one_register_cannot_hold_both(tmp_path: Path) -> None:
    centre = FOLDER / "pocket.cls"
    with pytest.raises(trunnion.InputError, match="both work with the radius"):
        trunnion.post([POCKET, centre], machine="yl569", output=tmp_path / "both.mpf")


@pytest.mark.parametrize(
    ("words", "of_contour"),
    [
        ("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_PROFILE\nCUTCOM/LEFT\n", True),
        ("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER\nCUTCOM/LEFT\n", False),
        ("CUTCOM/LEFT,CONTACT\n", True),
        ("CUTCOM/LEFT,CONTACT\nGOTO/2,2,0\nCUTCOM/OFF\nGOTO/3,2,0\nCUTCOM/ON\n", True),
        ("CUTCOM/LEFT\n", False),
    ],
)
def test_creo_says_what_its_points_are(words: str, of_contour: bool, tmp_path: Path) -> None:
    cl = tmp_path / "one.ncl"
    cl.write_text(f"$$* Pro/CLfile Version\n$$-> FEATNO / 5\nUNITS/MM\nLOADTL/1\nGOTO/0,0,0\n{words}GOTO/5,5,0\nFINI\n")
    events = trunnion.read_cl(cl).operations[0].events
    sides = [event for event in events if getattr(event, "side", "OFF") != "OFF"]
    assert [event.contour for event in sides] == [of_contour] * len(sides)  # type: ignore[attr-defined]


def test_points_of_a_contour_are_written_to_no_cl_file(tmp_path: Path) -> None:
    with pytest.raises(trunnion.TrunnionError, match="the points behind CUTCOM/LEFT are those of the contour"):
        trunnion.convert(POCKET, to_cl=True, to_dialect="ncl", output=tmp_path / "pocket.ncl")


def test_the_setup_sheet_says_what_to_enter(tmp_path: Path) -> None:
    sheet = tmp_path / "sheet.json"
    trunnion.post(POCKET, machine="yl569", output=tmp_path / "pocket.mpf", sheet=sheet)
    assert "the path is that of the contour, so enter the radius in the tool table" in sheet.read_text()
