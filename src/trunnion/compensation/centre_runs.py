"""The run of the tool's centre: what a control drives where the program compensates the radius.

In:     a run, whose positions under compensation are those that its blocks program, and how far beside it goes.
Out:    the run as the tool's centre goes, with rows for what the control inserts at corners; where no tool fits.
Units:  mm.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.compensation.inserted_rows import Insertion, with_inserted_rows
from trunnion.compensation.offsets import Fault
from trunnion.compensation.plane_insertions import PlaneMotions, plane_insertion
from trunnion.compensation.stretches import Stretch
from trunnion.compensation.styles import STYLES
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass

#: A smaller offset, mm, is none.
NOTHING: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class CentreRun:
    """What a control drives.

    run     with the positions of the tool's centre
    faults  rows of the program, each with what is wrong there
    ends    (n,) int64: the row of this run that ends a row of the program; None: nothing is inserted
    """

    run: Run
    faults: tuple[tuple[int, Fault], ...]
    ends: Ints | None = None

    @property
    def row_of(self) -> Ints:
        """(n,) int64: the row of this run that ends a row of the program."""
        return np.arange(len(self.run)) if self.ends is None else self.ends


def run_of_centre(run: Run, offsets: Sequence[tuple[Stretch, float]]) -> CentreRun:
    """Return the run of the tool's centre, ``offsets`` mm beside what the stretches program, each on its side."""
    found, faults = list[Insertion](), list[tuple[int, Fault]]()
    before, last = 0.0, 0
    for stretch, offset in offsets:
        comes_back = stretch.first == last and abs(before) > NOTHING
        before, last = offset, stretch.end
        if abs(offset) <= NOTHING and not comes_back:
            continue
        insertion = _insertion(run, stretch, offset, faults)
        if insertion is not None:
            found.append(insertion)
    if not found:
        return CentreRun(run, tuple(faults))
    centre, ends = with_inserted_rows(run, found)
    return CentreRun(centre, tuple(faults), ends)


def _insertion(run: Run, stretch: Stretch, offset: float, faults: list[tuple[int, Fault]]) -> Insertion | None:
    """Return what becomes of a stretch; None, with the reason among the faults, where that is not known."""
    style = STYLES.get(stretch.style)
    touches = stretch.first and run.state.compensation[stretch.first - 1]
    if style is None or stretch.plane < 0 or touches:
        faults.append((stretch.first, Fault.UNSURE))
        return None
    last = _last_row(run, stretch)
    rows = np.arange(stretch.first, last)
    tip = run.positions(np.arange(stretch.first - 1, last)).tip
    motions = PlaneMotions(rows, tip, run.kind[rows] == Kind.ARC, run.arcs, stretch.end)
    normal = run.compensation_planes[stretch.plane]
    found, wrong = plane_insertion(motions, normal, stretch.side * offset, style)
    faults += wrong
    return found


def _last_row(run: Run, stretch: Stretch) -> int:
    """Return the row behind the last one that may belong to a stretch: up to the next one, or a machine position."""
    state = run.state
    others = [
        int(row) for column in (state.compensation, state.machine_frame) for row in column.rows if row > stretch.end
    ]
    stops = stretch.end >= len(run) or state.machine_frame[stretch.end] or state.compensation[stretch.end]
    return stretch.end if stops else min([*others, len(run)])
