"""Blade and fillet as patches round the root.

In:     a blade, hub, shroud and the fillet's radius.
Out:    ``RootLoop``: six parts, each a patch of the fillet and one of the blade above it, which end where the next ones
        begin.
Units:  mm and rad.

The parts go round the blade: along side −1 to the leading edge, round it in two parts, along side +1, and round the
trailing edge in two parts. The edges are divided where the fillet's foot reaches farthest up and down the hub: there
the borders between channels begin. A blade that the stock cuts has its round edge outside of the stock.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import Fillet, Stations, crossings, root_fillet
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.profiles import Profile
from trunnion.impeller.solid.shapes import SplineSurface
from trunnion.impeller.solid.splines import surface_through
from trunnion.impeller.solid.turned import profile_parameters
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.wording import position

#: Parts of a loop.
PARTS: Final = 6

#: The parts that begin on the leading and on the trailing edge's middle.
LEADING: Final = 2
TRAILING: Final = 5

#: A blade that the stock cuts goes on so much lower, of v, that its fillet finds a place outside of the stock too.
_LOWER: Final = 0.5

#: And farther outside by the first of these that is enough, in radii of its fillet.
_FARTHER: Final = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0)

#: Places of an edge at which it may be divided.
_DIVISIONS: Final = np.linspace(0.1, 0.9, 161)


@dataclass(frozen=True, slots=True)
class Density:
    """How many points patches go through: along a side, round half an edge, across the fillet and up the blade."""

    side: int
    edge: int
    fillet: int
    blade: int


@dataclass(frozen=True, slots=True, eq=False)
class LoopPart:
    """A part of the loop.

    at       (k,) its parameter, from 0 up
    fillet   patch from hub (v = 0) to blade (v = 1)
    blade    patch from fillet (v = 0) to shroud (v = 1)
    outward  whether the patches' normals, derivative by u times derivative by v, point out of the metal
    hub      (k, 2) angle about Z and parameter of the hub's profile, where the fillet touches the hub
    shroud   (k, 2) the same where the blade ends at the shroud
    """

    at: Floats
    fillet: SplineSurface
    blade: SplineSurface
    outward: bool
    hub: Floats
    shroud: Floats


@dataclass(frozen=True, slots=True, eq=False)
class RootLoop:
    """The parts of a loop, and its fillet at all of its stations."""

    parts: tuple[LoopPart, ...]
    fillet: Fillet
    radius: float

    @property
    def feet(self) -> Floats:
        """Where the fillet touches the hub, (k, 3)."""
        return np.asarray(self.fillet.centre + self.radius * self.fillet.to_hub)


def root_loop(impeller: Impeller, blade: Blade, density: Density, near: float | None = None) -> RootLoop:
    """Make the loop of a blade.

    impeller, blade  the blade, and the impeller that it is of
    density          of its points
    near             an angle about Z near to that of the loop's first station; default: whichever comes

    Raises ``InputError`` if the fillet finds no place all round the blade, or reaches the shroud.
    """
    radius = impeller.definition.fillet
    blade = carried_on(impeller, blade)
    stations = _stations(blade, impeller.hub, radius, density)
    joined = Stations(np.concatenate([one.part for one in stations]), np.concatenate([one.at for one in stations]))
    fillet = root_fillet(blade, impeller.hub, radius, joined)
    high = _heights(impeller, blade, joined, fillet)
    share = np.linspace(0.0, 1.0, density.blade)
    walls = np.empty((len(joined.part), density.blade, 3))
    for column, part in enumerate(share):
        walls[:, column] = _surface(blade, joined, fillet.v + part * (high - fillet.v))
    arcs = _arcs(fillet, radius, density.fillet)
    arcs[:, -1] = walls[:, 0]
    outward = joined.balls(blade, fillet.v)[1]
    hub, shroud = (
        _turned(profile, points, near)
        for profile, points in ((impeller.hub, arcs[:, 0]), (impeller.shroud, walls[:, -1]))
    )
    rows = np.split(np.arange(len(joined.part)), np.cumsum([len(one.part) for one in stations])[:-1])
    parts = tuple(
        _part(one, *(found[k] for found in (arcs, walls, outward, hub, shroud)))
        for one, k in zip(stations, rows, strict=True)
    )
    return RootLoop(parts, fillet, radius)


def carried_on(impeller: Impeller, blade: Blade) -> Blade:
    """Return a blade as it is; or, where the stock cuts it, one that ends so far outside that its fillet does so too.

    It ends no farther outside than that takes: there its fillet may reach the shroud.
    """
    definition = impeller.definition
    if definition.trailing_edge != "cut":
        return blade
    slopes = np.stack([curve.derivatives(np.ones(1), 1)[1, 0] for curve in (impeller.curves[0], impeller.curves[-1])])
    turns = np.linspace(0.0, 1.0, 17)
    edge = Stations(np.full(len(turns), 3), turns)
    found = replace(blade, low=blade.low - _LOWER)
    for part in _FARTHER:
        edges = blade.edges.copy()
        edges[1] += part * definition.fillet / np.linalg.norm(slopes, axis=1)
        found = replace(found, edges=edges)
        fillet = root_fillet(found, impeller.hub, definition.fillet, edge)
        ends = np.vstack([fillet.centre + definition.fillet * away for away in (fillet.to_hub, fillet.to_blade)])
        if np.hypot(ends[:, 0], ends[:, 1]).min() > definition.stock.diameter / 2.0:
            break
    return found


def _stations(blade: Blade, hub: Profile, radius: float, density: Density) -> tuple[Stations, ...]:
    """Stations of the six parts; each begins where the one before ends."""
    w = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, density.side))
    spans = [(0, w[::-1]), (2, w)]
    for place, (part, wanted) in enumerate(((1, np.argmin), (3, np.argmax))):
        edge = Stations(np.full(len(_DIVISIONS), part), _DIVISIONS)
        found = root_fillet(blade, hub, radius, edge)
        feet = profile_parameters(hub, found.centre + radius * found.to_hub)
        middle = float(_DIVISIONS[int(wanted(feet))])
        halves = (part, np.linspace(0.0, middle, density.edge)), (part, np.linspace(middle, 1.0, density.edge))
        spans[3 * place + 1 : 3 * place + 1] = halves
    return tuple(Stations(np.full(len(at), part), at) for part, at in spans)


def _heights(impeller: Impeller, blade: Blade, stations: Stations, fillet: Fillet) -> Floats:
    """v (k,) at which the blade ends at the shroud.

    Raises ``InputError`` if that is below the top of the fillet somewhere.
    """

    def gap(v: Floats) -> Floats:
        return impeller.shroud.distances(_surface(blade, stations, v))[0]

    over = gap(fillet.v)
    k = int(over.argmax())
    if over[k] >= 0.0:
        place = position(fillet.centre[k] + impeller.definition.fillet * fillet.to_blade[k])
        raise InputError(Problem(impeller.definition.file, 0, Wording("IMP420", "fillet_reaches_shroud", place=place)))
    return crossings(gap, fillet.v, np.full(len(over), blade.high))


def _surface(blade: Blade, stations: Stations, v: Floats) -> Floats:
    """Points (k, 3) of a blade's surface at stations and v (k,)."""
    return stations.touching(blade, v, 0.0)[0]


def _arcs(fillet: Fillet, radius: float, count: int) -> Floats:
    """Points (k, count, 3) of the fillet, from hub to blade."""
    share = np.linspace(0.0, 1.0, count)[None, :, None]
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", fillet.to_blade, fillet.to_hub), -1.0, 1.0))[:, None, None]
    first, second = fillet.to_hub[:, None], fillet.to_blade[:, None]
    away = (np.sin((1.0 - share) * angle) * first + np.sin(share * angle) * second) / np.sin(angle)
    return np.asarray(fillet.centre[:, None] + radius * away)


def _turned(profile: Profile, points: Floats, near: float | None) -> Floats:
    """Angles about Z and parameters of a profile (k, 2) at points (k, 3), the angles without jumps."""
    angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    if near is not None:
        angle += 2.0 * np.pi * np.round((near - angle[0]) / (2.0 * np.pi))
    return np.column_stack((angle, profile_parameters(profile, points)))


def _part(stations: Stations, arcs: Floats, walls: Floats, normals: Floats, hub: Floats, shroud: Floats) -> LoopPart:
    at = np.abs(stations.at - stations.at[0])
    k = len(at) // 2
    normal = np.cross(walls[k + 1, 0] - walls[k - 1, 0], walls[k, 1] - walls[k, 0])
    fillet, blade = (surface_through(at, np.linspace(0.0, 1.0, one.shape[1]), one) for one in (arcs, walls))
    return LoopPart(at, fillet, blade, bool(normal @ normals[k] > 0.0), hub, shroud)
