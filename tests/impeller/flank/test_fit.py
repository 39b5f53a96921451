"""Paths of flank milling: surfaces that a cutter can touch everywhere, derivatives, and the family of ruled blades."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.flanks import PUBLISHED, RuledBlade, ruled
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.flank.deviations import Deviations, deviations_of, slopes_of
from trunnion.impeller.flank.fit import Floor, Limits, fit_path
from trunnion.impeller.flank.flanks import Flank
from trunnion.impeller.flank.measure import measured_deviations
from trunnion.impeller.flank.path import FlankPath
from trunnion.impeller.flank.start import double_point_offset

Rails = Callable[[Floats], tuple[Floats, Floats]]


def cylinder(u: Floats) -> tuple[Floats, Floats]:
    """A quarter of a cylinder of radius 30 about Z."""
    angle = 0.5 * np.pi * u
    ring = np.column_stack((30.0 * np.cos(angle), 30.0 * np.sin(angle), np.zeros(len(u))))
    return ring, ring + np.array([0.0, 0.0, 20.0])


def cone(u: Floats) -> tuple[Floats, Floats]:
    """A quarter of a cone about Z, of radius 40 below and 30 above."""
    low, high = cylinder(u)
    return low * (4.0 / 3.0), high


def tangents(u: Floats) -> tuple[Floats, Floats]:
    """Tangents of a helix, 10 to 25 mm from where they touch it: a developable surface."""
    angle = u - 0.5
    at = np.column_stack((20.0 * np.cos(angle), 20.0 * np.sin(angle), 15.0 * angle))
    way = np.column_stack((-20.0 * np.sin(angle), 20.0 * np.cos(angle), np.full(len(u), 15.0))) / 25.0
    return at + 10.0 * way, at + 25.0 * way


def wavy(seed: int, slope: float = 0.0) -> FlankPath:
    """A path with control points at random about a bow."""
    rng = np.random.default_rng(seed)
    at = np.linspace(0.0, 1.0, 8)
    lower = np.column_stack((40.0 * at, 10.0 * at * at, np.zeros(8))) + rng.normal(0.0, 0.5, (8, 3))
    return FlankPath(
        lower, lower + np.array([2.0, 3.0, 30.0]) + rng.normal(0.0, 2.0, (8, 3)), FlankCutter(3.0, slope, 32.0)
    )


@pytest.mark.third
@pytest.mark.parametrize("slope", [0.0, 0.05], ids=["cylinder", "cone"])
@pytest.mark.parametrize("rails", [cylinder, cone, tangents])
def test_a_developable_flank_comes_out_exact(rails: Rails, slope: float) -> None:
    cutter = FlankCutter(3.0, slope, 40.0)
    flank = ruled(rails, 61, 11, 1.0)
    start = double_point_offset(flank, cutter, 14, (0.25, 0.75), 5.0, 0.06)
    fit = fit_path(start, flank.flat(), Limits(enough=5e-4))
    assert np.abs(measured_deviations(fit.path, ruled(rails, 150, 21, 1.0).flat(), 6001)).max() < 1e-3


@given(st.integers(0, 10_000), st.sampled_from([0.0, 0.08, -0.05]))
@example(229, -0.05)  # a point on the axis, where the cutter is 1.4 mm thin
@settings(max_examples=examples(25), deadline=None)
def test_deviations_are_those_of_the_slow_twin(seed: int, slope: float) -> None:
    path = wavy(seed, slope)
    points = np.random.default_rng(seed + 1).uniform((-8.0, -8.0, -8.0), (48.0, 25.0, 40.0), (60, 3))
    found = deviations_of(path, points)[0][:, 0]
    slow = measured_deviations(path, points, 9001)
    assert np.all(found < slow + 1e-9)
    # Near the axis, poses that are s apart miss up to s/2; further out s²/8 divided by the distance, here 1 mm or more.
    lower, axis = path.poses(np.linspace(0.0, 1.0, 9001))
    apart = max(np.linalg.norm(np.diff(at, axis=0), axis=1).max() for at in (lower, lower + path.cutter.length * axis))
    thinnest = path.cutter.radius + min(path.cutter.slope, 0.0) * path.cutter.length
    assert np.abs(found - slow)[found > 1.0 - thinnest].max() < 0.25 * apart * apart  # twice, since paths are bent


@given(st.integers(0, 10_000), st.sampled_from([0.0, 0.08]))
@settings(max_examples=examples(20), deadline=None)
def test_changes_are_those_of_finite_differences(seed: int, slope: float) -> None:
    path = wavy(seed, slope)
    lower, axis = path.poses(np.linspace(0.2, 0.8, 7))
    side = np.cross(np.gradient(lower, axis=0), axis)
    side /= np.linalg.norm(side, axis=1)[:, None]
    points = lower + 15.0 * axis + 4.5 * side
    at = deviations_of(path, points)[1]
    change = slopes_of(path, points, at[:, 0]).changes()
    step = np.random.default_rng(seed).normal(size=(2, 8, 3))
    h = 1e-5
    ends = [
        deviations_of(FlankPath(path.lower + s * step[0], path.upper + s * step[1], path.cutter), points)
        for s in (h, -h)
    ]
    slopes = (ends[0][0][:, 0] - ends[1][0][:, 0]) / (2.0 * h)
    steady = np.abs(ends[0][1][:, 0] - at[:, 0]) < 0.01
    assert steady.sum() > 3
    np.testing.assert_allclose((change @ step.ravel())[steady], slopes[steady], atol=2e-3)


def test_each_round_improves_and_overcut_has_its_own_limit() -> None:
    blade = PUBLISHED["high twist"]
    flank = blade.flank(41, 9, 1.0)
    start = double_point_offset(flank, FlankCutter(3.5, 0.0, 60.0), 10, (0.25, 0.75), 8.0, 0.06)
    both = fit_path(start, flank.flat(), Limits(rounds=25))
    assert all(later < earlier for earlier, later in zip(both.history, both.history[1:], strict=False))
    assert both.deviations.largest < 0.2 * Deviations.of(deviations_of(start, flank.flat())[0]).largest
    assert both.deviations.overcut == pytest.approx(both.deviations.undercut, rel=0.02)
    hard = fit_path(start, flank.flat(), Limits(overcut=0.05, rounds=25))
    assert hard.deviations.overcut < 0.0505
    assert both.deviations.undercut < hard.deviations.undercut < 0.5


def test_the_ball_stays_clear_of_a_floor() -> None:
    flank = ruled(cylinder, 41, 9, 1.0)
    start = double_point_offset(flank, FlankCutter(3.0, 0.0, 30.0), 10, (0.25, 0.75), 2.0, 0.06)

    def above(points: Floats) -> tuple[Floats, Floats]:
        return points[:, 2] + 4.0, np.tile([0.0, 0.0, 1.0], (len(points), 1))

    fit = fit_path(start, flank.flat(), Limits(overcut=0.001), Floor(above, 3.0))
    assert fit.path.poses(np.linspace(0.0, 1.0, 200))[0][:, 2].min() > -1.0 - 1e-4
    assert fit.deviations.overcut < 0.0011


@pytest.mark.parametrize(
    ("radius", "slope", "length"), [(0.0, 0.0, 10.0), (2.0, -0.3, 10.0), (2.0, 0.0, 0.0), (2.0, 1.0, 9.0)]
)
def test_what_is_no_cutter_is_refused(radius: float, slope: float, length: float) -> None:
    with pytest.raises(InputError, match="is none"):
        FlankCutter(radius, slope, length)


def test_a_flank_has_two_sides() -> None:
    flank = ruled(cylinder, 5, 3, 1.0)
    other = ruled(cylinder, 5, 3, -1.0)
    assert isinstance(other, Flank)
    np.testing.assert_allclose(flank.normals, -other.normals)


@pytest.mark.nightly
@given(
    st.floats(30.0, 40.0),
    st.floats(0.0, 14.0),
    st.floats(9.0, 14.0),
    st.floats(16.0, 26.0),
    st.floats(0.3, 0.65),
    st.floats(0.2, 0.65),
)
@settings(max_examples=examples(4), deadline=None)
def test_blades_of_the_family_are_fitted_far_better_than_they_begin(
    inner: float, growth: float, height: float, span: float, wrap: float, twist: float
) -> None:
    blade = RuledBlade(3.0, (inner, inner + growth), (inner + height, inner + height + growth), span, 6.0, wrap, twist)
    flank = blade.flank(61, 11, 1.0)
    start = double_point_offset(flank, FlankCutter(3.0, 0.0, 60.0), 14, (0.25, 0.75), 6.0, 0.06)
    fit = fit_path(start, flank.flat(), Limits(rounds=30))
    assert fit.deviations.largest < 0.5 * Deviations.of(deviations_of(start, flank.flat())[0]).largest
