"""Statements of APT dialects: what they become, and what is refused by name."""

import math
import re
from collections.abc import Callable

import pytest

from tests.support.cl_reading import Fail, Read
from trunnion.cl.dialects import DIALECTS, recognize_dialect
from trunnion.cli.arguments import DIALECTS as LISTED
from trunnion.model.toolpath import (
    Coolant,
    CycleOn,
    From,
    GoHome,
    Kind,
    LoadTool,
    Message,
    Operation,
    SpindleOn,
    UnknownStatement,
)
from trunnion.planning.holes.cycles import HoleMethod, cycle_from_event

HEADS = {
    "clt": ["UNITS/ MM", "CUTTER/ 10.0,1.0", "OPFEATSTART/Mill1", "ROTABL/ 0.0,AAXIS,TABLE,CCLW"],
    "apt": ["PARTNO A", "UNITS/MM", "CUTTER/10,1", "LOADTL/5"],
    "ncl": ["$$* Pro/CLfile Version 8.0", "UNITS / MM", "LOADTL / 5", "$$-> CUTTER / 10.0"],
    "solidworks": [
        "PARTNO/1",
        "UNIT/MM",
        "INSERT/MILL",
        "CUTTER/10.,0,5.,0,0,0,60.",
        "LOAD/TOOL,5",
        "TRNTYP/WORLD,0,0,0",
    ],
    "fusion": ["PARTNO/'1001'", "UNITS/MM", "PPRINT/'Face1'", "MULTAX/OFF", "CUTTER/10., 1.", "LOADTL/5, 0, 60., 5"],
    "catia": ["$$ CATIA APT VERSION 1.0", "MULTAX", "CUTTER/10,1,4,1,0,0,50", "TPRINT/T5 End Mill", "LOADTL/5"],
}


@pytest.fixture
def apt(read: Read) -> Callable[..., Operation]:
    """Return a function that reads statements of a dialect as one operation."""

    def reader(dialect: str, *lines: str, **options: object) -> Operation:
        toolpath = read("\n".join([*HEADS[dialect], *lines, "FINI"]) + "\n", **options)
        assert toolpath.dialect == dialect
        return toolpath.operations[-1]

    return reader


@pytest.fixture
def refused(fails: Fail) -> Callable[..., str]:
    """Return a function that reads bad statements of a dialect and gives back what is wrong."""

    def reader(dialect: str, *lines: str) -> str:
        problems = fails("\n".join([*HEADS[dialect], "GOTO/0,0,0", *lines, "FINI"]) + "\n")
        return "\n".join(f"{problem.line}: {problem.what}; {problem.cure}" for problem in problems)

    return reader


# -- recognition --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dialect", HEADS)
def test_a_dialect_is_told_by_its_lines(dialect: str) -> None:
    found = recognize_dialect("\n".join(HEADS[dialect]).encode())
    assert found.dialect.name == dialect
    assert re.search(r" in line \d+$", found.why)


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("TOOL PATH/A,TOOL,B\n$$-> CSYS\nMSYS/0\n", "clsf"),
        ("GOTO/1,2,3\n", "clsf"),
        ("", "clsf"),
        ("PPRINT $$*CATIA0\nPPRINT/TOOL PATH/\nLOADTL/1\n", "apt"),
        ("REMARK -> MFGNO / A\nLOADTL/1\n", "ncl"),
        ("  $$*catia0\nLOADTL/1\n", "catia"),
        ("PARTNO A\r\nCYCLE / INIT\r\n", "solidworks"),
    ],
)
def test_marks_count_where_they_begin_a_line_that_is_no_text(text: str, dialect: str) -> None:
    assert recognize_dialect(text.encode()).dialect.name == dialect


def test_a_toolpath_says_what_it_was_read_as_and_why(read: Read) -> None:
    toolpath = read("$$-> MFGNO / A\nLOADTL / 1\nGOTO / 1, 2, 3\nFINI\n")
    assert (toolpath.dialect, toolpath.recognized) == ("ncl", "Creo NCL: $$-> in line 1")


def test_the_dialect_can_be_given(read: Read, fails: Fail) -> None:
    text = "TLAXIS/0,1,0\nGOTO/1,2,3\nGOTO/1,2,3,1,0,0\nGOTO/1,2,4\nFINI\n"
    assert read(text, dialect="apt").operations[0].moves.axis[2].tolist() == [1, 0, 0]
    (problem,) = fails(text, dialect="iso")
    assert problem.cure == f"dialects are {', '.join(DIALECTS)}"


def test_the_command_line_knows_all_dialects() -> None:
    assert tuple(DIALECTS) == LISTED


# -- tool axes ----------------------------------------------------------------------------------------------------


def test_apt_keeps_the_last_tool_axis(apt: Callable[..., Operation]) -> None:
    moves = apt("apt", "MULTAX/ON", "GOTO/1,0,0,1,0,0", "GOTO/2,0,0", "TLAXIS/0,1,0", "GOTO/3,0,0").moves
    assert moves.axis.tolist() == [[1, 0, 0], [1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize("dialect", ["ncl", "solidworks"])
def test_a_point_without_a_tool_axis_is_upright_where_only_tilted_ones_are_written(
    apt: Callable[..., Operation], dialect: str
) -> None:
    moves = apt(dialect, "GOTO/1,0,0,1,0,0", "GOTO/2,0,0", "GODLTA/1,0,0").moves
    assert moves.axis.tolist() == [[1, 0, 0], [0, 0, 1], [0, 0, 1]]
    moves = apt(dialect, "GOTO/1,0,0,1,0,0", "GODLTA/1,0,0").moves
    assert moves.axis.tolist() == [[1, 0, 0], [1, 0, 0]]


def test_multax_off_leaves_no_doubt(apt: Callable[..., Operation], refused: Callable[..., str]) -> None:
    moves = apt("apt", "GOTO/1,0,0,0,0,1", "MULTAX/OFF", "GOTO/2,0,0", "GOTO/2,0,0,1,0,0").moves
    assert moves.axis.tolist() == [[0, 0, 1], [0, 0, 1], [1, 0, 0]]
    assert "after MULTAX/OFF" in refused("apt", "GOTO/1,0,0,1,0,0", "MULTAX/OFF", "GOTO/2,0,0")


def test_a_tilted_system_of_solidworks_needs_tool_axes(refused: Callable[..., str]) -> None:
    csys = "CSYS/0,0,1.,0,0,1.,0,0,-1.,0,0,0"
    assert "without a tool axis" in refused("solidworks", csys, "GOTO/1,2,3")


def test_the_tool_axis_goes_on_from_operation_to_operation(read: Read) -> None:
    lines = ["$$ OPERATION NAME : B", "RAPID", "GOTO/2,0,0"]
    lines += ["$$ OPERATION NAME : C", "TLAXIS/0,1,0", "RAPID", "GOTO/3,0,0"]
    toolpath = read("\n".join([*HEADS["catia"], "GOTO/1,0,0,1,0,0", *lines, "FINI"]))
    assert [operation.name for operation in toolpath.operations] == ["OPERATION 1", "B", "C"]
    assert [operation.moves.axis[0].tolist() for operation in toolpath.operations] == [[1, 0, 0], [1, 0, 0], [0, 1, 0]]


# -- points that are not tips -------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [9, 12])
def test_more_numbers_are_never_taken_for_tip_and_axis(refused: Callable[..., str], count: int) -> None:
    numbers = ",".join(["0"] * (count - 1) + ["1"])
    assert "compensation vector, or a contact point" in refused("catia", f"GOTO/{numbers}")
    assert f"GOTO has {count} numbers" in refused("apt", f"GOTO/{numbers}")


@pytest.mark.parametrize(("dialect", "mode"), [("catia", "NORMDS"), ("catia", "NORMPS"), ("apt", "ENDPT")])
def test_compensation_in_space_is_refused(refused: Callable[..., str], dialect: str, mode: str) -> None:
    assert "compensation in space" in refused(dialect, f"CUTCOM/{mode}", "GOTO/1,2,3,0,0,1")


# -- arcs ---------------------------------------------------------------------------------------------------------

XY = ["AUTOPS", "INDIRV/ 0.0, 1.0, 0.0", "TLON,GOFWD/ (CIRCLE/ 40.0, 20.0, 0.0,$", " 10.0),ON,(LINE/ 40.0, 20.0, 0.0,$"]


def test_a_circle_ends_where_its_line_does(apt: Callable[..., Operation]) -> None:
    operation = apt("catia", "GOTO/50,20,0", *XY, " 40.0, 30.0, 0.0)")
    assert operation.moves.tip.tolist() == [[50, 20, 0], [40, 30, 0]]
    assert operation.moves.kind.tolist() == [Kind.LINEAR, Kind.ARC]
    assert (operation.arcs.normal.tolist(), operation.arcs.radius.tolist()) == ([[0, 0, 1]], [10])


def test_the_direction_gives_the_sense(apt: Callable[..., Operation]) -> None:
    clockwise = [line.replace("0.0, 1.0, 0.0", "0.0, -1.0, 0.0") for line in XY]
    clockwise[3] = clockwise[3].replace("ON,", "ON,2,INTOF,")
    operation = apt("catia", "GOTO/50,20,0", *clockwise, " 40.0, 30.0, 0.0)")
    assert operation.arcs.normal.tolist() == [[0, 0, -1]]


def test_a_line_that_only_points_to_the_end_is_followed_to_the_circle(apt: Callable[..., Operation]) -> None:
    operation = apt("ncl", "GOTO / 50,20,0", *XY, " 40.0, 90.0, 0.0)")
    assert operation.moves.tip[1].tolist() == [40, 30, 0]


def test_a_circle_stands_in_the_plane_of_its_direction(apt: Callable[..., Operation]) -> None:
    lines = ["INDIRV/0,0,1", "TLON,GOFWD/(CIRCLE/25,0,-30,$", "4.6),ON,(LINE/25,0,-30,25,0,-25.4)"]
    operation = apt("catia", "GOTO/20.4,0,-30", *lines)
    assert operation.arcs.normal.tolist() == [[0, 1, 0]]


def test_a_cylinder_stands_in_any_plane(apt: Callable[..., Operation]) -> None:
    s = math.sqrt(0.5)
    lines = [
        "PSIS/(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,-0.707107,0.707107))",
        "INDIRV/0,0.707107,0.707107",
        "TLON,GOFWD/(CYLNDR/0,0,0,0,-0.707107,0.707107,10),ON,(PLANE/PERPTO,$",
        "(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,-0.707107,0.707107)),(POINT/0,0,0),$",
        f"(POINT/-6,{8 * s:.6f},{8 * s:.6f}))",
    ]
    operation = apt("catia", "GOTO/10,0,0", *lines)
    assert operation.arcs.normal[0].tolist() == pytest.approx([0, -s, s], abs=1e-6)
    assert operation.moves.tip[1].tolist() == pytest.approx([-6, 8 * s, 8 * s], abs=1e-6)


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        (["GOTO/50,20,0", *XY[2:], "40,30,0)"], "GOFWD without INDIRV"),
        (["GOTO/50,20,0", "INDIRV/1,0,0", *XY[2:], "40,30,0)"], "INDIRV is not the tangent"),
        (["GOTO/50,20,0", *XY, "40,10,0)"], "does not meet the line for the first time"),
        (["GOTO/50,20,0", "INDIRV/0,1,0", "GOFWD/L1,ON,L2"], "along other geometry"),
        (["GOTO/50,20,0", *XY[:3], "10.0),ON,(LINE/ 41.0,20,0,40,30,0)"], "does not begin in the centre"),
        (["GOTO/60,20,0", *XY, "40,30,0)"], "off its radius"),
    ],
)
def test_arcs_that_are_in_doubt_are_refused(refused: Callable[..., str], lines: list[str], what: str) -> None:
    assert what in refused("catia", *lines)


@pytest.mark.parametrize(
    "word", ["TLLFT,GOFWD", "TLRGT,GOFWD", "TLON,GOLFT", "TLON,GOBACK", "TLONPS,TLON,GOFWD", "GO,TO"]
)
@pytest.mark.parametrize("dialect", ["apt", "clsf"])
def test_motion_along_geometry_is_refused_by_each_of_its_words(fails: Fail, dialect: str, word: str) -> None:
    lines = [*HEADS["apt"], "GOTO/0,0,0", "INDIRV/0,1,0", f"{word}/(CIRCLE/5,0,0,5),ON,(LINE/5,0,0,5,5,0)", "FINI"]
    if dialect == "clsf":
        lines = ["TOOL PATH/A,TOOL,T", *lines[4:5], *lines[6:7], "END-OF-PATH"]
    problems = fails("\n".join(lines) + "\n")
    assert [problem.what for problem in problems] == [f"{word} is motion that cannot be read"]


@pytest.mark.parametrize(
    "lines",
    [
        ["INDIRV/0,1,0", "GOTO/60,20,0"],
        ["INDIRV/0,1,0"],
        ["INDIRV/0,1,0", "INDIRV/0,1,0", *XY[2:], "40,30,0)"],
        ["INDIRV/0,1,0", "GOTO/50,20,0", "AUTOPS", *XY[2:], "40,30,0)"],
    ],
)
def test_an_arc_that_is_lost_behind_its_direction_is_refused(refused: Callable[..., str], lines: list[str]) -> None:
    assert refused("catia", "GOTO/50,20,0", *lines).startswith("8: INDIRV without its arc")


@pytest.mark.parametrize(
    ("dialect", "statement", "meant"),
    [
        ("solidworks", "UNTI/INCH", "UNIT"),
        ("solidworks", "TRNTPY/LOCAL,0,0,0", "TRNTYP"),
        ("solidworks", "CSXS/1,0,0,0,0,1,0,0,0,0,1,0", "CSYS"),
        ("ncl", "$$-> CUTER / 8", "CUTTER"),
        ("catia", "OUTOL/0.1", "OUTTOL"),
        ("catia", "TLONGOFWD/(CIRCLE/5,0,0,5),ON,(LINE/5,0,0,5,5,0)", "TLON,GOFWD"),
        ("apt", "CLERP/XYPLAN,5", "CLEARP"),
    ],
)
def test_a_damaged_word_of_a_dialect_is_never_dropped(
    apt: Callable[..., Operation], dialect: str, statement: str, meant: str
) -> None:
    (event,) = (e for e in apt(dialect, "GOTO/0,0,0", statement).events if isinstance(e, UnknownStatement))
    assert event.acts
    assert event.what.endswith(f"may be a damaged {meant}")


@pytest.mark.parametrize("statement", ["CLAMP,ON", "SHOPWD,ROTATE,90"])
def test_each_word_of_a_statement_without_a_slash_is_judged(apt: Callable[..., Operation], statement: str) -> None:
    (event,) = (e for e in apt("apt", "GOTO/0,0,0", statement).events if isinstance(e, UnknownStatement))
    assert event.acts


def test_the_start_gives_the_radius(apt: Callable[..., Operation], refused: Callable[..., str]) -> None:
    operation = apt("solidworks", "GOTO/5,0,0", "CIRCLE/0,0,0,0,0,-1", "GOTO/0,-5,0")
    assert (operation.arcs.radius.tolist(), operation.arcs.normal.tolist()) == ([5], [[0, 0, -1]])
    assert "off its radius" in refused("solidworks", "GOTO/5,0,0", "CIRCLE/0,0,0,0,0,-1", "GOTO/0,-5.1,0")


def test_an_arc_may_be_the_first_row_of_an_operation_that_goes_on(apt: Callable[..., Operation]) -> None:
    operation = apt("ncl", "GOTO / 5,0,0", "LOADTL / 6", "CIRCLE / 0,0,0,0,0,1,5", "GOTO / 0,5,0")
    assert operation.name == "OPERATION 2"
    assert [event.tip for event in operation.events if isinstance(event, From)] == [(5, 0, 0)]
    assert operation.arcs.radius.tolist() == [5]


def test_movarc_counts_turns(apt: Callable[..., Operation]) -> None:
    operation = apt("apt", "GOTO/5,0,0", "MOVARC/0,0,0,0,0,1,5,ANGLE,450", "GOTO/0,5,3")
    assert operation.arcs.full_turns.tolist() == [1]


HALF = ["GOTO / 5,0,0", "CIRCLE / 0,0,0,0,0,1,5", "GOTO / 3,4,0"]


def test_points_that_may_belong_to_an_arc_of_creo_are_refused(apt: Callable[..., Operation], fails: Fail) -> None:
    text = "\n".join([*HEADS["ncl"], *HALF, "GOTO / -5,0,0", "FINI"])
    (problem,) = fails(text)
    assert (problem.line, problem.what[:32]) == (6, "a point of the same circle follo")
    assert "ARC_ONLY" in problem.cure
    for lines in (["GOTO / 3,-4,9"], ["RAPID", "GOTO / -5,0,0"], ["GOTO / -5,0,0", *HALF[1:], "GOTO / 9,9,0"]):
        assert len(apt("ncl", *HALF, *lines).arcs.row) == len(lines) // 3 + 1
    assert len(apt("ncl", *HALF, "GOTO / 2.9,4.0731,0").arcs.row) == 1  # as near as a line would be


# -- cycles -------------------------------------------------------------------------------------------------------


def cycle(operation: Operation) -> CycleOn:
    """The only cycle of an operation."""
    (found,) = (event for event in operation.events if isinstance(event, CycleOn))
    return found


@pytest.mark.parametrize(
    ("dialect", "statement", "method", "heights", "pecks"),
    [
        ("ncl", "CYCLE / DEEP, DEPTH, 12, STEP, 4, MMPM, 50, CLEAR,$\n 1", HoleMethod.DEEP_DRILLING, (1, 12, 1), 4),
        ("ncl", "CYCLE / BRKCHP, DEPTH, 12, STEP, 4, MMPM, 50, CLEAR, 1", HoleMethod.CHIP_BREAKING, (1, 12, 1), 4),
        ("ncl", "CYCLE / DRILL, DEPTH, 9, MMPM, 50, CLEAR, 5, RAPTO, 3, RETURN, 9", HoleMethod.DRILL, (2, 9, 9), 0),
        ("ncl", "CYCLE / DRILL, DEPTH, 9, MMPM, 50, CLEAR, 5, RETURN, 0", HoleMethod.DRILL, (5, 9, None), 0),
        ("ncl", "CYCLE / DRILL, DEPTH, 9, MMPM, 50, CLEAR, 5, RAPTO, 3", HoleMethod.DRILL, (2, 9, 5), 0),
        ("solidworks", "CYCLE/DRILL,FEDTO,5,MMPM,9,RAPTO,3.,RTRCTO,27,DWELL,0", HoleMethod.DRILL, (3, 5, 27), 0),
        (
            "solidworks",
            "CYCLE/DEEP2,FEDTO,28.6,1STPECK,5.,SUBPECK,2.,MMPM,9,RAPTO,3.,RTRCTO,27",
            HoleMethod.DEEP_DRILLING,
            (3, 28.6, 27),
            5,
        ),
        ("solidworks", "CYCLE/DEEP,FEDTO,3,INCR,10.,MMPM,9,RAPTO,2,RTRCTO,4", HoleMethod.DEEP_DRILLING, (2, 3, 4), 10),
        ("catia", "CYCLE/DRILL,    3.000000,    5.000000", HoleMethod.DRILL, (5, 3, 5), 0),
        ("catia", "CYCLE/DRILL,    3.0,    5.0,  80.0,MMPM", HoleMethod.DRILL, (5, 3, 5), 0),
        ("catia", "CYCLE/TAP,   50.786017,    1.000000", HoleMethod.TAP, (1, 50.786017, 1), 0),
        ("apt", "CYCLE/DRILL,FEDTO,7,MMPM,9,RAPTO,2,RTRCTO,6", HoleMethod.DRILL, (2, 7, 6), 0),
        ("apt", "CYCLE/DEEP,FEDTO,7,STEP,3,MMPM,9,RAPTO,2", HoleMethod.DEEP_DRILLING, (2, 7, 2), 3),
    ],
)
def test_cycles_by_the_words_of_their_dialect(
    apt: Callable[..., Operation],
    dialect: str,
    statement: str,
    method: HoleMethod,
    heights: tuple[float, float, float | None],
    pecks: float,
) -> None:
    found = cycle_from_event(cycle(apt(dialect, "GOTO/0,0,9", statement, "GOTO/0,0,0", "CYCLE/OFF")))
    assert (found.method, (found.rapid_height, found.depth, found.retract_height)) == (method, heights)
    assert found.pecks[0] == pecks


def test_later_pecks_of_solidworks_are_of_one_length(apt: Callable[..., Operation]) -> None:
    statement = "CYCLE/DEEP2,FEDTO,28,1STPECK,5.,SUBPECK,2.,MMPM,9,RAPTO,3.,RTRCTO,27"
    assert dict(cycle(apt("solidworks", statement, "GOTO/0,0,0")).values)["STEP"] == (5, 3, 2)


def test_pecks_that_grow_are_all_as_long_as_the_first(read: Read) -> None:
    lines = [
        *HEADS["solidworks"],
        "CYCLE/DEEP2,FEDTO,45,1STPECK,5.,SUBPECK,30.,MMPM,9,RAPTO,3.,RTRCTO,27",
        "GOTO/0,0,0",
    ]
    toolpath = read("\n".join([*lines, "CYCLE/OFF", "FINI"]) + "\n")
    assert dict(cycle(toolpath.operations[-1]).values)["STEP"] == (5,)
    (remark,) = toolpath.remarks
    assert remark.what == "pecks of 30 behind a first one of 5: all are made as long as the first"


@pytest.mark.parametrize(
    ("dialect", "statement", "what"),
    [
        ("apt", "CYCLE/DRILL, 12.0, MMPM, 80.0, 5.0", "numbers without words"),
        ("apt", "CYCLE/THRU,FEDTO,5,RAPTO,1", "differs from post-processor"),
        ("apt", "CYCLE/BORE,FEDTO,5,RAPTO,1", "differs from post-processor"),
        ("ncl", "CYCLE / THRU, DEPTH, 5, CLEAR, 1", "no real file"),
        ("ncl", "CYCLE / DRILL, 5, 100, MMPM, 1", "numbers without words"),
        ("ncl", "CYCLE / DRILL, DEPTH, 5", "without CLEAR"),
        ("ncl", "CYCLE / DRILL, DEPTH, 5, CLEAR, 1, RAPTO, 2", "passes the point"),
        ("catia", "CYCLE/DRILL, 3, 5, 6, 7", "numbers without words"),
        ("catia", "CYCLE/DRILL, 3, 5, 6", "a feed without a unit"),
        ("solidworks", "CYCLE/DEEP2,FEDTO,5,1STPECK,1,RAPTO,1", "one of 1STPECK and SUBPECK"),
        ("solidworks", "CYCLE/DEEP2,FEDTO,5,1STPECK,1,SUBPECK,0,RAPTO,1", "SUBPECK that is not above 0"),
    ],
)
def test_cycles_in_doubt_are_refused(refused: Callable[..., str], dialect: str, statement: str, what: str) -> None:
    assert what in refused(dialect, statement)


# -- tools --------------------------------------------------------------------------------------------------------


def test_a_tool_has_the_form_of_its_cutter(apt: Callable[..., Operation]) -> None:
    mill = apt("apt", "GOTO/0,0,0", "CUTTER/12,2,4,2,0,3,55", "GOTO/1,2,3").tool
    assert (mill.kind, mill.diameter, mill.corner_radius, mill.taper_angle, mill.length) == ("MILL", 12, 2, 3, 55)
    drill = apt("apt", "GOTO/0,0,0", "CUTTER/12.,0,6.,3.605164,31.,0,63.", "GOTO/1,2,3").tool
    assert (drill.kind, drill.diameter, drill.tip_angle, drill.length) == ("DRILL", 12, 118, 63)


def test_a_tool_that_is_loaded_is_not_loaded_again(read: Read) -> None:
    lines = ["LOADTL/5,1", "GOTO/1,0,0", "LOADTL/5,1", "LOADTL/5", "GOTO/2,0,0", "LOADTL/6", "GOTO/3,0,0"]
    toolpath = read("\n".join([*HEADS["catia"], *lines, "FINI"]))
    assert [len(operation.moves) for operation in toolpath.operations] == [2, 1]
    loads = [[e for e in operation.events if isinstance(e, LoadTool)] for operation in toolpath.operations]
    assert [[(load.row, load.number, load.adjust) for load in each] for each in loads] == [[(0, 5, 1)], [(0, 6, 0)]]
    assert [operation.tool.diameter for operation in toolpath.operations] == [10, 0]


def test_a_tool_of_the_same_form_keeps_it(read: Read) -> None:
    lines = ["GOTO/1,0,0", "CUTTER/10,1", "LOADTL/6", "GOTO/2,0,0", "LOADTL/7", "CUTTER/10,1", "GOTO/3,0,0"]
    toolpath = read("\n".join([*HEADS["apt"], *lines, "FINI"]))
    assert [operation.tool.diameter for operation in toolpath.operations] == [10, 10, 10]


def test_another_tool_has_not_the_name_of_the_one_before(read: Read) -> None:
    lines = [
        "GOTO/1,0,0",
        "CUTTER/10,1,4,1,0,0,50",
        "LOADTL/6",
        "GOTO/2,0,0",
        "TPRINT/THIRD",
        "LOADTL/7",
        "GOTO/3,0,0",
    ]
    toolpath = read("\n".join([*HEADS["catia"], *lines, "FINI"]))
    assert [operation.tool.name for operation in toolpath.operations] == ["T5 End Mill", "", "THIRD"]


@pytest.mark.parametrize(
    ("statement", "adjust"),
    [("LOADTL/7,LENGTH,150.5,OSETNO,12", 12), ("LOADTL/7, 0, 80.5, 3", 3), ("LOAD/7", 0), ("LOADTL/7,2", 2)],
)
def test_forms_of_loadtl(apt: Callable[..., Operation], statement: str, adjust: int) -> None:
    operation = apt("apt", "GOTO/0,0,0", statement, "GOTO/1,0,0")
    assert [(e.number, e.adjust) for e in operation.events if isinstance(e, LoadTool)][-1] == (7, adjust)


def test_notes_of_solidworks_never_go_into_the_program_as_they_are(apt: Callable[..., Operation]) -> None:
    operation = apt("solidworks", "GOTO/1,2,3")
    assert operation.tool.name == "MILL"
    assert [event.text for event in operation.events if isinstance(event, Message)] == ["MILL"]


# -- coordinate systems -------------------------------------------------------------------------------------------


def test_the_system_of_a_file_may_not_change(refused: Callable[..., str], read: Read) -> None:
    csys = "$$-> CSYS / 1,0,0,{},  $\n  0,1,0,0,  $\n 0,0,1,0"
    assert "coordinate system of the points changes" in refused("ncl", csys.format(0), csys.format(5))
    text = "\n".join([*HEADS["ncl"], csys.format(5), "GOTO / 1,2,3", csys.format(5), "GOTO / 1,2,4", "FINI"])
    assert read(text).system[3] == 5


def test_the_matrix_of_catia_is_read_in_its_lines(read: Read, refused: Callable[..., str]) -> None:
    matrix = ["$$*CATIA0", "$$ A", "$$ 1.0 0.0 0.0 -220.0", "$$ 0.0 1.0 0.0 0.0", "$$ 0.0 0.0 1.0 20.0"]
    text = "\n".join([*matrix, "LOADTL/1", "GOTO/1,2,3", "FINI"])
    assert read(text).system == (1, 0, 0, -220, 0, 1, 0, 0, 0, 0, 1, 20)
    assert "three lines of four numbers" in refused("catia", *matrix[:4], "$$ 0.0 0.0")


@pytest.mark.parametrize(
    ("statement", "what"),
    [
        ("ROTABL/ATANGL,90", "turns a rotary axis"),
        ("ROTATE/CAXIS,90", "turns a rotary axis"),
        ("TRANS/1,2,3", "TRANS/1,2,3 shifts or turns"),
        ("ORIGIN/0,0,5", "ORIGIN/0,0,5 shifts or turns"),
        ("COPY/1,TRANSL,1,2,3,4", "repeats, shifts or turns"),
        ("INDEX/1", "repeats, shifts or turns"),
        ("MACRO/A", "statement of an APT part program"),
        ("CALL/M1,A=5", "statement of an APT part program"),
        ("M1 = MACRO/A", "M1 is defined here"),
        ("P1 = POINT/1,2,3", "P1 is defined here"),
        ("LOOPST", "statement of an APT part program"),
        ("GORGT/L1,PAST,L2", "statement of an APT part program"),
        ("1009/ 73, 12", "the word is the number 1009"),
        ("5.0, 6.0, 7.0", "numbers without a word"),
        ("MODE/INCR,ON", "would count from each other"),
        ("MOVE/1,2,3", "MOVE is motion"),
        ("HELICAL/CENTER,0,0,0,INDIRV,0,1,0,AXIS,0,0,1,PITCH,1,RADIUS,5,ANGLE,90,END,0,5,1", "HELICAL is motion"),
        ("SCALE/2", "SCALE repeats, shifts or turns"),
        ("RETRCT", "without a clearance plane"),
        ("CLRSRF/YZPLAN,5", "not a plane of constant Z"),
    ],
)
def test_what_moves_and_is_not_understood_is_refused_by_name(
    refused: Callable[..., str], statement: str, what: str
) -> None:
    found = refused("apt", statement)
    assert what in found
    assert found.startswith("6: ")


@pytest.mark.parametrize("statement", ["TRANS/0,0,0", "ORIGIN/0,0", "TRANS/1,0,0,0,0,1,0,0,0,0,1,0"])
def test_a_shift_by_nothing_is_nothing(apt: Callable[..., Operation], statement: str) -> None:
    assert len(apt("apt", statement, "GOTO/1,2,3").moves) == 1


# -- motion words -------------------------------------------------------------------------------------------------


def test_retrct_goes_up_to_the_clearance_plane(apt: Callable[..., Operation], refused: Callable[..., str]) -> None:
    moves = apt("apt", "CLEARP/XYPLAN,50", "GOTO/1,2,3", "RETRCT", "GOTO/1,2,80", "RETRCT").moves
    assert moves.tip.tolist() == [[1, 2, 3], [1, 2, 50], [1, 2, 80], [1, 2, 80]]
    assert moves.kind.tolist() == [Kind.LINEAR, Kind.RAPID, Kind.LINEAR, Kind.RAPID]
    assert "tilted tool axis" in refused("apt", "CLRSRF/50", "GOTO/1,2,3,1,0,0", "RETRCT")


def test_home_ends_an_operation(read: Read) -> None:
    toolpath = read("\n".join([*HEADS["apt"], "GOTO/1,2,3", "GOHOME", "GOTO/4,5,6", "FINI"]))
    first, second = toolpath.operations
    assert [event.row for event in first.events if isinstance(event, GoHome)] == [1]
    assert len(second.moves) == 1


def test_blanks_may_stand_in_words(apt: Callable[..., Operation]) -> None:
    operation = apt("apt", "S P INDL / 900 , R P M , C L W", "GO TO / 1 , 2 , 3")
    assert [event.rpm for event in operation.events if isinstance(event, SpindleOn)] == [900]
    assert operation.moves.tip.tolist() == [[1, 2, 3]]


@pytest.mark.parametrize(
    ("statement", "feed"),
    [
        ("FEDRAT/100,MMPM", 100),
        ("FEDRAT/MMPM,100", 100),
        ("FEDRAT/100,PERMIN", 100),
        ("FEDRAT/1,FPM", 304.8),
        ("FEDRAT/100.", 100),
    ],
)
def test_feeds_in_either_order(apt: Callable[..., Operation], statement: str, feed: float) -> None:
    assert apt("apt", statement, "GOTO/1,2,3").moves.feed.tolist() == [feed]


def test_inverse_time_of_creo_is_no_feed(apt: Callable[..., Operation]) -> None:
    lines = ["FEDRAT / 100, MMPM", "FEDRAT / INVERS, AUTO", "GOTO / 1,2,3", "FEDRAT / INVERS, OFF", "GOTO / 2,2,3"]
    assert apt("ncl", *lines).moves.feed.tolist() == [100, 100]


def test_feed_and_cycle_go_on_in_the_next_operation(apt: Callable[..., Operation]) -> None:
    lines = ["FEDRAT/100,MMPM", "CYCLE/DRILL,3,5", "GOTO/1,2,3", "$$ OPERATION NAME : B", "GOTO/4,5,6", "CYCLE/OFF"]
    operation = apt("catia", *lines)
    assert operation.moves.feed.tolist() == [100]
    assert cycle(operation).row == 0


CUT_ON = ["RAPID", "GOTO/0,0,50", "FEDRAT/200,MMPM", "GOTO/0,0,-10"]


@pytest.mark.parametrize(
    ("dialect", "boundary"),
    [
        ("catia", "$$ OPERATION NAME : B"),
        ("ncl", "$$-> FEATNO / 2"),
        ("solidworks", "INSERT/CHECK THE DEPTH"),
        ("solidworks", "TRNTYP/WORLD,0,0,0"),
        ("solidworks", "SPINDL/900,RPM,CLW"),
        ("apt", "CYCLE/OFF"),
    ],
)
def test_a_cut_goes_on_from_one_operation_into_the_next(read: Read, dialect: str, boundary: str) -> None:
    lines = [*HEADS[dialect], *CUT_ON, boundary, "GOTO/0,60,-10", "RAPID", "GOTO/0,0,50"]
    toolpath = read("\n".join([*lines, "FINI"]) + "\n")
    (operation,) = toolpath.operations
    assert operation.moves.tip[:, 2].tolist() == [50, -10, -10, 50]
    assert operation.moves.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.LINEAR, Kind.RAPID]
    assert operation.moves.feed[2] == 200
    said = [remark.line for remark in toolpath.remarks if "they are one operation" in remark.what]
    assert said == ([] if dialect == "apt" else [len(HEADS[dialect]) + len(CUT_ON) + 1])


def test_an_arc_goes_on_with_its_events_and_the_smaller_tolerance(apt: Callable[..., Operation]) -> None:
    lines = ["INTOL/0.01", *CUT_ON, "COOLNT/FLOOD", "$$-> FEATNO / 2", "COOLNT/MIST", "INTOL/0.005"]
    operation = apt("ncl", *lines, "CIRCLE/10,0,-10,0,0,1,10", "GOTO/20,0,-10")
    assert (operation.arcs.row.tolist(), operation.intol) == ([2], 0.005)
    assert [(event.row, event.kind) for event in operation.events if isinstance(event, Coolant)] == [
        (2, "FLOOD"),
        (2, "MIST"),
    ]
    assert not any(isinstance(event, From) for event in operation.events)


@pytest.mark.parametrize(
    ("lines", "count"),
    [
        (["$$-> FEATNO / 2", "RAPID", "GOTO/0,60,50"], 2),
        (["LOADTL/6", "GOTO/0,60,50"], 2),
        (["GOHOME", "GOTO/0,60,50"], 2),
        (["CYCLE/DRILL,DEPTH,5,CLEAR,2", "GOTO/0,0,0", "$$-> FEATNO / 2", "GOTO/0,60,0"], 2),
        (["$$-> FEATNO / 2", "FROM/0,60,50", "GOTO/0,60,0"], 2),
        (["$$-> FEATNO / 2", "GOTO/0,60,0", "$$-> FEATNO / 3", "GOTO/0,70,0"], 1),
    ],
)
def test_where_no_cut_goes_on_the_operations_stay_apart(read: Read, lines: list[str], count: int) -> None:
    toolpath = read("\n".join([*HEADS["ncl"], *CUT_ON, *lines, "FINI"]) + "\n")
    assert len(toolpath.operations) == count


def test_another_register_of_the_tool_in_a_cut_is_refused(refused: Callable[..., str]) -> None:
    assert "another register" in refused("apt", *CUT_ON, "LOADTL/5,7", "GOTO/0,60,-10")


def test_a_rapid_belongs_to_the_operation_of_its_point(apt: Callable[..., Operation]) -> None:
    operation = apt("catia", "GOTO/1,2,3", "RAPID", "$$ OPERATION NAME : B", "GOTO/4,5,6")
    assert operation.moves.kind.tolist() == [Kind.RAPID]


def test_an_unknown_statement_is_kept_with_its_line(apt: Callable[..., Operation], refused: Callable[..., str]) -> None:
    operation = apt("apt", "GOTO/1,2,3", "SHOPWD/4", "GOTO/1,2,4")
    (found,) = (event for event in operation.events if isinstance(event, UnknownStatement))
    assert (found.text, found.line, found.row) == ("SHOPWD/4", 6, 1)


def test_other_commands_of_creo_are_comments(read: Read, fails: Fail, refused: Callable[..., str]) -> None:
    text = "\n".join([*HEADS["ncl"], "$$-> SETSTART / 1", "GOTO / 1,2,3", "$$-> SETSTART / 2", "FINI"])
    toolpath = read(text)
    assert [(problem.line, "(2 times" in problem.what) for problem in toolpath.remarks] == [(5, True)]
    assert not any(isinstance(event, UnknownStatement) for event in toolpath.operations[0].events)
    assert len(fails(text, strict=True)) == 2
    assert "TRACUT repeats" in refused("ncl", "$$-> TRACUT / 1")


def test_an_alias_of_creo_may_put_commands_into_remarks(apt: Callable[..., Operation]) -> None:
    operation = apt("ncl", "REMARK -> FEATNO / 9", "REMARK -> CUTTER / 6.5", "REMARK any $ text", "GOTO / 1,2,3")
    assert (operation.name, operation.tool.diameter) == ("FEATNO 9", 6.5)


@pytest.mark.parametrize("dialect", [name for name in HEADS if name != "clsf"])
def test_no_beginning_of_a_file_is_taken_for_the_whole(read: Read, fails: Fail, dialect: str) -> None:
    lines = [*HEADS[dialect], "GOTO/1,2,3", "GOTO/1,2,35", "COOLNT/OFF"]
    text = "\n".join([*lines, "FINI"])
    assert len(read(text).operations[0].moves) == 2
    behind_last_motion = text.index("COOLNT/OFF")
    for length in range(text.index("GOTO") + 6, len(text)):
        assert fails(text[:length]), text[:length]
    (problem,) = fails(text[:behind_last_motion])
    assert "no FINI" in problem.what
    (problem,) = fails(text[: behind_last_motion - 2], dialect=dialect)
    assert f"in the middle of line {len(lines) - 1}" in problem.what


def test_motion_behind_the_end_needs_an_end_of_its_own(read: Read, fails: Fail) -> None:
    text = "\n".join([*HEADS["apt"], "GOTO/1,2,3", "FINI", "GOTO/1,2,4", ""])
    (problem,) = fails(text)
    assert "no FINI" in problem.what
    assert sum(len(operation.moves) for operation in read(text + "END\n").operations) == 2


def test_a_unit_other_than_that_of_the_file_is_warned_of(read: Read) -> None:
    text = "\n".join([*HEADS["apt"], "GOTO/1,2,3", "FINI", ""])
    (remark,) = read(text, units="inch").remarks
    assert remark.line == 2
    assert "states another length unit than inch" in remark.what
    assert read(text, units="mm").remarks == ()
