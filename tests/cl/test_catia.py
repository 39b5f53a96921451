"""What CATIA's files have of their own: tool axes by MULTAX, vectors of compensation, turning, full circles."""

from collections.abc import Callable

import pytest

from tests.support.cl_reading import Fail, Read
from trunnion.model.toolpath import Message, Stop

HEAD = ["$$ CATIA APT VERSION 1.0", "CUTTER/10,1,4,1,0,0,50", "LOADTL/5"]


@pytest.fixture
def axes(read: Read) -> Callable[..., list[list[float]]]:
    """Return a function that gives the tool axes of points."""

    def reader(*lines: str) -> list[list[float]]:
        toolpath = read("\n".join([*HEAD, *lines, "END"]) + "\n")
        assert toolpath.dialect == "catia"
        return [axis for operation in toolpath.operations for axis in operation.moves.axis.tolist()]

    return reader


def test_points_keep_the_last_tool_axis_after_multax_off(axes: Callable[..., list[list[float]]]) -> None:
    assert axes("MULTAX", "GOTO/1,2,3,1,0,0", "MULTAX/OFF", "GOTO/2,2,3", "MULTAX/ON", "GOTO/2,2,3,0,1,0") == [
        [1, 0, 0], [1, 0, 0], [0, 1, 0],
    ]  # fmt: skip


@pytest.mark.parametrize(
    "lines",
    [
        ["TLAXIS/0,0,1", "GOTO/1,2,3", "GOTO/1,2,3,0.6,0.8,0"],
        ["GOTO/1,2,3", "GOTO/1,2,3,1,0,0"],
        ["MULTAX", "MULTAX/OFF", "GOTO/1,2,3,1,0,0"],
        ["MULTAX", "GOTO/1,2,3,0,0,1", "TLAXIS/0,0,1", "GOTO/1,2,3,1,0,0"],
        ["MULTAX", "GOTO/1,2,3,0,0,1", "$$ OPERATION NAME : B", "TLAXIS/0,0,1", "GOTO/1,2,9", "GOTO/1,2,3,1,0,0"],
        ["MULTAX/OFF", "GOTO/1,2,3", "$$ OPERATION NAME : B", "GOTO/1,2,3,1,0,0"],
    ],
)
def test_three_numbers_more_are_tool_axes_after_multax_only(fails: Fail, lines: list[str]) -> None:
    """Without MULTAX they may be the vector along which a control compensates the radius."""
    (problem,) = fails("\n".join([*HEAD, *lines, "END"]))
    assert problem.line == len(HEAD) + len(lines)
    assert "a tool axis, or a vector of compensation" in problem.what
    assert "MULTAX" in problem.cure


def test_the_tool_axis_itself_is_none_in_any_reading(axes: Callable[..., list[list[float]]]) -> None:
    assert axes("TLAXIS/0,1,0", "GOTO/1,2,3,0,1,0", "GOTO/1,2,4") == [[0, 1, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("TOOLNO/1,TURN,1,0,9,    0.4", "belongs to turning"),
        ("SWITCH/9", "belongs to turning"),
        ("TURRET/1,OSETNO,1", "belongs to turning"),
        ("PROBE/POINTS,MMPM,500,DIST,30,5", "until it touches"),
    ],
)
def test_turning_and_probing_are_refused_by_name(fails: Fail, line: str, what: str) -> None:
    (problem,) = fails("\n".join([*HEAD, line, "GOTO/1,2,3", "END"]))
    assert (problem.line, what in problem.what) == (4, True)


def test_a_full_circle_as_the_help_writes_it(read: Read) -> None:
    arc = ["INDIRV/ 0,-1,0", "TLON,GOFWD/ (CIRCLE/ 0,0,0,$", "50.0),ON,2,INTOF,$", "(LINE/ 0,0,0,$", "50,0,0)"]
    (operation,) = read("\n".join([*HEAD, "MULTAX", "GOTO/50,0,0,0,0,1", "AUTOPS", *arc, "END"])).operations
    assert operation.moves.tip.tolist() == [[50, 0, 0], [50, 0, 0]]
    assert (operation.arcs.normal.tolist(), operation.arcs.radius.tolist()) == ([[0, 0, -1]], [50])


def texts_of(read: Read, *lines: str) -> list[str]:
    """Return the texts of a file."""
    toolpath = read("\n".join([*HEAD, *lines, "GOTO/1,2,3", "GOTO/4,5,6", "END"]) + "\n")
    assert toolpath.dialect == "catia"
    assert [tip for operation in toolpath.operations for tip in operation.moves.tip.tolist()] == [[1, 2, 3], [4, 5, 6]]
    events = [event for operation in toolpath.operations for event in operation.events]
    return [event.text for event in events if isinstance(event, Message | Stop)]


def test_a_text_goes_on_behind_a_dollar_sign_in_the_last_column(read: Read) -> None:
    long = f"PPRINT/{'=' * 64}$"
    assert len(long) == 72
    assert texts_of(read, long, "==) ") == ["=" * 66 + ")"]
    assert texts_of(read, f"{long}\r", "==)\r", "STOP/(B)\r") == ["=" * 66 + ")", "(B)"]
    assert texts_of(read, long, "x" * 71 + "$", "$") == ["=" * 64 + "x" * 71 + "$"]
    assert texts_of(read, f"STOP/{'a' * 66}$", "b") == ["a" * 66 + "b"]
    # In another column it is a letter of the text, and so it is in the files of other systems.
    assert texts_of(read, long.replace("==$", "=$"), "PPRINT/B") == ["=" * 63 + "$", "B"]
    (operation,) = read(f"TOOL PATH/A,TOOL,T\n{long}\nGOTO/1,2,3\nGOTO/4,5,6\nEND-OF-PATH\n").operations
    assert [event.text for event in operation.events if isinstance(event, Message)] == ["=" * 64 + "$"]


@pytest.mark.parametrize("line", ["GOTO/1,2,3", "RAPID", "FEDRAT/ 100.0,MMPM", " SPINDL / OFF", "COOLNT/ON"])
def test_a_text_that_would_hide_a_statement_is_refused(fails: Fail, line: str) -> None:
    word = line.partition("/")[0].strip()
    text = f"PPRINT/{'COST ' * 12}1 9 $"
    problem = fails("\n".join([*HEAD, text, line, "GOTO/4,5,6", "GOTO/7,8,9", "END"]))[0]
    assert (problem.code, problem.line) == ("CL160", 4)
    assert problem.what == f"PPRINT has {word} within it, a statement without a line of its own"
