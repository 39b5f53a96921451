"""Each position of a recording at its place of the program's path.

In:     a ``Run``, a ``Recording``, and how far off a position may be.
Out:    a ``RecordedComparison``.
Units:  mm and degrees, workpiece frame.

Where the machine told the line that it ran, a position is compared with that block and with those that ran at the
positions before and after it: a control shows block and axes at times of its own. Positions without a line, or in
another program, are compared with what lies between the lines that were told before and after them. Without any line
positions follow the path: each is looked for from the place of the one before, not much further than the machine has
moved.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine, forward
from trunnion.messages import Wording
from trunnion.model.recording import TIP, Mark, Recording
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.verification.recorded.nearest import Nearest, nearest_pieces, nearest_places
from trunnion.verification.recorded.order import BEFORE, UNTOLD, ToldRows, told_rows
from trunnion.verification.recorded.path import SAG, ProgramPath

#: Blocks before and after the told ones that are compared with as well.
_BESIDE: Final = 1

#: How much further along the path than it has moved a machine may be: a factor, and mm.
_FURTHER: Final = (3.0, 5.0)

#: By how much is looked further where nothing is near.
_WIDER: Final = (1.0, 10.0, 100.0)

#: Pieces of the beginning, where a program that runs once more is looked for.
_BEGINNING: Final = 64

#: Pieces that are looked at for one position at most.
_MOST_PIECES: Final = 200_000


@dataclass(frozen=True, slots=True, eq=False)
class RecordedComparison:
    """A recording of k positions against a run of n rows.

    joints     (k, 5)  recorded axis values, machine order; None: the recording has the tip in place of the slides
    tips       (k, 3)  recorded tips
    row        (k,)    row that each position belongs to; -1 where it was not compared
    off        (k, 3)  from the nearest place of the path to the recorded tip, NaN where it was not compared
    axis_off   (k,)    degrees from the tool axis there to the recorded one
    tolerance  how far off it may be, mm and degrees
    foreign    positions in other programs, while a tool is changed or outside of this one
    strange    rows with a line that the program does not have
    back       rows at which the machine goes back in the program
    outside    positions before the program, after it, and in blocks of which nobody knows where the tool is
    incomplete rows of the recording without all axes
    name       what the machine calls the program, if that is none of the names of its files
    by_line    the machine told the line that it ran
    positions  (n,)    how many positions each row has
    worst      (n, 2)  how far off tip and tool axis were at worst, NaN where a row has no position
    moves      (n,)    rows in which something moves, and of which it is known where
    lengths    (n,)    way of the tip in each row, a degree of the tool axis counting as a millimetre
    """

    recording: Recording
    joints: Floats | None
    tips: Floats
    row: Ints
    off: Floats
    axis_off: Floats
    tolerance: float
    foreign: int
    strange: Ints
    back: Ints
    outside: int
    incomplete: int
    name: str
    by_line: bool
    positions: Ints
    worst: Floats
    moves: Flags
    lengths: Floats

    @property
    def compared(self) -> Ints:
        """Rows of the recording that were compared."""
        return np.flatnonzero(self.row >= 0)

    @property
    def tip_off(self) -> Floats:
        """How far each tip is off, (k,)."""
        return np.asarray(np.linalg.norm(self.off, axis=1))


def compare_recording(run: Run, recording: Recording, tolerance: float) -> RecordedComparison:
    """Compare a recording with a run.

    Raises ``InputError`` if the recording has not all axes of the machine.
    """
    joints, tip, axis = _poses(run.machine, recording)
    whole = np.isfinite(tip).all(axis=1) & np.isfinite(axis).all(axis=1)
    told, path = told_rows(run, recording), ProgramPath.of(run)
    by_line = bool((told.row >= 0).any())
    apart = _apart(run, told) if by_line else told.foreign
    usable = whole & ~apart
    row = np.full(len(recording), -1, np.int64)
    off, axis_off = np.full((len(recording), 3), np.nan), np.full(len(recording), np.nan)
    at = np.flatnonzero(usable & (told.row != BEFORE))
    anew = np.logical_or.reduceat(recording.marked(Mark.GAP), np.r_[0, at[:-1] + 1]) if len(at) else at.astype(np.bool_)
    if by_line:
        rows, following = _told_around(told.row)
        within = (told.row[at] != UNTOLD) | ((rows[at] >= 0) & (following[at] >= rows[at]))
        at, anew = at[within], anew[within]
        found = _by_line(path, (rows[at], following[at]), (tip[at], axis[at]), anew, tolerance)
    else:
        found = _Walk(path, tolerance).follow(tip[at], axis[at], anew)
    there = found.piece >= 0
    row[at[there]] = path.row[found.piece[there]]
    stated = told.row >= 0
    row = np.where((row >= 0) & stated, told.row, row)
    off[at], axis_off[at] = found.off, found.axis_off
    gone = row < 0
    off[gone], axis_off[gone] = np.nan, np.nan
    positions, worst = _by_row(len(run), row, off, axis_off)
    return RecordedComparison(
        recording=recording,
        joints=joints,
        tips=tip,
        row=row,
        off=off,
        axis_off=axis_off,
        tolerance=tolerance,
        foreign=int((whole & apart).sum()),
        strange=np.flatnonzero(told.strange),
        back=told.goes_back(len(run), recording.marked(Mark.GAP)),
        outside=int((usable & gone).sum()),
        incomplete=int((~whole & (recording.source >= 0)).sum()),
        name=told.name,
        by_line=by_line,
        positions=positions,
        worst=worst,
        moves=_moves(len(run), path),
        lengths=_row_lengths(len(run), path),
    )


def _poses(machine: Machine, recording: Recording) -> tuple[Floats | None, Floats, Floats]:
    """Axis values if the recording has all, tips and tool axes, (k, 5), (k, 3) and (k, 3)."""
    columns = {name.casefold(): column for name, column in recording.values.items()}
    names = [name.casefold() for name in machine.names]
    doubled = [name for name in names if sum(each.casefold() == name for each in recording.values) > 1]
    if doubled:
        raise InputError(Problem(recording.file, 1, Wording("TWN321", "two_columns_axis", doubled=doubled[0].upper())))
    missing = [machine.names[k] for k, name in enumerate(names) if name not in columns]
    has_tip = all(name in columns for name in TIP)
    if missing and not (has_tip and all(names[k] in columns for k in machine.own_rotary)):
        raise InputError(
            Problem(
                recording.file,
                1,
                Wording(
                    "TWN350",
                    "no_column",
                    missing=missing[0],
                    machine=machine.key,
                    names=tuple(machine.names),
                    tip=tuple(TIP),
                )
                if len(missing) == 1
                else Wording(
                    "TWN350",
                    "no_columns",
                    missing=tuple(missing),
                    machine=machine.key,
                    names=tuple(machine.names),
                    tip=tuple(TIP),
                ),
            )
        )
    joints = np.zeros((len(recording), 5))
    for k, name in enumerate(names):
        if name in columns and (not missing or k in machine.own_rotary):
            joints[:, k] = columns[name]
    tip, axis = forward(machine, joints)
    if not missing:
        return joints, tip, axis
    return None, np.column_stack([columns[name] for name in TIP]), axis


def _apart(run: Run, told: ToldRows) -> Flags:
    """Positions in other programs of which nobody knows where they should be: while a tool is changed, or outside."""
    rows, following = _told_around(told.row)
    changes = np.zeros(len(run) + 2, np.int64)
    changes[[min(each.before_row, len(run)) + 1 for each in run.events if each.kind == "tool_change"]] = 1
    changes = np.cumsum(changes)
    within = (rows >= 0) & (following >= rows)
    changed = changes[np.maximum(following, 0) + 1] > changes[np.maximum(rows, 0) + 1]
    return np.asarray(told.foreign & (~within | changed))


def _told_around(told: Ints) -> tuple[Ints, Ints]:
    """For each position the row told last, itself included, and the one told next; -1 where there is none."""
    k = len(told)
    index = np.arange(k)
    before = np.maximum.accumulate(np.where(told != UNTOLD, index, -1)) if k else index
    after = np.minimum.accumulate(np.where(told != UNTOLD, index, k)[::-1])[::-1] if k else index
    padded = np.append(told, -1)
    return np.maximum(padded[before], -1), np.maximum(padded[after], -1)


def _by_line(
    path: ProgramPath, around: tuple[Ints, Ints], poses: tuple[Floats, Floats], anew: Flags, tolerance: float
) -> Nearest:
    """Return the nearest places to some tips and tool axes, by the rows that were told before and after them."""
    rows, following = around
    before, after = np.r_[rows[:1], rows[:-1]], np.r_[following[1:], following[-1:]]
    before = np.where(anew | (before > rows), rows, before)
    after = np.where(np.r_[anew[1:], True] | (after < following), following, after)
    after = np.maximum(after, rows)
    last = len(path.first) - 2
    low = path.first[np.maximum(before - _BESIDE, 0)]
    high = path.first[np.minimum(after + _BESIDE, last) + 1]
    high = np.minimum(high, low + _MOST_PIECES)
    found = nearest_places(path, *poses, low, high)
    # Beside a block of which nobody knows where it is, a position may be in that one.
    unknown = np.concatenate(([0], np.cumsum(~path.known)))
    own = unknown[path.first[rows + 1]] > unknown[path.first[rows]]
    beside = unknown[high] > unknown[low]
    found.piece[own | (beside & (found.measure > tolerance))] = -1
    return found


class _Walk:
    """Follows a path with positions in their order."""

    def __init__(self, path: ProgramPath, tolerance: float) -> None:
        self._path, self._tolerance = path, tolerance
        self._near_enough = max(tolerance, 2.0 * SAG)
        self._length = np.concatenate(([0.0], np.cumsum(path.lengths())))
        self._unknown = np.concatenate(([0], np.cumsum(~path.known)))
        self._now = -1
        self._step = 0.0  # how far the machine went last on the path

    def follow(self, tip: Floats, axis: Floats, anew: Flags) -> Nearest:
        """Return the nearest places to positions, (k,); none before the first and after the last of the program."""
        piece = np.full(len(tip), -1, np.int64)
        moved = np.linalg.norm(np.diff(tip, axis=0, prepend=tip[:1]), axis=1)
        moved += np.degrees(np.linalg.norm(np.diff(axis, axis=0, prepend=axis[:1]), axis=1))
        for k in range(len(tip)):
            piece[k] = self._next(tip[k : k + 1], axis[k : k + 1], float(moved[k]), anew=bool(anew[k]))
        last = np.flatnonzero(piece >= 0)
        low = np.maximum(piece, 0)
        found = self._nearest_around(tip, axis, piece)
        beside = self._unknown[np.minimum(low + 2, len(self._path))] > self._unknown[np.maximum(low - 1, 0)]
        found.piece[beside & (found.measure > self._tolerance)] = -1
        self._forget_the_end(found, last)
        return found

    def _next(self, tip: Floats, axis: Floats, moved: float, *, anew: bool) -> int:
        """Return the piece of the next position; -1: it is none of the path."""
        if self._now < 0 or anew:
            begun = self._near(tip, axis, max(self._now, 0), len(self._path))
            if begun < 0 <= self._now:  # it may run once more
                begun = self._near(tip, axis, 0, self._now)
            if begun >= 0 or self._now < 0:
                self._now = begun
                return begun
        # A position that is off says nothing about how far the machine has gone.
        gone = min(moved, _FURTHER[1] + _FURTHER[0] * self._step)
        ways = [_FURTHER[1] + _FURTHER[0] * gone * wider for wider in _WIDER]
        narrow = -1
        for way in ways:
            high = self._reach(way)
            found, away = self._look(tip, axis, self._now, high)
            if away <= self._near_enough:
                self._now, self._step = found, moved
                return found
            if narrow < 0:
                narrow = found
        if (begun := self._near(tip, axis, 0, min(len(self._path), _BEGINNING))) >= 0:
            self._now = begun  # the program runs once more
            return begun
        near = self._reach(_FURTHER[1] + _FURTHER[0] * self._step)
        if self._unknown[near] > self._unknown[self._now]:
            return -1  # it may be where nobody knows the tool
        self._now = max(narrow, self._now)
        return narrow

    def _reach(self, way: float) -> int:
        """Return the first piece that is further along the path than some way."""
        high = int(np.searchsorted(self._length, self._length[self._now] + way, "right"))
        return min(max(high, self._now + 2), self._now + _MOST_PIECES, len(self._path))

    def _nearest_around(self, tip: Floats, axis: Floats, piece: Ints) -> Nearest:
        """Return the nearest place in these pieces and in those beside them: they are curved, and were taken for
        straight.
        """
        best = None
        for beside in (0, -1, 1, -2, 2):
            low = np.clip(piece + beside, 0, max(len(self._path) - 1, 0))
            found = nearest_places(self._path, tip, axis, low, np.where(piece >= 0, low + 1, low))
            if best is None:
                best = found
                continue
            better = found.measure < best.measure
            best.piece[better], best.off[better] = found.piece[better], found.off[better]
            best.axis_off[better] = found.axis_off[better]
        assert best is not None
        return best

    def _near(self, tip: Floats, axis: Floats, low: int, high: int) -> int:
        """Return the nearest of some pieces if it is within the tolerance, else -1."""
        found, away = self._look(tip, axis, low, high)
        return found if away <= self._near_enough else -1

    def _look(self, tip: Floats, axis: Floats, low: int, high: int) -> tuple[int, float]:
        """Return the nearest of some pieces, and how far away it is."""
        found, away = nearest_pieces(self._path, tip, axis, np.array([low]), np.array([high - low]))
        return int(found[0]), float(away[0])

    def _forget_the_end(self, found: Nearest, compared: Ints) -> None:
        """Positions after the last one that is at the path's end are no longer in the program."""
        near = found.measure <= self._tolerance
        at_end = np.flatnonzero(near & (found.piece >= len(self._path) - 1))
        if len(at_end):
            after = compared[(compared > at_end[-1]) & ~near[compared]]
            found.piece[after] = -1


def _by_row(n: int, row: Ints, off: Floats, axis_off: Floats) -> tuple[Ints, Floats]:
    """How many positions each of n rows has, and how far off its worst ones are."""
    compared = np.flatnonzero(row >= 0)
    worst = np.full((n, 2), -np.inf)
    np.maximum.at(worst[:, 0], row[compared], np.linalg.norm(off[compared], axis=1))
    np.maximum.at(worst[:, 1], row[compared], axis_off[compared])
    worst[worst < 0.0] = np.nan
    return np.bincount(row[compared], minlength=n).astype(np.int64), worst


def _row_lengths(n: int, path: ProgramPath) -> Floats:
    """Return the way of the tip in n rows, (n,)."""
    lengths = np.zeros(n)
    np.add.at(lengths, path.row, path.lengths())
    return lengths


def _moves(n: int, path: ProgramPath) -> Flags:
    """Rows in which something moves at a known place, (n,)."""
    moving = path.known & (np.abs(path.end - path.begin) > 1e-9).any(axis=1)
    return np.asarray(np.bincount(path.row[moving], minlength=n)[:n] > 0)
