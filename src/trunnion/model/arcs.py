"""What counts as one circle: the tolerances that reader, planner, writers and proof share, mm."""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.toolpath import Arcs, Operation

#: How far start and end of an arc may be off its radius: coordinates are printed with three or four decimals.
ARC_POINT_TOLERANCE: Final = 0.02

#: An arc whose end comes within this of its start, seen along its axis, ends where it starts: it is a full turn.
CLOSED_ARC: Final = 1e-4

#: An arc that rises by less than this is flat: the last digits of its points differ.
FLAT_ARC: Final = 1e-4


def arc_gaps(arcs: Arcs, tip: Floats) -> Floats:
    """(m,) float64: distance from start to end of each arc, seen along its axis, mm; ``tip`` (n, 3)."""
    return np.asarray(np.linalg.norm(np.cross(tip[arcs.row] - tip[arcs.row - 1], arcs.normal), axis=1))


def with_closed_turns(operation: Operation) -> Operation:
    """Return the operation with full turns about X, Y or Z that end exactly over their start.

    Where a last digit parts start and end, a control would make a short arc of the turn.
    """
    arcs, tip = operation.arcs, operation.moves.tip
    if not len(arcs.row):
        return operation
    about = np.abs(arcs.normal).argmax(axis=1)
    gap = np.abs(tip[arcs.row] - tip[arcs.row - 1])
    gap[np.arange(len(about)), about] = 0.0
    closed = np.flatnonzero((arc_gaps(arcs, tip) < CLOSED_ARC) & (gap.max(axis=1) > 0.0))
    if not len(closed):
        return operation
    tip = tip.copy()
    for m in np.flatnonzero(arc_gaps(arcs, operation.moves.tip) < CLOSED_ARC).tolist():
        row, across = int(arcs.row[m]), [k for k in range(3) if k != about[m]]
        tip[row, across] = tip[row - 1, across]
    return replace(operation, moves=replace(operation.moves, tip=tip))


def arc_lengths(arcs: Arcs, start: Floats, end: Floats) -> Floats:
    """Lengths of arcs and helices, (m,) mm, from ``start`` to ``end``, (m, 3) each."""
    rise = np.einsum("ij,ij->i", end - start, arcs.normal)
    angle = swept_angles(arcs, start, end)
    return np.asarray(np.hypot(arcs.radius * (angle + 2.0 * np.pi * arcs.full_turns), rise))


def swept_angles(arcs: Arcs, start: Floats, end: Floats) -> Floats:
    """Angles of the last turns of arcs and helices, (m,) radians, a full one where they close."""
    first, last = start - arcs.centre, end - arcs.centre
    rise = np.einsum("ij,ij->i", last - first, arcs.normal)
    across = np.einsum("ij,ij->i", np.cross(first, last), arcs.normal)
    angle = np.arctan2(across, np.einsum("ij,ij->i", first, last) - rise * np.einsum("ij,ij->i", first, arcs.normal))
    angle = np.mod(angle, 2.0 * np.pi)
    closed = np.minimum(angle, 2.0 * np.pi - angle) * arcs.radius < CLOSED_ARC
    return np.asarray(np.where(closed, 2.0 * np.pi, angle))
