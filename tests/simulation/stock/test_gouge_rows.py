"""The row of a gouge is that of the surface that is left there, not of what stands across the air beside it."""

import numpy as np

from trunnion.simulation.stock.deviation import _difference
from trunnion.simulation.stock.spans import Spans


def _spans(ends: list[float], rows: list[int] | None = None) -> Spans:
    count = len(ends) // 2
    normals = np.zeros((2 * count, 3), np.int8)
    normals[:, 2] = 127
    own = np.array(rows if rows is not None else [-1] * (2 * count), np.int32)
    return Spans(np.array([0, count]), np.array(ends), normals, rows=own)


def test_a_wall_across_a_pocket_did_not_cut_this_one() -> None:
    # Design: walls up to 10 and from 30; row 7 left the first one at 9.5, row 3 the other one where it should be.
    _, table = _difference(_spans([0.0, 10.0, 30.0, 40.0]), _spans([0.0, 9.5, 30.0, 40.0], [-1, 7, 3, -1]))
    assert table[:, :2].tolist() == [[9.5, 10.0]]
    assert table[:, 3:].tolist() == [[7.0, -1.0]]


def test_a_gouge_through_a_wall_is_that_of_both_surfaces() -> None:
    _, table = _difference(_spans([0.0, 10.0]), _spans([0.0, 4.0, 6.0, 10.0], [-1, 7, 8, -1]))
    assert table[:, 3:].tolist() == [[7.0, 8.0]]
