"""G5, G5.1 and G5.2 with G5.3: the curves of LinuxCNC's documentation, and what its own interpreter refuses."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.linuxcnc.interpreter import RefusedByLinuxcncError, interpret, needs_linuxcnc
from tests.support.naive.splines import points_of
from tests.support.reading import Runner, close
from trunnion.arrays import Floats
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.splines import Spline, SplineRows
from trunnion.readers import run_program
from trunnion.readers.control.splines import CHORD
from trunnion.readers.families.linuxcnc.arcs_of_splines import arcs_beside

HEAD = "G21 G17 G90 G94\nG54\nG0 X0 Y0 Z1\nF100\n"


def bezier(poles: Floats, at: Floats) -> Floats:
    """Points of a curve by the sums of de Casteljau."""
    points = np.repeat(poles[None, :, :], len(at), axis=0)
    while points.shape[1] > 1:
        points = points[:, :-1] * (1.0 - at[:, None, None]) + points[:, 1:] * at[:, None, None]
    return points[:, 0]


def beside(points: Floats, curve: Floats) -> float:
    """How far the farthest of the curve's points is from the lines between points."""
    begin, step = points[:-1], np.diff(points, axis=0)
    share = ((curve[:, None] - begin) * step).sum(axis=2) / np.maximum((step * step).sum(axis=1), 1e-30)
    near = begin + np.clip(share, 0.0, 1.0)[..., None] * step
    return float(np.linalg.norm(curve[:, None] - near, axis=2).min(axis=1).max())


def all_of(run: Run) -> list[SplineRows]:
    return [run.splines[k] for k in range(len(run.splines))]


def path(run: Run, first: int, last: int) -> Floats:
    return run.tip[first - 1 : last + 1]


def test_the_curves_of_the_documentation(run: Runner) -> None:
    found = run(f"{HEAD}G5 I0 J3 P0 Q-3 X1 Y1\nG5 P1 Q-3 X2 Y2\nG0 X-2 Y4\nG5.1 X2 Y4 I2 J-8\nM2\n")
    assert not found.errors
    at = np.linspace(0.0, 1.0, 200)
    curves = ([[0, 0], [0, 3], [1, -2], [1, 1]], [[1, 1], [1, 4], [3, -1], [2, 2]], [[-2, 4], [0, -4], [2, 4]])
    for (first, last, _), poles in zip(all_of(found), curves, strict=True):
        wanted = bezier(np.array([[*pole, 1.0] for pole in poles]), at)
        assert beside(path(found, first, last), wanted) <= CHORD
    parabola = path(found, found.splines[2].first, found.splines[2].last)
    close(parabola[:, 1], parabola[:, 0] ** 2, atol=1e-9)


def test_a_nurbs_has_the_knots_of_linuxcnc(run: Runner) -> None:
    found = run(f"{HEAD}G5.2 P1 L3\nX0 Y1 P1\nM8\nX2 Y2 P1\nF200 X2 Y0 P1\nX0 Y0 P2\nG5.3\nG1 X5\nM2\n")
    assert not found.errors
    (first, last, _), *none = all_of(found)
    poles = np.array([[0, 0, 1], [0, 1, 1], [2, 2, 1], [2, 0, 1], [0, 0, 1]], dtype=float)
    wanted = Spline(2, np.array([0.0, 0, 0, 1, 2, 3, 3, 3]), poles, np.array([1.0, 1, 1, 1, 2]))
    assert not none
    assert beside(path(found, first, last), points_of(wanted, np.linspace(0.0, 3.0, 300))) <= CHORD
    close(found.tip[last], [0, 0, 1], atol=1e-9)
    assert found.feed[last] == 200.0


NUMBERS = st.integers(-300, 300).map(lambda number: number / 8.0)
POINTS = st.tuples(NUMBERS, NUMBERS)


@needs_linuxcnc
@settings(max_examples=examples(25))
@given(st.lists(POINTS, min_size=3, max_size=6), st.integers(3, 5), st.booleans(), st.booleans())
def test_linuxcnc_ends_where_the_reader_does(
    tmp_path_factory: pytest.TempPathFactory, points: list[tuple[float, float]], order: int, inches: bool, turned: bool
) -> None:
    """Its interpreter prints no control points; what it does behind the curve, from where that ends, is compared."""
    (a, b), (c, d), *rest = points
    lines = [f"G5 X{a} Y{b} I3 J4 P{c} Q{d}", f"G5 X{c} P1 Q2", "G91", f"G5.1 X{d} Y{a} I{b} J1", "G90"]
    nurbs = [f"X{x} Y{y} P{1 + k}" for k, (x, y) in enumerate([*rest, *points])]
    back = ["G91", "G1 X1 Y1 Z1 F50", "G90"]
    turn = ["G10 L2 P1 X3 Y-2 Z0 R30", "G92 Y5"] if turned else []
    text = "\n".join([HEAD, "G20 F9" if inches else "", *turn, *lines, *back, f"G5.2 L{order} P2", *nurbs, "G5.3"])
    text += "\n" + "\n".join([*back, "M2\n"])
    folder = tmp_path_factory.mktemp("judge")
    lines_of = [move for move in interpret(text, folder).moves if move.kind == "line"]
    found = run_program(folder / "part.ngc", load_machine("xyzac_trt"))
    assert [str(fault) for fault in found.errors if fault.code != "NC352"] == []
    behind = [spline.last + 1 for spline in all_of(found)][2:]
    got = found.joints[behind][:, [found.machine.column(name) for name in "XYZ"]]
    close(got, [move.machine[:3] for move in lines_of], atol=0.02)


REFUSED = [
    "G5 P0 Q-3 X1", "G5 I0 P0 Q-3 X1 Y1", "G5 I0 J3 P0 X1 Y1", "G5 I0 J3 P0 Q-3", "G5 I0 J3 P0 Q-3 X1 Z1",
    "G18\nG5 I0 J3 P0 Q-3 X1", "G5.1 X2 I1", "G5.1 X2 I1 J2 C5", "G18\nG5.2 X1 Z1 P1", "G5.3",
    "G5.2 X0 Y1 P1\nX2 Y2\nX3 Y2 P1\nG5.3", "G5.2 X0 Y1 P1\nX2 P1\nG5.3", "G5.2 X0 Y1 P1 L4\nX3 Y2 P1\nG5.3",
    "G5.2 X0 Y1 P1 L3.5\nX3 Y2 P1\nG5.3", "G5.2 X0 Y1 P0\nX3 Y2 P0\nG5.3", "G5.2 X0 Y1 P1\nX3 Y2 P1\nG5.3\nX9",
    "F0\nG5 I0 J3 P0 Q-3 X1 Y1", "G41 D1\nG5 I0 J3 P0 Q-3 X1 Y1",
]  # fmt: skip

#: What the documentation excludes and the interpreter 2.9 takes, or drops in silence.
NOT_FOLLOWED = [
    "G5.2 X0 Y1 P1\nX3 Y2 P1\nG0 X9", "G5.2 X0 Y1 P1\nX3 Y2 P1", "G5.2 X0 Y1 P1 Z5\nX3 Y2 P1\nG5.3",
    "G91\nG5.2 X0 Y1 P1\nX3 Y2 P1\nG5.3", "G41 D1\nG5.2 X0 Y1 P1\nX3 Y2 P1\nG5.3", "G5.2 X0 Y1\nX3 Y2 P1\nG5.3",
    "G5.2 X0 Y1 P1\nX3 Y2 P1\nG5.3 X4", "G5 I0 J3 P0 Q-3 X1 Y1\nG0 X5\nG5 P0 Q-3 X7", "G93\nG5 I0 J3 P0 Q-3 X1 F3",
    "G5.2 X0 Y1 P1\nX3 Y2 P1\nG80\nG5.3", "G5.2 X1 Y1 P1\nP2\nX2 Y1 P1\nG5.3", "G5.1 X2000000000 I1 J1",
    "G5.2 X0 Y1 P1\nG20\nX.3 Y.2 P1\nG5.3", "G5.2 X0 Y1 P1\nX3 Y2 P1\nG20\nG5.3",
]  # fmt: skip


def test_what_is_not_followed_is_an_error_and_does_not_move(run: Runner) -> None:
    wrong = [text for text in (*REFUSED, *NOT_FOLLOWED) if not run(f"{HEAD}{text}\nM2\n").errors]
    assert wrong == []
    curves = [text for text in (*REFUSED[:-3], *NOT_FOLLOWED[:6]) if run(f"{HEAD}{text}\nM2\n").splines]
    assert curves == []


@needs_linuxcnc
def test_linuxcnc_refuses_the_same(tmp_path: Path) -> None:
    taken = []
    for text in REFUSED:
        if re.match("G5 P0", text):
            continue  # it takes what is left in its memory
        try:
            interpret(f"{HEAD}{text}\nM2\n", tmp_path)
        except RefusedByLinuxcncError:
            continue
        taken.append(text)
    assert taken == ["G5.2 X0 Y1 P0\nX3 Y2 P0\nG5.3"] or taken == []


def test_m52_is_a_warning(run: Runner) -> None:
    found = run(f"{HEAD}M52 P1\nG1 X1\nM52 P0\nM2\n")
    assert not found.errors
    assert [fault.code for fault in found.diagnostics] == ["NC221"]


def arcs_of(poles: Floats) -> list[tuple[Floats, ...]]:
    """Begin, joint, end and both directions of the pairs of arcs in place of a quadratic curve."""
    found = list[tuple[Floats, ...]]()
    at = np.linspace(0.0, 1.0, 13)
    points = bezier(poles, at)[:, :2]
    ways = np.array([(1 - t) * (poles[1] - poles[0]) + t * (poles[2] - poles[1]) for t in at])[:, :2]
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    for begin, end, leaves, arrives in zip(points, points[1:], ways, ways[1:], strict=False):
        low, high = 0.0, float(np.linalg.norm(end - begin))
        for _ in range(60):
            length = 0.5 * (low + high)
            apart = np.linalg.norm((end - length * arrives) - (begin + length * leaves))
            low, high = (length, high) if apart > 2.0 * length else (low, length)
        found.append((begin, 0.5 * (begin + low * leaves + end - low * arrives), end, leaves, arrives))
    return found


@pytest.mark.parametrize("size", [1.0, 10.0])
def test_how_far_the_arcs_are_from_a_curve_is_what_they_are_one_by_one(size: float) -> None:
    poles = size * np.array([[-2.0, 4, 0], [0, -4, 0], [3, 4, 0]])
    farthest = 0.0
    for k, (begin, joint, end, leaves, arrives) in enumerate(arcs_of(poles)):
        piece = bezier(poles, np.linspace(k / 12, (k + 1) / 12, 500))[:, :2]
        for corner, way, to in ((begin, leaves, joint), (end, arrives, joint)):
            normal = np.array([-way[1], way[0]])
            radius = float((to - corner) @ (to - corner) / (2.0 * normal @ (to - corner)))
            centre = corner + radius * normal
            begin_angle, end_angle = (np.arctan2(*(each - centre)[::-1]) for each in (corner, to))
            turn = (end_angle - begin_angle + np.pi) % (2.0 * np.pi) - np.pi
            here = (np.arctan2(*(piece - centre).T[::-1]) - begin_angle + np.pi) % (2.0 * np.pi) - np.pi
            on = (here * turn >= 0.0) & (np.abs(here) <= abs(turn))
            farthest = max(farthest, float(np.abs(np.linalg.norm(piece[on] - centre, axis=1) - abs(radius)).max()))
    spline = Spline(2, np.array([0.0, 0, 0, 1, 1, 1]), poles, np.ones(3))
    assert arcs_beside(spline) == pytest.approx(farthest, rel=0.01)


def test_arcs_are_on_a_circle_and_a_line() -> None:
    knots = np.array([0.0, 0, 0, 1, 1, 1])
    quarter = Spline(2, knots, np.array([[9.0, 0, 0], [9, 9, 0], [0, 9, 0]]), np.array([1.0, np.sqrt(0.5), 1.0]))
    line = Spline(2, knots, np.array([[0.0, 0, 0], [3, 0, 0], [9, 0, 0]]), np.ones(3))
    assert arcs_beside(quarter) < 1e-12
    assert arcs_beside(line) < 1e-12


def test_a_curve_that_the_machine_leaves_is_warned_of_by_how_far(run: Runner) -> None:
    small, large = (run(f"{HEAD}G5.1 X{4 * k} Y0 I{2 * k} J{-8 * k}\nG0 Z9\nM2\n") for k in (1, 20))
    assert not small.diagnostics
    told = [each for each in large.diagnostics if each.code == "NC322"]
    assert [each.line for each in told] == [5]
    assert "LinuxCNC runs this curve as 24 arcs, up to 0.019 mm beside it" in told[0].text


def test_an_order_below_three_is_three_and_said(run: Runner) -> None:
    curve = "\nX2 Y2 P1\nX3 Y1 P1\nX4 Y0 P1\nG5.3\nG0 Z9\nM2\n"
    two, three = (run(f"{HEAD}G5.2 P1 L{order}{curve}") for order in (2, 3))
    close(two.tip, three.tip)
    assert ["an order L2" in each.text for each in two.diagnostics if each.code == "NC322"] == [True]
