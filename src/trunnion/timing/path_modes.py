"""What a program says about its corners: how far the control may leave them, and where it stops exactly.

In:     the events of a run: ``tolerance`` and ``exact_stop``.
Out:    columns with one value for each row.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run

#: How far an axis may depart from a corner where the program does not say, mm or degrees: usual for cuts of ordinary
#: accuracy.
CORNER_TOLERANCE: Final = 0.01


def corner_tolerances(run: Run) -> StepColumn:
    """How far the control may depart from the corner after each row, mm or degrees; infinite: as far as it likes.

    A tolerance of 0 is that of the control's settings, which nobody has said, unless the path is to be exact.
    """
    stated, exact = 0.0, False
    changes = {0: CORNER_TOLERANCE}
    for event in run.events:
        if event.kind == "tolerance" and isinstance(event.value, int | float) and not math.isnan(event.value):
            stated = max(float(event.value), 0.0)
        elif event.kind == "exact_stop" and event.value in ("path", "on", "off"):
            exact = event.value == "path"
        else:
            continue
        changes[event.before_row] = 0.0 if exact else stated or CORNER_TOLERANCE
    return StepColumn(len(run), np.array(list(changes), np.int64), np.array(list(changes.values()), np.float64))


def exact_stop_rows(run: Run) -> Flags:
    """Rows at whose end the axes stop exactly because the program says so, (n,)."""
    n = len(run)
    stops, once = np.zeros(n, np.bool_), []
    since: int | None = None
    for event in run.events:
        if event.kind != "exact_stop":
            continue
        if event.value == "block":
            once.append(event.before_row)
            continue
        if since is not None:
            stops[since : event.before_row] = True
        since = event.before_row if event.value == "on" else None
    if since is not None:
        stops[since:] = True
    stops[[row for row in once if row < n]] = True
    return stops
