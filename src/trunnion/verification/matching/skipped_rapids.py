"""Rapids that go to no CL point beside blocks that may be skipped: they lead the tool to one height, or back."""

from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.expected.path import ExpectedPath

#: They lead from blocks that may be skipped to the next CL point: up, across, down.
MOST_RAPIDS: Final = 3


def rapids_beside_skipped(run: Run, expected: ExpectedPath, rows: Ints, point: int) -> int:
    """Return how many rows may lead to a CL row without going to it, each a rapid and not the last of the rows.

    Behind an OPSKIP up to ``MOST_RAPIDS``, and one before it.

    rows  (k,) the next motions of the run
    """
    most = MOST_RAPIDS if point in expected.behind_skipped else int(point in expected.first_skipped)
    cuts = np.flatnonzero(run.kind[rows[:-1]] != Kind.RAPID)
    return min(most, int(cuts[0]) if len(cuts) else len(rows) - 1)
