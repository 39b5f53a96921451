"""Cutting against the booleans of a library of solids: volume, surface, and the ends of rays."""

import functools
import math
from collections.abc import Iterator

import numpy as np
import pytest
from manifold3d import Manifold

from tests.support.solid_booleans import as_solid, box, crossings, cutter, difference, swept
from tests.support.sweeps import block, cut_path, path
from trunnion.arrays import Floats
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.surface import stock_surface
from trunnion.simulation.tools.shapes import BodySizes, ball, bull, flat

BODY: BodySizes = {"flute_length": 30.0, "length": 60.0}
LOW, HIGH = (0.0, 0.0, -9.0), (24.0, 18.0, 0.0)  # a corner at the origin of X and Y; 0.7 and 0.45 divide no side
CELLS = [1.0, 0.7, 0.45]

#: How far the facets of the judge are off, mm.
FACETS = 0.005

LINES = np.array([(4.0, 5.0, 3.0), (6.0, 6.0, -3.0), (19.0, 8.0, -5.0), (15.0, 13.0, -2.0)])
HELIX = np.array([(12.0 + 4 * math.cos(a), 9.0 + 4 * math.sin(a), 1.0 - a) for a in np.linspace(0.0, 6.0, 13)])
SWEEPS = {
    "flat, lines": (flat(6.0, **BODY), LINES, (0.0, 0.0, 1.0)),
    "bull, leaning": (bull(8.0, 2.0, **BODY), LINES, (0.3, -0.5, 1.0)),
    "ball, leaning": (ball(6.0, **BODY), LINES, (-0.6, 0.4, 1.0)),
    "flat, across": (flat(5.0, **BODY), LINES - (0.0, 0.0, 3.0), (0.0, 1.0, 0.05)),
    "ball, helix": (ball(5.0, **BODY), HELIX, (0.0, 0.0, 1.0)),
}


def rays(stock: Stock, step: int) -> Iterator[tuple[Floats, Floats, Floats, Floats]]:
    """Some rays: begin and end a millimetre beyond the box, the ends of their stretches from there, mm, and how far
    across the surface there a step along the ray is."""
    low, high = stock.lattice.low, stock.lattice.high
    for bundle, (u, v, w) in enumerate(BUNDLE_AXES):
        spans, (across, up) = stock.spans(bundle), stock.lattice.ray_positions(bundle)
        for ray in range(bundle, len(across) * len(up), step):
            begin, end = np.empty(3), np.empty(3)
            begin[[u, v, w]] = across[ray // len(up)], up[ray % len(up)], low[w] - 1.0
            end[[u, v, w]] = begin[u], begin[v], high[w] + 1.0
            own = slice(2 * spans.first[ray], 2 * spans.first[ray + 1])
            yield begin, end, spans.ends[own] - begin[w], np.abs(spans.normals[own, 2]) / 127.0


@functools.cache
def left_by_booleans(name: str) -> tuple[Manifold, float]:
    """What is exactly left of the stock, and the area of what was taken, mm²."""
    shape, tips, axis = SWEEPS[name]
    whole, gone = box(LOW, HIGH), swept(cutter(shape), tips, axis)
    return whole - gone, float((whole ^ gone).surface_area())


@pytest.mark.third
@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("name", SWEEPS)
def test_what_is_left_is_what_booleans_leave(name: str, cell: float) -> None:
    shape, tips, axis = SWEEPS[name]
    stock, tolerance = block(LOW, HIGH, cell), 0.1 * cell
    cut_path(stock, path(tips, np.tile(axis, (len(tips), 1))), shape, tolerance)
    exact, area = left_by_booleans(name)
    # A plane between the rays of two bundles may be half a cell off in both, and is exact in the third.
    assert abs(stock.volume - exact.volume()) <= (cell / 3.0 + tolerance) * area
    # The mesh is exact on planes, and within a twentieth of a cell on round surfaces.
    assert difference(as_solid(stock_surface(stock)), exact) <= 0.05 * cell * area
    # Along a ray nothing is rounded to the cell, and corners of tools are cones within the tolerance.
    off, grazing = list[float](), 0
    for begin, end, ends, across in rays(stock, int(8 / cell**2)):
        hits = crossings(exact, begin, end)
        if len(hits) != len(ends):  # it grazes what was cut
            grazing += 1
            continue
        off += (np.abs(np.array(hits) - ends) * across).tolist()
    assert len(off) > 200
    assert grazing <= 0.01 * len(off)
    assert max(off) <= tolerance + FACETS
