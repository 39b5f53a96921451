"""Where the tool's tip is stated by the program, row by row.

In:     a run.
Out:    ``StatedTips``: which rows begin and end at a known place of the workpiece, and how the tool leaves and comes.
Units:  mm, unit vectors, workpiece frame.

Without workpiece zero and tool length, of all tools or of one, nobody knows where a machine position (G53, SUPA, M91)
is in the workpiece frame, nor where the part is after rotary axes have turned without TCP. What is not known of a tip
is a set of directions: a retract of Z leaves one, and in a tilted plane X and Y alone do not end it. A block ends the
directions of the coordinates that it names, in the axes in which it names them.
"""

from typing import Final
from weakref import WeakKeyDictionary

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Mount, forward
from trunnion.model.machine_slides import at_machine
from trunnion.model.run import NO_OFFSET, ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.model.unknown_setups import rows_elsewhere, stated_rows
from trunnion.records import dataclass

#: Smaller rotary motion, degrees, is none; coordinates that differ by less, mm, are the same.
_STILL: Final = 1e-3
_SAME: Final = 1e-9

#: What a motion may be off the tool axis, as the cosine, and still take the tool away from the part, or to it.
_ALONG: Final = 0.5

_XYZ: Final = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)
_TURNS: Final = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR)


@dataclass(frozen=True, slots=True, eq=False)
class StatedTips:
    """What a program of n rows states of its tips.

    placed         (n,)    zero and length are stated: where rotary axes turn a known tip to is known too
    before, after  (n,)    the whole tip is known where a row begins, and where it ends
    ways           rows in which the tool leaves for, or comes from, a place that nobody knows, and in which unit
                   vector that place is, far from the part
    aside          rows that leave for machine positions, none of their slides along the tool
    unjudged       (k,)    rows with programmed positions of which only the end is judged, or nothing, ascending
    lost_feeds     (m,)    those of them at feed that no motion follows which makes the tip known
    """

    placed: Flags
    before: Flags
    after: Flags
    ways: dict[int, Floats]
    aside: Ints
    unjudged: Ints
    lost_feeds: Ints

    @staticmethod
    def of(run: Run, *, needs_gauge_point: bool = False) -> "StatedTips":
        """Return what a run states, found once for all who ask.

        needs_gauge_point  positions of the machine are some of the workpiece only where the definition states where the
                           spindle nose stands
        """
        found = _of_runs[needs_gauge_point].get(run)
        if found is None:
            found = _of_runs[needs_gauge_point][run] = _Walk(run, needs_gauge_point=needs_gauge_point).result()
        return found


#: Kept as long as the runs, by whether the gauge point is needed.
_of_runs: dict[bool, WeakKeyDictionary[Run, StatedTips]] = {False: WeakKeyDictionary(), True: WeakKeyDictionary()}


def turns_without_tcp(run: Run, rows: Ints) -> Flags:
    """Which rows turn a rotary axis while TCP is off, (k,) bool."""
    before = np.where((rows > 0)[:, None], run.rotary[np.maximum(rows - 1, 0)], run.start[list(run.machine.rotary)])
    turned = np.abs(run.rotary[rows] - before).max(axis=1, initial=0.0)
    return np.asarray((turned > _STILL) & ~run.state.tcp.at(rows))


class _Walk:
    """Follows what is not known of the tip through a run.

    It is kept as orthonormal columns (3, k); none: the tip is known.
    """

    def __init__(self, run: Run, *, needs_gauge_point: bool) -> None:
        machine, n = run.machine, len(run)
        self.run = run
        zero, length = (column.column() for column in stated_rows(run))
        elsewhere = rows_elsewhere(run)
        if machine.workpiece_zero is not None:  # places of the machine are the same in all work offsets
            zero = zero | ~elsewhere
        self.turns_known = zero & length
        #: Positions of the machine are some of the workpiece too.
        self.placed = self.turns_known & np.bool_(machine.spindle_point_is_stated or not needs_gauge_point)
        self.turns_in_place = zero & (length | np.bool_(not machine.has_rotary_head))
        self.tip_words = run.state.xyz_is_tip.column()
        self.plane = run.state.plane.column()
        self.words = run.programmed & np.uint8(_XYZ)
        upright = (np.abs((run.rotary + 180.0) % 360.0 - 180.0) < _SAME).all(axis=1)
        means_tip = self.tip_words | upright | self.turns_in_place
        self.of_machine = run.machine_frame | (run.work_offset == NO_OFFSET)
        #: Rows whose words are positions of slides that nobody can place in the workpiece frame.
        self.unplaced = np.asarray((self.of_machine | elsewhere | ~means_tip) & ~self.placed & (self.words != 0))
        self.turned = turns_without_tcp(run, np.arange(n)) & ~self.placed
        self.unnamed = np.asarray((run.programmed & np.uint8(_XYZ | _TURNS)) == 0)
        self.lifts, self.relative = _event_rows(run, ("retract",)), _event_rows(run, ("leave",))
        #: Rows before which another tool comes, not both of known lengths, or another zero, not both known.
        self.changes = {row for row in _tool_changes(run) if not length[row - 1 : row + 1].all()}
        self.shifts = set((np.flatnonzero(zero[1:] != zero[:-1]) + 1).tolist())
        self.before, self.after = np.ones(n, np.bool_), np.ones(n, np.bool_)
        self.ways: dict[int, Floats] = {}
        self.aside: list[int] = []
        self.unjudged: list[int] = []
        self.lost_feeds: list[int] = []
        self._waiting: list[int] = []
        self._found_at_machine: Flags | None = None

    def result(self) -> StatedTips:
        """Walk through all rows."""
        run, n = self.run, len(self.run)
        if n:
            self._walk(n)
            self._end_stretch()
        feeds = np.array(self.lost_feeds, np.int64)
        return StatedTips(
            self.turns_known, self.before, self.after, self.ways, np.array(self.aside, np.int64),
            np.array(self.unjudged, np.int64), feeds[run.kind[feeds] != Kind.RAPID],
        )  # fmt: skip

    def _walk(self, n: int) -> None:
        loses = self.unplaced | self.turned
        special = list(self.lifts | self.changes | self.shifts)
        loses[special] = True
        losing = np.flatnonzero(loses)
        same = np.zeros(n, np.bool_)
        for column in (self.words, self.plane, self.tip_words, self.unplaced, self.turned):
            same[1:] |= column[1:] != column[:-1]
        same = ~(same | self.unnamed | self.turned)
        same[special] = False
        other = np.append(np.flatnonzero(~same), n)
        unknown = np.zeros((3, 0)) if self.placed[0] else np.eye(3)
        row = 0
        while row < n:
            if not unknown.shape[1]:
                at = int(np.searchsorted(losing, row))
                row = int(losing[at]) if at < len(losing) else n
                if row == n:
                    return
            old, unknown = unknown, self._after(row, unknown)
            if unknown.shape[1] and _same_span(old, unknown):
                # The blocks that follow with the same words change nothing either.
                end = int(other[np.searchsorted(other, row, "right")])
                self.before[row:end] = self.after[row:end] = False
                self._add_unjudged(range(row + 1, end))
                row = end
            else:
                row += 1

    def _after(self, row: int, unknown: Floats) -> Floats:
        """Return what is not known after a row, given what was not before it; what the row does is noted."""
        if row in self.lifts:
            unknown = _span(unknown, self._axis(row - 1)[:, None])
            self._end_stretch()
        if row in self.changes or row in self.shifts:
            unknown = self._changed(row, unknown)
            self._end_stretch()
        begin = unknown
        if self.turned[row]:
            unknown = self._turned(row, unknown)
        if self.unplaced[row]:
            unknown = _span(unknown, self._slides(row)[:, self._named(row)])
        elif row not in self.relative:
            unknown = self._named_in_workpiece(row, unknown)
        was, is_known = not begin.shape[1], not unknown.shape[1]
        self.before[row], self.after[row] = was, is_known
        if unknown.shape[1] > begin.shape[1]:
            self._end_stretch()
        if was and not is_known:
            self._leave(row)
        elif not was:
            self._add_unjudged([row])
            if is_known:
                self._come(row, begin)
        return unknown

    def _changed(self, row: int, unknown: Floats) -> Floats:
        """Return what is not known after another tool or work offset has come into force."""
        unknown = np.eye(3) if row in self.shifts else _span(unknown, self._axis(row - 1)[:, None])
        if not self.placed[row]:
            return unknown
        # Linear axes that stand at positions of the machine still do.
        others = self._slides(row - 1)[:, ~self._at_machine()[row - 1]]
        return _common(unknown, _span(others))

    def _at_machine(self) -> Flags:
        """Which of X, Y and Z stand where coordinates of the machine, or the way home, have put them, (n, 3)."""
        if self._found_at_machine is None:
            home = np.ones(3, np.bool_)
            self._found_at_machine = at_machine(self.run.programmed, self.run.machine_frame, self.tip_words, home)
        return self._found_at_machine

    def _leave(self, row: int) -> None:
        """Note how a row leaves a known place."""
        if not self.unplaced[row]:
            self._add_unjudged([row])
            return
        named = np.linalg.qr(self._slides(row)[:, self._named(row)])[0]
        way = _projected(named, self._axis(row - 1))
        if way is None:
            self.aside.append(row)
        if way is not None and not self.turned[row]:
            self.ways[row] = way
        else:
            self._add_unjudged([row])

    def _come(self, row: int, unknown: Floats) -> None:
        """Note how a row comes to a known place, which ends a stretch of unknown ones."""
        way = None if self.turned[row] else _projected(unknown, self._axis(row))
        if way is not None:
            self.ways[row] = way
            self._waiting = [each for each in self._waiting if each != row]
        self.unjudged += self._waiting
        self._waiting = []

    def _add_unjudged(self, rows: "range | list[int]") -> None:
        """Note rows that are not judged, where they go to positions of the workpiece."""
        self._waiting += [
            row for row in rows if not self.run.machine_frame[row] and (self.words[row] or self.unnamed[row])
        ]  # fmt: skip

    def _end_stretch(self) -> None:
        """Give up the rows that wait for the tip to become known."""
        self.unjudged += self._waiting
        self.lost_feeds += self._waiting
        self._waiting = []

    def _turned(self, row: int, unknown: Floats) -> Floats:
        """Return what is not known after rotary axes have turned about places that nobody knows."""
        run, rotary = self.run, list(self.run.machine.rotary)
        old = run.rotary[row - 1] if row else run.start[rotary]
        turned = [k for k, way in zip(rotary, np.abs(run.rotary[row] - old), strict=True) if way > _STILL]
        if any(run.machine.axes[k].mount is Mount.TOOL for k in turned):
            return unknown if self.turns_in_place[row] else np.eye(3)
        turn = self._slides(row) @ np.linalg.inv(self._slides(row - 1))
        unknown = turn @ unknown
        if self.turns_in_place[row] or np.abs(turn - np.eye(3)).max() < _SAME:
            return unknown
        if len(turned) > 1:
            return np.eye(3)
        # Along the axis about which it turns the part stays: what is across it is no longer known.
        return _span(unknown, np.linalg.svd(turn - np.eye(3))[2][:2].T)

    def _named_in_workpiece(self, row: int, unknown: Floats) -> Floats:
        """Return what is not known after a row that names coordinates of the workpiece, or of a plane in it."""
        if not unknown.shape[1] or not (self.words[row] or self.unnamed[row]):
            return unknown
        if not self.tip_words[row]:
            axes = self._slides(row)
        else:
            axes = self.run.planes[self.plane[row], :, :3] if self.plane[row] >= 0 else np.eye(3)
        if self.words[row]:
            named = self._named(row)
        else:  # circles, and the motions of cycles: what they move
            way = np.diff(self.run.positions(np.array([row - 1, row])).tip, axis=0)[0]
            named = np.flatnonzero(np.abs(np.linalg.solve(axes, way)) > _SAME)
        kept = np.ones(3)
        kept[named] = 0.0
        return _span(axes @ (kept[:, None] * np.linalg.solve(axes, unknown)))

    def _named(self, row: int) -> Ints:
        return np.flatnonzero(int(self.words[row]) >> np.arange(3) & 1)

    def _axis(self, row: int) -> Floats:
        return np.asarray(self.run.positions(np.array([row])).axis[0])

    def _slides(self, row: int) -> Floats:
        """How the tip goes with the slides X, Y and Z, the rotary axes standing as after a row: columns (3, 3)."""
        machine = self.run.machine
        joints = np.zeros((4, len(machine.axes)))
        joints[:, list(machine.rotary)] = self.run.rotary[row] if row >= 0 else self.run.start[list(machine.rotary)]
        for k, name in enumerate("XYZ"):
            joints[k + 1, machine.column(name)] = 1.0
        tip = forward(machine, joints)[0]
        return np.asarray((tip[1:] - tip[0]).T)


def _event_rows(run: Run, kinds: tuple[str, ...]) -> set[int]:
    return {event.before_row for event in run.events if event.kind in kinds and event.before_row < len(run)}


def _tool_changes(run: Run) -> set[int]:
    """Rows before which another tool comes into the spindle: it may be longer or shorter than the last one."""
    tools = run.state.tool
    return {int(row) for row in tools.rows if 0 < row < len(run) and tools[int(row) - 1] != tools[int(row)]}


def _span(*columns: Floats) -> Floats:
    """Orthonormal columns that span all columns, (3, k)."""
    if not sum(each.shape[1] for each in columns):
        return np.zeros((3, 0))
    vectors, sizes, _ = np.linalg.svd(np.hstack(columns), full_matrices=False)
    return np.asarray(vectors[:, sizes > 1e-6])


def _common(one: Floats, two: Floats) -> Floats:
    """Orthonormal columns of what lies in both spans, (3, k)."""
    outside = np.vstack((np.eye(3) - one @ one.T, np.eye(3) - two @ two.T))
    _, sizes, vectors = np.linalg.svd(outside)
    return np.asarray(vectors[sizes < 1e-6].T)


def _same_span(one: Floats, two: Floats) -> bool:
    return one.shape == two.shape and bool(np.abs(one @ one.T - two @ two.T).max() < 1e-6)


def _projected(columns: Floats, axis: Floats) -> Floats | None:
    """Return the unit vector of a span that is nearest to the tool axis; None if it is not along the tool."""
    way = columns @ (columns.T @ axis)
    length = float(np.linalg.norm(way))
    return None if length <= _ALONG else np.asarray(way / length)
