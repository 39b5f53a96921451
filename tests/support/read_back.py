"""Every shipped machine with a Sinumerik."""

from dataclasses import replace

import numpy as np

from tests.support.machines import at_zero, five_axis_machines
from tests.support.operations import operation_of
from trunnion.controls import load_control
from trunnion.machines import load_machine
from trunnion.model.toolpath import LoadTool, Moves, SpindleOn, Toolpath

SINUMERIK = load_machine("yl569").control
CONTROL = load_control(SINUMERIK)

#: Every shipped machine with a control whose programs can be written.
MACHINES = {name: replace(at_zero(name), control=SINUMERIK.unread_copy()) for name in five_axis_machines()}


def toolpath_of(moves: Moves) -> Toolpath:
    """A toolpath of one operation, with the events that a program needs."""
    moves = replace(moves, tip=moves.tip + 20.0 * np.sin(np.arange(len(moves)))[:, None] * [1.0, 0.5, 0.2])
    operation = operation_of(moves)
    events = (LoadTool(0, 1, 1), SpindleOn(0, 2, 1000.0))
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))
