"""The optimum is the optimum, and equals the nearest neighbour where that is good enough."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.machines import five_axis_machines
from tests.support.naive.poses import AllPaths, nearest_neighbour
from tests.support.operations import moves_of, rapids_at
from tests.support.path_strategies import BC, CA, directions, short_paths, smooth_paths, winding, with_limits
from trunnion.machines import Machine, forward, load_machine, slide_positions
from trunnion.model.toolpath import Moves
from trunnion.planning.poses import selection as poses
from trunnion.planning.poses.placement import REWIND
from trunnion.planning.poses.selection import (
    PlannedPoses,
    branches_travel_alike,
    cheapest_states,
    choose_nearest_states,
    choose_poses,
    choose_poses_in_one_pass,
    choose_states,
    poses_of_states,
)
from trunnion.planning.poses.states import MOST_TURNS, REWIND_STEP, STATE_BITS, states_of


def posed(machine: Machine, moves: Moves) -> PlannedPoses:
    return choose_poses(machine, moves, False)


def rewinds(poses: PlannedPoses) -> int:
    return int((poses.outcome == REWIND).sum())


SMALL = {
    "endless C, B with both signs": with_limits(BC, B=(-110, 110)),
    "endless C, B little below zero": with_limits(BC, B=(-15, 110)),
    "C limited to a turn and a half": with_limits(BC, B=(-5, 110), C=(-270, 270)),
    "fork head": CA,
    "nutated head": load_machine("generic_nutated_b45_c"),
    "nutated, C limited": with_limits(load_machine("generic_nutated_b45_c"), C=(-200, 200)),
}


@settings(deadline=None, max_examples=examples(50))
@given(st.sampled_from(sorted(SMALL)), short_paths(), st.sampled_from([-1, 0, 1]))
def test_no_path_through_the_states_is_cheaper(name: str, moves: Moves, prefer: int) -> None:
    machine = SMALL[name]
    states = states_of(machine).table
    assume(len(states) ** len(moves) < 300_000)
    every = AllPaths(machine, moves, prefer)
    assert [tuple(row) for row in states.tolist()] == every.states
    state = cheapest_states(machine, moves, False, prefer)
    fewest, least = every.least()
    found = every.cost_of([int(s) & STATE_BITS for s in state])
    assert found[0] == fewest
    assert found[1] == pytest.approx(least, abs=1e-6)
    assert int((state & REWIND_STEP != 0).sum()) == fewest % (1 << 20)


def test_eight_rows_of_six_states() -> None:
    machine = CA
    azimuth = np.array([0.0, 70.0, 140.0, 210.0, 280.0, 350.0, 420.0, 490.0])
    moves = moves_of(np.zeros((8, 3)), directions(np.full(8, 30.0), azimuth))
    assert len(states_of(machine)) == 6
    every = AllPaths(machine, moves)
    state = [int(s) & STATE_BITS for s in choose_states(machine, moves, False)]
    assert every.cost_of(state) == pytest.approx(every.least(), abs=1e-6)


@settings(deadline=None, max_examples=examples(40))
@given(smooth_paths(100.0))
def test_on_the_yl569_the_optimum_is_the_nearest_neighbour_where_that_is_good_enough(moves: Moves) -> None:
    machine = load_machine("yl569")
    naive = nearest_neighbour(machine, moves)
    assume(not naive.rows_beyond_limits and not naive.changes and len(set(naive.branch)) == 1)
    wound = naive.rotary[:, 0] - 360.0 * np.floor(naive.rotary[:, 0] / 360.0)
    assert np.array_equal(posed(machine, moves).rotary, np.column_stack((wound, naive.rotary[:, 1])))


ALIKE = {name: machine for name in five_axis_machines() if branches_travel_alike(machine := load_machine(name))} | {
    name: SMALL[name] for name in SMALL if branches_travel_alike(SMALL[name])
}


def test_most_shipped_machines_have_branches_that_travel_alike() -> None:
    assert {"yl569", "ucp800", "dmu65", "hs664rt", "mikron_600u", "fork head"} <= set(ALIKE)
    assert not any("nutated" in name for name in ALIKE)


@settings(deadline=None, max_examples=examples(120))
@given(st.sampled_from(sorted(ALIKE)), smooth_paths(100.0) | smooth_paths(4.0) | short_paths(30), st.booleans())
def test_without_a_choice_one_pass_finds_the_optimum(name: str, moves: Moves, keep_slide_limits: bool) -> None:
    machine = ALIKE[name]
    found = choose_poses_in_one_pass(machine, moves, keep_slide_limits)
    assume(found is not None)
    assert found is not None
    wanted = poses_of_states(machine, moves, choose_states(machine, moves, keep_slide_limits), keep_slide_limits)
    assert np.array_equal(found.state, wanted.state)
    assert np.array_equal(found.rotary, wanted.rotary)
    assert np.array_equal(found.extremes, wanted.extremes)
    assert np.array_equal(found.extreme_rows, wanted.extreme_rows)
    assert np.array_equal(found.changes, wanted.changes)
    assert not wanted.outcome.any()


@settings(deadline=None, max_examples=examples(70))
@given(st.sampled_from(sorted(ALIKE)), smooth_paths(4.0) | short_paths(30), st.integers(1, 12))
def test_one_pass_does_not_depend_on_the_size_of_chunks(name: str, moves: Moves, rows: int) -> None:
    whole = choose_poses_in_one_pass(ALIKE[name], moves, False)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(poses, "_CHUNK", rows)
        found = choose_poses_in_one_pass(ALIKE[name], moves, False)
    assert (found is None) == (whole is None)
    if found is not None and whole is not None:
        for column in ("state", "rotary", "outcome", "extremes", "extreme_rows", "changes"):
            assert np.array_equal(getattr(found, column), getattr(whole, column))


@pytest.mark.parametrize("name", sorted(n for n, m in ALIKE.items() if not any(a.preferred_sign for a in m.axes)))
def test_one_pass_is_enough_for_a_usual_path(name: str) -> None:
    machine = ALIKE[name]
    rows = np.linspace(0.0, 1.0, 300)
    moves = moves_of(np.zeros((300, 3)), directions(20.0 + 10.0 * np.sin(9.0 * rows), 20.0 + 40.0 * rows))
    upright = moves_of(np.zeros((9, 3)), directions(np.zeros(9), np.zeros(9)))
    for path in (moves, upright):
        assert choose_poses_in_one_pass(machine, path, False) is not None


#: The nearest neighbour does not look at preferred sides.
IMPARTIAL = [name for name in five_axis_machines() if not any(axis.preferred_sign for axis in load_machine(name).axes)]


@settings(deadline=None, max_examples=examples(40))
@given(st.sampled_from(IMPARTIAL), smooth_paths(30.0))
def test_on_every_machine_it_is_the_nearest_neighbour_or_cheaper(name: str, moves: Moves) -> None:
    machine = load_machine(name)
    naive = nearest_neighbour(machine, moves)
    assume(not naive.rows_beyond_limits and not naive.changes)
    every = AllPaths(machine, moves)
    state = [int(s) & STATE_BITS for s in cheapest_states(machine, moves, False)]
    turns = np.rint((naive.rotary - every.angles[naive.branch, range(len(moves))]) / 360.0)
    turns[:, every.endless] = 0
    its = [every.states.index((b, int(one), int(two))) for b, (one, two) in zip(naive.branch, turns, strict=True)]
    assert state == its or every.cost_of(state)[0] <= every.cost_of(its)[0]
    if state != its:
        assert every.cost_of(state) < (every.cost_of(its)[0], every.cost_of(its)[1] + 1e-6)


@settings(deadline=None, max_examples=examples(25))
@given(st.sampled_from(five_axis_machines()), smooth_paths(30.0))
def test_the_nearest_neighbour_of_the_planner_is_that_of_the_tests(name: str, moves: Moves) -> None:
    machine = load_machine(name)
    naive = nearest_neighbour(machine, moves)
    found = poses_of_states(machine, moves, choose_nearest_states(machine, moves, False), False).rotary
    apart = found - naive.rotary
    assert np.abs(apart - 360.0 * np.rint(apart / 360.0)).max() < 1e-9


@settings(deadline=None, max_examples=examples(30))
@given(st.sampled_from(five_axis_machines()), st.one_of(smooth_paths(35.0), short_paths(30)))
def test_limits_hold_and_the_tool_points_where_it_should(name: str, moves: Moves) -> None:
    machine = load_machine(name)
    poses = posed(machine, moves)
    low, high = machine.limits[list(machine.rotary)].T
    fine = (poses.outcome == 0) | (poses.outcome >= REWIND)
    assert ((poses.rotary >= low) & (poses.rotary <= high))[fine].all()
    tip, axis = forward(machine, slide_positions(machine, moves.tip, poses.rotary))
    assert np.abs(axis - moves.axis).max() < 1e-7
    assert np.abs(tip - moves.tip).max() < 1e-4
    naive = nearest_neighbour(machine, moves)
    if not naive.rows_beyond_limits:
        assert fine.all(), "where the nearest neighbour keeps the limits, the optimum does"


# Cases in which the nearest neighbour fails.


def test_a_pass_of_700_degrees_starts_on_the_turn_where_it_fits() -> None:
    moves = winding(40.0, 100.0, 800.0)
    assert nearest_neighbour(CA, moves).changes, "from 10 degrees it meets the limit of 360 half-way"
    poses = posed(CA, moves)
    assert not poses.outcome.any()
    c = poses.rotary[:, 0]
    assert np.ptp(c) == pytest.approx(700.0)
    assert c.min() >= -360.0
    assert c.max() <= 360.0


def test_a_pass_of_1000_degrees_rewinds_once() -> None:
    poses = posed(CA, winding(40.0, 100.0, 1100.0))
    assert rewinds(poses) == 1
    assert np.abs(np.diff(poses.rotary[:, 0])).max() == pytest.approx(360.0, abs=3.0)


def test_a_limit_crossed_on_one_side_is_seen_from_the_start() -> None:
    machine = load_machine("yl569")
    moves = moves_of(np.zeros((60, 3)), directions(np.linspace(5.0, 40.0, 60), np.full(60, 190.0)))
    assert nearest_neighbour(machine, moves).changes, "B -5 is nearer, but ends at -11"
    poses = posed(machine, moves)
    assert not poses.outcome.any()
    assert (poses.rotary[:, 1] > 0).all()
    assert poses.rotary[:, 0] == pytest.approx(190.0)


def test_a_path_through_the_pole_continues_in_the_branch_within_limits() -> None:
    tilt = np.linspace(-60.0, 60.0, 121)
    moves = moves_of(np.zeros((121, 3)), directions(tilt, np.full(121, 30.0)))
    wide = posed(with_limits(BC, B=(-110, 110)), moves)
    assert np.ptp(wide.rotary[:, 0]) < 1e-9, "C stands still"
    narrow = posed(with_limits(BC, B=(-11, 110)), moves)
    assert not narrow.outcome.any()
    turn = np.flatnonzero(np.abs(np.diff(narrow.rotary[:, 0])) > 1.0)
    assert len(turn) == 1
    assert abs(narrow.rotary[turn[0] + 1, 1]) <= 1.0, "C turns over at the pole, where that tilts nothing"


def test_equal_tool_axes_have_equal_poses_in_every_pass() -> None:
    machine = with_limits(BC, B=(-110, 110))
    azimuths = [0.0, 170.0, -20.0, 100.0, 260.0, 0.0, 170.0, -20.0, 100.0, 260.0]
    rows = [directions(np.full(20, 30.0), np.linspace(a, a + 30.0, 20)) for a in azimuths]
    moves = moves_of(np.zeros((200, 3)), np.concatenate(rows))
    moves = rapids_at(moves, list(range(0, 200, 20)))
    b = posed(machine, moves).rotary[:, 1]
    assert len(np.unique(np.sign(b))) == 1
    assert len(np.unique(np.sign(nearest_neighbour(machine, moves).rotary[:, 1]))) == 2


@pytest.mark.parametrize(("prefer", "sign"), [("positive", 1.0), ("negative", -1.0)])
def test_a_definition_says_which_side_the_machine_works_on(prefer: str, sign: float) -> None:
    machine = load_machine("generic_head_head_ca", {"axis": [{"name": "A", "prefer": prefer}]})
    poses = posed(machine, rapids_at(winding(40.0, 30.0, 60.0), [0]))
    assert (np.sign(poses.rotary[:, 1]) == sign).all()


def test_an_axis_with_very_many_turns_is_planned_around_its_home() -> None:
    machine = with_limits(BC, C=(-36000, 36000), B=(-110, 500))
    assert len(states_of(machine)) <= 2 * MOST_TURNS
    assert not posed(machine, winding(40.0, 0.0, 2000.0, 2000)).outcome.any()
