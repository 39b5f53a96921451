"""The run of the tool's centre: what a control drives where the program compensates the radius.

In:     a run, whose positions under compensation are those that its blocks program, and how far beside it goes.
Out:    the run as the tool's centre goes, with rows for what the control inserts at corners; where no tool fits.
Units:  mm.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.compensation.inserted_rows import Insertion, with_inserted_rows
from trunnion.compensation.offsets import CentrePath, Fault, centre_path
from trunnion.compensation.plane_path import PlanePath, Points
from trunnion.compensation.stretches import Stretch
from trunnion.compensation.styles import STYLES
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

#: A smaller motion in the plane, mm, is none.
_STILL: Final = 1e-6

#: A smaller offset, mm, is none.
NOTHING: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class CentreRun:
    """What a control drives.

    run     with the positions of the tool's centre
    row_of  (n,) int64: the row of this run that ends a row of the program
    faults  rows of the program, each with what is wrong there
    """

    run: Run
    row_of: Ints
    faults: tuple[tuple[int, Fault], ...]


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


def run_of_centre(run: Run, offsets: Sequence[tuple[Stretch, float]]) -> CentreRun:
    """Return the run of the tool's centre, ``offsets`` mm beside what the stretches program, each on its side."""
    found, faults = list[Insertion](), list[tuple[int, Fault]]()
    before, last = 0.0, 0
    for stretch, offset in offsets:
        comes_back = stretch.first == last and abs(before) > NOTHING
        before, last = offset, stretch.end
        if abs(offset) <= NOTHING and not comes_back:
            continue
        insertion = _insertion(run, stretch, offset, faults)
        if insertion is not None:
            found.append(insertion)
    if not found:
        return CentreRun(run, np.arange(len(run)), tuple(faults))
    return CentreRun(*with_inserted_rows(run, found), tuple(faults))


def _insertion(run: Run, stretch: Stretch, offset: float, faults: list[tuple[int, Fault]]) -> Insertion | None:
    """Return what becomes of a stretch; None, with the reason among the faults, where that is not known."""
    style = STYLES.get(stretch.style)
    touches = stretch.first and run.state.compensation[stretch.first - 1]
    if style is None or stretch.plane < 0 or touches:
        faults.append((stretch.first, Fault.UNSURE))
        return None
    plane = _Plane.of(run.compensation_planes[stretch.plane])
    last = _last_row(run, stretch)
    rows = np.arange(stretch.first, last)
    tip = run.positions(np.arange(stretch.first - 1, last)).tip
    points, heights = plane.seen(tip), tip @ plane.normal
    moving = (np.abs(np.diff(points)) > _STILL) | (run.kind[rows] == Kind.ARC)
    leaves = _leaves(moving, rows, stretch.end)
    if leaves is not None:
        rows, moving = rows[: leaves + 1], moving[: leaves + 1]
    else:
        rows, moving = rows[rows < stretch.end], moving[rows < stretch.end]
    at = np.flatnonzero(moving)
    if not len(at):
        return None
    path, flat = _path(run, rows[at], points[at], points[at + 1], plane)
    faults += [(int(row), Fault.UNSURE) for row in rows[at[~flat]]]
    found = centre_path(path, stretch.side * offset, style, leaves=leaves is not None)
    faults += [(int(rows[at[k]]), fault) for k, fault in found.faults]
    return _placed(found, rows, at, (points, heights), plane)


def _last_row(run: Run, stretch: Stretch) -> int:
    """Return the row behind the last one that may belong to a stretch: up to the next one, or a machine position."""
    state = run.state
    others = [
        int(row) for column in (state.compensation, state.machine_frame) for row in column.rows if row > stretch.end
    ]
    stops = stretch.end >= len(run) or state.machine_frame[stretch.end] or state.compensation[stretch.end]
    return stretch.end if stops else min([*others, len(run)])


def _leaves(moving: Flags, rows: Ints, end: int) -> int | None:
    """Return the index of the motion on which compensation ends, if there is one."""
    behind = np.flatnonzero(moving & (rows >= end))
    return int(behind[0]) if len(behind) else None


def _path(run: Run, rows: Ints, start: Points, end: Points, plane: _Plane) -> tuple[PlanePath, Flags]:
    """Return the motions of rows as elements in the plane, and whether their circles lie in it."""
    centre, sense, flat = np.zeros(len(rows), complex), np.zeros(len(rows), np.int64), np.ones(len(rows), np.bool_)
    curved = np.flatnonzero(run.kind[rows] == Kind.ARC)
    if len(curved):
        arcs = np.searchsorted(run.arcs.row, rows[curved])
        centre[curved] = plane.seen(run.arcs.centre[arcs])
        along = run.arcs.normal[arcs] @ plane.normal
        sense[curved], flat[curved] = np.where(along > 0.0, 1, -1), np.abs(along) > 1.0 - 1e-6
    return PlanePath(start, end, centre, sense), flat


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
