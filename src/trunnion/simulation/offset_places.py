"""Cuts of which nobody knows where they are: in a work offset without a zero, while the stock is in another one.

In:     the runs of a set-up as they were read, and the frame in which the stock stands.
Out:    errors.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.one_frame import WorkpieceFrame
from trunnion.model.run import Run
from trunnion.model.run_setups import Setup
from trunnion.model.toolpath import Kind
from trunnion.simulation.findings import file_of_row


def cuts_at_unknown_places(frame: WorkpieceFrame, runs: Sequence[Run]) -> Iterator[Problem]:
    """Yield an error of each program that cuts where its zero is not stated, and others are: without any they count
    as one.
    """
    each = [setup for run in runs if run.setups is not None for setup in run.setups.each]
    if all(setup.machine.workpiece_zero is None for setup in each):
        return
    for run in runs:
        found = next(_cuts_elsewhere(frame, run), None)
        if found is not None:
            setup, row = found
            name = run.work_offset_name(setup.work_offset) if setup.work_offset else "no work offset"
            stock = run.work_offset_name(frame.offset)
            wording = Wording("SIM141", "place_of_offset_unknown", offset=name, stock=stock)
            yield Problem(file_of_row(run, row), run.lines[row], wording)


def _cuts_elsewhere(frame: WorkpieceFrame, run: Run) -> Iterator[tuple[Setup, int]]:
    """Yield the set-ups of a run that nobody can place, each with the first row in which it cuts."""
    if run.setups is None:
        return
    at_feed = (run.kind != Kind.RAPID) & ~run.machine_frame
    for number, setup in enumerate(run.setups.each):
        is_known = frame.zero is not None and setup.machine.workpiece_zero is not None
        if not is_known and setup.work_offset != frame.offset:
            rows = np.flatnonzero(at_feed & (run.setups.number.column() == number))
            if len(rows):
                yield setup, int(rows[0])
