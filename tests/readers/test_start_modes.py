"""Modes that a program relies on without saying them: the verification says that they are assumed."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError

MOVES = "G0 X0. Y0. Z50.\nG1 Z5. F100.\nX10.\nG0 Z50."
FANUC = f"%\nO0001\nG21{{said}}\nT1 M6\nG54 S500 M3\nG43 H1\n{MOVES}\nG49\nM5\nM30\n%\n"
OTHERS = f"{{said}}\nT1 M6\nG54 S500 M3\n{MOVES}\nM5\nM30\n"

KLARTEXT = (
    "BEGIN PGM P MM\n{said}\nTOOL CALL 1 Z S500\nCYCL DEF 247 DATUM SETTING ~\nQ339=1\nM3\nL X+0 Y+0 Z+50 R0 FMAX\n"
    "L Z+5 F100\nL X+10\nL Z+50 FMAX\nM5\nM30\nEND PGM P MM\n"
)

#: Machines, their programs, and what is assumed of one that says nothing.
PROGRAMS = [
    ("matsuura_mx330", FANUC, ("G90", "G17", "G40", "G94", "G69")),
    ("haas_umc750", FANUC, ("G90", "G17", "G40", "G94", "G255")),
    ("xyzac_trt", FANUC.replace("%\nO0001\n", "").replace("%\n", ""), ("G90", "G17", "G40", "G94", "M429")),
    ("hs664rt", OTHERS, ("G90", "G17", "G40", "G69", "G197")),
    ("dmu65", KLARTEXT, ("M137", "PLANE RESET", "M129")),
    ("yl569", OTHERS, ("G90", "G17", "G40", "G94", "G71", "TRAFOOF", "CYCLE800()")),
]


def assumed(machine: str, text: str, folder: Path) -> tuple[str, ...]:
    """What the verification of a program says it assumes."""
    program = folder / "part.nc"
    program.write_text(text, encoding="utf-8")
    return trunnion.verify(program, machine=machine).standing.assumed


@pytest.mark.parametrize(("machine", "text", "words"), PROGRAMS)
def test_what_no_program_says_before_it_moves_is_assumed(
    machine: str, text: str, words: tuple[str, ...], tmp_path: Path
) -> None:
    assert assumed(machine, text.format(said=""), tmp_path) == words
    if machine == "dmu65":
        assert assumed(machine, text.format(said="M137\nPLANE RESET STAY"), tmp_path) == ("M129",)
        assert assumed(machine, text.format(said="PLANE RESET STAY\nM129"), tmp_path) == ("M137",)
        assert assumed(machine, text.format(said="PLANE RESET STAY\nM129\nM137"), tmp_path) == ()
        return
    said = " " + " ".join(words)
    assert assumed(machine, text.format(said=said), tmp_path) == ()
    assert assumed(machine, text.format(said=said.replace(" G17", "")), tmp_path) == ("G17",)


def test_a_word_behind_the_first_motion_comes_too_late(tmp_path: Path) -> None:
    late = FANUC.format(said=" G17 G40 G80 G69").replace("G1 Z5.", "G90 G94 G1 Z5.")
    assert assumed("matsuura_mx330", late, tmp_path) == ("G90",), "the feed mode matters in the first cut"


def test_any_word_of_a_motion_ends_a_cycle(tmp_path: Path) -> None:
    for machine, text, words in PROGRAMS[:2]:
        found = assumed(machine, text.format(said="").replace("G0 X0.", "X0."), tmp_path)
        assert set(found) == {*words, "G80"}


#: What ends a plane, a rotation or TCP that was left on.
PLANE_OFF = {"matsuura_mx330": "G69", "haas_umc750": "G255", "xyzac_trt": "M429"}

CYCLE = "G0 X0. Y0. Z50.\n{}G81 X10. Y0. Z-5. R3. F100.\nX20. Y0.\nG80\nG0 Z50."


@pytest.mark.parametrize(
    ("machine", "text", "word"),
    [("matsuura_mx330", FANUC, "G98"), ("haas_umc750", FANUC, "G98"), ("xyzac_trt", PROGRAMS[2][1], "G99")],
)
def test_a_cycle_relies_on_where_it_ends(machine: str, text: str, word: str, tmp_path: Path) -> None:
    text = text.format(said=f" G90 G17 G40 G94 G80 {PLANE_OFF[machine]}")
    drilled = text.replace(MOVES, CYCLE)
    assert assumed(machine, drilled.format(""), tmp_path) == (word,)
    for said in ("G98 ", "G99 ", "G99\n", "G98\n"):
        assert assumed(machine, drilled.format(said), tmp_path) == ()
    early = drilled.replace("T1 M6", f"{word}\nT1 M6")
    assert assumed(machine, early.format(""), tmp_path) == ()
    files = [tmp_path / f"{name}.nc" for name in ("said", "unsaid", "early")]
    for file, program in zip(files, (drilled.format(f"{word} "), drilled.format(""), early.format("")), strict=True):
        file.write_text(program, encoding="utf-8")
    assert not trunnion.diff(files[0], files[1], machine=machine).same
    assert trunnion.diff(files[0], files[2], machine=machine).same


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "xyzac_trt"])
def test_a_move_at_the_part_relies_on_the_length_being_off(machine: str, tmp_path: Path) -> None:
    text = (FANUC if "xyz" not in machine else PROGRAMS[2][1]).replace("G43 H1\n", "")
    said = f" G90 G17 G40 G94 G80 {PLANE_OFF[machine]}"
    assert assumed(machine, text.format(said=said), tmp_path) == ("G49",)
    assert assumed(machine, text.format(said=said + "\nG49"), tmp_path) == ()
    home = text.format(said=said).replace("T1 M6", "G53 G0 Z0.\nT1 M6").replace("G54 S500", "G49 G54 S500")
    assert assumed(machine, home, tmp_path) == (), "positions of the machine have no length"


def test_a_rotation_that_was_left_on_is_assumed_off(tmp_path: Path) -> None:
    text = FANUC.format(said=" G90 G17 G40 G94 G80{}")
    files = [tmp_path / "with.nc", tmp_path / "without.nc"]
    for file, said in zip(files, (" G69", ""), strict=True):
        file.write_text(text.format(said), encoding="utf-8")
    assert assumed("matsuura_mx330", files[1].read_text(encoding="utf-8"), tmp_path) == ("G69",)
    assert not trunnion.diff(*files, machine="matsuura_mx330").same


def test_centres_of_arcs_rely_on_how_they_count_on_a_linuxcnc(tmp_path: Path) -> None:
    text = PROGRAMS[2][1].format(said=" G90 G17 G40 G94 G80 M429")
    arc = text.replace("X10.\n", "G2 X10. Y0. I5. J0.\n")
    assert assumed("xyzac_trt", arc, tmp_path) == ("G91.1",)
    assert assumed("xyzac_trt", arc.replace("I5. J0.", "R5."), tmp_path) == ()
    assert assumed("xyzac_trt", arc.replace("T1", "G91.1 T1"), tmp_path) == ()


LINUXCNC = PROGRAMS[2][1].replace("T1 M6", "{before}T1 M6")
SAID = " G90 G17 G40 G94 G80 G49"


@pytest.mark.parametrize("machine", ["linuxcnc_5axis", "xyzac_trt"])
def test_all_positions_of_a_linuxcnc_rely_on_its_kinematics(machine: str, tmp_path: Path) -> None:
    assert assumed(machine, LINUXCNC.format(said=SAID, before=""), tmp_path) == ("M429",)
    assert assumed(machine, LINUXCNC.format(said=SAID, before="M429\n"), tmp_path) == ()
    home = LINUXCNC.format(said=SAID, before="G53 G0 Z0.\nM429\n")
    assert assumed(machine, home, tmp_path) == ("M429",), "under TCP G53 goes to positions of the tip"


def test_a_linuxcnc_without_tcp_has_no_kinematics_to_switch(tmp_path: Path) -> None:
    machine = tmp_path / "plain.toml"
    machine.write_text('extends = "xyzac_trt"\n[control]\ntcp = false\n', encoding="utf-8")
    assert assumed(str(machine), LINUXCNC.format(said=SAID, before=""), tmp_path) == ()


def test_rotary_axes_of_a_fidia_rely_on_tcp_being_off(tmp_path: Path) -> None:
    turns = OTHERS.format(said="G90 G17 G40 G69{}").replace("T1 M6", "G1 A0. C0. F500\n{}T1 M6")
    assert assumed("hs664rt", turns.format("", "G197\n"), tmp_path) == ("G197",)
    assert assumed("hs664rt", turns.format(" G197", ""), tmp_path) == ()
    machine = tmp_path / "head.toml"
    other = '[control.settings]\ntcp_on = "G96"\ntcp_off = "G97"\n'
    machine.write_text(f'extends = "hs664rt"\n{other}', encoding="utf-8")
    assert assumed(str(machine), turns.format("", ""), tmp_path) == ("G97",)


@pytest.mark.parametrize(
    ("axis", "words"), [("B10. C20.", ("ORIAXES", "ORIWKS")), ("A3=0.1 B3=0. C3=1.", ("ORIVECT", "ORIWKS"))]
)
def test_tcp_of_a_sinumerik_relies_on_how_the_tool_axis_turns(
    axis: str, words: tuple[str, ...], tmp_path: Path
) -> None:
    said = "G90 G17 G40 G94 G71 CYCLE800()"
    text = OTHERS.format(said=said).replace("M3\n", f"M3\nTRAORI\n{{}}G0 X0. Y0. Z60. {axis}\n", 1)
    assert assumed("yl569", text.format(""), tmp_path) == words
    for said in ("ORIAXES ORIWKS", "ORIVECT ORIMKS"):
        assert assumed("yl569", text.format(f"{said}\n"), tmp_path) == ()
    assert assumed("yl569", text.format(f"{words[0]}\n"), tmp_path) == ("ORIWKS",)
    assert assumed("yl569", text.replace(f" {axis}", "").format(""), tmp_path) == (), "the tool axis stays"


def test_a_plane_of_the_rotary_position_that_was_left_on_is_assumed_off(tmp_path: Path) -> None:
    text = FANUC.format(said=" G90 G17 G40 G94 G80{}")
    for said, words in (("", ("G255",)), ("\nG255", ()), ("\nG53 G0 B0. C0.\nG254", ())):
        assert assumed("haas_umc750", text.format(said), tmp_path) == words, said
    own = tmp_path / "own.toml"
    own.write_text('extends = "haas_umc750"\n[control.reading]\nstart_modes = ["G69", "G255"]\n', encoding="utf-8")
    assert assumed(str(own), text.format(""), tmp_path) == ()
    own.write_text('extends = "matsuura_mx330"\n[control.reading]\nstart_modes = ["G255"]\n', encoding="utf-8")
    with pytest.raises(InputError, match="G255"):
        assumed(str(own), text.format(""), tmp_path)


def test_positions_of_a_sinumerik_rely_on_its_plane_being_off(tmp_path: Path) -> None:
    text = OTHERS.format(said="G90 G17 G40 G94 G71 TRAFOOF\n{}")
    assert assumed("yl569", text.format(""), tmp_path) == ("CYCLE800()",)
    assert assumed("yl569", text.format("CYCLE800()\n"), tmp_path) == ()
    assert assumed("yl569", text.format("SUPA G0 Z0 D0\nCYCLE800()\nD1\n"), tmp_path) == ()


def test_what_only_a_skipped_block_says_is_assumed(tmp_path: Path) -> None:
    text = FANUC.format(said=" G17 G40 G69\n/G90 G94")
    assert assumed("matsuura_mx330", text, tmp_path) == ("G90", "G94")


def test_who_asks_for_start_modes_gets_an_error_and_a_definition_may_state_them(tmp_path: Path) -> None:
    program, machine = tmp_path / "part.nc", tmp_path / "mine.toml"
    program.write_text(FANUC.format(said=" G40 G94 G69 G80\nG54\nG28 A0. C0."), encoding="utf-8")
    head = 'extends = "matsuura_mx330"\n[proof]\nrequire = ["start_modes"]\n'
    machine.write_text(head, encoding="utf-8")
    found = trunnion.verify(program, machine=machine)
    (basis,) = (check for check in found.checks if not check.passed)
    assert (basis.key, "G90, G17" in basis.told) == ("basis", True)
    assert found.standing.told.endswith("; assumed: the control starts with G90, G17")
    machine.write_text(f'{head}[control.reading]\nstart_modes = ["G90", "G17"]\n', encoding="utf-8")
    assert trunnion.verify(program, machine=machine).standing.assumed == ()
    machine.write_text(f'{head}[control.reading]\nstart_modes = ["G91"]\n', encoding="utf-8")
    with pytest.raises(InputError, match="has G91, with which no program is taken to start"):
        trunnion.verify(program, machine=machine)
