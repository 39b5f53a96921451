"""The box round all that a program cuts, as a block form wants it.

In:     motions in the program's coordinate system.
Out:    two corners in whole millimetres, rounded outwards. They are those of the tip: nothing is known of the stock.
"""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind
from trunnion.planning.holes.cycles import cycle_from_event


def extents(motions: Sequence[Motion]) -> tuple[Floats, Floats] | None:
    """Lower and upper corner, (3,) each, the upper one higher in all coordinates; None where nothing is cut."""
    places = [place for motion in motions for place in _cut_points(motion)]
    cut = np.concatenate(places) if places else np.zeros((0, 3))
    if not len(cut):
        return None
    low, high = np.floor(cut.min(axis=0)), np.ceil(cut.max(axis=0))
    return low, np.maximum(high, low + 1.0)


def _cut_points(motion: Motion) -> list[Floats]:
    """Where the tip cuts: ends of cuts with the points before them, all of a circle's box, holes from top to bottom."""
    moves, arcs = motion.operation.moves, motion.operation.arcs
    cuts = np.flatnonzero(moves.kind != Kind.RAPID)
    places = [moves.tip[cuts], moves.tip[np.maximum(cuts - 1, 0)]]
    reach = arcs.radius[:, None] * np.sqrt(np.maximum(1.0 - arcs.normal**2, 0.0))
    places += [arcs.centre - reach, arcs.centre + reach]
    ends = [e.row for e in motion.operation.events if isinstance(e, CycleOn | CycleOff)] + [len(moves)]
    for event in motion.operation.events:
        if isinstance(event, CycleOn):
            holes = slice(event.row, min(row for row in ends if row > event.row or row == len(moves)))
            places += [moves.tip[holes], moves.tip[holes] - cycle_from_event(event).depth * moves.axis[holes]]
    return places
