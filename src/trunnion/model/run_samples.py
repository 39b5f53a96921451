"""Some rows of a run that stand for all: what its axes do from end to end.

In:     a ``Run``.
Out:    axis values of at most 64 rows.
Units:  mm, degrees.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.run import Run

_EVEN: Final = 54


def joint_samples(run: Run) -> Floats:
    """Return axis values (k, 5) of rows with the extremes of each programmed column, and of some between, in order."""
    if not len(run):
        return np.zeros((0, 5))
    columns = np.column_stack((run.xyz, run.rotary))
    ends = (columns.argmin(axis=0), columns.argmax(axis=0))
    between = np.linspace(0, len(run) - 1, min(len(run), _EVEN)).astype(np.int64)
    return run.positions(np.unique(np.concatenate((*ends, between)))).joints
