"""A recording beside the path of the tool's centre, by the rows of the program: what is inserted belongs to a row."""

from dataclasses import replace

import numpy as np

from trunnion.compensation.centre_runs import CentreRun
from trunnion.verification.driven_rows import DrivenRows
from trunnion.verification.recorded.compared import RecordedComparison


def by_program_rows(compared: RecordedComparison, driven: CentreRun) -> RecordedComparison:
    """Return a comparison with the run of the tool's centre by the rows of the program."""
    own = DrivenRows(driven.run, driven.row_of).own
    n = len(driven.row_of)
    worst = np.full((n, 2), np.nan)
    np.fmax.at(worst, own, compared.worst)
    moves = np.zeros(n, np.bool_)
    moves[own[compared.moves]] = True
    return replace(
        compared,
        row=np.where(compared.row >= 0, own[compared.row], -1),
        positions=np.bincount(own, compared.positions, n).astype(compared.positions.dtype),
        worst=worst,
        moves=moves,
        lengths=np.bincount(own, compared.lengths, n).astype(np.float64),
    )
