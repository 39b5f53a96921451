"""The stretches of material of a ray: what a tool that covers a part of the ray removes or meets.

In:     a ray of a tile, and the interval of it that the tool covers.
Out:    the stretches that are left, and what is measured.
Units:  mm, coordinates (u, v, w) of the tile's bundle.

The thickness at a ray is the length of its stretch times the smaller |n_w| of the surfaces at both ends: for two
parallel planes their distance, however the ray passes them.
"""

import math
from typing import Annotated, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Floats2, Floats3, Ints, Lines
from trunnion.jit import inner
from trunnion.simulation.cutting.ray_kernel import Ends

Rows2: TypeAlias = Annotated[Lines, 2]
Normals: TypeAlias = Annotated[NDArray[np.int8], 3]

#: Columns of what is measured of each sweep.
REMOVED, GOUGED, MET_IDLE, MET = 0, 1, 2, 3

#: Shorter stretches than this do not count as material, mm: rounding of a path that is cut again.
TRACE = 1e-7


class Rays(NamedTuple):
    """The rays of a tile: where they are along u and v, and the cell's area.

    design_first  (nu * nv + 1,) the stretches of ray k within the design are design_first[k]:design_first[k + 1]
    design        (2 m,)         their starts and ends along w, mm
    """

    u: Floats
    v: Floats
    area: float
    design_first: Ints
    design: Floats


@inner
def is_clear(ray: int, bounds: tuple[float, float], count: Lines, ends: Floats2, gaps: Floats2) -> bool:
    """Whether a ray has no material between two heights; if so, it is looked for there first the next time."""
    low, high = bounds
    if low > gaps[ray, 0] - TRACE and high < gaps[ray, 1] + TRACE:
        return True
    for s in range(count[ray]):
        if min(high, ends[ray, 2 * s + 1]) - max(low, ends[ray, 2 * s]) >= TRACE:
            return False
    find_gap(ray, 0.5 * (low + high), count, ends, gaps)
    return True


@inner
def find_gap(ray: int, at: float, count: Lines, ends: Floats2, gaps: Floats2) -> None:
    """Take up the gap of a ray's material in which a height is, if it is in one."""
    low = -math.inf
    for s in range(count[ray]):
        if ends[ray, 2 * s] >= at:
            gaps[ray, 0], gaps[ray, 1] = low, ends[ray, 2 * s]
            return
        low = ends[ray, 2 * s + 1]
        if low > at:
            return
    gaps[ray, 0], gaps[ray, 1] = low, math.inf


@inner
def measure(k: int, ray: int, found: Ends, rays: Rays, count: Lines, ends: Floats2, measured: Floats2) -> None:
    """Measure what is removed from a ray, and how much of it belongs to the design."""
    for s in range(count[ray]):
        start, end = max(found.low, ends[ray, 2 * s]), min(found.high, ends[ray, 2 * s + 1])
        if end - start < TRACE:
            continue
        measured[k, REMOVED] += (end - start) * rays.area
        for m in range(rays.design_first[ray], rays.design_first[ray + 1]):
            common = min(end, rays.design[2 * m + 1]) - max(start, rays.design[2 * m])
            measured[k, GOUGED] += max(0.0, common) * rays.area


@inner
def meet(
    k: int,
    ray: int,
    u: float,
    v: float,
    found: Ends,
    count: Lines,
    ends: Floats2,
    normals: Normals,
    measured: Floats2,
    places: Floats3,
    column: int,
) -> None:
    """Measure the material of a ray that an idle cutter met, or a section that does not cut."""
    for s in range(count[ray]):
        start, end = max(found.low, ends[ray, 2 * s]), min(found.high, ends[ray, 2 * s + 1])
        if end - start > TRACE:
            from_slope, to_slope = _slopes(ray, s, found, ends, normals)
            _thicker(k, u, v, start, end, min(from_slope, to_slope), measured, places, column)


@inner
def _slopes(ray: int, s: int, found: Ends, ends: Floats2, normals: Normals) -> tuple[float, float]:
    """|n_w| where what the tool covers of a stretch begins and ends: of the tool, or of the material."""
    one, two = abs(normals[ray, 2 * s, 2]) / 127.0, abs(normals[ray, 2 * s + 1, 2]) / 127.0
    if found.low > ends[ray, 2 * s]:
        one = abs(found.low_w)
    if found.high < ends[ray, 2 * s + 1]:
        two = abs(found.high_w)
    return one, two


@inner
def _thicker(
    k: int,
    u: float,
    v: float,
    start: float,
    end: float,
    slope: float,
    measured: Floats2,
    places: Floats3,
    column: int,
) -> None:
    """Keep a thickness if it is the greatest."""
    if (end - start) * slope > measured[k, column]:
        measured[k, column] = (end - start) * slope
        places[k, column, 0], places[k, column, 1], places[k, column, 2] = u, v, 0.5 * (start + end)


@inner
def fits(ray: int, found: Ends, count: Lines, ends: Floats2) -> bool:
    """Whether a ray has room for what is left of it: a cut within a stretch makes two of it."""
    if count[ray] < ends.shape[1] // 2:
        return True
    divided = False
    for s in range(count[ray]):
        divided = divided or (ends[ray, 2 * s] < found.low - TRACE and ends[ray, 2 * s + 1] > found.high + TRACE)
    return not divided


@inner
def remove(ray: int, found: Ends, row: int, count: Lines, ends: Floats2, rows: Rows2, normals: Normals) -> None:
    """Take what the tool covers from a ray."""
    low, high = found.low, found.high
    s = 0
    while s < count[ray]:
        start, end = ends[ray, 2 * s], ends[ray, 2 * s + 1]
        if end <= low + TRACE:
            s += 1
            continue
        if start >= high - TRACE:
            break
        keeps_start, keeps_end = start < low - TRACE, end > high + TRACE
        if keeps_start and keeps_end:
            for m in range(2 * count[ray] - 1, 2 * s, -1):
                _copy_end(ray, m, m + 2, ends, rows, normals)
            count[ray] += 1
            _set_end(ray, 2 * s + 1, low, row, found.low_u, found.low_v, found.low_w, ends, rows, normals)
            _set_end(ray, 2 * s + 2, high, row, found.high_u, found.high_v, found.high_w, ends, rows, normals)
            break
        if keeps_start:
            _set_end(ray, 2 * s + 1, low, row, found.low_u, found.low_v, found.low_w, ends, rows, normals)
            s += 1
        elif keeps_end:
            _set_end(ray, 2 * s, high, row, found.high_u, found.high_v, found.high_w, ends, rows, normals)
            break
        else:
            for m in range(2 * s + 2, 2 * count[ray]):
                _copy_end(ray, m, m - 2, ends, rows, normals)
            count[ray] -= 1


@inner
def _copy_end(ray: int, source: int, target: int, ends: Floats2, rows: Rows2, normals: Normals) -> None:
    ends[ray, target] = ends[ray, source]
    rows[ray, target] = rows[ray, source]
    for axis in range(3):
        normals[ray, target, axis] = normals[ray, source, axis]


@inner
def _set_end(
    ray: int,
    at: int,
    value: float,
    row: int,
    u: float,
    v: float,
    w: float,
    ends: Floats2,
    rows: Rows2,
    normals: Normals,
) -> None:
    """Write an end of a stretch: the material's normal is opposite to (u, v, w), that of the tool."""
    ends[ray, at] = value
    rows[ray, at] = row
    normals[ray, at, 0] = np.int8(round(-127.0 * u))
    normals[ray, at, 1] = np.int8(round(-127.0 * v))
    normals[ray, at, 2] = np.int8(round(-127.0 * w))
