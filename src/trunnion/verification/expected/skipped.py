"""What the CL files let the operator skip: OPSKIP/ON to OPSKIP/OFF.

In:     an operation.
Out:    its rows that may be skipped; the operation without them.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from trunnion.arrays import Flags
from trunnion.model.toolpath import BlockSkip, LoadTool, Operation, SelectTool
from trunnion.verification.expected.holes import without_rows


def skipped_stretches(operation: Operation) -> Iterator[tuple[int, int]]:
    """Yield the stretches of an operation that may be skipped: their first row, and the one after the last."""
    begin = -1
    for event in operation.events:
        if isinstance(event, BlockSkip):
            if event.on and begin < 0:
                begin = event.row
            elif not event.on and begin >= 0:
                yield begin, event.row
                begin = -1
    if begin >= 0:
        yield begin, len(operation.moves)


def without_skipped(operation: Operation) -> tuple[Operation, Flags]:
    """Return the operation as it is with the switch on, and which rows are gone, (n,) bool. Tools are called all the
    same.
    """
    gone = np.zeros(len(operation.moves), np.bool_)
    for begin, end in skipped_stretches(operation):
        gone[begin:end] = True
    events, skips = [], False
    for event in operation.events:
        skips = event.on if isinstance(event, BlockSkip) else skips
        if not skips or isinstance(event, LoadTool | SelectTool):
            events.append(event)
    return without_rows(replace(operation, events=tuple(events)), gone), gone
