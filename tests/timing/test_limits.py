"""What the axes can do holds everywhere on any path: looked at closely, in straight parts and in corners."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.naive.speeds import naive_seconds
from trunnion.arrays import Floats
from trunnion.machines import load_machine
from trunnion.timing import AxisDynamics, Path, piece_seconds, timed_pieces
from trunnion.timing.planner import Phases, plan
from trunnion.timing.speed_kernel import BEGIN, CORNER, END, plan_speeds

EVEN = AxisDynamics.of(load_machine("generic_head_table_bc"))
SMOOTH = replace(EVEN, jerk=np.array([5e3, 4e4, 5e4, 6e4, 5e3]))

#: What rounding may add.
MORE = 1.0 + 1e-9

#: What more of anything may cost; the most in 300,000 random paths is 1.032.
HARDLY_LONGER = 1.05


@st.composite
def paths(draw: st.DrawFn) -> Path:
    """Rough and smooth ones, of pieces long and short, some without motion, with stops and tolerances."""
    n = draw(st.integers(1, 50))
    seed = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    steps = seed.normal(size=(n, 5)) * draw(st.sampled_from([0.01, 1.0, 30.0]))
    if draw(st.booleans()):
        steps = np.cumsum(steps, axis=0)
    steps *= seed.random((n, 5)) < draw(st.sampled_from([0.3, 1.0]))
    length = np.linalg.norm(steps, axis=1) * np.where(seed.random(n) < 0.9, 1.0, seed.uniform(0.01, 1.0, n))
    rate = np.where(seed.random(n) < 0.2, math.inf, draw(st.floats(10.0, 1e5)))
    tolerance = seed.choice([0.0, 0.01, 0.2, math.inf], n) if draw(st.booleans()) else np.full(n, 0.01)
    return Path(steps, length, rate, tolerance, seed.random(n) < 0.1, np.zeros(n, bool), np.zeros(0, np.int64))


def directions(path: Path) -> Floats:
    """Axis values for each unit of the length, (m, 5)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.nan_to_num(path.steps / path.length[:, None]))


def closely(phases: Phases) -> tuple[Floats, Floats]:
    """Speed and acceleration along the path at many times of each phase, (p, 17)."""
    time = np.linspace(0.0, 1.0, 17) * phases.seconds[:, None]
    acceleration = phases.acceleration[:, None] + time * phases.jerk[:, None]
    speed = phases.speed[:, None] + time * (phases.acceleration[:, None] + time * phases.jerk[:, None] / 2.0)
    return speed, acceleration


@pytest.mark.parametrize("dynamics", [EVEN, SMOOTH], ids=["even", "smooth"])
@given(path=paths())
def test_no_axis_is_beyond_its_limits_and_no_piece_beyond_its_feed(path: Path, dynamics: AxisDynamics) -> None:
    seconds, phases = plan(path, dynamics)
    speed, acceleration = closely(phases)
    assert np.isfinite(seconds).all()
    assert (speed >= -1e-9 * MORE).all()
    assert (speed <= path.rate[phases.piece][:, None] / 60.0 * MORE + 1e-12).all()
    shares = np.abs(directions(path))[phases.piece]
    for k in range(5):
        share = shares[:, k, None]
        assert (share * speed <= dynamics.speed[k] * MORE).all()
        assert (share * np.abs(acceleration) <= dynamics.acceleration[k] * MORE).all()
        assert (share[:, 0] * np.abs(phases.jerk) <= dynamics.jerk[k] * MORE).all()


@pytest.mark.parametrize("dynamics", [EVEN, SMOOTH], ids=["even", "smooth"])
@given(path=paths())
def test_phases_follow_each_other_without_a_jump_and_cover_the_path(path: Path, dynamics: AxisDynamics) -> None:
    seconds, phases = plan(path, dynamics)
    speed, acceleration = closely(phases)
    top = max(1.0, float(speed.max(initial=0.0)))
    np.testing.assert_allclose(speed[:-1, -1], speed[1:, 0], atol=1e-7 * top, rtol=0)
    np.testing.assert_allclose([speed[0, 0], speed[-1, -1]], 0.0, atol=1e-7 * top) if len(speed) else None
    if dynamics is SMOOTH:
        top = max(1.0, float(np.abs(acceleration).max(initial=0.0)))
        np.testing.assert_allclose(acceleration[:-1, -1], acceleration[1:, 0], atol=1e-6 * top, rtol=0)
    t = phases.seconds
    way = t * (phases.speed + t * (phases.acceleration / 2.0 + t * phases.jerk / 6.0))
    moves = (np.abs(path.steps).max(axis=1) > 0.0) & (path.length > 0.0)
    covered = np.bincount(phases.piece, way, len(seconds))
    np.testing.assert_allclose(covered[moves], path.length[moves], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(np.bincount(phases.piece, t, len(seconds)), seconds, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(piece_seconds(path, dynamics), seconds, rtol=1e-12)


@pytest.mark.parametrize("dynamics", [EVEN, SMOOTH], ids=["even", "smooth"])
@given(path=paths())
def test_the_speed_that_a_piece_reaches_is_the_highest_of_its_phases(path: Path, dynamics: AxisDynamics) -> None:
    times, (_, phases) = timed_pieces(path, dynamics), plan(path, dynamics)
    highest = np.zeros(len(path.length))
    np.maximum.at(highest, phases.piece, closely(phases)[0].max(axis=1))
    np.testing.assert_allclose(times.reached, highest, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(times.seconds, piece_seconds(path, dynamics), rtol=1e-12)


@given(paths())
def test_corners_are_parabolas_within_the_tolerance_and_the_accelerations(path: Path) -> None:
    """The parabola, point for point: the direction changes evenly, and so does the square of the speed."""
    columns, seconds = np.zeros((len(path.length), 5)), np.zeros(len(path.length))
    limits = np.stack((EVEN.speed, EVEN.acceleration))
    no = path.bends_after
    plan_speeds(
        path.steps, path.length, path.rate / 60.0, path.tolerance, path.stops_after, no, limits, columns, seconds
    )
    moves = np.flatnonzero((np.abs(path.steps).max(axis=1) > 0.0) & (path.length > 0.0))
    along = directions(path)
    for one, two in pairwise(moves.tolist()):
        half = columns[one, CORNER]
        if half == 0.0:
            continue
        assert not path.stops_after[one:two].any()
        assert half <= 0.5 * min(path.length[one], path.length[two]) * MORE
        bend = (along[two] - along[one]) / (2.0 * half)
        assert np.abs(bend).max() * half**2 / 2.0 <= path.tolerance[one] * MORE
        b0, b1 = columns[one, END], columns[two, BEGIN]
        for done in np.linspace(0.0, 1.0, 9):
            direction = along[one] + done * (along[two] - along[one])
            square = b0 + done * (b1 - b0)
            needed = np.abs(direction * (b1 - b0) / (4.0 * half) + bend * square)
            assert (needed <= EVEN.acceleration * MORE).all()
            assert (np.abs(direction) * math.sqrt(square) <= EVEN.speed * MORE).all()


@given(paths())
def test_the_passes_find_what_lowering_without_order_finds(path: Path) -> None:
    np.testing.assert_allclose(piece_seconds(path, EVEN), naive_seconds(path, EVEN), rtol=1e-7, atol=1e-10)


@pytest.mark.third
@pytest.mark.parametrize("length", [1e-4, 0.01, 0.3, 2.0, 20.0, 300.0])
@pytest.mark.parametrize("feed", [60.0, 6000.0, math.inf])
def test_one_straight_move_under_jerk_is_that_of_the_textbook(length: float, feed: float) -> None:
    """Seven phases: Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots, 3.4."""
    top, ramp, jerk = min(feed / 60.0, 500.0), 4000.0, 4e4
    rises = min(ramp / jerk, math.sqrt(top / jerk))
    up = rises + top / (jerk * rises)
    if top * up <= length:
        expected = length / top + up
    elif 2.0 * ramp**3 / jerk**2 <= length:
        expected = ramp / jerk + math.sqrt((ramp / jerk) ** 2 + 4.0 * length / ramp)
    else:
        expected = 4.0 * (length / (2.0 * jerk)) ** (1.0 / 3.0)
    steps = np.zeros((1, 5))
    steps[0, 1] = length
    no, none = np.zeros(1, bool), np.zeros(0, np.int64)
    path = Path(steps, np.array([length]), np.array([feed]), np.array([0.01]), no, no, none)
    assert piece_seconds(path, SMOOTH)[0] == pytest.approx(expected, rel=1e-9)
    split = replace(path, steps=np.repeat(steps / 64.0, 64, axis=0), length=np.full(64, length / 64.0))
    split = replace(split, rate=np.full(64, feed), tolerance=np.full(64, 0.01), stops_after=np.zeros(64, bool))
    assert piece_seconds(split, SMOOTH).sum() == pytest.approx(expected, rel=1e-6)


@given(paths())
def test_jerks_only_cost_time(path: Path) -> None:
    assert piece_seconds(path, SMOOTH).sum() >= piece_seconds(path, EVEN).sum() * (1.0 - 1e-3)


@given(paths(), st.lists(st.floats(1.0, 5.0), min_size=11, max_size=11))
def test_more_of_anything_takes_hardly_longer(path: Path, factors: list[float]) -> None:
    """Where a corner can be passed faster it is longer, and leaves less room for ramps: a few pieces take 3 % more."""
    now = piece_seconds(path, EVEN).sum()
    more = replace(EVEN, speed=EVEN.speed * factors[:5], acceleration=EVEN.acceleration * factors[5:10])
    assert piece_seconds(path, more).sum() <= now * HARDLY_LONGER
    assert piece_seconds(replace(path, rate=path.rate * factors[10]), EVEN).sum() <= now * HARDLY_LONGER
