"""Changes of the tool length in force while the tool is at the part.

With another length the tool goes elsewhere than its numbers say: after ``G49`` it dives by its whole length with
``G0 Z0``, and it does so by the difference with the length of another tool. At a position of the machine nothing moves.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Ints
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.unknown_setups import stated_rows
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.results import Place


def lengths_lost_at_part(context: Context) -> Iterator[Place]:
    """Yield motions that begin at the part with a length and end without it, where nobody has stated it."""
    run = context.run
    axes = run.state.length_axis.column()
    lost = np.flatnonzero((axes[1:] < 0) & (axes[:-1] >= 0)) + 1
    lost = lost[~stated_rows(run)[1].at(lost)]
    lost = lost[(axes[lost] < 0) | ~run.state.tcp.column()[lost].astype(np.bool_)]  # with TCP it counts along the tool
    for row in _begun_at_part(run, lost):
        yield context.place(row, 0.0, Wording("modal", "length_lost"))


def numbers_changed_at_part(context: ComparedContext) -> Iterator[Place]:
    """Yield motions to no CL point that begin at the part with the length of one number and end with another one."""
    run = context.run
    numbers, axes = run.state.edge.column(), run.state.length_axis.column()
    changed = np.flatnonzero((numbers[1:] != numbers[:-1]) & (axes[1:] >= 0) & (axes[:-1] >= 0)) + 1
    changed = changed[run.state.tool.at(changed) == run.state.tool.at(changed - 1)]
    for row in _begun_at_part(run, changed):
        pair = context.matching.nc.count_before(row)
        if context.matching.nc.count_before(row + 1) == pair:
            has, before = int(numbers[row]), int(numbers[row - 1])
            yield context.place(row, 0.0, Wording("tool", "number_at_part", has=has, before=before))


def _begun_at_part(run: Run, rows: Ints) -> Iterator[int]:
    """Yield those of rows before which the axis Z does not stand where machine coordinates have put it."""
    if not len(rows):
        return
    frame = run.state.machine_frame.column()
    states = np.flatnonzero((run.programmed & int(ProgrammedWord.Z)) != 0)
    for row in rows[~frame[rows]].tolist():
        before = int(np.searchsorted(states, row)) - 1
        if before >= 0 and not frame[states[before]]:
            yield row
