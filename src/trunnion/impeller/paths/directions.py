"""Directions as points of the unit sphere: searches for those that are farthest from being forbidden.

In:     what tells how far a direction is from being forbidden at a place.
Out:    better directions near others, the most central ones, those that are allowed everywhere.
"""

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from trunnion.arrays import Floats, Ints

#: How far directions (n, 3) at places (n,) are from being forbidden, (n,): below 0 they are. Below the third argument,
#: it may be less than what is told.
Margin: TypeAlias = Callable[[Ints, Floats, float], Floats]

#: A search for a better direction: steps in degrees, each done again as long as it helps, but not more often than this.
_CLIMB: Final = (8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.1)
_AGAIN: Final = 4
_AROUND: Final = 8

#: Directions of which one may do for all places, and how many are asked for at once.
_COMMON: Final = 6000
_AT_ONCE: Final = 8000

#: Degrees: a direction so far from forbidden ones is far enough, and one so near to Z is upright enough.
_ENOUGH: Final = (15.0, 45.0)

#: Directions of the first search.
_DIRECTIONS: Final = 800


def sphere(count: int) -> Floats:
    """Directions (count, 3), evenly over the sphere: Fibonacci's lattice."""
    k = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * k / count, np.pi * (1.0 + 5.0**0.5) * k
    r = np.sqrt(1.0 - z * z)
    return np.column_stack((np.cos(angle) * r, np.sin(angle) * r, z))


def frames_about(directions: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors (n, 3) each that are perpendicular to directions (n, 3) and to each other."""
    least = np.abs(directions).argmin(axis=1)
    helper = np.eye(3)[least]
    one = np.cross(directions, helper)
    one /= np.linalg.norm(one, axis=1)[:, None]
    return one, np.cross(directions, one)


def circle(directions: Floats, angle: float, count: int) -> Floats:
    """Directions (n, count, 3) at an angle to directions (n, 3)."""
    turn = 2.0 * np.pi * np.arange(count) / count
    one, other = frames_about(directions)
    side = np.cos(turn)[:, None] * one[:, None] + np.sin(turn)[:, None] * other[:, None]
    return np.asarray(np.cos(angle) * directions[:, None] + np.sin(angle) * side)


def climb(rows: Ints, start: Floats, margin: Margin) -> tuple[Floats, Floats]:
    """Directions (n, 3) near others that are farther from being forbidden, and how far they are, (n,)."""
    best, value = start.copy(), margin(rows, start, -np.inf)
    for angle in np.radians(_CLIMB):
        for _ in range(_AGAIN):
            around = circle(best, angle, _AROUND)
            tried = margin(np.repeat(rows, _AROUND), around.reshape(-1, 3), -np.inf).reshape(-1, _AROUND)
            k = np.arange(len(rows)), tried.argmax(axis=1)
            better = tried[k] > value
            if not better.any():
                break
            best, value = np.where(better[:, None], around[k], best), np.where(better, tried[k], value)
    return best, value


def most_central(rows: Ints, margin: Margin) -> list[tuple[float, int, Floats]]:
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


def common_directions(rows: Ints, margin: Margin) -> Floats:
    """Directions (m, 3) that are allowed at all places, the best first; none is sought between those of a lattice.

    Best is one that is far from forbidden ones, up to an angle, and not tilted from Z more than by another.
    """
    directions = sphere(_COMMON)
    left = np.arange(_COMMON)
    done = 0
    while done < len(rows) and len(left):
        # The fewer directions are left, the more places at once.
        some = rows[done : done + max(_AT_ONCE // len(left), 1)]
        answer = margin(np.repeat(some, len(left)), np.tile(directions[left], (len(some), 1)), 0.0)
        left = left[(answer.reshape(len(some), -1) >= 0.0).all(axis=0)]
        done += len(some)
    good, bad = directions[left], np.delete(directions, left, axis=0)
    if not len(good):
        return good
    room = (
        np.degrees(np.arccos(np.clip((good @ bad.T).max(axis=1), -1.0, 1.0))) if len(bad) else np.full(len(good), 180.0)
    )
    enough, upright = _ENOUGH
    tilted = np.maximum(np.degrees(np.arccos(good[:, 2])) - upright, 0.0)
    return np.asarray(good[np.argsort(tilted / upright - np.minimum(room, enough) / enough, kind="stable")])
