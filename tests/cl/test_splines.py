"""Splines of NX: cubic B-splines from the point before, made points within a tolerance."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.cl_reading import Body, Fail, Read
from tests.support.examples import examples
from tests.support.naive.splines import points_of
from trunnion.arrays import Floats
from trunnion.cl.splines import evaluate
from trunnion.cli import main
from trunnion.model.splines import Spline
from trunnion.model.toolpath import Coolant, Kind, Operation, Phase

START = ("FEDRAT/MMPM,100", "GOTO/0,0,5,0,0.6,0.8")
ARCH = ("NURBS/", "KNOT/0.25,0.5", "KNOT/1.0000000", "CNTRL/0,10,5", "CNTRL/10,20,5", "CNTRL/20,20,5", "CNTRL/30,10,6",
        "CNTRL/30,0,5")  # fmt: skip
POLES = np.array([[0, 0, 5], [0, 10, 5], [10, 20, 5], [20, 20, 5], [30, 10, 6], [30, 0, 5]], float)


def curve(knots: Iterable[float], poles: Floats, places: Iterable[float]) -> Floats:
    """Points of a cubic spline; ``knots`` without 0."""
    full = np.array([0.0] * 4 + list(knots) + [1.0] * 3)
    return points_of(Spline(3, full, poles, np.ones(len(poles))), places)


CURVE = curve((0.25, 0.5, 1.0), POLES, np.linspace(0.0, 1.0, 400).tolist())


def distance_from_chords(operation: Operation) -> float:
    """How far the arch is from the lines between the points, mm."""
    tip = operation.moves.tip
    first, step = tip[:-1], np.diff(tip, axis=0)
    share = np.einsum("cki,ki->ck", CURVE[:, None] - first[None], step) / np.einsum("ki,ki->k", step, step)
    nearest = first + np.clip(share, 0.0, 1.0)[..., None] * step
    return float(np.linalg.norm(CURVE[:, None] - nearest, axis=2).min(axis=1).max())


@pytest.mark.parametrize(
    ("tolerances", "given", "within"),
    [
        ((), None, 0.001),
        (("INTOL/0.03", "OUTTOL/0.004"), None, 0.004),
        (("INTOL/0.5",), None, 0.01),
        (("INTOL/0", "OUTTOL/0.00001"), None, 0.0001),
        (("INTOL/0.03",), 0.1, 0.1),
    ],
)
def test_the_chords_stay_within_the_tolerance(
    tolerances: tuple[str, ...], given: float | None, within: float, body: Body
) -> None:
    operation = body(*tolerances, *START, *ARCH, spline_tolerance=given)
    off = distance_from_chords(operation)
    assert 0.2 * within < off <= within
    moves = operation.moves
    assert moves.tip[-1].tolist() == [30, 0, 5]
    assert (moves.axis == [0.0, 0.6, 0.8]).all()
    assert set(moves.kind.tolist()) == {Kind.LINEAR}
    assert set(moves.feed.tolist()) == {100.0}


def test_what_stands_around_a_spline_keeps_its_place(body: Body) -> None:
    operation = body(
        "PAINT/COLOR,42", *START, "COOLNT/ON", *ARCH, "PAINT/COLOR,31", "FEDRAT/MMPM,200", "GODLTA/0,-1,0", *ARCH,
        "CIRCLE/35,0,5,0,0,1,5", "GOTO/40,0,5", "RAPID", "GOTO/0,0,50", "COOLNT/OFF",
    )  # fmt: skip
    moves, ends = operation.moves, [30, 0, 5]
    first = moves.tip.tolist().index(ends)
    assert moves.tip[first + 1].tolist() == [30, -1, 5]
    assert moves.feed[first : first + 2].tolist() == [100, 200]
    assert set(moves.phase[: first + 1].tolist()) == {Phase.ENGAGE}
    assert operation.arcs.row.tolist() == [len(moves) - 2]
    assert moves.tip[-3].tolist() == ends
    assert [(event.row, event.kind) for event in operation.events if isinstance(event, Coolant)] == [
        (1, "ON"),
        (len(moves), "OFF"),
    ]
    assert moves.kind[-1] == Kind.RAPID
    splines = operation.splines
    assert [rows.last for rows in (splines[0], splines[1])] == [first, len(moves) - 3]
    assert [rows.first for rows in (splines[0], splines[1])] == [1, first + 2]
    assert splines[0].spline.poles.tolist() == POLES.tolist()
    assert splines[0].spline.knots.tolist() == [0, 0, 0, 0, 0.25, 0.5, 1, 1, 1, 1]
    assert splines[1].spline.poles[0].tolist() == [30, -1, 5]


def test_inches_from_and_the_number_of_points(read: Read) -> None:
    inches = [line for line in ARCH if not line.startswith("CNTRL")]
    inches += [f"CNTRL/{','.join(repr(float(v)) for v in pole / 25.4)}" for pole in POLES[1:]]
    head = "UNITS/INCHES\nTOOL PATH/A,TOOL,T\nFEDRAT/IPM,10\n"
    start = ",".join(repr(float(v)) for v in POLES[0] / 25.4)
    toolpath = read(head + f"FROM/{start}\n" + "\n".join(inches) + "\nEND-OF-PATH\n")
    moves = toolpath.operations[0].moves
    assert moves.tip[-1] == pytest.approx([30, 0, 5])
    (remark,) = (each for each in toolpath.remarks if "NURBS" in each.what)
    assert remark.line == 5
    assert f"1 spline (NURBS) with 5 control points: {len(moves)} points within 0.001 mm stand for them" in remark.what


@settings(max_examples=examples(25), deadline=None)
@given(
    st.lists(st.integers(1, 999), max_size=6, unique=True),
    st.randoms(use_true_random=False),
    st.lists(st.integers(1, 4), min_size=7, max_size=7),
)
def test_points_are_those_of_another_evaluation(inner: list[int], random: object, counts: list[int]) -> None:
    knots = np.array([*(knot / 1000 for knot in sorted(inner)), 1.0])
    poles = np.array([[random.uniform(-50, 50) for _ in range(3)] for _ in range(len(knots) + 3)])  # type: ignore[attr-defined]
    each = np.array(counts[: len(knots)])
    ends = np.concatenate(([0.0], knots))
    at = np.concatenate([np.linspace(a, b, n + 1)[1:] for a, b, n in zip(ends, knots, each, strict=False)])
    expected = curve(knots.tolist(), poles, at.tolist())
    np.testing.assert_allclose(evaluate(poles, knots, each), expected, atol=1e-9)


#: Lines inside an operation, the line of the error, and why.
REFUSED = {
    "values": ((*START, "NURBS/3", *ARCH[1:]), 5, "a degree, weights or a form"),
    "no start": (ARCH, 3, "without a point to begin in"),
    "rapid": ((*START, "RAPID", *ARCH), 6, "RAPID before a NURBS"),
    "circle": ((*START, "CIRCLE/0,0,5,0,0,1,5", *ARCH), 6, "NURBS where the GOTO of the CIRCLE"),
    "cycle": ((*START, "CYCLE/DRILL,RAPTO,3,FEDTO,-1,MMPM,9", *ARCH), 6, "within the cycle of line 5"),
    "no knots": ((*START, "NURBS/", "CNTRL/0,0,0"), 5, "without knots"),
    "no control points": ((*START, "NURBS/", "KNOT/1", "GOTO/0,0,0"), 5, "without control points"),
    "backwards": ((*START, "NURBS/", "KNOT/0.5,0.4,1", *ARCH[3:]), 5, "do not increase from 0"),
    "from zero": ((*START, "NURBS/", "KNOT/0,0.5,1", *ARCH[3:]), 5, "do not increase from 0"),
    "short": ((*START, "NURBS/", "KNOT/0.2,0.5,0.9", *ARCH[3:]), 5, "the last knot of a NURBS is 0.9, not 1"),
    "degree": ((*START, "NURBS/", "KNOT/0.5,1", *ARCH[3:]), 5, "its degree would be 4"),
    "huge degree": ((*START, "NURBS/", "KNOT/1", *["CNTRL/0,0,0"] * 500), 5, "its degree would be 500"),
    "not a number": ((*START, "NURBS/", "KNOT/NAN,1", *ARCH[3:]), 6, "'NAN' where a number belongs"),
    "infinite": ((*START, *ARCH[:3], "CNTRL/1e400,0,0", *ARCH[4:]), 8, "CNTRL has the number inf"),
    "five axes": ((*START, *ARCH[:3], "CNTRL/0,10,5,0,0,1", *ARCH[4:]), 8, "CNTRL with a tool axis"),
    "a point between": ((*START, *ARCH[:4], "GOTO/1,1,1", *ARCH[4:]), 10, "follows neither KNOT nor another CNTRL"),
    "a switch between": ((*START, *ARCH[:4], "COOLNT/ON", *ARCH[4:]), 5, "another statement stands between"),
    "knots behind": ((*START, *ARCH, "KNOT/1"), 13, "KNOT without a NURBS"),
    "alone": ((*START, "CNTRL/0,0,0"), 5, "CNTRL that follows neither"),
    "far": ((*START, *ARCH[:3], "CNTRL/9e8,0,0", *ARCH[4:]), 5, "more than 1000000 points"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_other_splines_are_refused_once(name: str, body_fails: Fail) -> None:
    lines, line, why = REFUSED[name]
    problems = body_fails(*lines)
    assert problems[0].line == line
    assert why in problems[0].what
    assert len(problems) <= 2


def test_dialects_without_such_splines_refuse_them(fails: Fail) -> None:
    text = "\n".join(("PARTNO A", "UNITS/MM", *START, *ARCH))
    assert any("NURBS is motion that cannot be read" in problem.what for problem in fails(text, dialect="apt"))
    creo = ("MOVNRB/ON,4,8,0,4,30", "MOVNRB/1,0,0,0,0,1,1,1,1", "MOVNRB/NEXT", START[1], "MOVNRB/OFF", "FINI")
    (problem,) = fails("\n".join(("PARTNO / A", "UNITS / MM", *START, *creo)), dialect="ncl")
    assert (problem.line, problem.what) == (5, "MOVNRB is motion that cannot be read")


def test_the_tolerance_is_a_setting_of_the_post_too(tmp_path: Path) -> None:
    path = tmp_path / "a.cls"
    lines = ["TOOL PATH/A,TOOL,T", "TLDATA/MILL,10,5,50,0,0", "LOAD/TOOL,1", "SPINDL/RPM,900,CLW", "RAPID", START[1]]
    path.write_text("\n".join([*lines, START[0], *ARCH, "RAPID", "GOTO/0,0,90", "END-OF-PATH\n"]))
    rows = [
        len(trunnion.plan(path, machine="yl569", settings=settings).motions[0].operation.moves)
        for settings in ({}, {"spline_tolerance": 0.05}, {"spline_tolerance": "0.0002"})
    ]
    assert rows[1] < rows[0] < rows[2]
    assert rows[1] == len(trunnion.read_cl(path, spline_tolerance=0.05).operations[0].moves)
    for wrong in (0, 5.0, "0.1", True, float("nan")):
        with pytest.raises(trunnion.InputError, match="spline_tolerance: error: is"):
            trunnion.read_cl(path, spline_tolerance=wrong)  # type: ignore[arg-type]
    assert main(["post", str(path), "--machine", "yl569", "--set", "spline_tolerance=9", "--output", "-"]) == 2
