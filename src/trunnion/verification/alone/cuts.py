"""The cuts of a program, and the stretches of them with one tool."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass


def cuts_of(run: Run) -> Ints:
    """Return the rows that cut in the workpiece: at feed, with the spindle on."""
    cuts = run.kind != Kind.RAPID
    cuts &= ~run.state.machine_frame.column()
    return np.flatnonzero(cuts & (run.state.spindle.column() != 0))


@dataclass(frozen=True, slots=True, eq=False)
class ToolStretch:
    """The rows from one tool change to the next, or to the end: ``first`` to ``end`` (exclusive).

    tool  that is in the spindle
    cuts  those of the rows that cut, (k,)
    """

    tool: str
    first: int
    end: int
    cuts: Ints


def tool_stretches(run: Run, cuts: Ints) -> Iterator[ToolStretch]:
    """Yield the stretches of a program behind its tool changes, in order."""
    changes = [event for event in run.events if event.kind == "tool_change"]
    ends = [*(event.before_row for event in changes[1:]), len(run)]
    for change, end in zip(changes, ends, strict=True) if changes else ():
        first = change.before_row
        own = cuts[bisect_left(cuts, first) : bisect_left(cuts, end)]
        yield ToolStretch(str(change.value or ""), first, end, own)


def is_between_cuts(cuts: Ints, row: int) -> bool:
    """Whether the rows on either side of what happens before a row cut."""
    at = bisect_right(cuts, row - 1)
    return 0 < at < len(cuts) and int(cuts[at - 1]) == row - 1 and int(cuts[at]) == row
