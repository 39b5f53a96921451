"""How deep and how high the tool goes at the holes of cycles, where no row stands.

In:     an operation as ``trunnion.planning.holes.operations.normalize_cycles`` returns it.
Out:    for each hole where the tip is at its lowest and at its highest.

Everything that a cycle does at a hole lies between the two, but for the lift-off to the side in a bore: how far and to
which side is up to the control, and only its program says it.
"""

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.toolpath import Operation
from trunnion.planning.holes.cycles import HoleCycleError, cycle_from_event
from trunnion.planning.holes.operations import cycle_row_ranges


def hole_ends(operation: Operation) -> tuple[Ints, Floats]:
    """Return the rows of m holes, and their ends, (2, m, 3) mm: the bottoms, and the points from which the tool goes
    on.

    Cycles that cannot be read are left to the writer's checks.
    """
    moves = operation.moves
    rows, heights = [np.zeros(0, np.int64)], [np.zeros((2, 0))]
    for event, end in cycle_row_ranges(operation):
        try:
            cycle = cycle_from_event(event)
        except HoleCycleError:
            continue
        highest = cycle.rapid_height if cycle.retract_height is None else cycle.retract_height
        rows.append(np.arange(event.row, end))
        heights.append(np.repeat([[-cycle.depth], [highest]], end - event.row, axis=1))
    holes = np.concatenate(rows)
    return holes, moves.tip[holes] + np.concatenate(heights, axis=1)[:, :, None] * moves.axis[holes]
