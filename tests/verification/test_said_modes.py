"""``diff`` compares the modes that only one of two programs says, and those that no path shows."""

import re
from functools import cache
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.readers.families.heidenhain import words as klartext
from trunnion.readers.families.sinumerik import unseen_modes, words

CASES = TESTS / "data" / "cases"


@cache
def posted(machine: str, cl: str, folder: Path) -> str:
    program = folder / f"{machine}_{cl}.nc"
    trunnion.post(CASES / f"{cl}.cls", machine=machine, output=program)
    return program.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("posted")


def compared(folder: Path, machine: str, one: str, two: str, *, path: bool = False) -> trunnion.Comparison:
    paths = folder / "one.nc", folder / "two.nc"
    for file, text in zip(paths, (one, two), strict=True):
        file.write_text(text, encoding="utf-8")
    return trunnion.diff(*paths, machine=machine, path=path)


#: Machine, CL file, what is found, what takes its place the first time, what the difference says.
FAULTS = [
    ("yl569", "tilted_flood", " G17", "", "plane stated against not stated"),
    ("yl569", "tilted_flood", " G90", "", "distances stated against not stated"),
    ("yl569", "tilted_flood", " G94", "", "feed stated against not stated"),
    ("yl569", "tilted_flood", " G60", " G64", "path control G60 against G64"),
    ("yl569", "tilted_flood", " FNORM", "", "course of the feed FNORM against not stated"),
    ("yl569", "tilted_flood", " FNORM", " FNORM SOFT", "acceleration not stated against SOFT"),
    ("yl569", "tilted_flood", "_ORI_SEMIFIN", "_ORI_FINISH", "CYCLE832 mode 12 against mode 11"),
    ("yl569", "tilted_flood", 'CYCLE800(0,""', 'CYCLE800(0,"TC2"', "swivel data none, _FR 0 against TC2, _FR 0"),
    ("yl569", "tilted_flood", r"(TRAORI\nN\d+) G54", r"\1 ;", "work offset G54 against none since TRAORI"),
    ("yl569", "tilted_flood", r"M5(?=\nN\d+ ;End of Program)", "M3", "spindle off behind the last motion"),
    ("matsuura_mx330", "tilted_flood", " G17", "", "plane stated against not stated"),
    ("matsuura_mx330", "tilted_flood", " G90", "", "distances stated against not stated"),
    ("matsuura_mx330", "tilted_flood", r"G05\.1 Q1", "G05.1 Q0", "G5.1 Q1 against G5.1 Q0"),
    ("matsuura_mx330", "tilted_flood", r"M5(?=\nN\d+ M9\nN\d+ M30)", "M3", "spindle off behind the last motion"),
    ("haas_umc750", "tilted_flood", " G17", "", "plane stated against not stated"),
    ("xyzac_trt", "tilted_flood", r" G91\.1", "", "centres stated against not stated"),
    ("hs664rt", "tilted_flood", r"G90", "M9", "distances stated against not stated"),
    ("dmu65", "tilted_flood", r"(M9\n\d+ L Z\+560 R0 FMAX M91\n\d+) PLANE RESET STAY", r"\1 M9", "plane is on"),
    ("dmu65", "contour", "PLANE RESET STAY", "M9", "tilted plane stated against not stated"),
    ("dmu65", "tilted_flood", "HSC-MODE:1", "HSC-MODE:0", "HSC-MODE 1 against 0"),
    ("yl569", "tilted_flood", r"\bM30\b", "R90=7 M30", "nothing against left to the next program: R90 = 7"),
    ("dmu65", "tilted_flood", "; DMG DMU 65", "QR9 = 7", "nothing against left to the next program: QR9 = 7"),
    ("matsuura_mx330", "tilted_flood", r"\bM30\b", "#500=7. M30", "nothing against left to the next program: #500 = 7"),
    ("xyzac_trt", "tilted_flood", r" G91\.1", " G91.1 #40=7", "nothing against left to the next program: #40 = 7"),
    ("yl569", "tilted_flood", r"\bM30\b", "M2", "end of the program by M30 against end of the program by M2"),
    ("dmu65", "tilted_flood", r"\bM30\b", "M2", "end of the program by M30 against end of the program by M2"),
    ("matsuura_mx330", "tilted_flood", r"\bM30\b", "M2", "end of the program by M30 against end of the program by M2"),
    ("haas_umc750", "tilted_flood", r"\bM30\b", "M2", "end of the program by M30 against end of the program by M2"),
    ("xyzac_trt", "tilted_flood", r"\bM2\b", "M30", "end of the program by M2 against end of the program by M30"),
    ("hs664rt", "tilted_flood", r"\bM02\b", "M30", "end of the program by M2 against end of the program by M30"),
    ("dmu65", "contour", r"(TOOL CALL \d+) Z", r"\1", "tool axis stated against not stated"),
    ("yl569", "contour", r"(N\d+) (G1 )", r"\1 G9 \2", "exact stop in one block not stated against 1"),
    ("matsuura_mx330", "contour", r"(N\d+) (G1 )", r"\1 G9 \2", "exact stop in one block not stated against 1"),
    ("haas_umc750", "contour", r"(N\d+) (G1 )", r"\1 G9 \2", "exact stop in one block not stated against 1"),
    ("yl569", "contour", " FNORM", " FNORM WALIMOF", "limits of the working area not stated against WALIMOF"),
    ("yl569", "contour", " FNORM", " FNORM ACC[X]=50", "ACC[X] not stated against 50"),
    ("yl569", "contour", r"(N\d+) (G1 )", r"\1 STOPRE\n\2", "STOPRE not stated against 1"),
    ("yl569", "contour", r"(N\d+) (G41)", r"\1 G451 \2", "corners of the contour not stated against G451"),
    ("xyzac_trt", "contour", " G91.1", " G91.1 M49", "override of the feed not stated against P0"),
    ("xyzac_trt", "contour", r"\nN\d+ G1 ", r"\nM62 P1\g<0>", "digital output 1 not stated against M62"),
    ("dmu65", "contour", r"\n(\d+) L ([^\n]* F\d)", r"\n\1 M94 C\n\1 L \2", "M94 C not stated against 1"),
    ("dmu65", "contour", r"\n(\d+) L ([^\n]* F\d)", r"\n\1 M108\n\1 L \2", "oversize not stated against M108"),
    ("matsuura_mx330", "contour", r"(G41 D2\n[^\n]*\n)", r"\1M8\nM8\n", "2 blocks without motion within radius comp"),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "cl", "found", "new", "told"), FAULTS)
def test_a_mode_that_only_one_program_says_is_a_difference(
    machine: str, cl: str, found: str, new: str, told: str, folder: Path
) -> None:
    text = posted(machine, cl, folder)
    # A plane may be reset twice before the first cut.
    pattern = re.escape(found) if found.startswith("CYCLE") else found
    changed = re.sub(pattern, new, text, count=0 if found == "PLANE RESET STAY" else 1)
    assert changed != text
    result = compared(folder, machine, text, changed)
    assert not result.same
    assert result.first is not None
    assert told in result.first.text


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "dmu65"])
def test_a_mode_said_again_is_none(machine: str, folder: Path) -> None:
    text = posted(machine, "contour", folder)
    again = {"yl569": ("N440", "N435 G17 G90 G94 G60\nN440"), "matsuura_mx330": ("N120", "N115 G17 G90 G94\nN120")}
    old, new = again.get(machine, (" PLANE RESET STAY", " PLANE RESET STAY\n3 PLANE RESET STAY"))
    assert old in text
    assert compared(folder, machine, text, text.replace(old, new, 1)).same


#: Control, what stands before the first work offset, and behind it, in place of the other order.
TURNS_BEFORE = [
    ("yl569", r"(N\d+ G0 B[^\n]*\n)((?:N\d+ [^\n]*\n){3})(N\d+ G54\n)"),
    ("matsuura_mx330", r"()(N\d+ G54\n)(N\d+ G0 A[^\n]*\n)"),
    ("haas_umc750", r"()(N\d+ G54\n)(N\d+ G0 B[^\n]*\n)"),
]


@pytest.mark.parametrize(("machine", "order"), TURNS_BEFORE)
def test_rotary_axes_before_any_work_offset_are_elsewhere_than_behind_it(
    machine: str, order: str, folder: Path
) -> None:
    text = posted(machine, "contour", folder)
    changed = re.sub(order, r"\3\1\2", text, count=1)
    assert changed != text
    result = compared(folder, machine, text, changed)
    assert result.first is not None
    assert "stated before any work offset" in result.first.text


def test_every_word_of_a_sinumerik_without_effect_on_the_path_has_a_mode_or_does_nothing() -> None:
    # Those that show in tolerances, tools and feeds, or are errors.
    elsewhere = words.TOLERANCES | words.TOOL_DELTAS | {"OTOL", "FB", "FD", "FDA", "FZ", "FP", "G9"}
    g_words = {f"G{code}" for code in words.G_WITHOUT_PATH_EFFECT}
    known = words.WITHOUT_PATH_EFFECT | words.WITHOUT_PATH_EFFECT_VALUES | words.WITHOUT_PATH_EFFECT_CALLS | g_words
    tables = (elsewhere, unseen_modes.MODES.keys(), unseen_modes.VALUES, unseen_modes.ONCE, unseen_modes.NOTHING)
    assert known == set().union(*tables)
    assert sum(len(each) for each in tables) == len(known)


def test_every_m_function_of_klartext_without_effect_on_the_path_has_a_mode_or_acts_once() -> None:
    warned = {code for code, (_, error) in klartext.M_NOT_SIMULATED.items() if not error}
    known = {*klartext.M_WITHOUT_PATH_EFFECT, *warned}
    of_display, refused = {145}, {143, 150}
    assert known - of_display == (klartext.M_UNSEEN_MODES.keys() | klartext.M_UNSEEN_ONCE) - refused


#: The first leg of an approach, by machine, and the same place in two legs or from a greater height.
APPROACHES = [
    ("yl569", r"(N\d+ G0 X\S+ Y\S+) (Z)(\S+)", [r"\1\n\2\3", r"\1 Z99.\nZ\3"]),
    ("matsuura_mx330", r"(N\d+ G43 H\d+) (Z)(\S+)", [r"\1 Z99.\nZ\3"]),
    ("dmu65", r"(\n\d+ L X\S+ Y\S+) (Z)(\S+) FMAX", [r"\1 FMAX\1 \2\3 FMAX", r"\1 Z+99 FMAX\1 \2\3 FMAX"]),
]


@pytest.mark.parametrize(("machine", "leg", "others"), APPROACHES)
def test_a_path_may_be_approached_from_home_in_more_legs(
    machine: str, leg: str, others: list[str], folder: Path
) -> None:
    text = posted(machine, "contour", folder)
    low = re.sub(r"Z\+?99\.?", "Z-99", others[-1])
    for each, is_same in [*((other, True) for other in others), (low, False)]:
        changed = re.sub(leg, each, text, count=1)
        assert changed != text
        assert compared(folder, machine, text, changed, path=True).same is is_same, each
        if is_same and "99" not in each:
            assert not compared(folder, machine, text, changed).same


#: Programs of two cuts, by machine: what stands before them, and behind.
CUTS = {
    "haas_umc750": ("G21 G17 G90 G94 G54\nT1 M6\nS500 M3\nG43 H1 Z50.\n", "\nG1 X10. F100.\nX20.\nG49\nM30\n"),
    "matsuura_mx330": ("G21 G17 G90 G94 G54\nT1 M6\nS500 M3\nG43 H1 Z50.\n", "\nG1 X10. F100.\nX20.\nG49\nM30\n"),
    "yl569": ("G17 G90 G71 G94 G54\nT1 D1\nM6\nS500 M3\n", "\nM3\nG1 X10 F100\nX20\nTRAFOOF\nM30\n"),
    "ucp800": ("BEGIN PGM A MM\nTOOL CALL 1 Z S500\nM3\n", "\nL X+10 R0 F100\nL X+20\nM129\nM30\nEND PGM A MM\n"),
    "xyzac_trt": ("G21 G17 G90 G94 G54\nT1 M6\nS500 M3\nG43\n", "\nM3\nG1 X10 F100\nX20\nM2\n"),
}

#: Two ways to say a mode, and what the comparison says of them; empty: they are the same.
WAYS = [
    ("haas_umc750", "G187 P1", "G187 P3", "smoothness G187 P1 against G187 P3"),
    ("haas_umc750", "G187 P1 E0.1", "G187 P3 E0.1", "smoothness G187 P1 E0.1 against G187 P3 E0.1"),
    ("haas_umc750", "G187", "", "smoothness G187 against not stated"),
    ("haas_umc750", "G103 P1", "G103 P9", "look-ahead G103 P1 against G103 P9"),
    ("xyzac_trt", "G64 P0.1", "G64 P0.05 Q0.1", "tolerances of G64 P0.1 Q0.1 against P0.05 Q0.1"),
    ("xyzac_trt", "G64 P0.1", "G64 P0.1 Q0.1", ""),
    ("xyzac_trt", "G64", "G64 P0", ""),
    ("xyzac_trt", "M100 P1", "M100 P2", "M100 P1 against P2"),
    ("xyzac_trt", "M19 R0", "M19 R90", "M19 R0 against R90"),
    ("ucp800", "M128 F1000", "M128 F2000", "compensating motions F1000 against F2000"),
    ("ucp800", "M128", "M128 F2000", "compensating motions stated against F2000"),
    ("ucp800", "M128", "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", ""),
    ("ucp800", "M128", "FUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS", "tool axis under TCP AXIS POS against AXIS SPAT"),
    ("yl569", "SPOS=0", "SPOS=90", "SPOS 0 against 90"),
    ("yl569", "SPOS[2]=0", "SPOS[2]=90", "SPOS[2] 0 against 90"),
    ("yl569", "M2=3", "M2=4", "M2 3 against 4"),
    ("yl569", "S2=100", "S2=200", "S2 100 against 200"),
    ("yl569", "TRAORI\nORIWKS", "TRAORI\nORIMKS", "tool axis under TCP ORIWKS against ORIMKS"),
    ("yl569", "ORIWKS", "ORIMKS", ""),
    ("yl569", "TRAORI\nORIVECT", "TRAORI\nORIPLANE", ""),
    ("matsuura_mx330", "G43.4 H1", "G43.5 H1", "tool axis under TCP G43.4 against G43.5"),
    ("matsuura_mx330", "G43.4 H1", "G43.4 H1 P0", ""),
]  # fmt: skip


def test_two_ways_to_say_a_mode_that_no_path_shows_are_a_difference(tmp_path: Path) -> None:
    wrong = []
    for machine, one, two, told in WAYS:
        before, behind = CUTS[machine]
        found = compared(tmp_path, machine, before + one + behind, before + two + behind)
        said = "" if found.first is None else found.first.text
        if not said.startswith(told) or bool(said) != bool(told):
            wrong.append((machine, one, two, said))
    assert not wrong


@pytest.mark.parametrize(
    ("machine", "word", "told"),
    [
        ("yl569", "SETAL(65000)", "SETAL(65000)"),
        ("dmu65", "FN 14: ERROR=1000", "FN 14"),
        ("dmu65", "FN 20: WAIT FOR SYNC", "FN 20"),
        ("dmu65", "FN 29: PLC=+1", "FN 29"),
        ("matsuura_mx330", "G91 G30 P2 Z0.\nG90", "G30 P2"),
    ],
)
def test_what_stops_the_program_or_goes_to_another_reference_position_is_a_difference(
    machine: str, word: str, told: str, folder: Path
) -> None:
    lines = posted(machine, "tilted_flood", folder).splitlines()
    at = max(k for k, line in enumerate(lines) if re.search(r"SUPA G0 Z|G53 G0 Z|L Z\S+ R0 FMAX M91", line))
    if told == "G30 P2":
        one, two = [*lines[:at], "G91 G28 Z0.", "G90", *lines[at + 1 :]], [*lines[:at], word, *lines[at + 1 :]]
    else:
        at = max(k for k, line in enumerate(lines[:at]) if re.search(r"\bX", line))
        one, two = lines, [*lines[:at], word, *lines[at:]]
    found = compared(folder, machine, "\n".join([*one, ""]), "\n".join([*two, ""]))
    assert not found.same
    assert found.first is not None
    assert told in found.first.text
