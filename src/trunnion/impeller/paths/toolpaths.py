"""The paths of a step as operations of a CL file.

In:     a ``LinkedPath``, the tool, speeds and feeds.
Out:    an ``Operation``.
Units:  mm, rev/min, mm/min.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.impeller.paths.linking import LinkedPath
from trunnion.model.toolpath import (
    Arcs,
    Coolant,
    Event,
    Frame,
    LoadTool,
    Moves,
    Operation,
    Phase,
    SpindleOff,
    SpindleOn,
    Tool,
)
from trunnion.records import dataclass

#: Decimals of tips, mm: those that CL files have, so that they say what is meant in as many digits.
_DECIMALS: Final = 6

#: Phases that are cut at the feed of the step; all others at that of its leads.
_CUTTING: Final = (Phase.CUT, Phase.STEPOVER)


@dataclass(frozen=True, slots=True)
class CuttingData:
    """Speeds, feeds and the tolerance of a step.

    rpm        of the spindle, clockwise
    feed       mm/min
    lead_feed  on leads, approaches and retracts, mm/min
    coolant    a CL word, such as ON; empty: none
    tolerance  that its path keeps, mm, for INTOL and OUTTOL
    """

    rpm: float
    feed: float
    lead_feed: float
    coolant: str
    tolerance: float


def operation_of(name: str, path: LinkedPath, tool: Tool, number: int, radius: float, data: CuttingData) -> Operation:
    """Return the operation of a path.

    name          of the operation
    tool, number  as CL files describe it, and by which it is called
    radius        from the ball's centre to the tip; 0 where centres are tips
    """
    n = len(path.kind)
    cutting = np.isin(path.phase, _CUTTING)
    feed: Floats = np.where(cutting, data.feed, data.lead_feed)
    line = np.ones(n, np.int32)
    tip = np.round(path.centre - radius * path.axis, _DECIMALS)
    moves = Moves(tip, path.axis, path.kind, path.phase, feed, np.zeros(n, np.bool_), line)
    events: list[Event] = [LoadTool(0, 1, number, number), SpindleOn(0, 1, data.rpm)]
    if data.coolant:
        events.append(Coolant(0, 1, data.coolant))
        events.append(Coolant(n, 1, "OFF"))
    events.append(SpindleOff(n, 1))
    return Operation(name, tool, Frame(), moves, Arcs.empty(), tuple(events), 1, data.tolerance, data.tolerance)
