"""The places of the workpiece zero at which a path fits, at one turn, as a convex polyhedron.

Half-spaces are added until no corner of the polyhedron violates one by more than a tolerance. Where a rotary table
turns the part about, the true region is round, with as many faces as the path has rows: the polyhedron is then around
it, within the tolerance. ``Region.margin`` is exact.
"""

from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.placing.inscribed_box import Box, inscribed_box
from trunnion.placing.largest_margin import BestPlace, innermost
from trunnion.placing.travel_limits import FARTHEST, CutSet
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure

#: How far corners may be outside, mm.
TOLERANCE: Final = 0.01

#: A region whose best place has a smaller margin is taken for that place alone, mm.
_NO_INSIDE: Final = 1e-6

#: The most half-spaces, after which a larger tolerance is reported.
_MOST: Final = 4000


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """Where the workpiece zero may be.

    corners    (v, 3) of the polyhedron, mm, machine frame
    tolerance  how far they are outside at most, mm
    volume     mm^3; infinite where a linear axis without limits leaves it open
    low, high  (3,) its extent, mm; infinite where it is open: not every place within it fits
    box        the largest box of places that all fit, around the best one
    cuts       its half-spaces
    """

    corners: Annotated[Floats, Figure(unit="mm", after="volume_mm3")]
    tolerance: Annotated[float, Figure(unit="mm", after="corners_mm")]
    volume: Annotated[float, Figure(unit="mm3", after="high_mm")]
    low: Annotated[Floats, Figure(unit="mm", after="inside_high_mm")]
    high: Annotated[Floats, Figure(unit="mm", after="low_mm")]
    cuts: Annotated[CutSet, NOT_DATA]
    box: Annotated[
        Box,
        Figure("inside_low", unit="mm", take=attrgetter("low")),
        Figure("inside_high", unit="mm", take=attrgetter("high")),
    ]

    @property
    def is_box(self) -> bool:
        """Whether all places within its extent fit."""
        ends = ((self.low, self.box.low), (self.high, self.box.high))
        return all(np.allclose(one, other, rtol=0.0, atol=TOLERANCE) for one, other in ends)

    def margin(self, zero: Floats) -> float:
        """Return what the linear axis nearest to a limit has left with the zero (3,) there, mm; negative: it does not
        fit.
        """
        return self.cuts.at(np.asarray(zero, np.float64)).margin


def region_of(cuts: CutSet, best: BestPlace, inside: Floats | None = None) -> Region | None:
    """Return the region around the best place, with a box around it or a place (3,) near it; None if there is none."""
    if best.margin < 0.0:
        return None
    middle, room = (best.zero, best.margin) if cuts.edges is None else innermost(cuts)
    if room < _NO_INSIDE:
        return Region(best.zero[None], 0.0, 0.0, best.zero, best.zero, cuts, Box(best.zero, best.zero))
    corners = _corners(cuts, middle)
    judged: dict[tuple[float, ...], float] = {}
    while len(cuts.cuts) < _MOST:
        before = len(cuts.cuts)
        for corner in corners:
            key = tuple(corner.tolist())
            if key not in judged:
                reached = cuts.at(corner)
                judged[key] = -reached.least
                cuts.add(reached, np.full((3, 2), -TOLERANCE), -TOLERANCE)
        if len(cuts.cuts) == before:
            break
        corners = _corners(cuts, middle)
    off = max(judged.get(tuple(corner.tolist()), np.inf) for corner in corners)
    spatial = import_extra("scipy.spatial", "place")
    hull = spatial.ConvexHull(corners)
    corners = corners[np.sort(hull.vertices)]
    low, high = corners.min(axis=0), corners.max(axis=0)
    open_low, open_high = low < -0.99 * FARTHEST, high > 0.99 * FARTHEST
    volume = np.inf if (open_low | open_high).any() else float(hull.volume)
    low, high = np.where(open_low, -np.inf, low), np.where(open_high, np.inf, high)
    box = inscribed_box(cuts, best.zero if inside is None else inside, low, high)
    return Region(corners, max(off, 0.0), volume, low, high, cuts, box)


def _corners(cuts: CutSet, inside: Floats) -> Floats:
    """Corners of the half-spaces so far, within the box of all places."""
    spatial = import_extra("scipy.spatial", "place")
    normals, bounds, _ = cuts.table()
    box = np.concatenate((np.eye(3), -np.eye(3)))
    normals = np.concatenate((normals, box))
    bounds = np.concatenate((bounds, np.full(6, FARTHEST)))
    found = spatial.HalfspaceIntersection(np.column_stack((normals, -bounds)), inside)
    return np.unique(np.round(found.intersections, 9), axis=0)
