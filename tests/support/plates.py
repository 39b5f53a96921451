"""Plates without thickness that a tool keeps clear of, passes between them, and a slender tool."""

import numpy as np

from trunnion.arrays import Floats
from trunnion.impeller.paths.cell_trees import STEPS, cell_tree, joined
from trunnion.impeller.paths.clearance import Obstacles
from trunnion.impeller.paths.clearance_kernel import BodyData
from trunnion.impeller.paths.passes import Pass, PassFamily, Way
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import BodyPiece, ball


def necked(diameter: float, neck: float, length: float = 45.0) -> ToolShape:
    return ball(
        diameter,
        flute_length=2.5 * diameter,
        length=length,
        neck_diameter=0.9 * diameter,
        neck_length=neck,
        shank_diameter=6.0,
        holder=(BodyPiece(20, 24, 30), BodyPiece(40, 40, 20)),
    )


def sheet(corner: Floats, one: Floats, other: Floats, counts: tuple[int, int] = (32, 32)) -> Floats:
    """A grid of points of a parallelogram, without thickness."""
    s, t = np.meshgrid(*(np.linspace(0.0, 1.0, STEPS * count + 1) for count in counts), indexing="ij")
    points = corner + s[..., None] * one + t[..., None] * other
    return np.concatenate((points, np.zeros((*s.shape, 1))), axis=2)


def bodies(*grids: Floats) -> Obstacles:
    trees = [
        cell_tree(grid, np.ones(((grid.shape[0] - 1) // STEPS, (grid.shape[1] - 1) // STEPS), bool)) for grid in grids
    ]
    cells, children, roots = joined(trees)
    turns = np.tile([1.0, 0.0], (len(grids), 1))
    return Obstacles(BodyData(cells, children, roots, turns), tuple(f"plate {k + 1}" for k in range(len(grids))))


def rows(centre: Floats, normal: Floats, shares: Floats) -> PassFamily:
    """Passes (m, n, 3) as a family: along them, and across by shares."""
    along = np.linspace(0.0, 1.0, centre.shape[1])
    passes = [
        Pass(line, np.broadcast_to(normal, line.shape), np.column_stack((along, np.full(len(along), share))))
        for line, share in zip(centre, shares, strict=True)
    ]
    return PassFamily(tuple(passes), 2.0, Way.BOTH_WAYS)


def floor(width: float, count: int = 3, length: float = 40.0) -> PassFamily:
    """Rows along x on the floor z = 0 of a slot about y = 0, so wide for centres."""
    x, y = np.linspace(0.0, length, 21), np.linspace(-width / 2.0, width / 2.0, count)
    centre = np.stack([np.column_stack((x, np.full(21, one), np.full(21, 2.0))) for one in y])
    return rows(centre, np.array([0.0, 0.0, 1.0]), np.linspace(0.0, 1.0, count))


def slot(half: float, height: float, lean: float = 0.0) -> Obstacles:
    """Two plates about y = 0 whose feet are ``half`` from it; both lean outward, so that they make a wedge."""
    up = height * np.array([0.0, np.tan(lean), 1.0])
    side = np.array([440.0, 0.0, 0.0])
    left = sheet(np.array([-200.0, half, 0.0]), side, up)
    right = sheet(np.array([-200.0, -half, 0.0]), side, up * np.array([1.0, -1.0, 1.0]))
    return bodies(left, right)


def bent_slot(half: float, height: float, lean: float) -> Obstacles:
    """A slot about y = 0 whose sides lean to the right, degrees, and from x = 20 on to the left."""
    grids = []
    for begin, angle in ((-200.0, -lean), (20.0, lean)):
        up = height * np.array([0.0, np.tan(np.radians(angle)), 1.0])
        side = np.array([220.0, 0.0, 0.0])
        grids += [sheet(np.array([begin, y, 0.0]), side, up) for y in (half, -half)]
    return bodies(*grids)
