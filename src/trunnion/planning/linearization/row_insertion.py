"""Rows put in before rows of an operation, with everything that is counted by rows."""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.model.toolpath import Moves, Operation


def insert_rows(operation: Operation, copies: Ints, tip: Floats, axis: Floats, kind: Codes) -> Operation:
    """An operation each of whose rows becomes ``copies`` (n,) rows, of which the last is the row itself.

    ``tip``, ``axis`` and ``kind`` are those of the new rows; all else the new ones have of the row that they lead to,
    but for the surface's normal, which nobody knows there.
    What happens before a row happens before the first of its copies.
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
        events=tuple(replace(event, row=int(first[event.row])) for event in operation.events),
    )


def _at(rows: Ints, vectors: Floats, n: int) -> Floats:
    """(n, 3): vectors at their rows, NaN elsewhere."""
    found = np.full((n, 3), np.nan)
    found[rows] = vectors
    return found
