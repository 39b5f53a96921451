"""Which arcs a control takes, and lines for the others.

A control moves the tip about X, Y or Z of its coordinate system. An arc about any other direction, or one on which the
tool axis changes, becomes lines that leave the arc by no more than a chord tolerance.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.arcs import CLOSED_ARC, FLAT_ARC, arc_gaps
from trunnion.model.toolpath import Arcs, Kind, Operation
from trunnion.planning.linearization.row_insertion import insert_rows

#: Lines that arcs may become: more would take the memory of a computer, and no control would read them.
MOST_LINES: Final = 10_000_000

#: A direction is that of a coordinate axis within this sine; seven printed decimals give 1e-7.
_PARALLEL_SINE: Final = 1e-6

#: A start and an end nearer to each other than this, mm, could print as the same point.
_DISTINCT: Final = 0.005

#: Greatest difference of the radii at start and end of an arc that all controls take, mm: the strictest takes 0.005 of
#: what is printed.
_SAME_RADIUS: Final = 0.003

#: Error of an arc's radius if start, end and centre have four decimals, mm.
_PRINTED_RADIUS_ERROR: Final = 3e-4


def arc_sweeps(operation: Operation) -> Floats:
    """Angle that the tip sweeps on each arc.

    (m,) float64  radians, positive; 2 pi for a full circle, and whole turns count
    """
    arcs, tip = operation.arcs, operation.moves.tip
    start, end = tip[arcs.row - 1] - arcs.centre, tip[arcs.row] - arcs.centre
    across = np.einsum("ij,ij->i", np.cross(start, end), arcs.normal)
    start_in_plane = start - np.einsum("ij,ij->i", start, arcs.normal)[:, None] * arcs.normal
    along = np.einsum("ij,ij->i", start_in_plane, end)
    angle = np.mod(np.arctan2(across, along), 2.0 * np.pi)
    # If start and end are the same in the plane it is a full circle; the file's rounding may part them a little.
    closed = np.minimum(angle, 2.0 * np.pi - angle) * arcs.radius < CLOSED_ARC
    return np.asarray(np.where(closed, 2.0 * np.pi, angle) + 2.0 * np.pi * arcs.full_turns)


def radius_change(operation: Operation) -> Floats:
    """(m,) float64: how much farther from its axis an arc ends than it starts, mm."""
    arcs, tip = operation.arcs, operation.moves.tip
    start, end = tip[arcs.row - 1] - arcs.centre, tip[arcs.row] - arcs.centre
    away = [np.linalg.norm(np.cross(arcs.normal, point), axis=1) for point in (start, end)]
    return np.asarray(away[1] - away[0])


def arcs_a_control_takes(operation: Operation, only_about_z: bool = False, by_angle: bool = False) -> Flags:
    """Arcs that a control can take, as far as their geometry goes.

    They turn about X, Y or Z, the tool axis is the same at start and end, and so is the radius. They also end clear of
    their start or over it, because an arc whose end prints as its start becomes a full circle on the control, however
    short it really is.

    operation     in the coordinates of its blocks
    only_about_z  the control takes arcs about Z only
    by_angle      the control takes a helix by its angle. It then meets the end only if start and end are equally far
                  from the centre

    (m,) bool  one entry for each arc
    """
    arcs, axis, tip = operation.arcs, operation.moves.axis, operation.moves.tip
    off_z = np.abs(arcs.normal[:, :2]).max(axis=1, initial=0.0)
    fits = (off_z if only_about_z else np.sort(np.abs(arcs.normal), axis=1)[:, 1]) < _PARALLEL_SINE
    fits &= np.abs(axis[arcs.row] - axis[arcs.row - 1]).max(axis=1, initial=0.0) < _PARALLEL_SINE
    change = np.abs(radius_change(operation))
    fits &= change < _SAME_RADIUS
    if by_angle:
        fits &= flat_arcs(operation) | (change < _PRINTED_RADIUS_ERROR)
    gap, rise = arc_gaps(arcs, tip), _rises(operation)
    fits &= (gap > _DISTINCT) | ((gap < CLOSED_ARC) & ((rise < FLAT_ARC) | (rise > _DISTINCT)))
    return np.asarray(fits)


def flat_arcs(operation: Operation) -> Flags:
    """(m,) bool: the arc ends at the height of its start, along its normal, and makes no further whole turns."""
    return np.asarray((_rises(operation) < FLAT_ARC) & (operation.arcs.full_turns == 0))


def _rises(operation: Operation) -> Floats:
    """(m,) float64: how far the end of each arc is from its start along its normal, mm."""
    arcs, tip = operation.arcs, operation.moves.tip
    return np.asarray(np.abs(np.einsum("ij,ij->i", tip[arcs.row] - tip[arcs.row - 1], arcs.normal)))


def arcs_about_tool(operation: Operation) -> Flags:
    """(m,) bool: the arc turns about the tool axis at its end."""
    arcs = operation.arcs
    across = np.cross(arcs.normal, operation.moves.axis[arcs.row])
    return np.asarray(np.linalg.norm(across, axis=1) < _PARALLEL_SINE)


def single_turns(operation: Operation, keep: Flags) -> tuple[Operation, Flags]:
    """Replace arcs of several turns that stay arcs by one arc a turn, for controls that have no word for turns.

    keep  (m,) bool: arcs that stay arcs

    operation, keep  ``keep`` with one entry for each arc of the operation
    """
    arcs = operation.arcs
    turns = np.where(keep, arcs.full_turns, 0)
    if not turns.any():
        return operation, keep
    moves = operation.moves
    copies = np.ones(len(moves), np.int64)
    copies[arcs.row] += turns
    source = np.repeat(np.arange(len(moves)), copies)
    last = np.cumsum(copies) - 1
    tip, sweep = moves.tip[source], arc_sweeps(operation)
    for m in np.flatnonzero(turns).tolist():
        row, count, normal = int(arcs.row[m]), int(turns[m]), arcs.normal[m]
        rise = float((moves.tip[row] - moves.tip[row - 1]) @ normal) * 2.0 * np.pi / sweep[m]
        steps = np.arange(1, count + 1)[:, None] * rise * normal
        tip[last[row] - count : last[row]] = moves.tip[row - 1] + steps
    inserted = insert_rows(operation, copies, tip, moves.axis[source], moves.kind[source])
    which = np.repeat(np.arange(len(arcs.row)), turns + 1)
    place = np.arange(len(which)) - np.repeat(np.cumsum(turns + 1) - 1, turns + 1)
    whole = np.where(keep, 0, arcs.full_turns)[which]
    single = Arcs(last[arcs.row][which] + place, arcs.centre[which], arcs.normal[which], arcs.radius[which], whole)
    return replace(inserted, arcs=single), keep[which]


def lines_for_arcs(operation: Operation, keep: Flags, chord_tolerance: float) -> Operation:
    """Replace arcs by lines.

    operation        no arc may be its first row, as an arc starts at the row before
    keep             (m,) bool: arcs that stay arcs
    chord_tolerance  the greatest distance between arc and line, mm

    Operation  the tool axis turns evenly along an arc; new rows have the line number of the arc's end

    Raises ``InputError`` if they become more than ``MOST_LINES``.
    """
    if bool(keep.all()):
        return operation
    moves, arcs = operation.moves, operation.arcs
    sweep = arc_sweeps(operation)
    copies = arc_piece_counts(operation, keep, chord_tolerance)
    if int(copies.sum()) - len(moves) > MOST_LINES:
        longest = int(np.argmax(copies))
        raise InputError(
            Problem(
                operation.file,
                int(moves.line[longest]),
                Wording(
                    "PLN550",
                    "arcs_operation_become",
                    operation=operation.name,
                    sum=int(copies.sum()),
                    copies=int(copies[longest]),
                ),
            )
        )
    source = np.repeat(np.arange(len(moves)), copies)
    new_row = np.cumsum(copies) - 1  # the last copy of each row is the row itself
    tip, axis = moves.tip[source], moves.axis[source]
    kind = moves.kind[source]
    for m in np.flatnonzero(~keep):
        row = arcs.row[m]
        part = slice(new_row[row] - copies[row] + 1, new_row[row] + 1)
        tip[part], axis[part] = _points_on_arc(operation, int(m), float(sweep[m]), int(copies[row]))
        kind[part] = Kind.LINEAR
    kept = Arcs(arcs.row[keep], arcs.centre[keep], arcs.normal[keep], arcs.radius[keep], arcs.full_turns[keep])
    return insert_rows(replace(operation, arcs=kept), copies, tip, axis, kind)


def arc_piece_counts(operation: Operation, keep: Flags, chord_tolerance: float) -> Ints:
    """(n,) int64: number of lines for the move to each row; 1 except for arcs that are not kept."""
    arcs = operation.arcs
    half = np.sqrt(np.minimum(chord_tolerance / (2.0 * np.maximum(arcs.radius, chord_tolerance)), 0.25))
    pieces = np.where(keep, 1, np.ceil(arc_sweeps(operation) / (4.0 * np.arcsin(half)))).astype(np.int64)
    copies = np.ones(len(operation.moves), np.int64)
    copies[arcs.row] = np.maximum(pieces, 1)
    return copies


def source_rows(before: Operation, after: Operation) -> Ints:
    """(n,) int64: the row of ``before`` that each row of ``after`` belongs to, in which lines may stand for arcs.

    Lines for an arc carry the arc's line number; where several rows of ``before`` have it, the last of them counts.
    """
    count = len(before.moves)
    if len(after.moves) == count:
        return np.arange(count)
    old_starts = np.flatnonzero(np.diff(before.moves.line, prepend=before.moves.line[:1] - 1))
    new_starts = np.flatnonzero(np.diff(after.moves.line, prepend=after.moves.line[:1] - 1))
    old_counts, new_counts = np.diff(old_starts, append=count), np.diff(new_starts, append=len(after.moves))
    return np.concatenate(
        [
            np.arange(first, first + old) if old == new else np.full(new, first + old - 1)
            for first, old, new in zip(old_starts.tolist(), old_counts.tolist(), new_counts.tolist(), strict=True)
        ]
    )


def _points_on_arc(operation: Operation, m: int, sweep: float, pieces: int) -> tuple[Floats, Floats]:
    """Points on arc ``m`` at the ends of ``pieces`` equal parts, and the tool axes there."""
    moves, arcs = operation.moves, operation.arcs
    row, centre, normal = int(arcs.row[m]), arcs.centre[m], arcs.normal[m]
    part = np.arange(1, pieces + 1) / pieces
    start, end = moves.tip[row - 1] - centre, moves.tip[row] - centre
    rise_start, rise_end = float(start @ normal), float(end @ normal)
    radial = start - rise_start * normal
    angle = (part * sweep)[:, None]
    tip = centre + np.cos(angle) * radial + np.sin(angle) * np.cross(normal, radial)
    tip = tip + (rise_start + part * (rise_end - rise_start))[:, None] * normal
    # The file rounds centre and end: the difference at the end is spread over the arc.
    tip += part[:, None] * (moves.tip[row] - tip[-1])
    tip[-1] = moves.tip[row]  # exactly
    return tip, great_circle_points(moves.axis[row - 1], moves.axis[row], part)


def great_circle_points(first: Floats, last: Floats, part: Floats) -> Floats:
    """(k, 3) float64: unit vectors on the great circle from ``first`` to ``last``, at shares ``part`` (k,) of it.

    The two are not opposite: there is no one circle then.
    """
    angle = float(np.arctan2(np.linalg.norm(np.cross(first, last)), first @ last))
    if angle < 1e-12:
        return np.repeat(last[None, :], len(part), axis=0)
    weight = np.sin(np.outer(np.column_stack((1.0 - part, part)), angle).reshape(-1, 2)) / np.sin(angle)
    turned = weight[:, :1] * first + weight[:, 1:] * last
    return np.asarray(turned / np.linalg.norm(turned, axis=1, keepdims=True))
