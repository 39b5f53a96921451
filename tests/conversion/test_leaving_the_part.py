"""Programs that leave the workpiece within an operation: nothing may lead the tool through the part instead."""

from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from tests.support.posting import FOOT, HEAD
from trunnion.controls import load_control
from trunnion.conversion import Conversion, convert
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Coolant, CutterComp, Dwell, LoadTool, SpindleOff, SpindleOn
from trunnion.readers import run_program

#: A cut on one side of the part, a retract in machine positions, a turn of the table, and a cut on the other side.
PROGRAMS = {
    "mikron_600u": """BEGIN PGM A MM
TOOL CALL 5 Z S3000
L Z+560 R0 FMAX M91
L B+30 C+90 R0 FMAX M3
M128
L X+0 Y+90 Z+60 R0 FMAX
L Y+60 Z+5 F500
L X+20
M129
L Z+560 R0 FMAX M91
L C+270 R0 FMAX
M128
L X+20 Y-60 Z+5 R0 FMAX
L X+0
M129
L Z+560 R0 FMAX M91
M30
END PGM A MM
""",
    "yl569": """T5 M6
SUPA G0 Z0 D0
G0 B30 C90
TRAORI
G54 S3000 M3
G0 X0 Y90 Z60 D1
G1 Y60 Z5 F500
X20
TRAFOOF
SUPA G0 Z0 D0
G0 C270
TRAORI
G0 X20 Y-60 Z5 D1
G1 X0
TRAFOOF
SUPA G0 Z0 D0
M30
""",
    "matsuura_mx330": """%
O0001
G21
T5 M6
G53 G0 Z0.
G0 A-30. C90.
G54 S3000 M3
G43.4 H5
G0 X0. Y90. Z60.
G1 Y60. Z5. F500.
X20.
G49
G91 G28 Z0.
G90
G0 C270.
G43.4 H5
G0 X20. Y-60. Z5.
G1 X0.
G49
G53 G0 Z0.
M30
%
""",
    "xyzac_trt": """T5 M6
G53 G0 Z0
G0 A30 C90
G54 S3000 M3
M428
G0 X0 Y90 Z60
G1 Y60 Z5 F500
X20
M429
G53 G0 Z0
G0 C270
M428
G0 X20 Y-60 Z5
G1 X0
M429
G53 G0 Z0
M2
""",
    "hs664rt": """G71
M306 T.5
G55 O1
M242
G01 C90. A30. F3000
G196
M3 S3000
G1 X0. Y90. Z60. F3000
G1 Y60. Z5. F500
X20.
G197
M242
G01 C270. A30. F3000
G196
G1 X20. Y-60. Z5. F3000
G1 X0. F500
G197
M242
M02
""",
}


def converted(text: str, machine: Machine, folder: Path) -> Conversion:
    """A program converted."""
    program = folder / "part.nc"
    program.write_text(text)
    run = run_program(program, machine)
    assert run.errors == ()
    return convert(run, load_control(machine.control))


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_retract_in_machine_positions_divides_the_operation(name: str, tmp_path: Path) -> None:
    found = converted(PROGRAMS[name], load_machine(name), tmp_path)
    assert found.errors == ()
    first, second = found.toolpath.operations
    assert first.moves.tip.tolist() == [[0.0, 90.0, 60.0], [0.0, 60.0, 5.0], [20.0, 60.0, 5.0]]
    assert second.moves.tip.tolist() == [[20.0, -60.0, 5.0], [0.0, -60.0, 5.0]]
    assert second.events[0] == LoadTool(0, second.events[0].line, 5)
    if name != "hs664rt":  # M242 begins its operations
        assert second.name == f"{first.name}_2"
        assert any("the tool leaves the workpiece within an operation" in remark.what for remark in found.warnings)


def sinumerik(folder: Path, *lines: str, **setup: object) -> Conversion:
    """A Sinumerik program converted."""
    machine = replace(load_machine("yl569"), **setup)  # type: ignore[arg-type]
    return converted("\n".join([*lines, "M30", ""]), machine, folder)


KNOWN = {"workpiece_zero": (0.0, 0.0, 0.0), "tool_length": 0.0}


def test_coolant_and_stops_go_with_the_second_part(tmp_path: Path) -> None:
    lines = ["T5 M6", "S500 M3 M8", "G0 X0 Y0 Z5", "G1 X1 F10", "SUPA G0 Z0", "M5", "G4 F2", "G0 X9 Y0 Z5", "G1 X8 M3"]
    first, second = sinumerik(tmp_path, *lines).toolpath.operations
    assert [event.row for event in first.events] == [0, 0, 0]
    assert {*second.events} == {
        Coolant(0, 2, "ON"),
        LoadTool(0, 8, 5),
        SpindleOff(0, 6),
        Dwell(0, 7, 2.0),
        SpindleOn(1, 9, 500.0),
    }


def test_radius_compensation_cannot_stay_on_while_the_tool_leaves(tmp_path: Path) -> None:
    lines = ["G0 X0 Y0 Z5", "G41 G1 X1 F10", "X2", "SUPA G0 Z0", "G0 X9 Y0 Z5", "G1 X8", "G40 X7"]
    found = sinumerik(tmp_path, *lines)
    assert [(error.line, error.what) for error in found.errors] == [
        (2, "radius compensation stays on while the tool leaves the workpiece")
    ]
    lines[3:3] = ["G40 X3", "X4"]
    found = sinumerik(tmp_path, *lines[:-1])
    assert found.errors == ()
    assert CutterComp(3, 4, "OFF") in found.toolpath.operations[0].events


def test_a_turn_without_tcp_at_the_part_divides_too_where_the_zero_is_not_known(tmp_path: Path) -> None:
    lines = ["TRAORI", "G0 X0 Y60 Z5", "G1 X1 F10", "TRAFOOF", "G0 C180", "TRAORI", "G0 X0 Y-60 Z5", "G1 X1"]
    assert len(sinumerik(tmp_path, *lines).toolpath.operations) == 2


def test_first_legs_from_home_whose_height_nobody_knows_are_left_out(tmp_path: Path) -> None:
    (operation,) = sinumerik(tmp_path, "SUPA G0 Z300", "G0 X5 Y6", "Z50", "G1 Z1 F10").toolpath.operations
    assert operation.moves.tip.tolist() == [[5.0, 6.0, 50.0], [5.0, 6.0, 1.0]]


@pytest.mark.parametrize(
    ("lines", "line"),
    [
        (["G0 X0 Y0", "G1 Z1 F10", "SUPA G0 Z300", "G1 X5 F10"], 4),
        (["G0 X0 Y0 Z5", "SUPA G0 Z0", "G0 C90", "G0 X0 Y0 Z5", "G1 X1 F10"], 5),
        (["G0 X0 Y0 Z5", "G1 X1 B30 F1"], 2),
        (["SUPA G0 X0 Y0 Z0", "G2 X10 Y0 Z0 I5 J0 F100"], 2),
        (["G500", "G0 X0 Y0 Z5", "G1 X1 F10"], 3),
        (["TRAORI", "G0 B30 X0 Y0 Z5", "TRAFOOF", "G0 Z9", "TRAORI", "G1 X1 F10"], 6),
    ],
)
def test_a_cut_at_a_position_that_follows_from_the_machine_is_refused(
    lines: list[str], line: int, tmp_path: Path
) -> None:
    found = sinumerik(tmp_path, *lines)
    assert [(error.line, error.cure) for error in found.errors] == [
        (line, "give the workpiece zero and the tool length of the program's machine")
    ]
    assert sinumerik(tmp_path, *lines, **KNOWN).errors == ()


@pytest.mark.parametrize(
    ("lines", "refused"),
    [
        (["G0 X0 Y0 Z5", "G1 X1 F10", "SUPA G1 Z0", "G0 X9 Y0 Z5", "G1 X8"], False),
        (["G0 X0 Y0 Z5", "G1 X1 F10", "SUPA G1 Z-200", "G1 X9 Y0 Z5", "G1 X8"], True),
        (["G0 X0 Y0 Z5", "G1 X1 F10", "SUPA G1 X0", "G0 X9 Y0 Z5", "G1 X8"], True),
        (["G0 X0 Y0 Z5", "G1 X1 F10", "G0 Z50", "SUPA G1 X0 Y0"], False),
        (["G0 X0 Y0 Z5", "G1 X1 F10", "G0 Z50", "G0 Z4", "SUPA G1 X0 Y0"], True),
    ],
)
def test_cuts_in_machine_positions_are_refused_and_retracts_at_feed_are_not(
    lines: list[str], refused: bool, tmp_path: Path
) -> None:
    found = sinumerik(tmp_path, *lines)
    assert [error.what for error in found.errors] == ["moves at feed to a position of the machine"] * refused


def test_a_swing_of_the_tip_without_tcp_is_no_straight_line(tmp_path: Path) -> None:
    lines = ["G0 X0 Y60 Z5", "G1 X1 F10", "G0 C180", "G0 X0 Y60", "G1 X1"]
    found = sinumerik(tmp_path, *lines, **KNOWN)
    assert found.errors == ()
    assert len(found.toolpath.operations) == 2


def test_klartext_keeps_radius_compensation(tmp_path: Path) -> None:
    lines = ["L X+0 Y+0 Z+5 R0 FMAX M3", "L X+1 RL F100", "L X+2", "L X+3 R0", "L Y+9 RR", "L Y+10 R0"]
    text = "\n".join(["BEGIN PGM A MM", "TOOL CALL 5 Z S500", *lines, "M30", "END PGM A MM", ""])
    (operation,) = converted(text, load_machine("mikron_600u"), tmp_path).toolpath.operations
    sides = [(event.row, event.side) for event in operation.events if isinstance(event, CutterComp)]
    assert sides == [(1, "LEFT"), (3, "OFF"), (4, "RIGHT"), (5, "OFF")]


def test_fanuc_keeps_the_register_of_radius_compensation(tmp_path: Path) -> None:
    text = "O1\nG21 G90 G94\nT5 M6\nG54 S500 M3\nG43 H5 G0 X0. Y0. Z50.\nG41 D{d} G1 X1. F100.\nX2.\nG40 X3.\nM30\n"
    for number, register in ((15, 15), (5, 0)):
        found = converted(text.format(d=number), load_machine("matsuura_mx330"), tmp_path)
        (operation,) = found.toolpath.operations
        assert CutterComp(1, 6, "LEFT", "", register) in operation.events


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("TOOL CALL 5 Z S500 DL+0.5", "DL or DR of TOOL CALL"),
        ("CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 90", "the spindle stops at an angle"),
        ("CYCL DEF 208 BORE MILLING Q200=2 Q201=-5 Q206=100 Q334=1 Q203=0 Q204=10 Q335=20 Q342=0 Q351=1", "cycle 208:"),
    ],
)
def test_klartext_that_a_toolpath_cannot_hold_is_refused(line: str, what: str, tmp_path: Path) -> None:
    lines = ["TOOL CALL 5 Z S500", line, "L X+0 Y+0 Z+5 R0 FMAX M3", "L X+1 F100"]
    text = "\n".join(["BEGIN PGM A MM", *lines, "M30", "END PGM A MM", ""])
    errors = converted(text, load_machine("mikron_600u"), tmp_path).errors
    assert [error.what.startswith(what) for error in errors] == [True]


def test_a_tolerance_of_cycle_32_is_named(tmp_path: Path) -> None:
    lines = [
        "TOOL CALL 5 Z S500",
        "L X+0 Y+0 Z+5 R0 FMAX M3",
        "CYCL DEF 32.0 TOLERANCE",
        "CYCL DEF 32.1 T0.05",
        "L X+1 F100",
    ]
    text = "\n".join(["BEGIN PGM A MM", *lines, "M30", "END PGM A MM", ""])
    found = converted(text, load_machine("mikron_600u"), tmp_path)
    assert "cycle 32 is not carried over" in [remark.what for remark in found.warnings]


def test_control_characters_in_comments_become_blanks(tmp_path: Path) -> None:
    lines = ["TOOL CALL 5 Z S500", "; D32\rLONG", "L X+0 Y+0 Z+5 R0 FMAX M3", "L X+1 F100"]
    text = "\n".join(["BEGIN PGM A MM", *lines, "M30", "END PGM A MM", ""])
    program = tmp_path / "part.h"
    program.write_bytes(text.encode())
    found = trunnion.convert(program, machine="mikron_600u", to_cl=True)
    assert "PPRINT/D32 LONG" in (found.text or "")


def test_a_retract_of_which_no_row_tells_divides_operations_of_one_tool(tmp_path: Path) -> None:
    """M242 where the travel of Z is not known: the tool is not at the last Z any more."""
    (tmp_path / "part.cls").write_text(HEAD + FOOT + HEAD.replace("OP1", "OP2") + FOOT)
    first, second = tmp_path / "a.nc", tmp_path / "b.nc"
    trunnion.post(tmp_path / "part.cls", machine="hs664rt", output=first)
    converted = trunnion.convert(first, machine="hs664rt", to_machine="hs664rt", output=second)
    assert len(converted.toolpath.operations) == 2
    one, two = (
        [line.split(" ", 1)[-1] for line in path.read_text().splitlines() if not line.startswith("(")]
        for path in (first, second)
    )
    assert one[one.index("M306 T.1") :] == two[two.index("M306 T.1") :]


def test_a_program_that_leaves_at_feed_in_machine_positions_goes_over() -> None:
    machine = load_machine("dmu65")
    run = run_program(TESTS / "data" / "cases" / "pile" / "R7_m91_at_feed.h", machine)
    assert convert(run, load_control(machine.control)).errors == ()
