"""A tile of rays as sweeps pass through it: material is removed, and what the tool meets is measured.

In:     the material of a tile, the sweeps that reach it in the order of the program, and the pieces of the tool.
Out:    the material that is left; for each sweep the volume it removed, how much of it was part of the design, and
        the greatest thickness that an idle cutter, or a section of the tool which does not cut, has met.
Units:  mm, coordinates (u, v, w) of the tile's bundle.

Idle are rapids and motions with a spindle that stands. What they meet is measured against the material before the first
of them, and then removed: a way in small steps meets as much as the same way in one.
"""

import math
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Floats3, Ints, Ints2, Lines
from trunnion.jit import inner, kernel
from trunnion.simulation.cutting.motion_bounds import EDGES, Box, near_part, outline, passage, swept_box, within
from trunnion.simulation.cutting.pose_kernel import (
    KEPT,
    U_BEHIND,
    V_BEHIND,
    U,
    V,
    Work,
    at_pose,
    found_at,
    keep,
    new_work,
)
from trunnion.simulation.cutting.ray_kernel import swept_ends, within_tangents
from trunnion.simulation.cutting.stretch_kernel import (
    MET,
    MET_IDLE,
    Normals,
    Rays,
    Rows2,
    find_gap,
    fits,
    is_clear,
    measure,
    meet,
    remove,
)
from trunnion.simulation.cutting.tool_table import Motion, Piece

#: What to do with a sweep: cut, or measure what the cutter or everything else meets.
_CUT, _IDLE, _REST = 0, 1, 2

#: Outlines are drawn where a box has more rays than this.
_OUTLINED = 64


class CutterTable(NamedTuple):
    """A tool: ``tool_table.piece_list`` and ``element_table``; which pieces cut, and of which section each is."""

    pieces: Floats2
    elements: Floats2
    cuts: Flags
    section: Ints


class Desk(NamedTuple):
    """What the sweeps of a tile use one after another.

    work    of ``pose_kernel``
    listed  (2, r)  the rays that a sweep may hit ahead and behind
    gaps    (r, 2)  a gap of the material of each ray, open to both sides: its ends along w
    edges   of ``motion_bounds.outline``
    """

    work: Work
    listed: Ints2
    gaps: Floats2
    edges: Floats


class Sweeps(NamedTuple):
    """Short motions of one tool, n of them: tip and tool axis at start and end, the row of each, and which are idle.

    Columns of ``poses`` (n, 12) are those of ``Motion``: start tip, start axis, the way of the tip, end axis.
    """

    poses: Floats2
    row: Ints
    idle: Flags


@kernel(writes="count ends rows normals measured places", checks_division=False)
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
    desk = Desk(new_work(), np.empty((2, len(count)), np.int64), np.empty((len(count), 2)), np.empty(3 * EDGES))
    for ray in range(len(count)):
        desk.gaps[ray, 0] = ends[ray, 2 * count[ray] - 1] if count[ray] else -math.inf
        desk.gaps[ray, 1] = math.inf
    pending = -1
    k = begin
    while True:
        idle = k < len(wanted) and sweeps.idle[wanted[k]]
        first = k
        if idle and pending < 0:
            pending = k
        elif pending >= 0 and not idle:
            first, pending = pending, -1
        # What the idle sweeps before this one have met is removed first.
        for j in range(first, k + 2 if k < len(wanted) else k):
            task = _CUT if j < k or (j == k and not idle) else (_IDLE if j == k else _REST)
            at = min(j, k)
            if not _pass(
                at, task, rays, count, ends, rows, normals, sweeps, wanted[at], tool, tolerance, inside, desk,
                measured, places,
            ):  # fmt: skip
                return at
        if k == len(wanted):
            return k
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
    inside: Box,
    desk: Desk,
    measured: Floats2,
    places: Floats3,
) -> bool:
    """Cut or measure with one sweep; False if a ray needs more room for stretches."""
    table, work, gaps = tool.elements, desk.work, desk.gaps
    p = sweeps.poses[sweep]
    ahead = Motion(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11])
    back = Motion(p[0] + p[6], p[1] + p[7], p[2] + p[8], p[9], p[10], p[11], -p[6], -p[7], -p[8], p[3], p[4], p[5])
    for number in range(len(tool.cuts)):
        if tool.cuts[number] == (task == _REST):
            continue
        q = tool.pieces[number]
        piece = Piece(int(q[0]), int(q[1]), q[2], q[3], q[4], q[5], q[6])
        low, high = near_part(ahead, piece, inside)
        if low > high:
            continue
        listed = _list_rays(rays, ahead, piece, table, low, high, desk)
        column = MET_IDLE if task == _IDLE else MET + tool.section[number]
        # What the tool leaves behind it is farthest out at its start: from there the search is shorter.
        for side in range(2):
            motion = back if side else ahead
            if side:
                for n in range(listed[1]):
                    work[U + n], work[V + n] = work[U_BEHIND + n], work[V_BEHIND + n]
            kept = _reached(side, listed[side], motion, piece, table, count, ends, desk)
            if kept == 0:
                continue
            at_pose(work, 0, kept, motion, 0.0, piece, table)
            way = passage(motion, piece, table)
            for n in range(kept):
                ray, before, after = desk.listed[side, n], found_at(work, n), found_at(work, n + KEPT)
                if before.hit and after.hit and is_clear(ray, within_tangents(before, after), count, ends, gaps):
                    continue
                u, v, last = work[U + n], work[V + n], 2 * count[ray] - 1
                found = swept_ends(
                    u, v, work, motion, way, piece, table, tolerance, ends[ray, 0], ends[ray, last], before, after
                )
                if not found.hit or is_clear(ray, (found.low, found.high), count, ends, gaps):
                    continue
                if task != _CUT:
                    meet(k, ray, u, v, found, count, ends, normals, measured, places, column)
                    continue
                if not fits(ray, found, count, ends):
                    return False
                measure(k, ray, found, rays, count, ends, measured)
                remove(ray, found, sweeps.row[sweep], count, ends, rows, normals)
                find_gap(ray, 0.5 * (found.low + found.high), count, ends, gaps)
    return True


@inner
def _list_rays(
    rays: Rays, motion: Motion, piece: Piece, table: Floats2, low: float, high: float, desk: Desk
) -> tuple[int, int]:
    """List the rays that a piece, from z ``low`` to ``high``, may hit: those ahead of it, and those behind it.

    Rays without material where the piece is are left out. Returns their numbers.
    """
    low_u, low_v = rays.u[0], rays.v[0]
    nu, nv = len(rays.u), len(rays.v)
    step_u = rays.u[1] - low_u if nu > 1 else 1.0
    step_v = rays.v[1] - low_v if nv > 1 else 1.0
    box = swept_box(motion, piece, low, high)
    first_u = max(0, math.ceil((box[0] - low_u) / step_u))
    last_u = min(nu - 1, math.floor((box[1] - low_u) / step_u))
    many = (last_u - first_u) * (box[3] - box[2]) > _OUTLINED * step_v
    if many:
        outline(desk.edges, motion, piece, table, low, high)
    ahead_u, ahead_v, middle = _ahead(motion)
    ahead, behind = 0, 0
    for i in range(first_u, last_u + 1):
        u = rays.u[i]
        lowest, highest = within(desk.edges, u, box[2], box[3]) if many else (box[2], box[3])
        first_v = max(0, math.ceil((lowest - low_v) / step_v))
        last_v = min(nv - 1, math.floor((highest - low_v) / step_v))
        for j in range(first_v, last_v + 1):
            ray, v = i * nv + j, rays.v[j]
            if desk.gaps[ray, 0] <= box[4] and desk.gaps[ray, 1] >= box[5]:
                continue
            if u * ahead_u + v * ahead_v < middle:
                desk.work[U_BEHIND + behind], desk.work[V_BEHIND + behind] = u, v
                desk.listed[1, behind] = ray
                behind += 1
            else:
                desk.work[U + ahead], desk.work[V + ahead] = u, v
                desk.listed[0, ahead] = ray
                ahead += 1
    return ahead, behind


@inner
def _ahead(motion: Motion) -> tuple[float, float, float]:
    """Return a line across the rays that divides those ahead of a motion from those behind: n_u u + n_v v < d is
    behind.
    """
    u_axis, v_axis = 0.5 * (motion.au + motion.bu), 0.5 * (motion.av + motion.bv)
    along = motion.du * v_axis - motion.dv * u_axis
    shown = u_axis * u_axis + v_axis * v_axis
    ahead_u, ahead_v = v_axis * along, -u_axis * along
    # A tool that is seen from its end, or moves along its axis.
    if shown < 0.01 or along * along < 1e-3 * shown * (motion.du**2 + motion.dv**2):
        ahead_u, ahead_v = motion.du, motion.dv
    middle = ahead_u * (motion.tu + 0.5 * motion.du) + ahead_v * (motion.tv + 0.5 * motion.dv)
    return ahead_u, ahead_v, middle


@inner
def _reached(
    side: int,
    listed: int,
    motion: Motion,
    piece: Piece,
    table: Floats2,
    count: Lines,
    ends: Floats2,
    desk: Desk,
) -> int:
    """Keep the listed rays whose material a piece may reach, by where it is at the end of a motion; their number."""
    if listed == 0:
        return 0
    at_pose(desk.work, 0, listed, motion, 1.0, piece, table)
    kept = 0
    for n in range(listed):
        ray, found = desk.listed[side, n], found_at(desk.work, n)
        if found.hit:
            bounds = found.first - max(found.down, 0.0), found.last - min(found.up, 0.0)
            if is_clear(ray, bounds, count, ends, desk.gaps):
                continue
        keep(desk.work, n, kept)
        desk.listed[side, kept] = ray
        kept += 1
    return kept


@inner
def _material(u: Floats, v: Floats, count: Lines, ends: Floats2) -> Box:
    """Return a box around the material of a tile: lowest and highest u, v and w."""
    low, high = math.inf, -math.inf
    for ray in range(len(count)):
        if count[ray] > 0:
            low, high = min(low, ends[ray, 0]), max(high, ends[ray, 2 * count[ray] - 1])
    return u[0], u[-1], v[0], v[-1], low, high


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
