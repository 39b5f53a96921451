"""How deep solids are in each other, and where they cross: by kernels that stop early, and by NumPy."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.naive.overlaps import crossings, deepest
from tests.support.simulating import cuboid
from trunnion.simulation.collisions.queries import crossing_box, deepest_point

seeds = st.integers(0, 2**32 - 1)


@given(seed=seeds)
@settings(max_examples=examples(50), deadline=None)
def test_the_box_of_all_crossings(seed: int) -> None:
    random = np.random.default_rng(seed)
    edges, faces = random.uniform(-1.0, 1.0, (2, 40, 3, 3))
    # Some lie in the plane of the other, or share a corner with it.
    edges[:5, :, 2] = faces[:5, :, 2] = 0.0
    edges[5:10, 0] = faces[5:10, 0]
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    crossing_box(edges, faces, low, high)
    points = crossings(edges, faces)
    assert len(points)
    assert np.allclose(low, points.min(axis=0), atol=1e-9)
    assert np.allclose(high, points.max(axis=0), atol=1e-9)


@given(seed=seeds, beside=st.booleans())
@settings(max_examples=examples(50), deadline=None)
def test_the_deepest_of_all_points(seed: int, beside: bool) -> None:
    random = np.random.default_rng(seed)
    mesh = cuboid((-3.0, -2.0, -1.0), (3.0, 2.0, 1.0))
    corners = np.ascontiguousarray(mesh.vertices[mesh.faces])
    points = random.uniform(-3.5, 3.5, (60, 3)) + (10.0 if beside else 0.0)
    place = np.zeros(3)
    depth = deepest_point(points, corners, place)
    wanted, at = deepest(points, corners)
    assert depth == wanted
    assert np.array_equal(place, at)
