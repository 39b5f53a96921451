"""Moves and operations built from a few columns."""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.toolpath import Arcs, Frame, Kind, Moves, Operation, Phase, Tool


def moves_of(tip: Floats, axis: Floats, kind: Kind = Kind.LINEAR, phase: Phase = Phase.CUT) -> Moves:
    """Moves through the points; the line of row n is 10 + n."""
    n = len(tip)
    return Moves(
        np.array(tip, float),
        np.array(axis, float),
        np.full(n, kind, np.uint8),
        np.full(n, phase, np.uint8),
        np.full(n, 100.0),
        np.zeros(n, bool),
        np.arange(10, 10 + n, dtype=np.int32),
    )


def rapids_at(moves: Moves, rows: list[int]) -> Moves:
    """The moves with rapids in these rows."""
    kind, phase = moves.kind.copy(), moves.phase.copy()
    kind[rows], phase[rows] = Kind.RAPID, Phase.RAPID
    return replace(moves, kind=kind, phase=phase)


def operation_of(moves: Moves, name: str = "OP") -> Operation:
    """An operation with these moves only."""
    return Operation(name, Tool(), Frame(), moves, Arcs.empty(), (), 1)
