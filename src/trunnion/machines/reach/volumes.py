"""Volumes of what bodies of several tool axes fill together, and of what they have in common.

In:     the bodies of all rotary positions, with the tool axis that each gives.
Out:    volumes with bounds, mm^3.

The box around all bodies is divided into cells. A cell that lies within one body, or beyond a plane of each, is
decided; others are divided again, until they are so small that only their middle is asked. The cells that were never
decided are what lies between the bounds.
"""

from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3, Ints
from trunnion.jit import inner, kernel
from trunnion.machines.reach.bodies import PoseBodies
from trunnion.records import dataclass
from trunnion.results import Figure

#: The box is divided into so many cells along each side at first.
_FIRST: Final = 8

#: The same for bounds that allow for tool axes in between, which are no sharper than points move until the next one.
_BETWEEN_LEVELS: Final = 2

#: Cells that are beyond a plane by less than this, mm, are not: planes and sides of cells often fall together.
_THIN: Final = 1e-6

#: How often cells are halved along each side. Four times make 128 cells along a side.
LEVELS: Final = 4


@dataclass(frozen=True, slots=True)
class ReachedVolume:
    """A volume, mm^3: at least ``low``, at most ``high``, and ``likely`` by the middles of undecided cells."""

    low: Annotated[float, Figure("at_least", decimals=1)]
    likely: Annotated[float, Figure(decimals=1)]
    high: Annotated[float, Figure("at_most", decimals=1)]


def reached_volumes(
    bodies: PoseBodies, direction: Ints, directions: int, levels: int = LEVELS, between: Floats | None = None
) -> tuple[ReachedVolume, ReachedVolume]:
    """Return the volume of points that are reached with some tool axis, and with every one.

    bodies      of k rotary positions
    direction   (k,) int64: the tool axis that each gives, from 0, increasing
    directions  how many tool axes there are
    levels      how often cells are halved
    between     (k,) float64, mm: how far the points of each body go on the way half-way to those of the next tool axis:
                bounds then hold for the tool axes in between, too. None: these tool axes are all that is meant
    """
    solid = bodies.solid
    slack = np.zeros(len(direction)) if between is None else between
    bodies, direction, slack = bodies.select(solid), direction[solid], slack[solid]
    if not len(direction):
        return ReachedVolume(0.0, 0.0, 0.0), ReachedVolume(0.0, 0.0, 0.0)
    starts = np.searchsorted(direction, np.arange(directions + 1))
    low, high = bodies.corners.min(axis=1), bodies.corners.max(axis=1)
    box = low.min(axis=0), high.max(axis=0)
    some = _volume(bodies, starts, np.zeros(len(slack)), box, levels, every=False)
    most = float(slack.max())
    if most:
        wide = box[0] - most, box[1] + most
        wider = _volume(bodies, starts, slack, wide, min(levels, _BETWEEN_LEVELS), every=False)
        some = replace(some, high=max(some.high, wider.high))
    if directions == 1:
        return some, some
    # What every tool axis reaches is within the box around each one's bodies.
    lowest = np.array([low[first:end].min(axis=0, initial=np.inf) for first, end in pairwise(starts)])
    highest = np.array([high[first:end].max(axis=0, initial=-np.inf) for first, end in pairwise(starts)])
    box = lowest.max(axis=0), highest.min(axis=0)
    every = _volume(bodies, starts, np.zeros(len(slack)), box, levels, every=True)
    if most:
        narrower = _volume(bodies, starts, slack, box, min(levels, _BETWEEN_LEVELS), every=True)
        every = replace(every, low=min(every.low, narrower.low))
    return some, every


def _volume(
    bodies: PoseBodies, starts: Ints, slack: Floats, box: tuple[Floats, Floats], levels: int, *, every: bool
) -> ReachedVolume:
    """Return the volume within a box, lowest and highest corner."""
    size = (box[1] - box[0]) / _FIRST
    if not (size > 0.0).all():
        return ReachedVolume(0.0, 0.0, 0.0)
    counts = np.zeros(3)
    count_cells(bodies.normal, bodies.low, bodies.high, slack, starts, box[0], size, levels, every, counts)
    return ReachedVolume(*(counts * float(np.prod(size))).tolist())


@kernel(writes="counts")
def count_cells(
    normal: Floats3,
    low: Floats2,
    high: Floats2,
    slack: Floats,
    starts: Ints,
    corner: Floats,
    size: Floats,
    levels: int,
    every: bool,
    counts: Floats,
) -> None:
    """Add up the cells of a box that are reached.

    normal, low, high  as in ``PoseBodies``
    slack              (k,) how far planes may be off, mm: what some tool axis reaches at most is wider by it, what
                       every one reaches at least is narrower
    starts             (m + 1,) int64, first body of each tool axis
    corner, size       (3,) lowest corner of the box, and sizes of a cell of the first division, mm
    levels             how often a cell is halved
    every              count what every tool axis reaches; else what some one does
    counts             (3,) written: cells of the first division, at least, by the middles, and at most
    """
    stack = np.empty((8 * (levels + 1), 3))
    depth = np.empty(8 * (levels + 1), np.int64)
    for first in range(_FIRST * _FIRST * _FIRST):
        stack[0, 0] = corner[0] + (first % _FIRST + 0.5) * size[0]
        stack[0, 1] = corner[1] + (first // _FIRST % _FIRST + 0.5) * size[1]
        stack[0, 2] = corner[2] + (first // (_FIRST * _FIRST) + 0.5) * size[2]
        depth[0] = 0
        top = 1
        while top:
            top -= 1
            level = depth[top]
            x, y, z = stack[top, 0], stack[top, 1], stack[top, 2]
            scale = 0.5**level
            hx, hy, hz = 0.5 * scale * size[0], 0.5 * scale * size[1], 0.5 * scale * size[2]
            whole, middle, touched = every, every, every
            for way in range(starts.shape[0] - 1):
                inside, centred, near = _cell_in_bodies(
                    normal, low, high, slack, starts[way], starts[way + 1], every, x, y, z, hx, hy, hz
                )
                if every:
                    whole, middle, touched = whole and inside, middle and centred, touched and near
                    if not touched:
                        break
                else:
                    whole, middle, touched = whole or inside, middle or centred, touched or near
                    if whole:
                        break
            if whole or not touched or level == levels:
                part = scale * scale * scale
                counts[0] += part * whole
                counts[1] += part * (whole or middle)
                counts[2] += part * touched
                continue
            for child in range(8):
                stack[top, 0] = x + (hx if child & 1 else -hx) * 0.5
                stack[top, 1] = y + (hy if child & 2 else -hy) * 0.5
                stack[top, 2] = z + (hz if child & 4 else -hz) * 0.5
                depth[top] = level + 1
                top += 1


@inner
def _cell_in_bodies(
    normal: Floats3,
    low: Floats2,
    high: Floats2,
    slack: Floats,
    first: int,
    end: int,
    every: bool,
    x: float,
    y: float,
    z: float,
    hx: float,
    hy: float,
    hz: float,
) -> tuple[bool, bool, bool]:
    """Whether a cell lies within one of some bodies, whether its middle does, and whether one may touch it.

    x, y, z     the middle
    hx, hy, hz  half of the sides
    """
    whole, middle, touched = False, False, False
    for body in range(first, end):
        inside, centred, near = True, True, True
        narrower, wider = (slack[body], 0.0) if every else (0.0, slack[body])
        for k in range(3):
            a, b, c = normal[body, k, 0], normal[body, k, 1], normal[body, k, 2]
            at = a * x + b * y + c * z
            room = min(at - low[body, k], high[body, k] - at)
            reach = abs(a) * hx + abs(b) * hy + abs(c) * hz
            inside = inside and room >= reach + narrower - _THIN
            centred = centred and room >= 0.0
            near = near and room > _THIN - reach - wider
            if not near:
                break
        whole, middle, touched = whole or inside, middle or centred, touched or near
        if whole:
            break
    return whole, middle, touched
