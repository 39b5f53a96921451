"""Full circles as two arcs, for dialects that give an arc by its end point."""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.arcs import CLOSED_ARC
from trunnion.model.toolpath import From, Kind, Operation


def with_half_circles(operation: Operation) -> tuple[Operation, int]:
    """Return the operation with a point halfway round each full circle, and how many circles these are.

    Helices and arcs of several turns stay as they are.
    """
    arcs, moves = operation.arcs, operation.moves
    starts = {event.row: np.array(event.tip) for event in operation.events if isinstance(event, From)}
    full = []
    for index, row in enumerate(arcs.row.tolist()):
        start = starts.get(row) if row in starts else moves.tip[row - 1] if row else None
        closed = start is not None and float(np.linalg.norm(moves.tip[row] - start)) < CLOSED_ARC
        if closed and not arcs.full_turns[index]:
            full.append(index)
    if not full:
        return operation, 0
    rows = arcs.row[full]
    opposite = np.array([_opposite(operation, index) for index in full])
    axis = np.array([moves.axis[row] for row in rows.tolist()])
    inserted = replace(
        moves,
        tip=np.insert(moves.tip, rows, opposite, axis=0),
        axis=np.insert(moves.axis, rows, axis, axis=0),
        kind=np.insert(moves.kind, rows, int(Kind.ARC)),
        phase=np.insert(moves.phase, rows, moves.phase[rows]),
        feed=np.insert(moves.feed, rows, moves.feed[rows]),
        per_rev=np.insert(moves.per_rev, rows, moves.per_rev[rows]),
        line=np.insert(moves.line, rows, moves.line[rows]),
        normal=None if moves.normal is None else np.insert(moves.normal, rows, moves.normal[rows], axis=0),
    )
    twice = np.repeat(np.arange(len(arcs.row)), np.where(np.isin(np.arange(len(arcs.row)), full), 2, 1))
    second = np.concatenate(([False], twice[1:] == twice[:-1])) if len(twice) else np.zeros(0, bool)
    first_half = np.isin(twice, full) & ~second
    new_rows = _moved(arcs.row[twice], rows) + np.where(first_half, 0, np.isin(twice, full))
    halves = replace(
        arcs, row=new_rows, centre=arcs.centre[twice], normal=arcs.normal[twice], radius=arcs.radius[twice],
        full_turns=arcs.full_turns[twice],
    )  # fmt: skip
    events = tuple(replace(event, row=int(_moved(np.array([event.row]), rows)[0])) for event in operation.events)
    moved = operation.splines.at_rows(_moved(operation.splines.first, rows), _moved(operation.splines.last, rows))
    return replace(operation, moves=inserted, arcs=halves, splines=moved, events=events), len(full)


def _opposite(operation: Operation, index: int) -> Floats:
    """(3,) the point of a circle opposite its end, at the height of the end."""
    arcs = operation.arcs
    end, centre, normal = operation.moves.tip[arcs.row[index]], arcs.centre[index], arcs.normal[index]
    height = float((end - centre) @ normal)
    return np.asarray(2.0 * (centre + height * normal) - end, np.float64)


def _moved(rows: Ints, inserted: Ints) -> Ints:
    """Where rows are once a row stands before each of ``inserted``, (k,) sorted: before a row itself, its new one."""
    return np.asarray(rows + np.searchsorted(inserted, rows, side="left"), np.int64)
