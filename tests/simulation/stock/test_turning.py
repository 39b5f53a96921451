"""Stock in the workpiece frame of the next set-up: quarter turns lose nothing, others less than half a cell."""

import math

import numpy as np
import pytest

from tests.support.sweeps import block, cut_path, path
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.turning import Pose, turned_stock
from trunnion.simulation.tools.shapes import BodySizes, ball, flat

BODY: BodySizes = {"flute_length": 30.0, "length": 60.0}
LOW, HIGH = np.array([0.0, -8.0, -10.0]), np.array([20.0, 12.0, 0.0])


@pytest.fixture(scope="module")
def slotted() -> Stock:
    """A block with a slot along X that is 6 mm wide and 4 mm deep."""
    stock = block((0.0, -8.0, -10.0), (20.0, 12.0, 0.0), 0.7)
    cut_path(stock, path([(-10.0, 0.0, -4.0), (30.0, 0.0, -4.0)]), flat(6.0, **BODY))
    return stock


def beyond(point: Floats) -> Floats:
    """How far points are from the surface of the slotted block, mm."""
    middle, half = 0.5 * (LOW + HIGH), 0.5 * (HIGH - LOW)
    outside = _to_box(point, middle, half)
    slot = _to_box(point, np.array([10.0, 0.0, 6.0]), np.array([30.0, 3.0, 10.0]))
    return np.asarray(np.abs(np.maximum(outside, -slot)))


def _to_box(point: Floats, middle: Floats, half: Floats) -> Floats:
    apart = np.abs(point - middle) - half
    return np.asarray(np.linalg.norm(np.maximum(apart, 0.0), axis=1) + np.minimum(apart.max(axis=1), 0.0))


def ends_of(stock: Stock) -> tuple[Floats, Floats]:
    """The ends of all stretches of stock in the workpiece frame, and the normals there."""
    points, normals = [], []
    for bundle in range(3):
        axes = list(BUNDLE_AXES[bundle])
        spans, (u, v) = stock.spans(bundle), stock.lattice.ray_positions(bundle)
        ray = np.repeat(np.arange(len(spans.first) - 1), 2 * np.diff(spans.first))
        point, normal = np.empty((len(ray), 3)), np.empty((len(ray), 3))
        point[:, axes] = np.column_stack((u[ray // len(v)], v[ray % len(v)], spans.ends))
        normal[:, axes] = spans.normals
        points.append(point)
        normals.append(normal)
    return np.concatenate(points), np.concatenate(normals)


@pytest.mark.parametrize("turn", [(0, 0, 0), (90, 0, 0), (180, 0, 0), (0, -90, 0), (0, 90, 270), (90, 180, 90)])
def test_quarter_turns_lose_nothing(turn: tuple[float, float, float]) -> None:
    stock = block((0.0, -8.0, -10.0), (20.0, 12.0, 0.0), 0.7)
    cut_path(stock, path([(-10.0, 0.0, -4.0), (30.0, 3.0, -4.0)]), ball(6.0, **BODY))
    pose = Pose((5.0, -7.25, 100.0), turn)
    turned = Stock.of_spans(*turned_stock(stock, pose, 0.1))
    assert turned.volume == pytest.approx(stock.volume, rel=1e-12)
    assert sorted(turned.lattice.counts) == sorted(stock.lattice.counts)
    point, normal = ends_of(stock)
    new_point, new_normal = ends_of(turned)
    wanted = np.column_stack((point @ pose.rotation.T + pose.origin, normal @ pose.rotation.T))
    found = np.column_stack((new_point, new_normal))
    order = [np.lexsort(np.round(each, 6).T) for each in (wanted, found)]
    assert np.allclose(wanted[order[0]], found[order[1]], atol=1e-9)
    assert (np.diff(turned.spans(0).ends[: 2 * turned.spans(0).first[1]]) > 0.0).all()


def test_a_turn_and_its_inverse_give_the_stock_back(slotted: Stock) -> None:
    there = Stock.of_spans(*turned_stock(slotted, Pose(turn=(90.0, 0.0, 90.0)), 0.7))
    back = Stock.of_spans(*turned_stock(there, Pose(turn=(0.0, -90.0, -90.0)), 0.7))
    for bundle in range(3):
        assert np.array_equal(back.spans(bundle).ends, slotted.spans(bundle).ends)
        assert np.array_equal(back.spans(bundle).first, slotted.spans(bundle).first)


@pytest.mark.parametrize("turn", [(30.0, 0.0, 0.0), (0.0, 0.0, 45.0), (17.0, 40.0, -110.0)])
def test_any_other_turn_loses_less_than_half_a_cell(slotted: Stock, turn: tuple[float, float, float]) -> None:
    pose = Pose((3.0, 4.0, 5.0), turn)
    turned = Stock.of_spans(*turned_stock(slotted, pose, 0.7))
    point, _ = ends_of(turned)
    off = beyond((point - pose.origin) @ pose.rotation)
    assert off.max() < 0.5 * 0.7
    assert np.median(off) < 1e-6  # planes and the edges between them stay
    assert turned.volume == pytest.approx(3520.0, rel=3e-3)  # its own rays are farther off


def test_a_ball_turned_stays_a_ball() -> None:
    stock = block((-6.0, -6.0, -6.0), (6.0, 6.0, 0.0), 0.4)
    cut_path(stock, path([(0.0, 0.0, 5.0), (0.0, 0.0, -4.0)]), ball(10.0, **BODY), 0.04)
    turned = Stock.of_spans(*turned_stock(stock, Pose(turn=(25.0, 10.0, 0.0)), 0.4))
    point, _ = ends_of(turned)
    old = point @ Pose(turn=(25.0, 10.0, 0.0)).rotation
    inside = (np.linalg.norm(old[:, :2], axis=1) < 4.5) & (old[:, 2] > -5.0)
    off = np.abs(np.linalg.norm(old[inside] - (0.0, 0.0, 1.0), axis=1) - 5.0)
    assert off.max() < 0.1 * 0.4


def test_the_turn_goes_about_x_then_y_then_z() -> None:
    assert np.allclose(Pose(turn=(90.0, 0.0, 0.0)).rotation @ (0, 1, 0), (0, 0, 1))
    assert np.allclose(Pose(turn=(90.0, 90.0, 0.0)).rotation @ (0, 1, 0), (1, 0, 0))
    assert np.allclose(Pose(turn=(0.0, 90.0, 90.0)).rotation @ (1, 0, 0), (0, 0, -1))
    assert math.isclose(np.linalg.det(Pose(turn=(12.0, 34.0, 56.0)).rotation), 1.0)


def test_nothing_left_cannot_be_turned() -> None:
    stock = block((0.0, 0.0, 0.0), (2.0, 2.0, 2.0), 0.5)
    cut_path(stock, path([(-10.0, 1.0, -1.0), (20.0, 1.0, -1.0)]), flat(10.0, **BODY))
    with pytest.raises(InputError, match="nothing is left of it"):
        turned_stock(stock, Pose(), 0.5)
