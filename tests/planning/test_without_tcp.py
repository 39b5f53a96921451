"""Programs without TCP, read back by the virtual control: tip and tool axis between points, and durations."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.operations import moves_of, operation_of
from tests.support.without_tcp import NAMES, apart, machine, post, rows_of_points, steps, toolpath, worst_off
from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, forward
from trunnion.model.motion import Plan
from trunnion.model.run import Run
from trunnion.model.subdivision import subdivide
from trunnion.model.toolpath import Arcs, Kind, Operation
from trunnion.planning import PlanOptions, plan
from trunnion.planning.linearization.arc_chords import great_circle_points


def minutes(run: Run, rows: Sequence[int]) -> float:
    """Duration of blocks at feed, by their F and what it counts, min."""
    total = 0.0
    for row in rows:
        way = float(np.linalg.norm(run.tip[row] - run.tip[row - 1]))
        total += 1.0 / run.feed[row] if run.feed_mode[row] == 93 else way / run.feed[row]
    return total


lean = st.one_of(st.floats(-0.6, 0.6), st.just(0.0), st.floats(-1e-3, 1e-3), st.floats(-1e-6, 1e-6))
kinds = st.sampled_from([Kind.LINEAR, Kind.LINEAR, Kind.RAPID])
rough = st.lists(st.tuples(steps, lean, lean, kinds), min_size=2, max_size=4)


@settings(deadline=None, max_examples=examples(25), phases=[Phase.generate])
@given(
    st.sampled_from(NAMES),
    rough,
    st.sampled_from([0.001, 0.01, 0.1]),
    st.sampled_from([0.01, 0.05, 0.5]),
)
def test_the_tool_stays_on_its_path_between_points(
    name: str,
    path: list[tuple[tuple[float, float, float], float, float, Kind]],
    tip_tolerance: float,
    axis_tolerance: float,
) -> None:
    tip = np.round(np.cumsum([step for step, _, _, _ in path], axis=0), 5)
    assume(np.linalg.norm(np.diff(tip, axis=0), axis=1).min() > 0.1)
    axis = np.array([[i, j, 1.0] for _, i, j, _ in path])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    assume(np.abs(axis - [0.0, 0.0, 1.0]).max() > 1e-6)
    kind = np.array([Kind.RAPID, *(k for _, _, _, k in path[1:])], np.uint8)
    moves = replace(moves_of(tip, axis), kind=kind)
    done = post(
        machine(name),
        toolpath(operation_of(moves)),
        PlanOptions(tcp=False, tip_tolerance=tip_tolerance, axis_tolerance=axis_tolerance),
    )
    refused = [problem.what for problem in done.plan.problems if problem.severity is Severity.ERROR]
    event(f"refused: {bool(refused)}")
    if refused:
        return
    failed = [str(check) for check in done.found.checks if not check.passed]
    assert failed == []
    worst_tip, worst_axis = worst_off(done.run, tip, axis, kind.tolist())
    assert worst_tip <= tip_tolerance + 3e-5
    assert worst_axis <= axis_tolerance + 2e-5
    rows = rows_of_points(done.run, tip, axis)
    for k in np.flatnonzero(kind != Kind.RAPID).tolist():
        blocks = list(range(rows[k - 1] + 1, rows[k] + 1))
        way = float(np.linalg.norm(tip[k] - tip[k - 1]))
        at_rest = np.linalg.norm(np.diff(done.run.tip[rows[k - 1] : rows[k] + 1], axis=0), axis=1) < 2e-4
        if not at_rest.any():
            assert minutes(done.run, blocks) == pytest.approx(way / 100.0, rel=2e-3)


def smooth(form: str, turns: float, tilt: float, n: int) -> tuple[Floats, Floats]:
    """A path and its tool axes: around a part, over the pole and back, or a spiral close by the pole."""
    part = np.linspace(0.0, 1.0, n)
    azimuth = np.radians(20.0 + 360.0 * turns * part)
    lean = np.full(n, math.radians(tilt))
    if form == "over the pole":
        lean, azimuth = np.radians(tilt * (1.0 - 2.0 * part)), np.full(n, 0.4)
    if form == "spiral":
        lean = np.radians(tilt * part)
    axis = np.column_stack((np.sin(lean) * np.cos(azimuth), np.sin(lean) * np.sin(azimuth), np.cos(lean)))
    tip = 25.0 * axis + np.column_stack((60.0 * part, np.zeros((n, 2))))
    return np.round(tip, 5), axis


@settings(deadline=None, max_examples=examples(12), phases=[Phase.generate])
@given(
    st.sampled_from(NAMES),
    st.sampled_from(["round", "over the pole", "spiral"]),
    st.floats(-2.4, 2.4),
    st.floats(1.0, 25.0),
    st.integers(5, 30),
    st.sampled_from([0.001, 0.01, 0.1]),
)
def test_smooth_paths_also_past_the_pole_and_over_several_turns(
    name: str, form: str, turns: float, tilt: float, n: int, tip_tolerance: float
) -> None:
    tip, axis = smooth(form, turns, tilt, n)
    done = post(
        machine(name), toolpath(operation_of(moves_of(tip, axis))), PlanOptions(tcp=False, tip_tolerance=tip_tolerance)
    )
    if any(problem.severity is Severity.ERROR for problem in done.plan.problems):
        event("refused")
        return
    assert [str(check) for check in done.found.checks if not check.passed] == []
    if any(problem.code == "PLN220" for problem in done.plan.problems):
        event("draws back")  # the way out and back, to rewind an axis, is no part of the path: the check judges it
        return
    worst_tip, worst_axis = worst_off(done.run, tip, axis, [Kind.LINEAR] * n)
    assert worst_tip <= tip_tolerance + 3e-5
    assert worst_axis <= 0.05 + 2e-5


# With TCP


@settings(deadline=None, max_examples=examples(12), phases=[Phase.generate])
@given(st.sampled_from(NAMES), rough, st.sampled_from([0.01, 0.1, 1.0]))
def test_with_tcp_points_keep_the_tool_axis_if_there_is_a_tolerance(
    name: str, path: list[tuple[tuple[float, float, float], float, float, Kind]], tolerance: float
) -> None:
    tip = np.round(np.cumsum([step for step, _, _, _ in path], axis=0), 5)
    assume(np.linalg.norm(np.diff(tip, axis=0), axis=1).min() > 0.1)
    axis = np.array([[i, j, 1.0] for _, i, j, _ in path])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    assume(np.abs(axis - [0.0, 0.0, 1.0]).max() > 1e-6)
    kind = np.array([Kind.RAPID, *(k for _, _, _, k in path[1:])], np.uint8)
    asked = toolpath(operation_of(replace(moves_of(tip, axis), kind=kind)))
    done = post(machine(name), asked, PlanOptions(axis_tolerance=tolerance))
    if any(problem.severity is Severity.ERROR for problem in done.plan.problems):
        event("refused")
        return
    assert [check.key for check in done.found.checks if not check.passed] == []
    assert worst_off(done.run, tip, axis, kind.tolist())[1] <= tolerance + 2e-5
    left_alone = plan([asked], machine(name), 0.001)
    added = len(done.plan.motions[0].operation.moves) - len(left_alone.motions[0].operation.moves)
    if done.found.passed and worst_of(left_alone, machine(name), tip, axis, kind) < 0.9 * tolerance:
        assert added == 0, "nothing is put in where nothing bends"


def worst_of(planned: Plan, model: Machine, tip: Floats, axis: Floats, kind: Codes) -> float:
    """How far the tool axis bends between the points of cuts without inserted points, degrees."""
    rotary = planned.motions[0].rotary
    worst = 0.0
    for k in np.flatnonzero(kind[1:] != Kind.RAPID).tolist():
        step = rotary[k + 1] - rotary[k]
        for r, column in enumerate(model.rotary):
            if model.axes[column].endless:
                step[r] -= 360.0 * round(step[r] / 360.0)
        joints = np.zeros((51, 5))
        joints[:, list(model.rotary)] = rotary[k] + np.linspace(0.0, 1.0, 51)[:, None] * step
        look = forward(model, joints)[1]
        part = np.linspace(0.0, 1.0, 51)
        worst = max(worst, float(apart(look, great_circle_points(axis[k], axis[k + 1], part)).max()))
    return worst


# Numbers worked out by hand


def test_slides_of_a_tilting_head_follow_pivot_and_tool_length() -> None:
    """X = x + R sin B and Z = z + R (cos B - 1), R from the pivot to the tip; the table's C turns the point."""
    model = replace(machine("generic_head_table_bc"), workpiece_zero=(0.0, 0.0, 50.0), tool_length=120.0)
    tip, b = np.array([[10.0, 4.0, 2.0], [12.0, 4.0, 1.0]]), np.array([30.0, 40.0])
    axis = np.column_stack((np.sin(np.radians(b)), np.zeros(2), np.cos(np.radians(b))))
    done = post(model, toolpath(operation_of(moves_of(tip, axis))), PlanOptions(tcp=False))
    rows = rows_of_points(done.run, tip, axis)
    places = [done.run.joints[row] for row in rows]
    arm = 180.0 + 120.0
    for point, joints, angle in zip(tip, places, np.radians(b), strict=True):
        x, y, z = (joints[model.column(name)] for name in "XYZ")
        assert x == pytest.approx(point[0] + arm * math.sin(angle), abs=2e-5)
        assert y == pytest.approx(point[1], abs=2e-5)
        assert z == pytest.approx(50.0 + 120.0 + point[2] + arm * (math.cos(angle) - 1.0), abs=2e-5)
    blocks = [line for line in done.text.splitlines() if " B40." in line]
    words = {word[0]: float(word[1:]) for word in blocks[-1].split(" ")[1:] if word[0] in "XYZB"}
    assert words["X"] == pytest.approx(12.0 + arm * math.sin(math.radians(40.0)), abs=2e-5)
    assert words["Z"] == pytest.approx(1.0 + arm * (math.cos(math.radians(40.0)) - 1.0), abs=2e-5)


def test_slides_of_a_tilting_table_turn_with_the_part() -> None:
    """YL569 with B alone: the part turns by -B about Y through the machine's zero."""
    model = replace(machine("yl569"), workpiece_zero=(5.0, 0.0, 80.0))
    tip, b = np.array([[10.0, 4.0, 2.0], [12.0, 4.0, 1.0]]), np.array([30.0, 35.0])
    axis = np.column_stack((np.sin(np.radians(b)), np.zeros(2), np.cos(np.radians(b))))
    done = post(model, toolpath(operation_of(moves_of(tip, axis))), PlanOptions(tcp=False))
    for point, row, angle in zip(tip, rows_of_points(done.run, tip, axis), np.radians(b), strict=True):
        x, z = point[0] + 5.0, point[2] + 80.0
        place = done.run.joints[row]
        assert place[model.column("X")] == pytest.approx(x * math.cos(angle) - z * math.sin(angle), abs=2e-5)
        assert place[model.column("Z")] == pytest.approx(x * math.sin(angle) + z * math.cos(angle), abs=2e-5)


# Circles


def arc_moves(normal: Floats, axis: Floats) -> tuple[Operation, Floats]:
    """A half circle of radius 10 about ``normal`` under a constant tool axis, then a line; and the points."""
    across = np.cross(normal, [0.3, 0.5, 0.8])
    across /= np.linalg.norm(across)
    tip = np.array([10.0 * across, -10.0 * across, -12.0 * across])
    axes = np.array([axis, axis, axis + np.array([0.01, 0.02, 0.0])])
    axes[2] /= np.linalg.norm(axes[2])
    moves = replace(moves_of(tip, axes), kind=np.array([Kind.RAPID, Kind.ARC, Kind.LINEAR], np.uint8))
    arcs = Arcs(np.array([1]), np.zeros((1, 3)), normal[None], np.array([10.0]), np.zeros(1, np.int64))
    return replace(operation_of(moves), arcs=arcs), tip


@pytest.mark.parametrize(
    ("name", "normal", "axis", "circles"),
    [
        (
            "generic_head_table_bc",
            [0.0, 0.0, 1.0],
            [0.5, 0.0, math.sqrt(0.75)],
            1,
        ),  # the head tilts, the slides do not
        ("generic_head_table_bc", [1.0, 0.0, 0.0], [0.5, 0.0, math.sqrt(0.75)], 0),  # not in the plane of X and Y
        ("yl569", [0.0, 0.0, 1.0], [0.5, 0.0, math.sqrt(0.75)], 0),  # the table tilts, and the circle with it
        ("generic_head_head_ca", [0.0, 0.0, -1.0], [0.5, 0.2, math.sqrt(0.71)], 1),
    ],
)
def test_circles_stay_where_the_slides_make_them(
    name: str, normal: list[float], axis: list[float], circles: int
) -> None:
    operation, tip = arc_moves(np.array(normal), np.array(axis))
    done = post(machine(name), toolpath(operation), PlanOptions(tcp=False))
    assert [check.key for check in done.found.checks if not check.passed] == []
    assert len(done.run.arcs.row) == circles
    rows = rows_of_points(done.run, tip, operation.moves.axis)
    radius = np.linalg.norm(subdivide(done.run, 50, slice(rows[0] + 1, rows[1] + 1)).tip, axis=1)
    assert np.abs(radius - 10.0).max() < 0.001 + 0.005
