"""What the path of an operation amounts to: lengths, times at the programmed feeds, extents, and its kind.

Units: mm, seconds, mm/min, mm/rev, rev/min. Frames: each function says which.
"""

import math
from dataclasses import field
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.model.arc_extremes import operation_arcs, tip_reach
from trunnion.model.arcs import arc_lengths
from trunnion.model.toolpath import CycleOff, CycleOn, Dwell, Event, Kind, Operation, SpindleOff, SpindleOn
from trunnion.planning.holes.cycles import HoleCycleError, HoleMethod, SpindleState, cycle_feed, cycle_from_event
from trunnion.planning.holes.hole_ends import hole_ends
from trunnion.planning.holes.operations import axis_change_rows, hole_rows, normalize_cycles
from trunnion.records import dataclass

#: Tool axes are the same if no component differs by more than this; CL files print seven decimals or more.
_SAME_AXIS: Final = 1e-7

#: Decimals of tool axes that are told apart.
_AXIS_DECIMALS: Final = 6

#: Holes whose tool also leaves at feed.
_OUT_AT_FEED: Final = frozenset({
    HoleMethod.TAP, HoleMethod.FLOATING_TAP, HoleMethod.DEEP_TAP, HoleMethod.CHIP_BREAKING_TAP, HoleMethod.REAM,
})  # fmt: skip

#: No move and no dwell takes longer, seconds.
_LONGEST_TIME: Final = 1e9

THREE_AXIS: Final = "three-axis"
TILTED: Final = "3+2"
SIMULTANEOUS: Final = "simultaneous"
EMPTY: Final = "empty"


@dataclass(slots=True)
class Range:
    """The lowest and the highest of some values."""

    low: float = math.inf
    high: float = -math.inf

    def add(self, values: Floats | float) -> None:
        """Take values into account, NaN excepted."""
        known = np.asarray(values, np.float64)
        known = known[np.isfinite(known)]
        if known.size:
            self.low, self.high = min(self.low, float(known.min())), max(self.high, float(known.max()))

    def pair(self) -> tuple[float, float] | None:
        """Both; None if there was no value."""
        return None if self.low > self.high else (self.low, self.high)


@dataclass(slots=True)
class Measures:
    """Lengths and times of an operation.

    cutting_length     of lines, arcs and the way of holes at feed, mm
    rapid_length       of rapids between points, mm
    cutting_seconds    of those at feed, dwells included
    moves_without_time moves and holes at feed whose time is not known: no feed, no speed, or a cycle that is not known
    feed, feed_per_rev, rpm  ranges while cutting
    """

    cutting_length: float = 0.0
    rapid_length: float = 0.0
    cutting_seconds: float = 0.0
    moves_without_time: int = 0
    feed: Range = field(default_factory=Range)
    feed_per_rev: Range = field(default_factory=Range)
    rpm: Range = field(default_factory=Range)


def kind_and_planes(operation: Operation) -> tuple[str, tuple[tuple[float, float, float], ...]]:
    """How the tool axis of an operation behaves, and the tool axes of its planes if it is 3+2, in its coordinates.

    An operation whose axis changes in a cut is simultaneous. One whose axis changes only at rapids or from hole to hole
    is in several planes.
    """
    axis = operation.moves.axis
    if not len(axis):
        return EMPTY, ()
    turns = axis_change_rows(operation)
    cutting = (operation.moves.kind != Kind.RAPID) & ~hole_rows(operation)
    if cutting[turns].any():
        return SIMULTANEOUS, ()
    # The axis of a rapid alone is no plane: something must be cut under it.
    work = axis[operation.moves.kind != Kind.RAPID]
    planes = dict.fromkeys(map(tuple, (np.round(work if len(work) else axis, _AXIS_DECIMALS) + 0.0).tolist()))
    if len(planes) == 1 and np.abs((work if len(work) else axis) - [0.0, 0.0, 1.0]).max() <= _SAME_AXIS:
        return THREE_AXIS, ()
    return TILTED, tuple((i, j, k) for i, j, k in planes)


def measure(operation: Operation, before: Floats | None, spindle: SpindleState | None) -> Measures:
    """Measure an operation in any coordinates.

    operation  the operation
    before     (3,) float64, optional: where the tool stands before it, in the same coordinates; None: not known, so its
               first move has no length
    spindle    as it turns before the operation; None: it stands
    """
    found = Measures()
    moves = operation.moves
    if not len(moves):
        return found
    holes = hole_rows(operation)
    rpm = _speeds(operation, spindle)
    length = _lengths(operation, before)
    is_rapid = moves.kind == Kind.RAPID
    found.rapid_length = float(length[is_rapid | holes].sum())
    cut = ~is_rapid & ~holes
    per_minute = np.where(moves.per_rev, moves.feed * rpm, moves.feed)[cut]
    with np.errstate(divide="ignore", invalid="ignore"):
        seconds = np.where(length[cut] > 0.0, 60.0 * length[cut] / per_minute, 0.0)
    known = (seconds >= 0.0) & (seconds <= _LONGEST_TIME)
    found.cutting_length = float(length[cut].sum())
    found.cutting_seconds = float(seconds[known].sum())
    found.moves_without_time = int((~known).sum())
    found.feed.add(moves.feed[cut & ~moves.per_rev])
    found.feed_per_rev.add(moves.feed[cut & moves.per_rev])
    found.rpm.add(rpm[cut | holes][rpm[cut | holes] > 0.0])
    _add_holes(found, operation, holes, rpm)
    for event in operation.events:
        if isinstance(event, Dwell):
            _add_dwell(found, event.amount, event.revolutions, rpm[min(event.row, len(rpm) - 1)], 1)
    return found


def extents(operation: Operation) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
    """Return the lowest and the highest coordinates of points, arcs and holes, in those of the operation; None without
    any.
    """
    if not len(operation.moves):
        return None
    try:
        _, ends = hole_ends(normalize_cycles(operation))
    except HoleCycleError:
        ends = np.zeros((2, 0, 3))
    tip = np.concatenate((operation.moves.tip, *ends))
    reach = tip_reach(operation_arcs(operation))
    a, b, c = np.minimum(tip.min(axis=0), reach.low.min(axis=0, initial=np.inf)).tolist()
    d, e, f = np.maximum(tip.max(axis=0), reach.high.max(axis=0, initial=-np.inf)).tolist()
    return (a, b, c), (d, e, f)


def _lengths(operation: Operation, before: Floats | None) -> Floats:
    """(n,) float64: how far the tip moves to each row; 0 to the first one if nobody knows where from."""
    tip, arcs = operation.moves.tip, operation.arcs
    start = np.concatenate((tip[:1] if before is None else np.asarray(before)[None], tip[:-1]))
    length = np.linalg.norm(tip - start, axis=1)
    if len(arcs.row):
        length[arcs.row] = arc_lengths(arcs, start[arcs.row], tip[arcs.row])
    return np.asarray(length)


def _speeds(operation: Operation, spindle: SpindleState | None) -> Floats:
    """(n,) float64: rev/min at each row, 0 while the spindle stands."""
    rpm = np.full(len(operation.moves), 0.0 if spindle is None else spindle.rpm)
    for event in operation.events:
        if isinstance(event, SpindleOn | SpindleOff):
            rpm[event.row :] = event.rpm if isinstance(event, SpindleOn) else 0.0
    return rpm


def _add_holes(found: Measures, operation: Operation, holes: Flags, rpm: Floats) -> None:
    """Add what the cycles of an operation do at their holes."""
    changes: list[Event] = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [event.row for event in changes[1:]] + [len(holes)]
    for event, end in zip(changes, ends, strict=False):
        rows = np.flatnonzero(holes[event.row : end]) + event.row
        if not isinstance(event, CycleOn) or not len(rows):
            continue
        try:
            cycle = cycle_from_event(event)
        except HoleCycleError:
            found.moves_without_time += len(rows)
            continue
        row = int(rows[0])
        modal, per_rev = float(operation.moves.feed[row]), bool(operation.moves.per_rev[row])
        feed, per_rev = cycle_feed(cycle, None, modal, per_rev)
        (found.feed_per_rev if per_rev else found.feed).add(feed)
        way = (cycle.rapid_height + cycle.depth) * (2.0 if cycle.method in _OUT_AT_FEED else 1.0)
        per_minute = feed * float(rpm[row]) if per_rev else feed
        found.cutting_length += way * len(rows)
        if per_minute > 0.0:
            _add_time(found, 60.0 * way / per_minute, len(rows))
            _add_dwell(found, cycle.dwell, cycle.dwell_in_revolutions, float(rpm[row]), len(rows))
        else:
            found.moves_without_time += len(rows)


def _add_dwell(found: Measures, amount: float, in_revolutions: bool, rpm: float, times: int) -> None:
    """Add a dwell; one in revolutions of a spindle that stands takes no time that is known."""
    if not in_revolutions or rpm > 0.0:
        _add_time(found, 60.0 * amount / rpm if in_revolutions else amount, times)
    elif amount:
        found.moves_without_time += times


def _add_time(found: Measures, seconds: float, times: int) -> None:
    """Add a time so many times; one that nobody waits for is a mistake in the file, and not known."""
    if 0.0 <= seconds <= _LONGEST_TIME:
        found.cutting_seconds += seconds * times
    else:
        found.moves_without_time += times
