"""New rows before the rows of an operation: columns, arcs, splines and events move along."""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.model.toolpath import Moves, Operation


def insert_rows(operation: Operation, copies: Ints, tip: Floats, axis: Floats, kind: Codes) -> Operation:
    """Return the operation with ``copies`` (n,) rows in place of each row, of which the last is the row itself.

    ``tip`` (m, 3) mm, ``axis`` (m, 3) unit vectors, both in the operation's system, and ``kind`` (m,) are the columns
    of all rows of the result. New rows copy everything else from the row that they lead to, except the surface normal,
    which is unknown there. Events stay before the first copy of their row.
    """
    moves = operation.moves
    source = np.repeat(np.arange(len(moves)), copies)
    last = np.cumsum(copies) - 1
    first = np.append(last - copies + 1, last[-1] + 1 if len(last) else 0)
    return replace(
        operation,
        moves=Moves(
            tip,
            axis,
            kind,
            moves.phase[source],
            moves.feed[source],
            moves.per_rev[source],
            moves.line[source],
            None if moves.normal is None else _at(last, moves.normal, len(source)),
        ),
        arcs=replace(operation.arcs, row=last[operation.arcs.row]),
        splines=operation.splines.at_rows(first[operation.splines.first], last[operation.splines.last]),
        events=tuple(replace(event, row=int(first[event.row])) for event in operation.events),
    )


def _at(rows: Ints, vectors: Floats, n: int) -> Floats:
    """(n, 3): vectors at their rows, NaN elsewhere."""
    found = np.full((n, 3), np.nan)
    found[rows] = vectors
    return found
