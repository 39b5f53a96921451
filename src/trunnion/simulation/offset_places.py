"""Cuts of which nobody knows where they are: in a work offset without a zero, while the stock is in another one.

In:     the runs of a set-up in the frame in which the stock stands.
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
from trunnion.model.unknown_setups import offset_name
from trunnion.simulation.findings import file_of_row


def cuts_at_unknown_places(frame: WorkpieceFrame, runs: Sequence[Run]) -> Iterator[Problem]:
    """Yield an error of each program in a frame that cuts where nobody knows the place in it."""
    for run in runs:
        found = next(_cuts_elsewhere(run), None)
        if found is not None:
            setup, row = found
            name, stock = offset_name(run, setup.work_offset), run.work_offset_name(frame.offset)
            wording = Wording("SIM141", "place_of_offset_unknown", offset=name, stock=stock)
            yield Problem(file_of_row(run, row), run.lines[row], wording)


def _cuts_elsewhere(run: Run) -> Iterator[tuple[Setup, int]]:
    """Yield the set-ups of a run that nobody can place, each with the first row in which it cuts."""
    if run.setups is None:
        return
    at_feed = (run.kind != Kind.RAPID) & ~run.machine_frame
    for number, setup in enumerate(run.setups.each):
        if setup.is_elsewhere:
            rows = np.flatnonzero(at_feed & (run.setups.number.column() == number))
            if len(rows):
                yield setup, int(rows[0])
