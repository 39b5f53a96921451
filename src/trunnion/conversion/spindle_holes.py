"""Holes whose cycles drive the spindle, as CYCLE statements: motions alone do not make them.

In:     the rows of an operation, and what the reader recorded of such holes (``Run.spindle_holes``).
Out:    rows with one for each hole, the points of the holes, and the events that begin and end their cycles.

A thread keeps its pitch, its hand and its strokes. A bore at whose bottom the spindle stops stays one. Where the
spindle stops at an angle or the operator takes the tool out, nothing says which way: such holes are refused.
"""

import math
from collections.abc import Sequence
from dataclasses import field

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.conversion.program_events import ProgramEvent
from trunnion.conversion.unsupported import ON_AXIS, Warnings
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.spindle_work import SpindleHole, SpindleTask
from trunnion.model.toolpath import CycleOff, CycleOn, Event, Kind, Sense, SpindleOff, SpindleOn
from trunnion.records import dataclass

_REFUSED = {
    SpindleTask.LIFT: "stops the spindle at an angle and moves the tool off the wall",
    SpindleTask.MANUAL: "stops the program at the bottom, and the operator takes the tool out",
}


@dataclass(frozen=True, slots=True, eq=False)
class HoleRows:
    """The rows of an operation with one row for each hole of a cycle.

    rows     (k,) rows of the run
    points   index into ``rows`` -> (3,) tip of the hole's point, mm
    before   cycle ends and spindle states that come before the other events of their row
    after    spindle states and cycle starts that come after them
    dwells   rows of the run before which a cycle dwells; they are values of the cycle
    """

    rows: Ints
    points: dict[int, Floats] = field(default_factory=dict)
    before: list[Event] = field(default_factory=list)
    after: list[Event] = field(default_factory=list)
    dwells: frozenset[int] = frozenset()

    def tips(self, tips: Floats) -> Floats:
        """Return the ``tips`` (k, 3) with the points of the holes."""
        found = tips.copy()
        for index, point in self.points.items():
            found[index] = point
        return found

    def without_own_events(self, events: Sequence[ProgramEvent], rigid_tap: str) -> list[ProgramEvent]:
        """Return the program events without the dwells of cycles, and without the word that makes taps rigid (M29)."""
        coupling = rigid_tap.removeprefix("M") if self.points else ""
        return [
            event
            for event in events
            if not (event.kind == "dwell" and event.row in self.dwells)
            and not (event.kind == "m" and coupling and f"{event.value:g}" == coupling)
        ]

    def with_cycles(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        """Return the events of an operation with those of the cycles."""
        return tuple(sorted([*self.before, *events, *self.after], key=lambda event: event.row))


@dataclass(frozen=True, slots=True, eq=False)
class _Made:
    """One hole: its cycle, its point, the rows it replaces, and the row that stays for it.

    spindle   what the cycle needs: rev/min, and 1 clockwise, -1 counter-clockwise
    """

    hole: SpindleHole
    cycle: CycleOn
    point: Floats
    first: int
    row: int
    spindle: tuple[float, int]


def read_spindle_holes(run: Run, rows: Ints, events: Sequence[ProgramEvent], warn: Warnings) -> HoleRows:
    """Return the holes of an operation with the ``rows`` (n,) and the program events ``events``."""
    inside = [hole for hole in run.spindle_holes if len(rows) and rows[0] <= hole.first and hole.end - 1 <= rows[-1]]
    made = [one for one in (_made(run, rows, hole, events, warn) for hole in inside) if one is not None]
    if not made:
        return HoleRows(rows)
    removed = np.zeros(len(rows), np.bool_)
    for one in made:
        removed |= (rows >= one.first) & (rows < one.hole.end) & (rows != one.row)
    kept = rows[~removed]
    found = HoleRows(kept, dwells=frozenset(row for one in made for row in range(one.hole.first + 1, one.hole.end + 1)))
    _add_events(run, kept, made, found)
    return found


def _add_events(run: Run, kept: Ints, made: Sequence[_Made], found: HoleRows) -> None:
    """Add points and cycles; holes in a row with the same cycle share it."""
    before: _Made | None = None
    for one, following in zip(made, [*made[1:], None], strict=True):
        index = int(np.searchsorted(kept, one.row))
        found.points[index] = one.point
        actual = _spindle(run, one.row)
        if before is None:
            if one.spindle != actual:
                found.after.append(_spindle_event(index, one.hole.line, one.spindle))
            found.after.append(CycleOn(index, one.hole.line, one.cycle.mode, one.cycle.values, one.cycle.words))
        follows = following is not None and kept[index + 1 : index + 2].tolist() == [following.row]
        if follows and following is not None and _alike(one, following) and _spindle(run, following.row) == actual:
            before = one
            continue
        before = None
        found.before.append(CycleOff(index + 1, one.hole.line))
        if one.spindle != actual:
            found.before.append(_spindle_event(index + 1, one.hole.line, actual))


def _alike(one: _Made, other: _Made) -> bool:
    return (one.cycle.mode, one.cycle.values, one.cycle.words, one.spindle) == (
        other.cycle.mode,
        other.cycle.values,
        other.cycle.words,
        other.spindle,
    )


def _spindle(run: Run, row: int) -> tuple[float, int]:
    """Speed and sense of the spindle at a row, as the program has it."""
    return float(run.rpm[row]), int(run.spindle[row])


def _spindle_event(row: int, line: int, spindle: tuple[float, int]) -> Event:
    rpm, sense = spindle
    return SpindleOn(row, line, rpm, Sense.CLW if sense > 0 else Sense.CCLW) if sense else SpindleOff(row, line)


def _made(run: Run, rows: Ints, hole: SpindleHole, events: Sequence[ProgramEvent], warn: Warnings) -> _Made | None:
    """One hole as a cycle; None, with an error, if it cannot be one."""
    work = hole.work
    if work.task in _REFUSED:
        warn.refuse(hole.line, Wording("CNV176", "cycle_toolpath_does", refused=_REFUSED[work.task]), hole.file)
        return None
    motions = np.arange(hole.first, hole.end)
    lines = motions[run.kind[motions] != Kind.RAPID]
    if not len(lines) or lines[0] - 1 < rows[0]:
        warn.refuse(hole.line, Wording("CNV176", "cycle_does_not"), hole.file)
        return None
    start, axis = run.tip[lines[0] - 1], run.axis[lines[0]]
    offset = run.tip[motions] - start
    height = offset @ axis
    aside = float(np.linalg.norm(offset[motions >= lines[0]] - height[motions >= lines[0], None] * axis, axis=1).max())
    depth = -float(height.min())
    if aside > ON_AXIS or not depth > work.clearance:
        warn.refuse(hole.line, Wording("CNV176", "cycle_does_not"), hole.file)
        return None
    rpm, sense = _spindle(run, int(lines[0]))
    spindle = work.rpm or rpm, work.hand or sense
    if not (spindle[0] > 0.0 and spindle[1]):
        warn.refuse(hole.line, Wording("CNV176", "thread_bore_while"), hole.file)
        return None
    bottom = int(motions[np.argmin(height)])
    heights = work.clearance, depth - work.clearance, max(float(height[-1]), 0.0) + work.clearance
    values = _values(run, hole, int(lines[0]), bottom, heights, events)
    if len({float(feed) for feed in run.feed[lines]}) > 1 and not work.stroke:
        warn(hole.line, Wording("CNV180", "tool_leaves_thread"), hole.file)
    cycle = CycleOn(0, hole.line, _mode(hole), tuple(values), (("OPTION", ""),) if work.floating else ())
    if any(word == "DWELL,REV" for word, _ in values):
        cycle = CycleOn(0, hole.line, _mode(hole), _with_revolutions(values), (*cycle.words, ("DWELL", "REV")))
    first = hole.first - 1 if _leads_level(run, rows, hole.first - 1) else hole.first
    point = np.asarray(start - work.clearance * axis)
    return _Made(hole, cycle, np.round(point, 9) + 0.0, first, int(lines[0]), spindle)


def _mode(hole: SpindleHole) -> tuple[str, ...]:
    work = hole.work
    if work.task is SpindleTask.TAP and work.stroke:
        return ("TAP", "DEEP" if work.full else "BRKCHP")
    return tuple(work.task.value.split(","))


def _values(
    run: Run,
    hole: SpindleHole,
    line_row: int,
    bottom: int,
    heights: tuple[float, float, float],
    events: Sequence[ProgramEvent],
) -> list[tuple[str, tuple[float, ...]]]:
    """Return the couplets of a cycle; ``heights``: RAPTO, FEDTO and RTRCTO, mm."""
    work = hole.work
    clearance, depth, retract = (round(height, 6) for height in heights)
    values: list[tuple[str, tuple[float, ...]]] = [("RAPTO", (clearance,)), ("FEDTO", (-depth,))]
    if retract > clearance:
        values.append(("RTRCTO", (retract,)))
    if math.isfinite(work.pitch):
        values.append(("MMPR", (work.pitch,)))
    else:
        values.append(("MMPR" if run.feed_mode[line_row] == 95 else "MMPM", (float(run.feed[line_row]),)))
    if work.stroke:
        values.append(("STEP", (work.stroke,)))
    dwells = [event.value for event in events if event.kind == "dwell" and event.row == bottom + 1]
    dwell = next((value for value in dwells if isinstance(value, float) and value), 0.0)
    return [*values, ("DWELL" if dwell > 0.0 else "DWELL,REV", (abs(dwell),))] if dwell else values


def _with_revolutions(values: Sequence[tuple[str, tuple[float, ...]]]) -> tuple[tuple[str, tuple[float, ...]], ...]:
    return tuple((word.removesuffix(",REV"), numbers) for word, numbers in values)


def _leads_level(run: Run, rows: Ints, row: int) -> bool:
    """Whether a row leads to a hole at rapid, at the height where the tool is: its cycle does so by itself."""
    if row - 1 < rows[0] or run.kind[row] != Kind.RAPID:
        return False
    step, axis = run.tip[row] - run.tip[row - 1], run.axis[row]
    same_axis = float(np.abs(axis - run.axis[row - 1]).max()) < 1e-9
    return same_axis and abs(float(step @ axis)) < ON_AXIS and row in rows and row - 1 in rows
