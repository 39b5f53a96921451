"""Flank milling of one side of an impeller's blade: the ball at the cutter's end goes along the hub.

In:     an impeller, one of its blades in its own, unturned frame, and a cutter.
Out:    ``BladeFlank``: the path, what it leaves, how far the cutter stays from hub and other blades; a pass.
Units:  mm.

The flank begins where a ball touches blade and hub: the ball at the cutter's end, or that of the fillet where it is
larger. It ends at the tip. Where the fillet takes up nearly all of a low blade, it is not milled with the flank.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.flank.fit import Floor, Limits
from trunnion.impeller.flank.flanks import Flank
from trunnion.impeller.flank.milling import FlankCut, mill_flank
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.paths.passes import Pass
from trunnion.impeller.progress import Progress, silent
from trunnion.messages import Wording
from trunnion.records import dataclass

#: A flank ends where the fillet takes up more than this part of the blade's height.
_LOW: Final = 0.75

#: Poses and places along the axis at which the distances to hub and other blades are sampled.
_POSES: Final = 161
_PLACES: Final = 41

#: Poses of the pass that is linked to others.
_OF_PASS: Final = 401

#: Part of the overcut's limit that a fit is given, and how far from the hub it stays, mm.
_KEPT: Final = 0.95
_OFF_HUB: Final = 0.002

#: Halvings that find where a flank begins.
_HALVINGS: Final = 40


@dataclass(frozen=True, slots=True, eq=False)
class BladeFlank:
    """One side of a blade, milled with the side of the cutter.

    cut        the path and what it leaves
    side       +1: that of the mean surface's normal; -1
    until      w at which the flank ends, 1 at the trailing edge: what is beyond is left to another step
    hub        least distance of the cutter's surface to the hub, mm; below 0: it cuts into it
    neighbour  least distance of the cutter's surface to another blade, mm; below 0: it does not pass between them
    """

    cut: FlankCut
    side: float
    until: float
    hub: float
    neighbour: float

    def as_pass(self) -> tuple[Pass, Floats]:
        """Return the pass of the ball at the cutter's end, and the tool's axes (n, 3), for ``paths.linking``.

        Normals point from the blade to the cutter: across the axis and the way.

        Raises ``InputError`` if the cutter would cut into another blade.
        """
        if self.neighbour < 0.0:
            raise InputError(
                Problem("flank milling", 0, Wording("IMP326", "cutter_does_not", neighbour=-self.neighbour))
            )
        at = np.linspace(0.0, 1.0, _OF_PASS)
        centre, axis = self.cut.path.poses(at)
        way = np.gradient(centre, axis=0)
        normal = np.cross(way, axis) * self.side
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        return Pass(centre, normal, np.column_stack((at, np.zeros(len(at))))), axis

    def minutes(self, feed: float) -> float:
        """How long the pass takes at a feed of the ball's centre, mm/min, without leads."""
        centre = self.cut.path.poses(np.linspace(0.0, 1.0, 2001))[0]
        return float(np.linalg.norm(np.diff(centre, axis=0), axis=1).sum()) / feed


def mill_blade_flank(
    impeller: Impeller,
    blade: Blade,
    side: float,
    cutter: FlankCutter,
    overcut: float = 0.01,
    progress: Progress = silent,
) -> BladeFlank:
    """Fit the path for one side (+1 or -1) of a blade: the least undercut with no more overcut than allowed, mm.

    Raises ``InputError`` if the fillet takes up the blade where it begins.
    """
    ball = max(cutter.radius, impeller.definition.fillet)
    until = _until(impeller, blade, side, ball)
    # Between the points that a fit sees there may be a little more, so that it keeps off its limits.
    limits = Limits(overcut=_KEPT * overcut)

    def grid(along: int, across: int) -> Flank:
        return _grid(impeller, blade, side, ball, until, (along, across))

    def from_hub(points: Floats) -> tuple[Floats, Floats]:
        distance, normal, _ = impeller.hub.distances(points)
        return distance, normal

    floor = Floor(from_hub, cutter.radius + _OFF_HUB)
    cut = mill_flank(grid, cutter, limits, below=0.0, floor=floor, progress=progress)
    axis_points, radii = _axis_points(cut, cutter)
    hub = float((impeller.hub.distances(axis_points)[0] - radii).min())
    return BladeFlank(cut, side, until, hub, _neighbour(impeller, blade, axis_points, radii))


def _surface(blade: Blade, side: float, w: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Points (k, 3) and normals (k, 3) of one side."""
    centre, normal = blade.sides(w, v, side)
    return centre + blade.halves(w, v)[:, None] * normal, normal


def _begins(impeller: Impeller, blade: Blade, side: float, ball: float, w: Floats) -> Floats:
    """Return the least v (k,) at which a ball that touches the flank is clear of the hub; 1 where none is below the
    tip.
    """
    low, high = np.zeros(len(w)), np.ones(len(w))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        point, normal = _surface(blade, side, w, middle)
        inside = impeller.hub.distances(point + ball * normal)[0] < ball
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return high


def _until(impeller: Impeller, blade: Blade, side: float, ball: float) -> float:
    """Return the w at which a flank ends."""
    w = np.linspace(0.0, 1.0, 401)
    low = _begins(impeller, blade, side, ball, w) > _LOW
    if low[:40].any():
        raise InputError(Problem(impeller.definition.file, 0, Wording("IMP326", "ball_radius_mm", ball=ball)))
    return float(w[low.argmax() - 1]) if low.any() else 1.0


def _grid(impeller: Impeller, blade: Blade, side: float, ball: float, until: float, size: tuple[int, int]) -> Flank:
    """Return the flank with so many points along and across."""
    along, across = size
    w = np.linspace(0.0, until, along)
    begins = _begins(impeller, blade, side, ball, w)
    v = begins[:, None] + (1.0 - begins[:, None]) * np.linspace(0.0, 1.0, across)
    points, normals = _surface(blade, side, np.repeat(w, across), v.ravel())
    return Flank(points.reshape(along, across, 3), normals.reshape(along, across, 3))


def _axis_points(cut: FlankCut, cutter: FlankCutter) -> tuple[Floats, Floats]:
    """Centres (n, 3) of the cutter's balls over the whole path, and their radii (n,)."""
    lower, axis = cut.path.poses(np.linspace(0.0, 1.0, _POSES))
    up = np.linspace(0.0, cutter.length, _PLACES)
    points = lower[:, None] + up[:, None] * axis[:, None]
    return points.reshape(-1, 3), np.tile(cutter.radius + cutter.slope * up, _POSES)


def _neighbour(impeller: Impeller, blade: Blade, points: Floats, radii: Floats) -> float:
    """Return the least distance of balls to all blades but one."""
    own = next(angle for one, angle in impeller.blades() if one is blade)
    found = np.inf
    for other, angle in impeller.blades():
        if other is blade and angle == own:
            continue
        distance = other.distances(rotated(points, own - angle))[0] - radii
        found = min(found, float(distance.min()))
    return found
