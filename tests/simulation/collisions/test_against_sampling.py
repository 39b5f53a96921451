"""Skipping by clearance against looking everywhere, over random machines and motions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.machine_strategies import machines
from trunnion.arrays import Floats
from trunnion.machines import Machine, link_transforms
from trunnion.machines.links import axes_between, link_chain
from trunnion.simulation.collisions.bodies import Body, BodyKind
from trunnion.simulation.collisions.clearance import joint_senses, motion_bounds, relative_pose
from trunnion.simulation.collisions.queries import PairQuery, Solid
from trunnion.simulation.collisions.watching import PairWatch
from trunnion.simulation.meshes import TriangleMesh, box_mesh, cylinder_mesh
from trunnion.timing import AxisPieces

#: Places of four rows, far enough apart for bodies to meet and part, and near enough to look everywhere.
paths = st.lists(
    st.lists(st.floats(-60.0, 60.0, allow_subnormal=False), min_size=5, max_size=5), min_size=5, max_size=5
)

links = st.sampled_from(["workpiece", "spindle", "bed", "J1", "J3"])


def pieces_of(joints: Floats) -> AxisPieces:
    n = len(joints) - 1
    zeros = np.zeros(n, np.int64)
    return AxisPieces(0, n, np.arange(n), np.zeros(n), np.ones(n), joints, zeros, np.ones(n, np.bool_), zeros > 0)


def seen_from(machine: Machine, one: str, other: str, joints: Floats) -> Floats:
    """Poses of one link in the frame of the other, by the links in the machine frame."""
    found = link_transforms(machine, joints)
    return np.asarray(np.linalg.inv(found[other]) @ found[one])


def between(joints: Floats, count: int) -> Floats:
    """Axis values at many places of each row, (rows * count, 5)."""
    share = (np.arange(count) / count)[None, :, None]
    return np.asarray((joints[:-1, None] + share * np.diff(joints, axis=0)[:, None]).reshape(-1, 5))


def meshes() -> tuple[TriangleMesh, TriangleMesh]:
    rod = cylinder_mesh(30.0, -50.0, 50.0, "rod", 0.5)
    return rod, box_mesh(np.array([20.0, -60.0, -40.0]), np.array([60.0, 60.0, 60.0]), "block")


@given(machines(), paths, links, links)
@settings(max_examples=examples(25), deadline=None)
def test_no_point_moves_further_than_the_bound(machine: Machine, path: list[list[float]], one: str, other: str) -> None:
    if not axes_between(machine, one, other):
        return
    joints, (rod, _) = np.array(path), meshes()
    solid_centre = rod.bounds.mean(axis=0)
    radius = float(np.linalg.norm(rod.vertices - solid_centre, axis=1).max())
    bounds = np.zeros(len(joints) - 1)
    senses = joint_senses(machine, one, other)
    motion_bounds(link_chain(machine), *senses, solid_centre, radius, joints, bounds)
    count = 16
    poses = seen_from(machine, one, other, np.concatenate((between(joints, count), joints[-1:])))
    points = np.einsum("nij,vj->nvi", poses[:, :3, :3], rod.vertices) + poses[:, None, :3, 3]
    for row in range(len(bounds)):
        own = points[row * count : (row + 1) * count + 1]
        steps = np.linalg.norm(np.diff(own, axis=0), axis=2).max(axis=1)
        # Also each part of a row keeps to its share.
        assert steps.max() <= bounds[row] / count + 1e-9
    pose = np.eye(4)
    relative_pose(link_chain(machine), *senses, joints[2], pose)
    np.testing.assert_allclose(pose, seen_from(machine, one, other, joints[2:3])[0], atol=1e-9)


@given(machines(), paths, links, links)
@settings(max_examples=examples(10), deadline=None)
def test_what_dense_sampling_finds_is_found(machine: Machine, path: list[list[float]], one: str, other: str) -> None:
    if not axes_between(machine, one, other):
        return
    joints, solids = np.array(path), tuple(map(Solid, meshes()))
    bodies = (
        Body("rod", one, solids[0].mesh, BodyKind.MACHINE),
        Body("block", other, solids[1].mesh, BodyKind.MACHINE),
    )
    watch = PairWatch(machine, ("",), bodies, (solids[0], solids[1]), 0.0, 0.5)
    watch.follow(pieces_of(joints[:3]))
    last = pieces_of(joints[2:])
    watch.follow(
        AxisPieces(2, 4, last.row + 2, last.begin, last.done, last.joints, last.tool, last.known, last.at_machine)
    )
    found = watch.findings()
    query, count = PairQuery(solids[0], solids[1]), 40
    poses = seen_from(machine, one, other, between(joints, count))
    deep = [(query.touches(pose) and query.depth(pose)[0]) or 0.0 for pose in poses]
    for k in np.flatnonzero(np.array(deep) > 1.0).tolist():
        at = k / count
        assert any(each.rows[0] + each.begin <= at + 0.05 and at - 0.05 <= each.rows[1] + 1 for each in found), at
    for each in found:
        place = each.rows[0] + each.begin
        pose = np.eye(4)
        row = min(int(place), len(joints) - 2)
        axes = joints[row] + (place - row) * (joints[row + 1] - joints[row])
        relative_pose(link_chain(machine), *joint_senses(machine, one, other), axes, pose)
        assert query.touches(pose) or query.contains(pose) or query.distance(pose) < 1e-6


@pytest.mark.parametrize(("height", "depth"), [(52.0, 2.0), (44.0, 9.0), (60.0, 0.0)])
def test_the_depth_of_a_rod_in_a_plate(height: float, depth: float) -> None:
    # 2 mm from the lower face where the rod ends there; 4 of the plate and 5 of the rod where it goes through.
    rod, plate = cylinder_mesh(10.0, -50.0, 50.0), box_mesh(np.array([-90.0, -90.0, 0.0]), np.array([90.0, 90.0, 8.0]))
    query = PairQuery(Solid(rod), Solid(plate))
    pose = np.eye(4)
    pose[2, 3] = height
    found, place = query.depth(pose)
    assert found == pytest.approx(depth, abs=0.03)
    assert 0.0 <= place[2] <= 8.0 or not depth
