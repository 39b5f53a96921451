"""Holes as motion: rapids, pecks and dwells in place of a cycle that the control lacks.

In:     an operation as ``trunnion.planning.holes.operations.normalize_cycles`` returns it.
Out:    the same operation with rows of motion in place of the points of these holes, and without their cycles.

Heights are distances along the tool axis from the point of the hole, mm; docs/cl.md lists the motions of each cycle. A
thread needs a spindle that is synchronized with the feed, and a tool that lifts off sideways needs one that stops at an
angle. Motion can do neither, so such cycles stay.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import CycleOff, CycleOn, Dwell, Event, Kind, Operation, SpindleOff, SpindleOn
from trunnion.planning.holes.cycles import (
    Cycle,
    HoleCycleError,
    HoleMethod,
    SpindleState,
    SpindleStates,
    cycle_feed,
    cycle_from_event,
)
from trunnion.planning.holes.operations import cycle_row_ranges
from trunnion.planning.holes.pecks import SAME_HEIGHT, HoleMotions, hole_motions
from trunnion.planning.holes.skipped_holes import LevelWays, level_ways, with_lifts
from trunnion.planning.linearization.row_insertion import insert_rows
from trunnion.planning.options import CycleObjection
from trunnion.records import dataclass

#: The reason for holes as motion although the control has their cycles.
REQUESTED: Final = phrase("as_requested")

#: Methods that motion can replace.
CONVERTIBLE: Final = frozenset(
    {HoleMethod.DRILL, HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING, HoleMethod.REAM, HoleMethod.BORE}
)

#: A tool within this distance of the line above a hole, mm, moves straight down: a row to that line might print as no
#: motion.
_ABOVE_HOLE: Final = 2e-3

#: The most rows that an operation may get.
_MOST_ROWS: Final = 10_000_000

#: Rows that lead to a hole: up at the last one, across above this one, down to where the feed starts.
_LEADING: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class HoleConditions:
    """What decides whether the holes of an operation become motion.

    spindle            before the operation; None: it stands still
    from_home          (n,) bool, rows to which the tool comes from home
    general_objection  why no cycle at all can be used in this operation; None: cycles can
    cycle_objection    why the control lacks a cycle
    prefers_motion     holes become motion even if cycles can be used
    """

    spindle: SpindleState | None
    from_home: Flags
    general_objection: Wording | None
    cycle_objection: CycleObjection
    prefers_motion: bool

    def reason(self, cycle: Cycle, spindle: SpindleState | None) -> Wording | None:
        """Why the holes of a cycle become motion; None: they do not."""
        if cycle.method not in CONVERTIBLE:
            return None
        objection = self.general_objection or self.cycle_objection(cycle, spindle)
        return objection or (REQUESTED if self.prefers_motion else None)


@dataclass(frozen=True, slots=True)
class ConvertedCycles:
    """Cycles of one method that became motion for one reason; ``line`` is that of the first one."""

    method: HoleMethod
    line: int
    holes: int
    reason: Wording

    @property
    def description(self) -> Wording:
        """Such as ``CYCLE/DRILL expanded to rapids and lines for 2 holes``."""
        return phrase("cycle_expanded", method=str(self.method), count=self.holes)


@dataclass(frozen=True, slots=True, eq=False)
class HolesAsMotion:
    """An operation with holes as motion.

    first_rows  (n + 1,) int64  the first new row for each row of the operation before
    """

    operation: Operation
    first_rows: Ints
    converted: tuple[ConvertedCycles, ...] = ()


@dataclass(frozen=True, slots=True)
class _Holes:
    """Rows ``first`` to ``end`` (exclusive): holes of one cycle with the spindle in one state.

    reason  why they become motion; None: they do not
    """

    first: int
    end: int
    event: CycleOn
    cycle: Cycle
    reason: Wording | None
    spindle: SpindleState | None

    @property
    def rows(self) -> slice:
        return slice(self.first, self.end)

    @property
    def retract_height(self) -> float:
        assert self.cycle.retract_height is not None  # cycles are normalized
        return self.cycle.retract_height


def convert_holes_to_motion(operation: Operation, conditions: HoleConditions) -> HolesAsMotion:
    """Replace cycles by motion where the conditions ask for it.

    Raises ``HoleCycleError`` when a cycle that would become motion leaves out something that it needs, or there are too
    many rows.
    """
    every = list(_holes(operation, conditions))
    converted = [holes for holes in every if holes.reason]
    if not converted:
        return HolesAsMotion(operation, np.arange(len(operation.moves) + 1))
    before = _positions_before(operation, every)
    from_home = conditions.from_home.copy()
    from_home[0] = True
    ways = level_ways(operation, before, from_home, _feed_heights(operation, converted))
    rows = [_rows_of(operation, holes, ways, from_home) for holes in converted]
    copies = np.ones(len(operation.moves), np.int64)
    for holes, new in zip(converted, rows, strict=True):
        copies[holes.rows] = new.keep.sum(axis=1)
    if copies.sum() > _MOST_ROWS:
        raise HoleCycleError(Wording("PLN620", "holes_motions", sum=copies.sum()), converted[0].event.line)
    first_rows = np.concatenate(([0], np.cumsum(copies)))
    made = _with_rows(operation, converted, rows, copies, first_rows)
    return HolesAsMotion(*with_lifts(made, first_rows, ways.lifts), tuple(_summary(converted)))


def _holes(operation: Operation, conditions: HoleConditions) -> Iterator[_Holes]:
    """Yield the holes of an operation, cycle by cycle. Cycles that cannot be read are left to the writer's checks."""
    spindles = SpindleStates(operation.events, conditions.spindle)
    for event, end in cycle_row_ranges(operation):
        try:
            cycle = cycle_from_event(event)
        except HoleCycleError:
            continue
        reason = conditions.reason(cycle, spindles.at(event.row))
        for first, last in pairwise([event.row, *spindles.changes_between(event.row, end), end]):
            yield _Holes(first, last, event, cycle, reason, spindles.at(first))


def _positions_before(operation: Operation, every: Sequence[_Holes]) -> Floats:
    """(n, 3): where the tip is before each row, mm: retracted if the row before is a hole."""
    moves = operation.moves
    lift = np.zeros(len(moves))
    for holes in every:
        lift[holes.rows] = holes.retract_height
    return np.roll(moves.tip + lift[:, None] * moves.axis, 1, axis=0)


def _feed_heights(operation: Operation, converted: Sequence[_Holes]) -> Floats:
    """(n,): how far above the point of each hole its feed begins, mm; NaN at rows that are no hole as motion."""
    heights = np.full(len(operation.moves), np.nan)
    for holes in converted:
        heights[holes.rows] = holes.cycle.rapid_height
    return heights


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """The rows of m holes of one cycle. Each hole has s of them, of which only those in ``keep`` are made.

    tip   (m, s, 3) float64, mm
    keep  (m, s) bool
    """

    tip: Floats
    keep: Flags
    motions: HoleMotions
    feed: float
    per_rev: bool

    @property
    def kinds(self) -> list[Kind]:
        """The kinds of the s rows."""
        return [*[Kind.RAPID] * _LEADING, *self.motions.kinds]

    @property
    def bottom(self) -> int:
        """Which of the s rows reaches the bottom."""
        return _LEADING + self.motions.bottom


def _rows_of(operation: Operation, holes: _Holes, ways: LevelWays, from_home: Flags) -> _Rows:
    """Return the rows of holes; ``ways``: from where the tool comes to each row of the operation."""
    cycle, moves, rows, before = holes.cycle, operation.moves, holes.rows, ways.before
    feed, per_rev = cycle_feed(cycle, holes.spindle, float(moves.feed[holes.first]), bool(moves.per_rev[holes.first]))
    motions = _checked_motions(holes, feed)
    point, axis = moves.tip[rows], moves.axis[rows]
    height = np.where(from_home[rows], holes.retract_height, np.einsum("ij,ij->i", before[rows] - point, axis))
    is_low = height < cycle.rapid_height - SAME_HEIGHT
    if is_low[0] and moves.kind[holes.first - 1] != Kind.RAPID:
        raise HoleCycleError(Wording("PLN650", "cycle_while_tool"), holes.event.line)
    travel_height = np.maximum(height, cycle.rapid_height)
    above = point + travel_height[:, None] * axis
    up = before[rows] + (cycle.rapid_height - height)[:, None] * axis
    comes_down = travel_height > cycle.rapid_height + SAME_HEIGHT
    distance = np.abs(above - np.where(is_low[:, None], up, before[rows])).max(axis=1)
    is_there = ~from_home[rows] & ~ways.aside[rows] & (distance <= np.where(comes_down, _ABOVE_HOLE, SAME_HEIGHT))
    count = _LEADING + len(motions.heights)
    tip = np.empty((len(point), count, 3))
    tip[:, 0], tip[:, 1], tip[:, 2] = up, above, point + cycle.rapid_height * axis
    tip[:, _LEADING:] = point[:, None] + np.array(motions.heights)[None, :, None] * axis[:, None]
    keep = np.ones((len(point), count), np.bool_)
    keep[:, 0], keep[:, 1], keep[:, 2] = is_low, ~is_there, comes_down
    return _Rows(tip, keep, motions, feed, per_rev)


def _checked_motions(holes: _Holes, feed: float) -> HoleMotions:
    """Return the motions in a hole. Raises ``HoleCycleError``, with the line, if the cycle leaves out something."""
    try:
        motions = hole_motions(holes.cycle)
        if not feed > 0.0:
            raise HoleCycleError(Wording("CTL310", "cycle_without_feed"))
        if holes.cycle.dwell_in_revolutions and holes.spindle is None:
            raise HoleCycleError(Wording("PLN660", "dwell_rev_while"))
        if holes.cycle.method is HoleMethod.BORE and holes.spindle is None:
            raise HoleCycleError(Wording("PLN660", "cycle_bore_drag"))
    except HoleCycleError as error:
        raise HoleCycleError(error.wording, holes.event.line) from None
    return motions


def _with_rows(
    operation: Operation, converted: Sequence[_Holes], rows: Sequence[_Rows], copies: Ints, first_rows: Ints
) -> Operation:
    """Return the operation with all new rows; each old row becomes ``copies`` (n,) new ones from ``first_rows`` on."""
    moves = operation.moves
    tip, kind = np.repeat(moves.tip, copies, axis=0), np.repeat(moves.kind, copies)
    feed, per_rev = np.repeat(moves.feed, copies), np.repeat(moves.per_rev, copies)
    events: list[Event] = []
    for holes, new in zip(converted, rows, strict=True):
        at = first_rows[holes.first : holes.end, None] + np.cumsum(new.keep, axis=1) - 1
        kinds = np.broadcast_to(np.array(new.kinds, np.uint8), new.keep.shape)
        tip[at[new.keep]], kind[at[new.keep]] = new.tip[new.keep], kinds[new.keep]
        lines = at[new.keep & (kinds == Kind.LINEAR)]
        feed[lines], per_rev[lines] = new.feed, new.per_rev
        events += _events_at_bottom(holes, at[:, new.bottom] + 1, first_rows[holes.first + 1 : holes.end + 1])
    events = [event for event in events if event.row < len(tip)]
    axis = np.repeat(moves.axis, copies, axis=0)
    result = insert_rows(_without_cycles(operation, converted), copies, tip, axis, kind)
    return replace(
        result,
        moves=replace(result.moves, feed=feed, per_rev=per_rev),
        events=tuple(sorted([*events, *result.events], key=lambda event: event.row)),
    )


def _events_at_bottom(holes: _Holes, after: Ints, end: Ints) -> Iterator[Event]:
    """Dwells and spindle stops: before the rows ``after`` the bottom, and back on before the rows at the ``end``."""
    cycle, line, spindle = holes.cycle, holes.event.line, holes.spindle
    for row_after, row_end in zip(after.tolist(), end.tolist(), strict=True):
        if cycle.dwell:
            yield Dwell(row_after, line, cycle.dwell, cycle.dwell_in_revolutions)
        if cycle.method is HoleMethod.BORE and spindle is not None:
            yield SpindleOff(row_after, line)
            yield SpindleOn(row_end, line, spindle.rpm, spindle.sense)


def _without_cycles(operation: Operation, converted: Sequence[_Holes]) -> Operation:
    """Return the operation without the events that begin and end the converted cycles."""
    removed = {id(holes.event) for holes in converted}
    events: list[Event] = []
    in_removed = False
    for event in operation.events:
        if isinstance(event, CycleOn):
            in_removed = id(event) in removed
        if not (in_removed and isinstance(event, CycleOn | CycleOff)):
            events.append(event)
    return replace(operation, events=tuple(events))


def _summary(converted: Sequence[_Holes]) -> Iterator[ConvertedCycles]:
    """One entry for each method and reason."""
    groups: dict[tuple[HoleMethod, Wording], list[_Holes]] = {}
    for holes in converted:
        if holes.reason is not None:
            groups.setdefault((holes.cycle.method, holes.reason), []).append(holes)
    for (method, reason), group in groups.items():
        count = sum(holes.end - holes.first for holes in group)
        yield ConvertedCycles(method, group[0].event.line, count, reason)
