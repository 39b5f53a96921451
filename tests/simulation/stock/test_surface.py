"""The surface of stock: closed whatever was cut, exact on planes, and sharp at edges."""

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.solid_booleans import as_solid
from tests.support.sweeps import block, cut_path, path
from trunnion.simulation.meshes import TriangleMesh, load_mesh, save_mesh
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import mesh_spans
from trunnion.simulation.stock.surface import stock_surface
from trunnion.simulation.tools.shapes import BodySizes, ball, flat

BODY: BodySizes = {"flute_length": 30.0, "length": 60.0}


def is_closed(mesh: TriangleMesh) -> bool:
    """Whether every edge belongs to two facets that run along it in opposite directions."""
    edges = np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    there = edges[:, 0] * len(mesh.vertices) + edges[:, 1]
    back = edges[:, 1] * len(mesh.vertices) + edges[:, 0]
    return len(np.unique(there)) == len(there) and np.array_equal(np.sort(there), np.sort(back))


@pytest.mark.parametrize("cell", [1.0, 0.7, 0.3])
def test_a_slot_has_sharp_edges_and_its_volume(cell: float) -> None:
    stock = block((0.0, -20.0, -10.0), (50.0, 20.0, 0.0), cell)
    cut_path(stock, path([(-20.0, 0.0, -5.0), (70.0, 0.0, -5.0)]), flat(10.0, **BODY), cell / 10)
    mesh = stock_surface(stock)
    assert is_closed(mesh)
    assert mesh.volume == pytest.approx(17500.0, abs=0.01)
    assert np.allclose(mesh.bounds, [[0.0, -20.0, -10.0], [50.0, 20.0, 0.0]])
    corner = mesh.vertices[
        (np.abs(np.abs(mesh.vertices[:, 1]) - 5.0) < 0.4 * cell) & (np.abs(mesh.vertices[:, 2] + 5.0) < 0.4 * cell)
    ]
    assert len(corner) > 20
    assert np.abs(np.abs(corner[:, 1]) - 5.0).max() < 1e-6
    assert np.abs(corner[:, 2] + 5.0).max() < 1e-6


def test_a_ball_leaves_its_sphere() -> None:
    stock = block((-10.0, -10.0, -10.0), (10.0, 10.0, 0.0), 0.5)
    cut_path(stock, path([(0.0, 0.0, 5.0), (0.0, 0.0, -4.0)]), ball(12.0, **BODY), 0.05)
    mesh = stock_surface(stock)
    inside = mesh.vertices[np.linalg.norm(mesh.vertices - (0.0, 0.0, 2.0), axis=1) < 6.3]
    off = np.linalg.norm(inside - (0.0, 0.0, 2.0), axis=1) - 6.0
    assert is_closed(mesh)
    assert len(inside) > 300
    assert np.abs(off[inside[:, 2] < -0.5]).max() < 0.02
    cap = math.pi * 4.0**2 * (3.0 * 6.0 - 4.0) / 3.0
    assert mesh.volume == pytest.approx(4000.0 - cap, rel=2e-3)


@pytest.mark.third
@pytest.mark.parametrize("cell", [1.0, 0.7, 0.3])
@pytest.mark.parametrize("depth", [0.05, 0.3, 1.0])
def test_a_shallow_groove_leaves_the_faces_of_the_stock_where_they_are(cell: float, depth: float) -> None:
    low, high = (0.0, -20.0, -10.0), (50.0, 20.0, 0.0)
    stock = block(low, high, cell)
    cut_path(stock, path([(-20.0, 0.0, -depth), (70.0, 3.0, -depth)]), ball(10.0, **BODY), cell / 10)
    vertices = stock_surface(stock).vertices
    assert (vertices >= low).all()
    assert (vertices <= high).all()
    inside = vertices[(vertices[:, 0] > 5.0) & (vertices[:, 0] < 45.0) & (vertices[:, 2] > -9.0)]
    inside = inside[np.abs(inside[:, 1]) < 19.0]
    along = np.array([90.0, 3.0]) / math.hypot(90.0, 3.0)
    aside = (inside[:, 0] + 20.0) * along[1] - inside[:, 1] * along[0]
    off = np.maximum(inside[:, 2], 5.0 - np.hypot(aside, inside[:, 2] - 5.0 + depth))
    assert len(inside) > 500
    assert np.abs(off).max() < 0.05 * cell
    assert np.abs(off[np.abs(aside) > 5.0]).max() == 0.0


@settings(max_examples=examples(12))
@given(st.integers(0, 10_000))
def test_whatever_was_cut_the_surface_is_closed(seed: int) -> None:
    stock = cut_by_chance(seed)
    mesh = stock_surface(stock)
    assert is_closed(mesh)
    assert mesh.volume == pytest.approx(stock.volume, rel=0.03)


@pytest.mark.third
@pytest.mark.parametrize("seed", [9, 32])  # cubes that had the same vertex, one of them by half a nanometre
@pytest.mark.parametrize("ending", [".stl", ".ply", ".3mf", ".glb"])
def test_what_is_saved_is_a_solid_for_others_that_make_equal_corners_one(
    tmp_path: Path, seed: int, ending: str
) -> None:
    mesh = stock_surface(cut_by_chance(seed))
    path = tmp_path / f"stock{ending}"
    save_mesh(mesh, path)
    own = load_mesh(path, closed=True)
    assert is_closed(own)
    if ending != ".3mf":
        theirs = trimesh.load_mesh(path)
        theirs.merge_vertices()
        assert theirs.is_watertight
        assert theirs.is_winding_consistent
    assert as_solid(own).volume() == pytest.approx(mesh.volume, rel=1e-5)


def cut_by_chance(seed: int) -> Stock:
    """A block after twelve motions of small tools."""
    random = np.random.default_rng(seed)
    stock = block((-6.0, -6.0, -6.0), (6.0, 6.0, 0.0), 0.6)
    for _ in range(12):
        axis = random.normal(size=3) * (0.5, 0.5, 0.2) + (0.0, 0.0, 1.0)
        start = random.uniform(-6.0, 6.0, 3) * (1.0, 1.0, 0.4) - (0.0, 0.0, 2.0)
        tips = np.array([start, start + 3.0 * random.normal(size=3)])
        shape = flat(1.5, **BODY) if random.random() < 0.5 else ball(2.0, **BODY)
        cut_path(stock, path(tips, np.array([axis, axis])), shape)
    return stock


def test_a_surface_is_stock_again() -> None:
    stock = block((0.0, -20.0, -10.0), (50.0, 20.0, 0.0), 1.0)
    cut_path(stock, path([(-20.0, 0.0, -5.0), (70.0, 0.0, -5.0)]), flat(10.0, **BODY))
    mesh, lattice = stock_surface(stock), stock.lattice
    spans = [mesh_spans(mesh.vertices, mesh.faces, lattice, bundle) for bundle in range(3)]
    again = Stock.of_spans(lattice, (spans[0], spans[1], spans[2]))
    assert [each.leaks for each in spans] == [0, 0, 0]
    assert again.volume == pytest.approx(stock.volume, rel=1e-6)
