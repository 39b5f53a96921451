"""Arcs of APT dialects, and motion along geometry."""

import math
from collections.abc import Callable

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Fail
from trunnion.model.toolpath import (
    From,
    Kind,
    Operation,
    UnknownStatement,
)

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
    assert str(event.what).endswith(f"may be a damaged {meant}")


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
