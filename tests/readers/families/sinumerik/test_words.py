"""One small program for each thing that a block can say."""

from dataclasses import replace

import numpy as np
import pytest

from tests.support.reading import Runner, close, rotary, slides
from trunnion.errors import InputError, Severity
from trunnion.machines import load_machine
from trunnion.model.run import Orientation, ProgrammedWord
from trunnion.model.toolpath import Kind


@pytest.mark.parametrize(
    "text",
    [
        "G1 X1.5 Y-2 Z.25",
        "G1X1.5Y-2.Z0.25",
        "N10G01X+1.5Y-02Z.250",
        "n10 g1 x1.5 y-2 z.25",
        "G1 X=1.5 Y=-2 Z=1/4",
        "G1 X=AC(1.5) Y=IC(-2) Z=0.25",
        "R1=1.5\nG1 X=R1 Y=-2 Z=.25",
        "/N10 G1 X1.5 Y-2 Z.25",
        "HERE: G1 X1.5 Y-2 Z.25",
        "G91 X1.5 Y-2 Z.25",
        "G1 X15EX-1 Y-2 Z.25 ; a comment",
    ],
)
def test_a_position_may_be_written_in_many_ways(run: Runner, text: str) -> None:
    result = run(text)
    close(slides(result)[-1], [1.5, -2.0, 0.25], atol=1e-15)
    assert result.diagnostics == ()


def test_rows_know_line_number_and_what_was_written(run: Runner) -> None:
    result = run("N5 G0 X1\n\nN20 ;only a comment\nN30 G1 Y2 F100\nB3 C4\nX5")
    assert result.line.tolist() == [1, 4, 5, 6]
    assert result.block_number.tolist() == [5, 30, -1, -1]
    assert result.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.LINEAR, Kind.LINEAR]
    assert result.programmed.tolist() == [
        ProgrammedWord.X,
        ProgrammedWord.Y | ProgrammedWord.FEED,
        ProgrammedWord.SECOND | ProgrammedWord.FIRST,
        ProgrammedWord.X,
    ]
    assert result.comments[0].text == "only a comment"
    assert result.comments[0].before_row == 1


def test_blocks_behind_a_slash_are_left_out_only_when_asked(run: Runner) -> None:
    assert len(run("/G1 X1\n/3 X2\nX3")) == 3
    assert slides(run("/G1 X1\n/3 X2\nX3", skip=True))[:, 0].tolist() == [3.0]


def test_inches_become_millimetres(run: Runner) -> None:
    result = run("G70 G1 X1 F10\nG700 X2 F10\nG71 X3\nG710 G2 X4 Y0 I.5 J0")
    close(slides(result)[:, 0], [25.4, 50.8, 3.0, 4.0])
    close(result.feed, [10.0, 254.0, 254.0, 254.0])
    assert result.inches.tolist() == [True, True, False, False]


def test_feed_modes_and_spindle(run: Runner) -> None:
    result = run("G1 X1 F100 S500 M3\nG95 X2 F.2 M4\nG93 X3 F5 M5\nG94 X4 S700\nX5")
    assert result.feed_mode.tolist() == [94, 95, 93, 94, 94]
    assert result.feed.tolist() == [100.0, 0.2, 5.0, 5.0, 5.0]
    assert result.rpm.tolist() == [500.0, 500.0, 500.0, 700.0, 700.0]
    assert result.spindle.tolist() == [1, -1, -1, 0, 0]


def test_tools_are_changed_by_m6_and_only_chosen_by_t(run: Runner) -> None:
    result = run('T="MILL_D12" D1\nX1\nM6\nX2\nT5\nX3\nM6 D2\nX4')
    assert [result.tools[k] for k in result.tool] == ["", "MILL_D12", "MILL_D12", "5"]
    assert result.edge.tolist() == [1, 1, 1, 2]


def test_messages_stops_coolant_and_dwell_are_events(run: Runner) -> None:
    result = run('MSG("HELLO; YOU")\nM8\nX1\nG4 F2.5\nG4 S30\nM0\nM1\nM50\nH7\nMSG()\nM9\nM30\nX2')
    assert [(e.kind, e.value) for e in result.events] == [
        ("message", "HELLO; YOU"),
        ("coolant", "flood"),
        ("dwell", 2.5),
        ("dwell", -30.0),
        ("stop", None),
        ("optional_stop", None),
        ("m", 50.0),
        ("h", 7.0),
        ("message", ""),
        ("coolant", "off"),
        ("end", "M30"),
    ]
    assert len(result) == 1


@pytest.mark.parametrize(
    ("text", "centre", "normal", "radius"),
    [
        ("G2 X10 Y0 I5 J0", (5, 0, 0), (0, 0, -1), 5),
        ("G3 X10 Y0 I=AC(5) J=AC(0)", (5, 0, 0), (0, 0, 1), 5),
        ("G3 I5", (5, 0, 0), (0, 0, 1), 5),
        ("G2 X10 Y0 CR=5", (5, 0, 0), (0, 0, -1), 5),
        ("G3 X6 Y6 CR=6", (0, 6, 0), (0, 0, 1), 6),
        ("G2 X6 Y6 CR=6", (6, 0, 0), (0, 0, -1), 6),
        ("G3 X6 Y6 CR=-6", (6, 0, 0), (0, 0, 1), 6),
        ("G3 X6 Y6 AR=90", (0, 6, 0), (0, 0, 1), 6),
        ("G3 AR=90 I0 J6", (0, 6, 0), (0, 0, 1), 6),
        ("G18 G2 X6 Z6 I6 K0", (6, 0, 0), (0, -1, 0), 6),
        ("G19 G3 Y6 Z6 J0 K6", (0, 0, 6), (1, 0, 0), 6),
        ("CIP X10 Y0 Z0 I1=5 J1=5 K1=0", (5, 0, 0), (0, 0, -1), 5),
        ("CIP X0 Y0 Z8 I1=0 J1=4 K1=4", (0, 0, 4), (1, 0, 0), 4),
        ("G2 X10 Y0 Z-3 I5 J0 TURN=2", (5, 0, 0), (0, 0, -1), 5),
    ],
)
def test_circles(run: Runner, text: str, centre: tuple[float, ...], normal: tuple[float, ...], radius: float) -> None:
    result = run(text)
    assert result.diagnostics == ()
    close(result.arcs.centre[0], centre, atol=1e-12)
    close(result.arcs.normal[0], normal, atol=1e-12)
    assert result.arcs.radius[0] == pytest.approx(radius)
    assert result.arcs.full_turns[0] == (2 if "TURN" in text else 0)
    assert result.kind[0] == Kind.ARC


@pytest.mark.parametrize(
    "text",
    [
        *(
            "G2 X10 Y0 I4 J0",
            "G2 X10 Y0 CR=4",
            "G2 X0 Y0 CR=4",
            "G2 X10 Y0",
            "CIP X10 I1=5",
            "G2 X9 Y0 AR=400",
            "G2 X5",
        ),
        *("G2 X10 I1EX300", "G2 X10 CR=1EX200", "G2 X10 AR=1EX-323", "CIP X10 Y2 I1=1EX200 J1=1EX250"),
    ],
)
def test_circles_that_are_none_are_named_and_go_straight(run: Runner, text: str) -> None:
    result = run(text)
    assert [f.severity for f in result.diagnostics] == [Severity.ERROR]
    assert result.kind[0] == Kind.LINEAR


def test_a_circle_that_is_not_executed_leaves_none(run: Runner) -> None:
    result = run("G2 X10 I5 B=1EX8\nG1 X5")
    assert result.kind.tolist() == [Kind.LINEAR]
    assert len(result.arcs.row) == 0
    assert "farther away" in result.errors[0].text


def test_a_feed_is_one_that_a_machine_could_have(run: Runner) -> None:
    result = run("G700 F=1EX308\nX1")
    assert np.isnan(result.feed[0])
    assert "a feed is not from 0 to" in result.errors[0].text


def test_an_endless_axis_takes_the_shorter_way_while_tcp_is_on(run: Runner) -> None:
    result = run("C350\nC10\nTRAORI\nC350\nC10\nC=AC(200)\nC=IC(400)")
    assert rotary(result)[:, 1].tolist() == [350.0, 10.0, -10.0, 10.0, -160.0, 240.0]


def test_ways_of_endless_axes(run: Runner) -> None:
    result = run("C=DC(350)\nC=ACP(10)\nC=ACN(20)\nC=ACP(20)\nC=DC(30)")
    assert rotary(result)[:, 1].tolist() == [-10.0, 10.0, -340.0, -340.0, -330.0]
    assert rotary(run("C350\nC10", shortest=True))[:, 1].tolist() == [-10.0, 10.0]
    assert rotary(run("TRAORI\nC350\nC10", shortest=False))[:, 1].tolist() == [350.0, 10.0]


def test_a_way_to_a_position_beyond_one_turn_is_an_alarm(run: Runner) -> None:
    for word in ("DC(440.5)", "DC(-10)", "ACP(360)", "ACN(400)"):
        (error,) = run(f"C={word}").errors
        assert "which DC(), ACP() and ACN() do not take" in error.text
    assert run("C=AC(440.5)\nC=DC(0)\nC=DC(359.999)").errors == ()


def test_a_pole_changes_no_path_and_a_polar_position_is_an_error(run: Runner) -> None:
    plain, said = run("G1 X5 F100\nX7"), run("G1 X5 F100\nG111 X0 Y0\nX7")
    assert said.errors == ()
    close(said.tip, plain.tip, atol=0.0)
    assert run("G1 X5 F100\nG111 X0 Y0\nAP=30 RP=7").errors


def test_a_dwell_of_seconds_and_revolutions_is_an_error(run: Runner) -> None:
    (error,) = run("G4 F2 S3").errors
    assert "it takes seconds or revolutions" in error.text


def test_an_axis_that_writes_its_turns_takes_the_number(run: Runner) -> None:
    machine = replace(load_machine("mikron_600u"), control=load_machine("yl569").control)
    result = run("TRAORI\nC350\nC725", machine=machine)
    assert rotary(result)[:, 1].tolist() == [350.0, 725.0]


def test_with_tcp_positions_are_the_tip_and_without_it_the_slides(run: Runner) -> None:
    result = run("G0 B90 C0\nX10 Y20 Z30\nTRAORI\nX10 Y20 Z30\nTRAFOOF\nX10 Y20 Z30")
    close(result.tip[1], [30.0, 20.0, -10.0], atol=1e-12)
    close(result.tip[2], [10.0, 20.0, 30.0], atol=1e-12)
    close(slides(result)[2], [-30.0, 20.0, 10.0], atol=1e-12)
    close(slides(result)[3], [10.0, 20.0, 30.0], atol=1e-12)
    assert result.tcp.tolist() == [False, False, True, False]
    close(result.axis, [[1.0, 0.0, 0.0]] * 4, atol=1e-12)


def test_an_axis_that_a_block_does_not_name_stays_when_tcp_goes_on(run: Runner) -> None:
    result = run("G0 B90\nX10 Y20 Z30\nTRAORI\nX0")
    close(result.tip[-1], [0.0, 20.0, -10.0], atol=1e-12)


def test_vectors_point_from_tip_to_holder_and_missing_components_are_zero(run: Runner) -> None:
    result = run("TRAORI\nORIWKS ORIVECT\nX1 A3=1 B3=0 C3=1\nX2 C3=2\nX3 B3=1 C3=1")
    half = np.sqrt(0.5)
    close(result.axis, [[half, 0, half], [0, 0, 1], [0, half, half]], atol=1e-12)
    close(rotary(result), [[45, 0], [0, 0], [45, 90]], atol=1e-9)
    close(result.tip[:, 0], [1, 2, 3])
    assert result.orientation.tolist() == [Orientation.GREAT_CIRCLE] * 3
    assert run("TRAORI\nORIAXES\nX1 A3=1 C3=1").orientation.tolist() == [Orientation.ANGLES]


def test_a_vector_out_of_reach_is_named(run: Runner) -> None:
    result = run("TRAORI\nX1 A3=1 C3=-2")
    assert [f.severity for f in result.diagnostics] == [Severity.WARNING]
    assert "travel" in result.diagnostics[0].text


def test_machine_positions(run: Runner) -> None:
    machine = load_machine("yl569", {"workpiece": {"zero_mm": [1.0, 2.0, 3.0]}})
    result = run("G54\nG0 X10 Y10 Z10\nSUPA Z100 D0\nG53 X5\nG153 Y6 B0\nX7", machine=machine)
    close(slides(result)[0], [11.0, 12.0, 13.0])
    close(slides(result)[3], [5.0, 6.0, 100.0])
    close(slides(result)[4], [8.0, 6.0, 100.0])
    close(result.tip[0], [10.0, 10.0, 10.0])
    assert result.machine_frame.tolist() == [False, True, True, True, False]
    assert result.edge.tolist() == [-1, 0, 0, 0, 0]


def test_work_offsets(run: Runner) -> None:
    machine = load_machine("yl569", {"workpiece": {"zero_mm": [1.0, 2.0, 3.0]}})
    result = run("X0 Y0 Z0\nG54 X0\nG500 X0 Y0 Z0\nG505 X0 Y0 Z0", machine=machine)
    assert result.work_offset.tolist() == [0, 54, 500, 505]
    close(slides(result)[:, 0], [1.0, 1.0, 0.0, 1.0])
    assert "work offsets are not known" in result.diagnostics[0].text


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("FOO", "FOO"),
        ("G999", "G999"),
        ("X1 Q5", "Q=5"),
        ("U7", "U7"),
        ("X1 ?", "?"),
        ("X", "a number is missing"),
        ("X=", "a value is missing"),
        ("X=5+", "a value is missing"),
        ("X=1/0", "divides by zero"),
        ("X=(((1)", "expected )"),
        ("X=SQRT(-1)", "SQRT"),
        ("X=NOBODY", "NOBODY has no value"),
        ("X=$AA_IW[1]", "$AA_IW"),
        ("$P_UIFR[1]=5", "$P_UIFR"),
        ("AROTS X10", "AROTS"),
        ("BSPLINE X1", "BSPLINE"),
        ("TOROT", "TOROT"),
        ("CYCLE81()", "CYCLE81"),
        ("CYCLE999(1,2)", "CYCLE999"),
        ("G74 X1=0", "G74"),
        ("MSG(", "a value is missing"),
        ("X1e99", "E=99"),
        ("X99999999", "farther"),
        ("SCALE X0", "flatten"),
        ("IF 1", "never ends"),
        ("G1.5", "G takes a whole number"),
        ("F-1", "feed"),
        ("X=1 IF", "IF cannot stand here"),
        ("DEF", "DEF needs a type"),
        ("DEF _A, REAL _B", "DEF needs a type"),
        ("DEF REAL", "DEF needs a name"),
    ],
)
def test_what_is_not_known_is_named_with_its_line(run: Runner, text: str, named: str) -> None:
    try:
        findings = [(f.line, f.text) for f in run("X1\n" + text).diagnostics]
    except InputError as error:
        findings = [(p.line, p.what) for p in error.problems]
    assert any(line == 2 and named in what for line, what in findings), findings


def test_what_stands_before_an_unknown_word_is_still_done(run: Runner) -> None:
    result = run("G1 X5 WHAT ?")
    assert slides(result)[0, 0] == 5.0
    assert len(result.errors) == 2


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1+2*3", 7),
        ("(1+2)*3", 9),
        ("-2*-3", 6),
        ("7 DIV 2", 3),
        ("-7 DIV 2", -3),
        ("7 MOD 4", 3),
        ("SIN(30)", 0.5),
        ("COS(60)+TAN(45)", 1.5),
        ("ATAN2(1,1)", 45),
        ("ASIN(0.5)+ACOS(0.5)", 90),
        ("SQRT(POT(3)+16)", 5),
        ("ABS(-4)", 4),
        ("TRUNC(-2.7)", -2),
        ("ROUND(2.5)", 3),
        ("ROUND(-2.5)", -3),
        ("ROUNDUP(2.1)", 3),
        ("MINVAL(3,2)+MAXVAL(3,2)", 5),
        ("BOUND(1,5,9)", 5),
        ("LN(EXP(2))", 2),
        ("5 B_AND 3", 1),
        ("5 B_OR 3", 7),
        ("5 B_XOR 3", 6),
        ("B_NOT 0", -1),
        ("(1<2) AND (2<1) OR (1==1)", 1),
        ("TRUE XOR TRUE", 0),
        ("NOT FALSE", 1),
        ('"A"=="A"', 1),
        ('"A"<<"B"=="AB"', 1),
        ("'HFF'", 255),
        ("'B101'", 5),
        ("$PI*0", 0),
        ("2<>2", 0),
        ("3>=3", 1),
        ("1+2==3", 1),
        ("R[1+1]+R2", 14),
        ("_FIELD[2]", 9),
    ],
)
def test_arithmetic(run: Runner, expression: str, value: float) -> None:
    result = run(f"R2=7\nDEF INT _FIELD[3]=SET(1,4,9)\nX={expression}")
    assert result.diagnostics == ()
    assert slides(result)[0, 0] == pytest.approx(value)


def test_variables_have_types(run: Runner) -> None:
    result = run('DEF INT _N=2.6\nDEF BOOL _B=5\nDEF REAL _R\nDEF STRING[8] _S="X"\n_R=_N*2\nX=_N Y=_B Z=_R')
    assert slides(result)[0].tolist() == [3.0, 1.0, 6.0]
    assert "takes a number" in run('DEF REAL _R\n_R="TEXT"').diagnostics[0].text


def test_incremental_words_carry_a_new_frame_along_and_others_stay(run: Runner) -> None:
    result = run("X1 Y1\nTRANS X100 Y5\nX=IC(1)\nX0")
    assert slides(result).tolist() == [[1, 1, 0], [102, 1, 0], [100, 1, 0]]


def test_a_file_may_be_without_a_last_line_end_or_have_those_of_windows(run: Runner) -> None:
    assert slides(run("X1\r\nY2 ;c\r\nZ3\r\n"))[-1].tolist() == [1.0, 2.0, 3.0]
    assert run("X1 ;c\r\n").comments[0].text == "c"
    assert len(run("X1\nX2")) == 2
    assert len(run("")) == 0


def test_comments_in_any_encoding(run: Runner) -> None:
    result = run("; 轮廓粗加工\n".encode() + b"X1 ; \xff\xfe\n")
    assert result.comments[0].text == " 轮廓粗加工"
    assert result.comments[1].text == " \xff\xfe"


def test_transfer_header_and_words_without_effect(run: Runner) -> None:
    result = run(
        "%_N_TEST_MPF\n;$PATH=/_N_WKS_DIR\nG40 G17 G710 G94 G90 G60 G601 FNORM\nSOFT FFWON COMPCAD G645\n"
        "CTOL=0.01 OTOL=0.1 ATOL[X]=.2\nFGROUP(X,Y,Z)\nFGREF[C]=10\n"
        'WORKPIECE(,"",,"BOX",112,0,-10,80,0,0,1,1)\nSTOPRE\nSPOS=90\n'
        "CYCLE832(0.02,_ORI_ROUGH,0.5)\nCYCLE832()\nG64 ADIS=0.1\nTCARR=0\nM17"
    )
    assert result.diagnostics == ()
    assert [e.value for e in result.events if e.kind == "cycle832"] == [(0.02, "_ORI_ROUGH", 0.5), ()]
    assert [e.value for e in result.events if e.kind == "tolerance"] == [0.01, 0.2, 0.02, 0.0, 0.1]


def test_what_is_added_to_the_tool_is_named(run: Runner) -> None:
    result = run("TOFFL=-5\nG0 X1\nTOFF[Z]=0\nTOFFR=.5")
    assert [(e.line, e.severity) for e in result.diagnostics] == [(1, Severity.WARNING), (4, Severity.WARNING)]
    assert [e.value for e in result.events] == [("TOFFL", -5.0), ("TOFFR", 0.5)]


def test_a_limit_of_the_spindle_is_no_programmed_speed(run: Runner) -> None:
    assert run("S500 M3\nG26 S4000\nG25 S20\nG1 X1 F100").rpm.tolist() == [500.0]


@pytest.mark.parametrize(("before", "within"), [("CDON", ""), ("", "CDON")])
def test_a_look_ahead_for_bottlenecks_warns_and_leaves_the_path(before: str, within: str, run: Runner) -> None:
    text = "{}\nG0 X0 Y0 Z5 D1\nG1 Z0 F100\nG41 X10 Y0\nX20\n{}\nX30\nG40 X40 Y9"
    found, plain = run(text.format(before, within)), run(text.format("CDOF", ""))
    assert found.errors == plain.errors == ()
    assert any("CDON" in each.text for each in found.diagnostics)
    assert not any("CDO" in each.text for each in plain.diagnostics)
    close(found.tip, plain.tip)


def test_cycles_that_are_not_followed_are_named_unless_their_file_is_given(run: Runner) -> None:
    for call, what in (("CYCLE90(9,0,2,-9)", "thread milling"), ("POCKET4(9,0,2,-9)", "circular pocket")):
        (error,) = run(f"{call}\nX1\nM30").errors
        assert error.code == "NC220"
        assert what in error.text
    own = run("CYCLE90(9)\nM30", files={"CYCLE90.SPF": "PROC CYCLE90(REAL _A)\nX=_A\nRET"})
    assert not own.errors
    assert own.joints[-1][own.machine.column("X")] == 9.0


def test_points_that_only_the_machine_knows_are_one_error(run: Runner) -> None:
    for block in ("G74 X1=0 Y1=0 Z1=0", "G75 FP=1 X1=0 Z1=0", "G75 Z1=0"):
        assert len(run(f"{block}\nM30").errors) == 1
