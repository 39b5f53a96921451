"""The path of operations as polylines to be drawn.

In:     operations in one coordinate system.
Out:    ``PathSeries``: the points of each, and which of its steps are rapids.

Arcs become chords, holes lines from their clearance to the bottom. Points that lie nearly on the line between their
neighbours are left out where a path has more than can be drawn.
"""

from collections.abc import Iterable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Flags, Floats
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, Operation
from trunnion.planning.holes.cycles import HoleCycleError, cycle_from_event
from trunnion.planning.holes.operations import hole_rows
from trunnion.planning.linearization.arc_chords import lines_for_arcs
from trunnion.records import dataclass
from trunnion.reporting.text import clean

#: Points that a page can hold and a browser can turn.
MAX_POINTS: Final = 1_000_000

#: How far a chord may leave its arc, mm.
_CHORD_TOLERANCE: Final = 0.02

#: How far a point that is left out may lie off the line between its neighbours, mm, and how often that is tried.
_FIRST_TOLERANCE: Final = 0.001
_MOST_PASSES: Final = 60


@dataclass(frozen=True, slots=True, eq=False)
class PathSeries:
    """The path of one operation.

    name     of the operation
    details  what else is shown of it
    points   (n, 3) float32, mm
    rapid    (n,)   int32   1 where the step to the point is a rapid
    """

    name: str
    details: str
    points: NDArray[np.float32]
    rapid: NDArray[np.int32]


def collect_paths(
    operations: Iterable[tuple[str, Operation]], most: int = MAX_POINTS
) -> tuple[list[PathSeries], float]:
    """Return the paths of operations.

    operations  what is shown of each, and the operation, all in one coordinate system
    most        more points than this are thinned out

    paths      those that have points
    tolerance  how far points that are left out lie off the lines that are drawn, mm; 0 if none is
    """
    drawn = [(details, operation, *_polyline(operation)) for details, operation in operations if len(operation.moves)]
    tolerance, passes = 0.0, 0
    while sum(len(points) for *_, points, _ in drawn) > most and passes < _MOST_PASSES:
        step = _FIRST_TOLERANCE * 2.0 ** (passes // 2)
        tolerance += step
        drawn = [(details, operation, *_thinned(points, rapid, step)) for details, operation, points, rapid in drawn]
        passes += 1
    paths = [
        PathSeries(clean(operation.name), details, points.astype(np.float32), rapid.astype(np.int32))
        for details, operation, points, rapid in drawn
    ]
    return paths, tolerance


def _polyline(operation: Operation) -> tuple[Floats, Flags]:
    """Points of an operation, (n, 3), and whether the step to each is a rapid."""
    holes, arcs = hole_rows(operation), operation.arcs
    if not holes.any():
        # The start of an arc in the first row is not known here.
        moves = lines_for_arcs(operation, arcs.row == 0, _CHORD_TOLERANCE).moves
        return moves.tip, moves.kind == Kind.RAPID
    tip, axis = operation.moves.tip, operation.moves.axis
    clear, depth = _heights(operation)
    copies = np.where(holes, 3, 1)
    source = np.repeat(np.arange(len(tip)), copies)
    part = np.arange(len(source)) - np.repeat(np.cumsum(copies) - copies, copies)
    height = np.where(part == 1, -depth[source], clear[source])
    is_hole = holes[source]
    points = tip[source] + np.where(is_hole, height, 0.0)[:, None] * axis[source]
    rapid = np.where(is_hole, part != 1, (operation.moves.kind == Kind.RAPID)[source])
    return points, np.asarray(rapid, np.bool_)


def _heights(operation: Operation) -> tuple[Floats, Floats]:
    """Clearance above and depth below each point, (n,) mm, of the cycle in force; 0 where it is not known."""
    clear, depth = np.zeros(len(operation.moves)), np.zeros(len(operation.moves))
    for event in operation.events:
        if isinstance(event, CycleOn):
            try:
                cycle = cycle_from_event(event)
            except HoleCycleError:
                clear[event.row :] = depth[event.row :] = 0.0
            else:
                clear[event.row :], depth[event.row :] = cycle.rapid_height, cycle.depth
        elif isinstance(event, CycleOff):
            clear[event.row :] = depth[event.row :] = 0.0
    return clear, depth


def _thinned(points: Floats, rapid: Flags, tolerance: float) -> tuple[Floats, Flags]:
    """Without every second point, but those farther than a tolerance off the chord, or at the end of rapids or cuts."""
    n = len(points)
    if n < 3:
        return points, rapid
    middle = np.arange(1, n - 1, 2)
    start, end = points[middle - 1], points[middle + 1]
    along = end - start
    length = np.linalg.norm(along, axis=1)
    offset = points[middle] - start
    share = np.clip(np.einsum("ij,ij->i", offset, along) / np.maximum(length, 1e-12) ** 2, 0.0, 1.0)
    off = np.linalg.norm(offset - share[:, None] * along, axis=1)
    keep = np.ones(n, np.bool_)
    keep[middle[(off <= tolerance) & (rapid[middle] == rapid[middle + 1])]] = False
    return points[keep], rapid[keep]
