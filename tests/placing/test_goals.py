"""Goals: costs against sums written out, their subgradients, and the cheapest place against a search."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.placed_paths import best_turns, random_rows
from trunnion.machines import Machine, inverse, load_machine
from trunnion.placing.goals import Goal, PlaceCost, planned_seconds, rotary_travel
from trunnion.placing.largest_margin import largest_margin
from trunnion.placing.least_cost import least_cost
from trunnion.placing.path_rows import PathRows, Stretch
from trunnion.placing.rotary_angles import RotaryAngles, rotary_angles
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import Choice, TurnedPath

YL569 = load_machine("yl569")
GOALS = [Goal.SLIDES, Goal.TIME, Goal.OVERSPEED]


def tilted_rows(seed: int, count: int = 40) -> PathRows:
    """Rows of two operations that the YL569 reaches in its first branch, with times at feed and some rapids."""
    rows = random_rows(seed, count)
    random = np.random.default_rng(seed)
    axis = np.abs(rows.axis) + np.array([0.05, 0.0, 0.0])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    seconds = np.where(random.random(count) < 0.3, 0.0, random.uniform(0.2, 2.0, count))
    stretches = (Stretch(0, "a.cls"), Stretch(count // 2, "a.cls"))
    return replace(
        rows, axis=axis, branch=np.zeros(count, np.uint8), seconds=seconds, stretches=stretches, start=np.zeros((2, 2))
    )


def positions_of(machine: Machine, rows: PathRows) -> np.ndarray:
    """Positions of the rotary axes."""
    angles = rotary_angles(machine, rows)
    assert isinstance(angles, RotaryAngles)
    return angles.positions


def plain_cost(goal: Goal, rows: PathRows, positions: np.ndarray, zero: np.ndarray) -> tuple[float, int]:
    """The cost row after row, by the inverse map."""
    x, y, z = zero.tolist()
    slides = inverse(replace(YL569, workpiece_zero=(x, y, z)), rows.tip, rows.axis).joints[0, :, 2:]
    cost, count = 0.0, 0
    for row in range(1, len(rows)):
        if rows.begins[row]:
            continue
        steps = np.abs(slides[row] - slides[row - 1])
        turns = np.abs(positions[row] - positions[row - 1]) / (np.array([9720.0, 5760.0]) / 60.0)
        needed = max(*(steps / (5000.0 / 60.0)), *turns)
        if goal is Goal.SLIDES:
            cost += steps.sum()
        elif goal is Goal.TIME:
            cost += max(needed, rows.seconds[row])
        elif rows.seconds[row] > 0.0:
            cost += max(needed - rows.seconds[row], 0.0)
        count += rows.seconds[row] > 0.0 and needed > rows.seconds[row] * (1.0 + 1e-9)
    return cost, count


@pytest.mark.parametrize("goal", GOALS)
@settings(max_examples=examples(8), deadline=None)
@given(seed=st.integers(0, 10**6))
def test_costs_are_the_sums_that_they_say_and_planes_stay_below_them(goal: Goal, seed: int) -> None:
    rows = tilted_rows(seed)
    positions = positions_of(YL569, rows)
    cost = PlaceCost.of(goal, YL569, rows, positions)
    random = np.random.default_rng(seed)
    here = random.uniform(-100.0, 100.0, 3)
    value, gradient, count = cost.at(here)
    plain, plain_count = plain_cost(goal, rows, positions, here)
    assert value == pytest.approx(plain, rel=1e-9, abs=1e-9)
    if goal is not Goal.SLIDES:
        assert count == plain_count
    for other in random.uniform(-300.0, 300.0, (10, 3)):
        assert cost.at(other)[0] >= value + gradient @ (other - here) - 1e-6 * max(value, 1.0)


@pytest.mark.parametrize("goal", GOALS)
def test_no_place_of_a_search_is_cheaper_than_the_cheapest(goal: Goal) -> None:
    rows = tilted_rows(7)
    cost = PlaceCost.of(goal, YL569, rows, positions_of(YL569, rows))
    cuts = TurnedPath.of(YL569, Choice.FIRST, rows, np.zeros(3)).at(0.0)
    assert isinstance(cuts, CutSet)
    best = largest_margin(cuts, np.zeros(3))
    found = least_cost(cuts, cost, best.zero, 1.0)
    assert cuts.at(found.zero).margins.min() >= 1.0 - 1e-6
    assert found.bound <= found.cost <= cost.at(best.zero)[0]
    assert found.cost <= found.bound * 1.002 + 1e-6
    random = np.random.default_rng(1)
    for zero in np.concatenate((random.uniform(-250.0, 250.0, (1500, 3)), found.zero + random.normal(size=(500, 3)))):
        if cuts.at(zero).margins.min() >= 1.0:
            assert cost.at(zero)[0] >= found.bound - 1e-6


def test_rotary_travel_counts_from_the_start_of_each_stretch() -> None:
    rows = tilted_rows(3, 4)
    positions = np.array([[10.0, 5.0], [20.0, 5.0], [-40.0, 0.0], [-40.0, 30.0]])
    # 10 + 5, 10; then, anew from 0 0: 40 + 0, 30
    assert rotary_travel(rows, positions) == 95.0


def straight_rows(speed: float) -> PathRows:
    """100 mm along X at a speed, mm/s, by a tool that stands upright."""
    rows = random_rows(1, 2)
    return replace(
        rows,
        tip=np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0]]),
        axis=np.tile([0.0, 0.0, 1.0], (2, 1)),
        branch=np.zeros(2, np.uint8),
        seconds=np.array([0.0, 100.0 / speed if speed else 0.0]),
    )


@pytest.mark.parametrize(
    ("speed", "seconds"),
    [
        (10.0, 10.0 + 10.0 / 50.0),  # v/a besides the time at the feed: half of it at each end
        (50.0, 2.0 + 1.0),
        (0.0, 2.0 * np.sqrt(2.0)),  # at rapid it speeds up for 50 mm, and slows down for 50 mm
    ],
)
def test_planned_seconds_have_the_accelerations_of_the_axes(speed: float, seconds: float) -> None:
    axes = tuple(axis if axis.is_rotary else replace(axis, acceleration=50.0, jerk=None) for axis in YL569.axes)
    machine = replace(YL569, axes=axes, workpiece_zero=None)
    rows = straight_rows(speed)
    positions = positions_of(machine, rows)
    assert planned_seconds(machine, rows, positions, np.zeros(3)) == pytest.approx(seconds, rel=1e-9)


@pytest.mark.parametrize("seed", [3, 8])
def test_the_place_for_time_is_the_fastest_by_the_planner_of_those_it_judges(seed: int) -> None:
    axes = tuple(replace(axis, acceleration=40.0, jerk=None) for axis in YL569.axes)
    machine = replace(YL569, axes=axes)
    rows = tilted_rows(seed)
    path = TurnedPath.of(machine, Choice.AS_PLANNED, rows, np.zeros(3))
    _, best = best_turns([path], np.array([0.0, 120.0]), refine=False, goal=Goal.TIME)
    assert best.best is not None
    assert best.cost is not None
    seconds = planned_seconds(path.machine, *path.rows_at(best.turn), best.best.zero)
    assert seconds > best.cost  # accelerations cost something
    for turn in (0.0, 120.0):
        cuts = path.at(turn)
        assert isinstance(cuts, CutSet)
        widest = largest_margin(cuts, np.zeros(3)).zero
        assert seconds <= planned_seconds(path.machine, *path.rows_at(turn), widest) * (1.0 + 2e-4)
