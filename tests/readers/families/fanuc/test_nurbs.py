"""G06.2: NURBS by their control points, knots and weights, as the operator's manual defines them."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings

from tests.support.examples import examples
from tests.support.naive.splines import points_of, splines
from tests.support.reading import Runner, close
from trunnion.arrays import Floats
from trunnion.controls.words import NumberFormat
from trunnion.machines import Machine, load_machine
from trunnion.model.splines import Spline
from trunnion.model.toolpath import Kind
from trunnion.output.families.fanuc.splines import spline_lines, takes_spline
from trunnion.readers import run_program
from trunnion.readers.control.splines import CHORD, SplineError, nurbs_points

#: Its first span goes out and comes back, and turns 0.1 mm behind the next of eight points.
OUT_AND_BACK = Spline(
    2,
    np.array([0.0, 0.0, 0.0, 0.809, 1.0, 1.0, 1.0]),
    np.array([[11.4337, 4.0324, -0.8486], [40.0, 3.5942, -0.0401], [11.4337, 4.0324, -0.8486], [10, 0, 0]]),
    np.array([1.0, 2.125, 1.0, 1.0]),
)

HEAD = "%\nO1\nG21 G90 G94 G17\nG54\nG1 X10. Y0. Z0. F500.\n"
#: A quarter of a circle, exactly.
QUARTER = "G06.2 P3 K0. X10. Y0. Z0. R2.\nK0. X10. Y10. Z0. R1.414\nK0. X0. Y10. Z0. R2.\nK1.\nK1.\nK1.\n"


@pytest.fixture(scope="module")
def fanuc() -> Machine:
    return load_machine("matsuura_mx330")


def test_weights_make_a_circle(run: Runner, fanuc: Machine) -> None:
    found = run(f"{HEAD}{QUARTER}G1 X0. Y0.\nM30\n%\n", fanuc)
    assert not found.diagnostics
    first, last, spline = found.splines[0]
    assert (first, spline.degree, spline.weights.tolist()) == (1, 2, [2.0, 1.414, 2.0])
    assert np.abs(np.linalg.norm(found.tip[1 : last + 1], axis=1) - 10.0).max() < 2e-3
    close(found.tip[last], [0, 10, 0], atol=1e-12)
    angles = np.unwrap(np.arctan2(found.tip[: last + 1, 1], found.tip[: last + 1, 0]))
    assert (10.0 * (1.0 - np.cos(0.5 * np.diff(angles)))).max() < 0.0011
    assert (np.diff(angles) > 0.0).all()
    assert math.isclose(angles[-1], 0.5 * math.pi)
    assert set(found.kind.tolist()) == {Kind.LINEAR}
    assert found.feed[last] == 500.0
    close(found.tip[-1], [0, 0, 0])


def test_one_curve_after_another_without_an_order(run: Runner, fanuc: Machine) -> None:
    line = "K0. X{0}. Y0. Z0.\nK0. X12. Y4. Z0.\nK0. X18. Y4. Z1.\nK0. X20. Y0. Z0.\n" + "K5.\n" * 4
    there, back = line.format(10), line.replace("X20.", "X10.").format(20)
    found = run(f"{HEAD}G6.2 {there}G6.2 {back}G0 Z50.\nM30\n%\n", fanuc)
    assert not found.diagnostics
    assert [found.splines[k].spline.degree for k in (0, 1)] == [3, 3]
    close(found.tip[[found.splines[0].last, found.splines[1].last]], [[20, 0, 0], [10, 0, 0]], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (QUARTER.replace("P3", "P5"), "an order P5"),
        (QUARTER.replace("K0. X10. Y0.", "K0. X10. Y1."), "PS1009"),
        (QUARTER.replace("K1.\nK1.\nK1.", "K1.\nK1."), "before the last knot"),
        (QUARTER.replace("K1.\nK1.\nK1.", "K1.\nK1.\nK2."), "PS1007"),
        (QUARTER.replace("K0. X10. Y10.", "K-1. X10. Y10."), "a knot below"),
        (QUARTER.replace("K0. X10. Y10.", "X10. Y10."), "without K"),
        (QUARTER.replace("Y10. Z0. R1", "Y10. R1"), "without X, Y and Z"),
        (QUARTER.replace("R1.414", "R0."), "a weight of 0"),
        (QUARTER.replace("R1.414", "R1.414 M8"), "another command"),
        (QUARTER.replace("K0. X0.", "G1 K0. X0."), "another command"),
        (QUARTER.replace("K1.\n", "K1. X3. Y3. Z0.\n", 1), "before the last knot"),
        (QUARTER.replace("K1.\nK1.", "K1.\nK1. X3. Y3. Z0."), "behind the last ones"),
        (QUARTER + "X5. Y5.\n", "behind the last knot"),
        ("G91\n" + QUARTER, "incremental"),
        ("G41 D1\n" + QUARTER, "radius compensation"),
        ("G95 F1.\n" + QUARTER, "feed per minute"),
        ("G43.4 H1\n" + QUARTER, "TCP"),
        (QUARTER.replace("G06.2", "G06.2 G17"), "other G and M words"),
        (QUARTER.replace("X10. Y10.", "X99999999. Y10."), "farther away"),
        (QUARTER.replace("K0. X0.", "K0. A5. X0."), "A has no use"),
        (QUARTER + "G06.2 P3 K0. X0. Y10. Z0.\n", "before the last knot"),
    ],
)
def test_what_the_control_refuses_is_an_error(run: Runner, fanuc: Machine, text: str, named: str) -> None:
    found = run(f"{HEAD}{text}M30\n%\n", fanuc)
    assert any(named in error.text for error in found.errors), found.diagnostics


def test_a_curve_that_does_not_end_is_named(run: Runner, fanuc: Machine) -> None:
    found = run(HEAD + QUARTER[:-9], fanuc)
    assert any("without its last knots" in error.text for error in found.errors), found.diagnostics


@settings(max_examples=examples(15), deadline=None)
@example(OUT_AND_BACK)
@given(splines(degrees=(1, 2, 3), weights=(0.5, 1.0, 2.125), repeats=1))
def test_what_is_written_is_read(tmp_path_factory: pytest.TempPathFactory, fanuc: Machine, spline: Spline) -> None:
    assert takes_spline(spline)
    lines = spline_lines(spline, {"coordinate": NumberFormat(4)})
    x, y, z = spline.poles[0]
    path = tmp_path_factory.mktemp("nurbs") / "A.nc"
    start = f"%\nO1\nG21 G90 G94 G17\nG54\nG1 X{x:.4f} Y{y:.4f} Z{z:.4f} F500.\n"
    path.write_text(start + "\n".join(lines) + "\nG0 Z90.\nM30\n%\n")
    found = run_program(path, fanuc)
    assert not found.errors
    first, last, own = found.splines[0]
    close(own.poles, spline.poles, atol=1e-9)
    close(own.knots / own.knots[-1], spline.knots, atol=1e-9)
    close(own.weights, spline.weights if spline.is_rational else np.ones(len(own.weights)))
    dense = points_of(spline, np.linspace(0.0, 1.0, 201))
    assert off_chords(dense, found.tip[first - 1 : last + 1]) <= 0.00101


@settings(max_examples=examples(60), deadline=None)
@given(splines(degrees=(1, 2, 3), weights=(0.5, 1.0, 4.0), repeats=1))
def test_no_point_of_a_curve_is_far_from_its_chords(spline: Spline) -> None:
    dense = points_of(spline, np.linspace(0.0, 1.0, 101))
    assert off_chords(dense, np.concatenate((spline.poles[:1], nurbs_points(spline)))) <= CHORD + 1e-9


@pytest.mark.parametrize("inner", [[[20, 20, 0]], [[10, 20, 0], [30, 20, 0]]])
def test_chords_are_no_more_than_a_curve_needs(inner: list[list[float]]) -> None:
    # A short chord is off by the second derivative across it over 8 chords squared: at most 10 mm of the parabola and
    # 13.4 mm of the cubic, so that 100 and 116 chords do. Their number is doubled until it is enough.
    degree = len(inner) + 1
    poles = np.array([[0, 0, 0], *inner, [40, 0, 0]], dtype=float)
    bow = Spline(degree, np.repeat([0.0, 1.0], degree + 1), poles, np.ones(degree + 1))
    assert len(nurbs_points(bow)) == 128


def off_chords(dense: Floats, corners: Floats) -> float:
    """How far the farthest of points is from the chords between corners, mm."""
    begin, step = corners[:-1], np.diff(corners, axis=0)
    farthest = 0.0
    for points in np.array_split(dense, 20):
        length = np.maximum(np.einsum("ki,ki->k", step, step), 1e-30)
        share = np.clip(np.einsum("cki,ki->ck", points[:, None] - begin[None], step) / length, 0.0, 1.0)
        off = np.linalg.norm(points[:, None] - begin - share[..., None] * step, axis=2).min(axis=1)
        farthest = max(farthest, float(off.max()))
    return farthest


def test_a_curve_of_too_many_points_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    corners = np.array([[0, 0, 0], [0, 40, 0], [40, 40, 0], [40, 0, 0.0]])
    bezier = Spline(3, np.repeat([0.0, 1.0], 4), corners, np.ones(4))
    assert len(nurbs_points(bezier)) < 500
    with pytest.raises(SplineError, match="more than 10000 points"):
        nurbs_points(bezier._replace(poles=1e6 * corners))
    monkeypatch.setattr("trunnion.readers.control.splines._MOST_IN_ALL", 100)
    two = Spline(3, np.repeat([0.0, 0.5, 1.0], [4, 3, 4]), np.concatenate((corners, corners[1:])), np.ones(7))
    with pytest.raises(SplineError, match="more than 100 points"):
        nurbs_points(two)


def test_which_splines_the_control_takes() -> None:
    poles, ones = np.arange(15.0).reshape(5, 3), np.ones(5)
    fine = Spline(3, np.array([0, 0, 0, 0, 0.5, 1, 1, 1, 1.0]), poles, ones)
    assert takes_spline(fine)
    assert not takes_spline(Spline(4, np.repeat([0.0, 1.0], 5), poles, ones))
    assert not takes_spline(fine._replace(knots=np.array([0, 0, 0, 0, 1e-9, 1, 1, 1, 1.0])))
    assert not takes_spline(fine._replace(knots=np.array([0, 0, 0, 0.2, 0.5, 1, 1, 1, 1.0])))
    assert not takes_spline(fine._replace(weights=np.array([1, 1, 1.0005, 1, 1])))
