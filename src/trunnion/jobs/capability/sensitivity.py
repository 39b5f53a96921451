"""Where the tool goes over a program when a number of the machine's geometry is not what its definition says."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem, Severity
from trunnion.jobs.capability.feed_samples import feed_samples
from trunnion.jobs.capability.tip_errors import TipErrors, in_radians, joints_at_zero, tip_errors, zero_pose
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.jobs.inputs.reading import FilePath, MachineLike, as_machine, as_run, read_toolpaths
from trunnion.jobs.inputs.settings import set_up_machine
from trunnion.jobs.observer import SILENT
from trunnion.machines.sensitivity import GeometryNumber, idle_numbers
from trunnion.model.run import Run
from trunnion.wording import counted

#: How far numbers are off unless it is said, mm and seconds of arc.
DEFAULT_LENGTH: Final = 0.01
DEFAULT_ANGLE: Final = 5.0

#: The most that they may be off: derivatives tell small errors only.
_MOST: Final = {"length": 10.0, "angle": 3600.0}


@dataclass(frozen=True, slots=True)
class ProgramPlace:
    """The block of a motion: ``line`` of ``file`` from 1, ``block`` its N number, -1 where it has none."""

    file: str
    line: int
    block: int


@dataclass(frozen=True, slots=True)
class ErrorExtent:
    """How far the tip is off over a program.

    largest  mm
    rms      root of the mean square over the motions, mm
    place    where it is farthest off
    """

    largest: float
    rms: float
    place: ProgramPlace


@dataclass(frozen=True, slots=True)
class NumberSensitivity:
    """What one number does to a program.

    number    of the machine's geometry
    amount    how far it is off, mm, or seconds of arc for an angle
    tip       how far the tip is off
    zeroed    how far it is still off when the workpiece zero was set with the same error; None: no zero was assumed
    axis_deg  how far the tool axis is off at most, degrees
    """

    number: GeometryNumber
    amount: float
    tip: ErrorExtent
    zeroed: ErrorExtent | None
    axis_deg: float

    @property
    def worst(self) -> ErrorExtent:
        """The error by which numbers are ranked: what is left once the zero is set, or all of it."""
        return self.tip if self.zeroed is None else self.zeroed


@dataclass(frozen=True, slots=True, eq=False)
class Sensitivity:
    """What each number of a machine's geometry does to a program, the worst one first.

    run      the program
    motions  how many of its motions are at feed; the others do not count
    numbers  all that can move the tool
    idle     those that cannot: a point along its own axis, a direction turned about itself
    zero_at  where the rotary axes stood when the workpiece zero was set, degrees by names; None: as the error is
    remarks  what was assumed
    length   how far lengths are off, mm
    angle    how far angles are off, seconds of arc
    """

    run: Run
    motions: int
    numbers: tuple[NumberSensitivity, ...]
    idle: tuple[GeometryNumber, ...]
    zero_at: Mapping[str, float] | None
    remarks: tuple[Problem, ...]
    length: float
    angle: float


def sensitivity(
    nc: FilePath | Run,
    *,
    machine: MachineLike,
    subprograms: Sequence[FilePath] = (),
    zero: str | Sequence[float] | None = None,
    tool_length: str | float | None = None,
    length: float = DEFAULT_LENGTH,
    angle: float = DEFAULT_ANGLE,
    zero_at: str | Mapping[str, float] | None = "home",
) -> Sensitivity:
    """Tell how far the tip is off over a program for each geometry number of the machine that is not true.

    Parameters
    ----------
    nc
        The program: a path, or its run (``trunnion.read_program``), which keeps the machine that it was read for.
    machine
        The machine that runs it: a name, a path or a ``Machine``.
    subprograms
        Files of the subprograms that it calls. No others are opened.
    zero : (3,) float, mm
        Workpiece zero on the machine. The errors of directions, and on tables those of points, depend on it.
    tool_length
        From the gauge point of the spindle to the tip, mm.
    length
        How far points, lengths and zeros are off, mm.
    angle
        How far directions and displayed angles are off, seconds of arc.
    zero_at
        Where the rotary axes stood when the workpiece zero was set by the tool or a probe: ``home``, or their values in
        degrees, such as ``"C=0,B=30"`` or a mapping. What the error is there is then in the zero, and only the rest of
        it is at the tip. ``none`` or None: nothing was set.

    Returns
    -------
    Sensitivity
        Each number with its largest error over the program and the place of it, the worst first.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or the program has no motion at feed.

    Notes
    -----
    The control works out axis values with the numbers of the definition, and the iron has others: the tip is off by the
    derivative of the forward map with respect to the number, times its error. Motions are judged at their ends, and
    within arcs and turns at least every 5 degrees.

    Examples
    --------
    >>> import trunnion
    >>> file = "tests/golden/yl569/3_blade_finish.expected.mpf"
    >>> found = trunnion.sensitivity(file, machine="yl569", zero=(0, 0, 100), tool_length=120)
    >>> found.numbers[0].number.name
    'gauge point X'
    """
    amounts = in_radians(_amount("length", length), _amount("angle", angle))
    loaded = set_up_machine(as_machine(machine), zero, tool_length)
    run = as_run(nc, loaded, subprograms)
    loaded = run.machine
    pose = zero_pose(loaded, zero_at)
    joints = None if pose is None else joints_at_zero(loaded, pose)
    totals: dict[GeometryNumber, _Total] = {}
    count = motions = 0
    for samples in feed_samples(run):
        count += len(samples.row)
        motions += int(np.count_nonzero(np.diff(samples.row, prepend=-1)))
        for found in tip_errors(loaded, samples.joints, joints, amounts):
            totals.setdefault(found.number, _Total(found.number)).add(found, samples.row)
    if not count:
        raise InputError(_without_cuts(run))
    numbers = [total.result(run, count, (length, angle)) for total in totals.values()]
    return Sensitivity(
        run,
        motions,
        tuple(sorted(numbers, key=lambda each: -each.worst.largest)),
        idle_numbers(loaded),
        pose,
        tuple(_remarks(run)),
        length,
        angle,
    )


def errors_over(found: Sensitivity, numbers: Sequence[GeometryNumber]) -> tuple[Ints, Floats]:
    """The rows at feed (k,), and how far the tip is off at most in each by some numbers, (k, m) float32, mm.

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
        """The totals; amounts as they are told, mm and seconds of arc."""
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
        place = ProgramPlace(run.files[run.state.file[row]], int(run.lines[row]), int(run.block_numbers[row]))
        return ErrorExtent(math.sqrt(max(self._largest, 0.0)), math.sqrt(self._squares / count), place)


def _without_cuts(run: Run) -> Problem:
    """Why there is nothing to judge: no cut, or a CL file in place of a program."""
    name = run.files[0] if run.files else "nc"
    if run.errors and _is_cl_file(name):
        return Problem(name, 0, "is a CL file, and no NC program", "post it, and give the program", code="RCH115")
    return Problem(name, 0, "has no motion at feed", "give a program that cuts", code="RCH110")


def _is_cl_file(name: str) -> bool:
    try:
        found = read_toolpaths(name, None, False, SILENT)
    except InputError:
        return False
    return any(len(operation.moves) for toolpath in found for operation in toolpath.operations)


def _amount(name: str, value: object) -> float:
    """How far numbers are off, checked."""
    if isinstance(value, int | float) and not isinstance(value, bool) and 0.0 < value <= _MOST[name]:
        return float(value)
    raise wrong_argument(name, value, f"give a number above 0, and at most {_MOST[name]:g}")


def _remarks(run: Run) -> list[Problem]:
    """What was assumed."""
    machine, file = run.machine, run.files[0] if run.files else "nc"
    found = []
    if run.errors:
        what = f"{counted(len(run.errors), 'place')} not understood, so motions may be wrong"
        found.append(Problem(file, run.errors[0].line, what, "verify the program first", code="RCH120"))
    if machine.workpiece_zero is None:
        what = "the workpiece zero is not known and counts as the zero of the machine"
        found.append(
            Problem(file, 0, what, "give argument zero=X,Y,Z: errors of directions depend on it", code="RCH130")
        )
    if machine.tool_length is None:
        what = "the tool length is not known and counts as 0"
        found.append(
            Problem(
                file, 0, what, "give argument tool_length=MM: the longer the tool, the larger its errors", code="RCH140"
            )
        )
    return [replace(each, severity=Severity.WARNING) for each in found]
