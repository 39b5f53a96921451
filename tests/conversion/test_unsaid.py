"""What a program needs and does not say, may leave out or loses with its cycles is told where it is converted."""

from pathlib import Path

import pytest

import trunnion
from tests.support.program_states import MACHINES, PROGRAMS

HEADS = {
    "matsuura_mx330": ("%", "O0001", "G21 G17 G90 G94 G40 G80 G54", "T1 M6", "S1000 M3", "G0 G43 H1 X0. Y0. Z50."),
    "yl569": ("G710 G17 G90 G94 G54", "T1", "M6", "S1000 M3", "G0 X0 Y0 Z50 D1"),
    "dmu65": (
        "BEGIN PGM A MM",
        "CYCL DEF 247 DATUM SETTING Q339=1",
        "TOOL CALL 1 Z S1000",
        "M3",
        "L X+0 Y+0 Z+50 R0 FMAX",
    ),
}
CUTS = {
    "matsuura_mx330": ("G1 Z-1. F100", "X10.", "G0 X20.", "Z50.", "M5", "G53 G0 Z0.", "M30", "%"),
    "yl569": ("G1 Z-1 F100", "X10", "G0 X20", "Z50", "M5", "SUPA G0 Z0 D0", "M30"),
    "dmu65": ("L Z-1 F100", "L X+10", "L X+20 FMAX", "L Z+50 FMAX", "M5", "L Z+560 R0 FMAX M91", "END PGM A MM"),
}


def told(folder: Path, machine: str, change: tuple[str, str] = ("", "")) -> list[tuple[str, int, str]]:
    """Code, line and variant of what a conversion to a CL file tells of missing and skipped words."""
    old, new = change
    lines = (*HEADS[machine], *CUTS[machine])
    assert not old or old in lines
    program = folder / ("part.h" if machine == "dmu65" else "part.nc")
    program.write_text("\n".join(new if line == old else line for line in lines) + "\n", encoding="utf-8")
    found = trunnion.convert(program, machine=machine, to_cl=True).problems
    codes = ("CNV144", "CNV153", "CNV154")
    return [(str(each.code), each.line, str(each.wording.variant)) for each in found if each.code in codes]


@pytest.mark.parametrize("machine", HEADS)
def test_a_sound_program_needs_nothing(tmp_path: Path, machine: str) -> None:
    assert told(tmp_path, machine) == []


@pytest.mark.parametrize(("machine", "old", "new", "expected"), [
    ("matsuura_mx330", "S1000 M3", "S1000", ("CNV154", 7, "cuts_without_spindle")),
    ("yl569", "S1000 M3", "S1000", ("CNV154", 6, "cuts_without_spindle")),
    ("dmu65", "M3", "M8", ("CNV154", 6, "cuts_without_spindle")),
    ("matsuura_mx330", "T1 M6", "T1", ("CNV154", 7, "cuts_without_tool")),
    ("matsuura_mx330", "T1 M6", "", ("CNV154", 7, "cuts_without_tool")),
    ("yl569", "M6", "", ("CNV154", 6, "cuts_without_tool")),
    ("matsuura_mx330", HEADS["matsuura_mx330"][2], "G21 G17 G90 G94 G40 G80", ("CNV144", 7, "selects_none")),
])  # fmt: skip
def test_a_lost_word_is_told_at_the_first_cut(
    tmp_path: Path, machine: str, old: str, new: str, expected: tuple[str, int, str]
) -> None:
    assert told(tmp_path, machine, (old, new)) == [expected]


@pytest.mark.parametrize(("machine", "block", "variant"), [
    ("matsuura_mx330", "T1 M6", "skips_tool"), ("yl569", "M6", "skips_tool"),
    ("dmu65", "TOOL CALL 1 Z S1000", "skips_tool"), ("matsuura_mx330", "S1000 M3", "skips_head"),
    ("yl569", "S1000 M3", "skips_head"), ("matsuura_mx330", "G0 G43 H1 X0. Y0. Z50.", "skips_length"),
    ("matsuura_mx330", "G53 G0 Z0.", "skips_machine_move"), ("dmu65", "L Z+560 R0 FMAX M91", "skips_machine_move"),
])  # fmt: skip
def test_what_no_opskip_holds_is_told(tmp_path: Path, machine: str, block: str, variant: str) -> None:
    line = HEADS[machine].index(block) if block in HEADS[machine] else len(HEADS[machine]) + CUTS[machine].index(block)
    assert ("CNV153", line + 1, variant) in told(tmp_path, machine, (block, f"/{block}"))


def test_motion_that_may_be_skipped_is_carried_and_not_told(tmp_path: Path) -> None:
    assert told(tmp_path, "matsuura_mx330", ("G0 X20.", "/G0 X20.")) == []


HOLES = {
    "matsuura_mx330": ("G98 G81 X10. Y0. Z-5. R2. F100", "X20.", "X30.", "G80"),
    "haas_umc750": ("G98 G81 X10. Y0. Z-5. R2. F100", "X20.", "X30.", "G80"),
    "yl569": ("F100", "MCALL CYCLE81(5,0,2,-5)", "X10 Y0", "X20", "X30", "MCALL"),
    "dmu65": (
        "CYCL DEF 200 DRILLING ~", "Q200=2 ~", "Q201=-5 ~", "Q206=100 ~", "Q202=5 ~", "Q210=0 ~", "Q203=0 ~",
        "Q204=50 ~", "Q211=0", "L X+10 Y+0 R0 FMAX M99", "L X+20 R0 FMAX M99", "L X+30 R0 FMAX M99",
    ),
    "hs664rt": ("G81 X10 Y0 Z50 R2 E-5 F100", "X20", "X30", "G80", "G1"),
    "xyzac_trt": ("G98 G81 X10 Y0 Z-5 R2 F100", "X20", "X30", "G80", "G1"),
}  # fmt: skip


@pytest.mark.parametrize("machine", HOLES)
def test_cycles_that_become_motion_are_one_remark_at_the_first_hole(tmp_path: Path, machine: str) -> None:
    family = next(family for family, name in MACHINES.items() if name == machine)
    rooms = dict.fromkeys(("head", "above", "behind", "end"), "") | {"cut": "\n".join(HOLES[machine])}
    program = tmp_path / ("part.h" if machine == "dmu65" else "part.nc")
    program.write_text(PROGRAMS[family].format(**rooms), encoding="utf-8")
    lines = program.read_text(encoding="utf-8").splitlines()
    found = [each for each in trunnion.convert(program, machine=machine, to_cl=True).problems if each.code == "CNV163"]
    assert [each.what.partition(", the first")[0] for each in found] == ["3 holes of drilling cycles become motion"]
    assert "10" in lines[found[0].line - 1]
