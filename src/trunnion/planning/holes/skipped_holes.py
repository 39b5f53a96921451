"""Ways to holes as motion behind blocks that may be skipped: right with the skip switch on and off.

In:     an operation with cycles, and where the tip is before each of its rows.
Out:    where it is before them with its way raised to one height, and the rows that raise it.

With the switch off the tool comes to such a hole from the skipped rows, with the switch on from the row before them.
Both must be at one height, so that it goes across level. The lower one is raised along the tool axis.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording
from trunnion.model.toolpath import BlockSkip, Kind, Operation
from trunnion.planning.holes.cycles import HoleCycleError
from trunnion.planning.holes.pecks import SAME_HEIGHT
from trunnion.planning.linearization.row_insertion import insert_rows
from trunnion.records import dataclass

#: Tool axes are the same if no component differs by more than this.
_SAME_AXIS: Final = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class LevelWays:
    """Ways to holes that are level whether blocks are skipped or not.

    before   (n, 3) where the tip is before each row, mm
    aside    (n,) bool, holes to which the tool comes from two places
    lifts    row -> (3,) where the tip goes before that row and its events, mm
    """

    before: Floats
    aside: Flags
    lifts: dict[int, Floats]


def level_ways(operation: Operation, before: Floats, from_home: Flags, least: Floats) -> LevelWays:
    """Raise what is before and behind rows that may be skipped to one height, where a hole as motion follows.

    before      (n, 3) where the tip is before each row, mm
    from_home   (n,) bool, rows to which the tool comes from home
    least       (n,) height above the point of a hole as motion where its feed begins, mm; NaN at other rows

    Raises ``HoleCycleError`` where a cut ends at the lower height.
    """
    moves, found = operation.moves, LevelWays(before.copy(), np.zeros(len(before), np.bool_), {})
    for first, end in _skipped_rows(operation):
        if not 0 < first < end < len(moves) or np.isnan(least[end]) or from_home[first : end + 1].any():
            continue
        axis = moves.axis[end]
        if np.abs(moves.axis[first - 1 : end] - axis).max() > _SAME_AXIS:
            continue
        rows = (first, end)
        heights = [float(before[row] @ axis) for row in rows]
        level = max(*heights, float(moves.tip[end] @ axis) + float(least[end]))
        lifts = [row for row, height in zip(rows, heights, strict=True) if height < level - SAME_HEIGHT]
        cuts = moves.kind != Kind.RAPID
        if any(cuts[row - 1] for row in lifts) or (first in lifts and cuts[first]):
            # A cut ends there, or begins: nothing says that it may be left upwards, or begun from above.
            raise HoleCycleError(Wording("PLN650", "cut_beside_skipped"), int(moves.line[end]))
        for row, height in zip(rows, heights, strict=True):
            found.before[row] = before[row] + (level - height) * axis
        found.lifts.update((row, found.before[row]) for row in lifts)
        found.aside[end] = np.abs(found.before[first] - found.before[end]).max() > SAME_HEIGHT
    return found


def with_lifts(operation: Operation, first_rows: Ints, lifts: dict[int, Floats]) -> tuple[Operation, Ints]:
    """Return the operation with the rows that raise the tool, and its first new rows.

    operation    with holes as motion
    first_rows   (n + 1,) the first row of it for each row of the operation before
    lifts        as those of ``LevelWays``
    """
    if not lifts:
        return operation, first_rows
    moves, rows = operation.moves, np.array(sorted(lifts))
    copies = np.ones(len(moves), np.int64)
    copies[first_rows[rows]] += 1
    added = first_rows[rows] + np.arange(len(rows))
    tip, kind = np.repeat(moves.tip, copies, axis=0), np.repeat(moves.kind, copies)
    tip[added], kind[added] = [lifts[row] for row in rows.tolist()], Kind.RAPID
    result = insert_rows(operation, copies, tip, np.repeat(moves.axis, copies, axis=0), kind)
    behind = {int(row): int(row) + 1 for row in added}
    events = tuple(replace(event, row=behind.get(event.row, event.row)) for event in result.events)
    shift = np.searchsorted(rows, np.arange(len(first_rows)), "right")
    return replace(result, events=events), first_rows + shift


def _skipped_rows(operation: Operation) -> Iterator[tuple[int, int]]:
    """Yield the rows that may be skipped, each stretch with its first and the one after its last."""
    skips = np.zeros(len(operation.moves) + 1, np.int8)
    for event in operation.events:
        if isinstance(event, BlockSkip):
            skips[event.row :] = event.on
    skips[-1] = 0
    edges = np.flatnonzero(np.diff(skips, prepend=np.int8(0))).tolist()
    yield from zip(edges[::2], edges[1::2], strict=True)
