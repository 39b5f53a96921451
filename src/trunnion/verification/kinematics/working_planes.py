"""Working planes that stay in force over cuts although nothing there needs them.

Arcs, cycles and radius compensation work in the plane that ``G18`` or ``G19`` chooses, and on some controls the tool
length counts across it. Lines need no plane. A plane other than XY that no arc, cycle or compensation uses is a word
that nobody asked for: the next word that does use it goes elsewhere.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.row_ranges import chunk_bounds

_XY = 2


def unused_planes(run: Run) -> Iterator[tuple[int, str]]:
    """Yield the first cut in each plane that nothing uses, as its row, and the word of the plane."""
    planes = run.state.working_plane
    users = {*run.arcs.row.tolist(), *(event.before_row for event in run.events if event.kind == "hole")}
    ends = [*planes.rows[1:].tolist(), len(run)]
    for first, end, plane in zip(planes.rows.tolist(), ends, planes.values.tolist(), strict=True):
        end = min(end, len(run))
        if plane == _XY or first >= end or any(first <= row < end for row in users):
            continue
        if (cut := _first_cut(run, first, end)) is not None:
            yield cut, f"G{19 - plane}"


def _first_cut(run: Run, first: int, end: int) -> int | None:
    """Return the first row that cuts; None: none does, or radius compensation uses the plane."""
    found = None
    for a, b in chunk_bounds(end - first):
        rows = slice(first + a, first + b)
        if (run.state.compensation.part(rows.start, rows.stop) != 0).any():
            return None
        cuts = (run.kind[rows] != Kind.RAPID) & ~run.state.machine_frame.part(rows.start, rows.stop)
        if found is None and cuts.any():
            found = rows.start + int(np.argmax(cuts))
    return found
