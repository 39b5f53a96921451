"""Slides between the ends of lines on which rotary axes turn: against dense samples of the same motion."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.verifying import check
from trunnion.arrays import Floats
from trunnion.machines import Machine, forward, inverse, load_machine
from trunnion.model.turning_lines import LineSearch, TurningLines, chord_excursion

MACHINES = ("yl569", "dmu65", "generic_head_head_ca", "generic_head_table_bc", "generic_nutated_b45_c", "hs664rt")

#: A sweep of the table by 80 degrees in one block, the tool tilted by 2; the tip goes 1 mm.
SWEEP = """G17 G710 G90 G94
G0 B2. C-40.
TRAORI
G54
ORIWKS
ORIAXES
G0 X140. Y0. Z50. D1
G1 Z0. F500
Y0.001 C40.
M30
"""


def narrow(limit: float) -> Machine:
    """The yl569 with this travel of X to both sides, both rotary axes through the zero of the part."""
    machine = load_machine("yl569")
    axes = tuple(
        replace(axis, point=(0.0, 0.0, 0.0)) if axis.is_rotary
        else replace(axis, low=-limit, high=limit) if axis.name == "X" else axis
        for axis in machine.axes
    )  # fmt: skip
    return replace(machine, axes=axes, workpiece_zero=(0.0, 0.0, 0.0), tool_length=100.0)


def test_a_sweep_of_the_table_goes_beyond_the_travel_within_its_block(tmp_path: Path) -> None:
    """X is 140 cos 40 cos 2 = 107.180 at both ends of the block, and 140 cos 2 = 139.915 half-way."""
    file = tmp_path / "sweep.mpf"
    file.write_text(SWEEP)
    found = check(trunnion.verify(file, machine=narrow(125.0)), "travel")
    assert not found.passed
    assert found.summary == (
        "X goes to 139.915 within line 9, while rotary axes turn, its limit is 125 mm, 14.915 too far"
    )
    assert [place.nc_line for place in found.places] == [9]
    assert check(trunnion.verify(file, machine=narrow(139.92)), "travel").passed
    assert not check(trunnion.verify(file, machine=narrow(139.91)), "travel").passed
    file.write_text(SWEEP.replace("Y0.001 C40.", "C40."))  # a turn on the spot
    assert not check(trunnion.verify(file, machine=narrow(139.91)), "travel").passed


def test_without_tcp_slides_stay_on_their_lines(tmp_path: Path) -> None:
    file = tmp_path / "sweep.mpf"
    file.write_text(SWEEP.replace("TRAORI\n", "").replace("X140.", "X107."))
    assert check(trunnion.verify(file, machine=narrow(125.0)), "travel").passed


def test_the_range_counts_where_no_zero_is_known(tmp_path: Path) -> None:
    """From -140 cos 40 cos 2 to 140 cos 2 X needs 247.096 mm."""
    file = tmp_path / "sweep.mpf"
    file.write_text(SWEEP.replace("G1 Z0. F500\n", "G1 Z0. F500\nX-140.\nX140.\n"))
    for limit, passes in ((123.5, False), (123.6, True)):
        machine = replace(narrow(limit), workpiece_zero=None, tool_length=None)
        found = check(trunnion.verify(file, machine=machine), "travel")
        assert found.passed is passes, found.summary
        text = f"X needs 247.096 of {2.0 * limit:g} mm, counting what it does within line 11, while rotary axes turn"
        assert any(text in str(place.text) for place in found.places), found.places


directions = st.tuples(st.floats(0.0, 60.0), st.floats(-180.0, 180.0))
points = st.tuples(*[st.floats(-200.0, 200.0)] * 3)


def axis_of(tilt: float, azimuth: float) -> Floats:
    a, b = math.radians(tilt), math.radians(azimuth)
    return np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])


@settings(max_examples=examples(60), deadline=None)
@given(name=st.sampled_from(MACHINES), ends=st.tuples(directions, directions), tips=st.tuples(points, points))
def test_even_turns_reach_what_dense_samples_reach(
    name: str, ends: tuple[tuple[float, float], ...], tips: tuple[tuple[float, ...], ...]
) -> None:
    machine = replace(load_machine(name), workpiece_zero=(10.0, 20.0, 30.0), tool_length=80.0)
    axes, tip = np.array([axis_of(*end) for end in ends]), np.array(tips)
    solved = inverse(machine, tip, axes)
    joints = solved.joints[0]
    if not np.isfinite(joints).all():
        return
    extremes, rows = np.stack((joints.min(axis=0), joints.max(axis=0)), axis=1), np.full((5, 2), -1)
    within = np.zeros((5, 2), np.bool_)
    lines = TurningLines(np.array([7]), tip[None], axes[None], joints[None], np.zeros(1, np.bool_))
    search, even = LineSearch(machine, extremes, rows, within), np.zeros(1, np.bool_)
    if len(search.likely(tip, joints, ~even, even)):
        search.add(lines)
    dense = slides_between(machine, tip, joints, 2000)
    for column in machine.linear:
        for side, expected in ((0, dense[:, column].min()), (1, dense[:, column].max())):
            assert abs(extremes[column, side] - expected) < 5e-3
            assert within[column, side] == (rows[column, side] == 7)


def great_circle_slides(machine: Machine, tip: Floats, axes: Floats, joints: Floats, count: int) -> Floats:
    """(k, 5) axis values while the tool axis moves on its great circle, from branches that follow each other."""
    share = np.linspace(0.0, 1.0, count + 1)[:, None]
    angle = math.acos(min(1.0, float(axes[0] @ axes[1])))
    vector = (np.sin((1.0 - share) * angle) * axes[0] + np.sin(share * angle) * axes[1]) / math.sin(angle)
    solved = inverse(machine, tip[0] + share * (tip[1] - tip[0]), vector / np.linalg.norm(vector, axis=1)[:, None])
    rotary = list(machine.rotary)
    found, last = [joints[0]], joints[0]
    for at in range(1, count + 1):
        both = solved.joints[:, at].copy()
        both[:, rotary] += 360.0 * np.rint((last[rotary] - both[:, rotary]) / 360.0)
        off = np.nan_to_num(np.abs(both[:, rotary] - last[rotary]).sum(axis=1), nan=np.inf)
        last = both[int(np.argmin(off))]
        found.append(last)
    return np.array(found)


@settings(max_examples=examples(80), deadline=None)
@given(
    name=st.sampled_from(MACHINES),
    begin=directions,
    bend=st.tuples(st.floats(-4.0, 4.0), st.floats(-10.0, 10.0)),
    tips=st.tuples(points, points),
)
def test_great_circles_reach_what_dense_samples_reach(
    name: str, begin: tuple[float, float], bend: tuple[float, float], tips: tuple[tuple[float, ...], ...]
) -> None:
    machine = replace(load_machine(name), workpiece_zero=(10.0, 20.0, 30.0), tool_length=80.0)
    axes = np.array([axis_of(*begin), axis_of(begin[0] + bend[0], begin[1] + bend[1])])
    tip = np.array(tips)
    joints = inverse(machine, tip, axes).joints[0]
    if not np.isfinite(joints).all() or np.linalg.norm(axes[1] - axes[0]) < 1e-3:
        return
    dense = great_circle_slides(machine, tip, axes, joints, 400)
    if np.abs(dense[-1] - joints[1])[list(machine.rotary)].max() > 1e-6:
        return  # it ends on the other branch
    extremes, rows = np.stack((joints.min(axis=0), joints.max(axis=0)), axis=1), np.full((5, 2), -1)
    search = LineSearch(machine, extremes, rows, np.zeros((5, 2), np.bool_))
    by_vector = np.ones(1, np.bool_)
    if len(search.likely(tip, joints, by_vector, by_vector)):
        search.add(TurningLines(np.array([7]), tip[None], axes[None], joints[None], by_vector))
    for column in machine.linear:
        assert dense[:, column].min() > extremes[column, 0] - 5e-3
        assert dense[:, column].max() < extremes[column, 1] + 5e-3


def slides_between(machine: Machine, tip: Floats, joints: Floats, count: int) -> Floats:
    """(count + 1, 5) axis values while both angles and the tip move evenly: slides that the forward map takes there."""
    share = np.linspace(0.0, 1.0, count + 1)[:, None]
    found = joints[:1] + share * (joints[1:] - joints[:1])
    goal = tip[:1] + share * (tip[1:] - tip[:1])
    slides = list(machine.linear)
    # Tips are linear in the slides: four of them give the map at each pose.
    found[:, slides] = 0.0
    origin = forward(machine, found)[0]
    columns = []
    for slide in slides:
        moved = found.copy()
        moved[:, slide] = 1.0
        columns.append(forward(machine, moved)[0] - origin)
    found[:, slides] = np.linalg.solve(np.stack(columns, axis=2), (goal - origin)[:, :, None])[:, :, 0]
    return found


@settings(max_examples=examples(40), deadline=None)
@given(turn=st.floats(0.0, 3.0), radius=st.floats(1.0, 300.0))
def test_the_bound_holds_a_turn_at_a_radius(turn: float, radius: float) -> None:
    """On the spot a slide at this radius leaves its chord by r (1 - cos (d / 2))."""
    [bound] = chord_excursion(np.array([turn]), np.zeros(1), np.array([radius]))
    assert bound >= radius * (1.0 - math.cos(turn / 2.0)) - 1e-9


def test_lines_within_what_is_known_are_not_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = narrow(125.0)
    joints = inverse(machine, np.zeros((2, 3)), np.array([axis_of(2, 0), axis_of(2, 10)])).joints[0]
    lines = TurningLines(
        np.zeros(1, np.int64), np.zeros((1, 2, 3)), np.zeros((1, 2, 3)), joints[None], np.zeros(1, np.bool_)
    )
    extremes = np.tile([-1000.0, 1000.0], (5, 1))
    search = LineSearch(machine, extremes, np.full((5, 2), -1), np.zeros((5, 2), np.bool_))
    monkeypatch.setattr("trunnion.model.turning_lines.joints_from_rows", None)
    search.add(lines)
    assert (extremes == [-1000.0, 1000.0]).all()
