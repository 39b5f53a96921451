"""Which motion of a program answers to which CL point.

In:     a run, and what was wanted.
Out:    pairs of rows, rows of either side without a partner, and the lines that stand for an arc.

Motions in the machine's own frame and rotary axes placed without TCP answer to no CL point. Points that repeat the one
before make no block. Where as many motions as points remain they are paired in order, and that is all there is to most
programs; otherwise both sides are walked along together, and where they part they are searched for the nearest place
at which two motions in a row fit again.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.deviations.point_deviations import RotaryGeometry
from trunnion.verification.expected.arcs import Arc, arc_of
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.rapid_feeds import POSITION_WORDS as POSITION_WORDS
from trunnion.verification.kinematics.rapid_feeds import approach_rows, tool_axis_exit_rows
from trunnion.verification.matching.hole_matching import hole_approach_rows, hole_rows, match_holes
from trunnion.verification.matching.intermediate_points import follow_path
from trunnion.verification.matching.rewind_retracts import rewind_retract_length
from trunnion.verification.matching.row_ranges import RowRanges

#: Rows compared at a time: what is needed for them stays in the processor's cache.
CHUNK = 8192

#: Partners handed out at a time: for the checks that look at little of each.
_MANY = 65536

#: How far ahead the two sides are searched for a place at which they fit again.
_WINDOWS = (8, 48, 384)

#: Partings that are looked into; beyond them the two sides are taken to be different programs.
_PARTINGS = 2000

#: A point is where a hole left the tool when it is off by less than this, mm and as the length of a vector.
_SAME = 1e-9

#: Words that turn rotary axes.
_TURNS = ProgrammedWord.FIRST | ProgrammedWord.SECOND


@dataclass(frozen=True, slots=True, eq=False)
class ArcSegments:
    """Lines of a program, rows ``nc``, that together stand for the arc ``arc`` at CL row ``cl``, its end left out."""

    nc: Ints
    cl: int
    arc: Arc


_NOTHING = np.zeros(0, np.int64), np.zeros(0, np.int64)


@dataclass(frozen=True, slots=True, eq=False)
class Matching:
    """Partners: row ``nc[k]`` of the run answers to CL row ``cl[k]``, both growing.

    missing   CL rows that no motion answers to, repeated points left out
    extra     motions that answer to no CL row
    between   (k,) and (k,) int64: motions on the way from one CL point to the next, and the CL row that each leads to
    """

    nc: RowRanges
    cl: RowRanges
    missing: tuple[int, ...] = ()
    extra: tuple[int, ...] = ()
    pieces: tuple[ArcSegments, ...] = ()
    between: tuple[Ints, Ints] = _NOTHING

    def all_pair_chunks(self) -> Iterator[tuple[Ints, Ints]]:
        """As ``pair_chunks``, with the motions between CL points after all the others."""
        yield from self.pair_chunks()
        nc, cl = self.between
        for start in range(0, len(nc), CHUNK):
            yield nc[start : start + CHUNK], cl[start : start + CHUNK]

    def leading(self, cl: Ints) -> Ints:
        """How many motions between CL points lead to each of some CL rows, (k,)."""
        to = self.between[1]
        return np.searchsorted(to, cl, "right") - np.searchsorted(to, cl)

    def pair_chunks(self, first: int = 0, end: int | None = None) -> Iterator[tuple[Ints, Ints]]:
        """Partners, many at a time, from pair ``first`` to the one before ``end``: rows of run and CL files."""
        end = len(self.nc) if end is None else end
        for start in range(first, end, _MANY):
            stop = min(start + _MANY, end)
            yield self.nc.part(start, stop), self.cl.part(start, stop)


def workpiece_rows(run: Run) -> RowRanges:
    """Rows of a run that ought to answer to CL points."""
    return RowRanges.where(
        (start, _answer(run, start, min(start + CHUNK, len(run)))) for start in range(0, len(run), CHUNK)
    )


def _answer(run: Run, start: int, end: int) -> Flags:
    """Which of consecutive rows ought to answer to CL points."""
    return np.asarray(~(_placing(run, start, end) | run.state.machine_frame.part(start, end)))


def _placing(run: Run, start: int, end: int) -> Flags:
    """``only_positions_rotary_axes`` for consecutive rows."""
    programmed = run.programmed[start:end]
    turns = ((programmed & int(POSITION_WORDS)) == 0) & ((programmed & int(_TURNS)) != 0)
    return np.asarray(turns & ~run.state.tcp.part(start, end) & (run.kind[start:end] == Kind.RAPID))


def only_positions_rotary_axes(run: Run, rows: Ints) -> Flags:
    """(k,) bool: the row does nothing but place rotary axes at rapid, with TCP off."""
    programmed = run.programmed[rows]
    turns = ((programmed & int(POSITION_WORDS)) == 0) & ((programmed & int(_TURNS)) != 0)
    return np.asarray(turns & ~run.state.tcp.at(rows) & (run.kind[rows] == Kind.RAPID))


def points(run: Run, expected: ExpectedPath) -> RowRanges:
    """Rows of a run that ought to answer to CL points, without those that make holes or lead to the first point."""
    rows = workpiece_rows(run)
    none = np.concatenate((hole_rows(match_holes(run, expected)), approach_rows(run), tool_axis_exit_rows(run)))
    more = _taken_along(run, expected)
    if not len(none) and not len(more):
        return rows
    flags = np.zeros(len(run), np.bool_)
    flags[rows.part(0, len(rows))] = True
    flags[none] = False
    flags[more] = True
    return RowRanges.where([(0, flags)])


def _taken_along(run: Run, expected: ExpectedPath) -> Ints:
    """Rows that turn the table from one plane to the next, and so take the tool to a CL point at rapid."""
    rows: Ints = np.concatenate(
        [np.zeros(0, np.int64)]
        + [k + np.flatnonzero(_placing(run, k, min(k + CHUNK, len(run)))) for k in range(0, len(run), CHUNK)]
    )
    rows = rows[rows > 0]
    rows = rows[run.state.xyz_is_tip.at(rows - 1) & ~run.state.tcp.at(rows - 1)]
    if not len(rows):
        return rows
    is_, arrives = run.positions(rows), np.zeros(len(rows), np.bool_)
    for part in expected.sections:
        moves, allowed = part.operation.moves, part.tolerances
        rapids = np.flatnonzero(moves.kind[1:] == Kind.RAPID) + 1
        turns = rapids[(moves.axis[rapids] != moves.axis[rapids - 1]).any(axis=1)]
        for k in turns.tolist():
            there = (np.abs(is_.tip - moves.tip[k]) <= allowed.tip).all(axis=1)
            arrives |= there & (np.abs(is_.axis - moves.axis[k]) <= np.radians(2.0 * allowed.angle)).all(axis=1)
    return np.asarray(rows[arrives])


def match_by_count(run: Run, expected: ExpectedPath) -> Matching | None:
    """Matching by counting alone, if there are as many motions as points; whether they fit is not looked at."""
    rows = points(run, expected)
    if len(rows) == len(expected):
        return Matching(rows, RowRanges.of([(0, len(expected))]))
    fresh = RowRanges.where(_fresh(expected))
    return Matching(rows, fresh) if len(rows) == len(fresh) else None


def _fresh(expected: ExpectedPath) -> Iterator[tuple[int, Flags]]:
    """CL rows that do not say the point before once more, within an operation; as ``RowRanges.where`` takes them."""
    behind = np.array(sorted(expected.hole_exits), np.int64)
    for part in expected.sections:
        moves = part.operation.moves
        for start in range(0, len(moves), CHUNK):
            now, before = slice(max(start, 1), start + CHUNK), slice(max(start - 1, 0), start + CHUNK - 1)
            tip, axis = moves.tip[now], moves.axis[now]
            same = (tip == moves.tip[before][: len(tip)]).all(axis=1)
            same &= (axis == moves.axis[before][: len(tip)]).all(axis=1)
            fresh = ~same | (moves.kind[now] == Kind.ARC)
            fresh = fresh if start else np.concatenate(([True], fresh))
            first = part.first + start
            near = slice(*np.searchsorted(behind, [max(first, part.first + 1), first + len(fresh)]))
            for row in behind[near].tolist():
                (tip, axis), point = expected.hole_exits[row], expected.point(row)
                fresh[row - first] = max(np.abs(point.tip - tip).max(), np.abs(point.axis - axis).max()) > _SAME
            yield part.first + start, fresh


def match_by_position(run: Run, expected: ExpectedPath, *, bend: float | None = None) -> Matching:
    """Matching by position, whatever was dropped, doubled or swapped.

    With ``bend``, degrees, there may be more points on the way between CL points, with the tool axis no further off.
    """
    return _Matcher(run, expected, bend).walk()


class _Matcher:
    """Walks along the motions of a program and the points of its CL files together."""

    def __init__(self, run: Run, expected: ExpectedPath, bend: float | None) -> None:
        self._run, self._wanted, self._bend = run, expected, bend
        self._rows = points(run, expected)
        self._tilt = RotaryGeometry.of(run.machine)
        made = match_holes(run, expected)
        limits = [part.tolerances for part in expected.sections]
        before = [hole.first - k for hole in made for k in (1, 2, 3)]
        self._leads = hole_approach_rows(run, before, made, max(each.tip for each in limits))
        self._near = np.array([(each.tip * 1.001 + 1e-9, np.radians(2.0 * each.angle) + 2e-7) for each in limits])
        all_made = len(made) == len(expected.holes)
        self._made = np.array([hole.first for hole in made] if all_made else [], np.int64)
        self._holes = np.array([hole.row for hole in expected.holes] if all_made else [], np.int64)
        self._n, self._m = len(self._rows), len(expected)
        self._nc: list[tuple[int, int]] = []
        self._cl: list[tuple[int, int]] = []
        self._missing: list[int] = []
        self._extra: list[int] = []
        self._pieces: list[ArcSegments] = []
        self._between: list[tuple[Ints, Ints]] = [_NOTHING]

    def walk(self) -> Matching:
        """Both sides to their ends."""
        i = j = partings = 0
        size = 64
        while i < self._n and j < self._m:
            count = min(size, self._n - i, self._m - j)
            fits = self._fits(i, j, count)
            same = count if fits.all() else int(np.argmin(fits))
            self._pair(i, j, same)
            i, j = i + same, j + same
            if same == count:
                size = min(2 * size, CHUNK)
                continue
            size = 64
            skipped = self._skip_repeats(i, j)
            if skipped:
                j += skipped
                continue
            if self._rows[i] in self._leads:  # leads to a hole, and is no CL point itself
                self._extra.append(self._rows[i])
                i += 1
                continue
            pieces = self._take_arc(i, j)
            if pieces:
                i += pieces
                continue
            back = rewind_retract_length(self._run, self._rows[i], self._wanted.section_at(j).tolerances.tip)
            if back:
                self._extra += self._rows.part(i, i + back).tolist()
                i += back
                continue
            motions, points = self._take_way(i, j)
            if motions:
                i, j = i + motions, j + points
                continue
            partings += 1
            a, b = self._meeting(i, j) if partings <= _PARTINGS else (self._n - i, self._m - j)
            self._part(i, j, a, b)
            i, j = i + a, j + b
        self._extra += self._rows.part(i, self._n).tolist()
        self._missing += [row for row in range(j, self._m) if not self._repeats(row)]
        return Matching(
            RowRanges.of(self._nc),
            RowRanges.of(self._cl),
            tuple(self._missing),
            tuple(self._extra),
            tuple(self._pieces),
            (np.concatenate([nc for nc, _ in self._between]), np.concatenate([cl for _, cl in self._between])),
        )

    def _pair(self, i: int, j: int, count: int) -> None:
        self._nc += self._rows.stretches(i, i + count)
        self._cl.append((j, count))

    def _limits(self, j: int) -> tuple[float, float]:
        """How far apart partners may be, mm and as the length of a vector; the exact limits are judged later."""
        tip, axis = self._near[int(np.searchsorted(self._wanted.first_rows, j, "right")) - 1]
        return float(tip), float(axis)

    def _limits_of(self, rows: Ints) -> tuple[Floats, Floats]:
        """``_limits`` at growing CL rows, (k,) and (k,): each operation has its own."""
        near = self._near[np.searchsorted(self._wanted.first_rows, rows, "right") - 1]
        return near[:, 0], near[:, 1]

    def _fits(self, i: int, j: int, count: int) -> Flags:
        """Which of ``count`` motions from the i-th on are where the points from row j on want them, (count,) bool."""
        rows, points = self._rows.part(i, i + count), np.arange(j, j + count)
        is_ = self._run.positions(rows)
        tip, axis = self._limits_of(points)
        fits = (np.abs(is_.tip - self._wanted.tip(points)) <= tip[:, None]).all(axis=1)
        fits &= (np.abs(is_.axis - self._wanted.axis(points)) <= axis[:, None]).all(axis=1)
        if len(self._holes):  # no point is met before the holes that stand before it
            fits &= np.searchsorted(self._made, rows) == np.searchsorted(self._holes, points, "right")
        return np.asarray(fits)

    def _repeats(self, j: int) -> bool:
        """Whether a point may print as the one before it; an arc only if all of it does."""
        point = self._wanted.point(j)
        if j in self._wanted.first_rows:
            return False
        tip, axis = self._limits(j)
        if point.kind is Kind.ARC:
            arc = arc_of(self._wanted, j)
            if arc.sweep * arc.radius > 2.0 * tip:
                return False
        before = self._wanted.point(j - 1)
        was_tip, was_axis = self._wanted.hole_exits.get(j, (before.tip, before.axis))
        return bool(
            (np.abs(point.tip - was_tip) <= 2.0 * tip).all() and (np.abs(point.axis - was_axis) <= 2.0 * axis).all()
        )

    def _skip_repeats(self, i: int, j: int) -> int:
        """How many repeated points may be left out so that the sides fit again."""
        skipped = 0
        while j + skipped + 1 < self._m and skipped < 1000 and self._repeats(j + skipped):
            skipped += 1
            if self._fits(i, j + skipped, 1)[0] or self._wanted.point(j + skipped).kind is Kind.ARC:
                return skipped
        return 0

    def _take_arc(self, i: int, j: int) -> int:
        """How many lines from the i-th on lie on the arc of CL row j, and lead to its end."""
        if self._wanted.point(j).kind is not Kind.ARC or j == 0:
            return 0
        arc = arc_of(self._wanted, j)
        tip, _ = self._limits(j)
        for ahead in (64, 1024, 16384):
            rows = self._rows.part(i, i + ahead)
            turns_off = np.flatnonzero(self._run.kind[rows] != Kind.LINEAR)
            if len(turns_off):
                rows = rows[: turns_off[0]]
            tips = self._run.positions(rows).tip
            there = np.flatnonzero((np.abs(tips - arc.end) <= tip).all(axis=1))
            if arc.radius > 4.0 * tip:  # on the way of more than one turn the end may be passed
                there = there[np.abs(arc.fractions(tips)[there] - 1.0) * arc.sweep < np.pi]
            if len(there):
                pieces = rows[: there[0]]
                off = np.abs(arc.deviation(tips[: there[0]])).max(axis=1, initial=0.0)
                if (off > 100.0 * tip + 0.1).any():  # these lines are about something else
                    return 0
                self._pieces.append(ArcSegments(pieces, j, arc))
                return len(pieces)
            if len(rows) < ahead:
                return 0
        return 0

    def _take_way(self, i: int, j: int) -> tuple[int, int]:
        """How many motions from the i-th on go to how many points from row j on, some by points between."""
        if j == 0 or self._bend is None:
            return 0, 0
        part = self._wanted.section_at(j)
        rows = self._rows.part(i, i + CHUNK)
        points = np.arange(max(j - 1, part.first), min(j + CHUNK, part.end))
        if points[0] == j:  # nobody knows from where the tool comes to the first point
            return 0, 0
        is_ = self._run.positions(rows)
        expected = self._wanted
        near, bend = self._limits(j), math.radians(self._bend)
        way = follow_path(
            self._tilt, is_.tip, is_.axis, is_.joints, self._run.kind[rows], expected.tip(points),
            expected.axis(points), expected.kind(points), near, (part.tolerances.tip, part.tolerances.angle), bend +
            2.0 * near[1],
        )  # fmt: skip
        nc, cl = rows[: way.motions], j + way.partner
        there = np.flatnonzero(way.there)
        edges = np.flatnonzero((np.diff(nc[there]) != 1) | (np.diff(cl[there]) != 1))
        for stretch in np.split(there, edges + 1):
            if len(stretch):
                self._nc.append((int(nc[stretch[0]]), len(stretch)))
                self._cl.append((int(cl[stretch[0]]), len(stretch)))
        self._between.append((nc[~way.there], cl[~way.there]))
        return way.motions, way.points

    def _meeting(self, i: int, j: int) -> tuple[int, int]:
        """How many motions and points to go until two in a row fit again; all of them if they never do."""
        for window in _WINDOWS:
            a, b = min(window, self._n - i), min(window, self._m - j)
            is_, points = self._run.positions(self._rows.part(i, i + a)), np.arange(j, j + b)
            want_tip, want_axis = self._wanted.tip(points), self._wanted.axis(points)
            tip, axis = self._limits_of(points)
            fits = np.ones((a, b), np.bool_)
            for column in range(3):
                fits &= np.abs(is_.tip[:, column, None] - want_tip[:, column]) <= tip
                fits &= np.abs(is_.axis[:, column, None] - want_axis[:, column]) <= axis
            ends = i + a == self._n, j + b == self._m
            found = find_resync(fits, ends)
            if found is not None:
                return found
        return self._n - i, self._m - j

    def _part(self, i: int, j: int, a: int, b: int) -> None:
        """Pair ``a`` motions with ``b`` points that do not fit; the longer side has a gap where it costs least."""
        less, gap = min(a, b), abs(a - b)
        if gap == 0 or less > 1000:
            self._pair(i, j, less)
            place = less
        else:
            place = self._gap(i, j, a, b)
            self._pair(i, j, place)
            self._pair(i + place + max(a - b, 0), j + place + max(b - a, 0), less - place)
        if a > b:
            allowed = self._wanted.inserts.get(j + place, 0)
            self._extra += self._rows.part(i + place, i + place + gap).tolist()[allowed:]
        elif b > a:
            self._missing += [row for row in range(j + place, j + place + gap) if not self._repeats(row)]

    def _gap(self, i: int, j: int, a: int, b: int) -> int:
        """From which row on the longer of two sides, ``a`` motions and ``b`` points, leaves out what it has more."""
        is_, points = self._run.positions(self._rows.part(i, i + a)), np.arange(j, j + b)
        want_tip, want_axis = self._wanted.tip(points), self._wanted.axis(points)
        apart = np.empty(min(a, b) + 1)
        for gap in range(len(apart)):
            rows = np.delete(np.arange(a), slice(gap, gap + max(a - b, 0)))
            points = np.delete(np.arange(b), slice(gap, gap + max(b - a, 0)))
            tip = np.abs(is_.tip[rows] - want_tip[points]).sum(axis=1)
            axis = np.abs(is_.axis[rows] - want_axis[points]).sum(axis=1)
            apart[gap] = np.minimum(tip + 50.0 * axis, 1e6).sum()
        return int(np.argmin(apart))


def find_resync(fits: Flags, ends: Sequence[bool]) -> tuple[int, int] | None:
    """The nearest (a, b) at which two in a row fit, or one before the end of either side, or both sides end."""
    a, b = fits.shape
    twice = fits.copy()
    twice[:-1, :-1] &= fits[1:, 1:]
    if not ends[0]:
        twice[-1] = False
    if not ends[1]:
        twice[:, -1] = False
    where: Floats = np.argwhere(twice).astype(float)
    candidates = [(int(x), int(y)) for x, y in where if x or y]
    if ends[0] and ends[1]:
        candidates.append((a, b))
    if not candidates:
        return None
    return min(candidates, key=lambda c: (max(c), abs(c[0] - c[1])))
