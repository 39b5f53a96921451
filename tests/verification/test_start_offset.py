"""Rotary axes that turn before a program selects its work offset: the proof says what it takes to be in force there."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import GOLDEN, YL569
from tests.support.posting import FOOT, HEAD
from trunnion.machines import shipped_machines

FANUC = "%\nO0001\nG21 G90 G17 G40 G80 G94\nT1 M6\n{before}N20 G0 {axis}10.\n{after}G43 H1\nG0 X0. Y0. Z50.\nM30\n%\n"
KLARTEXT = (
    "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\n{before}L A-10 R0 FMAX\n{after}L X+0 Y+0 Z+50 FMAX\nM30\nEND PGM A MM\n"
)

#: Machines, their programs, the word of a work offset, and the block of the turn.
PROGRAMS = [
    ("matsuura_mx330", FANUC.replace("{axis}", "A-"), "G54\n", "N20"),
    ("haas_umc750", FANUC.replace("{axis}", "B"), "G54\n", "N20"),
    ("xyzac_trt", FANUC.replace("{axis}", "A-").replace("%\nO0001\n", "").replace("%\n", ""), "G54\n", "N20"),
    ("hs664rt", "G71 G90 G17 G40\nM306 T.1\n{before}N20 G01 A10. F3000\n{after}X0. Y0. Z50.\nM02\n", "G55 O1\n", "N20"),
    ("yl569", "G71 G90 G17 G40 G94\nT1 M6\n{before}N20 G0 B10\n{after}G0 X0 Y0 Z50\nM30\n", "G54\n", "N20"),
    ("dmu65", KLARTEXT, "CYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ;DATUM NUMBER\n", "line 3"),
]


def turned(machine: str, text: str, folder: Path) -> str:
    """The block that the verification of a program names."""
    program = folder / "part.nc"
    program.write_text(text, encoding="utf-8")
    return trunnion.verify(program, machine=machine).standing.turns_before_offset


@pytest.mark.parametrize(("machine", "text", "offset", "block"), PROGRAMS, ids=[each[0] for each in PROGRAMS])
def test_a_turn_before_the_work_offset_is_told(
    machine: str, text: str, offset: str, block: str, tmp_path: Path
) -> None:
    assert turned(machine, text.format(before="", after=offset), tmp_path) == block
    assert turned(machine, text.format(before=offset, after=""), tmp_path) == ""
    assert turned(machine, text.format(before="", after=""), tmp_path) == "", (
        "the check offset tells that there is none"
    )


def test_a_turn_to_a_position_of_the_machine_needs_no_work_offset(tmp_path: Path) -> None:
    machine, text, offset, _ = PROGRAMS[0]
    text = text.replace("G0 A-10.", "G53 G0 A-10.")
    assert turned(machine, text.format(before="", after=offset), tmp_path) == ""


def test_published_programs_stand_on_it(tmp_path: Path) -> None:
    found = trunnion.verify(YL569 / "2_hub_rough.expected.mpf", machine="yl569", cl=YL569 / "2_hub_rough.cls")
    assert found.passed
    assert "assumed: no work offset is in force at N400" in found.standing.told
    strict = trunnion.verify(YL569 / "2_hub_rough.expected.mpf", machine="yl569", strict=True)
    (basis,) = [check for check in strict.checks if check.key == "basis"]
    assert "assumed: no work offset is in force at N400" in basis.summary
    text = (GOLDEN / "hs664rt" / "radial_holes.expected.txt").read_text(encoding="utf-8")
    assert turned("hs664rt", text, tmp_path)


@pytest.mark.parametrize("machine", shipped_machines())
def test_posts_select_it_first_but_where_published_programs_do_not(machine: str, tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD + "RAPID\nGOTO/0,0,5\nFEDRAT/MMPM,200\nGOTO/5,0,5\n" + FOOT, encoding="utf-8")
    published = machine in ("yl569", "hs664rt")
    found = trunnion.post(cl, machine=machine, columns=False)
    assert found.verification is not None
    assert bool(found.verification.standing.turns_before_offset) == published
    if published:
        found = trunnion.post(cl, machine=machine, settings={"safe_start": "all"}, columns=False)
        assert found.verification is not None
        assert found.passed
        assert not found.verification.standing.turns_before_offset
