"""Cuts that begin where nobody knows how far the tool has gone.

In:     a run.
Out:    their rows.

A slide that went to a position of the machine, or to the end of its travel, stands nowhere in the workpiece that
follows from the program, unless workpiece zero and tool length are known. Until the program states it again, a block
that leaves it out cuts at an unknown height.

A feed along the table with the tool at home cuts nothing: programs whose rapids are written as feeds begin so. It is
none of these unless the tool was taken home out of a cut, which then went on without it.
"""

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.programmed_words import POSITION_WORDS, names_no_axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.kinematics.home_tolerance import home_tolerance, spindle_slide
from trunnion.verification.kinematics.machine_positions import MachinePositions

#: Rows that are searched at first for the next Z; later ever more.
_FEW = 64


def cuts_from_unknown_places(run: Run) -> Ints:
    """Return the cuts whose start is not known, and which leave out the slide that is not."""
    left, retracted = np.zeros((2, len(run)), np.bool_)
    for first, end in MachinePositions.of(run).left_at_machine():
        left[first:end] = True
    for event in run.events:
        row = event.before_row
        if event.kind != "retract" or (row < len(run) and run.state.machine_frame[row]):
            continue  # a retract whose way is known is a motion in machine coordinates
        retracted[row : _next_with_z(run, row)] = True
    rows = np.flatnonzero(left | retracted)  # few of a million
    cuts = rows[(run.kind[rows] != Kind.RAPID) & ((run.programmed[rows] & int(POSITION_WORDS)) != 0)]
    if not len(cuts):
        return np.asarray(cuts, np.int64)
    cuts = cuts[~run.state.machine_frame.at(cuts)]
    return np.asarray(cuts[retracted[cuts] | ~_passes_at_home(run, cuts)], np.int64)


def _passes_at_home(run: Run, rows: Ints) -> Flags:
    """Whether the tool stands at home along the spindle in rows, and did not go there out of a cut, (k,) bool."""
    along, outward = spindle_slide(run.machine)
    heights = outward * (run.positions(rows).joints[:, along] - run.machine.home[along])
    found: Flags = MachinePositions.of(run).at(rows)[:, along] & (heights >= -home_tolerance(run, rows)[:, along])
    if not found.any():
        return found
    frame, still = run.machine_frame, names_no_axis(run.programmed)
    still[1:] &= (run.xyz[1:] == run.xyz[:-1]).all(axis=1)  # the way of G28 over where the tool stands
    others = np.concatenate(([-1], np.flatnonzero(~frame & ~still)))
    last = np.maximum.accumulate(np.where(frame, np.arange(len(run)), -1))[rows]
    before = others[np.searchsorted(others, last) - 1]  # the last row before it that says no machine position
    lateral = (run.programmed[before] & int(ProgrammedWord.X | ProgrammedWord.Y)) != 0
    begin, end = (run.positions(each).joints[:, along] for each in (np.maximum(before - 1, -1), before))
    comes_out = ~lateral & (before > 0) & (outward * (end - begin) > 0.0)
    return np.asarray(found & ((before < 0) | (run.kind[before] == Kind.RAPID) | comes_out))


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
