"""A tile of rays as sweeps pass through it: material is removed, and what the tool meets is measured.

In:     the material of a tile, the sweeps that reach it in the order of the program, and the pieces of the tool.
Out:    the material that is left; for each sweep the volume it removed, how much of it was part of the design, and
        the greatest thickness that an idle cutter, or a section of the tool which does not cut, has met.
Units:  mm, coordinates (u, v, w) of the tile's bundle.

The thickness at a ray is the length of its stretch times the smaller |n_w| of the surfaces at both ends: for two
parallel planes their distance, however the ray passes them.

Idle are rapids and motions with a spindle that stands. What they meet is measured against the material before the first
of them, and then removed: a way in small steps meets as much as the same way in one.
"""

import math
from typing import Annotated, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Flags, Floats, Floats2, Floats3, Ints, Lines
from trunnion.jit import inner, kernel
from trunnion.simulation.cutting.motion_bounds import near_part, strip, swept_box
from trunnion.simulation.cutting.ray_kernel import Ends, Motion, Piece, swept_ends

Rows2: TypeAlias = Annotated[Lines, 2]
Normals: TypeAlias = Annotated[NDArray[np.int8], 3]

#: Columns of what is measured of each sweep.
REMOVED, GOUGED, MET_IDLE, MET = 0, 1, 2, 3

#: What to do with a sweep: cut, or measure what the cutter or everything else meets.
_CUT, _IDLE, _REST = 0, 1, 2

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


class CutterTable(NamedTuple):
    """A tool: ``ray_kernel.piece_list`` and ``element_table``; which pieces cut, and of which section each is."""

    pieces: Floats2
    elements: Floats2
    cuts: Flags
    section: Ints


class Sweeps(NamedTuple):
    """Short motions of one tool, n of them: tip and tool axis at start and end, the row of each, and which are idle.

    Columns of ``poses`` (n, 12) are those of ``Motion``: start tip, start axis, the way of the tip, end axis.
    """

    poses: Floats2
    row: Ints
    idle: Flags


@kernel(writes="count ends rows normals measured places")
def cut_tile(
    rays: Rays,
    count: Lines,
    ends: Floats2,
    rows: Rows2,
    normals: Normals,
    sweeps: Sweeps,
    wanted: Ints,
    begin: int,
    tool: CutterTable,
    tolerance: float,
    measured: Floats2,
    places: Floats3,
) -> int:
    """Cut a tile with the sweeps ``wanted[begin:]``.

    count     (r,)        stretches of material of each ray; r = nu * nv, v fastest
    ends      (r, 2 s)    starts and ends of up to s stretches, ascending
    rows      (r, 2 s)    rows of the run that made them, -1 for the stock itself
    normals   (r, 2 s, 3) unit normals out of the material there, in 127ths
    measured  (k, 3 + q)  for each sweep: volume removed, and of the design, mm³; the greatest thickness that the cutter
                          met while idle, and that section q of the tool met, mm
    places    (k, 3 + q, 3)  (u, v, w) of the greatest thicknesses

    Returns the index in ``wanted`` at which a ray needs more than s stretches, or their number. The sweep of that
    index has to be made again.
    """
    inside = _material(rays.u, rays.v, count, ends)
    pending = -1
    k = begin
    while True:
        idle = k < len(wanted) and sweeps.idle[wanted[k]]
        if pending >= 0 and not idle:
            for j in range(pending, k):
                if not _pass(
                    j,
                    _CUT,
                    rays,
                    count,
                    ends,
                    rows,
                    normals,
                    sweeps,
                    wanted[j],
                    tool,
                    tolerance,
                    inside,
                    measured,
                    places,
                ):
                    return j
            pending = -1
        if k == len(wanted):
            return k
        if idle:
            if pending < 0:
                pending = k
            _pass(
                k, _IDLE, rays, count, ends, rows, normals, sweeps, wanted[k], tool, tolerance, inside, measured, places
            )
        elif not _pass(
            k, _CUT, rays, count, ends, rows, normals, sweeps, wanted[k], tool, tolerance, inside, measured, places
        ):
            return k
        _pass(k, _REST, rays, count, ends, rows, normals, sweeps, wanted[k], tool, tolerance, inside, measured, places)
        k += 1


@inner
def _pass(
    k: int,
    task: int,
    rays: Rays,
    count: Lines,
    ends: Floats2,
    rows: Rows2,
    normals: Normals,
    sweeps: Sweeps,
    sweep: int,
    tool: CutterTable,
    tolerance: float,
    inside: tuple[float, float, float, float, float, float],
    measured: Floats2,
    places: Floats3,
) -> bool:
    """Cut or measure with one sweep; False if a ray needs more room for stretches."""
    low_u, low_v = rays.u[0], rays.v[0]
    nu, nv = len(rays.u), len(rays.v)
    step_u = rays.u[1] - low_u if nu > 1 else 1.0
    step_v = rays.v[1] - low_v if nv > 1 else 1.0
    design_first, design, area = rays.design_first, rays.design, rays.area
    table = tool.elements
    p = sweeps.poses[sweep]
    motion = Motion(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11])
    back = Motion(p[0] + p[6], p[1] + p[7], p[2] + p[8], p[9], p[10], p[11], -p[6], -p[7], -p[8], p[3], p[4], p[5])
    row = sweeps.row[sweep]
    for number in range(len(tool.cuts)):
        if tool.cuts[number] == (task == _REST):
            continue
        q = tool.pieces[number]
        piece = Piece(int(q[0]), int(q[1]), q[2], q[3], q[4], q[5], q[6])
        low, high = near_part(motion, piece, inside)
        if low > high:
            continue
        box = swept_box(motion, piece, low, high)
        first_u = max(0, math.ceil((box[0] - low_u) / step_u))
        last_u = min(nu - 1, math.floor((box[1] - low_u) / step_u))
        first_v = max(0, math.ceil((box[2] - low_v) / step_v))
        last_v = min(nv - 1, math.floor((box[3] - low_v) / step_v))
        column = MET_IDLE if task == _IDLE else MET + tool.section[number]
        view = strip(motion, piece)
        for i in range(first_u, last_u + 1):
            for j in range(first_v, last_v + 1):
                ray = i * nv + j
                if count[ray] == 0:
                    continue
                bottom, top = ends[ray, 0], ends[ray, 2 * count[ray] - 1]
                if bottom >= box[5] or top <= box[4]:
                    continue
                u, v = rays.u[i], rays.v[j]
                ahead = (u - view.u) * view.v_axis - (v - view.v) * view.u_axis
                if abs(ahead) > view.widest:
                    continue
                # What the tool leaves behind it is farthest out at its start: from there the search is shorter.
                leaves = ahead * view.along < 0.0
                if view.along == 0.0:
                    leaves = (u - view.u) * motion.du + (v - view.v) * motion.dv < 0.0
                found = swept_ends(u, v, back if leaves else motion, piece, table, tolerance, bottom, top)
                if not found.hit or not _meets(ray, found.low, found.high, count, ends):
                    continue
                if task == _CUT:
                    if not _fits(ray, found, count, ends):
                        return False
                    _measure(k, ray, found, area, design_first, design, count, ends, measured)
                    _remove(ray, found, row, count, ends, rows, normals)
                else:
                    _meet(k, ray, u, v, found, count, ends, normals, measured, places, column)
    return True


@inner
def _material(u: Floats, v: Floats, count: Lines, ends: Floats2) -> tuple[float, float, float, float, float, float]:
    """A box around the material of a tile: lowest and highest u, v and w."""
    low, high = math.inf, -math.inf
    for ray in range(len(count)):
        if count[ray] > 0:
            low, high = min(low, ends[ray, 0]), max(high, ends[ray, 2 * count[ray] - 1])
    return u[0], u[-1], v[0], v[-1], low, high


@inner
def _meets(ray: int, low: float, high: float, count: Lines, ends: Floats2) -> bool:
    """Whether a ray has material between two heights."""
    longest = 0.0
    for s in range(count[ray]):
        longest = max(longest, min(high, ends[ray, 2 * s + 1]) - max(low, ends[ray, 2 * s]))
    return longest >= TRACE


@inner
def _measure(
    k: int,
    ray: int,
    found: Ends,
    area: float,
    design_first: Ints,
    design: Floats,
    count: Lines,
    ends: Floats2,
    measured: Floats2,
) -> None:
    """Measure what is removed from a ray, and how much of it belongs to the design."""
    for s in range(count[ray]):
        start, end = max(found.low, ends[ray, 2 * s]), min(found.high, ends[ray, 2 * s + 1])
        if end - start < TRACE:
            continue
        measured[k, REMOVED] += (end - start) * area
        for m in range(design_first[ray], design_first[ray + 1]):
            measured[k, GOUGED] += max(0.0, min(end, design[2 * m + 1]) - max(start, design[2 * m])) * area


@inner
def _meet(
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
def _fits(ray: int, found: Ends, count: Lines, ends: Floats2) -> bool:
    """Whether a ray has room for what is left of it: a cut within a stretch makes two of it."""
    if count[ray] < ends.shape[1] // 2:
        return True
    divided = False
    for s in range(count[ray]):
        divided = divided or (ends[ray, 2 * s] < found.low - TRACE and ends[ray, 2 * s + 1] > found.high + TRACE)
    return not divided


@inner
def _remove(ray: int, found: Ends, row: int, count: Lines, ends: Floats2, rows: Rows2, normals: Normals) -> None:
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


@kernel(writes="lists")
def bin_sweeps(boxes: Floats2, tiles: Floats2, first: Ints, lists: Ints) -> None:
    """Fill lists of the sweeps that reach each tile, in order.

    boxes   (n, 6) lowest and highest u, v, w of each sweep
    tiles   (m, 6) the same of the material of each tile
    first   (m + 1,) where the list of each tile begins in ``lists``; negative: only count, into ``lists`` (m,)
    """
    counting = first[0] < 0
    for tile in range(len(tiles)):
        at = 0 if counting else first[tile]
        for sweep in range(len(boxes)):
            apart = False
            for axis in range(3):
                if boxes[sweep, 2 * axis] >= tiles[tile, 2 * axis + 1]:
                    apart = True
                if boxes[sweep, 2 * axis + 1] <= tiles[tile, 2 * axis]:
                    apart = True
            if not apart:
                if not counting:
                    lists[at] = sweep
                at += 1
        if counting:
            lists[tile] = at
