"""Motions in a plane, and what becomes of them where the tool's centre goes beside them.

In:     where motions end and which are circles, of a run or of an operation of a CL file; how far beside them it goes.
Out:    an ``Insertion``; where no tool fits.
Units:  mm.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.compensation.inserted_rows import Insertion
from trunnion.compensation.offsets import CentrePath, Fault, centre_path
from trunnion.compensation.plane_path import PlanePath, Points
from trunnion.compensation.styles import CompensationStyle
from trunnion.model.toolpath import Arcs
from trunnion.records import dataclass

#: A smaller motion in the plane, mm, is none.
_STILL: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class PlaneMotions:
    """Motions under compensation, and those behind it up to where the tool has left the contour.

    rows    (k,) int64, one after the other
    tip     (k + 1, 3) where the tool is before them, and after each
    curved  (k,) bool: which are circles
    arcs    all circles of the path
    end     the row behind the last one under compensation
    """

    rows: Ints
    tip: Floats
    curved: Flags
    arcs: Arcs
    end: int


@dataclass(frozen=True, slots=True, eq=False)
class _Plane:
    """A plane of compensation: two directions in it as one complex number, and its normal."""

    across: Points
    normal: Floats

    @staticmethod
    def of(normal: Floats) -> "_Plane":
        first = np.cross(normal, np.eye(3)[int(np.abs(normal).argmin())])
        first /= np.linalg.norm(first)
        return _Plane(first + 1j * np.cross(normal, first), normal)

    def seen(self, places: Floats) -> Points:
        return np.asarray(places @ self.across)

    def placed(self, points: Points, heights: Floats) -> Floats:
        return np.asarray(np.outer(points, np.conj(self.across)).real + heights[:, None] * self.normal)


def plane_insertion(
    motions: PlaneMotions, normal: Floats, left: float, style: CompensationStyle
) -> tuple[Insertion | None, list[tuple[int, Fault]]]:
    """Return what becomes of motions where the centre goes ``left`` mm to their left (right: negative), and its faults.

    None where nothing moves in the plane.
    """
    plane, rows, tip = _Plane.of(normal), motions.rows, motions.tip
    points, heights = plane.seen(tip), tip @ plane.normal
    moving = (np.abs(np.diff(points)) > _STILL) | motions.curved
    leaves = _leaves(moving, rows, motions.end)
    if leaves is not None:
        rows, moving = rows[: leaves + 1], moving[: leaves + 1]
    else:
        rows, moving = rows[rows < motions.end], moving[rows < motions.end]
    at = np.flatnonzero(moving)
    if not len(at):
        return None, []
    path, flat = _path(motions, at, points, plane)
    faults = [(int(row), Fault.UNSURE) for row in rows[at[~flat]]]
    found = centre_path(path, left, style, leaves=leaves is not None)
    faults += [(int(rows[at[k]]), fault) for k, fault in found.faults]
    return _placed(found, rows, at, (points, heights), plane), faults


def _leaves(moving: Flags, rows: Ints, end: int) -> int | None:
    """Return the index of the motion on which compensation ends, if there is one."""
    behind = np.flatnonzero(moving & (rows >= end))
    return int(behind[0]) if len(behind) else None


def _path(motions: PlaneMotions, at: Ints, points: Points, plane: _Plane) -> tuple[PlanePath, Flags]:
    """Return some motions as elements in the plane, and whether their circles lie in it."""
    centre, sense, flat = np.zeros(len(at), complex), np.zeros(len(at), np.int64), np.ones(len(at), np.bool_)
    curved = np.flatnonzero(motions.curved[at])
    if len(curved):
        all_arcs = motions.arcs
        arcs = np.searchsorted(all_arcs.row, motions.rows[at[curved]])
        centre[curved] = plane.seen(all_arcs.centre[arcs])
        along = all_arcs.normal[arcs] @ plane.normal
        sense[curved], flat[curved] = np.where(along > 0.0, 1, -1), np.abs(along) > 1.0 - 1e-6
    return PlanePath(points[at], points[at + 1], centre, sense), flat


def _placed(found: CentrePath, rows: Ints, at: Ints, programmed: tuple[Points, Floats], plane: _Plane) -> Insertion:
    """Return a path of the centre as rows; ``at`` are the rows with an element, ``programmed`` their points."""
    points, heights = programmed
    last_own = np.flatnonzero(found.own)
    # Rows that do not move in the plane stay where the element before them ended.
    before = np.cumsum(np.isin(np.arange(len(rows)), at)) - 1
    ends = np.where(before < 0, points[0], found.path.end[last_own][np.maximum(before, 0)])
    inner = ~found.own
    of = at[found.of[inner]]
    path = found.path
    radius = np.abs(path.end - path.centre)
    own = np.flatnonzero(path.sense[last_own])
    return Insertion(
        rows=rows,
        tip=plane.placed(ends, heights[1 : len(rows) + 1]),
        before=rows[of],
        inserted=plane.placed(path.end[inner], heights[of]),
        centre=plane.placed(path.centre[inner], heights[of]),
        normal=path.sense[inner][:, None] * plane.normal,
        radius=radius[inner],
        circles=rows[at[own]],
        circle_radius=radius[last_own][own],
    )
