"""Rays through boxes, cylinders and meshes: the same solid is the same however it is given."""

import math

import numpy as np
import pytest

from tests.support.sweeps import CUBE, CUBE_FACES
from trunnion.arrays import Floats, Ints
from trunnion.simulation.stock.lattice import Lattice
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import box_spans, cylinder_spans, mesh_spans


def prism(corners: int) -> tuple[Floats, Ints]:
    """An upright prism of diameter 20 and height 10, its faces turning left seen from outside."""
    angle = 2.0 * math.pi * np.arange(corners) / corners
    ring = np.column_stack((10.0 * np.cos(angle), 10.0 * np.sin(angle), np.zeros(corners)))
    points = np.concatenate((ring, ring + np.array([0.0, 0.0, 10.0]), [[0.0, 0.0, 0.0], [0.0, 0.0, 10.0]]))
    k = np.arange(corners)
    j = (k + 1) % corners
    low, high = np.full(corners, 2 * corners), np.full(corners, 2 * corners + 1)
    sides = (k, j, j + corners), (k, j + corners, k + corners)
    ends = (j, k, low), (k + corners, j + corners, high)
    return points, np.concatenate([np.column_stack(faces) for faces in (*sides, *ends)])


@pytest.mark.parametrize("bundle", range(3))
def test_a_box_is_the_same_as_a_mesh(bundle: int) -> None:
    # Corners, edges and diagonals of the faces lie on rays.
    lattice = Lattice.of_box(np.array([0.0, -1.0, 0.0]), np.array([20.0, 19.0, 10.0]), 1.0)
    as_mesh = mesh_spans(CUBE * (20.0, 20.0, 10.0) - (0.0, 1.0, 0.0), CUBE_FACES, lattice, bundle)
    as_box = box_spans(lattice, bundle)
    assert as_mesh.leaks == 0
    assert np.array_equal(as_mesh.first, as_box.first)
    assert as_mesh.ends == pytest.approx(as_box.ends)
    assert np.array_equal(as_mesh.normals, as_box.normals)


@pytest.mark.parametrize("cell", [1.0, 0.7])
def test_a_cylinder_is_the_same_as_a_fine_prism(cell: float) -> None:
    points, faces = prism(720)
    lattice = Lattice.of_box(np.array([-10.0, -10.0, 0.0]), np.array([10.0, 10.0, 10.0]), cell)
    for bundle in range(3):
        as_mesh, exact = mesh_spans(points, faces, lattice, bundle), cylinder_spans(lattice, bundle)
        same = np.diff(as_mesh.first) == np.diff(exact.first)
        assert as_mesh.leaks == 0
        assert same.mean() > 0.99  # rays that graze the prism may miss it
        if same.all():
            assert as_mesh.ends == pytest.approx(exact.ends, abs=0.01)
            assert np.abs(as_mesh.normals.astype(int) - exact.normals).max() <= 3


def test_the_volume_of_a_cylinder_is_that_of_its_rays() -> None:
    lattice = Lattice.of_box(np.array([-10.0, -10.0, 0.0]), np.array([10.0, 10.0, 10.0]), 0.25)
    stock = Stock.of_spans(
        lattice, (cylinder_spans(lattice, 0), cylinder_spans(lattice, 1), cylinder_spans(lattice, 2))
    )
    assert stock.volume == pytest.approx(1000.0 * math.pi, rel=2e-3)


def test_solids_that_overlap_are_one() -> None:
    lattice = Lattice.of_box(np.array([0.0, 0.0, 0.0]), np.array([20.0, 10.0, 10.0]), 1.0)
    points = np.concatenate((CUBE * (12.0, 10.0, 10.0), CUBE * (12.0, 10.0, 10.0) + (8.0, 0.0, 0.0)))
    faces = np.concatenate((CUBE_FACES, CUBE_FACES + 8))
    for bundle in range(3):
        assert mesh_spans(points, faces, lattice, bundle).ends == pytest.approx(box_spans(lattice, bundle).ends)


def test_rays_through_a_hole_of_a_mesh_are_left_empty_and_counted() -> None:
    lattice = Lattice.of_box(np.array([0.0, 0.0, 0.0]), np.array([10.0, 10.0, 10.0]), 1.0)
    spans = mesh_spans(CUBE * 10.0, CUBE_FACES[1:], lattice, 0)
    assert 45 <= spans.leaks <= 55  # half of the rays, and those through the diagonal
    assert len(spans.ends) == 2 * (100 - spans.leaks)
