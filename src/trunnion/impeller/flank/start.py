"""Where a path begins before it is fitted: double-point offset.

At each station along the flank, the axis goes through the centres of two of the cutter's balls, which touch the flank
at two heights (Liu 1995). Heights are shares of the flank's height, 0 at its lower end. Where the flank bends more
than the cutter, or its normals turn over along a ruling, such an axis goes through the flank itself; then the start is
laid along mean normals, as far away as it takes.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.flank.deviations import Deviations, deviations_of
from trunnion.impeller.flank.flanks import Flank
from trunnion.impeller.flank.path import FlankPath, basis

#: How often the places of both balls along the axis are found again: they decide about the radii of a cone.
_ROUNDS: Final = 8

#: Shares of the flank's length over which normals are averaged, and distances beyond the cutter's radius, in radii.
_WINDOWS: Final = (0.15, 0.4, 1.0)
_AWAY: Final = (0.0, 0.5, 1.0, 2.0, 3.0, 4.5, 6.0, 9.0)

#: An axis that cuts deeper than this part of the radius may be through the flank.
_DEEP: Final = 0.8


def start_path(flank: Flank, cutter: FlankCutter, count: int, below: float, lead: float) -> FlankPath:
    """Where the fit of a path begins: ``double_point_offset``, or a path that is clear of the flank."""
    points = flank.flat()
    path = double_point_offset(flank, cutter, count, (0.25, 0.75), below, lead)
    if -deviations_of(path, points)[0].min() < _DEEP * cutter.radius:
        return path
    best, least = path, np.inf
    for window in _WINDOWS:
        mean = flank.smoothed(window)
        for away in _AWAY:
            farther = Flank(flank.points + away * cutter.radius * mean.normals, mean.normals)
            tried = double_point_offset(farther, cutter, count, (0.0, 1.0), below, lead)
            left = Deviations.of(deviations_of(tried, points)[0])
            if left.overcut < _DEEP * cutter.radius and left.largest < least:
                best, least = tried, left.largest
    return best


def double_point_offset(
    flank: Flank, cutter: FlankCutter, count: int, touch: tuple[float, float], below: float, lead: float
) -> FlankPath:
    """Return a path of so many control points whose cutter touches the flank at two heights at each station.

    below  how far the lower point of the axis is below the flank's lower end, mm along the axis; below 0: above it
    lead   how far the path goes on straight at either end, as a share of its length
    """
    heights = np.linspace(0.0, 1.0, flank.points.shape[1])
    at = [min(int(np.searchsorted(heights, one - 1e-9)), len(heights) - 1) for one in touch]
    points, normals = flank.points[:, at], flank.normals[:, at]
    ends = flank.points[:, 0]
    radii = np.full((len(points), 2), cutter.radius)
    for _ in range(_ROUNDS):
        centres = points + radii[:, :, None] * normals
        axis = centres[:, 1] - centres[:, 0]
        axis /= np.linalg.norm(axis, axis=1)[:, None]
        lower = centres[:, 0] + (np.einsum("ij,ij->i", ends - centres[:, 0], axis) - below)[:, None] * axis
        radii = cutter.radius + cutter.slope * np.einsum("ijk,ik->ij", centres - lower[:, None], axis)
    upper = lower + cutter.length * axis
    return _through(lower, upper, cutter, count, lead)


def _through(lower: Floats, upper: Floats, cutter: FlankCutter, count: int, lead: float) -> FlankPath:
    """Return the path nearest to axes at stations, with straight leads at either end."""
    middle = (lower + upper) / 2.0
    places = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(middle, axis=0), axis=1))]
    places /= places[-1]
    both = np.concatenate((lower, upper), axis=1)
    if lead:
        share = np.linspace(lead, lead / 5.0, 5)[:, None]
        first = both[0] - share * (both[1] - both[0]) / (places[1] - places[0])
        last = both[-1] + share[::-1] * (both[-1] - both[-2]) / (places[-1] - places[-2])
        both = np.concatenate((first, both, last))
        places = np.concatenate((-share[:, 0], places, 1.0 + share[::-1, 0]))
    places = (places - places[0]) / (places[-1] - places[0])
    solved = import_extra("scipy.linalg", "geometry").lstsq(basis(places, count), both)[0]
    return FlankPath(np.ascontiguousarray(solved[:, :3]), np.ascontiguousarray(solved[:, 3:]), cutter)
