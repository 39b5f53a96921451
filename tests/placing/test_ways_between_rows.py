"""Arcs, and lines on which rotary axes turn: what counts between rows, against dense samples."""

from dataclasses import replace

import numpy as np
import pytest

from tests.support.placed_paths import path_rows
from trunnion.arrays import Codes, Floats
from trunnion.machines import inverse, load_machine
from trunnion.model.arc_extremes import ArcPaths
from trunnion.model.rotations import about_z
from trunnion.placing.axis_equations import AxisEquations
from trunnion.placing.extremes import Extremes
from trunnion.placing.moving_samples import most_between
from trunnion.placing.path_rows import Stretch
from trunnion.placing.rotary_angles import RotaryAngles, rotary_angles
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import Choice, TurnedPath, path_forms

YL569 = load_machine("yl569")
ZERO = np.array([20.0, -35.0, 60.0])


def test_arcs_count_where_slides_reach_farthest() -> None:
    """A helix about a tilted axis, with the table tilted: against ten thousand points of it."""
    normal = np.array([0.48, -0.36, 0.8])
    across = np.cross(normal, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    centre, radius, turns = np.array([5.0, 10.0, -3.0]), 37.5, 1.7
    share = np.linspace(0.0, 1.0, 10_001)
    angle = 2.0 * np.pi * turns * share
    tips = centre + radius * (np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * np.cross(normal, across))
    tips += 8.0 * share[:, None] * normal
    rows = path_rows(tips[[0, -1]], np.tile(normal, (2, 1)), np.zeros(2), straight=True)
    arcs = ArcPaths(tips[:1], tips[-1:], centre[None], normal[None], np.array([1]))
    rows = replace(rows, arcs=arcs, arc_row=np.array([1]))
    dense = path_rows(tips, np.tile(normal, (len(tips), 1)), np.zeros(len(tips)))
    for turn in (0.0, 77.0):
        one, other = (TurnedPath.of(YL569, Choice.FIRST, each, np.zeros(3)).at(turn) for each in (rows, dense))
        assert isinstance(one, CutSet)
        assert isinstance(other, CutSet)
        assert one.at(ZERO).extremes == pytest.approx(other.at(ZERO).extremes, abs=1e-4)
        # Exact extremes are never inside those of samples.
        assert (one.at(ZERO).extremes[:, 0] <= other.at(ZERO).extremes[:, 0] + 1e-9).all()
        assert (one.at(ZERO).extremes[:, 1] >= other.at(ZERO).extremes[:, 1] - 1e-9).all()


def test_slides_that_swing_while_rotary_axes_turn_count_within_the_bound() -> None:
    """B tilts by 75 degrees on a straight line of the tip: Z goes beyond both ends."""
    tilt = np.radians([-10.0, 65.0])
    tip = np.array([[0.0, 0.0, 40.0], [12.0, 3.0, 30.0]])
    rows = path_rows(tip, np.column_stack((np.sin(tilt), np.zeros(2), np.cos(tilt))), np.zeros(2), straight=True)
    rows = replace(rows, branch=inverse_branch(rows.axis))
    angles = rotary_angles(replace(YL569, workpiece_zero=None), rows)
    assert isinstance(angles, RotaryAngles)
    share = np.linspace(0.0, 1.0, 20_001)[:, None]
    positions = angles.positions[0] + share * (angles.positions[1] - angles.positions[0])
    line = path_rows(tip[0] + share * (tip[1] - tip[0]), np.tile([0.0, 0.0, 1.0], (20_001, 1)), np.zeros(20_001))
    dense = path_forms(YL569, line, positions)
    assert isinstance(dense, AxisEquations)
    exact, _ = Extremes.of(dense, ZERO).at(ZERO)
    sampled = path_forms(YL569, rows, angles.positions)
    assert isinstance(sampled, AxisEquations)
    found, _ = Extremes.of(sampled, ZERO).at(ZERO)
    ends = dense.slides(ZERO)[[0, -1]]
    assert exact[2, 1] > ends[:, 2].max() + 0.5  # it does swing
    bound = most_between(YL569, rows, angles.positions, ZERO)
    assert 0.0 < bound < 0.02
    assert np.abs(found - exact).max() <= bound
    # Slides that go straight themselves have their extremes at the ends.
    apart = path_forms(YL569, replace(rows, straight=np.zeros(2, np.bool_)), angles.positions)
    assert isinstance(apart, AxisEquations)
    assert len(apart) == 2
    assert most_between(YL569, replace(rows, straight=np.zeros(2, np.bool_)), angles.positions, ZERO) == 0.0


def inverse_branch(axis: Floats) -> Codes:
    """The branches in which C stands still and B tilts."""
    joints = inverse(YL569, np.zeros_like(axis), axis).joints
    return np.asarray(np.argmin(np.abs(joints[:, :, 0]), axis=0), np.uint8)


def test_the_pole_holds_the_table_until_the_path_leaves_it() -> None:
    """A three-axis path on a C table: C stands at home, and a turn of the part moves the tips, not the table."""
    tip = np.array([[40.0, 0.0, 0.0], [40.0, 30.0, 0.0]])
    rows = path_rows(tip, np.tile([0.0, 0.0, 1.0], (2, 1)), np.zeros(2), straight=True)
    path = TurnedPath.of(YL569, Choice.FIRST, rows, np.zeros(3))
    cuts = path.at(90.0)
    assert isinstance(cuts, CutSet)
    # Turned by 90 degrees the tips are at (0, 40) and (-30, 40).
    assert cuts.at(np.zeros(3)).extremes[:2] == pytest.approx(np.array([[-30.0, 0.0], [40.0, 40.0]]), abs=1e-9)


def test_rows_of_hulls_stand_for_all_rows_at_the_pole() -> None:
    random = np.random.default_rng(5)
    rows = path_rows(random.normal(size=(3000, 3)) * [40, 20, 5], np.tile([0.0, 0.0, 1.0], (3000, 1)), np.zeros(3000))
    path = TurnedPath.of(YL569, Choice.FIRST, rows, np.zeros(3))
    for turn in (0.0, 31.0, 200.0):
        cuts = path.at(turn)
        assert isinstance(cuts, CutSet)
        assert sum(len(part.forms) for part in cuts.parts) < 300
        tips = rows.tip @ about_z(turn).T + ZERO
        extremes = np.column_stack((tips.min(axis=0), tips.max(axis=0)))
        assert cuts.at(ZERO).extremes == pytest.approx(extremes, abs=1e-9)


def test_at_the_pole_the_table_stands_where_it_stood() -> None:
    """C comes from 30 degrees: it stays there until the tool tilts, and keeps what it has then."""
    tilt, azimuth = np.radians([0.0, 0.0, 40.0, 0.0]), np.radians(75.0)
    axis = np.column_stack((np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)))
    rows = replace(path_rows(np.zeros((4, 3)), axis, np.zeros(4)), start=np.array([[30.0, 0.0]]))
    angles = rotary_angles(YL569, rows)
    assert isinstance(angles, RotaryAngles)
    assert angles.positions == pytest.approx(np.array([[30.0, 0.0], [30.0, 0.0], [75.0, 40.0], [75.0, 0.0]]))
    assert angles.held.tolist() == [True, True, False, False]


@pytest.mark.parametrize("name", ["yl569", "generic_head_head_ca", "generic_head_table_bc"])
def test_a_turned_path_is_the_path_of_the_turned_part(name: str) -> None:
    """Operations that begin at the pole and leave it, with ways between rows: parts of a path add up to all of it."""
    machine = replace(load_machine(name), workpiece_zero=None, tool_length=75.0)
    random = np.random.default_rng(8)
    count = 60
    tilt = np.radians(
        np.concatenate((np.zeros(10), np.linspace(0.0, 60.0, 20), np.zeros(5), np.linspace(20.0, 5.0, 25)))
    )
    azimuth = np.radians(np.linspace(-40.0, 170.0, count))
    axis = np.column_stack((np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)))
    stretches = (Stretch(0, "a.cls"), Stretch(30, "a.cls"))
    rows = path_rows(random.uniform(-60.0, 60.0, (count, 3)), axis, np.zeros(count), straight=True)
    rows = replace(rows, stretches=stretches, start=np.array([[12.0, 0.0], [12.0, 0.0]]))
    path = TurnedPath.of(machine, Choice.FIRST, rows, np.zeros(3))
    for turn in (0.0, 40.0, 155.0):
        turned = rows.turned(about_z(turn))
        angles = rotary_angles(machine, turned)
        assert isinstance(angles, RotaryAngles)
        forms = path_forms(machine, turned, angles.positions)
        assert isinstance(forms, AxisEquations)
        whole = Extremes.of(forms, np.zeros(3))
        cuts = path.at(turn)
        assert isinstance(cuts, CutSet)
        for zero in random.uniform(-200.0, 200.0, (8, 3)):
            assert cuts.at(zero).extremes == pytest.approx(whole.at(zero)[0], abs=1e-8)
