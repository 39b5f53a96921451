"""The box around all cuts of a program, for a block form."""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind
from trunnion.planning.holes.cycles import cycle_from_event


def cut_extents(motions: Sequence[Motion]) -> tuple[Floats, Floats] | None:
    """Return the lower and the upper corner of the box around all cuts of the tip, rounded outwards.

    Parameters
    ----------
    motions
        In program coordinates.

    Returns
    -------
    lower, upper
        (3,) each, whole millimetres, at least 1 mm apart in every direction; None if nothing is cut.
    """
    points = [point for motion in motions for point in _cut_points(motion)]
    cut = np.concatenate(points) if points else np.zeros((0, 3))
    if not len(cut):
        return None
    # Column by column: NumPy takes ten times as long along the rows.
    low = np.floor([column.min() for column in cut.T])
    high = np.ceil([column.max() for column in cut.T])
    return low, np.maximum(high, low + 1.0)


def _cut_points(motion: Motion) -> list[Floats]:
    """Corners of the tip's cuts: ends of lines with the points before, boxes of whole circles, holes top and bottom."""
    moves, arcs = motion.operation.moves, motion.operation.arcs
    ends = moves.kind != Kind.RAPID
    touched = ends.copy()
    touched[:-1] |= ends[1:]
    points = [np.compress(touched, moves.tip, axis=0)]
    half_sides = arcs.radius[:, None] * np.sqrt(np.maximum(1.0 - arcs.normal**2, 0.0))
    points += [arcs.centre - half_sides, arcs.centre + half_sides]
    cycles = [event for event in motion.operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [*(event.row for event in cycles[1:]), len(moves)]
    for event, end in zip(cycles, ends, strict=True) if cycles else ():
        if isinstance(event, CycleOn):
            holes = slice(event.row, end)
            points += [moves.tip[holes], moves.tip[holes] - cycle_from_event(event).depth * moves.axis[holes]]
    return points
