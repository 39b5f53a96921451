"""What the CL files let the operator skip: OPSKIP/ON to OPSKIP/OFF.

In:     an operation.
Out:    its stretches that may be skipped; the operation without some of them; and where a retract is missing then.
"""

import sys
from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.toolpath import BlockSkip, Kind, LoadTool, Operation, SelectTool
from trunnion.verification.expected.holes import without_holes, without_rows

#: Smaller motion, mm, is none.
_STILL: Final = 1e-3


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


def rows_without_retract(operation: Operation, gone: Flags) -> Ints:
    """Return the rows that leave the cut sideways while the rows ``gone`` (n,) bool are skipped, as a retract is gone.

    The skipped rows go higher along the tool than where a cut before them ends, and do not come back there. The cycle
    of a hole has its own retract.
    """
    tip, axis = operation.moves.tip, operation.moves.axis
    in_cut = (operation.moves.kind != Kind.RAPID) & ~without_holes(operation)[1]
    edges = np.flatnonzero(np.diff(np.concatenate(([False], gone, [False])).astype(np.int8)))
    found = list[int]()
    for begin, end in edges.reshape(-1, 2).tolist():
        if begin == 0 or end == len(gone) or not in_cut[begin - 1]:
            continue
        start, along = tip[begin - 1], axis[begin - 1]
        rises = float(((tip[begin:end] - start) @ along).max()) > _STILL
        comes_back = float(np.abs(tip[end - 1] - start).max()) <= _STILL
        step = tip[end] - start
        aside = float(np.linalg.norm(step - (step @ along) * along))
        if rises and not comes_back and aside > _STILL:
            found.append(end)
    return np.array(found, np.int64)
