"""Whether an outline finds room on a table anywhere.

The place with the most left to the edges is the solution of a linear program. It is held against the rim, and gets one
more tangent, until they agree.
"""

from typing import Final

import numpy as np

from trunnion.placing.largest_margin import linear_program
from trunnion.placing.table_limits import TableLimits
from trunnion.placing.travel_limits import FARTHEST

#: An outline that is larger by less is as large as the table, mm.
_ROUNDING: Final = 1e-9

_MOST_ROUNDS: Final = 200


def has_room(limits: TableLimits) -> bool:
    """Whether there is a zero at which the whole outline is on the table."""
    edges = [*limits.straight_edges(), *limits.rim_around()]
    for _ in range(_MOST_ROUNDS):
        table = np.array([(*edge.normal, 1.0) for edge in edges])
        bounds = np.array([edge.bound for edge in edges])
        ranges = [(-FARTHEST, FARTHEST)] * 2 + [(None, None)]
        solved = linear_program(np.array([0.0, 0.0, -1.0]), table, bounds, ranges)
        left, most = limits.left(solved.x), float(solved.x[2])
        if left >= -_ROUNDING:
            return True
        tangent = limits.rim_at(solved.x)
        if most < -_ROUNDING or tangent is None:
            return False
        edges.append(tangent)
    return False
