"""Mastercam NCI: pairs of lines become motion, tools and switches, and what is not known is refused by name."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support import nci
from tests.support.cl_dialects import Step, Z, write_in
from tests.support.cl_paths import changes, content, paths
from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.cl import ClReading, can_be_unknown, read_cl, unknown_statements
from trunnion.cl.dialects import recognize_dialect
from trunnion.cl.read import read_source
from trunnion.cl.sources import cl_sources
from trunnion.errors import InputError, Problem
from trunnion.model.toolpath import (
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Insert,
    Kind,
    LoadTool,
    Message,
    SpindleOff,
    SpindleOn,
    Toolpath,
)
from trunnion.planning.holes.cycles import Cycle

CUT = [
    *nci.tool(3, 10, 1, 900),
    *nci.line(0, (0, 0, 50), -2),
    *nci.line(1, (0, 0, -2), 300),
    *nci.line(1, (20, 0, -2), -1),
]

Reads = Callable[..., Toolpath]
Fails = Callable[..., tuple[Problem, ...]]


@pytest.fixture
def reads(tmp_path: Path) -> Reads:
    def read(*lines: str, units: str | None = "mm", cutcom: str | None = None) -> Toolpath:
        file = tmp_path / "part.nci"
        file.write_text(nci.file_of(*lines), encoding="utf-8")
        return read_cl(file, ClReading(units=units, cutcom=cutcom))

    return read


@pytest.fixture
def fails(reads: Reads) -> Fails:
    def fail(*lines: str, **how: str) -> tuple[Problem, ...]:
        with pytest.raises(InputError) as caught:
            reads(*lines, **how)
        return caught.value.problems

    return fail


def test_it_is_told_by_its_header() -> None:
    found = recognize_dialect("\n".join(nci.header()).encode())
    assert (found.dialect.name, str(found.why)) == ("nci", "1050 in line 1")


def test_lines_five_axis_lines_tool_and_feeds(reads: Reads) -> None:
    toolpath = reads(*CUT, *nci.five_axis((20, 5, -2), (0.6, 0, 0.8), 250), *nci.line(0, (0, 0, 9), -2)[:0])
    assert (toolpath.part, toolpath.dialect) == ("PART", "nci")
    (operation,) = toolpath.operations
    moves = operation.moves
    assert moves.tip.tolist() == [[0, 0, 50], [0, 0, -2], [20, 0, -2], [20, 5, -2]]
    assert moves.axis.tolist() == [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0.6, 0, 0.8]]
    assert moves.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.LINEAR, Kind.LINEAR]
    assert moves.feed[1:].tolist() == [300, 300, 250]
    assert moves.line.tolist() == [11, 13, 15, 17]
    assert (operation.tool.diameter, operation.tool.corner_radius) == (10, 1)
    load, spindle = operation.events
    assert isinstance(load, LoadTool)
    assert isinstance(spindle, SpindleOn)
    assert (load.number, spindle.rpm, spindle.sense) == (3, 900, "CLW")


def test_lengths_and_feeds_are_in_the_unit_that_is_given_and_none_is_stated(reads: Reads) -> None:
    moves = reads(*CUT, units="inch").operations[0].moves
    assert (moves.tip[2, 0], moves.feed[2]) == (508.0, 7620.0)
    assert not reads(*CUT, units=None).states_unit


def test_a_negative_speed_turns_counter_clockwise_and_0_stops(reads: Reads) -> None:
    toolpath = reads(
        *nci.tool(3, 10, 1, -900, 3), *CUT[10:], *nci.tool(4, 8, 0, 0), *nci.line(0, (0, 0, 50), -2),
    )  # fmt: skip
    first, second = toolpath.operations
    assert [event.sense for event in first.events if isinstance(event, SpindleOn)] == ["CCLW"]
    assert [event.kind for event in first.events if isinstance(event, Coolant)] == ["THRU"]
    assert any(isinstance(event, SpindleOff) for event in second.events)
    assert [event.kind for event in second.events if isinstance(event, Coolant)] == ["OFF"]


def test_a_null_tool_change_begins_an_operation_with_the_same_tool(reads: Reads) -> None:
    null = ["1008", "SECOND", "1000", "0 100 2 3 0 0 0 900 0. 0 0. 0. 0."]
    first, second = reads(*CUT, *nci.line(0, (0, 0, 50), -2), *null, *nci.line(0, (9, 9, 50), -2)).operations
    assert (second.name, second.tool) == ("SECOND", first.tool)
    assert not any(isinstance(event, LoadTool) for event in second.events)


def test_arcs_turn_by_their_code_and_a_full_circle_is_marked(reads: Reads) -> None:
    (operation,) = reads(
        *CUT, "3", "0 0 0 20 0 0 -2 -1 0 0", "2", "0 0 20 0 0 0 -2 -1 0 0", "3", "0 0 20 0 0 0 -2 -1 0 1"
    ).operations
    arcs = operation.arcs
    assert arcs.normal[:, 2].tolist() == [1, -1, 1]
    assert arcs.radius.tolist() == [20, 20, 20]
    assert arcs.full_turns.tolist() == [0, 0, 0]


@pytest.mark.parametrize("values", ["41 0", "0 41"])
def test_compensation_word_and_plane_of_an_arc_stand_in_either_order(reads: Reads, values: str) -> None:
    operation = reads(*CUT, "3", f"{values} 0 20 0 0 -2 -1 0 0", cutcom="contour").operations[0]
    assert [event.side for event in operation.events if isinstance(event, CutterComp)] == ["LEFT"]
    assert operation.arcs.normal.tolist() == [[0, 0, 1]]


def test_arcs_in_other_planes_and_helices(reads: Reads) -> None:
    (operation,) = reads(
        *CUT, "3", "1 0 10 -2 5 -2 20 -1 0 0", "2", "0 2 15 3 20 3 10 -1 0 0", "3", "0 0 15 10 15 12 7 -1 0 1"
    ).operations
    assert operation.moves.tip[3:].tolist() == [[20, 10, -2], [15, 10, 3], [15, 10, 7]]
    assert operation.arcs.centre.tolist() == [[20, 5, -2], [20, 10, 3], [15, 12, 3]]
    assert operation.arcs.normal.tolist() == [[1, 0, 0], [0, -1, 0], [0, 0, 1]]
    assert operation.arcs.radius.tolist() == [5, 5, 2]


def test_holes_of_a_cycle_and_what_ends_it(reads: Reads) -> None:
    """The second hole is exchanged top for bottom and as deep; the third is deeper, with a dwell, in a tilted axis."""
    tilted = nci.Hole((30, 0, 0), (0.6, 0, 0.8), 9, 3, 50, 1, 0.5)
    first = "1 10 20 -7 0 120 2 0 0.1 0 51 4 1 0 10 20 51 0 0"
    second, third = "1 30 20 51 51 4 0 120 30 20 -7 0 1", nci.cycle(1, [tilted, tilted], 150)[2:4]
    toolpath = reads(*CUT, "81", first, "100", second, *third, *nci.five_axis((0, 0, 99), (0.6, 0, 0.8), -2, 42))
    (operation,) = toolpath.operations
    moves = operation.moves
    np.testing.assert_allclose(moves.tip[3:], [[10, 20, 1], [30, 20, 1], [30, 0, 0], [0, 0, 99]], atol=1e-8)
    np.testing.assert_allclose(moves.axis[3:], np.array([Z, Z, tilted.axis, tilted.axis]), atol=1e-8)
    on = [event for event in operation.events if isinstance(event, CycleOn)]
    heights = (("STEP", (2,)), ("RAPTO", (3,)), ("FEDTO", (-8,)), ("RTRCTO", (50,)), ("MMPM", (120,)))
    deeper = (("STEP", (2,)), ("RAPTO", (3,)), ("FEDTO", (-9,)), ("RTRCTO", (50,)), ("MMPM", (150,)), ("DWELL", (0.5,)))
    assert [(event.row, event.mode, event.values) for event in on] == [
        (3, ("DRILL", "DEEP"), heights), (5, ("DRILL", "DEEP"), deeper)
    ]  # fmt: skip
    assert [event.row for event in operation.events if isinstance(event, CycleOff)] == [6]
    assert any("not followed, by their places: 9: 0.1" in problem.what for problem in toolpath.remarks)


def test_heights_and_feeds_of_holes_are_in_the_unit_that_is_given(reads: Reads) -> None:
    hole = nci.Hole((0, 0, 0), Z, 1, 0.1, 1)
    (on,) = (
        e for e in reads(*CUT, *nci.cycle(0, [hole], 5), units="inch").operations[0].events if isinstance(e, CycleOn)
    )
    assert dict(on.values)["FEDTO"] == pytest.approx((-25.4,))
    assert dict(on.values)["MMPM"] == (127,)


FRONT = ["1014", "1. 0. 0. 0. 0. 1. 0. -1. 0."]


def test_points_of_a_turned_tool_plane_are_in_its_coordinates(reads: Reads) -> None:
    """The front view: its X is X, its Y is Z, and its Z, along which the tool stands, is -Y."""
    null = ["1000", "0 100 2 3 0 0 0 900 0. 0 0. 0. 0."]
    hole = nci.Hole((1, 2, 3), Z, 5, 2, 9)
    path = [
        *nci.line(0, (1, 2, 30), -2), *nci.cycle(0, [hole], 100), *nci.line(0, (0, 0, 9), -2),
        *nci.line(1, (0, 0, 3), 200), "3", "0 0 20 0 10 0 3 -1 0 0", *nci.five_axis((5, 6, 7), (0, 0.6, 0.8), -1),
    ]  # fmt: skip
    first, second, third = reads(
        *CUT, *nci.line(0, (0, 0, 50), -2), *FRONT, *null, *path, "1014", nci.TOP, *null, *nci.line(0, (9, 8, 7), -2)
    ).operations
    assert first.moves.tip.tolist()[-1] == [0, 0, 50]
    moves = second.moves
    expected = [[1, -30, 2], [1, -3, 2], [0, -9, 0], [0, -3, 0], [20, -3, 0], [5, -7, 6]]
    np.testing.assert_allclose(moves.tip, np.array(expected, float), atol=1e-12)
    np.testing.assert_allclose(moves.axis, np.array([*[[0, -1, 0]] * 5, [0, -0.8, 0.6]], float), atol=1e-12)
    assert second.arcs.centre.tolist() == [[10, -3, 0]]
    assert second.arcs.normal.tolist() == [[0, -1, 0]]
    assert (third.moves.tip.tolist(), third.moves.axis.tolist()) == ([[9, 8, 7]], [[0, 0, 1]])


def test_operations_of_two_planes_that_are_one_cut_keep_their_coordinates(reads: Reads) -> None:
    null = ["1000", "0 100 2 3 0 0 0 900 0. 0 0. 0. 0."]
    (operation,) = reads(*CUT, *FRONT, *null, *nci.line(1, (20, -2, 5), 300), *nci.line(1, (25, -2, 5), -1)).operations
    assert operation.moves.tip.tolist()[-3:] == [[20, 0, -2], [20, -5, -2], [25, -5, -2]]
    assert operation.moves.axis.tolist()[-3:] == [[0, 0, 1], [0, -1, 0], [0, -1, 0]]


def test_lengths_of_the_tool(reads: Reads) -> None:
    tool = reads("20007", "0. 12. 60. 20. 10. 50. 40. 0 0. 0. 0", *CUT).operations[0].tool
    assert (tool.length, tool.flute_length, tool.diameter) == (60, 12, 10)


def test_texts_literals_and_dwells(reads: Reads) -> None:
    texts = ["1005", "A NOTE", "1006", "M101 (X)", "4", "0.5 900"]
    events = reads(*CUT, *texts, *nci.line(1, (30, 0, -2), -1)).operations[0].events
    assert [event.text for event in events if isinstance(event, Message)] == ["A NOTE"]
    assert [event.text for event in events if isinstance(event, Insert)] == ["M101 (X)"]
    assert [event.amount for event in events if isinstance(event, Dwell)] == [0.5]


@pytest.mark.parametrize(("cutcom", "contour"), [("contour", True), ("centreline", False)])
def test_compensation_in_the_control_wants_its_points_stated(
    reads: Reads, fails: Fails, cutcom: str, contour: bool
) -> None:
    on, off = ["1", "41 30. 0. -2. -1. 0"], ["1", "40 40. 0. -2. -1. 0"]
    (problem,) = fails(*CUT, *on, *off)
    assert "cutcom=contour" in problem.cure
    events = reads(*CUT, *on, *off, cutcom=cutcom).operations[0].events
    sides = [(event.side, event.contour) for event in events if isinstance(event, CutterComp)]
    assert sides == [("LEFT", contour), ("OFF", False)]


@pytest.mark.parametrize(
    ("lines", "code", "what"),
    [
        (["81", "1 2 3"], "CL165", "record 81 (line 18) has 3 values, and 19 belong to it"),
        (["100", "0 2 3 -1 9 5 0 100 2 3 9 0 0"], "CL850", "record 100 (line 18) is a hole, and no cycle is on"),
        (["81", "5 0 0 -9 0 100 0 0 0 0 9 2 0 0 0 0 9 0 0"], "CL250", "cycle of type 5"),
        (["81", "4 0 0 -9 1 100 0 0 0 0 9 2 0 0 0 0 9 0 0"], "CL250", "cycle of type 4"),
        (["81", "1 0 0 -9 0 100 0 0 0 0 9 2 0 0 0 0 9 0 0"], "CL830", "has the pecks 0 and 0"),
        (["81", "2 0 0 -9 0 100 3 1 0 0 9 2 0 0 0 0 9 0 0"], "CL830", "has the pecks 3 and 1"),
        (["81", "0 0 0 -9 0 100 0 0 0 0 9 -1 0 0 0 0 9 0 0"], "CL830", "has the heights 9, -1, 0, -9"),
        (["81", "0 0 0 -9 0 100 0 0 0 0 9 10 0 0 0 0 9 0 0"], "CL830", "has the heights 9, 10, 0, -9"),
        (["81", "0 0 0 9 0 100 0 0 0 0 9 2 0 0 0 0 9 0 0"], "CL830", "has the heights 9, 2, 0, 9"),
        (["81", "0 0 0 -9 -1 100 0 0 0 0 9 2 0 0 0 0 9 0 0"], "CL830", "has the dwell -1, below 0"),
        (["81", "0 0 0 -9 0 -2 0 0 0 0 9 2 0 0 0 0 9 0 0"], "CL710", "has the feed -2"),
        (["81", "0 0 0 -9 0 100 0 0 0 0 9 2 0 0 0 0 9 0 2"], "CL165", "has 2, where 0, 1 are known"),
        (["81", "0 0 0 -9 0 100 0 0 0 0 9 2 0 0 0 0 9 3 0"], "CL165", "has 3, where 0, 100, 1000 are known"),
        (["20007", "0 9 8", *nci.tool(4, 8, 0)], "CL770", "has the cutting length 9 and the length 8"),
        (["200", "1 2 3"], "CL260", "record 200 (line 18) belongs to turning"),
        (["1018", "1"], "CL260", "record 1018 (line 18) belongs to a subprogram"),
        (["1014", "1 0 0 0 0 1 0 -1 0.1"], "CL430", "has no three unit vectors"),
        (["1014", "1 0 0 0 1 0 0 0 -1"], "CL430", "has no three unit vectors"),
        (["1014", "1 0 0 0 0 1 0 -1 0", "1000", "0 100 2 3 0 0 0 900 0. 0 0. 0. 0.", "2", "0 0 0 20 0 0 -2 100 0 0"],
         "CL250", "without a point to begin in"),
        (["1027", f"{nci.TOP} 5 0 0"], "CL430", "work coordinate system"),
        (["2", "0 3 0 20 0 0 -2 -1 0 0"], "CL250", "has 0 and 3, where a compensation word"),
        (["2", "1 2 0 20 0 0 -2 -1 0 0"], "CL250", "has 1 and 2, where a compensation word"),
        (["2", "0 0 20 0 0 0 -2 -1 0 0"], "CL250", "full circle"),
        (["11", "0 0 0 0 0 1 -1 22 0 0 0.6 0.8"], "CL540", "the second point is 0.600000 off"),
        (["11", "0 0 0 0 0 1.1 -1 22 0 0 0 1"], "CL540", "the second point"),
        (["11", "0 0 0 0 0 1 -1 23 0 0 0 1"], "CL165", "has 23, where 42, 12, 22, 32, 52 are known"),
        (["11", "0 0 0 0 0 1 -1 22 7 0 0 1"], "CL165", "has 7, where 0, 100, 1000 are known"),
        (["1", "0 0 0 0 0 0"], "CL710", "has the feed 0"),
        (["1", "0 0 0 0 -2 0"], "CL710", "stands for a rapid"),
        (["0", "0 0 0 0 100 0"], "CL710", "is a rapid with the feed 100"),
        (["0", "0 0 0 9 -2 0", "1", "0 0 0 0 -1 0"], "CL710", "keeps the feed of the motion before it"),
        (["1", "0 0 0 x -1 0"], "CL165", "has 'x' as value 4"),
        (["1", "0 0 0 0 -1"], "CL165", "has 5 values, and 6 belong to it"),
        (["1", "43 0 0 0 -1 0"], "CL165", "has 43, where 0, 40, 41, 42, 140 are known"),
        (["4", "0.5 700"], "CL320", "waits with the spindle at 700, and it turns at 900"),
        (["1002", "0 100 2 5.5 0 0 0 900 0. 0 0. 0. 0."], "CL165", "5.5 as value 4, where a whole number"),
        (["1002", "0 100 2 5 0 0 3 900 0. 0 0. 0. 0."], "CL430", "has the plane 3"),
        (["1002", "0 100 2 5 0 0 0 900 0. 9 0. 0. 0."], "CL330", "has the coolant 9"),
        (["1000", "0 100 2 5 0 0 0 900 0. 0 0. 0. 0."], "CL780", "names tool 5, which is not in the spindle"),
        (["1013", "0 8 0", *nci.line(1, (0, 0, 0), -1)], "CL430", "no tool change"),
        (["1 2 3", "4 5 6"], "CL165", "'1 2 3' stands where the code of a record belongs"),
        (nci.five_axis((0, 0, 0), (0.6, 0, 0.8), -1), "CL530", "record 0 or 1 has no tool axis"),
        (["011", "0"], "CL165", "'011' stands where"),
        (["", ""], "CL165", "'' stands where"),
    ],
)  # fmt: skip
def test_what_is_not_known_is_refused_by_name(fails: Fails, lines: list[str], code: str, what: str) -> None:
    problems = fails(*CUT, *lines, *nci.line(1, (20, 1, -2), -1))
    assert any(problem.code == code and what in problem.what and problem.cure for problem in problems), problems


def test_an_arc_needs_a_start(fails: Fails) -> None:
    problems = fails(*nci.tool(3, 10, 1, 900), "2", "0 0 0 20 0 0 -2 100 0 0", *nci.line(1, (0, 0, 0), 100))
    assert "without a point to begin in" in problems[0].what


def test_an_unknown_record_is_kept_and_may_be_said_what_becomes_of_it(reads: Reads) -> None:
    toolpath = reads(*CUT, "1031", "7 2.5", "1025", "0 3 0 0 0 0 0 0 0 0")
    said = [(event.line, str(event.what)) for alike in unknown_statements(toolpath) for event in alike]
    assert said == [(17, "1031 is not known"), (19, "1025 calls a text of Mastercam's post")]
    assert can_be_unknown("1031")
    assert not can_be_unknown("GOTO")


def test_pairs_that_are_not_followed_are_named_with_their_count(reads: Reads) -> None:
    remarks = reads("10010", "0.", "10011", "1", "20004", "", *CUT, "1011", " ".join(["0."] * 9 + ["2.5"])).remarks
    texts = [problem.what for problem in remarks]
    assert any("5 pairs of lines" in text and "10010–10011, 20004" in text for text in texts), texts
    assert any("not followed, by their places: 10: 2.5" in text for text in texts), texts


def test_an_odd_place_in_the_contour_is_said(reads: Reads) -> None:
    lines = [row for place in (42, 12, 22, 52) for row in nci.five_axis((place, 0, 0), Z, 100, place)]
    codes = [problem.what for problem in reads(*CUT[:10], *lines).remarks if problem.code == "CL225"]
    assert len(codes) == 1
    assert "52 behind 22" in codes[0]


@pytest.mark.parametrize("chunk", [1, 7, 64, 300])
def test_the_pieces_in_which_a_file_is_read_change_nothing(tmp_path: Path, chunk: int) -> None:
    lines = list(CUT)
    for k, place in enumerate([42, 42, 12, 22, 22, 22, 32, 52]):
        lines += nci.five_axis((k, 1, 2), (0, 0.6, 0.8), -2 if k == 7 else 300 if k % 3 else -1, place)
    file = tmp_path / "part.nci"
    file.write_bytes(nci.file_of(*lines).replace("\n", "\r\n").removesuffix("\r\n").encode() + b"\r\n\r\n \x1a")
    (source,) = cl_sources(file)
    found, whole = read_source(source, chunk=chunk), read_source(source)
    assert whole.operations[0].moves.line.tolist() == [11, 13, 15, *range(17, 33, 2)]
    for one, other in zip(found.operations, whole.operations, strict=True):
        for name in ("tip", "axis", "kind", "feed", "line"):
            np.testing.assert_array_equal(getattr(one.moves, name), getattr(other.moves, name))
    assert found.remarks == whole.remarks


@pytest.mark.parametrize(
    ("cut", "what"), [("0. 0. 0.\n", "ends after the code"), ("1003\n0. 0. 0.\n", "has no record 1003 behind")]
)
def test_a_file_that_is_cut_off_is_refused(tmp_path: Path, cut: str, what: str) -> None:
    file = tmp_path / "part.nci"
    file.write_text(nci.file_of(*CUT).removesuffix(cut), encoding="utf-8")
    with pytest.raises(InputError, match=what):
        read_cl(file)


#: Tool planes: the top view, the front view, and one that is turned about two axes.
PLANES = [
    np.eye(3), np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0.0]]),
    np.array([[0.6, 0, -0.8], [0, 1, 0], [0.8, 0, 0.6]]) @ np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1.0]]),
]  # fmt: skip


@st.composite
def said_paths(draw: st.DrawFn) -> tuple[list[Step], Floats]:
    """Paths of which records can say each step, in a tool plane; in half of them the tool stands along it."""
    plane = draw(st.sampled_from(PLANES))
    steps = draw(paths())
    if draw(st.booleans()):  # the path itself is turned, so that its upright tool axes are those of the plane
        steps = [nci.in_plane(step, plane.T) for step in steps]
    kept: list[Step] = []
    for step in steps:
        inside = nci.in_plane(step, plane)
        if not nci.can_say([inside]):
            continue
        before = nci.in_plane(kept[-1], plane) if kept else inside
        if step.word == "ARC" and (before.word != "GOTO" or before.point != inside.start or before.axis != Z):
            continue  # its line has been left out
        kept.append(step)
    return kept, plane


def outside_of_holes(found: dict[str, Any]) -> Floats:
    """Feeds of the rows that are no holes: a cycle has a feed of its own, and that before it counts for nothing."""
    feed = np.asarray(found["feed"], np.float64).copy()
    begin = len(feed)
    for row, what, *_ in found["events"]:
        if isinstance(what, Cycle):
            begin = min(begin, row)
        elif what == "CycleOff":
            feed[begin:row] = 0.0
            begin = len(feed)
    return feed


@settings(max_examples=examples(25), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(path=said_paths(), inch=st.booleans())
def test_a_path_is_the_same_as_apt(tmp_path: Path, path: tuple[list[Step], Floats], inch: bool) -> None:
    (steps, plane), found = path, []
    for name, text in (("apt", write_in("apt", steps, inch)), ("nci", nci.write(steps, plane))):
        file = tmp_path / name
        file.write_text(text or "", encoding="utf-8")
        toolpath = read_cl(file, ClReading(units="inch" if inch else "mm"))
        assert toolpath.dialect == name
        found.append(content(toolpath))
    expected, other = found
    np.testing.assert_allclose(outside_of_holes(other), outside_of_holes(expected), atol=3e-5, rtol=0)
    for name in ("tip", "axis", "arcs"):
        np.testing.assert_allclose(other[name], expected[name], atol=3e-5, rtol=0, err_msg=name)
    for name in ("kind", "arc rows", "turns"):
        np.testing.assert_array_equal(other[name], expected[name], err_msg=name)
    assert other["events"] == expected["events"]
    assert changes(other["tools"]) == changes(expected["tools"])


pairs = st.lists(
    st.tuples(
        st.sampled_from(["0", "1", "2", "3", "4", "11", "80", "81", "100", "20007", "1000", "1002", "1003", "1005",
                         "1013", "1014", "1027", "1050", "10010", "20001", "x", ""]),
        st.lists(st.sampled_from(["0", "1", "-1", "-2", "40", "41", "22", "0.5", "1e3", "1e400", "nan", "-", "A", "é"]),
                 max_size=14).map(" ".join),
    ),
    max_size=12,
)  # fmt: skip


@settings(max_examples=examples(200), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(rows=pairs, tail=st.binary(max_size=40))
def test_no_pairs_and_no_bytes_end_in_anything_but_a_problem(
    tmp_path: Path, rows: list[tuple[str, str]], tail: bytes
) -> None:
    file = tmp_path / "part.nci"
    text = nci.file_of(*CUT, *(line for row in rows for line in row))
    for data in (text.encode(), text.encode() + tail, text.encode()[: len(tail) * 7] + tail + text.encode()):
        file.write_bytes(data)
        with suppress(InputError):
            read_cl(file)
