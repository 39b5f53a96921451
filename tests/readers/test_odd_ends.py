"""Circles that end a digit beside their start, and what a program leaves on or has behind itself."""

import contextlib
from pathlib import Path

import pytest

import trunnion

#: Machine -> a program with room for the end of a circle about X0 Y0 from X10 Y0.
_CIRCLES = {
    "matsuura_mx330": "%\nO0001\nG21 G90 G17 G54\nG0 X10. Y0. Z0.\nG3 X10. Y{} Z{} I-10. J0. F90.\nM30\n%\n",
    "haas_umc750": "%\nO00001\nG21 G90 G17 G54\nG0 X10. Y0. Z0.\nG3 X10. Y{} Z{} I-10. J0. F90.\nM30\n%\n",
    "yl569": "G17 G90 G71\nG0 X10 Y0 Z0\nG3 X10 Y{} Z{} I-10 J0 F90\nM30\n",
    "xyzac_trt": "G17 G90 G21\nG0 X10 Y0 Z0\nG3 X10 Y{} Z{} I-10 J0 F90\nM2\n",
    "dmu65": "BEGIN PGM P MM\nTOOL CALL 1 Z S9\nL X+10 Y+0 Z+0 R0 FMAX\nCC X+0 Y+0\nC X+10 Y{} Z{} DR+ F90\nM30\n"
    "END PGM P MM\n",
}


def _said(machine: str, text: str, folder: Path) -> list[str]:
    program = folder / "part.nc"
    program.write_text(text, encoding="utf-8")
    return [each.code for each in trunnion.read_program(program, machine=machine).diagnostics]


@pytest.mark.parametrize("machine", _CIRCLES)
@pytest.mark.parametrize(
    ("end", "height", "found"),
    [("-0.001", "-1", True), ("0.001", "-1", True), ("-0.001", "0", True), ("0.001", "0", False), ("0.", "0.", False)],
)
def test_a_circle_that_ends_beside_its_start_is_remarked_upon(
    machine: str, end: str, height: str, found: bool, tmp_path: Path
) -> None:
    assert ("NC323" in _said(machine, _CIRCLES[machine].format(end, f"{height}."), tmp_path)) is found


@pytest.mark.parametrize(
    ("machine", "block"),
    [("yl569", "G3 X1 Y{} Z-1 I-1 J0 TURN=1"), ("xyzac_trt", "G3 X1 Y{} Z-1 I-1 J0 P2")],
)
@pytest.mark.parametrize(("end", "found"), [("-0.001", True), ("0.001", True), ("0", False)])
def test_a_helix_of_several_turns_that_ends_beside_its_start_is_remarked_upon(
    machine: str, block: str, end: str, found: bool, tmp_path: Path
) -> None:
    text = f"G21 G17 G90 G94\nG0 X0 Y0 Z0\nG1 X1 F9\n{block.format(end)}\nM2\n"
    text = text.replace("G21", "G71") if machine == "yl569" else text
    assert ("NC323" in _said(machine, text, tmp_path)) is found


_SINUMERIK = "%_N_PART_MPF\n;$PATH=/_N_WKS_DIR\nG17 G90 G71\nG0 X0 Y0 Z0\nG1 X1 F9\n"


@pytest.mark.parametrize(
    ("rest", "codes"),
    [
        ("M30\n%\n", []),
        ("X2\nM30\n", []),
        ("%\n", []),
        ("%_N_OTHER_MPF\nX30\nM30\n", ["NC160", "NC161"]),
        ("%\nX30\nM30\n", ["NC160", "NC161"]),
        ("M30\n%_N_OTHER_MPF\nX30\nM30\n", ["NC161"]),
    ],
)
def test_a_transfer_header_in_the_midst_begins_another_program(rest: str, codes: list[str], tmp_path: Path) -> None:
    found = _said("yl569", _SINUMERIK + rest, tmp_path)
    assert found[:1] == codes[:1]
    assert set(found) <= set(codes)


def test_g23_that_is_left_on_is_reported(tmp_path: Path) -> None:
    head = "%\nO0001\nG21 G90 G17 G54\n"
    cut = "G0 X0. Y0. Z0.\nG1 X9. F90.\n"
    assert _said("matsuura_mx330", f"{head}G23\n{cut}M30\n%\n", tmp_path) == ["NC351"]
    assert _said("matsuura_mx330", f"{head}G23\n{cut}G22\nM30\n%\n", tmp_path) == []


_ENDS = {
    "yl569": _SINUMERIK + "M30\n",
    "matsuura_mx330": "%\nO0001\nG21 G90 G17 G54\nG0 X0. Y0. Z0.\nM30\n%\n",
    "haas_umc750": "%\nO00001\nG21 G90 G17 G54\nG0 X0. Y0. Z0.\nM30\n%\n",
    "xyzac_trt": "G17 G90 G21\nG0 X10 Y0 Z0\nM2\n",
    "dmu65": "BEGIN PGM P MM\nTOOL CALL 1 Z S9\nL X+10 Y+0 Z+0 R0 FMAX\nM30\nEND PGM P MM\n",
    "hs664rt": "G71\nG90\nG1 X0. Y0. Z5. F3000\nM02\n",
}


@pytest.mark.parametrize("machine", _ENDS)
@pytest.mark.parametrize("end", ["\x1a", "\x1a\x1a\r\n", "\n \x1a"])
def test_ctrl_z_at_the_end_is_passed_over_and_said(machine: str, end: str, tmp_path: Path) -> None:
    sound = _said(machine, _ENDS[machine], tmp_path)
    assert _said(machine, _ENDS[machine] + end, tmp_path) == [*sound, "NC169"]


@pytest.mark.parametrize("machine", _ENDS)
def test_ctrl_z_before_another_block_is_an_error(machine: str, tmp_path: Path) -> None:
    head, _, rest = _ENDS[machine].rpartition("M")
    found = _said(machine, f"{head}\x1a\nM{rest}", tmp_path)
    assert "NC169" not in found
    assert {"NC210", "NC211", "NC160"} & set(found)


_HEADED = "%\nO0001\nG21 G90 G17 G54\nG0 X0. Y0. Z9.\nG1 Z-1. F90.\nM30\n%\n"


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
@pytest.mark.parametrize("text", ["MADE ON MONDAY\r\nFOR THE CUSTOMER\n", "(A)\n\n  STOCK 100 X 50\n", "+++\n"])
def test_a_text_before_the_first_percent_sign_is_passed_over(machine: str, text: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(text + _HEADED, encoding="utf-8", newline="")
    run = trunnion.read_program(program, machine=machine)
    assert [(each.code, each.severity.value) for each in run.diagnostics if each.code == "NC170"] == [
        ("NC170", "warning")
    ]
    assert not run.errors
    assert run.tip[-1].tolist() == [0.0, 0.0, -1.0]
    assert run.line[-1] == 5 + text.count("\n")


@pytest.mark.parametrize(
    ("machine", "before"),
    [
        ("matsuura_mx330", "G1 X5O\n"),
        ("matsuura_mx330", "MADE ON MONDAY\nG0 X5.\n"),
        ("matsuura_mx330", "T1 M6 OF MONDAY\n"),
        ("xyzac_trt", "MADE ON MONDAY\n"),
        ("hs664rt", "MADE ON MONDAY\n"),
    ],
)
def test_what_a_control_may_run_before_a_percent_sign_is_not_passed_over(
    machine: str, before: str, tmp_path: Path
) -> None:
    program = tmp_path / "part.nc"
    program.write_text(before + _HEADED, encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    assert run.errors
    assert "NC170" not in [each.code for each in run.diagnostics]


@pytest.mark.parametrize("behind", ["", "%\n", "%\n\n  \n"])
def test_a_text_behind_which_no_program_begins_is_an_error(behind: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(f"MADE ON MONDAY\n{behind}", encoding="utf-8")
    with contextlib.suppress(trunnion.TrunnionError):
        assert trunnion.read_program(program, machine="matsuura_mx330").errors
