"""Follows two programs together and notes where they differ."""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.errors import Problem, first_of_kinds
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.basis import stated_texts
from trunnion.verification.comparison.control_rules import ControlRules
from trunnion.verification.comparison.moving_rows import MovingRows
from trunnion.verification.comparison.on_path import PointTolerances, ends_on_path
from trunnion.verification.comparison.path_events import PathEvents
from trunnion.verification.comparison.result import Alignment, Comparison, Difference, DifferentRows, UnknownWord
from trunnion.verification.comparison.rotary_ways import RotaryWays
from trunnion.verification.comparison.row_states import compared_states
from trunnion.verification.comparison.states import DifferentStretch, StateComparison
from trunnion.verification.matching.resync import find_resync
from trunnion.verification.row_ranges import CHUNK

#: Motions that are compared at first, and after each difference.
_FEW: Final = 64

#: How far ahead both programs are searched for a place at which they are the same again.
_WINDOWS: Final = (8, 64, 512)

#: Differences between paths that are looked into; after them the programs simply count as different.
_MAX_DIFFERENCES: Final = 1000

#: Differences that are kept with their places.
_MOST_NOTED: Final = 2000

#: Kinds of words that are not understood which a terminal shows.
_MOST_KINDS: Final = 10

_KINDS: Final = {Kind.RAPID: "rapid", Kind.LINEAR: "line", Kind.ARC: "circle"}


class Comparer:
    """Follows both programs together; ``i`` and ``j`` count their motions.

    rules     of either control
    left_out  rows of both that go to points that nobody knows; from there both may come in one leg or in several
    """

    def __init__(
        self,
        one: Run,
        two: Run,
        tolerances: PointTolerances,
        *,
        path: bool = False,
        rules: tuple[ControlRules, ControlRules],
        left_out: tuple[Flags | None, Flags | None] = (None, None),
    ) -> None:
        coolants: dict[str, int] = {}
        tools: dict[str, int] = {}
        same_machine = one.machine is two.machine or one.machine.key == two.machine.key
        same_frame = same_machine and _are_set_up_alike(one.machine, two.machine)
        self._one = MovingRows(one, same_frame, coolants, tools, left_out=left_out[0])
        self._two = MovingRows(two, same_frame, coolants, tools, left_out=left_out[1])
        most = rules[0].most_feed, rules[1].most_feed
        states = compared_states(self._one, self._two, path=path, most_feeds=most, tolerance=tolerances.tip)
        self._states = StateComparison(states)
        programs = () if path else (self._one, self._two)
        self._events = [
            PathEvents(each.run, each.rows, of_control.blocks, same_machine=same_machine)
            for each, of_control in zip(programs, rules, strict=False)
        ]
        self._ways = RotaryWays(one, two) if same_machine and not path else None
        self._tolerances = tolerances
        self._largest_tip = self._largest_axis = 0.0
        self._points = 0
        self._count = self._path_count = 0
        self._first: _PathDifference | DifferentStretch | None = None
        self._worst: _PathDifference | None = None
        # Kept by ``follow`` only: motions that go together, and the differences in the order of finding.
        self._together: list[tuple[int, int, int]] | None = None
        self._noted: list[_PathDifference | DifferentStretch] = []

    def follow(self) -> "Alignment":
        """Compare both programs to their ends, and return where they go together and where they differ."""
        self._together = []
        self.compare()
        one, two = self._one, self._two
        spans = [np.zeros((0, 2), np.int64)]
        for i, j, count in self._together:
            spans.append(np.column_stack([one.rows[i : i + count], two.rows[j : j + count]]))
        found = []
        for each in self._noted:
            rows = (_row(one, each.i), _row(two, each.j))
            found.append(DifferentRows(*rows, each.wording))
        return Alignment(np.concatenate(spans), tuple(found), self._count)

    def compare(self) -> Comparison:
        """Compare both programs to their ends."""
        one, two = self._one, self._two
        i = j = 0
        size = _FEW
        while i < len(one) and j < len(two) and self._path_count < _MAX_DIFFERENCES:
            count = min(size, len(one) - i, len(two) - j)
            same = self._same(i, j, count)
            length = count if same.all() else int(np.argmin(same))
            self._go_together(i, j, length)
            i, j = i + length, j + length
            if length == count:
                size = min(2 * size, CHUNK)
                continue
            size = _FEW
            if self._is_on_path(one, i, two, j):
                self._compare_states(i, j, 1)
                self._compare_events((i, j), (i + 1, j + 1))
                i += 1
            elif self._is_on_path(two, j, one, i):
                self._compare_states(i, j, 1)
                self._compare_events((i, j), (i + 1, j + 1))
                j += 1
            else:
                after = self._differ(i, j)
                self._compare_events((i, j), after)
                i, j = after
        if (i < len(one) or j < len(two)) and self._path_count < _MAX_DIFFERENCES:
            goes_on = Wording("comparison", "first_goes_on" if i < len(one) else "second_goes_on")
            self._note(i, j, float("inf"), goes_on)
        elif i == len(one) and j == len(two):
            self._compare_events((i, j), (i + 1, j + 1))
            self._compare_ways(i, j, *(np.array([len(each.run) - 1]) for each in (one, two)))
        return Comparison(
            programs=(one.run.files[0], two.run.files[0]),
            points=self._points,
            tip=self._largest_tip,
            axis=float(np.degrees(self._largest_axis)),
            count=self._count,
            first=self._difference(self._first),
            worst=self._difference(self._worst or self._first),
            unknown_words=_unknown_words(one.run, two.run),
            first_unknown=_first_unknown(one.run, two.run),
            stated=tuple(dict.fromkeys(word for each in (one, two) for word in stated_texts(each.run))),
        )

    def _same(self, i: int, j: int, count: int) -> Flags:
        """Which of ``count`` motions go the same way to the same point, (count,) bool."""
        one, two = self._one, self._two
        a, b = one.rows[i : i + count], two.rows[j : j + count]
        tip = np.abs(one.run.tip[a] - two.run.tip[b]).max(axis=1, initial=0.0)
        axis = np.sqrt(((one.run.axis[a] - two.run.axis[b]) ** 2).sum(axis=1))
        same = (tip <= self._tolerances.tip) & (axis <= self._tolerances.axis) & (one.run.kind[a] == two.run.kind[b])
        arcs = np.flatnonzero(same & (one.run.kind[a] == Kind.ARC))
        for k in arcs.tolist():
            same[k] = self._same_circle(i + k, j + k)
        if same.any():
            self._largest_tip = max(self._largest_tip, float(tip[same].max()))
            self._largest_axis = max(self._largest_axis, float(axis[same].max()))
        return np.asarray(same)

    def _go_together(self, i: int, j: int, count: int) -> None:
        """Take ``count`` motions that go to the same points, and compare what holds there."""
        one, two = self._one, self._two
        if count and self._together is not None:
            self._together.append((i, j, count))
        a, b = one.rows[i : i + count], two.rows[j : j + count]
        moves = one.moves[i : i + count] | two.moves[j : j + count]
        self._points += int(np.count_nonzero(moves & (one.in_machine(a) == two.in_machine(b))))
        self._compare_states(i, j, count)
        self._compare_ways(i, j, a, b)
        motions = {
            motion - first
            for events, first in zip(self._events, (i, j), strict=False)
            for motion in events.motions_in(first, first + count)
        }
        for k in sorted(motions):
            self._compare_events((i + k, j + k), (i + k + 1, j + k + 1))

    def _compare_events(self, begin: tuple[int, int], end: tuple[int, int]) -> None:
        """Compare the events of both programs in motions that begin at the same place."""
        if not self._events:
            return
        one, two = (events.take(first, last) for events, first, last in zip(self._events, begin, end, strict=True))
        if {said: len(each) for said, each in one.items()} != {said: len(each) for said, each in two.items()}:
            self._count += 1
            said = Wording("comparison", "events", one=_alone(one, two), two=_alone(two, one))
            self._note_first(_PathDifference(*begin, 0.0, said))

    def _compare_states(self, i: int, j: int, count: int) -> None:
        a, b = self._one.rows[i : i + count], self._two.rows[j : j + count]
        for stretch in self._states.follow(i, j, a, b):
            self._count += 1
            self._note_first(stretch)

    def _compare_ways(self, i: int, j: int, a: Ints, b: Ints) -> None:
        for k, said in self._ways.follow(a, b) if self._ways else ():
            self._count += 1
            self._note_first(_PathDifference(i + k, j + k, 0.0, said))

    def _same_circle(self, i: int, j: int) -> bool:
        one, two = self._one.circle(i), self._two.circle(j)
        if one is None or two is None or self._one.full_turns(i) != self._two.full_turns(j):
            return False
        apart = one[0] - two[0]
        apart = apart - (apart @ one[1]) * one[1]
        return bool(np.abs(apart).max() <= 2.0 * self._tolerances.tip and one[1] @ two[1] > 1.0 - 1e-6)

    def _is_on_path(self, more: MovingRows, i: int, less: MovingRows, j: int) -> bool:
        """Whether motion ``i`` is an additional point on the path of the other's motion ``j``."""
        if more.run.kind[more.rows[i]] != less.run.kind[less.rows[j]]:
            return False
        if more.comes_from_above(i, less.run.tip[less.rows[j]], self._tolerances.tip) and less.comes_from_anywhere(j):
            return True
        return ends_on_path(more, i, less, j, self._tolerances)

    def _differ(self, i: int, j: int) -> tuple[int, int]:
        """Note a difference, and find where the programs are the same again: the next motions of both."""
        one, two = self._one, self._two
        for window in _WINDOWS:
            a, b = one.rows[i : i + window], two.rows[j : j + window]
            fits = np.ones((len(a), len(b)), np.bool_)
            for c in range(3):
                fits &= np.abs(one.run.tip[a, c][:, None] - two.run.tip[b, c]) <= self._tolerances.tip
                fits &= np.abs(one.run.axis[a, c][:, None] - two.run.axis[b, c]) <= self._tolerances.axis
            if fits[0, 0]:
                self._note(i, j, 0.0, self._difference_in_way(int(a[0]), int(b[0])))
                return i + 1, j + 1
            found = find_resync(fits, (len(a) < window, len(b) < window))
            if found is not None:
                break
        else:
            found = (len(one) - i, len(two) - j)
        self._note_unequal(i, j, *found)
        return i + found[0], j + found[1]

    def _note_unequal(self, i: int, j: int, a: int, b: int) -> None:
        """Note the differences of ``a`` and ``b`` motions before the programs are the same again."""
        one, two = self._one, self._two
        for k in range(min(max(min(a, b), 1), _MAX_DIFFERENCES)):
            if i + k >= len(one) or j + k >= len(two):
                break
            if a == b and self._same(i + k, j + k, 1)[0]:
                self._go_together(i + k, j + k, 1)
                continue
            p, q = int(one.rows[i + k]), int(two.rows[j + k])
            apart = float(np.linalg.norm(one.run.tip[p] - two.run.tip[q]))
            angle = float(np.degrees(np.linalg.norm(one.run.axis[p] - two.run.axis[q])))
            said = Wording("comparison", "tips_apart", apart=apart, angle=angle)
            if a != b:
                variant = "first_has_more" if a > b else "second_has_more"
                said = Wording("comparison", variant, difference=said, count=abs(a - b))
            self._note(i + k, j + k, apart + angle, said)
            if a != b:
                break

    def _difference_in_way(self, a: int, b: int) -> Wording:
        """Return what differs between row ``a`` and row ``b``, which go to the same point another way."""
        kinds = [Kind(int(run.kind[row])) for run, row in ((self._one.run, a), (self._two.run, b))]
        if kinds[0] != kinds[1]:
            one, two = (Wording("comparison", _KINDS[kind]) for kind in kinds)
            return Wording("comparison", "kinds", one=one, two=two)
        return Wording("comparison", "other_circles")

    def _note(self, i: int, j: int, value: float, said: Wording) -> None:
        """Note a difference between the paths."""
        self._count += 1
        self._path_count += 1
        if self._ways:
            self._ways.forget()
        place = _PathDifference(i, j, value, said)
        self._note_first(place)
        if self._worst is None or value > self._worst.value:
            self._worst = place

    def _note_first(self, found: "_PathDifference | DifferentStretch") -> None:
        if self._together is not None and len(self._noted) < _MOST_NOTED:
            self._noted.append(found)
        if self._first is None or (found.i, found.j) < (self._first.i, self._first.j):
            self._first = found

    def _difference(self, found: "_PathDifference | DifferentStretch | None") -> Difference | None:
        if found is None:
            return None
        blocks = self._one.block_name(found.i), self._two.block_name(found.j)
        if isinstance(found, _PathDifference):
            return Difference(*blocks, found.value, found.wording)
        said = found.wording
        if found.last != (found.i, found.j):
            one, two = self._one.block_name(found.last[0]), self._two.block_name(found.last[1])
            said = said.within("up_to", one=one, two=two)
        return Difference(*blocks, 0.0, said)


@dataclass(frozen=True, slots=True, eq=False)
class _PathDifference:
    """A difference between the paths, at motion ``i`` of the first program and ``j`` of the second."""

    i: int
    j: int
    value: float
    wording: Wording


def _are_set_up_alike(one: Machine, two: Machine) -> bool:
    """Whether positions of both in the machine's frame are positions in one frame of the workpiece."""
    return one.workpiece_zero == two.workpiece_zero and one.tool_length == two.tool_length and one.zeros == two.zeros


def _alone(one: dict[str, list[Wording]], two: dict[str, list[Wording]]) -> tuple[Wording, ...]:
    """Return what stands in one program only, or more often than in the other."""
    alone = [said for text, each in one.items() for said in each[len(two.get(text, ())) :]]
    return tuple(alone) or (Wording("comparison", "nothing"),)


def _row(program: MovingRows, motion: int) -> int:
    """Return the row of a motion; the last one if the program has ended."""
    return int(program.rows[motion]) if motion < len(program) else max(len(program.run) - 1, 0)


def _unknown_words(one: Run, two: Run) -> tuple[str, ...]:
    """Words that are not understood: what they do may depend on all that comes before, so that they prove nothing."""
    return tuple(UnknownWord(each.file, each.line, each.wording).line_of() for run in (one, two) for each in run.errors)


def _first_unknown(one: Run, two: Run) -> tuple[tuple[UnknownWord, ...], int]:
    """Return the first of each kind of words that are not understood, and how many there are of further kinds."""
    errors = [Problem(each.file, each.line, each.wording) for run in (one, two) for each in run.errors]
    shown, left = first_of_kinds(errors, _MOST_KINDS)
    return tuple(UnknownWord(each.file, each.line, each.wording) for each in shown), left
