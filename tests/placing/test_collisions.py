"""Places by collisions: literal ones, dense grids of zeros on machines of each kind, and turned fixtures."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.brute_clearance import BruteBodies, box_body, brute_joints
from tests.support.examples import examples
from tests.support.placed_paths import brute_margin, path_rows
from tests.support.u_shapes import vice
from trunnion.arrays import Floats
from trunnion.machines import Machine, MachineBody, load_machine
from trunnion.model.rotations import about_x, about_z
from trunnion.placing.best_turn import Grid, TurnResult
from trunnion.placing.collisions.best_clearance import Guard, NearestRow, Oriented, farthest_orientations, nearest_at
from trunnion.placing.collisions.clearance import ENOUGH, Clearance
from trunnion.placing.collisions.distance_planes import Witness
from trunnion.placing.collisions.guarded_pairs import (
    Changes,
    Guarded,
    GuardedPair,
    guarded_machine,
    guarded_on_part,
    guarded_pairs,
    guarded_tool,
)
from trunnion.placing.collisions.path_samples import path_samples
from trunnion.placing.collisions.search import FarthestSearch
from trunnion.placing.largest_margin import largest_margin
from trunnion.placing.path_rows import PathRows
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.turns import TurnedPath, choices_of
from trunnion.simulation.collisions import Body, BodyKind, machine_bodies
from trunnion.simulation.collisions.hull_pieces import mesh_pieces
from trunnion.simulation.meshes import TriangleMesh, box_mesh
from trunnion.simulation.tools.text import parse_tool

LENGTH = 100.0

CHANGED = (Changes.PLACE, Changes.TURN)


def gantry(bodies: Sequence[MachineBody], low: Sequence[float], high: Sequence[float]) -> Machine:
    """X carries the part, Y, Z, C and A the tool; the spindle nose stands at the origin; with limits of the slides."""
    machine = load_machine("generic_head_head_ca")
    ends = iter(zip(low, high, strict=True))
    axes = []
    for axis in machine.axes:
        least, most = (-4000.0, 4000.0) if axis.is_rotary else next(ends)
        axes.append(replace(axis, low=least, high=most))
    return replace(
        machine,
        axes=tuple(axes),
        bodies=tuple(bodies),
        tool_length=LENGTH,
        workpiece_zero=None,
        spindle_point=(0, 0, 0),
    )


def upright(*tips: Sequence[float]) -> PathRows:
    """A path with the tool upright; the ways between its points count."""
    tip = np.array(tips, np.float64)
    return path_rows(tip, np.tile([0.0, 0.0, 1.0], (len(tip), 1)), np.zeros(len(tip)), straight=True)


class Placed:
    """The search for the best place of rows among bodies."""

    def __init__(
        self, machine: Machine, rows: PathRows, turns: Sequence[float] = (0.0,), fixtures: Sequence[TriangleMesh] = (),
        tool: str = "",
    ) -> None:  # fmt: skip
        bodies = guarded_machine(machine_bodies(machine))
        bodies += [guarded_on_part(mesh, BodyKind.FIXTURE) for mesh in fixtures]
        if tool:
            bodies += guarded_tool(parse_tool(tool, {}), machine, "1", LENGTH, 0)
        self.guard = Guard(guarded_pairs(machine, bodies).kept, np.zeros(len(rows), np.int64), {})
        self.machine, self.rows = machine, rows
        self.results, self.best, bound = farthest_orientations(
            lambda tilt: self.paths(tilt), Grid(np.array(turns)), self.guard, lambda _: None
        )
        assert bound is not None
        self.bound: float = bound

    def paths(self, tilt: float = 0.0) -> list[TurnedPath]:
        rows = self.rows.turned(about_x(tilt))
        return [TurnedPath.of(self.machine, choice, each, np.zeros(3)) for choice, each in choices_of(rows)][:1]

    def nearest(self, *changes: Changes) -> NearestRow | None:
        found: TurnResult = self.best
        assert found.path is not None
        assert found.best is not None
        return nearest_at(found.path, self.guard, found.turn, found.tilt, found.best.zero, *(changes or CHANGED))

    @property
    def zero(self) -> Floats:
        assert self.best.best is not None
        return self.best.best.zero


def within(found: float, best: float) -> bool:
    """Whether a distance is the best one, within what the search states."""
    return best - max(0.1, 0.01 * best) - 0.011 <= found <= best + 0.011


def test_a_head_between_two_walls_is_in_the_middle() -> None:
    """The head is 100 wide and goes 40: between walls 400 apart 130 are left on both sides, with X0 at -10."""
    walls = [
        box_body("left", "X", (-300, -500, -900), (-200, 500, 500)),
        box_body("right", "X", (200, -500, -900), (300, 500, 500)),
        box_body("head", "Z", (-50, -50, 0), (50, 50, 200)),
    ]
    placed = Placed(gantry(walls, (-300, -20, -50), (300, 20, 50)), upright((-10, 0, 0), (30, 0, 0)))
    nearest = placed.nearest()
    assert nearest is not None
    assert nearest.names[0] == "head"
    assert within(nearest.distance, 130.0)
    assert 130.0 <= placed.bound <= 131.3
    assert abs(placed.zero[0] + 10.0) <= 1.31


def test_a_head_over_a_table_is_as_high_as_its_slide_allows() -> None:
    """Z ends at 600: with a tool of 100 mm and a path up to 20, Z0 is at 600 - 100 - 20 - 1 kept = 479 at most.

    The tip goes down to 5, so the head is then at 479 + 5 + 100 = 584, and 784 over the table at -200.
    """
    bodies = [
        box_body("table", "X", (-2000, -2000, -300), (2000, 2000, -200)),
        box_body("head", "Z", (-50, -50, 0), (50, 50, 200)),
    ]
    placed = Placed(gantry(bodies, (-300, -300, -600), (300, 300, 600)), upright((0, 0, 20), (50, 20, 5), (0, 0, 20)))
    nearest = placed.nearest()
    assert nearest is not None
    assert nearest.names == ("head", "table")
    assert nearest.row == 1
    assert within(nearest.distance, 784.0)
    # Of places as good as the best one with much margin: X and Y are in the middle of what is allowed.
    assert placed.best.margin == pytest.approx(1.0 + 0.0025 * 784.0, abs=0.02)


def test_a_head_over_a_fixture_is_as_far_from_it_as_the_tool_is_long() -> None:
    """Head 30 over the fixture: 100 of the tool, less 70 of the fixture; no place changes it, and margin decides."""
    bodies = [box_body("head", "spindle", (-50, -50, 0), (50, 50, 200))]
    machine = gantry(bodies, (-300, -200, -400), (300, 200, 400))
    block = box_mesh(np.array([60.0, -20, 0]), np.array([90.0, 20, 70]), "block")
    placed = Placed(machine, upright((0, 0, 0), (50, 0, 0)), fixtures=[block], tool="1=flat:10,length=100,flutes=40")
    nearest, always = placed.nearest(), placed.nearest(Changes.NOTHING)
    assert nearest is not None
    assert nearest.distance == pytest.approx(30.0, abs=1e-6)
    assert always is not None
    assert always.names[1] == "block"
    assert always.distance == pytest.approx(60.0 - 50.0 - 5.0, abs=0.03)  # the cutter of 10 mm at X50
    assert placed.best.margin == pytest.approx(200.0, abs=1e-6)  # Y: a path without way in Y, in the middle


def test_a_fixture_turns_with_its_part() -> None:
    """An arm of 200 mm along +X; a column at Y300 on the bed. Turned by 270 degrees the arm points away from it.

    Its own end is then at Y0 of the part, and Y0 of the part at -10 + 1 kept: 309 mm from the column.
    """
    bodies = [box_body("column", "bed", (-1000, 300, -1000), (1000, 400, 1000))]
    machine = gantry(bodies, (-10, -10, -400), (10, 10, 400))
    arm = box_mesh(np.array([0.0, -20, -50]), np.array([200.0, 20, -10]), "arm")
    for turns in ((0.0, 90.0, 180.0, 270.0), (90.0, 270.0, 0.0)):
        placed = Placed(machine, upright((0, 0, 0), (1, 0, 0)), turns, [arm])
        assert placed.best.turn == 270.0
        nearest = placed.nearest()
        assert nearest is not None
        assert nearest.names == ("column", "arm")
        assert within(nearest.distance, 309.0 - 1.0)  # turned, the way of 1 mm goes to -Y: Y0 ends 1 mm earlier
    single = Placed(machine, upright((0, 0, 0), (1, 0, 0)), (90.0,), [arm]).nearest()
    assert single is not None
    assert within(single.distance, 300.0 - 200.0 + 9.0)


def test_where_bodies_touch_everywhere_no_place_is_free() -> None:
    """The head is wider than the walls are apart."""
    walls = [
        box_body("left", "X", (-300, -500, -900), (-200, 500, 500)),
        box_body("right", "X", (200, -500, -900), (300, 500, 500)),
        box_body("head", "Z", (-210, -50, 0), (210, 50, 200)),
    ]
    placed = Placed(gantry(walls, (-300, -20, -50), (300, 20, 50)), upright((-10, 0, 0), (30, 0, 0)), (0.0, 90.0))
    nearest = placed.nearest()
    assert nearest is not None
    assert nearest.distance == 0.0
    assert all(result.cost is None for result in placed.results)
    assert placed.bound <= 0.076


def swarf(machine: Machine, seed: int) -> tuple[Machine, PathRows]:
    """A machine with limits, a head, a table and a post on it, and a leaning path of seven points."""
    random = np.random.default_rng(seed)
    axes = tuple(
        replace(axis, low=-4000.0, high=4000.0) if axis.is_rotary else replace(axis, low=-260.0, high=240.0)
        for axis in machine.axes
    )
    bodies = (
        box_body("head", "spindle", (-70, -60, 0), (60, 80, 150)),
        box_body("table", "workpiece", (-200, -200, -60), (200, 200, -20)),
        box_body("post", "workpiece", (150, -40, -20), (190, 40, 140)),
    )
    tip = random.uniform(-40.0, 40.0, (7, 3))
    azimuth = np.radians(random.uniform(-50.0, 50.0, 7))
    lean = np.radians(random.uniform(10.0, 30.0, 7))
    axis = np.column_stack((np.cos(azimuth) * np.sin(lean), np.sin(azimuth) * np.sin(lean), np.cos(lean)))
    machine = replace(machine, axes=axes, bodies=bodies, workpiece_zero=None, tool_length=LENGTH)
    return machine, path_rows(tip, axis, np.zeros(7))


@pytest.mark.parametrize("name", ["matsuura_mx330", "generic_head_table_bc", "generic_head_head_ca"])
def test_no_place_of_a_dense_grid_keeps_bodies_farther_apart(name: str) -> None:
    """Table and table, head and table, head and head: places at three turns, asked of python-fcl."""
    machine, rows = swarf(load_machine(name), 5)
    placed = Placed(machine, rows, (0.0, 70.0, 200.0))
    nearest = placed.nearest()
    assert nearest is not None
    meshes = [(body.link, body.mesh) for body in machine_bodies(machine)]
    brute, pairs = BruteBodies(machine, meshes, []), [(0, 1), (0, 2)]
    turn = placed.best.turn
    there = brute.least(pairs, brute_joints(machine, rows, turn, placed.zero, 30), turn, placed.zero)
    assert there == pytest.approx(nearest.distance, abs=0.1)
    assert there >= nearest.distance - 0.011
    assert brute_margin(machine, rows, turn, placed.zero) >= 1.0 - 1e-6
    random, most, count = np.random.default_rng(1), 0.0, 0
    for turn in (0.0, 70.0, 200.0):
        around = placed.zero + random.normal(size=(150, 3)) * np.repeat([1.0, 8.0, 40.0], 50)[:, None]
        for zero in np.concatenate((around, random.uniform(-400.0, 900.0, (1500, 3)))):
            if brute_margin(machine, rows, turn, zero) >= 1.0:
                count += 1
                found = brute.least(pairs, brute_joints(machine, rows, turn, zero, 3), turn, zero)
                if found > most:  # bodies come nearer between these poses
                    most = max(most, brute.least(pairs, brute_joints(machine, rows, turn, zero, 60), turn, zero))
    assert count > 60
    assert nearest.distance >= most - max(0.1, 0.01 * most) - 0.011
    assert most <= placed.bound + 0.011
    assert most > 0.95 * nearest.distance


def on_link(name: str, link: str, mesh: TriangleMesh) -> Guarded:
    return Guarded(Body(name, link, mesh, BodyKind.MACHINE), mesh_pieces(mesh))


def clearance(machine: Machine, rows: PathRows, pair: GuardedPair, near: Floats, turn: float = 0.0) -> Clearance:
    path = TurnedPath.of(machine, next(choices_of(rows))[0], rows, np.zeros(3))
    turned, positions = path.rows_at(turn)
    moments = path_samples(path.machine, turned, positions, np.zeros(len(rows), np.int64), {})
    return Clearance(path.machine, moments, [pair], about_z(turn), near)


@settings(max_examples=examples(12), deadline=None)
@given(
    seed=st.integers(0, 10**6), is_hollow=st.booleans(), turn=st.sampled_from([0.0, 33.0, 200.0]),
    name=st.sampled_from(["matsuura_mx330", "generic_head_table_bc", "generic_head_head_ca"]),
    carried=st.booleans(),
)  # fmt: skip
def test_the_nearest_moment_is_that_of_many_poses(
    seed: int, is_hollow: bool, turn: float, name: str, carried: bool
) -> None:
    machine, rows = swarf(load_machine(name), seed)
    random = np.random.default_rng(seed)
    mesh = vice() if is_hollow else box_mesh(np.array([-40.0, -90, -30]), np.array([60.0, 20, 10]))
    head = on_link("head", "spindle", box_mesh(np.array([-30.0, -30, -20]), np.array([20.0, 30, 90])))
    below = guarded_on_part(mesh, BodyKind.FIXTURE) if carried else on_link("table", "workpiece", mesh)
    zero, near = random.uniform(-120.0, 120.0, 3), random.uniform(-120.0, 120.0, 3)
    asked = clearance(machine, rows, GuardedPair(head, below, Changes.PLACE), near, turn)
    found = asked.inside(zero) or asked.nearest(zero)
    assert found is not None
    links = [("spindle", head.body.mesh), *([] if carried else [("workpiece", mesh)])]
    brute = BruteBodies(machine, links, [mesh] if carried else [])
    joints = brute_joints(machine, rows, turn, zero, 60)
    least = brute.least([(0, 1)], joints, turn, zero)
    allowed = 0.06 if is_hollow else 0.011
    assert found.distance <= least + allowed
    one = brute_joints(machine, rows, turn, zero, 1)
    at_rows = brute.least([(0, 1)], one, turn, zero)
    # No deeper than a fine look around what was found shows it to be.
    assert found.distance >= least - 0.3 or found.distance == 0.0
    assert found.distance <= at_rows + allowed
    if least > 1.0:
        assert found.distance > 0.0


def test_a_body_inside_of_another_is_no_free_place() -> None:
    """A head of 8 mm within a leg of a U of 20 mm: surfaces are 6 mm apart at least, and bodies touch."""
    machine = gantry([], (-300, -300, -600), (300, 300, 600))
    head = on_link("head", "spindle", box_mesh(np.array([-4.0, -4, 0]), np.array([4.0, 4, 8])))
    rows = upright((0, 0, 0), (0, 1, 0))
    pair = GuardedPair(head, guarded_on_part(vice(), BodyKind.FIXTURE), Changes.PLACE)
    # The nose is 100 over the tip; the path goes so far below the part that the head is within the left leg.
    inside = replace(rows, tip=rows.tip + np.array([-40.0, 0.0, -83.0]))
    asked = clearance(machine, inside, pair, np.zeros(3))
    found = asked.inside(np.zeros(3))
    assert found is not None
    assert found.distance == 0.0
    assert 0.0 < found.inside <= 10.0
    in_slot = replace(rows, tip=rows.tip + np.array([0.0, 0.0, -83.0]))
    asked = clearance(machine, in_slot, pair, np.zeros(3))
    assert asked.inside(np.zeros(3)) is None
    nearest = asked.nearest(np.zeros(3))
    assert nearest is not None
    assert nearest.distance == pytest.approx(17.0 - 10.0, abs=1e-6)  # its lower end over the ground of the slot


def test_a_short_way_near_a_body_is_not_skipped() -> None:
    """A row near a wall, a thousand far from it, and twelve that come nearer: most may be skipped, but not these."""
    machine = gantry([], (-900, -900, -600), (900, 900, 600))
    way = np.linspace(-300.0, 300.0, 1001)
    tips = np.column_stack((way, 400.0 - 250.0 * np.exp(-((way - 111.0) ** 2) / 8.0), np.zeros(1001)))
    tips[0, 1] = 200.0
    head = on_link("head", "spindle", box_mesh(np.array([-30.0, -30, 0]), np.array([20.0, 30, 90])))
    wall = on_link("wall", "workpiece", box_mesh(np.array([-900.0, -200, -500]), np.array([900.0, 0, 500])))
    asked = clearance(machine, upright(*tips.tolist()), GuardedPair(head, wall, Changes.PLACE), np.zeros(3))
    for zero in ([0.0, 0, 0], [50.0, -80, 30], [50.0, 200, 30]):
        found = asked.nearest(np.array(zero))
        assert found is not None
        assert found.distance == pytest.approx(tips[:, 1].min() + zero[1] - 30.0, abs=0.011)
        assert abs(way[asked.moments.row[found.moment]] - 111.0) <= 0.6 + 1e-9


def test_a_pair_counts_as_far_apart_as_its_weight_says() -> None:
    """A head 30 wide to the left, and a wall that ends at Y0: with Y0 at 50 they are 150 - 30 + 50 = 170 apart."""
    machine = gantry([], (-900, -900, -600), (900, 900, 600))
    head = on_link("head", "spindle", box_mesh(np.array([-30.0, -30, 0]), np.array([20.0, 30, 90])))
    wall = on_link("wall", "workpiece", box_mesh(np.array([-900.0, -200, -500]), np.array([900.0, 0, 500])))
    zero, other = np.array([0.0, 50.0, 0.0]), np.array([[0.0, 60.0, 0.0]])
    asked = clearance(
        machine, upright((0, 150, 0), (9, 150, 0)), GuardedPair(head, wall, Changes.PLACE, 8.0), np.zeros(3)
    )
    found = asked.nearest(zero)
    assert found is not None
    assert found.distance == pytest.approx(8.0 * 170.0)
    assert asked.nearest(zero, 8.0 * 170.0 - 1.0) is None
    witness = Witness.of(asked, found)
    assert witness.gaps(other).tolist() == pytest.approx([8.0 * 180.0])
    floor = witness.floor(zero)
    assert floor.height == pytest.approx(8.0 * 170.0)
    assert floor.slope.tolist() == pytest.approx([0.0, 8.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("seed", [3, 8])
def test_places_keep_their_margin_though_the_search_knows_no_limits_at_first(seed: int) -> None:
    machine, rows = swarf(load_machine("matsuura_mx330"), seed)
    path = TurnedPath.of(machine, next(choices_of(rows))[0], rows, np.zeros(3))
    bodies = guarded_machine(machine_bodies(machine))
    guard = Guard(guarded_pairs(machine, bodies).kept, np.zeros(len(rows), np.int64), {})
    cuts, others = path.at(0.0), path.at(0.0)
    assert not isinstance(cuts, Obstacle)
    assert not isinstance(others, Obstacle)
    start = largest_margin(others, np.zeros(3)).zero
    oriented = Oriented(path, guard, 0.0, 0.0, start)
    asked = oriented.asked(oriented.moments, Changes.PLACE)
    search = FarthestSearch(cuts, 1.0, start, ENOUGH, asked, lambda: asked)
    found = search.search(0.0)
    assert found is not None
    assert cuts.at(found.zero).margin >= 1.0 - 1e-6
    assert found.nearest.distance <= search.bound <= found.nearest.distance * 1.0076 + 1e-6
    assert cuts.at(search.settled()).margin >= 1.0 - 1e-6
