"""Circles, helices and what may be wrong with them."""

import math

import numpy as np
import pytest

from tests.support.cl_reading import Body, Fail, Read
from trunnion.model.toolpath import Kind


def test_an_arc_is_a_row_with_its_circle(body: Body) -> None:
    operation = body("GOTO/15,0,1", "CIRCLE/0,0,1,0,0,-1,15,0.06,0.5,16,0", "GOTO/0,-15,1", "GOTO/0,0,0")
    assert operation.moves.kind.tolist() == [Kind.LINEAR, Kind.ARC, Kind.LINEAR]
    arcs = operation.arcs
    assert arcs.row.tolist() == [1]
    assert arcs.centre.tolist() == [[0, 0, 1]]
    assert arcs.normal.tolist() == [[0, 0, -1]]
    assert (arcs.radius.tolist(), arcs.full_turns.tolist()) == ([15], [0])


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 1, 0), (1, 0, 0), (0.6, 0, 0.8), (-0.48, 0.6, 0.64)])
def test_arcs_lie_in_any_plane(body: Body, normal: tuple[float, float, float]) -> None:
    axis = np.array(normal)
    u = np.cross(axis, (0.3, 0.5, 0.9))
    u /= np.linalg.norm(u)
    v = np.cross(axis, u)
    centre = np.array((10, 20, 30))
    text = ["{:.7f},{:.7f},{:.7f}".format(*point) for point in (centre + 5 * u, centre, axis, centre + 5 * v)]
    arcs = body(f"GOTO/{text[0]}", f"CIRCLE/{text[1]},{text[2]},5.0", f"GOTO/{text[3]}").arcs
    assert np.allclose(arcs.normal, normal, atol=1e-7)
    assert np.linalg.norm(arcs.normal) == pytest.approx(1, abs=1e-15)


def test_a_full_circle_ends_where_it_starts_and_has_no_extra_turn(body: Body) -> None:
    operation = body("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5", "GOTO/5,0,0")
    assert operation.arcs.full_turns.tolist() == [0]


@pytest.mark.parametrize(
    ("tail", "turns"),
    [("", 0), (",TIMES,1", 0), (",TIMES,3", 2), (",0.06,0.5,16,0,TIMES,2", 1), (",0.06,0.5,16,0,4", 3), (",2", 1)],
)
def test_times_counts_the_turns_that_a_helix_begins(body: Body, tail: str, turns: int) -> None:
    operation = body("GOTO/5,0,9", f"CIRCLE/0,0,0,0,0,1,5{tail}", "GOTO/0,5,0")
    assert operation.arcs.full_turns.tolist() == [turns]


def test_an_arc_may_start_at_from(body: Body) -> None:
    assert body("FROM/5,0,0", "CIRCLE/0,0,0,0,0,1,5", "GOTO/0,5,0").arcs.row.tolist() == [0]


def test_statements_may_stand_between_circle_and_goto(body: Body) -> None:
    operation = body("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5", "PAINT/COLOR,31", "FEDRAT/MMPM,3", "GOTO/0,5,0")
    assert operation.moves.kind.tolist() == [Kind.LINEAR, Kind.ARC]


def test_rapid_before_an_arc_is_remarked_and_the_arc_is_fed(read: Read) -> None:
    text = "TOOL PATH/A,TOOL,T\nGOTO/5,0,0\nRAPID\nCIRCLE/0,0,0,0,0,1,5\nGOTO/0,5,0\nEND-OF-PATH\n"
    toolpath = read(text)
    assert toolpath.operations[0].moves.kind.tolist() == [Kind.LINEAR, Kind.ARC]
    assert [remark.line for remark in toolpath.remarks] == [4]


@pytest.mark.parametrize("off", [0.019, -0.019])
def test_a_little_off_the_radius_is_the_rounding_of_the_file(body: Body, off: float) -> None:
    assert len(body(f"GOTO/{5 + off},0,0", "CIRCLE/0,0,0,0,0,1,5", "GOTO/0,5,0").arcs.row) == 1


@pytest.mark.parametrize(
    ("lines", "line", "what"),
    [
        (("GOTO/5.03,0,0", "CIRCLE/0,0,0,0,0,1,5", "GOTO/0,5,0"), 4, "start point of the arc lies 0.030 mm off"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5", "GOTO/0,5.1,0"), 4, "end point of the arc lies 0.100 mm off"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5", "CIRCLE/0,0,0,0,0,1,5", "GOTO/0,5,0"), 5, "another CIRCLE"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5"), 4, "CIRCLE without a GOTO"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5", "GOHOME/5,0,0"), 5, "GOHOME where the GOTO of the CIRCLE in line 4"),
        (("CIRCLE/0,0,0,0,0,1,5", "GOTO/0,5,0"), 3, "no start point"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,0,5", "GOTO/0,5,0"), 4, "normal"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,-5", "GOTO/0,5,0"), 4, "radius"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1", "GOTO/0,5,0"), 4, "6 numbers"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5,TIMES,0", "GOTO/0,5,0"), 4, "0 turns"),
        (("GOTO/5,0,0", "CIRCLE/0,0,0,0,0,1,5,TIMES,1.5", "GOTO/0,5,0"), 4, "1.5 turns"),
    ],
)
def test_an_arc_that_does_not_fit_is_refused_with_its_line(
    body_fails: Fail, lines: tuple[str, ...], line: int, what: str
) -> None:
    problem = body_fails(*lines)[0]
    assert problem.line == line
    assert what in problem.what
    assert problem.cure


def test_the_helix_of_a_ramp_may_leave_its_plane(body: Body) -> None:
    end = f"GOTO/{5 * math.cos(1):.5f},{5 * math.sin(1):.5f},-7"
    assert body("GOTO/5,0,9", "CIRCLE/0,0,-7,0,0,1,5,TIMES,2", end).arcs.full_turns.tolist() == [1]


def test_a_file_has_no_more_turns_than_anybody_cuts(body: Body, body_fails: Fail) -> None:
    helix = "CIRCLE/0,0,{0},0,0,1,10,0.01,0.5,6,0,TIMES,{1}\nGOTO/10,0,{0}"
    sound = ["GOTO/10,0,0", *(helix.format(-k - 1, 50) for k in range(1000))]
    assert len(body(*sound).arcs.row) == 1000
    (problem,) = body_fails("GOTO/10,0,0", *(helix.format(-k - 1, 9_000) for k in range(9)))
    # TOOL PATH, TLDATA and the first GOTO stand before: the sixth CIRCLE is in line 14.
    assert (problem.code, problem.line) == ("CL575", 14)
