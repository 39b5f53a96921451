"""What a program works in: all that is known of the part where nobody states its stock.

In:     a run.
Out:    what the part may fill, in workpiece coordinates, mm.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import SweptPart
from trunnion.model.run import PositionChunk, Run
from trunnion.model.toolpath import Kind

#: How far a motion may deviate from the tool axis and still be along it, mm.
_STRAIGHT: Final = 1e-6


def cut_extent(run: Run) -> SweptPart | None:
    """Return the part around the cuts of a program and the stock that it states; None if it has neither.

    A line at feed straight out along the tool axis is a retract and does not count.
    """
    stated = [event.value for event in run.events if event.kind == "stock"]
    points = [np.array(value, np.float64).reshape(-1, 3) for value in stated]
    for first, end, positions in run.chunks():
        cuts = _cut_points(run, first, end, positions)
        if len(cuts):
            points.append(np.array([cuts.min(axis=0), cuts.max(axis=0)]))
    arcs = run.arcs
    if len(arcs.row):
        points += [arcs.centre - arcs.radius[:, None], arcs.centre + arcs.radius[:, None]]
    return SweptPart.around(run.machine, np.concatenate(points)) if points else None


def _cut_points(run: Run, first: int, end: int, positions: PositionChunk) -> Floats:
    """Both ends of the cuts among consecutive rows, (k, 3); ``positions`` are theirs and that of the row before."""
    start, tip, axis = positions.tip[:-1], positions.tip[1:], positions.axis[1:]
    step = tip - start
    out = np.einsum("ij,ij->i", step, axis)
    straight_out = (out > 0.0) & (np.abs(step - out[:, None] * axis).max(axis=1, initial=0.0) < _STRAIGHT)
    cuts = (run.kind[first:end] != Kind.RAPID) & ~run.state.machine_frame.part(first, end) & ~straight_out
    return np.concatenate((start[cuts], tip[cuts]))
