"""The fillet between blade and hub: what a ball that touches both does not reach.

In:     blade, hub and the radius of the fillet.
Out:    the path of the ball's centre, and where it touches blade and hub.
Units:  mm.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.profiles import Profile
from trunnion.messages import Wording
from trunnion.records import dataclass

#: A ball this near to the hub touches it, mm; that takes about ten steps.
_TOUCH: Final = 1e-11
_STEPS: Final = 60

#: A fillet's body goes so far below the hub, as a part of its radius: more than facets are off.
_BELOW: Final = 0.25

#: And into the blade up to this part of the radii of its balls.
_IN_BALL: Final = 0.2


class FilletError(InputError):
    """A ball that does not touch blade and hub at ``place``, a point (3,) of the blade."""

    def __init__(self, wording: Wording, place: Floats) -> None:
        super().__init__(Problem("fillet", 0, wording))
        self.place = place


@dataclass(frozen=True, slots=True, eq=False)
class Fillet:
    """Stations along the root, (k,): from the trailing edge along one side, round the leading edge, and back.

    centre    (k, 3) of the ball
    to_blade  (k, 3) unit vectors from the centre to where the ball touches the blade
    to_hub    (k, 3) and the hub
    v         (k,) of the blade
    inside    (2, k, 3) points in the blade: beside where the ball touches it, and below the hub
    is_closed whether it goes round the trailing edge too
    """

    centre: Floats
    to_blade: Floats
    to_hub: Floats
    v: Floats
    inside: Floats
    is_closed: bool


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Places along the root of a blade: on its sides at w, or on a round edge at a turn.

    part  (k,) 0: side −1, 1: leading edge, 2: side +1, 3: trailing edge
    at    (k,) w or turn
    """

    part: Ints
    at: Floats

    def balls(self, blade: Blade, v: Floats) -> tuple[Floats, Floats]:
        """Centres of the blade's balls (k, 3) and its normals (k, 3) at these stations and v (k,)."""
        centre, normal = np.empty((len(v), 3)), np.empty((len(v), 3))
        for part in range(4):
            rows = np.flatnonzero(self.part == part)
            if not len(rows):
                continue
            if part in (0, 2):
                found = blade.sides(self.at[rows], v[rows], -1.0 if part == 0 else 1.0)
            else:
                found = blade.edge(0.0 if part == 1 else 1.0, self.at[rows], v[rows])
            centre[rows], normal[rows] = found
        return centre, normal

    def touching(self, blade: Blade, v: Floats, radius: float) -> tuple[Floats, Floats]:
        """Centres (k, 3) of balls of a radius that touch the blade there, and its normals (k, 3)."""
        centre, normal = self.balls(blade, v)
        return centre + (blade.halves(self.w, v) + radius)[:, None] * normal, normal

    @property
    def w(self) -> Floats:
        """w of the stations (k,); those of an edge have the edge's."""
        return np.asarray(np.where(self.part == 1, 0.0, np.where(self.part == 3, 1.0, self.at)))


def root_stations(along: int, around: int, *, round_trailing: bool) -> Stations:
    """Stations along the root: ``along`` on each side, denser towards its ends, and ``around`` on each round edge."""
    w = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, along))
    turn = np.linspace(0.0, 1.0, around + 2)[1:-1]
    parts = [(0, w[::-1]), (1, turn), (2, w)]
    if round_trailing:
        parts.append((3, turn))
    number = np.concatenate([np.full(len(at), part) for part, at in parts])
    return Stations(number, np.concatenate([at for _, at in parts]))


def root_fillet(blade: Blade, hub: Profile, radius: float, stations: Stations) -> Fillet:
    """Roll a ball along the root of a blade.

    Raises ``FilletError`` if the ball does not touch blade and hub at each station, with the first where it does not.
    """
    count = len(stations.part)
    low, high = np.full(count, blade.low), np.full(count, blade.high)

    def gap(v: Floats) -> Floats:
        return hub.distances(stations.touching(blade, v, radius)[0])[0] - radius

    missing = (gap(low) > 0.0) | (gap(high) < 0.0)
    if missing.any():
        place = stations.balls(blade, np.zeros(count))[0][int(missing.argmax())]
        raise FilletError(Wording("IMP214", "fillet_mm_finds", radius=radius), place)
    v = crossings(gap, low, high)
    centre, normal = stations.touching(blade, v, radius)
    inside = _inside(blade, hub, stations, v, _BELOW * radius)
    return Fillet(centre, -normal, -hub.distances(centre)[1], v, inside, bool((stations.part == 3).any()))


def _inside(blade: Blade, hub: Profile, stations: Stations, v: Floats, below: float) -> Floats:
    """Points (2, k, 3) in the blade, at v (k,) and so far below the hub; they keep off the blade's middle."""

    def within(at: Floats) -> Floats:
        centre, normal = stations.balls(blade, at)
        return centre + (_IN_BALL * blade.halves(stations.w, at))[:, None] * normal

    def gap(at: Floats) -> Floats:
        return hub.distances(within(at))[0] + below

    return np.stack((within(v), within(crossings(gap, np.full(len(v), blade.low), v))))


def crossings(gap: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Where gaps (k,) rise through 0 between ``low`` and ``high`` (k,); the end that is nearer to it where none does.

    The Illinois method: the secant; an end that stays twice counts half.
    """
    at_low, at_high = gap(low), gap(high)
    high, at_high = np.where(at_low >= 0.0, low, high), np.where(at_low >= 0.0, at_low, at_high)
    low, at_low = np.where(at_high <= 0.0, high, low), np.where(at_high <= 0.0, at_high, at_low)
    open_ = low < high
    v, was_below = high, np.full(len(high), -1)
    for _ in range(_STEPS):
        v = np.where(open_, low - at_low * (high - low) / np.where(at_high > at_low, at_high - at_low, 1.0), high)
        at_v = gap(v)
        if np.abs(at_v)[open_].max(initial=0.0) < _TOUCH:
            break
        below = at_v < 0.0
        idle = np.where(below == was_below, 0.5, 1.0)
        at_high, at_low = np.where(below, idle * at_high, at_v), np.where(below, at_v, idle * at_low)
        low, high, was_below = np.where(open_ & below, v, low), np.where(open_ & ~below, v, high), below
    return np.asarray(v)
