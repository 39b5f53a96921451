"""Where a tool axis may point: one convex region of directions for each of many places.

In:     places on a family's parameters, and what tells whether a direction is allowed at one of them.
Out:    at each place a cone of directions: half-spaces through the origin that no known forbidden direction is in.

About a direction c, another one is the point where it meets the plane that touches the unit sphere in c (the gnomonic
projection): great circles are straight lines there, so that a convex region of the plane is a convex cone. Regions grow
from place to place, each from the middle of its neighbour's, so that all of them are on one side of what is in the way.
"""

from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.extras import import_extra
from trunnion.impeller.progress import Advance, ignore
from trunnion.records import dataclass

#: How far directions (n, 3) at places (n,) are from being forbidden, (n,): below 0 they are. Below the third argument,
#: it may be less than what is told.
Margin: TypeAlias = Callable[[Ints, Floats, float], Floats]


class _Rays(NamedTuple):
    """Rays from the middle of a region: how many, the angles in degrees at which they are tried, and how often the
    angle between the last allowed and the first forbidden one is halved.
    """

    number: int
    angles: tuple[float, ...]
    halvings: int


#: Those that find a region, and those of a first look, which finds the middle.
_RAYS: Final = _Rays(16, (0.6, 2.0, 5.0, 9.0, 14.0, 20.0, 27.0, 35.0, 44.0, 54.0, 64.0), 3)
_FIRST_RAYS: Final = _Rays(8, (0.5, 1.5, 4.0, 10.0, 18.0, 28.0, 40.0, 54.0), 0)

#: The middle is looked for so often, and once more, where margins are best, if the region is narrower than this sine.
_CENTRED: Final = 2
_NARROW: Final = 0.02

#: A search for a better direction: steps in degrees, each done again as long as it helps, but not more often than this.
_CLIMB: Final = (8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.1)
_AGAIN: Final = 4
_AROUND: Final = 8

#: Angles in degrees about a neighbour's direction that is not allowed here, at which others are tried.
_FAN: Final = (2.0, 5.0, 10.0, 16.0, 24.0, 34.0, 46.0)

#: A line that cuts a forbidden direction off is the one of these angles to its ray, degrees, that leaves most.
_TURNS: Final = (0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0, 60.0, -60.0, 75.0, -75.0)

#: Directions and places of the first search.
_DIRECTIONS: Final = 800
_SEEDS: Final = 16

_NEIGHBOURS: Final = 9


@dataclass(frozen=True, slots=True, eq=False)
class Regions:
    """Cones at n places: direction a is in that of place ``owner[k]`` if ``walls[k]``·a ≥ 0 for all its k.

    middle  (n, 3) a direction well inside; NaN where nothing is allowed
    owner   (m,)
    walls   (m, 3) unit vectors
    width   (n,) sine of the angle between the middle and the nearest wall
    """

    middle: Floats
    owner: Ints
    walls: Floats
    width: Floats

    def joined(self, other: "Regions") -> "Regions":
        """Return these places and then others."""
        owner = np.r_[self.owner, other.owner + len(self.middle)]
        parts = ((self.middle, other.middle), (self.walls, other.walls), (self.width, other.width))
        middle, walls, width = (np.concatenate(pair) for pair in parts)
        return Regions(middle, owner, walls, width)


def sphere(count: int) -> Floats:
    """Directions (count, 3), evenly over the sphere: Fibonacci's lattice."""
    k = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * k / count, np.pi * (1.0 + 5.0**0.5) * k
    r = np.sqrt(1.0 - z * z)
    return np.column_stack((np.cos(angle) * r, np.sin(angle) * r, z))


def grow_regions(places: Floats, margin: Margin, advance: Advance = ignore) -> Regions:
    """Regions at places (n, k), from the narrowest of some of them to all others; none if some of them have none."""
    count = len(places)
    seeds = distinct(np.linspace(0, count - 1, _SEEDS).astype(int))
    starts = _most_central(seeds, margin)
    middle = np.full((count, 3), np.nan)
    if len(starts) < len(seeds):
        return Regions(middle, np.empty(0, np.int64), np.empty((0, 3)), np.zeros(count))
    tree = import_extra("scipy.spatial", "impeller").cKDTree(places)
    near = tree.query(places, min(_NEIGHBOURS, count))[1].reshape(count, -1)
    _, first, direction = min(starts, key=lambda one: one[0])
    found = _regions(np.array([first]), direction[None], margin)
    order, parts = [np.array([first])], [found]
    middle[first] = found.middle[0]
    tried = np.zeros(count, np.bool_)
    tried[first] = True
    advance(1)
    front = np.array([first])
    while True:
        pairs = np.column_stack((np.repeat(front, near.shape[1]), near[front].ravel()))
        pairs = pairs[~tried[pairs[:, 1]]]
        rows, index = np.unique(pairs[:, 1], return_index=True)
        if not len(rows):
            rows, index, pairs = _nearest_left(places, tried, np.isfinite(middle[:, 0]))
            if not len(rows):
                break
        start = _nearest_allowed(rows, middle[pairs[index, 0]], margin)
        there = np.isfinite(start[:, 0])
        tried[rows] = True
        advance(len(rows))
        rows = rows[there]
        if len(rows):
            found = _regions(rows, start[there], margin)
            middle[rows] = found.middle
            order.append(rows)
            parts.append(found)
        front = rows
    return _in_order(order, parts, middle)


def _nearest_left(places: Floats, tried: Flags, found: Flags) -> tuple[Ints, Ints, Ints]:
    """Return the place that has not been tried and is nearest to one with a region, as rows and pairs of the search."""
    left, known = np.flatnonzero(~tried), np.flatnonzero(found)
    if not len(left):
        return left, left, np.empty((0, 2), np.int64)
    spatial = import_extra("scipy.spatial", "impeller")
    far, near = spatial.cKDTree(places[known]).query(places[left])
    k = int(far.argmin())
    return left[k : k + 1], np.zeros(1, np.int64), np.array([[known[near[k]], left[k]]])


def _in_order(order: list[Ints], parts: list[Regions], middle: Floats) -> Regions:
    """Regions of places in some order as those of all places."""
    owner = np.concatenate([rows[part.owner] for rows, part in zip(order, parts, strict=True)])
    width = np.zeros(len(middle))
    width[np.concatenate(order)] = np.concatenate([part.width for part in parts])
    return Regions(middle, owner, np.concatenate([part.walls for part in parts]), width)


def regions_about(rows: Ints, start: Floats, forbidden: Floats, margin: Margin) -> Regions:
    """Regions of places (n,) about directions (n, 3), without one more direction (n, 3) that is forbidden at each."""
    start = _nearest_allowed(rows, start, margin)
    there = np.isfinite(start[:, 0])
    found = _regions(rows[there], start[there], margin, forbidden[there])
    numbers = np.flatnonzero(there)
    middle, width = np.full((len(rows), 3), np.nan), np.zeros(len(rows))
    middle[numbers], width[numbers] = found.middle, found.width
    return Regions(middle, numbers[found.owner], found.walls, width)


def _most_central(rows: Ints, margin: Margin) -> list[tuple[float, int, Floats]]:
    """For places where something is allowed: the most central direction, and its angle to the next forbidden one."""
    directions = sphere(_DIRECTIONS)
    count = len(rows)
    margins = margin(np.repeat(rows, _DIRECTIONS), np.tile(directions, (count, 1)), -1.0).reshape(count, -1)
    best, value = climb(rows, directions[margins.argmax(axis=1)], margin)
    found = []
    for k, row in enumerate(rows.tolist()):
        if value[k] < 0.0:
            continue
        answer = margins[k] >= 0.0
        good, bad = np.vstack((best[k : k + 1], directions[answer])), directions[~answer]
        nearest = (good @ bad.T).max(axis=1) if len(bad) else np.full(len(good), -1.0)
        chosen = int(nearest.argmin())
        found.append((float(np.arccos(np.clip(nearest[chosen], -1.0, 1.0))), row, good[chosen]))
    return found


def climb(rows: Ints, start: Floats, margin: Margin) -> tuple[Floats, Floats]:
    """Directions (n, 3) near others that are farther from being forbidden, and how far they are, (n,)."""
    best, value = start.copy(), margin(rows, start, -np.inf)
    for angle in np.radians(_CLIMB):
        for _ in range(_AGAIN):
            circle = _circle(best, angle, _AROUND)
            tried = margin(np.repeat(rows, _AROUND), circle.reshape(-1, 3), -np.inf).reshape(-1, _AROUND)
            k = np.arange(len(rows)), tried.argmax(axis=1)
            better = tried[k] > value
            if not better.any():
                break
            best, value = np.where(better[:, None], circle[k], best), np.where(better, tried[k], value)
    return best, value


def _circle(directions: Floats, angle: float, count: int) -> Floats:
    """Directions (n, count, 3) at an angle to directions (n, 3)."""
    turn = 2.0 * np.pi * np.arange(count) / count
    one, other = frames_about(directions)
    side = np.cos(turn)[:, None] * one[:, None] + np.sin(turn)[:, None] * other[:, None]
    return np.asarray(np.cos(angle) * directions[:, None] + np.sin(angle) * side)


def frames_about(directions: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors (n, 3) each that are perpendicular to directions (n, 3) and to each other."""
    least = np.abs(directions).argmin(axis=1)
    helper = np.eye(3)[least]
    one = np.cross(directions, helper)
    one /= np.linalg.norm(one, axis=1)[:, None]
    return one, np.cross(directions, one)


def _nearest_allowed(rows: Ints, start: Floats, margin: Margin) -> Floats:
    """Return the directions (n, 3) themselves where they are allowed, else the nearest of a fan; NaN where none is
    found.
    """
    found = start.copy()
    missing = np.flatnonzero(margin(rows, start, 0.0) < 0.0)
    found[missing] = np.nan
    for angle in np.radians(_FAN):
        if not len(missing):
            break
        fan = _circle(start[missing], angle, _RAYS.number)
        answer = (
            margin(np.repeat(rows[missing], _RAYS.number), fan.reshape(-1, 3), 0.0).reshape(-1, _RAYS.number) >= 0.0
        )
        hit = answer.any(axis=1)
        # Between allowed ones, not at the edge of what is allowed.
        mean = np.where(answer[:, :, None], fan, 0.0).sum(axis=1)
        best = np.where(answer, np.einsum("nkj,nj->nk", fan, mean), -np.inf).argmax(axis=1)
        found[missing[hit]] = fan[hit, best[hit]]
        missing = missing[~hit]
    if len(missing):
        better, value = climb(rows[missing], start[missing], margin)
        found[missing[value >= 0.0]] = better[value >= 0.0]
    return found


def _regions(rows: Ints, start: Floats, margin: Margin, forbidden: Floats | None = None) -> Regions:
    """Regions of places (n,) about directions (n, 3) that are allowed."""
    middle = start
    for _ in range(_CENTRED):
        one, other = frames_about(middle)
        centre = _centroid(_reach(rows, middle, one, other, margin, _FIRST_RAYS))
        moved = middle + centre[:, :1] * one + centre[:, 1:] * other
        moved /= np.linalg.norm(moved, axis=1)[:, None]
        middle = np.where(margin(rows, moved, 0.0)[:, None] >= 0.0, moved, middle)
    found = _regions_about(rows, middle, margin, forbidden)
    narrow = np.flatnonzero(found.width < _NARROW)
    if len(narrow):
        better, _ = climb(rows[narrow], middle[narrow], margin)
        other_way = _regions_about(rows[narrow], better, margin, None if forbidden is None else forbidden[narrow])
        found = _wider(found, other_way, narrow)
    return found


def _wider(found: Regions, other: Regions, rows: Ints) -> Regions:
    """Regions, but of those of some rows the wider of two."""
    chosen = other.width > found.width[rows]
    replaced = np.zeros(len(found.middle), np.bool_)
    replaced[rows[chosen]] = True
    middle, width = found.middle.copy(), found.width.copy()
    middle[rows[chosen]], width[rows[chosen]] = other.middle[chosen], other.width[chosen]
    stay, come = ~replaced[found.owner], chosen[other.owner]
    owner = np.r_[found.owner[stay], rows[other.owner[come]]]
    return Regions(middle, owner, np.concatenate((found.walls[stay], other.walls[come])), width)


def _regions_about(rows: Ints, middle: Floats, margin: Margin, forbidden: Floats | None) -> Regions:
    """Regions of places (n,) with given middles (n, 3)."""
    one, other = frames_about(middle)
    limit = np.full(len(rows), np.inf)
    if forbidden is not None:
        one, other, limit = _towards(middle, forbidden, one, other)
    reach = _reach(rows, middle, one, other, margin, _RAYS)
    reach[:, 0] = np.minimum(reach[:, 0], 0.95 * limit)
    owner, normal, far = _convex(reach)
    walls = far[:, None] * middle[owner] - normal[:, :1] * one[owner] - normal[:, 1:] * other[owner]
    size = np.linalg.norm(walls, axis=1)
    width = np.full(len(rows), np.inf)
    np.minimum.at(width, owner, far / size)
    return Regions(middle, owner, walls / size[:, None], width)


def _towards(middle: Floats, forbidden: Floats, one: Floats, other: Floats) -> tuple[Floats, Floats, Floats]:
    """Frames whose first direction is towards forbidden ones, and how far these are in the plane."""
    ahead = np.einsum("ij,ij->i", forbidden, middle)
    x, y = (np.einsum("ij,ij->i", forbidden, side) for side in (one, other))
    size = np.hypot(x, y)
    usable = (ahead > 0.1) & (size > 1e-6)
    x, y = np.where(usable, x / np.maximum(size, 1e-6), 1.0), np.where(usable, y / np.maximum(size, 1e-6), 0.0)
    limit = np.where(usable, size / np.maximum(ahead, 0.1), np.inf)
    return x[:, None] * one + y[:, None] * other, x[:, None] * other - y[:, None] * one, limit


def _reach(rows: Ints, middle: Floats, one: Floats, other: Floats, margin: Margin, rays: _Rays) -> Floats:
    """How far rays in the plane about ``middle`` go before the first forbidden direction, (n, rays)."""
    turn = 2.0 * np.pi * np.arange(rays.number) / rays.number
    side = np.cos(turn)[None, :, None] * one[:, None] + np.sin(turn)[None, :, None] * other[:, None]
    low, high = np.zeros((len(rows), rays.number)), np.full((len(rows), rays.number), np.inf)
    open_ = np.ones((len(rows), rays.number), np.bool_)

    def ask(which: Flags, far: Floats) -> Flags:
        place, ray = np.nonzero(which)
        direction = middle[place] + far[which][:, None] * side[place, ray]
        return margin(rows[place], direction / np.linalg.norm(direction, axis=1)[:, None], 0.0) >= 0.0

    for far in np.tan(np.radians(rays.angles)).tolist():
        answer = ask(open_, np.full(open_.shape, far))
        low[open_] = np.where(answer, far, low[open_])
        high[open_] = np.where(answer, np.inf, far)
        open_[open_] = answer
        if not open_.any():
            break
    for _ in range(rays.halvings):
        which = np.isfinite(high)
        between = np.where(which, (low + np.where(which, high, 0.0)) / 2.0, 0.0)
        answer = ask(which, between)
        low[which] = np.where(answer, between[which], low[which])
        high[which] = np.where(answer, high[which], between[which])
    return low


def _centroid(reach: Floats) -> Floats:
    """Centroids (n, 2) of polygons whose corners are so far along rays, (n, rays)."""
    turn = 2.0 * np.pi * np.arange(reach.shape[1]) / reach.shape[1]
    x, y = reach * np.cos(turn), reach * np.sin(turn)
    next_x, next_y = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    area = x * next_y - next_x * y
    total = np.maximum(3.0 * area.sum(axis=1), 1e-12)
    return np.column_stack((((x + next_x) * area).sum(axis=1) / total, ((y + next_y) * area).sum(axis=1) / total))


def _convex(reach: Floats) -> tuple[Ints, Floats, Floats]:
    """Lines that leave of each plane a convex region about 0 that is within the ends of its rays, (n, rays).

    The nearest end that is not cut off yet is, by the line through it that leaves most of the rays.

    owner, normal, far  (m,), (m, 2) unit vectors outward, (m,): inside are points p of plane ``owner`` with normal · p
                        ≤ far
    """
    rays = reach.shape[1]
    turn = 2.0 * np.pi * np.arange(rays) / rays
    ray = np.column_stack((np.cos(turn), np.sin(turn)))
    # Not nearer than this, so that a region keeps an inside.
    ends = np.maximum(reach, 1e-3)
    left = np.full(ends.shape, 1e3)
    owners, normals, fars = [], [], []
    for _ in range(rays):
        is_beyond = left > ends * (1.0 + 1e-9)
        active = np.flatnonzero(is_beyond.any(axis=1))
        if not len(active):
            break
        nearest = np.where(is_beyond[active], ends[active], np.inf).argmin(axis=1)
        angles = turn[nearest][:, None] + np.radians(_TURNS)
        normal = np.stack((np.cos(angles), np.sin(angles)), axis=2)
        far = ends[active, nearest][:, None] * np.cos(np.radians(_TURNS))
        towards = np.einsum("atj,kj->atk", normal, ray)
        cut = np.where(towards > 1e-9, far[:, :, None] / np.maximum(towards, 1e-9), np.inf)
        rest = np.minimum(np.minimum(cut, left[active][:, None]), ends[active][:, None])
        best = (rest * rest).sum(axis=2).argmax(axis=1)
        chosen = np.arange(len(active)), best
        left[active] = np.minimum(left[active], cut[chosen])
        owners.append(active)
        normals.append(normal[chosen])
        fars.append(far[chosen])
    return np.concatenate(owners), np.concatenate(normals), np.concatenate(fars)
