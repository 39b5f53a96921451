"""Words and blocks of Klartext, one by one."""

import math

import numpy as np
import pytest

from tests.support.machines import at_zero
from tests.support.reading import Runner, close, slides
from trunnion.errors import Severity
from trunnion.model.run import Orientation, ProgrammedWord
from trunnion.model.toolpath import Kind

# Form


def test_block_numbers_comments_structure_and_both_separators(run: Runner) -> None:
    text = (
        "0 BEGIN PGM 11 MM\n;all\n* - Face\n1 L X+1,5 Y-2.25 ;there\n  L Z 25.000 FMAX\n4L X2\nl y+3 f100\n"
        "5 END PGM 11 MM\nL X+99"
    )
    found = run(text)
    assert [each.text for each in found.diagnostics] == ["stands behind the end of the program: it never runs"]
    close(found.tip, [[1.5, -2.25, 0], [1.5, -2.25, 25], [2, -2.25, 25], [2, 3, 25]])
    assert found.block_number.tolist() == [1, -1, 4, -1]
    assert [(c.line, c.text, c.before_row) for c in found.comments] == [
        (2, "all", 0),
        (3, " - Face", 0),
        (4, "there", 1),
    ]


@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_a_block_goes_on_over_several_lines(line_end: str, run: Runner) -> None:
    lines = [
        "7 CYCL DEF 200 DRILLING ~",
        "   Q200=2 ;SET-UP ~",
        "Q201=-8 ~",
        "Q206=150 ;F ~",
        "Q202=8 ~",
        "Q210=0 ~",
        "Q204=50 ~",
        "Q211=0 ~",
        "Q203=0",
        "8 CYCL CALL",
    ]
    found = run(line_end.join(lines))
    assert found.diagnostics == ()
    assert set(found.block_number.tolist()) == {8}
    assert found.tip[:, 2].min() == -8.0


def test_a_block_that_goes_on_into_a_new_one_is_named(run: Runner) -> None:
    found = run("1 L X+1 ~\n2 L X+2\n3 L X+3")
    assert [(f.line, f.severity) for f in found.diagnostics] == [(2, Severity.ERROR)]
    assert found.tip[:, 0].tolist() == [1, 2, 3]


def test_skipped_blocks(run: Runner) -> None:
    assert run("/ L X+1\n/2 L X+2\n3 / L X+3\nL X+4").tip[:, 0].tolist() == [1, 2, 3, 4]
    assert run("/ L X+1\n/2 L X+2\n3 / L X+3\nL X+4", skip=True).tip[:, 0].tolist() == [4]


def test_inches(run: Runner) -> None:
    found = run("BEGIN PGM A INCH\nL X+1 F100\nCC X+2 Y+0\nC X+3 DR+\nL IX-1\nEND PGM A INCH")
    assert found.diagnostics == ()
    close(found.tip[:, 0], [25.4, 76.2, 50.8], atol=1e-12)
    # Tenths of an inch a minute.
    close(found.feed, [254.0] * 3)
    assert found.inches.all()
    close(found.arcs.centre, [[50.8, 0, 0]])


def test_m6_changes_the_tool_where_the_tool_has_moved_since_its_call(run: Runner) -> None:
    found = run("TOOL CALL 3 Z S900\nM6\nM3\nL X+1 F100\nL X+2 M6\nL X+3")
    assert found.diagnostics == ()
    assert [event.before_row for event in found.events if event.kind == "tool_change"] == [0, 2]
    assert found.spindle.tolist() == [1, 1, 0]


def test_a_speed_with_tcp_on_is_an_error(run: Runner) -> None:
    found = run("TOOL CALL 3 Z S900\nM128\nTOOL CALL Z S1000\nM129\nTOOL CALL Z S900\nM128\nL X+1 F100")
    assert [error.line for error in found.errors] == [3]


def test_a_feed_at_the_tip_with_tcp_is_an_error(run: Runner) -> None:
    assert [error.line for error in run("TOOL CALL 3 Z S900\nM116\nM128\nL X+1 F100").errors] == [3]
    assert [error.line for error in run("TOOL CALL 3 Z S900\nM128\nM116\nL X+1 F100").errors] == [3]
    assert run("TOOL CALL 3 Z S900\nM116\nM117\nM128\nL X+1 F100").errors == ()


# Motion


def test_rapids_last_one_block_and_feeds_stay(run: Runner) -> None:
    found = run("TOOL CALL 3 Z S900 F777\nL X+1 FMAX\nL X+2\nL X+3 F250\nL X+4 FMAX\nL X+5\nL X+6 F AUTO\nL X7 FAUTO")
    assert found.diagnostics == ()
    assert (found.kind == Kind.RAPID).tolist() == [True, False, False, True, False, False, False]
    assert found.feed.tolist() == [777, 777, 250, 250, 250, 777, 777]
    assert found.programmed[2] == ProgrammedWord.X | ProgrammedWord.FEED


@pytest.mark.parametrize(
    ("block", "end", "centre", "normal", "turns"),
    [
        ("CC X+0 Y+0\nC X+0 Y+10 DR+", (0, 10, 5), (0, 0, 5), 1, 0),
        ("CC X+0 Y+0\nC X+0 Y+10 DR-", (0, 10, 5), (0, 0, 5), -1, 0),
        ("CC IX-10 IY+0\nC DR-", (10, 0, 5), (0, 0, 5), -1, 0),
        ("CC X+0 Y+0\nC IX-10 IY-10 Z+8 DR-", (0, -10, 8), (0, 0, 5), -1, 0),
        ("CR X+0 Y+10 R+10 DR+", (0, 10, 5), (0, 0, 5), 1, 0),
        ("CR X+0 Y+10 R-10 DR-", (0, 10, 5), (0, 0, 5), -1, 0),
        ("CR X+0 Y+10 R-10 DR+ R0 F50", (0, 10, 5), (10, 10, 5), 1, 0),
        ("CC X+0 Y+0\nCP PA+90 DR+", (0, 10, 5), (0, 0, 5), 1, 0),
        ("CC X+0 Y+0\nCP IPA+450 IZ-3 DR+", (0, 10, 2), (0, 0, 5), 1, 1),
        ("CC X+0 Y+0\nCP IPA-1440 Z+0 DR- F600", (10, 0, 0), (0, 0, 5), -1, 3),
        ("CC X+0 Y+0\nCP IPA+360 DR+", (10, 0, 5), (0, 0, 5), 1, 0),
        # From the left of the end of a line along X.
        ("CT X+14 Y+4", (14, 4, 5), (10, 4, 5), 1, 0),
        ("CT X+14 Y-4", (14, -4, 5), (10, -4, 5), -1, 0),
        ("CC X+10 Y+20\nCTP PR+5 PA+270", (10, 15, 5), (10, 7.5, 5), 1, 0),
    ],
)
def test_circles(
    block: str, end: tuple[float, ...], centre: tuple[float, ...], normal: int, turns: int, run: Runner
) -> None:
    found = run(f"L X+0 Y+0 Z+5 F100\nL X+10\n{block}")
    if "CTP" in block:
        # The end lies square to the direction: half a circle.
        close(found.tip[-1], end, atol=1e-9)
    assert found.diagnostics == ()
    close(found.tip[-1], end, atol=1e-9)
    close(found.arcs.centre[0], centre, atol=1e-9)
    close(found.arcs.normal[0], [0, 0, normal], atol=1e-12)
    assert found.arcs.full_turns.tolist() == [turns]


def test_a_tangential_circle_goes_on_from_a_circle(run: Runner) -> None:
    found = run("L X+10 Y+0\nCC X+0 Y+0\nC X+0 Y+10 DR+\nCT X-6 Y+4")
    # At its end the first circle goes to -X; the second turns left about a centre below it.
    assert found.diagnostics == ()
    close(found.arcs.centre[1], [0, 4, 0], atol=1e-9)
    close(found.arcs.normal[1], [0, 0, 1])


def test_polar_lines(run: Runner) -> None:
    found = run("CC X+10 Y+20\nLP PR+10 PA+0\nLP PA+90 Z+3\nLP IPA+90\nLP IPR+5\nLP PR+2 PA-90 FMAX")
    assert found.diagnostics == ()
    close(found.tip, [[20, 20, 0], [10, 30, 3], [0, 20, 3], [-5, 20, 3], [10, 18, 3]], atol=1e-9)


def test_circles_in_the_planes_of_other_tool_axes(run: Runner) -> None:
    found = run(
        "TOOL CALL 1 Y S1\nL X+10 Y+0 Z+0\nCC X+0 Z+0\nC X+0 Z+10 DR-\nTOOL CALL 1 X\nCC Y+5 Z+10\nC Y+10 Z+10 DR+"
    )
    # The length of the tool would count along them, and the spindle of this machine is along Z.
    assert [each.line for each in found.errors] == [1, 5]
    # Seen from the tool, Y+: from Z to X is counter-clockwise.
    close(found.arcs.normal, [[0, -1, 0], [1, 0, 0]], atol=1e-12)
    close(found.arcs.centre, [[0, 0, 0], [0, 5, 10]], atol=1e-12)


@pytest.mark.parametrize(
    "block",
    [
        "C X+0 Y+10 DR+", "CC X+0 Y+0\nC X+0 Y+10", "CC X+0 Y+0\nC X+0 Y+12 DR+", "CR X+0 Y+50 R+10 DR+",
        "CR X+0 Y+10 DR+", "CC X+0 Y+0\nCP IPA+90 DR-", "LP PR+1 PA+0", "CT X+20 Y+0",
    ],
)  # fmt: skip
def test_circles_that_are_none_are_named(block: str, run: Runner) -> None:
    found = run(f"L X+5 Y+0\nL X+10\n{block}")
    assert len(found.errors) == 1


def test_a_block_without_l_takes_one_axis(run: Runner) -> None:
    found = run("L X+5 Y+0 Z+5 R0 F500\nX+46 R0 FMAX\nIY+2\nM3")
    assert found.diagnostics == ()
    np.testing.assert_allclose(found.xyz[-1], (46.0, 2.0, 5.0))
    for block, names in [("X+22 Y+16 Z+5", "X, Y, Z"), ("A+1 IC+2 FMAX", "A, C"), ("TX+0 TY+0 TZ+1", "TX, TY, TZ")]:
        found = run(f"L X+5 Y+0 Z+5 R0 F500\n{block}")
        (error,) = found.errors
        assert (error.code, len(found.kind)) == ("NC210", 1)
        assert f"write L before {names}: a block without L takes one axis" in str(error)


def test_machine_positions(run: Runner) -> None:
    found = run("CYCL DEF 7.0\nCYCL DEF 7.1 X+10\nL X+1 Y+2 Z+3 F100\nL Z+0 R0 FMAX M91\nL X+1\nL Z-5 FMAX M92")
    assert [(f.line, f.severity) for f in found.diagnostics] == [(6, Severity.WARNING)]
    close(slides(found), [[11, 2, 3], [11, 2, 0], [11, 2, 0], [11, 2, -5]])
    assert found.machine_frame.tolist() == [False, True, False, True]
    assert (found.kind[1], found.kind[2]) == (Kind.RAPID, Kind.LINEAR)


def test_rotary_words_take_the_shorter_way_with_m126_only(run: Runner) -> None:
    c = "C350 FMAX\nL C10 FMAX\n"
    found = run(f"L {c}M126\nL {c}M127\nL {c}")
    column = found.machine.column("C")
    assert found.joints[:, column].tolist() == [350, 10, -10, 10, 350, 10]


def test_one_axis_on_its_own_and_blocks_of_m_words(run: Runner) -> None:
    found = run("X+5 R0 F100\nC+30 FMAX\nM3 M8\nM5 M9")
    assert found.diagnostics == ()
    close(found.joints[-1, [found.machine.column("X"), found.machine.column("C")]], [5, 30])
    assert [(e.kind, e.value) for e in found.events] == [
        ("spindle", "clockwise"), ("coolant", "flood"), ("spindle", "off"), ("coolant", "off"),
    ]  # fmt: skip


# Tools and machine functions


def test_tools(run: Runner) -> None:
    text = (
        'TOOL DEF 7\nTOOL CALL 5 Z S3500 F800 DL+0.1 DR-0.05\nL X+1\nTOOL CALL "D10R05" Z S8000\nL X+2\n'
        "TOOL CALL Z S9000\nL X+3\nTOOL DEF 9 L+80 R+5\nTOOL CALL 0\nL X+4"
    )
    found = run(text)
    assert [(each.line, each.severity) for each in found.diagnostics] == [(2, Severity.WARNING)] * 2
    assert [found.tools[k] for k in found.tool] == ["5", "D10R05", "D10R05", "0"]
    assert found.rpm.tolist() == [3500, 8000, 9000, 9000]
    assert [e.value for e in found.events if e.kind == "delta"] == [("DL", 0.1), ("DR", -0.05)]
    assert [e.value for e in found.events if e.kind == "tool"] == ["7", "5", "D10R05", "0"]


def test_machine_functions_act_before_or_after_their_block(run: Runner) -> None:
    found = run("L X+1 M3 M8\nL X+2 M9 M5\nL X+3 M13\nL X+4 M0\nSTOP M1\nL X+5 M25\nM136\nL X+6\nM137\nL X7 M30\nL X+9")
    assert [each.text for each in found.diagnostics] == ["M25 belongs to the machine: what it does is not known"]
    assert [(e.kind, e.value, e.before_row) for e in found.events] == [
        ("spindle", "clockwise", 0), ("coolant", "flood", 0), ("coolant", "off", 2), ("spindle", "off", 2),
        ("spindle", "clockwise", 2), ("coolant", "flood", 2), ("stop", None, 4), ("stop", None, 4),
        ("optional_stop", None, 4), ("m", 25.0, 4), ("end", "M30", 7),
    ]  # fmt: skip
    assert found.spindle.tolist() == [1, 1, 1, 1, 1, 1, 1]
    assert found.feed_mode.tolist() == [94, 94, 94, 94, 94, 95, 94]
    assert len(found) == 7


def test_words_of_a_function_are_not_those_of_the_path(run: Runner) -> None:
    found = run("L X+1 F500 M128 F3000\nL X+2 M118 X1 Y1\nL X+3 M138 A C\nM94 C\nM103 F20\nL M140 MB5 F77\nL X+4")
    assert [(f.line, f.severity) for f in found.diagnostics] == [(2, Severity.WARNING), (5, Severity.ERROR)]
    assert [event.value for event in run("L X+1 F9 M124 T0.5\nM124").events if event.kind == "tolerance"] == [0.5]
    assert found.feed.tolist() == [500, 500, 500, 77, 500]
    close(found.tip[:, 1], 0.0, atol=1e-12)


def test_how_the_tool_axis_moves(run: Runner) -> None:
    text = "FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR\nL A-10\nFUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nL A-20"
    found = run(text)
    assert found.diagnostics == ()
    assert found.orientation.tolist() == [Orientation.GREAT_CIRCLE, Orientation.ANGLES]
    assert found.tcp.all()


def test_presets_are_one(run: Runner) -> None:
    found = run("CYCL DEF 247 DATUM SETTING ~\nQ339=+2 ;DATUM\nL X+1\nCYCL DEF 247 DATUM SETTING Q339=3\nL X+1")
    assert [(f.line, f.severity) for f in found.diagnostics] == [(4, Severity.WARNING)]
    assert found.work_offset.tolist() == [2, 3]


def test_tolerance_and_dwell(run: Runner) -> None:
    tolerance = "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.02\nCYCL DEF 32.2 HSC-MODE:0 TA0.5\n"
    found = run(tolerance + "CYCL DEF 9.0 DWELL TIME\nCYCLE DEF 9.1 5")
    assert found.diagnostics == ()
    assert [(e.kind, e.value) for e in found.events] == [
        ("tolerance", 0.02), ("cycle32", "T0.02"), ("orientation_tolerance", 0.5), ("cycle32", "HSC-MODE:0 TA0.5"),
        ("dwell", 5.0),
    ]  # fmt: skip


# What is not known


@pytest.mark.parametrize(
    "block",
    [
        "QUX 5", "L X+", "L XNAN YNAN", "L X+1 W7", "L X+1 X+2", "L 5", "LX+1", "L X+1 S500", "L B+5", "L U+5",
        "RND R5", "CHF 2", "APPR LCT X+1 Y+2 R5", "DEP LT LEN20", "FC DR+ R10", "M114", "CYCL DEF 999 NAME Q200=1",
        "CYCL DEF 4.0 POCKET\nCYCL CALL", "CYCL CALL", "CYCL CALL PAT", "CALL PGM NOBODY", "TOOL CALL 5 Z Q7",
        "FUNCTION TURNDATA CORR", "FN 26: TABOPEN TNC:A", "TRANS DATUM AXIS X+10", "PATTERN DEF",
        "CYCL DEF 7.0\nCYCL DEF 7.1 #5",
        "DECLARE STRING QS1 = \"A\"", "QS1 = 5", "CYCL DEF 8.0\nCYCL DEF 8.1 Q", "CYCL DEF 11.0\nCYCL DEF 11.1 SCL0",
        "L M99", "BEGIN", "L ~X+1",
        "CYCL DEF 200 X Q200=2 Q253=PREDEF", "L X1EX5", "M99999",
    ],
)  # fmt: skip
def test_what_is_not_understood_is_named_and_the_next_block_runs(block: str, run: Runner) -> None:
    found = run(f"L X+1 Y+1\n{block}\nL Z+7")
    named = [f for f in found.diagnostics if f.line in (2, 3) and f.text]
    if block in ("FN 26: TABOPEN TNC:A",):
        assert [f.severity for f in named] == [Severity.WARNING]
    else:
        assert any(f.severity is Severity.ERROR for f in named)
    assert found.tip[-1, 2] == 7.0


def test_string_parameters_are_named(run: Runner) -> None:
    found = run('QS10 = "A" || QS11\nL Z+7')
    assert [(f.line, f.code, "QS string parameters" in f.text) for f in found.diagnostics] == [(1, "NC220", True)]


def test_radius_compensation_is_a_warning(run: Runner) -> None:
    found = run("L X+1 RL F100\nL X+2\nL X+3 R0")
    assert [(f.line, f.severity) for f in found.diagnostics] == [(1, Severity.WARNING)]
    close(found.tip[:, 0], [1, 2, 3])


def test_another_machine(run: Runner) -> None:
    machine = at_zero("mikron_600u")
    found = run("M128\nL X+1 Y+2 Z+3 B-30 C+45", machine=machine)
    assert found.diagnostics == ()
    sine, cosine, half = math.sin(math.radians(-30)), math.cos(math.radians(-30)), math.sqrt(0.5)
    close(found.axis[0], [sine * half, sine * half, cosine], atol=1e-12)
    close(found.tip[0], [1, 2, 3], atol=1e-9)
    assert np.isfinite(found.joints).all()


# Normals of surfaces


def test_normals_are_kept_as_the_workpiece_sees_them(run: Runner) -> None:
    text = (
        "L X+1 F100\nLN X+2 Y+0 Z+0 NX+0.6 NY+0 NZ+0.8\nLN X+3 Y+0 Z+0 NZ-2 TX+0 TY+0 TZ+1\nL X+4\n"
        "Q5 = 0.28\nLN X+5 NX+Q5 NY+0.96\nPLANE SPATIAL SPA-30 SPB+0 SPC+0 STAY\nLN X+6 Y+1 Z+1 NX+0 NY+1 NZ+0\n"
    )
    found = run(text)
    assert found.normals.row.tolist() == [1, 2, 4, 5]
    turned = [0.0, math.cos(math.radians(30.0)), -0.5]
    close(found.normals.vector, [[0.6, 0, 0.8], [0, 0, -2], [0.28, 0.96, 0], turned])


def test_normals_of_many_blocks_are_all_kept(run: Runner) -> None:
    """More than the kernel notes at a time, with others between them."""
    rows = range(9000)
    lines = [f"L{'N' if k % 3 else ''} X{k}" + (f" NX0.6 NY{k}" if k % 3 else "") for k in rows]
    found = run("L Y0 F100\n" + "\n".join(lines))
    wanted = [k for k in rows if k % 3]
    assert found.normals.row.tolist() == [k + 1 for k in wanted]
    assert found.normals.vector[:, 1].tolist() == wanted
    assert found.diagnostics == ()
