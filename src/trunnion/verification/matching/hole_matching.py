"""Which motions of a run drill which hole.

In:     a run whose control has expanded its cycles into motions, and the holes that the CL file asks for.
Out:    the rows that drill each hole, be they those of a cycle or motions of the program itself.

The rows of a cycle are recognized because no block programs them. Where there are fewer cycles than holes, motions are
searched for the others: a hole is drilled by a line that goes down along its axis to below RAPTO. Lines that the CL
file itself has there are counted first, and skipped.
"""

from collections.abc import Iterator, Sequence
from weakref import WeakKeyDictionary

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.expected.holes import Hole
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.positioning_moves import tool_axis_exit_rows

#: A motion is along the tool axis when it is off by less than this, mm.
_STRAIGHT = 1e-6

#: Rows that are searched at a time: at first, and at most.
_FEW, _MANY = 64, 8192

#: After so many holes that nothing drills, the program is taken to be for another part.
_MAX_MISSES = 8


@dataclass(frozen=True, slots=True, eq=False)
class MatchedHole:
    """Rows ``first`` to ``end`` (exclusive) that drill one hole; the first row goes to it.

    index              which of the holes, in their order
    by_motion          the rows are motions of the program itself, not of a cycle
    shares_first_row   the first row also goes to a CL point, or is the last one of the hole before
    shares_last_row    the last row also goes to a CL point
    """

    first: int
    end: int
    index: int
    by_motion: bool = False
    shares_first_row: bool = False
    shares_last_row: bool = False

    @property
    def rows(self) -> Ints:
        """The rows that do nothing but drill this hole."""
        return np.arange(self.first + self.shares_first_row, self.end - self.shares_last_row)


#: What has been found, as the matching and several checks ask for it; kept as long as the run and what is expected.
_matched: WeakKeyDictionary[Run, WeakKeyDictionary[ExpectedPath, tuple[MatchedHole, ...]]] = WeakKeyDictionary()


def match_holes(run: Run, expected: ExpectedPath | None = None) -> Sequence[MatchedHole]:
    """Return the motions of a run that drill holes, hole by hole, in the order of the run.

    A thread that has a block of its own includes the rapid to it and, where the CL file asks for that, the rapid
    straight up after it.
    """
    if expected is None:
        return _search_holes(run, None)
    known = _matched.setdefault(run, WeakKeyDictionary())
    found = known.get(expected)
    if found is None:
        found = known[expected] = tuple(_search_holes(run, expected))
    return found


def _search_holes(run: Run, expected: ExpectedPath | None) -> list[MatchedHole]:
    holes = () if expected is None else expected.holes
    rows = np.flatnonzero((run.programmed == 0) & (run.kind != Kind.ARC))
    cycles = np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1) if len(rows) else []
    if expected is None or len(cycles) >= len(holes):
        return [_cycle_hole(run, expected, cycle, k) for k, cycle in enumerate(cycles)]
    return list(_match_in_order(run, expected, cycles))


def hole_rows(holes: Sequence[MatchedHole]) -> Ints:
    """All rows that do nothing but drill holes, increasing."""
    return np.concatenate([np.zeros(0, np.int64), *(hole.rows for hole in holes)])


def _cycle_hole(run: Run, expected: ExpectedPath | None, rows: Ints, index: int) -> MatchedHole:
    """One hole of a cycle, whose rows without a block these are."""
    first, end = int(rows[0]), int(rows[-1]) + 1
    hole = None if expected is None or index >= len(expected.holes) else expected.holes[index]
    to = first - 1 if first and run.lines[first - 1] == run.lines[first] else first
    if to == first and first and run.kind[first - 1] == Kind.RAPID:
        if run.kind[first] != Kind.RAPID:
            to -= 1
            back = hole is not None and hole.cycle.retract > hole.cycle.clearance + 1e-9
            end += back and end < len(run) and run.kind[end] == Kind.RAPID and _rise(run, end) > 0.0
        elif expected is not None and hole is not None:
            to -= _only_goes_to_hole(run, expected, index, first - 1)
    return MatchedHole(to, end, index)


def _only_goes_to_hole(run: Run, expected: ExpectedPath, index: int, row: int) -> bool:
    """Whether the row before a cycle, in a block of its own, goes above the hole and to no CL point."""
    hole = expected.holes[index]
    height, aside = hole.heights_and_offsets(run.positions(np.array([row])).tip)
    above = bool(aside[0] <= hole.tolerance and height[0] >= hole.cycle.clearance - hole.tolerance)
    return above and not (
        _is_behind_point(expected, index) and _goes_to_cl_point(run, expected, hole.row - 1, row, -1, hole)
    )


def _is_behind_point(expected: ExpectedPath, index: int) -> bool:
    """Whether a CL point of the same operation stands before a hole, and no other hole between."""
    hole, before = expected.holes[index], expected.holes[max(index - 1, 0) : index]
    return hole.row not in expected.first_rows and all(other.row != hole.row for other in before)


def _rise(run: Run, row: int) -> float:
    """How far a row goes along the tool axis, mm, if it goes nowhere else; else 0."""
    positions = run.positions(np.array([row - 1, row]))
    step = positions.tip[1] - positions.tip[0]
    rise = float(step @ positions.axis[1])
    return rise if float(np.linalg.norm(step - rise * positions.axis[1])) < _STRAIGHT else 0.0


def _match_in_order(run: Run, expected: ExpectedPath, cycles: Sequence[Ints]) -> Iterator[MatchedHole]:
    """Hole by hole: by motions before the next cycle if there are any, else by that cycle."""
    at, used, misses, leaving = 0, 0, 0, _leaving_rows(run)
    before: Hole | None = None
    for index, hole in enumerate(expected.holes):
        limit = int(cycles[used][0]) if used < len(cycles) else len(run)
        found = None
        if misses < _MAX_MISSES:
            row = _find_plunge(run, hole, at, limit, _count_cl_plunges(expected, before, hole))
            found = None if row is None else _motion_hole(run, expected, index, row, at, leaving)
        if found is None and used < len(cycles):
            found = _cycle_hole(run, expected, cycles[used], index)
            used += 1
        if found is None:
            misses += 1
        else:
            yield found
            at = found.end
        before = hole
    for rows in cycles[used:]:
        yield _cycle_hole(run, expected, rows, len(expected.holes))


def _plunges(hole: Hole, tip: Floats, kind: Codes) -> Flags:
    """Which moves drill the hole, (k - 1,) bool: lines along its axis down to below RAPTO.

    ``tip`` (k, 3) and ``kind`` (k,) are of k moves; the first one is only where the second starts.
    """
    height, aside = hole.heights_and_offsets(tip)
    on_axis = aside <= hole.tolerance
    down = (kind[1:] == Kind.LINEAR) & (height[1:] < height[:-1]) & (height[1:] < hole.cycle.clearance - hole.tolerance)
    return np.asarray(on_axis[1:] & on_axis[:-1] & down)


def _count_cl_plunges(expected: ExpectedPath, before: Hole | None, hole: Hole) -> int:
    """How often the CL file itself plunges on the axis of a hole, after the hole before it."""
    first, count = 0 if before is None else before.row, 0
    for start in range(first, hole.row, _MANY):
        end = min(start + _MANY, hole.row)
        rows = np.arange(max(start - 1, 0), end)
        tip, kind = expected.tip(rows), expected.kind(rows).copy()
        if before is not None and start == first and first:
            tip = tip.copy()
            tip[0] = before.exit_tip
        kind[np.isin(rows, expected.first_rows)] = Kind.RAPID  # operations start from home
        count += int(_plunges(hole, tip, kind).sum())
    return count


def _find_plunge(run: Run, hole: Hole, at: int, limit: int, skipped: int) -> int | None:
    """Return the first row from ``at`` to ``limit`` that drills a hole, after ``skipped`` other plunges there."""
    start, size = max(at, 1), _FEW
    while start < limit:
        end = min(start + size, limit)
        rows = np.arange(start - 1, end)
        found = np.flatnonzero(_plunges(hole, run.positions(rows).tip, run.kind[rows]))
        if len(found) > skipped:
            return start + int(found[skipped])
        skipped -= len(found)
        start, size = end, min(2 * size, _MANY)
    return None


def _motion_hole(run: Run, expected: ExpectedPath, index: int, plunge: int, at: int, leaving: set[int]) -> MatchedHole:
    """Return the hole that row ``plunge`` begins to drill; rows before ``at`` belong to holes before it.

    leaving  as ``_leaving_rows`` returns them
    """
    hole = expected.holes[index]
    end = _end_of_hole(run, hole, plunge)
    first, after = plunge - 1, expected.holes[index + 1 : index + 2]
    shares_first = first < at or (
        _is_behind_point(expected, index) and _goes_to_cl_point(run, expected, hole.row - 1, first, -1, hole)
    )
    point_after = all(other.row != hole.row for other in after) and end not in leaving
    shares_last = point_after and _goes_to_cl_point(run, expected, hole.row, end - 1, 1, hole)
    return MatchedHole(first, end, index, True, shares_first, shares_last)


def _leaving_rows(run: Run) -> set[int]:
    """Rows at which the tool goes home or is changed: it comes to the next CL point by another motion.

    That point may be where the tool left a hole, as the first one of the next operation at the same hole.
    """
    said = {event.before_row for event in run.events if event.kind in ("tool_change", "retract")}
    return said.union(run.state.machine_frame.rows_changing_to(True), tool_axis_exit_rows(run).tolist())


def _goes_to_cl_point(run: Run, expected: ExpectedPath, cl: int, row: int, neighbour: int, hole: Hole) -> bool:
    """Whether a row goes to a CL point, and its neighbour (-1 before, 1 after) does not."""
    if not 0 <= cl < len(expected):
        return False
    tip = expected.point(cl).tip
    rows = sorted(k for k in (row, row + neighbour) if 0 <= k < len(run))
    fits = np.abs(run.positions(np.array(rows)).tip - tip).max(axis=1) <= 2.0 * hole.tolerance
    by_row = dict(zip(rows, fits.tolist(), strict=True))
    return bool(by_row.get(row)) and not by_row.get(row + neighbour, False)


def _end_of_hole(run: Run, hole: Hole, plunge: int) -> int:
    """Return the row after the last one of a hole: after its depth the tool retracts, and then goes elsewhere."""
    start, size, at_depth = plunge, _FEW, False
    while True:
        rows = np.arange(start, min(start + size + 1, len(run)))
        height, aside = hole.heights_and_offsets(run.positions(rows).tip)
        inside = (aside <= hole.tolerance) & ~run.state.machine_frame.at(rows)
        for k in range(len(rows) - 1):
            at_depth = at_depth or bool(height[k] <= hole.tolerance - hole.cycle.depth)
            out = bool(height[k] >= hole.cycle.retract - hole.tolerance)
            goes_in_again = bool(height[k + 1] < hole.cycle.clearance - hole.tolerance)
            if not inside[k + 1] or (out and (at_depth or not goes_in_again)):
                return int(rows[k]) + 1
        if rows[-1] + 1 >= len(run):
            return len(run)
        start, size = int(rows[-1]), min(2 * size, _MANY)
