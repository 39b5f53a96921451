"""Hole-making cycles of a CL file: which rows are holes, and what each cycle asks for.

In:     an operation with its events ``CycleOn`` and ``CycleOff``.
Out:    the same operation with every row under a cycle a hole to which the tool goes at rapid, heights resolved;
        and, where the tool axis changes between holes, one operation for each axis.

Heights are distances along the tool axis from the point of the hole, mm, up is positive. docs/cl.md says what each
word means.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.toolpath import Arcs, CycleOff, CycleOn, Event, Kind, Operation, Sense, SpindleOff, SpindleOn


class HoleMethod(StrEnum):
    """How a hole is made."""

    DRILL = "DRILL"
    DEEP_DRILLING = "DRILL,DEEP"
    CHIP_BREAKING = "DRILL,BRKCHP"
    TAP = "TAP"
    FLOATING_TAP = "TAP,OPTION"
    DEEP_TAP = "TAP,DEEP"
    CHIP_BREAKING_TAP = "TAP,BRKCHP"
    REAM = "REAM"
    BORE = "BORE,DRAG"
    BORE_WITH_LIFT = "BORE,NODRAG"
    BORE_MANUAL = "BORE,MANUAL"


_METHODS = {
    ("DRILL",): HoleMethod.DRILL,
    ("FACE",): HoleMethod.DRILL,
    ("DRILL", "FACE"): HoleMethod.DRILL,
    ("DRILL", "CSINK"): HoleMethod.DRILL,
    ("CSINK",): HoleMethod.DRILL,
    ("DRILL", "DEEP"): HoleMethod.DEEP_DRILLING,
    ("DRILL", "BRKCHP"): HoleMethod.CHIP_BREAKING,
    ("TAP",): HoleMethod.TAP,
    ("TAP", "DEEP"): HoleMethod.DEEP_TAP,
    ("TAP", "BRKCHP"): HoleMethod.CHIP_BREAKING_TAP,
    ("BORE",): HoleMethod.REAM,
    ("REAM",): HoleMethod.REAM,
    ("BORE", "DRAG"): HoleMethod.BORE,
    ("BORE", "NODRAG"): HoleMethod.BORE_WITH_LIFT,
    ("BORE", "MANUAL"): HoleMethod.BORE_MANUAL,
}


#: Those that say the length of a stroke.
_IN_STROKES = (HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING, HoleMethod.DEEP_TAP, HoleMethod.CHIP_BREAKING_TAP)

#: Threads.
_TAPS = (HoleMethod.TAP, HoleMethod.FLOATING_TAP, HoleMethod.DEEP_TAP, HoleMethod.CHIP_BREAKING_TAP)

#: No length, feed or angle of a cycle is so large.
_FARTHEST = 1e6


class HoleCycleError(Exception):
    """Why a cycle cannot be made: what, and what would put it right. ``line``: where, if that is known."""

    def __init__(self, what: str, cure: str, line: int = 0) -> None:
        super().__init__(what)
        self.what, self.cure, self.line = what, cure, line


class UnsupportedCycleError(HoleCycleError):
    """A control has no words for a cycle that says all that it must; motion may make its holes."""


@dataclass(frozen=True, slots=True)
class Cycle:
    """What a cycle asks for at each hole.

    rapid_height    height to which the tool goes at rapid
    depth    how far below the point it drills
    retract  height to which it is drawn back, no lower than ``rapid_height``; None: as high as it was before the first
    hole steps    strokes: the first, how much each next is shorter, the shortest
    dwell    seconds at the bottom, or spindle turns
    feed     mm/min, or mm/rev; None: the modal one
    angle    of the spindle for BORE,NODRAG, degrees
    """

    method: HoleMethod
    rapid_height: float
    depth: float
    retract_height: float | None
    strokes: tuple[float, float, float]
    dwell: float
    dwell_in_revolutions: bool
    feed: float | None
    per_rev: bool
    spindle_angle: float


def cycle_from_event(event: CycleOn) -> Cycle:
    """What a CYCLE statement asks for.

    Raises
    ------
    HoleCycleError
        When it asks for what is not known, or leaves out what must be said.
    """
    values, words = dict(event.values), dict(event.words)
    if any(not abs(number) < _FARTHEST for given in values.values() for number in given):
        raise HoleCycleError(
            "CYCLE with a number that no machine has", "write lengths in mm or inches, feeds per minute"
        )
    method = _METHODS.get(event.mode)
    if event.mode == ("BORE", "BACK"):
        what = "CYCLE/BORE,BACK does not say how far the tool must move off its axis to pass the hole, nor where to"
        raise HoleCycleError(what, "output the holes as motion")
    if method is None:
        what = f"CYCLE/{','.join(event.mode)} is a cycle that cannot be written"
        raise HoleCycleError(what, "output the holes as motion")
    if method is HoleMethod.TAP and "OPTION" in words:
        method = HoleMethod.FLOATING_TAP
    if method in (HoleMethod.DEEP_TAP, HoleMethod.CHIP_BREAKING_TAP) and "OPTION" in words:
        raise HoleCycleError(
            f"CYCLE/{method} with OPTION, a compensating chuck", "leave OPTION out, or tap in one stroke"
        )
    above = _one(values, "RAPTO", _one(values, "CLEAR", math.nan))
    if not above >= 0.0:
        raise HoleCycleError("CYCLE without RAPTO, or with one below the hole", "write RAPTO,distance above the point")
    steps = (*values.get("STEP", ()), 0.0, 0.0, 0.0)[:3]
    if method in _IN_STROKES and not steps[0] > 0.0:
        raise HoleCycleError(f"CYCLE/{method} without STEP", "write STEP,first stroke")
    if words.get("RTRCTO") == "MANUAL":
        raise HoleCycleError("RTRCTO,MANUAL does not say how far", "write RTRCTO,distance or RTRCTO,AUTO")
    retract = None if words.get("RTRCTO") == "AUTO" else max(_one(values, "RTRCTO", above), above)
    per_rev = "MMPR" in values
    return Cycle(
        method=method,
        rapid_height=above,
        depth=_depth(event.mode, values),
        retract_height=retract,
        strokes=(steps[0], steps[1], steps[2]),
        dwell=_one(values, "DWELL", 0.0),
        dwell_in_revolutions=words.get("DWELL") == "REV",
        feed=_one(values, "MMPR" if per_rev else "MMPM", math.nan) if per_rev or "MMPM" in values else None,
        per_rev=per_rev,
        spindle_angle=_one(values, "NODRAG", 0.0),
    )


def _one(values: dict[str, tuple[float, ...]], word: str, default: float) -> float:
    given = values.get(word)
    return given[0] if given else default


def _depth(mode: Sequence[str], values: dict[str, tuple[float, ...]]) -> float:
    """FEDTO whatever its sign; of a countersink what its diameter and angle come to."""
    given = abs(_one(values, "FEDTO", 0.0))
    if "CSINK" in mode and "CSKDIA" in values:
        angle = _one(values, "TLANGL", 0.0)
        if not 0.0 < angle < 180.0:
            raise HoleCycleError("CYCLE/DRILL,CSINK without the angle of the tool", "write TLANGL,angle")
        depth = 0.5 * values["CSKDIA"][0] / math.tan(math.radians(0.5 * angle))
        if given and abs(given - depth) > 0.01:
            what = f"CYCLE/DRILL,CSINK asks for {given:g} mm by FEDTO and for {depth:.4f} mm by CSKDIA and TLANGL"
            raise HoleCycleError(what, "leave one of them out")
        given = depth
    if not given > 0.0:
        raise HoleCycleError("CYCLE without a depth", "write FEDTO,depth")
    return given


def hole_rows(operation: Operation) -> Flags:
    """(n,) bool: the row is a hole, for it stands under a cycle and is no rapid."""
    under = np.zeros(len(operation.moves), bool)
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff):
            under[event.row :] = isinstance(event, CycleOn)
    return np.asarray(under & (operation.moves.kind != Kind.RAPID))


def normalize_cycles(operation: Operation) -> Operation:
    """The operation with its cycles around holes only, the way to each of them a rapid, and RTRCTO,AUTO as a number.

    Raises
    ------
    HoleCycleError
        When AUTO means the height before the cycle, and there is no point before it.
    """
    if not any(isinstance(event, CycleOn) for event in operation.events):
        return operation
    holes, moves = hole_rows(operation), operation.moves
    events: list[Event] = []
    cycle: CycleOn | None = None
    edges = np.flatnonzero(np.diff(holes, prepend=False, append=False)).tolist()
    for row in sorted({*edges, *(event.row for event in operation.events)}):
        here = [event for event in operation.events if event.row == row]
        hole = row < len(moves) and bool(holes[row])
        changed = any(isinstance(event, CycleOn | CycleOff) for event in here)
        if cycle is not None and (changed or not hole):
            events.append(CycleOff(row, cycle.line))
            cycle = None
        events += [event for event in here if not isinstance(event, CycleOn | CycleOff)]
        if hole and cycle is None:
            cycle = replace(_resolved(operation, _under(operation, row)), row=row)
            events.append(cycle)
    kind = np.where(holes, np.uint8(Kind.RAPID), moves.kind)
    return replace(operation, moves=replace(moves, kind=kind), events=tuple(events))


def cycle_row_ranges(operation: Operation) -> Iterator[tuple[CycleOn, int]]:
    """The cycles of an operation as ``normalize_cycles`` leaves it, each with the row after its last hole."""
    begun: CycleOn | None = None
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff) and begun is not None:
            yield begun, event.row
        if isinstance(event, CycleOn | CycleOff):
            begun = event if isinstance(event, CycleOn) else None


def _under(operation: Operation, row: int) -> CycleOn:
    """The cycle that holds at a row which is a hole."""
    return next(e for e in reversed(operation.events) if isinstance(e, CycleOn) and e.row <= row)


def _resolved(operation: Operation, event: CycleOn) -> CycleOn:
    """RTRCTO,AUTO as a distance: that of the point before the cycle from its first hole, along the tool axis."""
    words = dict(event.words)
    if words.get("RTRCTO") != "AUTO":
        return event
    moves = operation.moves
    if event.row == 0:
        cure = "put a point before the cycle, or write RTRCTO,distance"
        raise HoleCycleError("RTRCTO,AUTO before any point", cure, event.line)
    height = float((moves.tip[event.row - 1] - moves.tip[event.row]) @ moves.axis[event.row])
    words.pop("RTRCTO")
    return replace(event, values=(*event.values, ("RTRCTO", (height,))), words=tuple(words.items()))


@dataclass(frozen=True, slots=True)
class SpindleState:
    """The spindle at a hole."""

    rpm: float
    sense: Sense


def spindle_state_at(events: Sequence[Event], row: int, before: SpindleState | None) -> SpindleState | None:
    """The spindle at a row of an operation; ``before``: at its beginning. None: it stands still."""
    for event in events:
        if event.row > row:
            break
        if isinstance(event, SpindleOn):
            before = SpindleState(event.rpm, event.sense)
        elif isinstance(event, SpindleOff):
            before = None
    return before


def split_by_axis(operation: Operation) -> list[tuple[int, int]] | None:
    """Rows from, to, for each stretch of one tool axis of an operation with holes.

    None if it has none, or if it cannot be parted there: for arcs, or because the axis changes in a cut.
    """
    if not any(isinstance(event, CycleOn) for event in operation.events) or len(operation.arcs.row):
        return None
    turns = axis_change_rows(operation)
    if (operation.moves.kind[turns] != Kind.RAPID).any():
        return None
    return row_ranges(turns, len(operation.moves))


def axis_change_rows(operation: Operation) -> Ints:
    """The rows under another tool axis than the row before them."""
    return np.flatnonzero(np.abs(np.diff(operation.moves.axis, axis=0)).max(axis=1, initial=0.0) > 1e-7) + 1


def row_ranges(starts: Ints, count: int) -> list[tuple[int, int]]:
    """Rows from, to, for each part of ``count`` rows of which all but the first begin at ``starts``."""
    return list(pairwise([0, *starts.tolist(), count]))


def extract_rows(operation: Operation, first: int, end: int) -> Operation:
    """Rows ``first`` to ``end`` of an operation, with the cycle that holds where they begin. No arc leads there."""
    moves, arcs = operation.moves, operation.arcs
    cut = moves.select(slice(first, end))
    last = end == len(moves)
    inside = [e for e in operation.events if first <= e.row < end or (last and e.row == end)]
    held = [e for e in operation.events if isinstance(e, CycleOn | CycleOff) and e.row < first]
    events = [replace(event, row=event.row - first) for event in inside]
    if held and isinstance(held[-1], CycleOn) and not any(isinstance(e, CycleOff) and e.row == 0 for e in events):
        events.insert(0, replace(held[-1], row=0))
    here = (arcs.row >= first) & (arcs.row < end)
    kept = Arcs(arcs.row[here] - first, arcs.centre[here], arcs.normal[here], arcs.radius[here], arcs.full_turns[here])
    return replace(operation, moves=cut, arcs=kept, events=tuple(events))


def cycle_feed(cycle: Cycle, spindle: SpindleState | None, modal: float, modal_per_rev: bool) -> tuple[float, bool]:
    """The feed that is in force in the cycle, and whether it is per turn: the cycle's own, or the modal one."""
    if cycle.feed is None:
        return modal, modal_per_rev
    if cycle.method in _TAPS and cycle.per_rev and spindle is not None:
        return cycle.feed * spindle.rpm, False
    return cycle.feed, cycle.per_rev
