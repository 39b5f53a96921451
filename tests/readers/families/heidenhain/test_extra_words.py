"""Words that a Klartext block has no use for: none is dropped without a word about it."""

from pathlib import Path

import pytest

from tests.support.extra_words import without_use
from tests.support.reading import Runner, close

FRAME = (
    "BEGIN PGM A MM\nTOOL CALL 5 Z S500\nL X+0 Y+0 Z+50 R0 FMAX M3\nM8\nL X+5 F200\n{lines}\nL X+30 Y+7\nL Z+60\nM30\n"
    "LBL 9\nL IX+1\nLBL 0\nLBL 5\nLBL 0\nEND PGM A MM\n"
)
DRILL = "CYCL DEF 200 D Q200=2 Q201=-8 Q206=150 Q202=8 Q210=0 Q203=0 Q204=50 Q211=0"
PECK = "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 DIST2{}\nCYCL DEF 1.2 DEPTH-5\nCYCL DEF 1.3 PLNGNG5\nCYCL DEF 1.4 DWELL0\n"
PECK += "CYCL DEF 1.5 F100"
PLANES = (
    "PLANE SPATIAL SPA+0 SPB+0 SPC+30 STAY",
    "PLANE SPATIAL SPA+0 SPB+0 SPC+30 TURN MB MAX FMAX",
    "PLANE SPATIAL SPA+0 SPB+0 SPC+30 MOVE DIST20 F1000",
    "PLANE EULER EULPR0 EULNU10 EULROT0 STAY",
    "PLANE VECTOR BX1 BY0 BZ0 NX0 NY0 NZ1 STAY",
    "PLANE POINTS P1X0 P1Y0 P1Z0 P2X1 P2Y0 P2Z0 P3X0 P3Y1 P3Z0 STAY",
    "PLANE RELATIV SPC+10 STAY",
    "PLANE AXIAL C+10 STAY",
    "PLANE RESET STAY",
)
BLOCKS = (
    "L X+10 Y+4",
    "CC X+0 Y+0\nLP PR+10 PA+30",
    "CC X+10 Y+0\nC X+15 Y+0 DR+",
    "CC X+10 Y+0\nCP IPA+90 DR+",
    "CR X+15 Y+0 R+5 DR+",
    "CT X+15 Y+5",
    "CC X+10 Y+10\nCTP PR+10 PA+30",
    "CC X+10 Y+5",
    "L X+20\nRND R2|\nL Y+20",
    "L X+20\nCHF 2|\nL Y+20",
    "APPR LT X+20 Y+5 LEN5|\nL X+40",
    "L X+20\nDEP LT LEN5",
    "TOOL CALL 6 Z S900",
    "TOOL DEF 7",
    "TOOL DEF 7 L+0 R+5",
    "BLK FORM 0.1 Z X-50 Y-50 Z-20",
    "BLK FORM 0.1 Z X-50 Y-50 Z-20\nBLK FORM 0.2 X+50 Y+50 Z+0",
    "FN 0: Q1 = +5",
    "FN 1: Q1 = +5 + +3",
    "FN 9: IF +1 EQU +2 GOTO LBL 5",
    "Q1 = 5 + 3",
    "STOP",
    "LBL 3",
    "LBL 0",
    "CALL LBL 9",
    "LBL 3\nL IX+1\nCALL LBL 3 REP 2",
    DRILL,
    f"{DRILL}\nCYCL CALL",
    f"{DRILL}\nCYCL CALL POS X+5 Y+5 Z+2",
    f"{DRILL}\nL X+20 M99",
    "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+1",
    "CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X",
    "CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 1",
    "CYCL DEF 10.0 D\nCYCL DEF 10.1 ROT+10",
    "CYCL DEF 11.0 D\nCYCL DEF 11.1 SCL0.9",
    "CYCL DEF 13.0 O\nCYCL DEF 13.1 ANGLE 0",
    "CYCL DEF 19.0 A\nCYCL DEF 19.1 A+0 B+0 C+30",
    "CYCL DEF 32.0 T\nCYCL DEF 32.1 T0.05",
    "CYCL DEF 247 B Q339=+1",
    PECK.format("|"),
    PECK.format(""),
    "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
    "FUNCTION RESET TCPM",
    "FUNCTION MODE MILL",
    "M140 MB5",
    "X+7",
    *PLANES,
)
WORDS = (
    "X+77",
    "C+4",
    "Q8",
    "M5",
    "M0",
    "M9",
    "M30",
    "M4",
    "M136",
    "F",
    "F800",
    "S700",
    "RL",
    "R+3",
    "DR+",
    "SPA+10",
    "MOVE",
    "STAY",
    "SEQ+ SEQ-",
    "MB",
    "DIST5",
    "PR+3",
    "LEN5",
    "T5",
    "DL+1",
    "REP",
    "LBL 5",
    "Q203=+5",
    "TX1",
    "FOO",
    "FOO5",
    '"T"',
    "+",
)


def test_no_extra_word_is_dropped(tmp_path: Path) -> None:
    dropped, faulty, count = without_use(tmp_path, "mikron_600u", FRAME, dict.fromkeys(BLOCKS, WORDS))
    assert (dropped, faulty) == ({}, [])
    assert count == len(BLOCKS) * len(WORDS)


def test_the_title_of_a_cycle_is_a_text_but_no_block(tmp_path: Path) -> None:
    titles = ("CYCL DEF 7.0 DATUM|\nCYCL DEF 7.1 X+1", DRILL.replace(" D ", " DRILLING| "))
    words = ("M5", "M30", "F800", "X+77", "IZ-3", "S700", "R0", "RL", "FMAX", "T5")
    dropped, faulty, _ = without_use(tmp_path, "mikron_600u", FRAME, dict.fromkeys(titles, words))
    assert (dropped, faulty) == ({}, [])


@pytest.mark.parametrize(
    "line",
    [
        "L X+20 FMAX F800",
        "L X+20 R0 RL",
        "L X+20 DR+",
        "C X+20 Y+0 DR+ DR-",
        "L X+20 F",
        "L X+20 MAX",
        "L X+20 F100 F200",
        "CALL LBL 9 REP 2/M5",
        "TOOL CALL 6 Z Z",
        "M140 MB5 MB9",
        "C X+20 Y+0 DR+ FMAX",
        "PLANE RESET STAY SEQ+",
        "DEP LT LEN5 RL",
    ],
)
def test_of_two_words_that_exclude_each_other_none_is_dropped(line: str, run: Runner) -> None:
    assert run(f"L X+0 Y+0 Z+5 F100\nCC X+10 Y+0\nL X+10\n{line}\nLBL 9\nLBL 0").errors


@pytest.mark.parametrize(
    "line",
    [
        "L F MAX M3",
        "L X+2 F AUTO",
        "L X+2 R0 F MAX M8",
        "L FMAX",
        "L R0 FMAX M13",
        "LN X+2 NX0 NY0 NZ1 F9",
        "STOP M5",
        "CYCL DEF 13.0 O\nCYCL DEF 13.1 ANGLE+90",
        "CYCL DEF 9.0 V.ZEIT\nCYCL DEF 9.1 V.ZEIT 1,5",
    ],
)
def test_words_with_a_use_are_taken(line: str, run: Runner) -> None:
    assert run(f"TOOL CALL 1 Z S900 F200\nL X+0 Y+0 Z+5 F100\n{line}").diagnostics == ()


@pytest.mark.parametrize("line", ["Q201 = -13", "FN 0: Q201 = -13", "FN 2: Q201 = +0 - +13"])
def test_a_cycle_takes_the_parameters_as_they_are_when_it_is_called(line: str, run: Runner) -> None:
    found = run(f"L X+0 Y+0 Z+50 R0 FMAX M3\n{DRILL}\nL X+1 FMAX M99\n{line}\nL X+2 FMAX M99\nQ203 = 4\nL X+3 FMAX M99")
    assert found.diagnostics == ()
    at = found.tip[:, 0].round(6)
    close([found.tip[at == x, 2].min() for x in (1, 2, 3)], [-8, -13, -9])


def test_a_rapid_feed_of_a_cycle_is_its_own_until_the_parameter_is_set(run: Runner) -> None:
    ream = "CYCL DEF 201 R Q200=2 Q201=-8 Q206=150 Q211=0 Q208=MAX Q203=0 Q204=50"
    found = run(f"L X+0 Y+0 Z+50 R0 FMAX M3\n{ream}\nL X+1 FMAX M99\nQ208 = 77\nL X+2 FMAX M99")
    assert found.diagnostics == ()
    assert 77.0 not in found.feed[found.tip[:, 0] < 1.5]
    assert 77.0 in found.feed[found.tip[:, 0] > 1.5]


def test_a_parameter_that_is_lost_before_the_call_is_an_error(run: Runner) -> None:
    assert run(f"L Z+50 FMAX\n{DRILL}\nFN 18: SYSREAD Q201 = ID20 NR1\nL X+2 FMAX M99").errors


def test_both_ends_of_a_program_have_one_unit(run: Runner) -> None:
    for begin, end, wanted in (("MM", "MM", []), ("MM", "INCH", [3]), ("INCH", "MM", [3]), ("MM", "", [])):
        found = run(f"BEGIN PGM A {begin}\nL X+1 F100\nEND PGM A {end}".rstrip())
        assert [error.line for error in found.errors] == wanted
