"""The surface of stock as points: its area, and how far it is from the design."""

import numpy as np
import pytest

from tests.support.sweeps import block, cut_path, path
from trunnion.simulation.stock.surface import stock_surface
from trunnion.simulation.stock.surface_points import surface_points
from trunnion.simulation.stock.vertex_deviation import vertex_deviation
from trunnion.simulation.tools.shapes import BodySizes, flat

BODY: BodySizes = {"flute_length": 30.0, "length": 60.0}


def test_area_and_deviation_of_a_slot_that_is_too_deep_and_one_that_is_missing() -> None:
    design, stock = (block((0.0, -10.0, -10.0), (20.0, 10.0, 0.0), 0.5) for _ in range(2))
    cut_path(design, path([(-20.0, 0.0, -6.0), (40.0, 0.0, -6.0)]), flat(8.0, **BODY))
    cut_path(design, path([(-20.0, 0.0, -7.0), (40.0, 0.0, -7.0)]), flat(2.0, **BODY))
    cut_path(stock, path([(-20.0, 0.0, -6.25), (40.0, 0.0, -6.25)]), flat(8.0, **BODY))
    points = surface_points(stock, (design.spans(0), design.spans(1), design.spans(2)))
    outside = 2 * 400 + 4 * 200 + 2 * 6.25 * (20 - 8)  # the slot takes its two ends away, and gives two walls
    assert points.area.sum() == pytest.approx(outside, rel=0.01)
    assert points.deviation is not None
    floor = np.isclose(points.place[:, 2], -6.25) & (np.abs(points.normal[:, 2]) > 0.9)
    deep = floor & (np.abs(points.place[:, 1]) > 1.2)
    shallow = floor & (np.abs(points.place[:, 1]) < 0.8)
    assert points.deviation[deep] == pytest.approx(-0.25)
    assert points.deviation[shallow] == pytest.approx(0.75)
    assert not points.deviation[np.isclose(points.place[:, 2], 0.0)].any()
    mesh = stock_surface(stock)
    off = vertex_deviation(points, mesh.vertices, stock.lattice)
    inner = np.isclose(mesh.vertices[:, 2], -6.25) & (np.abs(mesh.vertices[:, 0] - 10.0) < 9.0)
    assert off[inner & (np.abs(mesh.vertices[:, 1]) < 0.3)] == pytest.approx(0.75)
    assert off[inner & (np.abs(np.abs(mesh.vertices[:, 1]) - 2.5) < 0.6)] == pytest.approx(-0.25)
    assert surface_points(stock, None).deviation is None
