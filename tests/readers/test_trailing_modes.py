"""Modes that a program sets behind its last motion are told, as far as its control keeps them for the next one."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.errors import Severity

#: A machine by its control, the first blocks of its programs, a motion, and their end.
PROGRAMS = {
    "matsuura_mx330": ("%\nO0001\nG21 G17 G90 G94 G40 G80 G54\nG0 X0. Y0.", "G1 X{}. F100", "M30\n%"),
    "haas_umc750": ("%\nO00001\nG21 G17 G90 G94 G40 G80 G54\nG0 X0. Y0.", "G1 X{}. F100.", "M30\n%"),
    "xyzac_trt": ("G21 G17 G90 G94 G40 G80 G54\nG0 X0 Y0", "G1 X{} F100", "M2"),
    "hs664rt": ("G90\nG71 G17 G40\nG55 O1\nG0 X0. Y0.", "G1 X{}. F100", "M30"),
    "yl569": ("G710 G17 G90 G94 G54\nG0 X0 Y0", "G1 X{} F100", "M30"),
    "dmu65": ("BEGIN PGM A MM\nTOOL CALL 1 Z S500\nL X+0 Y+0 R0 FMAX", "L X+{} F100", "END PGM A MM"),
}

#: What outlives the end of a program, with the word that sets it back.
KEPT = [
    ("matsuura_mx330", "G20", "G21"), ("matsuura_mx330", "G23", "G22"), ("haas_umc750", "G20", "G21"),
    ("xyzac_trt", "G20", "G21"), ("xyzac_trt", "G90.1", "G91.1"), ("xyzac_trt", "G43 H1", "G49"),
]  # fmt: skip

#: What may outlive it: that depends on a parameter, or nobody says.
IN_DOUBT = [
    ("matsuura_mx330", "G91", "G90"), ("matsuura_mx330", "G18", "G17"), ("matsuura_mx330", "G19", "G17"),
    ("matsuura_mx330", "G95", "G94"), ("matsuura_mx330", "G93", "G94"), ("matsuura_mx330", "G41 D1", "G40"),
    ("matsuura_mx330", "G55", "G54"), ("matsuura_mx330", "G54.1 P2", "G54"), ("matsuura_mx330", "G43 H1", "G49"),
    ("matsuura_mx330", "G66 P9000", "G67"), ("haas_umc750", "G91", "G90"),
    ("dmu65", "M118 X1", "M118"), ("dmu65", "M136", "M137"), ("dmu65", "M116", "M117"), ("dmu65", "M89", "M99"),
    ("dmu65", "M120 LA10", "M120"),
    ("hs664rt", "G91", "G90"), ("hs664rt", "G18", "G17"), ("hs664rt", "G42 D1", "G40"),
    ("hs664rt", "G55 O2", "G55 O1"), ("yl569", "G55", "G54"), ("yl569", "G505", "G54"), ("yl569", "G505", "G500"),
]  # fmt: skip

#: What the control sets back by itself at the end.
SET_BACK = [
    *(("xyzac_trt", word) for word in ("G91", "G18", "G95", "G93", "G41 D1", "M49", "G55")),
    *(("yl569", word) for word in ("G700", "G70", "G91", "G19", "G95", "G41", "G500", "MCALL CYCLE81(10,0,2,-5)")),
]


def left(folder: Path, machine: str, *lines: str) -> list[tuple[Severity, int, str]]:
    """What NC351 tells of a program with these lines behind its first position: how grave, where, and the text."""
    program = folder / "part.nc"
    head, _, end = PROGRAMS[machine]
    program.write_text("\n".join((head, *lines, end)) + "\n", encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    return [(each.severity, each.line, each.text) for each in run.diagnostics if each.code == "NC351"]


def cut(machine: str, x: int) -> str:
    return PROGRAMS[machine][1].format(x)


@pytest.mark.parametrize(("machine", "word", "back", "severity"), [
    *((*each, Severity.ERROR) for each in KEPT), *((*each, Severity.WARNING) for each in IN_DOUBT),
])  # fmt: skip
def test_a_mode_behind_the_last_motion_is_told_unless_it_is_set_back(
    tmp_path: Path, machine: str, word: str, back: str, severity: Severity
) -> None:
    ((found, line, text),) = left(tmp_path, machine, cut(machine, 10), word)
    name = word.split()[0]
    assert found is severity
    assert name in text
    assert ("may begin with it (" in text) is (severity is Severity.WARNING)
    in_force_at_end = name == "G66"
    assert line == PROGRAMS[machine][0].count("\n") + (4 if in_force_at_end else 3)
    assert left(tmp_path, machine, cut(machine, 10), word, back) == []
    if name not in ("G66", "G93", "M89", "G41", "G42", "G23"):  # these need more than a motion; G23 counts with any
        told = [text for _, _, text in left(tmp_path, machine, word, cut(machine, 10))]
        # A tool length has its use, and is left on all the same.
        in_use = ["ends with G43 on"] if name == "G43" else []
        assert [text.partition(",")[0] for text in told] == in_use
        assert left(tmp_path, machine, word, cut(machine, 10), back) == []


@pytest.mark.parametrize(("machine", "word"), [("matsuura_mx330", "G43.4 H1"), ("haas_umc750", "G234 H1")])
def test_tcp_that_is_left_on_is_told(tmp_path: Path, machine: str, word: str) -> None:
    ((severity, _, text),) = left(tmp_path, machine, word, cut(machine, 10))
    assert (severity, text.partition(",")[0]) == (Severity.WARNING, f"ends with {word.split()[0]} on")
    assert left(tmp_path, machine, word, cut(machine, 10), "G49") == []


@pytest.mark.parametrize(("machine", "word"), SET_BACK)
def test_what_the_end_of_a_program_sets_back_is_not_told(tmp_path: Path, machine: str, word: str) -> None:
    assert left(tmp_path, machine, cut(machine, 10), word) == []


@pytest.mark.parametrize(("machine", "word"), [(machine, word) for machine, word, _ in KEPT])
def test_a_program_that_only_sets_up_the_machine_may_set_its_modes(tmp_path: Path, machine: str, word: str) -> None:
    program = tmp_path / "part.nc"
    program.write_text(f"%\nO0001\n{word}\nM30\n%\n" if machine != "xyzac_trt" else f"{word}\nM2\n", encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    assert not [each for each in run.diagnostics if each.code == "NC351"]


@pytest.mark.parametrize(("unit", "told"), [("inch", "G21"), ("mm", "G20")])
def test_a_program_may_go_back_to_the_unit_that_the_control_counts_in(tmp_path: Path, unit: str, told: str) -> None:
    machine = tmp_path / "ours.toml"
    machine.write_text(f'extends = "matsuura_mx330"\n[control.reading]\nunits = "{unit}"\n', encoding="utf-8")
    program = tmp_path / "part.nc"
    for used, last in (("G20", "G21"), ("G21", "G20")):
        program.write_text(f"%\nO0001\n{used} G90 G54\nG0 X0.\n{last}\nM30\n%\n", encoding="utf-8")
        run = trunnion.read_program(program, machine=machine)
        found = [each.text.split()[0] for each in run.diagnostics if each.code == "NC351"]
        assert found == ([told] if last == told else [])


@pytest.mark.parametrize(
    ("machine", "blocks", "told"),
    [
        ("matsuura_mx330", "G81 X1. Z-1. R1. F100", True), ("matsuura_mx330", "G81 X1. Z-1. R1. F100\nG80", False),
        ("matsuura_mx330", "G81 X1. Z-1. R1. F100\nG0 Z9.", False), ("hs664rt", "G81 X1. Z5. R2. E-1. F100", True),
        ("hs664rt", "G81 X1. Z5. R2. E-1. F100\nG80", False), ("matsuura_mx330", "G91 G28 Z0", False),
    ],
)  # fmt: skip
def test_a_cycle_in_force_at_the_end_is_told(tmp_path: Path, machine: str, blocks: str, told: bool) -> None:
    found = left(tmp_path, machine, *blocks.split("\n"))
    assert [text[:16] for _, _, text in found] == (["ends with G81 on"] if told else [])


@pytest.mark.parametrize("word", ["G28.1", "G30.1"])
def test_a_position_that_the_next_program_goes_to_is_told(tmp_path: Path, word: str) -> None:
    ((severity, _, text),) = left(tmp_path, "xyzac_trt", cut("xyzac_trt", 10), word)
    assert severity is Severity.ERROR
    assert text.startswith(f"{word} behind the last motion changes the position that {word[:3]} goes to in the next")
    ((severity, _, text),) = left(tmp_path, "xyzac_trt", word, cut("xyzac_trt", 10))
    assert (severity, text) == (Severity.WARNING, f"{word} stays in the control behind the end of the program")


def test_no_tool_length_is_left_on_by_h0(tmp_path: Path) -> None:
    assert left(tmp_path, "matsuura_mx330", cut("matsuura_mx330", 10), "G43 H0") == []
    assert len(left(tmp_path, "matsuura_mx330", cut("matsuura_mx330", 10), "G43 H1")) == 1


SHOP = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8").replace("BORHED/40.5,DEEP\n", "")


def ours(folder: Path, base: str, templates: str) -> Path:
    machine = folder / "ours.toml"
    machine.write_text(f'extends = "{base}"\n[control.templates]\n{templates}\n', encoding="utf-8")
    (folder / "part.cls").write_text(SHOP, encoding="utf-8")
    return machine


@pytest.mark.parametrize(("base", "word"), [("matsuura_mx330", "G20"), ("xyzbc_trt", "G20"), ("matsuura_mx330", "G23")])
def test_a_program_whose_foot_leaves_it_to_the_next_one_is_refused(tmp_path: Path, base: str, word: str) -> None:
    machine = ours(tmp_path, base, f"program_end = '''\n{word}\nM30\n%\n'''")
    with pytest.raises(trunnion.RefusedError, match=f"{word} behind the last motion"):
        trunnion.post(tmp_path / "part.cls", machine=machine)


def test_post_warns_of_what_a_foot_may_leave(tmp_path: Path) -> None:
    machine = ours(tmp_path, "matsuura_mx330", "program_end = '''\nG91\nM30\n%\n'''")
    posted = trunnion.post(tmp_path / "part.cls", machine=machine)
    assert posted.passed
    (problem,) = posted.problems
    assert (problem.code, problem.severity) == ("NC351", Severity.WARNING)
    assert "G91 behind the last motion" in problem.what
    assert "parameter 3402" in problem.what


#: Moves that use nothing of what a program has set: to machine positions, and of a rotary axis alone.
HOMES = {
    "matsuura_mx330": ("G53 G0 Z0.", "G91 G28 Z0.\nG90", "G0 C0."), "haas_umc750": ("G53 G0 Z0.", "G0 C0."),
    "xyzac_trt": ("G53 G0 Z0", "G0 C0"),
    "dmu65": ("L Z+560 R0 FMAX M91", "L C+0 R0 FMAX", "M140 MB MAX"),
}  # fmt: skip

#: Shifts, planes and stored offsets, with what sets them back.
SET = [
    ("matsuura_mx330", "G10 L2 P1 X5.", ""), ("matsuura_mx330", "G52 X5.", "G52 X0. Y0. Z0."),
    ("matsuura_mx330", "G92 Z7.", ""), ("matsuura_mx330", "G68 X0. Y0. R30.", "G69"),
    ("xyzac_trt", "G92 X5", "G92.1"), ("xyzac_trt", "G52 X5", "G52 X0"), ("xyzac_trt", "G10 L20 P1 X0", ""),
    ("dmu65", "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+5", "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+0"),
    ("dmu65", "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X", "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1"),
    ("dmu65", "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30", "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0"),
    ("dmu65", "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2", "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 1"),
    ("dmu65", "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+30 C+0",
     "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+0 C+0\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1"),
    ("dmu65", "PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY", "PLANE RESET STAY"),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "words", "back"), SET)
def test_a_shift_that_only_machine_positions_follow_is_refused(
    tmp_path: Path, machine: str, words: str, back: str
) -> None:
    for home in HOMES[machine]:
        ((severity, _, text),) = left(tmp_path, machine, cut(machine, 10), words, home)
        assert severity is Severity.ERROR, text
        assert [each[0] for each in left(tmp_path, machine, cut(machine, 10), home, words)] == [Severity.ERROR]
        if back:
            assert left(tmp_path, machine, cut(machine, 10), words, home, back) == []
            assert left(tmp_path, machine, cut(machine, 10), words, back, home) == []


@pytest.mark.parametrize(("machine", "word"), [
    (machine, word) for machine, word, _ in (*KEPT, *IN_DOUBT)
    if word.split()[0] not in ("G91", "G66", "M89") and machine in HOMES
])  # fmt: skip
def test_a_mode_that_only_machine_positions_follow_is_told(tmp_path: Path, machine: str, word: str) -> None:
    home = HOMES[machine][0]
    behind = left(tmp_path, machine, cut(machine, 10), home, word)
    before = left(tmp_path, machine, cut(machine, 10), word, home)
    assert len(behind) == 1
    assert [(severity, text) for severity, _, text in before] == [(severity, text) for severity, _, text in behind]


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
def test_g91_has_its_use_in_front_of_g28(tmp_path: Path, machine: str) -> None:
    assert left(tmp_path, machine, cut(machine, 10), "G91 G28 Z0.") == []
    assert len(left(tmp_path, machine, cut(machine, 10), "G90 G53 G0 Z0.", "G91")) == 1


@pytest.mark.parametrize(("machine", "words"), [
    *((machine, words) for machine, words, _ in SET), *((machine, word) for machine, word, _ in KEPT),
])  # fmt: skip
def test_a_program_that_never_cuts_is_not_refused_for_what_it_sets(tmp_path: Path, machine: str, words: str) -> None:
    """PROGRAMS position at rapid; without that, words of a set-up are what it is for."""
    for before in ((words,), (HOMES[machine][0], words), (words, HOMES[machine][0])):
        assert {each[0] for each in left(tmp_path, machine, *before)} <= {Severity.WARNING}
    program = tmp_path / "setup.nc"
    if machine != "dmu65" and "G10" in words:
        end = PROGRAMS[machine][2]
        percent = "%\nO0001\n" if "%" in end else ""
        program.write_text(f"{percent}{HOMES[machine][0]}\n{words}\n{end}\n", encoding="utf-8")
        run = trunnion.read_program(program, machine=machine)
        assert not [each for each in run.diagnostics if each.code == "NC351"]


def test_a_mode_that_is_left_and_taken_up_again_is_as_it_was_used(tmp_path: Path) -> None:
    assert left(tmp_path, "matsuura_mx330", "G18", cut("matsuura_mx330", 10), "G17", "G18") == []
    ((_, _, text),) = left(tmp_path, "matsuura_mx330", "G18", cut("matsuura_mx330", 10), "G17", "G19")
    assert text.startswith("G19 ")


def preset(number: int) -> str:
    return f"CYCL DEF 247 DATUM SETTING Q339=+{number}"


def test_another_preset_than_that_of_the_head_is_told(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    for last, told in (((1,), []), ((3,), [3]), ((3, 1), []), ((1, 3), [3])):
        home = HOMES["dmu65"][0]
        lines = ("BEGIN PGM A MM", "TOOL CALL 1 Z S500", preset(1), "L X+0 Y+0 R0 FMAX", preset(2), cut("dmu65", 10))
        text = "\n".join((*lines, home, *map(preset, last), "END PGM A MM"))
        program.write_text(text + "\n", encoding="utf-8")
        found = [each for each in trunnion.read_program(program, machine="dmu65").diagnostics if each.code == "NC351"]
        assert [each.text.split(" behind")[0] for each in found] == [f"cycle 247 with preset {k}" for k in told]
        assert all(each.severity is Severity.ERROR for each in found)


def test_the_end_of_the_program_ends_the_plane_of_the_rotary_position(tmp_path: Path) -> None:
    assert left(tmp_path, "haas_umc750", cut("haas_umc750", 10), "G53 G0 Z0.", "G254") == []


@pytest.mark.parametrize(("words", "back"), [
    (words, back) for machine, words, back in SET
    if machine == "dmu65" and not words.startswith(("PLANE", "CYCL DEF 19"))
])  # fmt: skip
def test_a_datum_in_use_that_nothing_ends_is_warned_of(tmp_path: Path, words: str, back: str) -> None:
    """A rotation before a retract in Z changes no path, so that no other check and no comparison sees it."""
    up = "L Z+100 R0 FMAX"
    ((severity, _, text),) = left(tmp_path, "dmu65", cut("dmu65", 10), words, up)
    assert severity is Severity.WARNING
    assert text.startswith("ends with a datum of cycles 7, 8, 10, 11 or 26 on")
    assert left(tmp_path, "dmu65", cut("dmu65", 10), words, up, back) == []
