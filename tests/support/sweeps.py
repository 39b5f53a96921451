"""Stock and short motions of tools, without a program; and a slow twin that stamps the tool densely."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from trunnion.arrays import Floats
from trunnion.simulation.cutting.measurements import Chunk, RowsCut, rows_cut
from trunnion.simulation.cutting.removal import Cutter
from trunnion.simulation.cutting.sweeps import RowSweeps
from trunnion.simulation.stock.lattice import BUNDLE_AXES, Lattice
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import box_spans
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import Role, ToolShape

#: A cube of 1 mm: its corners, and its faces, which turn left seen from outside.
CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CUBE_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]], np.int64,
)  # fmt: skip


def block(low: tuple[float, float, float], high: tuple[float, float, float], cell: float) -> Stock:
    """A box of stock."""
    lattice = Lattice.of_box(np.array(low), np.array(high), cell)
    return Stock.of_spans(lattice, (box_spans(lattice, 0), box_spans(lattice, 1), box_spans(lattice, 2)))


def path(tips: list[tuple[float, float, float]] | Floats, axes: Floats | None = None) -> RowSweeps:
    """A path as sweeps, one for each row; the tool axis is Z where none is given."""
    points = np.array(tips, np.float64)
    if axes is None:
        axes = np.tile((0.0, 0.0, 1.0), (len(points), 1))
    axes = axes / np.linalg.norm(axes, axis=1)[:, None]
    rows = np.arange(len(points) - 1)
    return RowSweeps(0, len(rows), 1, rows, points[:-1], points[1:], axes[:-1], axes[1:])


def divided(tips: Floats, axes: Floats, pieces: int) -> tuple[Floats, Floats]:
    """The same path with every motion in pieces, as the rows of a run are divided."""
    at = np.linspace(0.0, len(tips) - 1, pieces * (len(tips) - 1) + 1)
    k = np.minimum(at.astype(np.int64), len(tips) - 2)
    s = (at - k)[:, None]
    return (1.0 - s) * tips[k] + s * tips[k + 1], (1.0 - s) * axes[k] + s * axes[k + 1]


def cut_path(
    stock: Stock,
    sweeps: RowSweeps,
    shape: ToolShape,
    tolerance: float = 0.01,
    threads: int = 1,
    cutter: Cutter | None = None,
    idle: bool = False,
) -> RowsCut:
    """Cut stock with a path."""
    pieces, _ = revolved_pieces(shape, tolerance)
    with ThreadPoolExecutor(threads) as executor:
        at_rest = np.full(sweeps.end, idle)
        tiles = (cutter or Cutter(stock, None, tolerance)).measure(sweeps, pieces, executor, at_rest)
        (found,) = rows_cut([Chunk(sweeps.first, sweeps.end, sweeps.tool, tiles)], {sweeps.tool: pieces})
        return found


def bundle_volumes(stock: Stock) -> list[float]:
    """The volume as each bundle sees it, mm³."""
    return [sum(stock.cell_area(k) * tile.volume_per_area() for tile in stock.bundle(k)) for k in range(3)]


def stamped_depth(points: Floats, sweeps: RowSweeps, shape: ToolShape, stamps: int = 200) -> Floats:
    """How far points are within the cutter in any of many poses, (n,), mm; negative outside.

    The distance is that to the outline, across it: never more than the real one inside.
    """
    deepest = np.full(len(points), -np.inf)
    for k in range(len(sweeps.row)):
        for s in np.linspace(0.0, 1.0, stamps):
            axis = (1.0 - s) * sweeps.axis[k] + s * sweeps.end_axis[k]
            axis = axis / np.linalg.norm(axis)
            way = points - ((1.0 - s) * sweeps.start[k] + s * sweeps.end_tip[k])
            z = way @ axis
            radius = np.linalg.norm(way - z[:, None] * axis, axis=1)
            np.maximum(deepest, _within(shape, radius, z), out=deepest)
    return deepest


def _within(shape: ToolShape, radius: Floats, z: Floats) -> Floats:
    found = np.full(len(z), -np.inf)
    for section in shape.sections:
        if section.role is not Role.CUTTER:
            continue
        for element in section.outline:
            low, high = element.start[1], element.end[1]
            inside = (z >= low) & (z <= high) & (high > low)
            if inside.any():
                edge = np.array([element.radius_at(float(value)) for value in z[inside]])
                ends = np.minimum(z[inside] - section.bottom, section.top - z[inside])
                found[inside] = np.maximum(found[inside], np.minimum(edge - radius[inside], ends))
    return found


def ray_points(stock: Stock, bundle: int, ray_step: int, along: int) -> tuple[Floats, list[bool]]:
    """Points along some rays of a bundle, (n, 3), and whether there is material."""
    points, material = [], []
    w = BUNDLE_AXES[bundle][2]
    heights = np.linspace(stock.lattice.low[w], stock.lattice.high[w], along + 2)[1:-1]
    for tile in stock.bundle(bundle):
        for ray in range(0, len(tile.count), ray_step):
            for height in heights:
                place = np.empty(3)
                place[list(BUNDLE_AXES[bundle])] = tile.u[ray // len(tile.v)], tile.v[ray % len(tile.v)], height
                points.append(place)
                ends = tile.ends[ray, : 2 * tile.count[ray]].reshape(-1, 2)
                material.append(bool(((ends[:, 0] < height) & (height < ends[:, 1])).any()))
    return np.array(points), material
