"""Behind a retract in machine coordinates nobody knows how high the tool is, without workpiece zero and tool length."""

from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import check

_ISO = "G21 G17 G40 G49 G80 G90 G94\nG54\nT1 M6\nS1000 M3\nG0 X0 Y0\nG43 H1 Z50.\nG1 Z-2. F500.\nX30.\nG0 Z50.\n"
_SINUMERIK = "G17 G710 G90 G94\nT1\nM6\nG54\nS1000 M3\nG0 X0 Y0 D1\nZ50\nG1 Z-2 F500\nX30\nG0 Z50\n"
_HEIDENHAIN = "TOOL CALL 1 Z S1000\nM3\nL X+0 Y+0 R0 FMAX\nL Z+50 R0 FMAX\nL Z-2 F500\nL X+30\nL Z+50 R0 FMAX\n"
_FIDIA = "G71 G90\nT1 M6\nS1000 M3\nG0 X0 Y0\nZ50\nG1 Z-2 F500\nX30\nG0 Z50\n"

#: Of each family a program up to a retract along Z in machine coordinates, what follows at that height, and its end.
PROGRAMS = {
    "haas_umc750": ("%\nO00001\n" + _ISO + "G49\n", "G53 G0 Z0.\n", "G0 X100. Y-50.\n", "M30\n%\n"),
    "matsuura_mx330": ("%\nO1\n" + _ISO + "G49\n", "G53 G0 Z0.\n", "G0 X100. Y-50.\n", "M30\n%\n"),
    "linuxcnc_5axis": (_ISO, "G49\nG53 G0 Z0\n", "G0 X100 Y-50\n", "M2\n"),
    "yl569": (_SINUMERIK, "SUPA G0 Z0 D0\n", "G0 X100 Y-50\n", "M30\n"),
    "dmu65": ("BEGIN PGM T MM\n" + _HEIDENHAIN, "L Z+0 R0 FMAX M91\n", "L X+100 Y-50 R0 FMAX\n", "M30\nEND PGM T MM\n"),
    "hs664rt": (_FIDIA, "G290 G0 Z0\n", "G0 X100 Y-50\n", "M30\n"),
}


def verified(folder: Path, text: str, key: str) -> trunnion.Verification:
    file = folder / ("t.h" if key == "dmu65" else "t.nc")
    file.write_text(text, encoding="utf-8")
    return trunnion.verify(file, machine=key)


@pytest.mark.parametrize("key", sorted(PROGRAMS))
def test_rapids_at_a_height_of_the_machine_are_not_judged(key: str, tmp_path: Path) -> None:
    begin, retract, rapid, end = PROGRAMS[key]
    found = verified(tmp_path, begin + retract + rapid + end, key)
    assert check(found, "travel").passed
    modal = check(found, "modal")
    assert str(modal.state) == "not checked", modal.told
    assert modal.coverage is not None
    assert len(modal.coverage.left_out) == 1


@pytest.mark.parametrize("key", sorted(PROGRAMS))
def test_a_low_rapid_in_coordinates_of_the_workpiece_fails_as_before(key: str, tmp_path: Path) -> None:
    begin, retract, rapid, end = PROGRAMS[key]
    down = "L Z+6 R0 FMAX\n" if key == "dmu65" else "G0 Z6.\n"
    with_length = begin.removesuffix("G49\n")
    found = check(verified(tmp_path, with_length + down + rapid + retract + end, key), "modal")
    assert "sideways 44.000 mm below the retract height" in found.told


def test_a_slide_left_at_a_machine_position_needs_no_travel(tmp_path: Path) -> None:
    begin, retract, _, end = PROGRAMS["matsuura_mx330"]
    found = check(verified(tmp_path, begin + retract + "G1 X10. Y10. F8000.\n" + end, "matsuura_mx330"), "travel")
    assert found.passed, found.told


def test_clearance_behind_an_approach_at_a_machine_height_is_no_low_rapid(tmp_path: Path) -> None:
    text = (
        "BEGIN PGM T MM\nTOOL CALL 1 Z S3000\nM3\nL Z+559 R0 FMAX M91\nL X+0 Y+0 FMAX\nL Z+50 R0 FMAX\nL X+5 FMAX\n"
        "L Z+0 F500\nL X+10\nM30\nEND PGM T MM\n"
    )
    found = check(verified(tmp_path, text, "dmu65"), "modal")
    assert found.passed, found.told


@pytest.mark.parametrize("retract", ["L Z+0 R0 FMAX M91\n", "L M140 MB MAX FMAX\n"])
def test_a_rapid_in_a_tilted_plane_without_z_behind_a_retract_is_named_as_not_known(
    retract: str, tmp_path: Path
) -> None:
    text = (
        "BEGIN PGM T MM\nTOOL CALL 1 Z S1000\nM3\nPLANE SPATIAL SPA-30 SPB+0 SPC+0 TURN FMAX SEQ-\n"
        "L X+0 Y+0 R0 FMAX\nL Z+50 R0 FMAX\nL Z-2 F500\nL X+30\nL Z+50 R0 FMAX\n"
    )
    found = check(verified(tmp_path, f"{text}{retract}L X+100 Y-50 R0 FMAX\nM30\nEND PGM T MM\n", "dmu65"), "travel")
    assert found.passed, found.told
    assert "Z 508.000 mm left in line 6, it needs 52.000 of 560" in found.told
    assert found.coverage is not None
    assert [place.nc_line for place in found.coverage.left_out] == [5, 11]
