"""What the CL files let the operator skip: OPSKIP/ON to OPSKIP/OFF.

In:     an operation.
Out:    its stretches that may be skipped; the operation without some of them.
"""

import sys
from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Flags
from trunnion.model.toolpath import BlockSkip, LoadTool, Operation, SelectTool
from trunnion.verification.expected.holes import without_rows


class SkippedStretch(NamedTuple):
    """A stretch of an operation that may be skipped.

    begin, end            its first row, and the one after the last
    first_line, end_line  lines of its OPSKIP/ON and OPSKIP/OFF; without the latter it goes to the end
    """

    begin: int
    end: int
    first_line: int
    end_line: int = sys.maxsize


def skipped_stretches(operation: Operation) -> Iterator[SkippedStretch]:
    """Yield the stretches of an operation that may be skipped, in their order."""
    began: BlockSkip | None = None
    for event in operation.events:
        if isinstance(event, BlockSkip):
            if event.on and began is None:
                began = event
            elif not event.on and began is not None:
                yield SkippedStretch(began.row, event.row, began.line, event.line)
                began = None
    if began is not None:
        yield SkippedStretch(began.row, len(operation.moves), began.line)


def without_stretches(operation: Operation, left_out: Collection[int]) -> tuple[Operation, Flags]:
    """Return the operation as it is while some of its stretches are skipped, and which rows are gone, (n,) bool.

    Tools are called all the same.
    """
    gone = np.zeros(len(operation.moves), np.bool_)
    for number, stretch in enumerate(skipped_stretches(operation)):
        gone[stretch.begin : stretch.end] |= number in left_out
    events, number, skips = [], -1, False
    for event in operation.events:
        if isinstance(event, BlockSkip):
            number += event.on and not skips
            skips = event.on
        if not (skips and number in left_out) or isinstance(event, LoadTool | SelectTool):
            events.append(event)
    return without_rows(replace(operation, events=tuple(events)), gone), gone
