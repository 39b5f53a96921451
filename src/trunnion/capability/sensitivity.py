"""How far the tip is off over a program by each number of the machine's geometry.

In:     a ``Run`` on its machine, and how far the numbers are off.
Out:    a ``Sensitivity``, the worst number first.
Units:  mm, seconds of arc, degrees; workpiece frame.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter
from typing import Annotated, ClassVar

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.capability.feed_samples import feed_samples
from trunnion.capability.tip_errors import TipErrors, in_radians, joints_at_zero, tip_errors
from trunnion.errors import Problem
from trunnion.machines.sensitivity import GeometryNumber, idle_numbers
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, BlockNumber, Figure
from trunnion.verification.grounds import NO_GROUNDS, Grounded, Grounds


@dataclass(frozen=True, slots=True)
class BlockPlace:
    """The block of a motion: ``line`` of ``file`` from 1, ``block`` its N number, -1 where it has none."""

    file: str
    line: int
    block: BlockNumber


@dataclass(frozen=True, slots=True)
class ErrorExtent:
    """How far the tip is off over a program.

    largest  mm
    rms      root of the mean square over the motions, mm
    place    where it is farthest off
    """

    largest: Annotated[float, Figure(unit="mm", decimals=9)]
    rms: Annotated[float, Figure(unit="mm", decimals=9)]
    place: Annotated[BlockPlace, Figure(is_flat=True)]


@dataclass(frozen=True, slots=True)
class NumberSensitivity:
    """What one number does to a program.

    number    of the machine's geometry
    amount    how far it is off, mm, or seconds of arc for an angle
    tip       how far the tip is off
    zeroed    how far it is still off when the workpiece zero was set with the same error; None: no zero was assumed
    axis_deg  how far the tool axis is off at most, degrees
    """

    number: Annotated[
        GeometryNumber,
        Figure(take=attrgetter("name")),
        Figure("axis", take=attrgetter("axis")),
        Figure("component", take=attrgetter("component")),
        Figure("key", take=attrgetter("key")),
        Figure("unit", take=lambda number: "arcsec" if number.is_angle else "mm", after="off_by"),
    ]
    amount: Annotated[float, Figure("off_by")]
    tip: ErrorExtent
    zeroed: Annotated[ErrorExtent | None, Figure("with_zero_set")]
    axis_deg: Annotated[float, Figure(decimals=9)]

    @property
    def worst(self) -> ErrorExtent:
        """The error by which numbers are ranked: what is left once the zero is set, or all of it."""
        return self.tip if self.zeroed is None else self.zeroed


@dataclass(frozen=True, slots=True, eq=False)
class Sensitivity(Grounded):
    """What each number of a machine's geometry does to a program, the worst one first.

    run      the program
    motions  how many of its motions are at feed; the others do not count
    numbers  all that can move the tool
    idle     those that cannot: a point along its own axis, a direction turned about itself
    zero_at  where the rotary axes stood when the workpiece zero was set, degrees by names; None: as the error is
    remarks  what was assumed
    length   how far lengths are off, mm
    angle    how far angles are off, seconds of arc
    grounds  what it stands on besides the program
    """

    SCHEMA: ClassVar[int] = 2

    run: Annotated[
        Run,
        Figure("program", take=lambda run: run.files[0]),
        Figure("machine", take=attrgetter("machine.key")),
    ]
    motions: int
    numbers: tuple[NumberSensitivity, ...]
    idle: Annotated[
        tuple[GeometryNumber, ...], Figure("without_effect", take=lambda idle: [each.name for each in idle])
    ]
    zero_at: Annotated[Mapping[str, float] | None, Figure(unit="deg", after="motions")]
    remarks: tuple[Problem, ...]
    length: Annotated[float, NOT_DATA]
    angle: Annotated[float, NOT_DATA]
    grounds: Annotated[Grounds, Figure(is_flat=True)] = NO_GROUNDS


def program_sensitivity(
    run: Run,
    zero_at: Mapping[str, float] | None,
    length: float,
    angle: float,
    remarks: tuple[Problem, ...] = (),
    advance: Callable[[int], None] = lambda motions: None,
) -> Sensitivity:
    """Judge a program; ``zero_at`` as in ``Sensitivity``. There are no numbers where nothing moves at feed.

    ``advance`` is called now and then with how many further motions are judged.
    """
    machine = run.machine
    amounts = in_radians(length, angle)
    joints = None if zero_at is None else joints_at_zero(machine, zero_at)
    totals: dict[GeometryNumber, _Total] = {}
    count = motions = done = 0
    for samples in feed_samples(run):
        count += len(samples.row)
        motions += int(np.count_nonzero(np.diff(samples.row, prepend=-1)))
        for found in tip_errors(machine, samples.joints, joints, amounts):
            totals.setdefault(found.number, _Total(found.number)).add(found, samples.row)
        if len(samples.row):
            advance(int(samples.row[-1]) + 1 - done)
            done = int(samples.row[-1]) + 1
    numbers = [total.result(run, count, (length, angle)) for total in totals.values()] if count else []
    ranked = tuple(sorted(numbers, key=lambda each: -each.worst.largest))
    return Sensitivity(run, motions, ranked, idle_numbers(machine), zero_at, remarks, length, angle)


def errors_over(found: Sensitivity, numbers: Sequence[GeometryNumber]) -> tuple[Ints, Floats]:
    """Return the rows at feed (k,), and how far the tip is off at most in each by some numbers, (k, m) float32, mm.

    With the zero set, where it was.
    """
    run, at = found.run, {number: k for k, number in enumerate(numbers)}
    joints = None if found.zero_at is None else joints_at_zero(run.machine, found.zero_at)
    amounts = in_radians(found.length, found.angle)
    rows, errors = [np.zeros(0, np.int64)], [np.zeros((0, len(numbers)), np.float32)]
    for samples in feed_samples(run):
        starts = np.flatnonzero(np.diff(samples.row, prepend=-1))
        part = np.zeros((len(starts), len(numbers)), np.float32)
        for each in tip_errors(run.machine, samples.joints, joints, amounts):
            if each.number in at:
                size = np.linalg.norm(each.tip if each.left is None else each.left, axis=1)
                part[:, at[each.number]] = np.maximum.reduceat(size, starts)
        rows.append(samples.row[starts])
        errors.append(part)
    return np.concatenate(rows), np.concatenate(errors)


class _Total:
    """What is found over all chunks for one number."""

    def __init__(self, number: GeometryNumber) -> None:
        self._number = number
        self._tip, self._left = _Extent(), _Extent()
        self._axis = 0.0
        self._is_zeroed = False

    def add(self, errors: TipErrors, rows: Ints) -> None:
        """Count the errors of some rows."""
        self._tip.add(errors.tip, rows)
        if errors.left is not None:
            self._is_zeroed = True
            self._left.add(errors.left, rows)
        if len(rows):
            self._axis = max(self._axis, float(np.linalg.norm(errors.axis, axis=1).max()))

    def result(self, run: Run, count: int, amounts: tuple[float, float]) -> NumberSensitivity:
        """Return the totals; amounts as they are told, mm and seconds of arc."""
        return NumberSensitivity(
            self._number,
            amounts[self._number.is_angle],
            self._tip.result(run, count),
            self._left.result(run, count) if self._is_zeroed else None,
            math.degrees(self._axis),
        )


class _Extent:
    """The largest length of vectors, its row, and the sum of squares."""

    def __init__(self) -> None:
        self._largest, self._row, self._squares = -1.0, 0, 0.0

    def add(self, vectors: Floats, rows: Ints) -> None:
        if not len(rows):
            return
        squares = np.einsum("ni,ni->n", vectors, vectors)
        worst = int(np.argmax(squares))
        self._squares += float(squares.sum())
        if squares[worst] > self._largest:
            self._largest, self._row = float(squares[worst]), int(rows[worst])

    def result(self, run: Run, count: int) -> ErrorExtent:
        row = self._row
        place = BlockPlace(run.files[run.state.file[row]], int(run.lines[row]), int(run.block_numbers[row]))
        return ErrorExtent(math.sqrt(max(self._largest, 0.0)), math.sqrt(self._squares / count), place)
