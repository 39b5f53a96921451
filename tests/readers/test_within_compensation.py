"""Words that controls do not take while radius compensation is on."""

from pathlib import Path

import pytest

import trunnion
from tests.support.linuxcnc.interpreter import RefusedByLinuxcncError, canonical, needs_linuxcnc
from trunnion.machines import load_machine
from trunnion.readers import run_program

#: Machine -> a program with room for a block in the midst of a compensated contour.
_PROGRAMS = {
    "yl569": "G17 G90 G71 G54\nT1\nM6\nG0 X0 Y0 Z5 S900 M3 D1\nG1 Z0 F100\nG41 X10 Y0\nX20\n{}\nX30\nG40 X40 Y9\nM30\n",
    "dmu65": "BEGIN PGM P MM\nTOOL CALL 1 Z S900\nM3\nL X+0 Y+0 Z+5 R0 FMAX\nL Z+0 F100\nL X+10 Y+0 RL\nL X+20\n{}\n"
    "L X+30\nL X+40 Y+9 R0\nM30\nEND PGM P MM\n",
    "matsuura_mx330": "%\nO0001\nG21 G17 G40 G80 G90 G94 G54\nT1 M6\nG0 G43 H1 X0. Y0. Z5. S900 M3\nG1 Z0. F100.\n"
    "G41 D1 X10. Y0.\nX20.\n{}\nX30.\nG40 X40. Y9.\nG49\nM30\n%\n",
    "haas_umc750": "%\nO00001\nG21 G17 G40 G80 G90 G94 G54\nT1 M6\nG0 G43 H1 X0. Y0. Z5. S900 M3\nG1 Z0. F100.\n"
    "G41 D1 X10. Y0.\nX20.\n{}\nX30.\nG40 X40. Y9.\nG49\nM30\n%\n",
    "xyzac_trt": "G21 G17 G90 G94 G40\nT1 M6\nG54\nG43 H1\nS900 M3\nG0 X0 Y0 Z5\nG1 Z0 F100\nG41 X40 Y0\nX60\n{}\n"
    "G1 X90 F100\nG40 X140 Y9\nG49\nM2\n",
    "hs664rt": "G71\nG90\nT.1 M306\nG55 O1\nG1 X0. Y0. Z5. F3000\nZ0. F100\nG41\nX10. Y0.\nX20.\n{}\n"
    "X30.\nG40\nX40. Y9.\nM02\n",
}

_REFUSED = {
    "yl569": ("TRAORI", "M6", "G18", "CYCLE800()", 'CYCLE800(0,"",0,57,0,0,0,0,0,0,0,0,0,1)', "TOROT", "TOFRAME"),
    "dmu65": (
        "PLANE RESET STAY", "PLANE SPATIAL SPA+0 SPB+0 SPC+0 STAY", "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
        "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1", "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.05", "M128",
        "TOOL CALL 1 Z S900",
        "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+5", "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+5",
    ),
    "matsuura_mx330": ("G18", "M6", "G68.2 X0 Y0 Z0 I0 J0 K0", "G53.1", "G43.4 H1", "G52 X0 Y0", "G92 X20."),
    "haas_umc750": ("G19", "M6", "G254", "G234 H1"),
    "xyzac_trt": (
        "G54", "G55", "G18", "M6", "G43", "G43 H7", "G49", "G52 X0", "G92 X0", "G10 L2 P1 X0", "G10 L20 P1 X0",
        "G53 G0 Z0", "G28 Z0", "G30 Z0", "G81 Z-5 R1", "G43.1 Z0", "G38.2 Z-1", "G28.1", "G41 D1", "G42.1 D6", "G61",
        "G64 P0.1", "M66 P0 L0", "M62 P0", "M64 P0", "M67 E0 Q1", "M68 E0 Q1",
    ),
    "hs664rt": ("G18", "G154", "G96", "T.2 M306", "G55 O2"),
}  # fmt: skip

_TAKEN = {
    "yl569": ("G17", "TRANS X5", "D2", "T2", "TRAFOOF", "G450", "STOPRE", "G90"),
    "dmu65": ("TOOL CALL S1000", "M129", "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+0", "M8"),
    "matsuura_mx330": ("G17", "G69", "T2", "M8", "G54", "G68 X0 Y0 R0"),
    "haas_umc750": ("G17", "G69", "T2", "M8", "G255"),
    "xyzac_trt": ("G17", "T2", "G92.1", "G10 L2 P2 X0", "G91\nG90", "M1", "M8", "G80", "G94", "G4 P1"),
    "hs664rt": ("G17", "G69", "G97", "G55 O1", "M8"),
}


def _found(machine: str, block: str, folder: Path) -> list[str]:
    program = folder / ("part.h" if machine == "dmu65" else "part.nc")
    program.write_text(_PROGRAMS[machine].format(block), encoding="utf-8")
    return [each.code for each in trunnion.read_program(program, machine=machine).errors]


@pytest.mark.parametrize("machine", _PROGRAMS)
def test_words_that_the_control_refuses_within_compensation_are_errors(machine: str, tmp_path: Path) -> None:
    silent = [word for word in _REFUSED[machine] if "NC343" not in _found(machine, word, tmp_path)]
    assert not silent
    assert "NC343" not in _found(machine, "", tmp_path)


@pytest.mark.parametrize("machine", _PROGRAMS)
def test_words_that_change_nothing_or_may_stand_there_are_none(machine: str, tmp_path: Path) -> None:
    refused = [word for word in _TAKEN[machine] if "NC343" in _found(machine, word, tmp_path)]
    assert not refused


@pytest.mark.parametrize(("machine", "off"), [("matsuura_mx330", "G40 G69 X25."), ("xyzac_trt", "G40 G54 X25")])
def test_a_block_that_ends_compensation_may_have_them(machine: str, off: str, tmp_path: Path) -> None:
    assert "NC343" not in _found(machine, off, tmp_path)


@needs_linuxcnc
def test_linuxcnc_agrees(tmp_path: Path) -> None:
    def is_refused(word: str) -> bool:
        program = tmp_path / "judged.ngc"
        program.write_text(_PROGRAMS["xyzac_trt"].format(word), encoding="utf-8")
        try:
            canonical(program)
        except RefusedByLinuxcncError:
            return True
        return False

    words = (*_REFUSED["xyzac_trt"], *_TAKEN["xyzac_trt"])
    assert [word for word in words if is_refused(word)] == list(_REFUSED["xyzac_trt"])


@pytest.mark.parametrize(
    ("machine", "block"),
    [
        ("matsuura_mx330", "G99 G81 X25. Z-5. R2. F100.\nG80\nG1"),
        ("haas_umc750", "G99 G81 X25. Z-5. R2. F100.\nG80\nG1"),
        ("yl569", "MCALL CYCLE81(50,0,2,-5)\nX25\nMCALL"),
    ],
)
def test_a_drilling_cycle_is_a_warning(machine: str, block: str, tmp_path: Path) -> None:
    assert _drilled(machine, block, tmp_path) == [
        ("warning", "a drilling cycle while radius compensation is on: where the holes are depends on the control")
    ]


@pytest.mark.parametrize("call", ["CYCL CALL", "L X+25 M99", "L X+25 M89\nM99"])
def test_a_tnc_refuses_a_drilling_cycle(call: str, tmp_path: Path) -> None:
    cycle = "CYCL DEF 200 DRILLING Q200=+2 Q201=-5 Q206=+100 Q202=+5 Q210=+0 Q203=+0 Q204=+50 Q211=+0\n"
    found = set(_drilled("dmu65", cycle + call, tmp_path))
    assert found == {("error", "a drilling cycle while radius compensation is on: the control refuses it")}


def _drilled(machine: str, block: str, folder: Path) -> list[tuple[str, str]]:
    path = folder / "p.nc"
    path.write_text(_PROGRAMS[machine].format(block), encoding="utf-8")
    run = run_program(path, load_machine(machine))
    return [
        (each.severity.value, each.text.partition(";")[0]) for each in run.diagnostics if each.wording.code == "NC343"
    ]


@pytest.mark.parametrize(
    ("between", "refused"),
    [
        ("L R0", True),
        ("L Z+5 R0", True),
        ("L X+30 R0", False),
        ("L R0\nL Y+4", False),
        ("L Z+5 R0\nL X+30 FMAX", False),
    ],
)
def test_r0_between_two_sides_moves_in_the_working_plane(between: str, refused: bool, tmp_path: Path) -> None:
    found = _drilled("dmu65", f"{between}\nL X+33 RR", tmp_path)
    assert ["on the other side" in text for _, text in found] == [True] * refused
