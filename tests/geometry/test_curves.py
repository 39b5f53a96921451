"""Curves through points: the published blade, exact curves, and random points."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.geometry.approximation import approximate
from trunnion.geometry.closest import closest_parameters
from trunnion.geometry.curves import BSplineCurve
from trunnion.geometry.ends import Ends, Natural, Tangent, parse_end
from trunnion.geometry.fairing import fair_points
from trunnion.geometry.fitting import Wanted, fit
from trunnion.geometry.interpolation import interpolate
from trunnion.geometry.parameters import parameters_of
from trunnion.geometry.point_tables import PointTable, read_point_table
from trunnion.geometry.spans import spans_between

BLADE = Path(__file__).resolve().parents[2] / "examples" / "impeller" / "blade_points.csv"
PUBLISHED = Path(__file__).with_name("blade_control_points.csv")

PUBLISHED_ENDS = Ends(Tangent((0.0, 0.0, 1.0), is_derivative=True), Tangent((-1.0, 0.0, 0.0), is_derivative=True))


def circle(count: int, radius: float = 10.0, angle: float = np.pi / 2.0) -> Floats:
    at = np.linspace(0.0, angle, count)
    return np.column_stack((radius * np.cos(at), radius * np.sin(at), np.zeros(count)))


@st.composite
def paths(draw: st.DrawFn) -> Floats:
    """Points of which no two in turn are the same, and none goes straight back."""
    count = draw(st.integers(5, 30))
    seed = draw(st.integers(0, 2**32 - 1))
    steps = np.random.default_rng(seed).normal(loc=(2.0, 0.0, 0.0), size=(count, 3))
    return np.cumsum(steps * draw(st.sampled_from([0.01, 1.0, 40.0])), axis=0)


def test_the_published_blade_has_the_published_control_points() -> None:
    printed = np.genfromtxt(PUBLISHED, delimiter=",", names=True)
    for table, mean in zip(read_point_table(BLADE), (0.0103, 0.0163), strict=True):
        curve = interpolate(table.points, parameters_of(table.points), PUBLISHED_ENDS)
        expected = np.column_stack([printed[f"{table.name}_{axis}_mm"] for axis in "xyz"])
        off = np.abs(curve.control_points - expected)
        assert off.shape == (22, 3)
        assert off.max() <= 0.13
        assert off.mean() <= mean


def test_the_published_end_tangents_bend_the_first_and_last_span_and_natural_ends_do_not() -> None:
    for table in read_point_table(BLADE):
        bent = fit(table, Wanted(PUBLISHED_ENDS))
        assert [k for k, span in enumerate(bent.spans) if span.runs_back] == [0, 18]
        assert [remark.line for remark in bent.remarks] == [3, 21]
        assert "runs back before this point: its direction is up to" in bent.remarks[0].what
        assert min(span.radius for span in bent.spans) < 0.001
        natural = fit(table, Wanted())
        assert natural.remarks == ()
        assert max(span.turn for span in natural.spans) < 5.0
        assert all(span.bend < 1e-12 for span in natural.spans)


@settings(max_examples=examples(25))
@given(paths(), st.sampled_from(["chord-length", "centripetal"]), st.booleans(), st.booleans())
def test_a_curve_passes_its_points_and_keeps_its_ends(points: Floats, kind: str, tangent: bool, rational: bool) -> None:
    parameters = parameters_of(points, kind)
    ends = Ends(Tangent((1.0, 2.0, -0.5)), Tangent((0.0, 3.0, 1.0), is_derivative=True)) if tangent else Ends()
    weights = np.linspace(1.0, 1.5, len(points)) if rational else None
    curve = interpolate(points, parameters, ends, weights)
    size = np.abs(points).max()
    assert np.abs(curve.points(parameters) - points).max() <= 1e-11 * size
    assert len(curve.control_points) == len(points) + 2
    start, end = curve.derivatives(np.array([0.0, 1.0]), 1)[1]
    if tangent:
        chords = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        given_start = np.array([1.0, 2.0, -0.5]) * chords / np.sqrt(5.25)
        np.testing.assert_allclose(start, given_start, rtol=1e-9, atol=1e-9 * size)
        np.testing.assert_allclose(end, [0.0, 3.0, 1.0], atol=1e-9 * size)
    elif not rational:
        assert np.abs(curve.derivatives(np.array([0.0, 1.0]), 2)[2]).max() <= 1e-6 * size * len(points) ** 2
    inside = np.linspace(0.013, 0.987, 31)
    step = 1e-6
    numeric = (curve.points(inside + step) - curve.points(inside - step)) / (2.0 * step)
    derivative = curve.derivatives(inside, 1)[1]
    np.testing.assert_allclose(numeric, derivative, atol=1e-4 * np.abs(derivative).max())


def test_a_straight_line_is_straight_and_its_curvature_nothing() -> None:
    points = np.outer([0.0, 1.0, 2.5, 3.0, 7.0], [1.0, -2.0, 3.0])
    fitted = fit(PointTable("points", "", points, range(1, 6)), Wanted())
    assert fitted.length == pytest.approx(7.0 * np.sqrt(14.0), rel=1e-12)
    assert max(span.sag for span in fitted.spans) < 1e-12
    assert np.abs(fitted.curve.curvatures(np.linspace(0.0, 1.0, 11))).max() < 1e-12


def test_a_rational_curve_can_be_an_exact_circle() -> None:
    half = np.sqrt(0.5)
    # The quarter circle as a cubic: the quadratic of Piegl and Tiller, example 7.1, with its degree elevated.
    first, middle, last = np.array([[10.0, 0, 0, 1], [10 * half, 10 * half, 0, half], [0, 10.0, 0, 1]])
    cubic = np.vstack((first, (first + 2 * middle) / 3, (2 * middle + last) / 3, last))
    curve = BSplineCurve(np.repeat([0.0, 1.0], 4), cubic[:, :3] / cubic[:, 3:], cubic[:, 3])
    at = np.linspace(0.0, 1.0, 21)
    np.testing.assert_allclose(np.linalg.norm(curve.points(at), axis=1), 10.0, rtol=1e-14)
    np.testing.assert_allclose(curve.curvatures(at), -curve.points(at) / 100.0, atol=1e-13)
    assert curve.lengths(np.array([0.0, 1.0]))[0] == pytest.approx(5.0 * np.pi, rel=1e-12)


def test_lengths_of_parts_add_up() -> None:
    curve = interpolate(circle(9), parameters_of(circle(9)))
    parts = curve.lengths(np.array([0.0, 0.1, 0.33, 0.9, 1.0]))
    assert parts.sum() == pytest.approx(curve.lengths(np.array([0.0, 1.0]))[0], rel=1e-12)
    fine = np.linalg.norm(np.diff(curve.points(np.linspace(0.1, 0.33, 20001)), axis=0), axis=1).sum()
    assert parts[1] == pytest.approx(fine, rel=1e-7)


@settings(max_examples=examples(20))
@given(paths(), st.sampled_from([0.001, 0.02, 0.3]))
def test_no_sample_of_a_curve_is_nearer_than_the_closest_point(points: Floats, away: float) -> None:
    curve = interpolate(points, parameters_of(points))
    size = np.linalg.norm(np.diff(points, axis=0), axis=1).mean()
    asked = points + size * away * np.random.default_rng(1).normal(size=points.shape)
    found = np.linalg.norm(curve.points(closest_parameters(curve, asked)) - asked, axis=1)
    samples = curve.points(np.linspace(0.0, 1.0, 4001))
    nearest = np.linalg.norm(samples[None] - asked[:, None], axis=2).min(axis=1)
    assert (found <= nearest + 1e-9 * size).all()


def test_the_closest_point_is_found_on_a_curve_that_comes_back_to_itself() -> None:
    rng = np.random.default_rng(5)
    for _ in range(15):
        points = np.cumsum(rng.normal(size=(9, 3)) * [3.0, 3.0, 0.2], axis=0)
        curve = interpolate(points, parameters_of(points))
        dense = curve.points(np.linspace(0.0, 1.0, 20_001))
        asked = dense[rng.integers(0, len(dense), 100)] + rng.normal(size=(100, 3))
        found = np.linalg.norm(curve.points(closest_parameters(curve, asked)) - asked, axis=1)
        assert all(
            off <= np.linalg.norm(dense - one, axis=1).min() + 1e-9 for off, one in zip(found, asked, strict=True)
        )


@pytest.mark.parametrize("tolerance", [0.3, 0.03, 0.001])
def test_few_control_points_hold_the_tolerance(tolerance: float) -> None:
    points = circle(60, angle=1.5 * np.pi) + np.column_stack((np.zeros((60, 2)), np.linspace(0.0, 8.0, 60)))
    curve = approximate(points, parameters_of(points), tolerance)
    off = np.linalg.norm(curve.points(closest_parameters(curve, points)) - points, axis=1)
    assert off.max() <= tolerance
    np.testing.assert_array_equal(curve.control_points[[0, -1]], points[[0, -1]])
    assert len(curve.control_points) == {0.3: 5, 0.03: 8, 0.001: 13}[tolerance]


def test_a_tolerance_that_only_the_curve_through_all_points_holds_gives_that_curve() -> None:
    points = np.cumsum(np.random.default_rng(5).normal(size=(12, 3)), axis=0)
    curve = approximate(points, parameters_of(points), 1e-7)
    np.testing.assert_allclose(curve.points(parameters_of(points)), points, atol=1e-12)


def test_fairing_moves_no_point_too_far_and_calms_the_curvature() -> None:
    smooth = circle(40)
    rough = smooth + np.random.default_rng(2).normal(scale=0.004, size=smooth.shape)
    parameters = parameters_of(rough)
    fair = fair_points(rough, parameters, 0.02)
    moved = np.linalg.norm(fair - rough, axis=1).max()
    assert 0.0199 < moved <= 0.02
    at = np.linspace(0.1, 0.9, 200)

    def unrest(points: Floats) -> float:
        curvature = interpolate(points, parameters_of(points)).curvatures(at)
        return float(np.ptp(np.linalg.norm(curvature, axis=1)))

    assert unrest(fair) < 0.2 * unrest(rough)


def test_spans_tell_sag_radius_and_turn_of_an_arc() -> None:
    points = circle(33)
    curve = interpolate(points, parameters_of(points), Ends(Tangent((0.0, 1.0, 0.0)), Tangent((-1.0, 0.0, 0.0))))
    spans = spans_between(curve, parameters_of(points), curve)
    angle = np.pi / 64.0
    assert spans[16].radius == pytest.approx(10.0, rel=1e-3)
    assert spans[16].sag == pytest.approx(10.0 * (1.0 - np.cos(angle / 2.0)), rel=1e-3)
    assert spans[16].turn == pytest.approx(np.degrees(angle / 2.0), rel=1e-3)
    assert spans[16].length == pytest.approx(10.0 * angle, rel=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        "tangent:0,0,0",
        "tangent:1,2",
        "derivative:a,b,c",
        "natural:1,0,0",
        "free",
        "tangent:nan,0,1",
        "derivative:1e-320,0,0",
    ],
)
def test_an_end_that_is_none_is_refused_with_what_it_may_be(text: str) -> None:
    with pytest.raises(InputError, match=r"start: error: is .*; write natural, tangent:X,Y,Z"):
        parse_end("start", text)
    assert parse_end("start", "natural") == Natural()


def test_weights_that_vary_too_much_are_refused() -> None:
    points = circle(6)
    weights = np.array([1.0, 1000.0, 1.0, 1000.0, 1.0, 1000.0])
    with pytest.raises(InputError, match="weights: error: vary so much"):
        interpolate(points, parameters_of(points), None, weights)


@pytest.mark.parametrize(
    ("wanted", "weights", "what"),
    [
        (Wanted(PUBLISHED_ENDS, tolerance=0.1), None, "start: error: is for a curve through points"),
        (Wanted(tolerance=0.1), np.ones(4), "weights: error: are for a curve through points"),
        (Wanted(fair=0.1), None, "fair: error: needs 5 points, and there are 4"),
        (Wanted(), np.ones(3), "weights: error: are not a number above 0 for each point; give 4 of them"),
        (Wanted(), np.array([1.0, 1.0, 0.0, 1.0]), "weights: error: are not a number above 0"),
    ],
)
def test_contradictions_are_refused(wanted: Wanted, weights: Floats | None, what: str) -> None:
    with pytest.raises(InputError, match=what):
        fit(PointTable("points", "", circle(4), range(1, 5)), wanted, weights)


def test_spans_of_many_points_are_those_of_each_pair() -> None:
    points = circle(1500)
    parameters = parameters_of(points)
    curve = interpolate(points, parameters, Ends(Tangent((1.0, 1.0, 0.0)), Natural()))
    natural = interpolate(points, parameters)
    spans = spans_between(curve, parameters, natural)
    assert len(spans) == 1499
    for k in (0, 1, 1022, 1023, 1024, 1025, 1498):
        (alone,) = spans_between(curve, parameters[k : k + 2], natural)
        for field in ("length", "sag", "radius", "turn", "bend"):
            assert getattr(alone, field) == pytest.approx(getattr(spans[k], field), rel=1e-6, abs=1e-9)
