"""Tool axes, motion words and operations of APT dialects."""

from collections.abc import Callable

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Read
from trunnion.model.toolpath import (
    Coolant,
    From,
    GoHome,
    Kind,
    Message,
    Operation,
    SpindleOn,
)


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
    assert operation.joined == {"catia": ("B",), "ncl": ("FEATNO 2",)}.get(dialect, ())
    told = [event.text for event in operation.events if isinstance(event, Message) and event.row == 2]
    assert told[-1:] == list(operation.joined) or dialect == "solidworks"
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


HOLE = "CYCLE/DRILL,DEPTH,5,CLEAR,2"


@pytest.mark.parametrize(
    ("lines", "count"),
    [
        (["$$-> FEATNO / 2", "RAPID", "GOTO/0,60,50"], 2),
        (["LOADTL/6", "GOTO/0,60,50"], 2),
        (["GOHOME", "GOTO/0,60,50"], 2),
        ([HOLE, "GOTO/0,0,0", "CYCLE/OFF", "$$-> FEATNO / 2", HOLE, "GOTO/0,60,0"], 2),
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
