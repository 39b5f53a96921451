"""A channel: the room between two neighbouring blades, or between a blade and a splitter.

In:     the impeller.
Out:    how far points of the channel are from what is left and right of it; how far a ball may go towards either.
Units:  mm; angles in radians about Z.

A point of a channel is that of the mean surface at u and v, turned about Z by an angle from ``start`` to ``end``. All
blades have the same mean surface, so that those two angles are the mean surfaces of the two blades. Where a blade has
not begun yet, or has ended, channels part at the angle at which the ball would first meet its edge.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.impeller.blade import Blade
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.records import dataclass

#: Of rows and their angles.
_Function: TypeAlias = Callable[[Ints, Floats], Floats]

#: The ball touches a blade this nearly, mm.
TOUCH: Final = 1e-7

#: The widest place is found this nearly, mm: nothing but the search for the places of contact begins there.
_MIDDLE: Final = 1e-2

_STEPS: Final = 60

#: Where a blade is not on its mean surface, it is searched at so many angles, up to this share of the channel on either
#: side.
_PLACES: Final = 33
_WINDOW: Final = 0.35


@dataclass(frozen=True, slots=True, eq=False)
class Extent:
    """How far a ball may go at places (k,) between the two blades: angles from the mean surface of blade 0.

    low, high   touching what is at ``start`` and what is at ``end``
    middle      where it is as far from both
    room        distance of its centre to both there, mm
    """

    low: Floats
    high: Floats
    middle: Floats
    room: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Channel:
    """The channel from the blade or splitter at the angle ``start`` to the next one at ``end``.

    before, behind  the two blades or splitters at and before ``start``, at and behind ``end``, with their angles
    """

    impeller: Impeller
    start: float
    end: float
    before: tuple[tuple[Blade, float], ...]
    behind: tuple[tuple[Blade, float], ...]

    def distance_before(self, points: Floats) -> Floats:
        """Distance (k,) of points (k, 3) to what bounds the channel at ``start``."""
        return _nearest(self.before, points)

    def distance_behind(self, points: Floats) -> Floats:
        """Distance (k,) of points (k, 3) to what bounds the channel at ``end``."""
        return _nearest(self.behind, points)

    def extent(self, places: Floats, wanted: float) -> Extent:
        """How far a ball may go to either side whose centre keeps a distance from the blades.

        places  (k, 3) float64: points of the mean surface from inlet to outlet, which are turned from ``start`` to
                ``end``
        wanted  mm. Where ``room`` is less, the ball does not fit, and both angles are that of the middle
        """
        count = len(places)
        start, end = np.full(count, self.start), np.full(count, self.end)
        before, behind = self._beyond(places, wanted)
        middle = _root(lambda rows, angle: before(rows, angle) - behind(rows, -angle), start, end, _MIDDLE)
        rows = np.arange(count)
        room = np.minimum(before(rows, middle), behind(rows, -middle)) + wanted
        fits = room >= wanted
        low = _root(before, np.minimum(self._parting(self.before[0], places, wanted), middle), middle, TOUCH)
        high = -_root(behind, -np.maximum(self._parting(self.behind[0], places, wanted), middle), -middle, TOUCH)
        return Extent(np.where(fits, low, middle), np.where(fits, high, middle), middle, room)

    def narrowed(self, places: Floats, wanted: float, extent: Extent, rows: Ints) -> Extent:
        """Return the same extent, but that the angles of rows go towards the middle where they do not keep the
        distance.
        """
        before, behind = self._beyond(places[rows], wanted)
        low, high = extent.low.copy(), extent.high.copy()
        low[rows] = _root(before, low[rows], extent.middle[rows], TOUCH)
        high[rows] = -_root(behind, -high[rows], -extent.middle[rows], TOUCH)
        return replace(extent, low=low, high=high)

    def _parting(self, bound: tuple[Blade, float], places: Floats, wanted: float) -> Floats:
        """Angles (k,) that part this channel from the next one, (k, 3) in their order from inlet to outlet.

        Where a ball would meet the blade between them, one at which it does. In front of the blade that of the nearest
        such place, so that passes come straight on to where the ways round the edge part: a leaning edge is not in
        front of its mean surface.
        """
        angle = np.full(len(places), bound[1])
        gap = _nearest((bound,), turned(places, angle)) - wanted
        rows = np.flatnonzero(gap >= 0.0)
        for share in np.linspace(-_WINDOW, _WINDOW, _PLACES):
            tried = np.full(len(rows), bound[1] + share * (self.end - self.start))
            found = _nearest((bound,), turned(places[rows], tried)) - wanted
            nearer = found < np.minimum(gap[rows], 0.0)
            angle[rows[nearer]], gap[rows[nearer]] = tried[nearer], found[nearer]
        meets = np.flatnonzero(gap < 0.0)
        if not len(meets):
            return angle
        return np.asarray(angle[meets[np.abs(np.arange(len(places))[:, None] - meets).argmin(axis=1)]])

    def _beyond(self, places: Floats, wanted: float) -> tuple[_Function, _Function]:
        """By how much places are farther away than wanted from what is before, and what is behind, turned by −angle."""

        def before(rows: Ints, angle: Floats) -> Floats:
            return self.distance_before(turned(places[rows], angle)) - wanted

        def behind(rows: Ints, angle: Floats) -> Floats:
            return self.distance_behind(turned(places[rows], -angle)) - wanted

        return before, behind


def channels_of(impeller: Impeller) -> tuple[Channel, ...]:
    """Return the channels from the first blade to the second one: one, or with splitters two."""
    angles = [(blade, angle) for blade, angle in impeller.blades()]
    count = len(angles)
    around = [(blade, angle + turn * 2.0 * np.pi) for turn in (-1, 0, 1) for blade, angle in angles]
    found = []
    for k in range(count, count + count // impeller.definition.number):
        before = around[k], around[k - 1]
        behind = around[k + 1], around[k + 2]
        found.append(Channel(impeller, around[k][1], around[k + 1][1], before, behind))
    return tuple(found)


def turned(points: Floats, angle: Floats) -> Floats:
    """Points (k, 3), each turned about Z by its own angle (k,)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = points[:, 0], points[:, 1]
    return np.column_stack((cosine * x - sine * y, sine * x + cosine * y, points[:, 2]))


def _nearest(blades: tuple[tuple[Blade, float], ...], points: Floats) -> Floats:
    """Distance (k,) to the nearest of blades, each with its angle; the first one is likely to be it."""
    found = np.full(len(points), np.inf)
    for blade, angle in blades:
        found = blade.nearer(rotated(points, -angle), found)
    return found


def _root(function: _Function, low: Floats, high: Floats, close: float) -> Floats:
    """Where a function of rows and angles changes its sign from − to + between ``low`` and ``high``, (k,).

    The Illinois method: the secant, of which an end that stays twice counts half. The function is at 0 or above it
    there, by no more than ``close``; or it is ``low`` where it is above 0 already, and ``high`` where it stays below.
    """
    low, high = low.copy(), high.copy()
    every: Ints = np.arange(len(low))
    at_low, at_high = function(every, low) - close / 2.0, function(every, high) - close / 2.0
    found = np.where(at_low >= 0.0, low, high)
    rows = np.flatnonzero((at_low < 0.0) & (at_high > 0.0))
    last = np.zeros(len(low))
    for _ in range(_STEPS):
        if not len(rows):
            break
        a, b, f, g = low[rows], high[rows], at_low[rows], at_high[rows]
        angle = a - f * (b - a) / (g - f)
        value = function(rows, angle) - close / 2.0
        side = np.where(value < 0.0, -1.0, 1.0)
        half = np.where(side == last[rows], 0.5, 1.0)
        low[rows], high[rows] = np.where(side < 0.0, angle, a), np.where(side < 0.0, b, angle)
        at_low[rows], at_high[rows] = np.where(side < 0.0, value, f * half), np.where(side < 0.0, g * half, value)
        last[rows] = side
        found[rows] = np.where(np.abs(value) <= close / 2.0, angle, high[rows])
        rows = rows[np.abs(value) > close / 2.0]
    return found
