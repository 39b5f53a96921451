"""The fastest run: the published case, the closed form of a straight motion, and what no path or limits are."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.published_path import LIMITS, PATH
from trunnion.arrays import Flags, Floats
from trunnion.extras import import_extra
from trunnion.timing import AxisDynamics, AxisMotion, FastestRun, SmoothPath, fastest_run


@pytest.fixture(scope="module")
def published() -> FastestRun:
    return fastest_run(PATH, LIMITS)


def dense_seconds(run: FastestRun) -> Floats:
    """Times spread evenly, and both sides of the ends of all pieces."""
    sides = [run.begins + shift for shift in (-1e-9, 0.0, 1e-9)]
    return np.sort(np.clip(np.concatenate((np.linspace(0.0, run.duration, 60001), *sides)), 0.0, run.duration))


def greatest_share(motion: AxisMotion, limits: AxisDynamics) -> float:
    pairs = (
        (motion.velocity, limits.speed), (motion.acceleration, limits.acceleration), (motion.jerk, limits.jerk),
    )  # fmt: skip
    return max(float((np.abs(values) / limit).max()) for values, limit in pairs)


def test_the_published_case_takes_at_most_8_3_seconds(published: FastestRun) -> None:
    assert 7.11 < published.duration <= 8.3


def test_no_axis_exceeds_a_limit_anywhere(published: FastestRun) -> None:
    share = greatest_share(published.at(dense_seconds(published)), LIMITS)
    assert 0.999 < share <= 1.0 + 1e-6


def test_the_run_begins_and_ends_at_rest_at_the_ends_of_the_path(published: FastestRun) -> None:
    motion = published.at(np.array([0.0, published.duration]))
    ends = PATH.derivatives(np.array([0.0, 1.0]), np.array([False, True]))[0]
    assert motion.position == pytest.approx(ends, abs=1e-12)
    assert np.abs(motion.velocity).max() < 1e-12
    assert np.abs(motion.acceleration).max() < 1e-9


def test_velocities_accelerations_and_jerks_are_those_of_the_positions_in_time(published: FastestRun) -> None:
    step = 2e-5
    seconds = np.linspace(0.01, published.duration - 0.01, 1999)
    far = np.abs(seconds[:, None] - published.begins).min(axis=1) > 2.0 * step
    before, now, after = (published.at(seconds[far] + shift) for shift in (-step, 0.0, step))
    chain = (
        (before.position, after.position, now.velocity), (before.velocity, after.velocity, now.acceleration),
        (before.acceleration, after.acceleration, now.jerk),
    )  # fmt: skip
    for low, high, derivative in chain:
        assert (high - low) / (2.0 * step) == pytest.approx(derivative, rel=1e-4, abs=2e-2)


def test_the_parameter_only_grows(published: FastestRun) -> None:
    assert (np.diff(published.at(np.linspace(0.0, published.duration, 5001)).parameter) > 0.0).all()


def straight(steps: Floats) -> SmoothPath:
    def derivatives(parameter: Floats, before: Flags) -> Floats:
        found = np.zeros((4, len(parameter), len(steps)))
        found[0], found[1] = parameter[:, None] * steps, steps
        return found

    return SmoothPath(derivatives, np.array([0.0, 1.0]))


def s_curve_seconds(length: float, speed: float, acceleration: float, jerk: float) -> float:
    """The fastest motion over a length from rest to rest: the textbook's, with up to seven phases."""
    ramp = min(math.cbrt(length / (2.0 * jerk)), math.sqrt(speed / jerk), acceleration / jerk)
    # jerk * ramp * (2 ramp^2 + 3 ramp even + even^2) = length without a part at full speed
    reach = length / (jerk * ramp)
    even = 0.5 * (math.sqrt(max(ramp**2 + 4.0 * reach, 0.0)) - 3.0 * ramp)
    even = max(min(even, speed / (jerk * ramp) - ramp), 0.0)
    top = jerk * ramp * (ramp + even)
    rest = length - jerk * ramp * (2.0 * ramp**2 + 3.0 * ramp * even + even**2)
    return 4.0 * ramp + 2.0 * even + max(rest, 0.0) / top


@settings(deadline=None, max_examples=examples(6))
@given(
    length=st.floats(0.1, 2000.0),
    speed=st.floats(1.0, 500.0),
    acceleration=st.floats(10.0, 5000.0),
    jerk=st.floats(100.0, 50000.0),
    shares=st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4),
)
def test_a_straight_motion_is_the_s_curve_of_its_farthest_axis(
    length: float, speed: float, acceleration: float, jerk: float, shares: list[float]
) -> None:
    limits = AxisDynamics(np.full(5, speed), np.full(5, acceleration), np.full(5, jerk))
    run = fastest_run(straight(length * np.array([1.0, *shares])), limits, 40)
    least = s_curve_seconds(length, speed, acceleration, jerk)
    assert least * (1.0 - 1e-9) <= run.duration <= 1.02 * least
    assert greatest_share(run.at(dense_seconds(run)), limits) <= 1.0 + 1e-6


@pytest.mark.parametrize("pieces", [40, 80])
def test_short_ramps_at_the_ends_of_a_long_way_do_not_slow_the_whole(pieces: int) -> None:
    limits = AxisDynamics(np.full(1, 1.0), np.full(1, 5000.0), np.full(1, 100.0))
    run = fastest_run(straight(np.array([2000.0])), limits, pieces)
    assert run.duration <= 1.002 * s_curve_seconds(2000.0, 1.0, 5000.0, 100.0)
    assert greatest_share(run.at(dense_seconds(run)), limits) <= 1.0 + 1e-6


def cubic(knots: Floats, points: Floats) -> SmoothPath:
    """A cubic B-spline through the space of the axes; each of its spans by its own Taylor series."""
    breaks = knots[3:-3]
    spline = import_extra("scipy.interpolate", "geometry").BSpline(knots, points, 3)

    def derivatives(parameter: Floats, before: Flags) -> Floats:
        inner = breaks[1:-1]
        span = np.where(before, np.searchsorted(inner, parameter), np.searchsorted(inner, parameter, side="right"))
        middle = 0.5 * (breaks[span] + breaks[span + 1])
        h = (parameter - middle)[:, None]
        d0, d1, d2, d3 = (spline(middle, order) for order in range(4))
        return np.stack((d0 + h * (d1 + h / 2 * (d2 + h / 3 * d3)), d1 + h * (d2 + h / 2 * d3), d2 + h * d3, d3))

    return SmoothPath(derivatives, breaks)


@settings(deadline=None, max_examples=examples(8))
@given(seed=st.integers(0, 2**32 - 1), inner=st.integers(0, 12), pieces=st.integers(1, 60))
def test_on_any_spline_no_limit_is_exceeded_and_one_is_nearly_reached(seed: int, inner: int, pieces: int) -> None:
    random = np.random.default_rng(seed)
    places = (np.sort(random.permutation(200)[:inner]) + 1.0) / 202.0
    points = random.normal(size=(inner + 4, 5)) * 10.0 ** random.uniform(-2.0, 3.0, 5)
    speed, acceleration, jerk = (10.0 ** random.uniform(low, low + 3.0, 5) for low in (0.0, 1.0, 2.0))
    limits = AxisDynamics(speed, acceleration, jerk)
    run = fastest_run(cubic(np.concatenate((np.zeros(4), places, np.ones(4))), points), limits, pieces)
    assert 0.7 < greatest_share(run.at(dense_seconds(run)), limits) <= 1.0 + 1e-6
    longest = zip(np.abs(points[-1] - points[0]), limits.speed, limits.acceleration, limits.jerk, strict=True)
    assert run.duration >= max(s_curve_seconds(*one) for one in longest)


def test_a_hundred_times_slower_axes_take_a_hundred_times_as_long() -> None:
    slow = AxisDynamics(LIMITS.speed / 100.0, LIMITS.acceleration / 1e4, LIMITS.jerk / 1e6)
    assert fastest_run(PATH, slow, 40).duration == pytest.approx(
        100.0 * fastest_run(PATH, LIMITS, 40).duration, rel=1e-4
    )


def test_an_axis_without_limits_does_not_count() -> None:
    none = np.array([math.inf, 1.0, 1.0, 1.0, 1.0])
    limits = AxisDynamics(100.0 * none, 1000.0 * none, 10000.0 * none)
    run = fastest_run(straight(np.array([1e4, 10.0, 0.0, 0.0, 0.0])), limits, 40)
    alone = fastest_run(straight(np.array([0.0, 10.0, 0.0, 0.0, 0.0])), limits, 40)
    assert run.duration == pytest.approx(alone.duration, rel=1e-6)


@pytest.mark.parametrize(
    ("path", "jerk", "message"),
    [
        (straight(np.ones(5)), math.inf, "no axis has a limit of its jerk"),
        (straight(np.ones(5)), 0.0, "limits must be positive"),
        (straight(np.zeros(5)), 1000.0, "does not move"),
        (straight(np.full(5, np.nan)), 1000.0, "is not finite"),
        (replace(straight(np.ones(5)), breaks=np.array([0.0, 0.5, 0.5, 1.0])), 1000.0, "breaks must ascend"),
    ],
)  # fmt: skip
def test_paths_and_limits_without_a_fastest_run_are_refused(path: SmoothPath, jerk: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fastest_run(path, AxisDynamics(np.full(5, 100.0), np.full(5, 1000.0), np.full(5, jerk)), 20)
