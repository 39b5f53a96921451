"""Operations with hole-making cycles: which rows are holes, and where the tool axis changes between them."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.messages import Wording
from trunnion.model.toolpath import Arcs, BlockSkip, CycleOff, CycleOn, Event, Kind, Operation
from trunnion.planning.holes.cycles import HoleCycleError

#: Tool axes are the same if no component differs by more than this; CL files print seven decimals or more.
_SAME_AXIS: Final = 1e-7


def normalize_cycles(operation: Operation) -> Operation:
    """Return the operation with cycles around holes only, a rapid into every hole, and RTRCTO,AUTO as a distance.

    A cycle without a feed of its own is stated again where the modal feed changes.

    Raises ``HoleCycleError`` when AUTO stands for the height before the cycle, and no point is before it.
    """
    if not any(isinstance(event, CycleOn) for event in operation.events):
        return operation
    holes, moves = hole_rows(operation), operation.moves
    here_by_row: defaultdict[int, list[Event]] = defaultdict(list)
    for event in operation.events:
        here_by_row[event.row].append(event)
    in_force: CycleOn | None = None
    events: list[Event] = []
    cycle: CycleOn | None = None
    edges = np.flatnonzero(np.diff(holes, prepend=False, append=False)).tolist()
    new_feed = set(_feed_change_rows(operation, holes))
    for row in sorted({*edges, *here_by_row, *new_feed}):
        here = here_by_row[row]
        in_force = next((event for event in reversed(here) if isinstance(event, CycleOn)), in_force)
        is_hole = row < len(moves) and bool(holes[row])
        changes = any(isinstance(event, CycleOn | CycleOff) for event in here)
        changes = changes or (row in new_feed and in_force is not None and not _has_own_feed(in_force))
        if cycle is not None and (changes or not is_hole):
            events.append(CycleOff(row, cycle.line))
            cycle = None
        events += [event for event in here if not isinstance(event, CycleOn | CycleOff)]
        if is_hole and cycle is None:
            assert in_force is not None
            cycle = replace(_with_retract_distance(operation, in_force), row=row)
            events.append(cycle)
    kind = np.where(holes, np.uint8(Kind.RAPID), moves.kind)
    return replace(operation, moves=replace(moves, kind=kind), events=tuple(events))


def hole_rows(operation: Operation) -> Flags:
    """(n,) bool: the row is a hole: a cycle is on there, and it is no rapid."""
    switches = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    rows = np.array([event.row for event in switches], np.int64)
    on = np.array([False, *(isinstance(event, CycleOn) for event in switches)])
    is_on = on[np.searchsorted(rows, np.arange(len(operation.moves)), "right")]
    return np.asarray(is_on & (operation.moves.kind != Kind.RAPID))


def _feed_change_rows(operation: Operation, holes: Flags) -> list[int]:
    """Rows of holes whose modal feed is another one than that of the hole before."""
    feed, per_rev = operation.moves.feed, operation.moves.per_rev
    changes = (np.diff(feed) != 0.0) & ~(np.isnan(feed[1:]) & np.isnan(feed[:-1]))
    changes |= per_rev[1:] != per_rev[:-1]
    return (np.flatnonzero(changes & holes[1:] & holes[:-1]) + 1).tolist()


def _has_own_feed(event: CycleOn) -> bool:
    """Whether a cycle states its feed."""
    return any(word in ("MMPM", "MMPR") for word, _ in event.values)


def _with_retract_distance(operation: Operation, event: CycleOn) -> CycleOn:
    """RTRCTO,AUTO as a distance: that of the point before the cycle from its first hole, along the tool axis."""
    words = dict(event.words)
    if words.get("RTRCTO") != "AUTO":
        return event
    moves = operation.moves
    if event.row == 0:
        raise HoleCycleError(Wording("PLN650", "rtrcto_auto_before"), event.line)
    height = float((moves.tip[event.row - 1] - moves.tip[event.row]) @ moves.axis[event.row])
    words.pop("RTRCTO")
    return replace(event, values=(*event.values, ("RTRCTO", (height,))), words=tuple(words.items()))


def cycle_row_ranges(operation: Operation) -> Iterator[tuple[CycleOn, int]]:
    """Yield the cycles of a normalized operation, each with the row after its last hole."""
    cycle: CycleOn | None = None
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff) and cycle is not None:
            yield cycle, event.row
        if isinstance(event, CycleOn | CycleOff):
            cycle = event if isinstance(event, CycleOn) else None


def split_by_axis(operation: Operation) -> list[tuple[int, int]] | None:
    """Rows, first and end, of each stretch with one tool axis in an operation with holes.

    None without holes, or if the operation cannot be split there: it has arcs, or its axis changes in a cut.
    """
    if not any(isinstance(event, CycleOn) for event in operation.events) or len(operation.arcs.row):
        return None
    turns = axis_change_rows(operation)
    if (operation.moves.kind[turns] != Kind.RAPID).any():
        return None
    return row_ranges(turns, len(operation.moves))


def axis_change_rows(operation: Operation) -> Ints:
    """Rows whose tool axis differs from that of the row before."""
    return np.flatnonzero(np.abs(np.diff(operation.moves.axis, axis=0)).max(axis=1, initial=0.0) > _SAME_AXIS) + 1


def row_ranges(starts: Ints, count: int) -> list[tuple[int, int]]:
    """Rows, first and end, of the parts of ``count`` rows; ``starts`` are the first rows of all parts but the first."""
    return list(pairwise([0, *starts.tolist(), count]))


def extract_rows(operation: Operation, first: int, end: int) -> Operation:
    """Rows ``first`` to ``end`` of an operation, with the cycle in force at their start. No arc may cross into them.

    An OPSKIP/OFF that is the first event before a row ends what may be skipped right behind the row before.
    """
    moves, arcs = operation.moves, operation.arcs
    is_last = end == len(moves)
    ends = {row: next((e for e in operation.events if e.row == row), None) for row in (first, end)}
    own, ending = (event if isinstance(event, BlockSkip) and not event.on else None for event in ends.values())
    inside = [
        e
        for e in operation.events
        if (first <= e.row < end and (first == 0 or e is not own)) or (e.row == end and (is_last or e is ending))
    ]
    before = [e for e in operation.events if isinstance(e, CycleOn | CycleOff) and e.row < first]
    events = [replace(event, row=event.row - first) for event in inside]
    if before and isinstance(before[-1], CycleOn) and not any(isinstance(e, CycleOff) and e.row == 0 for e in events):
        events.insert(0, replace(before[-1], row=0))
    here = (arcs.row >= first) & (arcs.row < end)
    kept = Arcs(arcs.row[here] - first, arcs.centre[here], arcs.normal[here], arcs.radius[here], arcs.full_turns[here])
    splines = operation.splines.inside(first, end)
    return replace(operation, moves=moves.select(slice(first, end)), arcs=kept, splines=splines, events=tuple(events))
