"""Which motions of a run make which hole.

In:     a run whose control has expanded its own cycles into motions, and the holes that are wanted.
Out:    the rows that make each hole, be it by a cycle or by motions that the program says itself.

Rows of a cycle are known by themselves: no block writes them. Where there are fewer of them than holes, the others are
looked for: a hole is drilled by a line that goes down along its axis to below RAPTO. Lines that the CL file itself has
there are counted before, and passed over.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.expected.holes import Hole
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.rapid_feeds import POSITION_WORDS, approach_rows

#: A motion is along the tool axis, or across it, when it is off by less than this, mm.
_STRAIGHT = 1e-6

#: With TCP the same comes to this, mm, and this share of the way.
_PLACED, _LEANS = 2e-5, 1e-6

#: Tool axes are the same when no component differs by more than this.
_TURNED = 1e-6

#: Two rounded points are off a direction by so many times what a coordinate may be off.
_BOTH_ENDS = 2.0 * 3.0**0.5

#: Rows looked at at a time: at first, and at most.
_FEW, _MANY = 64, 8192

#: So many holes that nobody makes are looked for: then the program is taken to be another one.
_MISSES = 8


@dataclass(frozen=True, slots=True)
class MatchedHole:
    """Rows ``first`` to ``end`` (left out) that make one hole; the first goes to it.

    hole         which of the holes, in their order
    by_motion    the program says these rows itself
    begins_at    the first row goes to a CL point, or is the last one of the hole before: it is no row of the hole alone
    ends_at      the last row goes to a CL point
    """

    first: int
    end: int
    hole: int
    by_motion: bool = False
    begins_at: bool = False
    ends_at: bool = False

    @property
    def rows(self) -> Ints:
        """The rows that do nothing but make this hole."""
        return np.arange(self.first + self.begins_at, self.end - self.ends_at)


def match_holes(run: Run, expected: ExpectedPath | None = None) -> list[MatchedHole]:
    """The motions of a run that make holes, hole by hole, in the order of the run.

    A thread that is cut by a block of its own has besides the rapid to it and, where the CL file wants that, the rapid
    straight up behind it.
    """
    holes = () if expected is None else expected.holes
    cycle = np.flatnonzero((run.programmed == 0) & (run.kind != Kind.ARC))
    groups = np.split(cycle, np.flatnonzero(np.diff(cycle) != 1) + 1) if len(cycle) else []
    if expected is None or len(groups) >= len(holes):
        return [_by_cycle(run, rows, k, holes[k] if k < len(holes) else None) for k, rows in enumerate(groups)]
    return list(_in_turn(run, expected, groups))


def _by_cycle(run: Run, rows: Ints, number: int, hole: Hole | None) -> MatchedHole:
    """One hole of a cycle, whose unwritten rows these are."""
    first, end = int(rows[0]), int(rows[-1]) + 1
    to = first - 1 if first and run.lines[first - 1] == run.lines[first] else first
    if to == first and first and run.kind[first] != Kind.RAPID and run.kind[first - 1] == Kind.RAPID:
        to -= 1
        back = hole is not None and hole.retract > hole.above + 1e-9
        end += back and end < len(run) and run.kind[end] == Kind.RAPID and _leg(run, end)[1] > 0.0
    return MatchedHole(to, end, number)


def _leg(run: Run, row: int) -> tuple[float, float]:
    """How far a row goes across the tool axis and, if it does so by nothing else, along it, mm."""
    poses = run.positions(np.array([row - 1, row]))
    way = poses.tip[1] - poses.tip[0]
    up = float(way @ poses.axis[1])
    across = float(np.linalg.norm(way - up * poses.axis[1]))
    return across, up if across < _STRAIGHT else 0.0


def _in_turn(run: Run, expected: ExpectedPath, groups: Sequence[Ints]) -> Iterator[MatchedHole]:
    """Hole by hole: by the motions before the next cycle if there are such, else by that cycle."""
    at, cycles, misses = 0, 0, 0
    before: Hole | None = None
    for number, hole in enumerate(expected.holes):
        limit = int(groups[cycles][0]) if cycles < len(groups) else len(run)
        found = None
        if misses < _MISSES:
            row = _plunge(run, hole, at, limit, _own_plunges(expected, before, hole))
            found = None if row is None else _by_motion(run, expected, number, row, at)
        if found is None and cycles < len(groups):
            found = _by_cycle(run, groups[cycles], number, hole)
            cycles += 1
        if found is None:
            misses += 1
        else:
            yield found
            at = found.end
        before = hole
    for rows in groups[cycles:]:
        yield _by_cycle(run, rows, len(expected.holes), None)


def _goes_down(hole: Hole, tip: Floats, kind: Codes) -> Flags:
    """(k - 1,) bool: of places (k, 3), each gone to in a way, those that are drilled to; the first is none.

    They are gone to along the axis of the hole, at a feed, down to below RAPTO.
    """
    height, aside = hole.seen(tip)
    on = aside <= hole.near
    down = (kind[1:] == Kind.LINEAR) & (height[1:] < height[:-1]) & (height[1:] < hole.above - hole.near)
    return np.asarray(on[1:] & on[:-1] & down)


def _own_plunges(expected: ExpectedPath, before: Hole | None, hole: Hole) -> int:
    """How often the CL file itself goes down on the axis of a hole, after the hole before."""
    first, count = 0 if before is None else before.row, 0
    for start in range(first, hole.row, _MANY):
        end = min(start + _MANY, hole.row)
        came = max(start - 1, 0)
        rows = np.arange(came, end)
        tip, kind = expected.tip(rows), expected.kind(rows).copy()
        if before is not None and start == first and first:
            tip = tip.copy()
            tip[0] = before.left
        kind[np.isin(rows, expected.first_rows)] = Kind.RAPID  # gone to from home
        count += int(_goes_down(hole, tip, kind).sum())
    return count


def _plunge(run: Run, hole: Hole, at: int, limit: int, own: int) -> int | None:
    """The first row from ``at`` to ``limit`` that drills a hole, once ``own`` others have gone down there."""
    start, size = max(at, 1), _FEW
    while start < limit:
        end = min(start + size, limit)
        rows = np.arange(start - 1, end)
        found = np.flatnonzero(_goes_down(hole, run.positions(rows).tip, run.kind[rows]))
        if len(found) > own:
            return start + int(found[own])
        own -= len(found)
        start, size = end, min(2 * size, _MANY)
    return None


def _by_motion(run: Run, expected: ExpectedPath, number: int, plunge: int, at: int) -> MatchedHole:
    """The hole that row ``plunge`` begins to drill; rows before ``at`` make holes before it."""
    hole = expected.holes[number]
    end = _end(run, hole, plunge)
    first, before, after = plunge - 1, expected.holes[number - 1 : number], expected.holes[number + 1 : number + 2]
    alone = hole.row not in expected.first_rows and all(other.row != hole.row for other in before)
    begins_at = first < at or (alone and _is_point(run, expected, hole.row - 1, first, -1, hole))
    left = all(other.row != hole.row for other in after)
    return MatchedHole(
        first, end, number, True, begins_at, left and _is_point(run, expected, hole.row, end - 1, 1, hole)
    )


def _is_point(run: Run, expected: ExpectedPath, cl: int, row: int, beside: int, hole: Hole) -> bool:
    """Whether a row goes to a CL point, and no row ``beside`` it does."""
    if not 0 <= cl < len(expected):
        return False
    there = expected.point(cl).tip
    rows = [k for k in (row, row + beside) if 0 <= k < len(run)]
    off = np.abs(run.positions(np.array(sorted(rows))).tip - there).max(axis=1) <= 2.0 * hole.near
    fits = dict(zip(sorted(rows), off.tolist(), strict=True))
    return bool(fits.get(row)) and not fits.get(row + beside, False)


def _end(run: Run, hole: Hole, plunge: int) -> int:
    """The row after the last one of a hole: after depth the tool is drawn back, and then goes elsewhere."""
    start, size, deep = plunge, _FEW, False
    while True:
        rows = np.arange(start, min(start + size + 1, len(run)))
        height, aside = hole.seen(run.positions(rows).tip)
        inside = (aside <= hole.near) & ~run.state.machine_frame.at(rows)
        for k in range(len(rows) - 1):
            deep = deep or bool(height[k] <= hole.near - hole.depth)
            out = bool(height[k] >= hole.retract - hole.near)
            again = bool(height[k + 1] < hole.above - hole.near)
            if not inside[k + 1] or (out and (deep or not again)):
                return int(rows[k]) + 1
        if rows[-1] + 1 >= len(run):
            return len(run)
        start, size = int(rows[-1]), min(2 * size, _MANY)


def clearance_between_holes(run: Run, first: Hole, made: MatchedHole, second: Hole, there: MatchedHole) -> float | None:
    """How high the tip stays on its way from a hole to the next one, whose axis is another, while the tool turns (TCP).

    At each place of the way it is counted from where the cycle of that hole may begin over which the tip is higher; the
    least of these heights, mm. None: the tool does not turn, or not on this way.
    """
    rows = np.arange(made.end, there.first + 1)
    turned = float(np.abs(first.axis - second.axis).max()) > _TURNED
    if not turned or not len(rows) or not run.state.tcp.at(rows).all():
        return None
    tips = run.positions(np.concatenate(([made.end - 1], rows))).tip
    heights = np.stack([(tips - hole.tip) @ hole.axis - hole.above for hole in (first, second)])
    lowest = float(heights.max(axis=0).min())
    apart = heights[0] - heights[1]
    for k in np.flatnonzero(apart[:-1] * apart[1:] < 0.0).tolist():  # as high over both
        part = apart[k] / (apart[k] - apart[k + 1])
        lowest = min(lowest, float(heights[0, k] + part * (heights[0, k + 1] - heights[0, k])))
    return lowest


def hole_rows(made: Sequence[MatchedHole]) -> Ints:
    """All rows that do nothing but make holes, growing."""
    pieces = [hole.rows for hole in made]
    return np.concatenate(pieces) if pieces else np.zeros(0, np.int64)


def hole_approach_rows(run: Run, extra: Sequence[int], made: Sequence[MatchedHole], tip_tolerance: float) -> set[int]:
    """Which of the motions that answer to no CL point only lead to a hole.

    They are rapids right before the motion to the hole: straight up along the tool axis from where the tool was, over
    the hole at that height, and straight down; or, from home or while the tool turns, over the hole itself. Where they
    are not a cycle's, their coordinates may each be off by ``tip_tolerance``, mm.
    """
    approach, unasked = set(approach_rows(run).tolist()), set(extra)
    lawful = set()
    for hole in made:
        if hole.begins_at:
            continue
        row = hole.first - 1
        rounded = _BOTH_ENDS * tip_tolerance if hole.by_motion else 0.0
        while row > 0 and row in unasked and run.kind[row] == Kind.RAPID:
            leg = _leads_how(run, row, hole, approach, rounded)
            if leg:
                lawful.add(row)
            if leg not in ("down", "across", "turned", "nowhere"):
                break
            row -= 1
    return lawful


def _leads_how(run: Run, row: int, hole: MatchedHole, approach: set[int], rounded: float) -> str:
    """How a rapid leads to the hole; empty if it does not. ``rounded``: what directions may be off for that, mm."""
    poses = run.positions(np.array([row - 1, row, hole.first]))
    way, rest, axis = poses.tip[1] - poses.tip[0], poses.tip[2] - poses.tip[1], poses.axis[1]
    up, left = float(way @ axis), float(rest @ axis)
    # With TCP places and axes are rounded each by itself.
    near, part = (_PLACED, _LEANS) if run.state.tcp[row] else (_STRAIGHT, 0.0)
    near, level = max(near, rounded), max(_STRAIGHT, rounded)
    straight = float(np.linalg.norm(way - up * axis)) < near + part * abs(up)
    over = float(np.linalg.norm(rest - left * axis)) < near + part * abs(left) and left < near
    from_home = (
        row - 1 in approach
        or bool(run.state.machine_frame[row - 1])
        or (int(run.programmed[row - 1]) & int(POSITION_WORDS)) == 0
    )
    turned = float(np.abs(poses.axis[0] - axis).max()) > _TURNED
    if float(np.abs(way).max()) < near and not turned:
        return "nowhere"  # where a program goes on in another file, it says again where the tool stands
    if straight and up > 0.0:
        return "up"
    if from_home and (float(np.abs(rest).max()) < level or (hole.by_motion and over)):
        return "from home"
    if straight and over:
        return "down"
    if over and turned:
        return "turned"
    return "across" if over and abs(up) < level else ""
