"""What a machine reaches, against closed forms and brute force."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.machine_strategies import machines
from trunnion.arrays import Floats
from trunnion.machines import Axis, AxisKind, Machine, Mount, forward, inverse, load_machine, slide_positions
from trunnion.machines.machine import Vector
from trunnion.machines.reach import axis_poses, pose_bodies, reached_points, reached_volumes
from trunnion.machines.reach.poses import within_travel

X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)


def slide(name: str, direction: Vector, low: float, high: float, mount: Mount = Mount.TOOL) -> Axis:
    return Axis(name, AxisKind.LINEAR, mount, direction, low=low, high=high)


def turn(
    name: str, direction: Vector, low: float, high: float, mount: Mount = Mount.PART, *, endless: bool = False
) -> Axis:
    low, high = (-math.inf, math.inf) if endless else (low, high)
    return Axis(name, AxisKind.ROTARY, mount, direction, low=low, high=high, endless=endless)


#: C on A in the table, slides of 500 x 400 x 300 in the tool.
TABLE = Machine(
    "table", "Table-table",
    (
        turn("C", Z, 0, 0, endless=True), turn("A", X, -90, 90),
        slide("X", X, -250, 250), slide("Y", Y, -200, 200), slide("Z", Z, 0, 300),
    ),
)  # fmt: skip

#: A fork head that carries A on C, with a pivot of 150 mm, over slides of 3000 x 2000 x 1000.
HEAD = Machine(
    "head", "Head-head",
    (
        slide("X", X, -1500, 1500, Mount.PART), slide("Y", Y, -1000, 1000), slide("Z", Z, 0, 1000),
        turn("C", Z, 0, 0, Mount.TOOL, endless=True), turn("A", X, -100, 100, Mount.TOOL),
    ),
    spindle_point=(0.0, 0.0, -150.0),
)  # fmt: skip


def axes_at(tilt: float, count: int) -> Floats:
    """Tool axes of a tilt at evenly spread azimuths."""
    angle = math.radians(tilt)
    azimuth = 2.0 * np.pi * np.arange(count) / count
    return np.column_stack((
        math.sin(angle) * np.cos(azimuth), math.sin(angle) * np.sin(azimuth), np.full(count, math.cos(angle))
    ))  # fmt: skip


def limited(machine: Machine, low: float, high: float, slides: tuple[float, float] = (-300.0, 200.0)) -> Machine:
    """A machine with travels for all axes."""
    ends = {True: (low, high), False: slides}
    axes = tuple(replace(axis, low=ends[axis.is_rotary][0], high=ends[axis.is_rotary][1]) for axis in machine.axes)
    return replace(machine, axes=axes, tool_length=120.0)


@pytest.mark.parametrize("tilt", [0.0, 30.0, 90.0])
def test_one_rotary_position_of_a_table_reaches_the_product_of_the_travels(tilt: float) -> None:
    poses = axis_poses(TABLE, axes_at(tilt, 7))
    assert pose_bodies(TABLE, poses.rotary).volume == pytest.approx(500.0 * 400.0 * 300.0, rel=1e-12)


def test_an_upright_tool_reaches_what_the_table_turns_under_it() -> None:
    """With Z upright C is free: the corners of 250 and 200 mm go round a disc, over 300 mm."""
    poses = axis_poses(TABLE, np.array([[0.0, 0.0, 1.0]]), 3.0)
    assert (poses.branches.tolist(), poses.pole.tolist(), len(poses.direction)) == ([1], [True], 120)
    some, every = reached_volumes(pose_bodies(TABLE, poses.rotary), poses.direction, 1, levels=3)
    disc = math.pi * (250.0**2 + 200.0**2) * 300.0
    # Corners every three degrees leave out slivers of less than 1 %.
    assert some.low <= disc
    assert some.high >= disc * 0.99
    assert some.likely == pytest.approx(disc, rel=0.02)
    assert (every.low, every.high) == (some.low, some.high)


@pytest.mark.parametrize("tilt", [20.0, 60.0, 90.0])
def test_a_head_reaches_its_box_less_and_more_the_swing_of_its_pivot(tilt: float) -> None:
    """The arm of 250 mm swings the tip on a circle: what it always reaches is narrower by it, what it may is wider."""
    machine = replace(HEAD, tool_length=100.0)
    axes = axes_at(tilt, 72)
    poses = axis_poses(machine, axes)
    assert poses.branches.tolist() == [2] * 72
    some, every = reached_volumes(pose_bodies(machine, poses.rotary), poses.direction, len(axes))
    swing = 250.0 * math.sin(math.radians(tilt))
    always = (3000.0 - 2.0 * swing) * (2000.0 - 2.0 * swing) * 1000.0
    ever = (3000.0 * 2000.0 + 2.0 * swing * 5000.0 + math.pi * swing**2) * 1000.0
    assert every.low * (1.0 - 1e-9) <= always <= every.high * (1.0 + 1e-9)
    assert every.high - every.low < 0.03 * always
    assert some.low <= ever
    assert some.high >= ever * 0.999  # the circle has 72 corners
    assert some.high - some.low < 0.03 * ever


def test_tilts_beyond_the_rotary_travel_are_not_reached() -> None:
    poses = axis_poses(TABLE, axes_at(90.001, 4))
    assert poses.branches.tolist() == [0] * 4
    some, every = reached_volumes(pose_bodies(TABLE, poses.rotary), poses.direction, 4)
    assert (some.high, every.high) == (0.0, 0.0)
    assert axis_poses(TABLE, axes_at(90.0, 4)).branches.tolist() == [2] * 4


def test_what_one_azimuth_lacks_is_not_reached_at_every() -> None:
    """C turns a quarter and A tilts one way only: one quadrant of azimuths."""
    quarter = replace(TABLE, axes=(turn("C", Z, 0, 90), turn("A", X, 0, 90), *TABLE.axes[2:]))
    poses = axis_poses(quarter, axes_at(45.0, 8))
    assert sorted(poses.branches.tolist()) == [0, 0, 0, 0, 0, 1, 1, 1]
    some, every = reached_volumes(pose_bodies(quarter, poses.rotary), poses.direction, 8)
    assert some.low > 500.0 * 400.0 * 300.0
    assert every.high == 0.0


def test_a_whole_turn_more_is_within_travel() -> None:
    c = turn("C", Z, 300, 500)
    assert within_travel(c, np.array([-60.0, -61.0, 0.0, 140.0, 141.0, np.nan])).tolist() == [
        True, False, True, True, False, False,
    ]  # fmt: skip


random_axes = st.lists(st.tuples(*[st.floats(-1.0, 1.0)] * 3), min_size=1, max_size=4)


@settings(deadline=None, max_examples=examples(100))
@given(machines(), st.floats(-170.0, -5.0), st.floats(5.0, 170.0), st.integers(0, 2**32 - 1))
def test_tool_axes_of_positions_within_the_travel_are_found(
    machine: Machine, low: float, high: float, seed: int
) -> None:
    machine = limited(machine, low, high)
    joints = np.random.default_rng(seed).uniform(low, high, (6, 5))
    _, axes = forward(machine, joints)
    poses = axis_poses(machine, axes)
    for row in range(len(axes)):
        if poses.pole[row]:
            continue
        own = poses.rotary[poses.direction == row]
        off = np.abs(np.mod(own - joints[row, list(machine.rotary)] + 180.0, 360.0) - 180.0).max(axis=1)
        assert off.min(initial=np.inf) < 1e-3  # at the edge of reach angles have half of the digits
        full = np.zeros((len(own), 5))
        full[:, list(machine.rotary)] = own
        assert forward(machine, full)[1] == pytest.approx(np.tile(axes[row], (len(own), 1)), abs=1e-6)


@settings(deadline=None, max_examples=examples(100))
@given(machines(), st.integers(0, 2**32 - 1))
def test_bodies_hold_exactly_the_tips_of_the_travel(machine: Machine, seed: int) -> None:
    machine = limited(machine, -170.0, 170.0)
    random = np.random.default_rng(seed)
    rotary = random.uniform(-170.0, 170.0, (1, 2))
    bodies = pose_bodies(machine, rotary)
    assume(bodies.volume[0] > 1e-3 * 500.0**3)
    slides = random.uniform(-300.0, 200.0, (40, 3))
    joints = np.empty((40, 5))
    joints[:, list(machine.linear)], joints[:, list(machine.rotary)] = slides, rotary
    tips, _ = forward(machine, joints)
    at = np.einsum("ij,nj->ni", bodies.normal[0], tips)
    assert (at >= bodies.low[0] - 1e-6).all()
    assert (at <= bodies.high[0] + 1e-6).all()
    # And the other way round: points of the box around it are inside exactly if the slides reach them.
    corners = bodies.corners[0]
    points = random.uniform(corners.min(axis=0), corners.max(axis=0), (200, 3))
    at = np.einsum("ij,nj->ni", bodies.normal[0], points)
    inside = ((at >= bodies.low[0]) & (at <= bodies.high[0])).all(axis=1)
    needed = slide_positions(machine, points, np.tile(rotary, (200, 1)))[:, list(machine.linear)]
    assert inside.tolist() == ((needed >= -300.0) & (needed <= 200.0)).all(axis=1).tolist()


@settings(deadline=None, max_examples=examples(12))
@given(machines(), st.floats(0.2, 3.0), st.integers(0, 2**32 - 1))
def test_volumes_are_those_that_trials_find(machine: Machine, tilt: float, seed: int) -> None:
    """Random points, each asked of the inverse map: the share that is reached has a known spread."""
    machine = limited(machine, -170.0, 170.0)
    axes = axes_at(math.degrees(tilt), 5)
    poses = axis_poses(machine, axes)
    assume(not poses.pole.any())
    assume(len(poses.direction))
    bodies = pose_bodies(machine, poses.rotary)
    some, every = reached_volumes(bodies, poses.direction, 5, levels=3)
    low, high = bodies.corners.min(axis=(0, 1)), bodies.corners.max(axis=(0, 1))
    count = 4000
    points = np.random.default_rng(seed).uniform(low, high, (count, 3))
    reached = np.zeros((5, count), np.bool_)
    for way in range(5):
        joints = inverse(machine, points, np.tile(axes[way], (count, 1))).joints
        limits = machine.limits
        with np.errstate(invalid="ignore"):
            fits = (joints >= limits[:, 0]) & (joints <= limits[:, 1])
        reached[way] = fits.all(axis=2).any(axis=0)
    box = float(np.prod(high - low))
    for found, hits in ((some, reached.any(axis=0).sum()), (every, reached.all(axis=0).sum())):
        share = hits / count
        spread = 5.0 * math.sqrt((share * (1.0 - share) + 1.0 / count) / count)
        assert found.low / box - spread <= share <= found.high / box + spread
        assert found.low <= found.likely <= found.high


@settings(deadline=None, max_examples=examples(60))
@given(machines(), random_axes, st.integers(0, 2**32 - 1))
def test_points_are_reached_where_a_solution_of_the_inverse_map_is_within_the_travel(
    machine: Machine, vectors: list[tuple[float, float, float]], seed: int
) -> None:
    machine = replace(limited(machine, -100.0, 100.0, (-900.0, 900.0)), workpiece_zero=(10.0, 20.0, 30.0))
    axes = np.array(vectors)
    assume(np.linalg.norm(axes, axis=1).min() > 0.1)
    points = np.random.default_rng(seed).uniform(-500.0, 500.0, (len(axes), 2, 3))
    found = reached_points(machine, points, axes)
    rotary = list(machine.rotary)
    for row in range(len(axes)):
        each = inverse(machine, points[row], np.tile(axes[row], (2, 1)))
        if each.pole.any() or not each.reachable.all():
            continue
        fits = (each.joints >= machine.limits[:, 0]) & (each.joints <= machine.limits[:, 1])
        assert bool(found.axis[row]) == any(fits[branch][:, rotary].all() for branch in range(2))
        assert bool(found.travel[row]) == any(fits[branch].all() for branch in range(2))


def test_a_free_table_turns_a_point_to_where_the_slides_go() -> None:
    """Y goes to 200 mm and X to 250: with the tool upright, C brings 240 of Y there, and no more than 250."""
    machine = replace(TABLE, workpiece_zero=(0.0, 0.0, 0.0), tool_length=0.0)
    points = np.array([[[0.0, 240.0, 10.0]], [[0.0, -320.0, 10.0]], [[0.0, 330.0, 10.0]]])
    found = reached_points(machine, points, np.tile([0.0, 0.0, 1.0], (3, 1)))
    assert found.axis.tolist() == [True] * 3
    # The corners of the travel are 320.2 mm away from its middle.
    assert found.travel.tolist() == [True, True, False]
    held = replace(machine, axes=(turn("C", Z, -1, 1), *machine.axes[1:]))
    assert reached_points(held, points, np.tile([0.0, 0.0, 1.0], (3, 1))).travel.tolist() == [False] * 3


def test_slides_whose_place_is_not_known_stop_nothing() -> None:
    far, up = np.full((1, 1, 3), 4000.0), np.array([[0.0, 0.0, 1.0]])
    dmu65 = load_machine("dmu65")
    assert reached_points(dmu65, far, up).travel.tolist() == [True]
    placed = replace(dmu65, workpiece_zero=(0.0, 0.0, 100.0), tool_length=100.0)
    assert reached_points(placed, far, up).travel.tolist() == [False]
    assert reached_points(placed, np.zeros((1, 1, 3)), up).travel.tolist() == [True]
