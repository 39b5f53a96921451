"""Distances of hulls against python-fcl, and pieces of bodies that are not convex."""

import fcl  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull  # type: ignore[import-untyped]
from scipy.spatial.transform import Rotation  # type: ignore[import-untyped]

from tests.support.brute_clearance import model_of
from tests.support.examples import examples
from tests.support.u_shapes import vice
from trunnion.arrays import Floats
from trunnion.placing.collisions.surfaces import SurfacePair
from trunnion.simulation.collisions.hull_gap import gaps_at, pose_gap
from trunnion.simulation.collisions.hull_pieces import mesh_pieces, section_pieces
from trunnion.simulation.collisions.hull_points import farthest, hull_points
from trunnion.simulation.collisions.queries import PairQuery, Solid
from trunnion.simulation.meshes import TriangleMesh, box_mesh, cylinder_mesh
from trunnion.simulation.tools.text import parse_tool

UP = np.array([0.0, 0.0, 1.0])


def hull_mesh(points: Floats) -> TriangleMesh:
    hull = ConvexHull(points)
    faces = hull.simplices.copy()
    inward = np.einsum(
        "ij,ij->i", np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]),
        hull.equations[:, :3],
    ) < 0.0  # fmt: skip
    faces[inward] = faces[inward][:, ::-1]
    return TriangleMesh(points, faces)


def joined(*meshes: TriangleMesh) -> TriangleMesh:
    """Meshes as one, each with its own corners."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    return TriangleMesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def fcl_distance(one: TriangleMesh, other: TriangleMesh, pose: Floats) -> float:
    a, b = fcl.CollisionObject(model_of(one)), fcl.CollisionObject(model_of(other))
    a.setTransform(fcl.Transform(pose[:3, :3], pose[:3, 3]))
    found = max(float(fcl.distance(a, b, fcl.DistanceRequest())), 0.0)
    return 0.0 if found > 0.0 and PairQuery(Solid(one), Solid(other)).contains(pose) else found


def random_pose(random: np.random.Generator, away: float) -> Floats:
    pose = np.eye(4)
    if random.random() < 0.7:  # else faces are parallel
        pose[:3, :3] = Rotation.random(random_state=random).as_matrix()
    pose[:3, 3] = np.round(random.uniform(-away, away, 3), random.integers(-1, 4))
    return pose


@settings(max_examples=examples(150), deadline=None)
@given(seed=st.integers(0, 10**9), kind=st.sampled_from(["boxes", "cylinders", "points"]))
def test_hulls_are_as_far_apart_as_their_meshes(seed: int, kind: str) -> None:
    random = np.random.default_rng(seed)

    def body() -> TriangleMesh:
        if kind == "boxes":
            return box_mesh(-np.round(random.uniform(1, 60, 3)), np.round(random.uniform(1, 60, 3)))
        if kind == "cylinders":
            return cylinder_mesh(random.uniform(1, 90), -30.0, random.uniform(-20, 50))
        return hull_mesh(random.normal(size=(random.integers(5, 40), 3)) * random.uniform(0.5, 30.0, 3))

    one, other, pose, direction = body(), body(), random_pose(random, 120.0), UP.copy()
    low, high = pose_gap(hull_points(one.vertices), hull_points(other.vertices), pose, direction)
    expected = fcl_distance(one, other, pose)
    assert high == pytest.approx(expected, abs=1e-5)
    assert high - 1e-5 <= max(low, 0.0) <= high
    if low > 0.0:  # the plane that it tells is between the hulls
        moved = one.vertices @ pose[:3, :3].T + pose[:3, 3]
        assert np.linalg.norm(direction) == pytest.approx(1.0)
        assert (moved @ direction).min() - (other.vertices @ direction).max() == pytest.approx(low, abs=1e-9)
    shifts = random.uniform(-50.0, 50.0, (5, 3))
    gaps = np.empty(5)
    gaps_at(hull_points(one.vertices), hull_points(other.vertices), pose, shifts, UP, gaps)
    for shift, gap in zip(shifts, gaps, strict=True):
        there = pose.copy()
        there[:3, 3] += shift
        assert gap == pytest.approx(fcl_distance(one, other, there), abs=1e-5)


def test_points_and_flat_hulls_have_distances_too() -> None:
    square = np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]])
    for point, expected in (([2.0, 2, 3], 3.0), ([7.0, 2, 0], 3.0), ([7.0, 8, 0], 5.0), ([1.0, 1, 0], 0.0)):
        found = pose_gap(hull_points(np.array([point])), hull_points(square), np.eye(4), UP.copy())
        assert found == pytest.approx((expected, expected), abs=1e-9)
        assert pose_gap(hull_points(square), hull_points(np.array([point])), np.eye(4), UP.copy())[1] == pytest.approx(
            expected, abs=1e-9
        )


def least_of_pieces(one: TriangleMesh, other: TriangleMesh, pose: Floats) -> float:
    """The least distance of the pieces of two meshes, with those of their surfaces that are not exact."""
    best = np.inf
    for a in mesh_pieces(one):
        for b in mesh_pieces(other):
            if a.exact and b.exact:
                best = min(best, pose_gap(a.hull, b.hull, pose, UP.copy())[1])
            else:
                best = min(best, SurfacePair(a, b).gap(pose).distance)
    return best


def test_meshes_fall_into_pieces_as_far_apart_as_they_are() -> None:
    assert vice().volume == pytest.approx(40.0 * (100.0 * 40.0 - 60.0 * 30.0))
    boxes = joined(box_mesh(np.zeros(3), np.full(3, 10.0)), box_mesh(np.full(3, 20.0), np.full(3, 35.0)))
    assert [piece.exact for piece in mesh_pieces(boxes)] == [True, True]
    assert any(not piece.exact for piece in mesh_pieces(vice()))  # its front is no rectangle
    random = np.random.default_rng(4)
    ring = joined(cylinder_mesh(30.0, 0.0, 8.0), box_mesh(np.array([-5.0, -5, 20]), np.array([5.0, 5, 60])))
    near = 0
    for _ in range(120):
        one = boxes if random.random() < 0.5 else ring
        pose = random_pose(random, 60.0)
        expected = fcl_distance(one, vice(), pose)
        near += 0.0 < expected < 20.0
        if expected > 0.0:
            assert least_of_pieces(one, vice(), pose) == pytest.approx(expected, abs=1e-4)
        else:
            inside = SurfacePair.depth_inside(one, vice(), pose)
            assert least_of_pieces(one, vice(), pose) < 1e-6 or inside is not None
    assert near > 30


def test_steps_of_a_holder_are_pieces_of_their_own() -> None:
    shape = parse_tool("1=ball:10,length=100,flutes=20,shank=10,holder=30x20/50x30", {})
    sections = [section_pieces(section, np.eye(4)) for section in shape.sections]
    assert all(piece.exact for pieces in sections for piece in pieces)
    holder = [piece for pieces in sections for piece in pieces if np.abs(piece.corners[:, 0]).max() > 14.9]
    assert {round(float(np.abs(piece.corners[:, 0]).max())) for piece in holder} == {15, 25}


@pytest.mark.third
@pytest.mark.parametrize("count", [1, 255, 256, 257, 1000, 4097])
def test_the_farthest_point_is_that_of_all(count: int) -> None:
    random = np.random.default_rng(count)
    points = random.normal(size=(count, 3)) * [100.0, 20.0, 1.0] + [5.0, -300.0, 7.0]
    hull = hull_points(points)
    assert np.array_equal(np.sort(hull.points, axis=0), np.sort(points, axis=0))
    directions = [*np.eye(3), *-np.eye(3), *random.normal(size=(50, 3))]
    for direction in directions:
        x, y, z = (direction / np.linalg.norm(direction)).tolist()
        far, at = farthest(hull, x, y, z)
        assert far == pytest.approx((points @ [x, y, z]).max(), abs=1e-9)
        assert hull.points[at] @ [x, y, z] == pytest.approx(far, abs=1e-9)
