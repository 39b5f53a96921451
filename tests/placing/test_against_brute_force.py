"""Regions and best places against the inverse map of every row, at many places and turns."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize  # type: ignore[import-untyped]

from tests.support.examples import examples
from tests.support.placed_paths import best_turns, brute_margin, limited_machines, random_rows
from trunnion.arrays import Floats
from trunnion.machines import Machine, inverse, load_machine
from trunnion.placing.best_turn import best_of_turn
from trunnion.placing.largest_margin import largest_margin
from trunnion.placing.path_rows import PathRows
from trunnion.placing.region import TOLERANCE, region_of
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import Choice, TurnedPath, choices_of

#: Machines have too many numbers to be made simpler in any time.
PHASES = [Phase.explicit, Phase.generate]

SEEDS = st.integers(0, 10**6)
TURNS = st.sampled_from([0.0, 90.0, 37.0, 200.5, -45.0])


def well_conditioned(cuts: CutSet | Obstacle) -> bool:
    """Whether slides are far from parallel in all rows: else rounding is multiplied, in the inverse map as well."""
    return isinstance(cuts, Obstacle) or all(np.abs(part.forms.normals).max() < 20.0 for part in cuts.parts)


@settings(max_examples=examples(40), deadline=None, phases=PHASES)
@given(machine=limited_machines(), seed=SEEDS, turn=TURNS, count=st.sampled_from([1, 2, 9, 150]))
def test_the_margin_of_any_place_is_that_of_its_worst_row(machine: Machine, seed: int, turn: float, count: int) -> None:
    rows = random_rows(seed, count)
    cuts = TurnedPath.of(machine, Choice.AS_PLANNED, rows, np.zeros(3)).at(turn)
    assume(well_conditioned(cuts))
    random = np.random.default_rng(seed)
    places = random.uniform(-700.0, 700.0, (12, 3))
    for zero in places:
        brute = brute_margin(machine, rows, turn, zero)
        if isinstance(cuts, Obstacle):
            assert brute == -np.inf
        elif brute == np.inf:
            assert not np.isfinite(cuts.at(zero).margins).any()
        else:
            assert cuts.at(zero).margins.min() == pytest.approx(brute, abs=1e-6)


@settings(max_examples=examples(25), deadline=None, phases=PHASES)
@given(machine=limited_machines(), seed=SEEDS, turn=TURNS)
def test_no_place_is_in_the_region_that_does_not_fit_and_none_outside_that_does(
    machine: Machine, seed: int, turn: float
) -> None:
    rows = random_rows(seed, 20)
    cuts = TurnedPath.of(machine, Choice.AS_PLANNED, rows, np.zeros(3)).at(turn)
    assume(not isinstance(cuts, Obstacle) and well_conditioned(cuts))
    assert not isinstance(cuts, Obstacle)
    assume(np.isfinite(cuts.limits).any())
    best = largest_margin(cuts, np.zeros(3))
    region = region_of(cuts, best)
    if region is None:
        places = np.random.default_rng(seed).uniform(-2000.0, 2000.0, (200, 3))
        assert max(brute_margin(machine, rows, turn, zero) for zero in places) < 1e-6
        return
    normals = np.array([cut.normal for cut in cuts.cuts])
    bounds = np.array([cut.bound for cut in cuts.cuts])
    low, high = (np.clip(end, best.zero - 3000.0, best.zero + 3000.0) for end in (region.low, region.high))
    places = np.random.default_rng(seed).uniform(low - 20.0, high + 20.0, (60, 3))
    for zero in places:
        brute = brute_margin(machine, rows, turn, zero)
        inside = (normals @ zero <= bounds).all()
        if brute >= 0.0:
            assert inside
        if inside:
            assert brute >= -TOLERANCE - 1e-6
        assert (region.margin(zero) >= 0.0) == (brute >= 0.0) or abs(brute) < 1e-6
    for corner in region.corners:
        if np.abs(corner).max() < 9e4:
            assert abs(brute_margin(machine, rows, turn, corner)) < TOLERANCE + 1e-6


def walk_uphill(machine: Machine, rows: PathRows, turn: float, at: Floats, seed: int) -> float:
    """The largest margin that a simplex finds by brute force, beginning anew in other directions where it rests."""
    random, best = np.random.default_rng(seed), brute_margin(machine, rows, turn, at)
    if best == -np.inf:
        return best
    for size in (80.0, 40.0, 40.0, 20.0, 10.0, 5.0):
        directions = np.linalg.qr(random.normal(size=(3, 3)))[0]
        walk = minimize(
            lambda zero: -brute_margin(machine, rows, turn, zero),
            at,
            method="Nelder-Mead",
            options={"initial_simplex": at + size * np.concatenate((np.zeros((1, 3)), directions)), "maxfev": 250},
        )
        if -walk.fun > best:
            best, at = -walk.fun, walk.x
    return best


@settings(max_examples=examples(5), deadline=None, phases=PHASES)
@given(machine=limited_machines(), seed=SEEDS, turn=TURNS)
def test_no_place_of_a_dense_search_is_better_than_the_best(machine: Machine, seed: int, turn: float) -> None:
    rows = random_rows(seed, 30)
    paths = [TurnedPath.of(machine, choice, each, np.zeros(3)) for choice, each in choices_of(rows)]
    found = best_of_turn(paths, turn)
    assume(found.best is not None and found.cuts is not None and np.isfinite(found.cuts.limits).any())
    assume(all(well_conditioned(path.at(turn)) for path in paths))
    assert found.best is not None
    assume(found.best.margin < 1999.0)  # limits on both sides hold it
    chosen = found.path.rows if found.path else rows
    assert brute_margin(machine, chosen, turn, found.best.zero) == pytest.approx(found.best.margin, abs=1e-6)
    away = found.best.zero + np.random.default_rng(seed).uniform(-80.0, 80.0, 3)
    best = max(walk_uphill(machine, each, turn, away, seed) for _, each in choices_of(rows))
    assert best <= found.best.margin + 1e-6
    assert best >= found.best.margin - 0.01 * abs(found.best.margin) - 0.01


@settings(max_examples=examples(5), deadline=None, phases=PHASES)
@given(machine=limited_machines(), seed=SEEDS)
def test_the_best_turn_is_the_best_of_all_turns(machine: Machine, seed: int) -> None:
    rows = random_rows(seed, 10)
    paths = [TurnedPath.of(machine, choice, each, np.zeros(3)) for choice, each in choices_of(rows)]
    grid = np.arange(0.0, 360.0, 60.0)
    assume(all(well_conditioned(path.at(turn)) for path in paths for turn in grid.tolist()))
    results, best = best_turns(paths, grid, refine=True)
    most = max(result.margin for result in results)
    assert best.margin >= most - 0.01 * max(most, 0.0) - 1e-6  # that much is given up for the rotary axes
    for result in results[:4]:
        alone = best_of_turn(paths, result.turn)
        assert alone.margin == pytest.approx(result.margin, abs=1e-6)


def test_a_head_that_turns_with_the_part_is_as_if_each_turn_were_a_path_of_its_own() -> None:
    """C and A in the head: the shortcut of ``Turning.HEAD`` against brute force."""
    machine = replace(load_machine("generic_head_head_ca"), tool_length=180.0)
    rows = random_rows(3, 400)
    rows = replace(rows, axis=np.abs(rows.axis), branch=np.zeros(400, np.uint8))
    path = TurnedPath.of(machine, Choice.AS_PLANNED, rows, np.zeros(3))
    for turn in (0.0, 10.0, 123.4, 270.0):
        cuts = path.at(turn)
        assert not isinstance(cuts, Obstacle)
        for zero in np.array([[0.0, 0.0, 0.0], [300.0, -200.0, 150.0], [-900.0, 40.0, -77.0]]):
            assert cuts.at(zero).margins.min() == pytest.approx(brute_margin(machine, rows, turn, zero), abs=1e-6)


def test_a_table_that_turns_with_the_part_is_as_if_each_turn_were_a_path_of_its_own() -> None:
    """C beside the part: the shortcut of ``Turning.TABLE``, with a table centre away from the origin."""
    machine = load_machine("yl569")
    axes = tuple(replace(axis, point=(3.0, -7.0, 11.0)) if axis.is_rotary else axis for axis in machine.axes)
    machine = replace(machine, axes=axes, tool_length=120.0)
    rows = random_rows(4, 400)
    rows = replace(rows, axis=np.abs(rows.axis) + np.array([0.01, 0.0, 0.0]), branch=np.zeros(400, np.uint8))
    found = inverse(machine, rows.tip, rows.axis)
    assert found.joints[0, :, 1].min() > 0.0
    path = TurnedPath.of(machine, Choice.AS_PLANNED, rows, np.zeros(3))
    for turn in (0.0, 10.0, 123.4, 270.0):
        cuts = path.at(turn)
        assert not isinstance(cuts, Obstacle)
        for zero in np.array([[0.0, 0.0, 0.0], [30.0, -20.0, 50.0], [-90.0, 40.0, -77.0]]):
            assert cuts.at(zero).margins.min() == pytest.approx(brute_margin(machine, rows, turn, zero), abs=1e-6)
