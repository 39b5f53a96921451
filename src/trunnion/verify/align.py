"""Which motion of a program answers to which CL point.

In:     a run, and what was wanted.
Out:    pairs of rows, rows of either side without a partner, and the lines that stand for an arc.

Motions in the machine's own frame and rotary axes placed without TCP answer to no CL point. Points that repeat the one
before make no block. Where as many motions as points remain they are paired in order, and that is all there is to most
programs; otherwise both sides are walked along together, and where they part they are searched for the nearest place
at which two motions in a row fit again.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.reader import Run, Written
from trunnion.toolpath import Kind
from trunnion.verify.arcs import Arc, arc_of
from trunnion.verify.wanted import Wanted

#: Rows compared at a time.
CHUNK = 65536

#: How far ahead the two sides are searched for a place at which they fit again.
_WINDOWS = (8, 48, 384)

#: Partings that are looked into; beyond them the two sides are taken to be different programs.
_PARTINGS = 2000

#: Words that say where the tip or the tool axis is to be, and those that turn rotary axes.
PLACES = Written.X | Written.Y | Written.Z | Written.VECTOR
_TURNS = Written.FIRST | Written.SECOND


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """Lines of a program, rows ``nc``, that together stand for the arc ``arc`` at CL row ``cl``, its end left out."""

    nc: Ints
    cl: int
    arc: Arc


@dataclass(frozen=True, slots=True, eq=False)
class Pairs:
    """Partners: row ``nc[k]`` of the run answers to CL row ``cl[k]``, both growing.

    missing   CL rows that no motion answers to, repeated points left out
    extra     motions that answer to no CL row
    """

    nc: Ints
    cl: Ints
    missing: tuple[int, ...] = ()
    extra: tuple[int, ...] = ()
    pieces: tuple[Pieces, ...] = ()


def answers(run: Run) -> Ints:
    """Rows of a run that ought to answer to CL points."""
    mask = np.empty(len(run), np.bool_)
    for start in range(0, len(run), CHUNK):
        part = slice(start, start + CHUNK)
        placing = (run.programmed[part] & int(PLACES)) == 0
        placing &= (run.programmed[part] & int(_TURNS)) != 0
        placing &= ~run.tcp[part] & (run.kind[part] == Kind.RAPID)
        mask[part] = ~(placing | run.machine_frame[part])
    return np.flatnonzero(mask)


def in_order(run: Run, wanted: Wanted) -> Pairs | None:
    """Pairs by counting alone, if there are as many motions as points; whether they fit is not looked at."""
    rows = answers(run)
    if len(rows) == len(wanted):
        return Pairs(rows, np.arange(len(wanted)))
    fresh = ~_repeats(wanted)
    if len(rows) == int(fresh.sum()):
        return Pairs(rows, np.flatnonzero(fresh))
    return None


def _repeats(wanted: Wanted) -> Flags:
    """CL rows that say the point before once more, within an operation."""
    same = np.zeros(len(wanted), np.bool_)
    for start in range(1, len(wanted), CHUNK):
        end = min(start + CHUNK, len(wanted))
        now, before = slice(start, end), slice(start - 1, end - 1)
        same[now] = (wanted.tip[now] == wanted.tip[before]).all(axis=1)
        same[now] &= (wanted.axis[now] == wanted.axis[before]).all(axis=1)
    same &= wanted.kind != Kind.ARC
    same[wanted.firsts] = False
    return same


def matched(run: Run, wanted: Wanted) -> Pairs:
    """Pairs by position, whatever was dropped, doubled or swapped."""
    return _Matcher(run, wanted).walk()


class _Matcher:
    """Walks along the motions of a program and the points of its CL files together."""

    def __init__(self, run: Run, wanted: Wanted) -> None:
        self._run, self._wanted = run, wanted
        self._rows = answers(run)
        self._n, self._m = len(self._rows), len(wanted)
        self._nc: list[Ints] = []
        self._cl: list[Ints] = []
        self._missing: list[int] = []
        self._extra: list[int] = []
        self._pieces: list[Pieces] = []

    def walk(self) -> Pairs:
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
            pieces = self._take_arc(i, j)
            if pieces:
                i += pieces
                continue
            partings += 1
            a, b = self._meeting(i, j) if partings <= _PARTINGS else (self._n - i, self._m - j)
            self._part(i, j, a, b)
            i, j = i + a, j + b
        self._extra += self._rows[i:].tolist()
        self._missing += [row for row in range(j, self._m) if not self._repeats(row)]
        none = np.zeros(0, np.int64)
        return Pairs(
            np.concatenate((none, *self._nc)),
            np.concatenate((none, *self._cl)),
            tuple(self._missing),
            tuple(self._extra),
            tuple(self._pieces),
        )

    def _pair(self, i: int, j: int, count: int) -> None:
        if count:
            self._nc.append(self._rows[i : i + count])
            self._cl.append(np.arange(j, j + count))

    def _limits(self, j: int) -> tuple[float, float]:
        """How far apart partners may be, mm and as the length of a vector; the exact limits are judged later."""
        allowed = self._wanted.part_of(j).allowed
        return allowed.tip * 1.001 + 1e-9, np.radians(2.0 * allowed.angle) + 2e-7

    def _fits(self, i: int, j: int, count: int) -> Flags:
        """Which of ``count`` motions from the i-th on are where the points from row j on want them, (count,) bool."""
        tip, axis = self._limits(j)
        rows = self._rows[i : i + count]
        fits = (np.abs(self._run.tip[rows] - self._wanted.tip[j : j + count]) <= tip).all(axis=1)
        fits &= (np.abs(self._run.axis[rows] - self._wanted.axis[j : j + count]) <= axis).all(axis=1)
        return np.asarray(fits)

    def _repeats(self, j: int) -> bool:
        """Whether a point may print as the one before it."""
        if j == 0 or self._wanted.kind[j] == Kind.ARC or j in self._wanted.firsts:
            return False
        tip, axis = self._limits(j)
        wanted = self._wanted
        return bool(
            (np.abs(wanted.tip[j] - wanted.tip[j - 1]) <= 2.0 * tip).all()
            and (np.abs(wanted.axis[j] - wanted.axis[j - 1]) <= 2.0 * axis).all()
        )

    def _skip_repeats(self, i: int, j: int) -> int:
        """How many repeated points may be left out so that the sides fit again."""
        skipped = 0
        while j + skipped + 1 < self._m and skipped < 1000 and self._repeats(j + skipped):
            skipped += 1
            if self._fits(i, j + skipped, 1)[0] or self._wanted.kind[j + skipped] == Kind.ARC:
                return skipped
        return 0

    def _take_arc(self, i: int, j: int) -> int:
        """How many lines from the i-th on lie on the arc of CL row j, and lead to its end."""
        if self._wanted.kind[j] != Kind.ARC or j == 0:
            return 0
        arc = arc_of(self._wanted, j)
        tip, _ = self._limits(j)
        for ahead in (64, 1024, 16384):
            rows = self._rows[i : i + ahead]
            turns_off = np.flatnonzero(self._run.kind[rows] != Kind.LINEAR)
            if len(turns_off):
                rows = rows[: turns_off[0]]
            there = np.flatnonzero((np.abs(self._run.tip[rows] - arc.end) <= tip).all(axis=1))
            if len(there):
                pieces = rows[: there[0]]
                off = np.abs(arc.deviation(self._run.tip[pieces])).max(axis=1, initial=0.0)
                if (off > 100.0 * tip + 0.1).any():  # these lines are about something else
                    return 0
                self._pieces.append(Pieces(pieces, j, arc))
                return len(pieces)
            if len(rows) < ahead:
                return 0
        return 0

    def _meeting(self, i: int, j: int) -> tuple[int, int]:
        """How many motions and points to go until two in a row fit again; all of them if they never do."""
        for window in _WINDOWS:
            a, b = min(window, self._n - i), min(window, self._m - j)
            rows = self._rows[i : i + a]
            tip, axis = self._limits(j)
            fits = np.ones((a, b), np.bool_)
            for column in range(3):
                one, two = self._run.tip[rows, column], self._wanted.tip[j : j + b, column]
                fits &= np.abs(one[:, None] - two) <= tip
                one, two = self._run.axis[rows, column], self._wanted.axis[j : j + b, column]
                fits &= np.abs(one[:, None] - two) <= axis
            ends = i + a == self._n, j + b == self._m
            found = first_meeting(fits, ends)
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
            apart = np.array([self._apart(i, j, a, b, k) for k in range(less + 1)])
            place = int(np.argmin(apart))
            self._pair(i, j, place)
            self._pair(i + place + max(a - b, 0), j + place + max(b - a, 0), less - place)
        if a > b:
            allowed = self._wanted.inserts.get(j + place, 0)
            self._extra += self._rows[i + place : i + place + gap].tolist()[allowed:]
        elif b > a:
            self._missing += [row for row in range(j + place, j + place + gap) if not self._repeats(row)]

    def _apart(self, i: int, j: int, a: int, b: int, gap: int) -> float:
        """Sum of distances if the longer side leaves out its rows from ``gap`` on."""
        rows, points = self._rows[i : i + a], np.arange(j, j + b)
        if a > b:
            rows = np.delete(rows, slice(gap, gap + a - b))
        else:
            points = np.delete(points, slice(gap, gap + b - a))
        tip = np.abs(self._run.tip[rows] - self._wanted.tip[points]).sum(axis=1)
        axis = np.abs(self._run.axis[rows] - self._wanted.axis[points]).sum(axis=1)
        return float(np.minimum(tip + 50.0 * axis, 1e6).sum())


def first_meeting(fits: Flags, ends: Sequence[bool]) -> tuple[int, int] | None:
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
