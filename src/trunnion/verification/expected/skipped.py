"""What the CL files let the operator skip: OPSKIP/ON to OPSKIP/OFF.

In:     an operation.
Out:    its stretches that may be skipped; the operation without some of them; and where a retract is missing then.
"""

import sys
from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.toolpath import BlockSkip, CycleOff, CycleOn, Kind, LoadTool, Moves, Operation, SelectTool
from trunnion.verification.expected.holes import without_holes, without_rows

#: Smaller motion, mm, is none.
_STILL: Final = 1e-3

#: Tool axes are the same when no component differs by more than this.
_SAME_AXIS: Final = 1e-6


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

    Tools are called all the same, and cycles begin and end: a point behind the stretch is a hole in both cases or none.
    """
    gone = np.zeros(len(operation.moves), np.bool_)
    for number, stretch in enumerate(skipped_stretches(operation)):
        gone[stretch.begin : stretch.end] |= number in left_out
    events, number, skips = [], -1, False
    for event in operation.events:
        if isinstance(event, BlockSkip):
            number += event.on and not skips
            skips = event.on
        if not (skips and number in left_out) or isinstance(event, LoadTool | SelectTool | CycleOn | CycleOff):
            events.append(event)
    return without_rows(replace(operation, events=tuple(events)), gone), gone


def rows_without_retract(operation: Operation, gone: Flags) -> Ints:
    """Return the rows to which the tool comes aslant while the rows ``gone`` (n,) bool are skipped.

    Out of a cut, or from below the top of the cuts, where the skipped rows go higher along the tool and do not come
    back there, or where the retract follows them; and down into a cut where a rapid of theirs leads above it. The cycle
    of a hole has its own ways.
    """
    moves, holes = operation.moves, without_holes(operation)[1]
    edges = np.flatnonzero(np.diff(np.concatenate(([False], gone, [False])).astype(np.int8)))
    ends = [(begin, end) for begin, end in edges.reshape(-1, 2).tolist() if begin and end < len(gone)]
    way = _Ways(moves, holes)
    return np.array([end for begin, end in ends if way.is_aslant(begin, end)], np.int64)


class _Ways(NamedTuple):
    """Ways past the skipped rows of an operation, of which some are holes, (n,) bool."""

    moves: Moves
    holes: Flags

    def is_aslant(self, begin: int, end: int) -> bool:
        """Whether the way past rows ``begin`` to ``end`` (exclusive) may lead through the part."""
        moves, holes = self.moves, self.holes
        before, last = begin - 1, end - 1
        start, along = moves.tip[before], moves.axis[before]
        if holes[before] or float(np.abs(moves.tip[last] - start).max()) <= _STILL or self._is_straight(before, end):
            return False
        from_cut, to_cut = (moves.kind[row] != Kind.RAPID for row in (before, end))
        rises = float(((moves.tip[begin:end] - start) @ along).max()) > _STILL
        if from_cut:
            retracts = moves.kind[last] != Kind.RAPID and not to_cut and self._is_straight(last, end)
            return rises or bool(retracts and not holes[last])
        if holes[end] or holes[last]:
            return False
        if to_cut:  # behind skipped cuts aslant as well where the CL file comes to them so
            straight = moves.kind[last] == Kind.RAPID or self._is_straight(*self._last_plunge(begin, end))
            return straight and float((moves.tip[end] - start) @ moves.axis[end]) < -_STILL
        return rises and float(start @ along) < self._highest(along) - _STILL

    def _last_plunge(self, begin: int, end: int) -> tuple[int, int]:
        """Return the rows between which the last cuts before ``end`` begin, behind a rapid."""
        is_rapid = self.moves.kind[begin - 1 : end] == Kind.RAPID
        row = begin + int(np.flatnonzero(is_rapid[:-1] & ~is_rapid[1:])[-1])
        return row - 1, row

    def _is_straight(self, first: int, row: int) -> bool:
        """Whether the way from one row to another is along the tool of the first one, and the tool does not turn."""
        along = self.moves.axis[first]
        step = self.moves.tip[row] - self.moves.tip[first]
        turns = float(np.abs(self.moves.axis[row] - along).max()) > _SAME_AXIS
        return not turns and float(np.linalg.norm(step - (step @ along) * along)) <= _STILL

    def _highest(self, along: Floats) -> float:
        """How high the cuts and holes come along a direction (3,), mm."""
        cuts = (self.moves.kind != Kind.RAPID) | self.holes
        return float((self.moves.tip[cuts] @ along).max(initial=-np.inf))
