"""Some rows of a run that stand for all: what its axes do from end to end.

In:     a ``Run``.
Out:    axis values of at most 64 rows.
Units:  mm, degrees.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, distinct
from trunnion.model.run import Run

_EVEN: Final = 54


def joint_samples(run: Run) -> Floats:
    """Return axis values (k, 5) of rows with the extremes of each programmed column, and of some between, in order."""
    if not len(run):
        return np.zeros((0, 5))
    ends = [row for columns in (run.xyz, run.rotary) for column in columns.T for row in _extremes(column)]
    between = np.linspace(0, len(run) - 1, min(len(run), _EVEN)).astype(np.int64)
    return run.positions(distinct(np.concatenate((ends, between)))).joints


def _extremes(column: Floats) -> tuple[int, int]:
    """Return the first rows of the least and of the greatest value; a copy without gaps is searched faster."""
    dense = np.ascontiguousarray(column)
    return int(dense.argmin()), int(dense.argmax())
