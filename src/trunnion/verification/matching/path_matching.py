"""Which motion of a program goes to which CL point.

In:     a run, and the expected path.
Out:    a ``Matching``.

Where there are as many motions as points they are paired in order, which is all that most programs need. Otherwise
both sides are followed together; where they differ, the nearest place is searched at which two motions in a row fit
again.
"""

import math

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints, distinct
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.expected.arcs import arc_of, circle_of
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.axis_difference import RotaryGeometry
from trunnion.verification.kinematics.positioning_moves import repeats_position, stands_still
from trunnion.verification.matching.hole_approaches import hole_approach_rows
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.matching.intermediate_points import FollowedPath, FollowLimits, PathPoints, follow_path
from trunnion.verification.matching.pairs import ArcSegments, Matching
from trunnion.verification.matching.resync import find_resync
from trunnion.verification.matching.rewind_retracts import rewind_retract_length
from trunnion.verification.matching.rows_to_match import (
    distinct_cl_rows,
    repeats_exactly,
    repeats_of_another_kind,
    rows_to_match,
)
from trunnion.verification.matching.skipped_rapids import MOST_RAPIDS, rapids_beside_skipped
from trunnion.verification.row_ranges import CHUNK, RowRanges

#: Motions that are compared at first, and after each mismatch.
_FEW = 64

#: How far ahead both sides are searched for a place at which they fit again.
_WINDOWS = (8, 48, 384)

#: How far ahead the end of an arc is searched.
_ARC_WINDOWS = (64, 1024, 16384)

#: Legs of an approach to a hole, and pieces of them, at most.
_MOST_LEGS = 8

#: Circles that make up one of the CL file, at most.
_MAX_PIECES = 1000

#: Cosine between the axes of a circle and of the one that it is a piece of, at least.
_SAME_SENSE = 1.0 - 1e-6

#: Smaller rotary motion, degrees, is none.
_STILL = 1e-9

#: Mismatches that are looked into; beyond them the two sides are taken to be different programs.
_MAX_MISMATCHES = 2000

#: Repeated points that are skipped at most, and the shorter side up to which the best gap is searched.
_MAX_REPEATS = 1000
_MAX_GAP_SEARCH = 1000


def match_by_count(run: Run, expected: ExpectedPath) -> Matching | None:
    """Match in order if there are as many motions as points, else None; whether they fit is not looked at.

    Nor are they matched where a motion that no point asks for only makes up for a repeated point that has none.
    """
    rows = rows_to_match(run, expected)
    if len(rows) == len(expected):
        matching = Matching(rows, RowRanges.from_ranges([(0, len(expected))]))
        by_chance = any(repeats_of_another_kind(run, expected, nc, cl).any() for nc, cl in matching.pair_chunks())
        return None if by_chance else matching
    distinct = distinct_cl_rows(expected)
    return Matching(rows, distinct) if len(rows) == len(distinct) else None


def match_by_position(
    run: Run, expected: ExpectedPath, *, axis_deviation: float | None = None, least_turn: float = 0.0
) -> Matching:
    """Match by position, whatever was dropped, doubled or swapped.

    axis_deviation  how far the tool axis may be off the great circle at intermediate points, degrees; None: there may
                    be no intermediate points
    """
    return _PathMatcher(run, expected, axis_deviation, least_turn).match()


class _PathMatcher:
    """Follows the motions of a program and the points of its CL files together.

    ``i`` counts the motions that take part, ``j`` is a CL row.
    """

    def __init__(self, run: Run, expected: ExpectedPath, axis_deviation: float | None, least_turn: float) -> None:
        self._run, self._expected, self._axis_deviation = run, expected, axis_deviation
        self._least_turn = least_turn
        self._rows = rows_to_match(run, expected)
        self._geometry = RotaryGeometry.of(run.machine)
        holes = match_holes(run, expected)
        before_holes = [hole.first - k for hole in holes for k in range(1, _MOST_LEGS + 1)]
        self._approaches = hole_approach_rows(run, before_holes, holes, expected.max_tip_tolerance)
        all_found = len(holes) == len(expected.holes)
        self._hole_rows = np.array([hole.first for hole in holes] if all_found else [], np.int64)
        self._hole_cl_rows = np.array([hole.row for hole in expected.holes] if all_found else [], np.int64)
        self._approach_rows = np.array(sorted(self._approaches), np.int64)
        limits = [section.tolerances for section in expected.sections]
        self._limits = np.array([(each.tip * 1.001 + 1e-9, np.radians(2.0 * each.angle) + 2e-7) for each in limits])
        self._n, self._m = len(self._rows), len(expected)
        self._mismatches = 0
        self._nc: list[tuple[int, int]] = []
        self._cl: list[tuple[int, int]] = []
        self._missing: list[int] = []
        self._extra: list[int] = []
        self._arc_segments: list[ArcSegments] = []
        self._turn_rows = expected.arcs.row[expected.arcs.full_turns > 0]
        self._intermediate_nc: list[Ints] = [np.zeros(0, np.int64)]
        self._intermediate_cl: list[Ints] = [np.zeros(0, np.int64)]

    def match(self) -> Matching:
        """Both sides to their ends."""
        i = j = 0
        size = _FEW
        while i < self._n and j < self._m:
            turns = self._match_turns(i, j)
            if turns:
                self._pair(i + turns, j, 1)
                i, j = i + turns + 1, j + 1
                continue
            later = int(np.searchsorted(self._turn_rows, j, "right"))
            last = self._turn_rows[later] if later < len(self._turn_rows) else self._m
            count = min(size, self._n - i, int(last) - j)
            fits = self._fits(i, j, count)
            fits &= ~repeats_of_another_kind(self._run, self._expected, *self._pairs(i, j, count))
            same = count if fits.all() else int(np.argmin(fits))
            self._pair(i, j, same)
            i, j = i + same, j + same
            if same == count:
                size = min(2 * size, CHUNK)
                continue
            size = _FEW
            motions, points = self._resolve_mismatch(i, j)
            i, j = i + motions, j + points
        self._extra += self._rows.rows(i, self._n).tolist()
        self._missing += [row for row in range(j, self._m) if not self._repeats(row)]
        return Matching(
            RowRanges.from_ranges(self._nc),
            RowRanges.from_ranges(self._cl),
            tuple(self._missing),
            tuple(self._extra),
            tuple(self._arc_segments),
            (np.concatenate(self._intermediate_nc), np.concatenate(self._intermediate_cl)),
        )

    def _resolve_mismatch(self, i: int, j: int) -> tuple[int, int]:
        """How many motions and points are dealt with where the i-th motion does not go to CL row j."""
        rapids = rapids_beside_skipped(self._run, self._expected, self._rows.rows(i, i + MOST_RAPIDS + 1), j)
        ways = next((k for k in range(1, rapids + 1) if self._fits(i + k, j, 1)[0]), 0)
        if ways:
            self._extra += self._rows.rows(i, i + ways).tolist()
            return ways, 0
        repeats = self._count_repeats(i, j)
        if repeats:
            return 0, repeats
        if repeats_exactly(self._expected, np.array([j]))[0]:
            return 0, 1
        row = self._rows.rows(i, i + 1)
        # Behind blocks that may be skipped a program states again where it is.
        again = j in self._expected.behind_skipped and bool(stands_still(self._run, row)[0])
        if self._rows[i] in self._approaches or again or repeats_position(self._run, row)[0]:
            self._extra.append(self._rows[i])
            return 1, 0
        segments = self._match_arc_segments(i, j) or self._match_circles(i, j)
        if segments:
            return segments, 0
        back = rewind_retract_length(self._run, self._rows[i], self._expected.section_at(j).tolerances.tip)
        if back:
            self._extra += self._rows.rows(i, i + back).tolist()
            return back, 0
        motions, points = self._match_intermediate(i, j)
        if motions:
            return motions, points
        self._mismatches += 1
        a, b = self._find_resync(i, j) if self._mismatches <= _MAX_MISMATCHES else (self._n - i, self._m - j)
        self._pair_unequal(i, j, a, b)
        return a, b

    def _pair(self, i: int, j: int, count: int) -> None:
        self._nc += self._rows.ranges(i, i + count)
        self._cl.append((j, count))

    def _pairs(self, i: int, j: int, count: int) -> tuple[Ints, Ints]:
        """Rows of ``count`` motions from the i-th on, and CL rows from j on."""
        return self._rows.rows(i, i + count), np.arange(j, j + count)

    def _limits_at(self, j: int) -> tuple[float, float]:
        """How far pairs may be apart, mm and as the length of a vector; checks apply the exact tolerances later."""
        tip, axis = self._limits[int(np.searchsorted(self._expected.first_rows, j, "right")) - 1]
        return float(tip), float(axis)

    def _limits_of(self, rows: Ints) -> tuple[Floats, Floats]:
        """``_limits_at`` of increasing CL rows, (k,) and (k,): each operation has its own."""
        limits = self._limits[np.searchsorted(self._expected.first_rows, rows, "right") - 1]
        return limits[:, 0], limits[:, 1]

    def _fits(self, i: int, j: int, count: int) -> Flags:
        """Which of ``count`` motions from the i-th on are at the points from CL row j on, (count,) bool."""
        rows, points = self._pairs(i, j, count)
        actual = self._run.positions(rows)
        tip, axis = self._limits_of(points)
        fits = (np.abs(actual.tip - self._expected.tip(points)) <= tip[:, None]).all(axis=1)
        fits &= (np.abs(actual.axis - self._expected.axis(points)) <= axis[:, None]).all(axis=1)
        if len(self._hole_cl_rows):  # no point is reached before the holes that come before it
            fits &= np.searchsorted(self._hole_rows, rows) == np.searchsorted(self._hole_cl_rows, points, "right")
        return np.asarray(fits)

    def _repeats(self, j: int) -> bool:
        """Whether a point may print as the one before it; an arc only if all of it does."""
        point = self._expected.point(j)
        if j in self._expected.first_rows:
            return False
        tip, axis = self._limits_at(j)
        if point.kind is Kind.ARC:
            arc = arc_of(self._expected, j)
            if arc.sweep * arc.radius > 2.0 * tip:
                return False
        before = self._expected.point(j - 1)
        tip_before, axis_before = self._expected.hole_exits.get(j, (before.tip, before.axis))
        same_tip = (np.abs(point.tip - tip_before) <= 2.0 * tip).all()
        return bool(same_tip and (np.abs(point.axis - axis_before) <= 2.0 * axis).all())

    def _count_repeats(self, i: int, j: int) -> int:
        """How many repeated points may be left out so that the sides fit again."""
        count = 0
        while j + count + 1 < self._m and count < _MAX_REPEATS and self._repeats(j + count):
            count += 1
            if self._fits(i, j + count, 1)[0] or self._expected.point(j + count).kind is Kind.ARC:
                return count
        return 0

    def _match_turns(self, i: int, j: int) -> int:
        """How many circles from the i-th on come before the last of those that make up the turns of CL row j."""
        k = int(np.searchsorted(self._turn_rows, j))
        return self._match_circles(i, j) if k < len(self._turn_rows) and self._turn_rows[k] == j else 0

    def _match_circles(self, i: int, j: int) -> int:
        """How many circles from the i-th on are pieces of the arc of CL row j before its last.

        How far each of them goes round says where on the arc it must end: a helix passes the same place in every turn.
        """
        if j == 0 or self._expected.point(j).kind is not Kind.ARC:
            return 0
        arc, (tip, _) = arc_of(self._expected, j), self._limits_at(j)
        # An end that is off by the tolerance is off by this angle, and no piece is as short as that.
        slack = 4.0 * tip / max(arc.radius, tip)
        done = 0.0
        pieces: list[float] = []
        while i + len(pieces) < self._n and len(pieces) <= _MAX_PIECES:
            row = self._rows[i + len(pieces)]
            if row == 0 or self._run.kind[row] != Kind.ARC:
                return 0
            circle = circle_of(self._run, row)
            done += circle.sweep
            if done >= arc.sweep - slack or circle.sweep <= slack or float(circle.normal @ arc.normal) < _SAME_SENSE:
                break
            fraction = done / arc.sweep
            if (np.abs(circle.end - arc.at(np.array([fraction]))[0]) > tip * (1.0 + arc.slope)).any():
                return 0
            pieces.append(fraction)
        count = len(pieces)
        if not count or i + count >= self._n or abs(done - arc.sweep) > slack or not self._fits(i + count, j, 1)[0]:
            return 0
        self._arc_segments.append(ArcSegments(self._rows.rows(i, i + count), j, arc, np.array(pieces)))
        return count

    def _match_arc_segments(self, i: int, j: int) -> int:
        """How many lines from the i-th on lie on the arc of CL row j and lead to its end."""
        if self._expected.point(j).kind is not Kind.ARC or j == 0:
            return 0
        arc = arc_of(self._expected, j)
        tip, _ = self._limits_at(j)
        for window in _ARC_WINDOWS:
            rows = self._rows.rows(i, i + window)
            others = np.flatnonzero(self._run.kind[rows] != Kind.LINEAR)
            if len(others):
                rows = rows[: others[0]]
            tips = self._run.positions(rows).tip
            ends = np.flatnonzero((np.abs(tips - arc.end) <= tip).all(axis=1))
            if arc.radius > 4.0 * tip:  # an arc of more than one turn may pass its end on the way
                ends = ends[np.abs(arc.fractions(tips)[ends] - 1.0) * arc.sweep < np.pi]
            if len(ends):
                segments = rows[: ends[0]]
                off = np.abs(arc.deviation(tips[: ends[0]])).max(axis=1, initial=0.0)
                if (off > 100.0 * tip + 0.1).any():  # these lines belong to something else
                    return 0
                if len(segments):  # a single line is judged by its kind
                    self._arc_segments.append(ArcSegments(segments, j, arc))
                return len(segments)
            if len(rows) < window:
                return 0
        return 0

    def _match_intermediate(self, i: int, j: int) -> tuple[int, int]:
        """How many motions from the i-th on go to how many points from CL row j on, with intermediate points."""
        if j == 0 or self._axis_deviation is None:
            return 0, 0
        section = self._expected.section_at(j)
        rows = self._rows.rows(i, i + CHUNK)
        points = np.arange(max(j - 1, section.first), min(j + CHUNK, section.end))
        if points[0] == j:  # where the tool comes from to the first point of an operation is not known
            return 0, 0
        expected, tolerances = self._expected, section.tolerances
        near_tip, near_axis = self._limits_at(j)
        limits = FollowLimits(
            near_tip, near_axis, tolerances.tip, tolerances.angle, math.radians(self._axis_deviation) + 2.0 * near_axis
        )
        cl_points = PathPoints(expected.tip(points), expected.axis(points), expected.kind(points))
        found = follow_path(self._geometry, self._run.positions(rows), self._run.kind[rows], cl_points, limits)
        motions, new_points = self._justified(rows, found, cl_points.kind)
        nc, cl, arrives = rows[:motions], j + found.cl_point[:motions], found.arrives[:motions]
        at_points = np.flatnonzero(arrives)
        edges = np.flatnonzero((np.diff(nc[at_points]) != 1) | (np.diff(cl[at_points]) != 1))
        for unbroken in np.split(at_points, edges + 1):
            if len(unbroken):
                self._nc.append((int(nc[unbroken[0]]), len(unbroken)))
                self._cl.append((int(cl[unbroken[0]]), len(unbroken)))
        self._intermediate_nc.append(nc[~arrives])
        self._intermediate_cl.append(cl[~arrives])
        return motions, new_points

    def _justified(self, rows: Ints, found: FollowedPath, kind: Codes) -> tuple[int, int]:
        """How many motions and points go together up to an intermediate point that nothing asks for.

        It must move as its step does. The rotary axes must turn by ``least_turn`` on that step, or not at all: then the
        point is on the straight line. ``kind`` is that of the CL points, led by the one from which the first motion
        starts.
        """
        if self._least_turn == 0.0:
            return found.motions, found.points
        for point in distinct(found.cl_point[~found.arrives]).tolist():
            step = np.flatnonzero(found.cl_point == point)
            each = np.concatenate(([rows[step[0]] - 1], rows[step]))
            turn = np.abs(np.diff(self._run.rotary[np.maximum(each, 0)], axis=0)).sum()
            between = rows[step[~found.arrives[step]]]
            same_kind = (self._run.kind[between] == kind[point + 1]).all()
            if _STILL < turn < self._least_turn or not same_kind:
                return int(step[0]), point
        return found.motions, found.points

    def _find_resync(self, i: int, j: int) -> tuple[int, int]:
        """How many motions and points come before two in a row fit again; all of them if they never do."""
        for window in _WINDOWS:
            a, b = min(window, self._n - i), min(window, self._m - j)
            actual, points = self._run.positions(self._rows.rows(i, i + a)), np.arange(j, j + b)
            cl_tip, cl_axis = self._expected.tip(points), self._expected.axis(points)
            tip, axis = self._limits_of(points)
            fits = np.ones((a, b), np.bool_)
            for column in range(3):
                fits &= np.abs(actual.tip[:, column, None] - cl_tip[:, column]) <= tip
                fits &= np.abs(actual.axis[:, column, None] - cl_axis[:, column]) <= axis
            # Rapids that only lead to a hole stand between motions to two CL points in a row.
            kept = np.flatnonzero(fits.any(axis=1) | ~np.isin(self._rows.rows(i, i + a), self._approach_rows))
            found = find_resync(fits[kept], (i + a == self._n, j + b == self._m))
            if found is not None:
                return int(np.append(kept, a)[found[0]]), found[1]
        return self._n - i, self._m - j

    def _pair_unequal(self, i: int, j: int, a: int, b: int) -> None:
        """Pair ``a`` motions with ``b`` points that do not fit; the longer side gets a gap where it costs least."""
        less, gap = min(a, b), abs(a - b)
        if gap == 0 or less > _MAX_GAP_SEARCH:
            self._pair(i, j, less)
            before_gap = less
        else:
            before_gap = self._best_gap(i, j, a, b)
            self._pair(i, j, before_gap)
            self._pair(i + before_gap + max(a - b, 0), j + before_gap + max(b - a, 0), less - before_gap)
        if a > b:
            inserts = self._expected.insert_counts.get(j + before_gap, 0)
            self._extra += self._rows.rows(i + before_gap, i + before_gap + gap).tolist()[inserts:]
        elif b > a:
            missing = range(j + before_gap, j + before_gap + gap)
            self._missing += [row for row in missing if not self._repeats(row)]

    def _best_gap(self, i: int, j: int, a: int, b: int) -> int:
        """How many pairs of ``a`` motions and ``b`` points should come before the gap in the longer side."""
        actual, points = self._run.positions(self._rows.rows(i, i + a)), np.arange(j, j + b)
        cl_tip, cl_axis = self._expected.tip(points), self._expected.axis(points)
        cost = np.empty(min(a, b) + 1)
        for gap in range(len(cost)):
            rows = np.delete(np.arange(a), slice(gap, gap + max(a - b, 0)))
            points = np.delete(np.arange(b), slice(gap, gap + max(b - a, 0)))
            tip = np.abs(actual.tip[rows] - cl_tip[points]).sum(axis=1)
            axis = np.abs(actual.axis[rows] - cl_axis[points]).sum(axis=1)
            cost[gap] = np.minimum(tip + 50.0 * axis, 1e6).sum()
        return int(np.argmin(cost))
