"""The row of a gouge is that of the surface that is left there, not of what stands across the air beside it."""

import numpy as np

from tests.support.sweeps import block, cut_path, path
from trunnion.simulation.stock.deviation import missing_from
from trunnion.simulation.stock.differences import difference
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans
from trunnion.simulation.tools.shapes import BodySizes, flat

BODY: BodySizes = {"flute_length": 30.0, "length": 60.0}


def _spans(ends: list[float], rows: list[int] | None = None) -> Spans:
    count = len(ends) // 2
    normals = np.zeros((2 * count, 3), np.int8)
    normals[:, 2] = 127
    own = np.array(rows if rows is not None else [-1] * (2 * count), np.int32)
    return Spans(np.array([0, count]), np.array(ends), normals, rows=own)


def test_a_wall_across_a_pocket_did_not_cut_this_one() -> None:
    # Design: walls up to 10 and from 30; row 7 left the first one at 9.5, row 3 the other one where it should be.
    _, table = difference(_spans([0.0, 10.0, 30.0, 40.0]), _spans([0.0, 9.5, 30.0, 40.0], [-1, 7, 3, -1]))
    assert table[:, :2].tolist() == [[9.5, 10.0]]
    assert table[:, 3:5].tolist() == [[7.0, -1.0]]


def test_a_gouge_through_a_wall_is_that_of_both_surfaces() -> None:
    _, table = difference(_spans([0.0, 10.0]), _spans([0.0, 4.0, 6.0, 10.0], [-1, 7, 8, -1]))
    assert table[:, 3:5].tolist() == [[7.0, 8.0]]


def test_floor_and_wall_gouged_at_once_are_as_deep_as_each() -> None:
    design = block((0.0, -10.0, -10.0), (20.0, 10.0, 0.0), 0.5)
    cut_path(design, path([(-20.0, 0.0, -6.0), (40.0, 0.0, -6.0)]), flat(8.0, **BODY))
    wanted = design.spans(0), design.spans(1), design.spans(2)
    stock = block((0.0, -10.0, -10.0), (20.0, 10.0, 0.0), 0.5)
    start = stock.spans(0), stock.spans(1), stock.spans(2)
    cut_path(stock, path([(-20.0, 0.5, -6.5), (40.0, 0.5, -6.5)]), flat(8.0, **BODY))
    gouge, _ = missing_from(stock, start, wanted, 0.05)
    # Rays along the edge see all 20 mm, rays down the wall 6.5 mm: the corner is 0.71 mm from the edge that is gone.
    assert 0.49 < gouge.largest < 0.72


def test_who_took_what_is_gone_altogether() -> None:
    low, high = (0.0, -10.0, -10.0), (20.0, 10.0, 0.0)
    stock = block(low, high, 0.5)
    start = stock.spans(0), stock.spans(1), stock.spans(2)
    pin = block((4.25, -3.75, -10.0), (6.25, -1.75, 0.0), 0.5)  # on rays of the same lattice
    wanted = tuple(_moved_spans(stock, pin, bundle) for bundle in range(3))
    wide = flat(12.0, **BODY)
    cut_path(stock, path([(-20.0, 0.0, -12.0), (40.0, 0.0, -12.0)]), wide)
    cut_path(stock, path([(-20.0, 0.0, -12.0), (40.0, 0.0, -12.0)]), flat(40.0, **BODY))
    gouge, rows = missing_from(stock, start, (wanted[0], wanted[1], wanted[2]), 0.05)
    assert gouge.largest > 1.0
    assert not len(rows.row)
    assert rows.whole is not None
    assert len(rows.whole[2].ends)


def _moved_spans(stock: Stock, pin: Stock, bundle: int) -> Spans:
    """The spans of a box along the rays of other stock."""
    u, v = stock.lattice.ray_positions(bundle)
    one, two, along = BUNDLE_AXES[bundle]
    low, high = pin.lattice.low, pin.lattice.high
    inside = ((u >= low[one]) & (u <= high[one]))[:, None] & ((v >= low[two]) & (v <= high[two]))[None]
    counts = inside.ravel().astype(np.int64)
    ends = np.tile((low[along], high[along]), int(counts.sum()))
    normals = np.tile(np.array([[0, 0, -127], [0, 0, 127]], np.int8), (int(counts.sum()), 1))
    return Spans(np.concatenate(([0], np.cumsum(counts))), ends, normals)
