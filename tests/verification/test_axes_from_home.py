"""Axes that a program cuts with before it has stated where they are: the verdict says that they are taken to be at
home.
"""

from pathlib import Path

import pytest

import trunnion

CUT = "G0 X0. Y0. Z50.\nN30 G1 Z5. F100.\nX10.\nG0 Z50."
FANUC = f"%\nO0001\nG21 G90 G17 G40 G80 G94 G69\n{{home}}T1 M6\nG54 S500 M3\nG43 H1\n{CUT}\nG49\nM5\nM30\n%\n"
LINUXCNC = FANUC.replace("%\nO0001\n", "").replace("%\n", "")
OTHERS = f"G71 G90 G17 G40 G94\n{{home}}T1 M6\nG54 S500 M3\n{CUT}\nM5\nM30\n"
KLARTEXT = (
    "BEGIN PGM P MM\nM129\nPLANE RESET STAY\nM137\n{home}TOOL CALL 1 Z S500\nM3\nL X+0 Y+0 Z+50 R0 FMAX\n"
    "L Z+5 F100\nL X+10\nL Z+50 FMAX\nM5\nM30\nEND PGM P MM\n"
)

#: Machines, their programs, a way home of both rotary axes and of the first alone, and the names with the block.
PROGRAMS = [
    ("matsuura_mx330", FANUC, "G28 A0. C0.\n", "G28 A0.\n", "A and C", "C", "N30"),
    ("haas_umc750", FANUC, "G28 G91 B0. C0.\nG90\n", "G53 G0 B0.\n", "B and C", "C", "N30"),
    ("xyzac_trt", LINUXCNC, "G53 G0 A0. C0.\n", "G53 G0 A0.\n", "A and C", "C", "N30"),
    ("yl569", OTHERS, "G0 SUPA B0 C0\n", "G0 SUPA B0\n", "B and C", "C", "N30"),
    ("hs664rt", OTHERS.replace("G94", "G69"), "G1 A0. C0. F3000\n", "G1 A0. F3000\n", "A and C", "C", "N30"),
    ("dmu65", KLARTEXT, "L A+0 C+0 R0 FMAX M91\n", "L A+0 R0 FMAX M91\n", "A and C", "C", "line 8"),
]  # fmt: skip


def assumed(machine: str, text: str, folder: Path, *, strict: bool = False) -> str:
    """What the verification of a program says of axes that it has not stated."""
    program = folder / "part.nc"
    program.write_text(text, encoding="utf-8")
    found = trunnion.verify(program, machine=machine, strict=strict)
    axes = found.standing.axes_from_home
    assert f"assumed: {axes}" in found.standing.told or not axes
    if strict:
        (basis,) = (check for check in found.checks if check.key == "basis")
        assert f"assumed: {axes}" in basis.told
    return axes


@pytest.mark.parametrize(("machine", "text", "both", "first", "names", "second", "block"), PROGRAMS)
def test_an_axis_that_no_block_states_before_the_first_cut_is_taken_to_be_at_home(
    machine: str, text: str, both: str, first: str, names: str, second: str, block: str, tmp_path: Path
) -> None:
    assert assumed(machine, text.format(home=""), tmp_path, strict=True) == f"{names} at home at {block}"
    if machine == "dmu65":
        block = "line 9"
    assert assumed(machine, text.format(home=first), tmp_path) == f"{second} at home at {block}"
    assert assumed(machine, text.format(home=both), tmp_path) == ""


def test_linear_axes_are_taken_to_be_at_home_too(tmp_path: Path) -> None:
    text = FANUC.format(home="G28 A0. C0.\n")
    assert assumed("matsuura_mx330", text.replace("X0. Y0. Z50.", "X0. Z50."), tmp_path) == "Y at home at N30"
    home = text.replace("X0. Y0. Z50.", "X0. Z50.").replace("T1 M6", "G28 G91 Y0.\nG90\nT1 M6")
    assert assumed("matsuura_mx330", home, tmp_path) == ""


def test_what_only_a_skipped_block_states_is_assumed(tmp_path: Path) -> None:
    assert assumed("matsuura_mx330", FANUC.format(home="/G28 A0. C0.\n"), tmp_path) == "A and C at home at N30"


def test_a_vector_or_a_plane_states_both_rotary_axes(tmp_path: Path) -> None:
    plane = KLARTEXT.format(home="PLANE SPATIAL SPA+10 SPB+0 SPC+0 TURN FMAX SEQ-\n")
    assert assumed("dmu65", plane, tmp_path) == ""
    vector = OTHERS.format(home="ORIVECT ORIWKS\n").replace("M3\n", "M3\nTRAORI\n").replace("Y0.", "Y0. A3=0 B3=0 C3=1")
    assert assumed("yl569", vector, tmp_path) == ""


def test_a_cycle_cuts_too(tmp_path: Path) -> None:
    drilled = FANUC.replace("G1 Z5. F100.\nX10.", "G81 X10. Y0. Z-2. R3. F100.\nG80")
    assert assumed("matsuura_mx330", drilled.format(home=""), tmp_path) == "A and C at home at N30"
    assert assumed("matsuura_mx330", drilled.format(home="G28 A0. C0.\n"), tmp_path) == ""
