"""Time that a machine takes, against what can be worked out by hand and what no machine can beat."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.arrays import Flags, Floats
from trunnion.machines import Machine, load_machine
from trunnion.timing import CORNER_TOLERANCE, AxisDynamics, Path, piece_seconds

BC = load_machine("generic_head_table_bc")
X, Y = (next(k for k, axis in enumerate(BC.axes) if axis.name == name) for name in "XY")
RAPID = 30000.0 / 60.0
RAMP = 4000.0


def steps_of(*moves: tuple[float, float]) -> Floats:
    """Rows that move X and Y."""
    steps = np.zeros((len(moves), 5))
    for row, (x, y) in enumerate(moves):
        steps[row, X], steps[row, Y] = x, y
    return steps


def taken(steps: Floats, feed: float = math.inf, machine: Machine = BC, stops: tuple[int, ...] = ()) -> Floats:
    """Seconds of rows whose length is that of their slides."""
    stop = np.zeros(len(steps), bool)
    stop[list(stops)] = True
    length = np.linalg.norm(steps[:, list(machine.linear)], axis=1)
    return piece_seconds(path_of(steps, length, feed, stop), AxisDynamics.of(machine))


def path_of(steps: Floats, length: Floats, feed: float, stop: Flags) -> Path:
    """A path with one feed, and the usual tolerance."""
    n = len(steps)
    return Path(
        steps, length, np.full(n, feed), np.full(n, CORNER_TOLERANCE), stop, np.zeros(n, bool), np.zeros(0, np.int64)
    )


def rest_to_rest(length: float, top: float, ramp: float) -> float:
    """The trapezoid by hand."""
    if length < top**2 / ramp:
        return 2.0 * math.sqrt(length / ramp)
    return length / top + top / ramp


def test_the_machine_is_the_one_that_the_figures_are_for() -> None:
    assert BC.axes[X].rapid == RAPID * 60.0
    assert BC.axes[X].acceleration == RAMP


@pytest.mark.parametrize(("length", "feed"), [(0.01, 1000.0), (100.0, 6000.0), (500.0, math.inf), (3.0, math.inf)])
def test_one_line_is_a_trapezoid(length: float, feed: float) -> None:
    top = min(feed / 60.0, RAPID)
    assert taken(steps_of((length, 0.0)), feed).sum() == pytest.approx(rest_to_rest(length, top, RAMP))


@given(st.lists(st.floats(0.001, 50.0), min_size=1, max_size=30), st.floats(10.0, 20000.0))
def test_points_on_a_straight_line_cost_nothing(lengths: list[float], feed: float) -> None:
    together = taken(steps_of((sum(lengths), 0.0)), feed).sum()
    assert taken(steps_of(*((length, 0.0) for length in lengths)), feed).sum() == pytest.approx(together, rel=1e-9)


def test_a_stop_costs_a_ramp_down_and_up() -> None:
    path = steps_of((100.0, 0.0), (100.0, 0.0))
    assert taken(path, 6000.0, stops=(0,)).sum() == pytest.approx(2.0 * rest_to_rest(100.0, 100.0, RAMP))


def test_a_stop_at_a_row_without_motion_holds_for_the_motion_before() -> None:
    path = steps_of((100.0, 0.0), (0.0, 0.0), (100.0, 0.0))
    seconds = taken(path, 6000.0, stops=(1,))
    assert seconds[1] == 0.0
    assert seconds.sum() == pytest.approx(2.0 * rest_to_rest(100.0, 100.0, RAMP))


def test_a_corner_is_slower_than_straight_on_and_faster_than_a_stop() -> None:
    straight = taken(steps_of((100.0, 0.0), (100.0, 0.0)), 6000.0).sum()
    corner = taken(steps_of((100.0, 0.0), (0.0, 100.0)), 6000.0).sum()
    back = taken(steps_of((100.0, 0.0), (-100.0, 0.0)), 6000.0).sum()
    assert straight < corner < back < 2.0 * rest_to_rest(100.0, 100.0, RAMP)


def test_a_circle_of_short_lines_keeps_the_speed_that_its_radius_allows() -> None:
    radius, pieces = 10.0, 3600
    angle = np.linspace(0.0, 20.0 * math.pi, 10 * pieces + 1)
    path = np.diff(np.column_stack((radius * np.cos(angle), radius * np.sin(angle))), axis=0)
    seconds = taken(steps_of(*map(tuple, path.tolist())), 60000.0)
    speed = 2.0 * math.pi * radius / pieces / seconds[len(seconds) // 3 : 2 * len(seconds) // 3]
    # slowest where one axis bears the whole turn; where two share it, there is more to be had
    assert speed.min() == pytest.approx(math.sqrt(RAMP * radius), rel=0.01)
    assert speed.max() < math.sqrt(math.sqrt(2.0) * RAMP * radius)


def test_what_is_not_stated_limits_nothing() -> None:
    free = replace(BC, axes=tuple(replace(axis, rapid=None, acceleration=None) for axis in BC.axes))
    path = steps_of((100.0, 0.0), (0.0, 50.0))
    np.testing.assert_allclose(taken(path, 6000.0, free), [1.0, 0.5])
    np.testing.assert_array_equal(taken(path, math.inf, free), [0.0, 0.0])


moves = st.lists(st.tuples(*[st.floats(-20.0, 20.0)] * 5), min_size=1, max_size=40)


@given(moves, st.floats(10.0, 1e5))
def test_no_axis_is_faster_than_it_can_be(path: list[tuple[float, ...]], feed: float) -> None:
    steps = np.array(path)
    length, stop = np.linalg.norm(steps, axis=1), np.zeros(len(steps), bool)
    seconds = piece_seconds(path_of(steps, length, feed, stop), AxisDynamics.of(BC))
    assert np.isfinite(seconds).all()
    assert (seconds >= 60.0 * length / feed * (1.0 - 1e-9)).all()
    for k, axis in enumerate(BC.axes):
        assert axis.rapid is not None
        assert axis.acceleration is not None
        assert (np.abs(steps[:, k]) <= axis.rapid / 60.0 * seconds * (1.0 + 1e-9) + 1e-12).all()
        # From rest to rest no axis gets this far in less time, but for what an estimate row by row may be off.
        least = rest_to_rest(abs(float(steps[:, k].sum())), axis.rapid / 60.0, axis.acceleration)
        assert seconds.sum() >= 0.99 * least - 1e-4


@given(moves, st.floats(10.0, 1e5), st.floats(1.0, 10.0))
def test_a_stronger_machine_is_no_slower(path: list[tuple[float, ...]], feed: float, factor: float) -> None:
    steps = np.array(path)
    axes = (replace(axis, acceleration=(axis.acceleration or 0.0) * factor) for axis in BC.axes)
    stronger = replace(BC, axes=tuple(axes))
    given_ = path_of(steps, np.linalg.norm(steps, axis=1), feed, np.zeros(len(steps), bool))
    ours, theirs = (piece_seconds(given_, AxisDynamics.of(each)).sum() for each in (BC, stronger))
    assert theirs <= ours * (1.0 + 1e-9)
