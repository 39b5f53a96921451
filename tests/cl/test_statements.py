"""What each statement becomes."""

import io
import math

import numpy as np
import pytest

from tests.support.cl_reading import Body, Fail, Read
from trunnion.cl import read_cl_files
from trunnion.cl.statements import HANDLERS
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    From,
    GoHome,
    Insert,
    Kind,
    LoadTool,
    Message,
    SelectTool,
    Sense,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    Tool,
    UnknownStatement,
)

GO = "GOTO/0,0,0"


@pytest.mark.parametrize("comma", [",", ", ", " ,\t"])
def test_tool_path_names_operation_and_tool(read: Read, comma: str) -> None:
    toolpath = read(f"TOOL PATH/ROUGH 1, A{comma}TOOL{comma}END MILL,10\nGOTO/1,2,3\nEND-OF-PATH\n")
    (operation,) = toolpath.operations
    assert (operation.name, operation.tool.name, operation.line) == ("ROUGH 1, A", "END MILL,10", 1)


def test_two_operations_keep_their_own_rows_tools_and_frames(read: Read) -> None:
    toolpath = read(
        "TOOL PATH/A,TOOL,T1\nMSYS/1,2,3,0,1,0,-1,0,0\nGOTO/1,1,1,1,0,0\nGOTO/2,2,2\nEND-OF-PATH\n"
        "TOOL PATH/B,TOOL,T2\nMSYS/0,0,0,1,0,0,0,1,0\nGOTO/3,3,3\nEND-OF-PATH\n"
    )
    a, b = toolpath.operations
    assert a.moves.tip.tolist() == [[1, 1, 1], [2, 2, 2]]
    assert b.moves.tip.tolist() == [[3, 3, 3]]
    assert a.frame.origin == (1, 2, 3)
    assert a.frame.x == (0, 1, 0)
    assert b.frame.origin == (0, 0, 0)
    assert a.moves.axis.tolist() == [[1, 0, 0], [1, 0, 0]]
    assert b.moves.axis.tolist() == [[0, 0, 1]]
    assert b.moves.line.tolist() == [8]


def test_columns_are_read_only(body: Body) -> None:
    assert not body(GO).moves.tip.flags.writeable


@pytest.mark.parametrize(
    ("text", "tool"),
    [
        ("MILL,10.,1.,50.,2.,3.", Tool("MILL", "T1", 10, 1, 50, 2, 3)),
        ("MILL,10.,1.,50.,2.,3.,4.,1.", Tool("MILL", "T1", 10, 1, 50, 2, 3)),
        ("MILL,10.,1.,50.,2.,3.,0,0,85.,0,0", Tool("MILL", "T1", 10, 1, 50, 2, 3, upper_radius=85)),
        ("DRILL,MILL,6.,0.,80.,118.,40.", Tool("DRILL", "T1", 6, 0, 80, tip_angle=118, flute_length=40)),
        ("TCUTTER,40.,1.,2.,50.,6.", Tool("TCUTTER", "T1", 40, 1, 50, flute_length=6, upper_radius=2)),
        ("BARREL,10.,1.,50.,2.,3.,0,0,85.,0,0", Tool("BARREL", "T1", 10, 1, 50, 2, 3, upper_radius=85)),
    ],
)
def test_tldata_becomes_a_tool(read: Read, text: str, tool: Tool) -> None:
    assert read(f"TOOL PATH/A,TOOL,T1\nTLDATA/{text}\n{GO}\nEND-OF-PATH\n").operations[0].tool == tool


def test_a_form_of_tldata_that_is_not_known_is_kept_with_a_remark(read: Read) -> None:
    toolpath = read("TOOL PATH/A,TOOL,T\nTLDATA/TURN,1,2\nGOTO/1,1,1\nEND-OF-PATH\n")
    assert toolpath.operations[0].tool == Tool("UNKNOWN", "T")
    assert "TLDATA/TURN" in toolpath.remarks[0].what


def test_msys_is_made_exactly_unit_and_square(body: Body) -> None:
    frame = body("MSYS/1,2,3,0.70710680,0.70710680,0,-0.70710680,0.70710670,0", GO).frame
    matrix = frame.matrix()
    assert np.allclose(matrix.T @ matrix, np.eye(3), atol=1e-15)


def test_load_select_and_their_registers(body: Body) -> None:
    assert body("LOAD/TOOL,7,ADJUST,3", "SELECT/TOOL,8", GO, "LOAD/TOOL,9 ").events == (
        LoadTool(0, 3, 7, 3),
        SelectTool(0, 4, 8),
        LoadTool(1, 6, 9, 0),
    )


@pytest.mark.parametrize(
    ("text", "rpm", "sense"),
    [
        ("RPM,800.,CLW", 800, Sense.CLW),
        ("800.,RPM,CCLW", 800, Sense.CCLW),
        ("CCLW, RPM , 800", 800, Sense.CCLW),
        ("800", 800, Sense.CLW),
        ("SMM,100,CLW", 100_000 / (math.pi * 10), Sense.CLW),
        ("SFM,100,CLW", 30_480 / (math.pi * 10), Sense.CLW),
        ("SFM,100,CLW,DIAMTR,20", 30_480 / (math.pi * 20), Sense.CLW),
    ],
)
def test_spindl_becomes_revolutions_and_sense(body: Body, text: str, rpm: float, sense: Sense) -> None:
    (event,) = body(f"SPINDL/{text}", GO).events
    assert isinstance(event, SpindleOn)
    assert (event.row, event.line, event.sense) == (0, 3, sense)
    assert event.rpm == pytest.approx(rpm, rel=1e-15)


def test_spindl_off_and_on_again(body: Body) -> None:
    events = body("SPINDL/RPM,500,CCLW", "SPINDL/OFF", GO, "SPINDL/ON", GO).events
    assert events == (SpindleOn(0, 3, 500, Sense.CCLW), SpindleOff(0, 4), SpindleOn(1, 6, 500, Sense.CCLW))


@pytest.mark.parametrize("kind", ["ON", "OFF", "FLOOD", "MIST", "TAP", "THRU", "AIR"])
def test_coolnt_keeps_its_kind(body: Body, kind: str) -> None:
    assert body(f"COOLNT/{kind}", GO).events == (Coolant(0, 3, kind),)


@pytest.mark.parametrize(
    ("text", "event"),
    [
        ("CUTCOM/LEFT", CutterComp(0, 3, "LEFT")),
        ("CUTCOM/RIGHT,XYPLAN,5", CutterComp(0, 3, "RIGHT", "XYPLAN", 5)),
        ("CUTCOM/LEFT,YZPLAN,ADJUST,7", CutterComp(0, 3, "LEFT", "YZPLAN", 7)),
        ("CUTCOM/ADJUST,7,RIGHT", CutterComp(0, 3, "RIGHT", "", 7)),
        ("CUTCOM/OFF", CutterComp(0, 3, "OFF")),
        ("DELAY/1.5", Dwell(0, 3, 1.5)),
        ("DELAY/3,REV", Dwell(0, 3, 3, True)),
        ("STOP", Stop(0, 3, False)),
        ("STOP/turn the part", Stop(0, 3, False, "turn the part")),
        ("OPSTOP/Look, $5", Stop(0, 3, True, "Look, $5")),
        ("PPRINT/50 $$ a/b, c", Message(0, 3, "50 $$ a/b, c")),
        ("PPRINT hello", Message(0, 3, "hello")),
        ("DISPLY/Check clamps", Message(0, 3, "Check clamps", True)),
        ("INSERT/G0 X1 Y2", Insert(0, 3, "G0 X1 Y2")),
        ("INSERTG00Z10.$", Insert(0, 3, "G00Z10.$")),
        ("OPSKIP/ON", BlockSkip(0, 3, True)),
        ("OPSKIP/OFF", BlockSkip(0, 3, False)),
        ("SET/MODE,ABSOL", SetMode(0, 3, ("SET", "MODE", "ABSOL"))),
        ("MODE/MILL", SetMode(0, 3, ("MODE", "MILL"))),
        ("LOADTL/7", LoadTool(0, 3, 7)),
        ("LOADTL/7,ADJUST,3", LoadTool(0, 3, 7, 3)),
        ("MULTAX/ON", SetMode(0, 3, ("MULTAX", "ON"))),
        ("GOHOME", GoHome(0, 3)),
        ("CYCLE/OFF", CycleOff(0, 3)),
    ],
)
def test_a_statement_becomes_its_event(body: Body, text: str, event: Event) -> None:
    assert body(text, GO).events == (event,)


def test_an_event_belongs_to_the_row_after_it(body: Body) -> None:
    events = body(GO, "COOLNT/ON", GO, GO, "COOLNT/OFF").events
    assert events == (Coolant(1, 4, "ON"), Coolant(3, 7, "OFF"))


def test_partno_names_the_part(read: Read) -> None:
    assert read("PARTNO/3100588-02\nTOOL PATH/A,TOOL,T\nGOTO/1,1,1\nEND-OF-PATH\n").part == "3100588-02"


def test_intol_and_outtol_belong_to_the_operation(body: Body) -> None:
    operation = body("INTOL/0.03", "OUTTOL/0.02", GO)
    assert (operation.intol, operation.outtol) == (0.03, 0.02)
    assert body(GO).intol is None


def test_statements_before_an_operation_and_after_the_last_are_not_lost(read: Read) -> None:
    toolpath = read("LOAD/TOOL,3\nFEDRAT/MMPM,50\nTOOL PATH/A,TOOL,T\nGOTO/1,1,1\nEND-OF-PATH\nSPINDL/OFF\nFINI\n")
    (operation,) = toolpath.operations
    assert operation.events == (LoadTool(0, 1, 3), SpindleOff(1, 6))
    assert operation.moves.feed.tolist() == [50]


def test_rapid_makes_only_the_next_motion_rapid(body: Body) -> None:
    moves = body("FEDRAT/MMPM,100", "RAPID", "COOLNT/ON", GO, GO, "RAPID", GO).moves
    assert moves.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.RAPID]
    assert moves.feed.tolist() == [100, 100, 100]


def test_the_axis_is_modal_and_from_sets_it(body: Body) -> None:
    operation = body("FROM/1,2,3,0,1,0", GO, "GOTO/0,0,0,1,0,0", GO, "FROM/0,0,0", GO, "FROM/0,0,0,0,0,1", GO)
    assert operation.moves.axis.tolist() == [[0, 1, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [0, 0, 1]]
    assert operation.events == (
        From(0, 3, (1, 2, 3), (0, 1, 0)),
        From(3, 7, (0, 0, 0), (1, 0, 0)),
        From(4, 9, (0, 0, 0), (0, 0, 1)),
    )


def test_an_axis_almost_of_length_one_is_made_so(body: Body) -> None:
    (axis,) = body("GOTO/0,0,0,0.5773503,-0.5773503,0.5773503").moves.axis
    assert np.linalg.norm(axis) == pytest.approx(1, abs=1e-15)


def test_godlta_goes_on_from_the_last_point(body: Body) -> None:
    moves = body("FROM/1,2,3", "GODLTA/1,1,1", "GOTO/10,0,0", "GODLTA/0,0,-5", GO).moves
    assert moves.tip.tolist() == [[2, 3, 4], [10, 0, 0], [10, 0, -5], [0, 0, 0]]
    assert moves.line.tolist() == [4, 5, 6, 7]


def test_gohome_with_a_point_is_a_rapid_row(body: Body) -> None:
    moves = body(GO, "GOHOME/650.0,-393.0,964.0").moves
    assert moves.tip.tolist() == [[0, 0, 0], [650, -393, 964]]
    assert moves.kind.tolist() == [Kind.LINEAR, Kind.RAPID]


@pytest.mark.parametrize(
    "text",
    [
        "GOTO / 1.5 , 2 ,\t3",
        "goto/1.5,2,3",
        "G O T O/1.5,2,3",
        "  GOTO/1.5,2,3  ",
        "GOTO/15.0E-1,2,3",
        "GOTO/15.0D-1,2,3",
        "GOTO/1.5,2,3 $$ 9,9,9",
        "GOTO/1.5,$\n2,3",
        "GOTO $\n / 1.5, $ \n 2, $\n 3",
        "GOTO/1.5,$ $$ X\n2,3",
        "GOTO/1.5, $\n2, $ $$ Y $\n3 $$ Z",
        "GOTO/1.500000000000000000000000000,2,3",
        "GOTO/+1.5,+2.,3.",
    ],
)
def test_a_goto_in_any_form_is_the_same_point(body: Body, text: str) -> None:
    moves = body(text, "GOTO/4,5,6").moves
    assert moves.tip.tolist() == [[1.5, 2, 3], [4, 5, 6]]
    assert moves.line.tolist() == [3, 4 + text.count("\n")]


def test_comments_and_blank_lines_are_nothing(body: Body) -> None:
    operation = body("$$ centerline data", "", "   ", "  $$ GOTO/9,9,9", GO, "COOLNT/ON $$ and cool")
    assert len(operation.moves) == 1
    assert operation.events == (Coolant(1, 8, "ON"),)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_both_line_ends_read_alike(read: Read, end: str) -> None:
    text = "TOOL PATH/A,TOOL,T 1\nPPRINT/hi\nFEDRAT/MMPM,$\n5\nGOTO/1,2,3\nGOTO/1,2,3 $$ c\nEND-OF-PATH\n"
    (operation,) = read(text.replace("\n", end)).operations
    assert (operation.name, operation.tool.name) == ("A", "T 1")
    assert operation.events == (Message(0, 2, "hi"),)
    assert operation.moves.tip.tolist() == [[1, 2, 3], [1, 2, 3]]
    assert operation.moves.line.tolist() == [5, 6]


def test_the_last_line_needs_no_line_end_and_may_have_a_dos_end_mark(read: Read) -> None:
    text = "TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH"
    assert len(read(text).operations) == 1
    assert read(text + "\n\x1a").remarks == ()


# -- feeds --------------------------------------------------------------------------------------------------------


def test_feed_is_modal_and_not_a_number_before_the_first(body: Body) -> None:
    moves = body(GO, "FEDRAT/MMPM,100", GO, "FEDRAT/200", GO, "FEDRAT/0.2,MMPR", GO, "FEDRAT/0.3", GO).moves
    assert math.isnan(moves.feed[0])
    assert moves.feed[1:].tolist() == [100, 200, 0.2, 0.3]
    assert moves.per_rev.tolist() == [False, False, False, True, True]


def test_inch_feeds_in_a_metric_file_become_mm(body: Body) -> None:
    moves = body("UNITS/MM", "FEDRAT/IPM,10", GO, "FEDRAT/0.01,IPR", GO, "FEDRAT/0.02", GO).moves
    assert moves.feed.tolist() == [254, 0.01 * 25.4, 0.02 * 25.4]
    assert moves.per_rev.tolist() == [False, True, True]
    assert moves.tip.tolist() == [[0, 0, 0]] * 3


# -- units --------------------------------------------------------------------------------------------------------

INCHES = """TOOL PATH/A,TOOL,T
TLDATA/MILL,1.0,0.125,4.0,0.0,0.0
MSYS/1,2,3,1,0,0,0,1,0
INTOL/0.001
FROM/1,1,1
SPINDL/SFM,100
{}
GOTO/1,2,3,0,0,1
CIRCLE/0,2,3,0,0,1,1
GOTO/-1,2,3
CYCLE/DRILL,RAPTO,0.1,FEDTO,-1.0,TLANGL,118,MMPR,0.2
GOTO/1,1,1
CYCLE/OFF
END-OF-PATH
"""


@pytest.mark.parametrize(("statement", "units"), [("UNITS/INCHES", None), ("", "inch"), ("UNITS/MM", "inch")])
def test_everything_that_is_a_length_is_turned_into_mm(read: Read, statement: str, units: str | None) -> None:
    (operation,) = read(INCHES.format(statement), units=units).operations
    assert operation.moves.tip[0].tolist() == [25.4, 50.8, 3 * 25.4]
    assert operation.tool.diameter == 25.4
    assert operation.tool.corner_radius == 0.125 * 25.4
    assert operation.tool.length == 4 * 25.4
    assert operation.frame.origin == (25.4, 50.8, 3 * 25.4)
    assert operation.intol == 0.001 * 25.4
    assert operation.arcs.radius.tolist() == [25.4]
    assert operation.arcs.centre.tolist() == [[0, 50.8, 3 * 25.4]]
    start, spindle, cycle, _ = operation.events
    assert start == From(0, 5, (25.4, 25.4, 25.4), (0, 0, 1))
    assert isinstance(spindle, SpindleOn)
    assert isinstance(cycle, CycleOn)
    assert spindle.rpm == pytest.approx(100 * 304.8 / (math.pi * 25.4), rel=1e-14)
    assert dict(cycle.values) == {"RAPTO": (0.1 * 25.4,), "FEDTO": (-25.4,), "TLANGL": (118,), "MMPR": (0.2,)}


def test_only_inch_feeds_make_an_inch_file_with_a_remark(read: Read) -> None:
    toolpath = read("TOOL PATH/A,TOOL,T\nFEDRAT/IPM,10\nGOTO/1,0,0\nFEDRAT/20\nGOTO/1,0,0\nEND-OF-PATH\n")
    assert toolpath.operations[0].moves.tip[0].tolist() == [25.4, 0, 0]
    assert toolpath.operations[0].moves.feed.tolist() == [254, 508]
    assert [(remark.line, "inches" in remark.what) for remark in toolpath.remarks] == [(2, True)]


def test_a_feed_without_any_unit_is_in_units_of_the_file(body: Body) -> None:
    assert body("FEDRAT/10", GO, units="inch").moves.feed.tolist() == [254]
    assert body("FEDRAT/10", GO).moves.feed.tolist() == [10]


# -- cycles -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "mode", "values", "words"),
    [
        (
            "DRILL,DEEP,STEP,1.0,CLEAR,3.0,FEDTO,-2.0,RTRCTO,18.0,MMPM,70.0",
            ("DRILL", "DEEP"),
            {"STEP": (1.0,), "RAPTO": (3.0,), "FEDTO": (-2.0,), "RTRCTO": (18.0,), "MMPM": (70.0,)},
            {},
        ),
        (
            "DRILL,RTRCTO,AUTO,FEDTO,-5,IPM,10,RAPTO,3,DWELL,REV,2",
            ("DRILL",),
            {"FEDTO": (-5,), "MMPM": (254,), "RAPTO": (3,), "DWELL": (2,)},
            {"RTRCTO": "AUTO", "DWELL": "REV"},
        ),
        (
            "DRILL,BRKCHP,STEP,3,2,1,RAPTO,3,FEDTO,-9,DWELL,0.5,MMPM,50",
            ("DRILL", "BRKCHP"),
            {"STEP": (3, 2, 1), "RAPTO": (3,), "FEDTO": (-9,), "DWELL": (0.5,), "MMPM": (50,)},
            {},
        ),
        (
            "DRILL,CSINK,CSKDIA,12,TLANGL,90,HOLDIA,6,RAPTO,3,MMPR,0.1",
            ("DRILL", "CSINK"),
            {"CSKDIA": (12,), "TLANGL": (90,), "HOLDIA": (6,), "RAPTO": (3,), "MMPR": (0.1,)},
            {},
        ),
        ("TAP,RAPTO,3,FEDTO,-9,MMPR,1,OPTION", ("TAP",), {"RAPTO": (3,), "FEDTO": (-9,), "MMPR": (1,)}, {"OPTION": ""}),
        ("BORE,NODRAG,90,RAPTO,3,FEDTO,-9", ("BORE", "NODRAG"), {"NODRAG": (90,), "RAPTO": (3,), "FEDTO": (-9,)}, {}),
        ("BORE,MANUAL,RAPTO,3,RTRCTO,MANUAL", ("BORE", "MANUAL"), {"RAPTO": (3,)}, {"RTRCTO": "MANUAL"}),
    ],
)
def test_cycle_is_read_by_couplets_in_any_order(
    body: Body, text: str, mode: tuple[str, ...], values: dict[str, tuple[float, ...]], words: dict[str, str]
) -> None:
    cycle, off = body(f"UNITS/MM\nCYCLE/{text}", GO, "CYCLE/OFF").events
    assert isinstance(cycle, CycleOn)
    assert (cycle.mode, dict(cycle.values), dict(cycle.words)) == (mode, values, words)
    assert off == CycleOff(1, 6)


def test_a_cycle_on_where_another_tool_is_loaded_is_refused(body_fails: Fail) -> None:
    (problem,) = body_fails("LOAD/TOOL,1", "CYCLE/DRILL,RAPTO,3,FEDTO,-5", GO, "LOAD/TOOL,2", GO)
    assert (problem.line, problem.what) == (6, "the cycle of line 4 is still on where tool 2 is loaded")


def test_cycle_on_repeats_the_last_cycle(body: Body) -> None:
    first, _, again = body("CYCLE/DRILL,RAPTO,3", GO, "CYCLE/OFF", "CYCLE/ON", GO).events
    assert isinstance(first, CycleOn)
    assert isinstance(again, CycleOn)
    assert again.values == first.values
    assert again.row == 1


# -- what is not known --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "WOBBLE/1,2",
        "ORIGIN/1,0,0,0",
        "COOLNT/LAVA",
        "SPINDL/ORIENT",
        "CUTCOM/ADJUST,1",
        "CUTCOM/LEFT,1,ADJUST,2",
        "CUTCOM/LEFT,ADJUST",
        "CUTCOM/NORMDS",
        "OPSKIP/ON,2",
        "DELAY/1,MIN",
        "ROTATE/TABLE,90",
        "ROTABL/ATANGL,90",
        "TLAXIS/0,1,0",
        "AUXFUN/31",
        "PREFUN/91",
        "CLAMP/ON",
        "SEQNO/10,INCR,5",
        "MY_EVENT/1",
        "SET/LINEAR",
        "MODE/TOOL,0,0,1",
        "MULTAX/OFF",
        "LOAD/HOLDER,3",
    ],
)
def test_a_statement_that_is_not_known_is_kept_with_a_remark_and_an_error_when_strict(
    read: Read, body: Body, body_fails: Fail, text: str
) -> None:
    toolpath = read(f"TOOL PATH/A,TOOL,T\n{text}\nGOTO/0,0,0\nEND-OF-PATH\n")
    assert toolpath.operations[0].events == (UnknownStatement(0, 2, text),)
    assert [remark.line for remark in toolpath.remarks] == [2]
    assert str(toolpath.remarks[0].severity) == "warning"
    (problem,) = body_fails(text, GO, strict=True)
    assert problem.line == 3


def test_a_statement_is_kept_once_however_much_of_it_is_not_known(read: Read) -> None:
    toolpath = read("TOOL PATH/A,TOOL,T\nCYCLE/DRILL,A,B,C\nGOTO/0,0,0\nEND-OF-PATH\n")
    assert [event for event in toolpath.operations[0].events if isinstance(event, UnknownStatement)] == [
        UnknownStatement(0, 2, "CYCLE/DRILL,A,B,C")
    ]
    (remark,) = toolpath.remarks
    assert all(f"CYCLE with {word} is not known" in remark.what for word in "ABC")


def test_what_is_known_of_a_statement_is_followed(body: Body) -> None:
    events = body(
        "SPINDL/RPM,800,RANGE,2", "LOAD/TOOL,3,LENGTH,80", "COOLNT/MIST,HIGH", "SELECT/TOOL,4,LARGE", GO
    ).events
    assert [event for event in events if not isinstance(event, UnknownStatement)] == [
        SpindleOn(0, 3, 800, Sense.CLW),
        LoadTool(0, 4, 3),
        Coolant(0, 5, "MIST"),
        SelectTool(0, 6, 4),
    ]
    unknown = [event.words for event in events if isinstance(event, UnknownStatement)]
    assert unknown == [("RANGE",), ("LENGTH",), ("HIGH",), ("LARGE",)]


def test_what_only_listings_have_is_nothing(read: Read, body: Body) -> None:
    lines = ("REMARK/roughing", "LEADER/20", "CLPRNT/ON", "CUTTER/10,1", "MACHIN/MILL,1")
    assert body(*lines, GO).events == ()
    assert read("TOOL PATH/A,TOOL,T\n" + "\n".join(lines) + "\nGOTO/0,0,0\nEND-OF-PATH\n").remarks == ()


def test_a_remark_is_made_once_however_often_its_reason_comes_and_the_list_is_capped(read: Read) -> None:
    toolpath = read("TOOL PATH/A,TOOL,T\n" + "WOBBLE\n" * 62 + "GOTO/0,0,0\nEND-OF-PATH\n")
    (remark,) = toolpath.remarks
    assert (remark.line, "(62 times, first here)" in remark.what) == (2, True)
    assert len(toolpath.operations[0].events) == 62
    many = "".join(f"WOBBLE{k}\n" for k in range(150))
    toolpath = read("TOOL PATH/A,TOOL,T\n" + many + "GOTO/0,0,0\nEND-OF-PATH\n")
    assert len(toolpath.remarks) == 101
    assert toolpath.remarks[-1].what == "and 50 more"


@pytest.mark.parametrize("text", ["PAINT/PATH", "PAINT/SPEED,10", "PAINT/TOOL,NOMORE", "PAINT/ARROW"])
def test_how_the_path_is_drawn_is_nothing(read: Read, text: str) -> None:
    toolpath = read(f"TOOL PATH/A,TOOL,T\n{text}\nGOTO/0,0,0\nEND-OF-PATH\n")
    assert toolpath.operations[0].events == ()
    assert toolpath.remarks == ()


def test_majors_are_written_without_blanks() -> None:
    assert all(major == major.upper().replace(" ", "") for major in HANDLERS)


# -- progress -----------------------------------------------------------------------------------------------------


def test_progress_is_told_the_bytes_done() -> None:
    text = "TOOL PATH/A,TOOL,T\nGOTO/0,0,0\nEND-OF-PATH\n"
    seen: list[int] = []
    read_cl_files(io.BytesIO(text.encode()), progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == len(text)
