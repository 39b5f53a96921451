"""The pole: no axis is too fast where a path allows it, the lean keeps its limit, and the tip stays."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.operations import moves_of, operation_of
from tests.support.pole_paths import MACHINES, around_pole, passes
from trunnion.arrays import Flags, Floats
from trunnion.machines import Machine, forward, inverse, kinematic_parameters, load_machine
from trunnion.model.motion import DecisionTopic, Plan, PoleStrategy
from trunnion.model.toolpath import Moves, Operation, Toolpath
from trunnion.planning import PlanOptions, plan
from trunnion.planning.pole.lean_limits import StepLimits, closest_second_angles, degrees_off_pole, least_lean
from trunnion.planning.pole.lean_task import LeanedMoves, LeanTask
from trunnion.planning.pole.tool_axis_lean import lean_tool_axis
from trunnion.planning.poses.placement import REWIND
from trunnion.planning.poses.selection import choose_poses
from trunnion.planning.speed.rotary_speed import REST_LENGTH, speed_shares


def leaned(machine: Machine, operation: Operation, mode: PoleStrategy, angle: float) -> LeanedMoves:
    moves = operation.moves
    poses = choose_poses(machine, moves, False)
    return lean_tool_axis(LeanTask.of(machine, operation, np.zeros(len(moves), bool), angle, False), poses, mode)


def axes_of(machine: Machine, rotary: Floats) -> Floats:
    joints = np.zeros((len(rotary), 5))
    joints[:, list(machine.rotary)] = rotary
    return forward(machine, joints)[1]


def degrees_between(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(a - b, axis=1), 1.0))))


@settings(max_examples=examples(50))
@given(st.data(), st.sampled_from(sorted(MACHINES)), st.sampled_from(list(PoleStrategy)[1:]), st.floats(0.005, 1.0))
def test_the_tool_axis_leans_within_its_limit_and_only_in_the_recorded_rows(
    data: st.DataObject, name: str, mode: PoleStrategy, angle: float
) -> None:
    machine = MACHINES[name]
    operation = data.draw(passes(machine))
    moves = operation.moves
    found = leaned(machine, operation, mode, angle)
    if (found.poses.outcome > 0).any():
        return  # out of reach, over limits or rewound: the planner's own tests
    off = degrees_between(axes_of(machine, found.poses.rotary), moves.axis)
    assert off.max() <= angle + 1e-8
    stays: Flags = np.ones(len(moves), bool)
    stays[found.rows] = False
    assert off[stays].max(initial=0.0) < 1.2e-5  # what the seven digits of a vector in the pole leave open
    np.testing.assert_allclose(found.lean, off[found.rows], atol=1e-8)
    np.testing.assert_array_equal(found.moves.tip, moves.tip)
    np.testing.assert_array_equal(found.moves.axis[stays], moves.axis[stays])
    assert degrees_between(found.moves.axis, axes_of(machine, found.poses.rotary)).max() < 1.2e-5
    low, high = machine.limits[list(machine.rotary)].T
    assert (found.poses.rotary >= low - 1e-5).all()
    assert (found.poses.rotary <= high + 1e-5).all()


@settings(max_examples=examples(50))
@given(st.data(), st.sampled_from(sorted(MACHINES)), st.floats(0.005, 1.0))
def test_in_solved_regions_no_rotary_axis_is_too_fast(data: st.DataObject, name: str, angle: float) -> None:
    machine = MACHINES[name]
    operation = data.draw(passes(machine))
    found = leaned(machine, operation, PoleStrategy.LEAN, angle)
    if (found.poses.outcome > 0).any():
        return
    share = speed_shares(machine, operation, found.poses.rotary).max(axis=1)
    lacking: Flags = np.zeros(len(share), bool)
    for place in found.regions:
        if not place.is_solved:
            lacking[place.first : place.end] = True
    # Where the tip rests a turn takes the time that it needs: no feed binds it.
    way = np.linalg.norm(np.diff(operation.moves.tip, axis=0, prepend=operation.moves.tip[:1]), axis=1)
    assert share[~lacking & (way >= REST_LENGTH)].max(initial=0.0) <= 1.0


@settings(max_examples=examples(40))
@given(st.data(), st.sampled_from(sorted(MACHINES)))
def test_nothing_is_done_where_nothing_is_too_fast(data: st.DataObject, name: str) -> None:
    machine = MACHINES[name]
    operation = data.draw(passes(machine))
    operation = replace(operation, moves=replace(operation.moves, feed=operation.moves.feed / 1e6))
    for mode in (PoleStrategy.HOLD, PoleStrategy.SPREAD, PoleStrategy.LEAN):
        found = leaned(machine, operation, mode, 0.5)
        plain = choose_poses(machine, operation.moves, False)
        if not (speed_shares(machine, operation, plain.rotary) > 0.98).any():
            assert not len(found.rows)
            np.testing.assert_array_equal(found.poses.rotary, plain.rotary)


# ---------------------------------------------------------------------------------------------------------------------
# The way with limited speed against a reference implementation

GRID = 3.0
FIRST = np.arange(-480.0, 480.0 + GRID, GRID)


@cache
def reached(name: str) -> Floats:
    """(k, s, 3): tool axes at the first angles of the grid, and second ones near the pole."""
    grid = np.stack(np.meshgrid(FIRST, np.arange(-10.0, 10.0, 0.02), indexing="ij"), axis=-1)
    return axes_of(MACHINES[name], grid.reshape(-1, 2)).reshape(*grid.shape[:2], 3)


def off_at_best(name: str, axis: Floats) -> Floats:
    """(n, k): the least lean from n tool axes over all second angles, at k first ones, by trying them."""
    cosine = np.stack([(reached(name) @ one).max(axis=1) for one in axis])
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def twin_finds(off: Floats, wanted: Floats, far: Floats, angle: float) -> bool:
    """Whether a path over the grid of first angles keeps within ``angle`` and ``far``, in the right branch."""
    nearest = [int(np.argmin(np.abs(FIRST - value))) for value in wanted]
    alive: Flags = np.zeros(len(FIRST), bool)
    alive[nearest[0]] = True
    for row in range(1, len(off)):
        allowed = off[row] <= angle
        allowed[nearest[row]] |= row == len(off) - 1
        low = high = nearest[row]
        while low > 0 and allowed[low - 1]:
            low -= 1
        while high < len(FIRST) - 1 and allowed[high + 1]:
            high += 1
        near = np.zeros(len(FIRST), bool)
        near[low : high + 1] = True
        there = np.array([(alive & (np.abs(FIRST - first) <= far[row])).any() for first in FIRST])
        alive = there & near & allowed
    return bool(alive[nearest[-1]])


@settings(max_examples=examples(30))
@given(
    st.sampled_from(["generic_head_table_bc", "generic_head_head_ca", "generic_nutated_b45_c", "yl569"]),
    st.floats(0.02, 1.0),
    st.floats(2.0, 90.0),
    st.floats(0.02, 1.0),
    st.integers(4, 9),
    st.floats(0.0, 6.0),
)
def test_a_path_that_a_search_finds_is_found(
    name: str, past: float, gets: float, angle: float, n: int, turn: float
) -> None:
    machine = MACHINES[name]
    along = np.linspace(-2.0, 2.0, n)
    x, y = along * math.cos(turn) - past * math.sin(turn), along * math.sin(turn) + past * math.cos(turn)
    axis = around_pole(machine, x, y)
    wanted = np.unwrap(inverse(machine, np.zeros((n, 3)), axis).joints[0, :, machine.rotary[0]], period=360.0)
    far = np.full(n, gets)
    steady = np.zeros(n, bool)
    steady[[0, -1]] = True
    kinematics, free = kinematic_parameters(machine), (-math.inf, math.inf)
    made, lean = least_lean(kinematics, axis, StepLimits(wanted, far, steady, *free), angle)
    off = off_at_best(name, axis)
    if made is None:
        # A little less room than there is, for what a grid cannot hit.
        assert not twin_finds(off, wanted, far - GRID, 0.999 * angle)
        return
    assert (np.abs(np.diff(made)) <= far[1:] + 1e-9).all()
    assert made[0] == pytest.approx(wanted[0], abs=1e-9)
    assert made[-1] == pytest.approx(wanted[-1], abs=1e-9)
    second = closest_second_angles(replace_limits(machine), kinematics, axis, made, np.zeros(n))
    assert degrees_between(axes_of(machine, np.column_stack((made, second))), axis).max() <= lean + 1e-8
    assert lean <= angle
    assert not twin_finds(off, wanted, far - GRID, 0.9 * lean - 1e-3), "there is a path with less lean"


def replace_limits(machine: Machine) -> Machine:
    """The machine without limits of its rotary axes."""
    free = {"low": -math.inf, "high": math.inf}
    return replace(machine, axes=tuple(replace(a, **free) if a.is_rotary else a for a in machine.axes))  # type: ignore[arg-type]


# ---------------------------------------------------------------------------------------------------------------------
# The strategies, by example

BC = MACHINES["generic_head_table_bc"]


def straight_past(off: float, feed: float = 3000.0, n: int = 401) -> Operation:
    along = np.linspace(-4.0, 4.0, n)
    tip = np.column_stack((2.5 * along, np.zeros(n), np.zeros(n)))
    moves = moves_of(tip, around_pole(BC, along, np.full(n, off)))
    return operation_of(replace(moves, feed=np.full(n, feed)))


def planned(operation: Operation, **options: object) -> Plan:
    return plan([Toolpath("part.cls", (operation,))], BC, 0.001, PlanOptions(**options))  # type: ignore[arg-type]


def test_hold_turns_after_the_cone() -> None:
    operation = straight_past(0.05)
    found = leaned(BC, operation, PoleStrategy.HOLD, 0.1)
    inside = np.flatnonzero(degrees_off_pole(kinematic_parameters(BC), operation.moves.axis) <= 0.1)
    np.testing.assert_allclose(np.diff(found.poses.rotary[inside[0] - 1 : inside[-1] + 1, 0]), 0.0, atol=1e-9)
    assert set(found.rows) <= set(inside.tolist())


def test_spread_turns_evenly_over_the_cone() -> None:
    operation = straight_past(0.05)
    found = leaned(BC, operation, PoleStrategy.SPREAD, 0.1)
    inside = np.flatnonzero(degrees_off_pole(kinematic_parameters(BC), operation.moves.axis) <= 0.1)
    steps = np.diff(np.unwrap(found.poses.rotary[inside[0] - 1 : inside[-1] + 2, 0], period=360.0))
    np.testing.assert_allclose(steps, steps[0], atol=1e-9)


def test_the_turn_out_of_the_pole_is_spread_over_the_approach_without_any_lean() -> None:
    n = 60
    axis = around_pole(BC, np.zeros(n), np.zeros(n))
    axis[40:] = around_pole(BC, np.full(20, 3.0), np.full(20, 3.0))
    axis[:5] = around_pole(BC, np.full(5, -3.0), np.full(5, 0.0))
    tip = np.column_stack((np.arange(n) * 0.5, np.zeros(n), np.zeros(n)))
    operation = operation_of(replace(moves_of(tip, axis), feed=np.full(n, 5000.0)))
    plain = leaned(BC, operation, PoleStrategy.SPREAD, 0.01)
    assert plain.lean.max(initial=0.0) < 1e-9
    steps = np.abs(np.diff(np.unwrap(plain.poses.rotary[:, 0], period=360.0)))
    assert steps[4:40].max() < 4.0
    assert speed_shares(BC, operation, plain.poses.rotary)[:, 0].max() < 1.5


def test_by_default_nothing_changes_and_the_log_names_place_axis_and_cure() -> None:
    operation = straight_past(0.05)
    found = planned(operation, explain=True)
    assert found.motions[0].deviations.is_empty
    np.testing.assert_array_equal(found.motions[0].operation.moves.axis, operation.moves.axis)
    said = [decision for decision in found.decisions if decision.topic is DecisionTopic.SPEED]
    assert len(said) == 1
    assert "axis C would need" in said[0].text
    assert "setting pole=lean setting pole_angle=0.08 would do" in said[0].text
    assert 10 + 190 < said[0].line < 10 + 210


def test_an_unsolved_region_is_a_warning_with_a_sufficient_angle() -> None:
    found = planned(straight_past(0.2), pole_strategy=PoleStrategy.LEAN, pole_angle=0.1)
    assert [str(p.severity) for p in found.problems] == ["warning"]
    assert "no lean of the tool axis by up to 0.1 degrees" in found.problems[0].what
    assert found.problems[0].cure == "setting pole=lean setting pole_angle=0.2 would do, or setting lower_feed=yes"
    enough = planned(straight_past(0.2), pole_strategy=PoleStrategy.LEAN, pole_angle=0.2)
    assert enough.problems == ()
    assert [d.topic for d in enough.decisions if d.topic in (DecisionTopic.SPEED, DecisionTopic.POLE)][
        -1
    ] is DecisionTopic.POLE


def test_a_machine_without_rapid_speeds_is_named() -> None:
    machine = load_machine("hs664rt")
    found = plan(
        [Toolpath("part.cls", (straight_past(0.05),))], machine, 0.001, PlanOptions(pole_strategy=PoleStrategy.LEAN)
    )
    assert "has no rapid speed of C and A" in found.problems[0].what


def feeds(found: Plan) -> Floats:
    return found.motions[0].operation.moves.feed


def test_a_feed_is_lowered_no_farther_than_the_axes_need() -> None:
    operation = straight_past(0.05)
    found = planned(operation, lower_feed=True)
    motion = found.motions[0]
    share = speed_shares(BC, motion.operation, motion.rotary).max(axis=1)
    low = feeds(found) < operation.moves.feed
    assert low.any()
    assert share.max() < 1.0
    assert share[low].min() > 0.98
    np.testing.assert_array_equal(motion.deviations.slowed_rows, np.flatnonzero(low))
    np.testing.assert_array_equal(motion.deviations.slowed_feed, feeds(found)[low])
    assert [d.topic for d in found.decisions if d.topic in (DecisionTopic.SPEED, DecisionTopic.FEED)] == [
        DecisionTopic.FEED
    ]


def test_feeds_are_lowered_less_if_the_tool_axis_leans() -> None:
    operation = straight_past(0.2)
    lowered = feeds(planned(operation, lower_feed=True)).min()
    assert feeds(planned(operation, lower_feed=True, pole_strategy=PoleStrategy.LEAN, pole_angle=0.1)).min() == lowered
    assert feeds(planned(operation, lower_feed=True, pole_strategy=PoleStrategy.LEAN, pole_angle=0.2)).min() == 3000.0


def test_leaning_keeps_rows_and_lines() -> None:
    operation = straight_past(0.05)
    moves: Moves = planned(operation, pole_strategy=PoleStrategy.LEAN).motions[0].operation.moves
    np.testing.assert_array_equal(moves.line, operation.moves.line)
    np.testing.assert_array_equal(moves.tip, operation.moves.tip)
    assert REWIND not in leaned(BC, operation, PoleStrategy.LEAN, 0.1).poses.outcome
