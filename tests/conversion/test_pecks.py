"""Holes in pecks become the motion of the program's own control: the conversion says so, and of how many holes."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import Problem

#: A machine of each control with a cycle for pecks, and of the next one.
MACHINES = ("yl569", "dmu65", "mikron_600u", "matsuura_mx330", "haas_umc750", "hs664rt", "linuxcnc_5axis")

HOLES = """TOOL PATH/DRILL,TOOL,D8
TLDATA/DRILL,8,0,60,118,60
LOADTL/1
SPINDL/RPM,900,CLW
RAPID
GOTO/0,0,50,0,0,1
CYCLE/{cycle}
GOTO/5,0,0
GOTO/9,0,0
CYCLE/OFF
CYCLE/DRILL,RAPTO,3,FEDTO,-5,RTRCTO,20,MMPM,150
GOTO/14,0,0
CYCLE/OFF
RAPID
GOTO/14,0,80
END-OF-PATH
"""
DEEP = "DRILL,DEEP,RAPTO,3,FEDTO,-20,RTRCTO,20,MMPM,150,STEP,7"
CHIPS = DEEP.replace("DEEP", "BRKCHP")


def said(source: str, cycle: str, folder: Path, **target: object) -> list[Problem]:
    """Return what the conversion of a program for ``source`` says of holes that become motion."""
    cl, program = folder / "part.cls", folder / "part.nc"
    cl.write_text(HOLES.format(cycle=cycle), encoding="utf-8")
    trunnion.post(cl, machine=source, output=program)
    found = trunnion.convert(program, machine=source, output=folder / "there.nc", **target)  # type: ignore[arg-type]
    return [each for each in found.problems if each.wording.code == "CNV163"]


@pytest.mark.parametrize("target", ["to_cl", "to_machine"])
@pytest.mark.parametrize("source", MACHINES)
def test_the_holes_in_pecks_of_every_control_are_counted_whatever_they_become(
    source: str, target: str, tmp_path: Path
) -> None:
    following = MACHINES[(MACHINES.index(source) + 1) % len(MACHINES)]
    given = {"to_cl": True} if target == "to_cl" else {"to_machine": following}
    (found,) = said(source, DEEP, tmp_path, **given)
    values = dict(found.wording.parameters)
    assert (found.wording.variant, values["count"], values["pecked"]) == ("pecks_become_motion", 3, 2)
    assert "2 have the pecks of this program's control" in str(found)


@pytest.mark.parametrize("source", [each for each in MACHINES if each != "hs664rt"])
def test_pecks_that_break_chips_are_counted_too(source: str, tmp_path: Path) -> None:
    (found,) = said(source, CHIPS, tmp_path, to_cl=True)
    assert (found.wording.variant, dict(found.wording.parameters)["pecked"]) == ("pecks_become_motion", 2)


@pytest.mark.parametrize("source", MACHINES)
def test_a_hole_without_pecks_is_not_said_to_have_any(source: str, tmp_path: Path) -> None:
    (found,) = said(source, DEEP.replace("DEEP,", "").replace(",STEP,7", ""), tmp_path, to_cl=True)
    assert (found.wording.variant, dict(found.wording.parameters)["count"]) == ("cycles_become_motion", 3)


def test_pecks_that_the_program_writes_as_motion_are_those_of_the_cl_file(tmp_path: Path) -> None:
    """Chip breaking is none of Fidia's cycles: only the hole of the second cycle is one."""
    (found,) = said("hs664rt", CHIPS, tmp_path, to_cl=True)
    assert (found.wording.variant, dict(found.wording.parameters)["count"]) == ("cycles_become_motion", 1)


def test_a_line_into_a_hole_that_a_cycle_has_made_is_no_peck(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    drilled = "G0 X5. Y0.\nG98 G81 Z-5. R3. F150.\nG80\nG1 Z-8. F150.\nG0 Z50.\n"
    head = "%\nO0001\nG21 G90 G94\nT5 M6\nG53 G0 Z0.\nG54 S500 M3\nG43 H5 G0 X0. Y0. Z50.\n"
    program.write_text(f"{head}{drilled}G53 G0 Z0.\nM30\n%\n", encoding="utf-8")
    converted = trunnion.convert(program, machine="matsuura_mx330", to_cl=True, output=tmp_path / "there.cls")
    assert [each.wording.variant for each in converted.problems if each.wording.code == "CNV163"] == [
        "cycles_become_motion"
    ]
