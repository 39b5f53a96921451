"""Holes as motion: rapids, strokes and dwells in place of a cycle that the control cannot say.

In:     an operation whose cycles are around holes only, as ``trunnion.planning.holes.cycles.normalize_cycles`` leaves
it. Out:    the same operation with the rows of these holes in place of their points, and without their cycles.

Heights are distances along the tool axis from the point of the hole, mm; docs/cl.md says which motions these are. A
thread needs a spindle that is held to the feed, and a tool that lifts off aside one that is oriented: no motion says
that, and such cycles stay.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.model.toolpath import CycleOff, CycleOn, Dwell, Event, Kind, Operation, SpindleOff, SpindleOn
from trunnion.planning.holes.cycles import (
    Cycle,
    HoleCycleError,
    HoleMethod,
    SpindleState,
    cycle_feed,
    cycle_from_event,
    cycle_row_ranges,
    spindle_state_at,
)
from trunnion.planning.linearization.row_insertion import insert_rows
from trunnion.planning.options import ControlCapabilities, PlanOptions

#: Why holes are made as motion whose cycles could be said.
REQUESTED: Final = "it is asked for"

#: Holes that motion can make.
CONVERTIBLE: Final = frozenset(
    {HoleMethod.DRILL, HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING, HoleMethod.REAM, HoleMethod.BORE}
)

#: A rapid back into the hole ends this far above what is drilled; a stroke that breaks chips is drawn back as far, mm.
REENTRY_CLEARANCE: Final = 0.5

#: Heights are the same when they differ by no more than this, mm.
_SAME: Final = 1e-9

#: Who stands over a hole by this, mm, comes straight down from there: a row to it might print as no motion.
_OVER: Final = 2e-3

#: Strokes of a hole, and rows of an operation, are no more.
_MOST_STROKES: Final = 10_000
_MOST_ROWS: Final = 10_000_000

#: Rows that lead to a hole: up where the tool is, over the hole, down to where the feed begins.
_LEADING: Final = 3


@dataclass(frozen=True, slots=True)
class ConvertedCycles:
    """Cycles of one kind that became motion: how many holes, the line of the first one's cycle, and why."""

    method: HoleMethod
    line: int
    holes: int
    why: str


@dataclass(frozen=True, slots=True, eq=False)
class HolesAsMotion:
    """An operation with holes as motion.

    first     (n + 1,) int64  the new row with which each row of the operation before begins
    resolved  what became of which cycles
    """

    operation: Operation
    first: Ints
    converted: tuple[ConvertedCycles, ...] = ()


@dataclass(frozen=True, slots=True)
class _Holes:
    """Rows ``first`` to ``end`` are holes of one cycle, which has a retract height.

    ``why`` they are made as motion; empty: they are not.
    """

    first: int
    end: int
    event: CycleOn
    cycle: Cycle
    why: str
    spindle: SpindleState | None


def convert_holes_to_motion(
    operation: Operation,
    options: PlanOptions,
    capabilities: ControlCapabilities,
    held: SpindleState | None,
    home: Flags,
    why: str,
) -> HolesAsMotion:
    """Make holes as motion where the control cannot say their cycles.

    Parameters
    ----------
    operation
        In any coordinate system.
    wishes
        What the control cannot say, and whether motion is preferred anyhow.
    held
        The spindle before the operation; None: nobody said so.
    home : (n,) bool
        To this row the tool comes from home.
    why
        Why no cycle can be said in this operation, whichever; empty: cycles can.

    Raises
    ------
    HoleCycleError
        When a cycle that would be made as motion leaves out what must be said.
    """
    every = list(_cycles(operation, options, capabilities, held, why))
    wanted = [holes for holes in every if holes.why]
    rows = np.arange(len(operation.moves) + 1)
    if not wanted:
        return HolesAsMotion(operation, rows)
    moves = operation.moves
    lift = np.zeros(len(moves))
    for holes in every:
        assert holes.cycle.retract_height is not None
        lift[holes.first : holes.end] = holes.cycle.retract_height
    came = np.roll(moves.tip + lift[:, None] * moves.axis, 1, axis=0)
    from_home = home.copy()
    from_home[0] = True
    pieces = [_rows_of(operation, holes, came, from_home) for holes in wanted]
    copies = np.ones(len(moves), np.int64)
    for holes, piece in zip(wanted, pieces, strict=True):
        copies[holes.first : holes.end] = piece.keep.sum(axis=1)
    if copies.sum() > _MOST_ROWS:
        raise HoleCycleError(f"holes of {copies.sum()} motions", "output longer strokes", wanted[0].event.line)
    first = np.concatenate(([0], np.cumsum(copies)))
    tip, kind = np.repeat(moves.tip, copies, axis=0), np.repeat(moves.kind, copies)
    feed, per_rev = np.repeat(moves.feed, copies), np.repeat(moves.per_rev, copies)
    events: list[Event] = []
    for holes, piece in zip(wanted, pieces, strict=True):
        at = first[holes.first : holes.end, None] + np.cumsum(piece.keep, axis=1) - 1
        tip[at[piece.keep]], kind[at[piece.keep]] = piece.tip[piece.keep], piece.kind[piece.keep]
        lines = at[piece.keep & (piece.kind == Kind.LINEAR)]
        feed[lines], per_rev[lines] = piece.feed, piece.per_rev
        events += _at_the_bottom(holes, at[:, _LEADING + piece.bottom] + 1, first[holes.first + 1 : holes.end + 1])
    events = [event for event in events if event.row < len(tip)]
    made = insert_rows(_without_cycles(operation, wanted), copies, tip, np.repeat(moves.axis, copies, axis=0), kind)
    made = replace(
        made,
        moves=replace(made.moves, feed=feed, per_rev=per_rev),
        events=tuple(sorted([*events, *made.events], key=lambda event: event.row)),
    )
    return HolesAsMotion(made, first, tuple(_told(wanted)))


def _cycles(
    operation: Operation, options: PlanOptions, capabilities: ControlCapabilities, held: SpindleState | None, why: str
) -> Iterator[_Holes]:
    """The holes of an operation, cycle by cycle; what is wrong with a cycle is left to whoever says it."""
    changes = [event.row for event in operation.events if isinstance(event, SpindleOn | SpindleOff)]
    for event, end in cycle_row_ranges(operation):
        try:
            cycle = cycle_from_event(event)
        except HoleCycleError:
            continue
        spindle = spindle_state_at(operation.events, event.row, held)
        reason = why or capabilities.cycle_objection(cycle, spindle) or (REQUESTED if options.holes_as_motion else "")
        reason = reason if cycle.method in CONVERTIBLE else ""
        rows = sorted({event.row, *(row for row in changes if event.row < row < end), end})
        for first, last in pairwise(rows):
            yield _Holes(first, last, event, cycle, reason, spindle_state_at(operation.events, first, held))


def stroke_depths(cycle: Cycle) -> list[float]:
    """The depths below the point of the hole, mm, that are drilled to one after another.

    Raises
    ------
    HoleCycleError
        When the strokes never get there.
    """
    if cycle.method not in (HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING):
        return [cycle.depth]
    stroke, less, least = cycle.strokes
    if less < 0.0 or least < 0.0:
        raise HoleCycleError("STEP with a number below 0", "write STEP,first,less,shortest")
    depths = [min(stroke, cycle.depth)]
    while cycle.depth - depths[-1] > _SAME:
        stroke = max(stroke - less, min(least, stroke))
        if not stroke > 0.0:
            raise HoleCycleError("STEP without a shortest stroke", "write STEP,first,less,shortest")
        if len(depths) >= _MOST_STROKES:
            raise HoleCycleError(f"a hole in more than {_MOST_STROKES} strokes", "write longer ones")
        depths.append(min(depths[-1] + stroke, cycle.depth))
    return [*depths[:-1], cycle.depth]


def cycle_motions(cycle: Cycle) -> tuple[list[float], list[Kind], int]:
    """The motions from RAPTO on: heights to which they go, mm, how, and which of them reaches the bottom."""
    assert cycle.retract_height is not None
    made: list[tuple[float, Kind]] = []
    before = 0.0
    for number, depth in enumerate(stroke_depths(cycle)):
        if number and cycle.method is HoleMethod.DEEP_DRILLING:
            made.append((cycle.rapid_height, Kind.RAPID))
            if REENTRY_CLEARANCE - before < cycle.rapid_height - _SAME:
                made.append((REENTRY_CLEARANCE - before, Kind.RAPID))
        elif number:
            made.append((min(REENTRY_CLEARANCE, 0.5 * before) - before, Kind.RAPID))
        made.append((-depth, Kind.LINEAR))
        before = depth
    bottom = len(made) - 1
    if cycle.method is HoleMethod.REAM:
        made.append((cycle.rapid_height, Kind.LINEAR))
    if cycle.method is not HoleMethod.REAM or cycle.retract_height > cycle.rapid_height + _SAME:
        made.append((cycle.retract_height, Kind.RAPID))
    return [height for height, _ in made], [kind for _, kind in made], bottom


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """The rows of m holes of one cycle: each has the same s, of which the first few may be left out.

    tip (m, s, 3), kind (m, s), keep (m, s) bool, and which of the rows after the leading ones reaches the bottom
    """

    tip: Floats
    kind: Codes
    keep: Flags
    bottom: int
    feed: float
    per_rev: bool


def _rows_of(operation: Operation, holes: _Holes, came: Floats, from_home: Flags) -> _Rows:
    """The rows of holes of one cycle; ``came`` (n, 3): where the tool is before each row."""
    cycle, moves, part = holes.cycle, operation.moves, slice(holes.first, holes.end)
    assert cycle.retract_height is not None
    feed, per_rev = cycle_feed(cycle, holes.spindle, float(moves.feed[holes.first]), bool(moves.per_rev[holes.first]))
    try:
        heights, kinds, bottom = cycle_motions(cycle)
        if not feed > 0.0:
            raise HoleCycleError("CYCLE without a feed", "write MMPM,feed, or FEDRAT before it")
        if cycle.dwell_in_revolutions and holes.spindle is None:
            raise HoleCycleError("DWELL,REV while the spindle stands still", "put SPINDL before the cycle")
        if cycle.method is HoleMethod.BORE and holes.spindle is None:
            raise HoleCycleError("CYCLE/BORE,DRAG while the spindle stands still", "put SPINDL before the cycle")
    except HoleCycleError as error:
        raise HoleCycleError(error.what, error.cure, holes.event.line) from None
    point, axis = moves.tip[part], moves.axis[part]
    high = np.where(from_home[part], cycle.retract_height, np.einsum("ij,ij->i", came[part] - point, axis))
    low = high < cycle.rapid_height - _SAME
    first = holes.first
    if low[0] and moves.kind[first - 1] != Kind.RAPID:
        what, cure = "CYCLE while the tool is below the height of RAPTO", "draw the tool back before the cycle"
        raise HoleCycleError(what, cure, holes.event.line)
    travel = np.maximum(high, cycle.rapid_height)
    over = point + travel[:, None] * axis
    up = came[part] + (cycle.rapid_height - high)[:, None] * axis
    comes_down = travel > cycle.rapid_height + _SAME
    away = np.abs(over - np.where(low[:, None], up, came[part])).max(axis=1)
    stands = ~from_home[part] & (away <= np.where(comes_down, _OVER, _SAME))
    count = _LEADING + len(heights)
    tip = np.empty((len(point), count, 3))
    tip[:, 0], tip[:, 1], tip[:, 2] = up, over, point + cycle.rapid_height * axis
    tip[:, _LEADING:] = point[:, None] + np.array(heights)[None, :, None] * axis[:, None]
    keep = np.ones((len(point), count), np.bool_)
    keep[:, 0], keep[:, 1], keep[:, 2] = low, ~stands, comes_down
    kind = np.tile(np.array([*[Kind.RAPID] * _LEADING, *kinds], np.uint8), (len(point), 1))
    return _Rows(tip, kind, keep, bottom, feed, per_rev)


def _at_the_bottom(holes: _Holes, after: Ints, end: Ints) -> Iterator[Event]:
    """What happens in each hole before the row ``after`` its bottom, and before the row at its ``end``."""
    cycle, line, spindle = holes.cycle, holes.event.line, holes.spindle
    for out, beyond in zip(after.tolist(), end.tolist(), strict=True):
        if cycle.dwell:
            yield Dwell(out, line, cycle.dwell, cycle.dwell_in_revolutions)
        if cycle.method is HoleMethod.BORE and spindle is not None:
            yield SpindleOff(out, line)
            yield SpindleOn(beyond, line, spindle.rpm, spindle.sense)


def _without_cycles(operation: Operation, made: list[_Holes]) -> Operation:
    """The operation without the events that begin and end some cycles."""
    gone = {id(holes.event) for holes in made}
    events: list[Event] = []
    off = False
    for event in operation.events:
        if isinstance(event, CycleOn):
            off = id(event) in gone
        elif not isinstance(event, CycleOff):
            events.append(event)
            continue
        if not off:
            events.append(event)
    return replace(operation, events=tuple(events))


def _told(made: list[_Holes]) -> Iterator[ConvertedCycles]:
    """One entry for each kind of cycle and reason."""
    found: dict[tuple[HoleMethod, str], list[_Holes]] = {}
    for holes in made:
        found.setdefault((holes.cycle.method, holes.why), []).append(holes)
    for (method, why), each in found.items():
        yield ConvertedCycles(method, each[0].event.line, sum(holes.end - holes.first for holes in each), why)
