"""Cuts that begin where nobody knows how far the tool has gone.

In:     a run.
Out:    their rows.

A slide that went to a position of the machine, or to the end of its travel, stands nowhere in the workpiece that
follows from the program, unless workpiece zero and tool length are known. Until the program states it again, a block
that leaves it out cuts at an unknown height.
"""

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.programmed_words import POSITION_WORDS, names_no_axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.kinematics.machine_positions import MachinePositions

#: Rows that are searched at first for the next Z; later ever more.
_FEW = 64


def cuts_from_unknown_places(run: Run) -> Ints:
    """Return the cuts whose start is not known, and which leave out the slide that is not."""
    unknown = np.zeros(len(run), np.bool_)
    for first, end in MachinePositions.of(run).left_at_machine():
        unknown[first:end] = True
    for event in run.events:
        row = event.before_row
        if event.kind != "retract" or (row < len(run) and run.state.machine_frame[row]):
            continue  # a retract whose way is known is a motion in machine coordinates
        unknown[row : _next_with_z(run, row)] = True
    rows = np.flatnonzero(unknown)  # few of a million
    cuts = rows[(run.kind[rows] != Kind.RAPID) & ((run.programmed[rows] & int(POSITION_WORDS)) != 0)]
    return np.asarray(cuts[~run.state.machine_frame.at(cuts)] if len(cuts) else cuts, np.int64)


def _next_with_z(run: Run, first: int) -> int:
    """Return the first row that says Z; n if there is none. In a plane and under TCP another word leaves it there."""
    size = _FEW
    while first < len(run):
        programmed = run.programmed[first : first + size]
        says = ((programmed & int(ProgrammedWord.Z)) != 0) | names_no_axis(programmed)
        if says.any():
            return first + int(np.argmax(says))
        first, size = first + size, 4 * size
    return len(run)
