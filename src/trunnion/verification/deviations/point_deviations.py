"""How far the program is from its CL points: the tip in each coordinate, the tool axis in each rotary axis.

In:     a run, what was wanted, and which rows answer to which.
Out:    per pair two deviations, largest and root mean square of them.
Units:  mm and degrees.

The difference of two tool axes is split along the two directions into which the rotary axes turn the tool where it
stands. That says what each rotary axis is off by, with the forward map alone, and leaves out an angle that is free.
"""

import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.jit import njit
from trunnion.machines import Machine
from trunnion.model.run import ProgrammedWord, RowPositions
from trunnion.verification.expected.path import ExpectedPath, Section

if TYPE_CHECKING:
    from trunnion.verification.matching.path_matching import Matching

#: What the two maps, there and back, may differ by, rad.
_NOISE: Final = 1e-11

#: Square degrees in a square radian.
_SQUARE_DEGREES: Final = (180.0 / math.pi) ** 2

#: What the seven decimals of CL files leave open at a pole and at the edge of what the rotary axes reach, rad.
_OPEN: Final = 1.1e-7


@dataclass(frozen=True, slots=True, eq=False)
class DeviationSummary:
    """Deviations of one kind; ``excess`` is how much of what is allowed the worst takes, pair ``k`` the worst itself.

    bad      pairs that are off by more than is allowed: the first of them, and the worst, worst first
    count    how many there are
    """

    largest: float
    rms: float
    limit: float
    excess: float
    worst: int
    bad: tuple[tuple[int, float], ...]
    count: int


class PointDeviations:
    """Tip and tool axis of all pairs, gathered as a run goes by; of what is off, ``max_rows`` pairs are named."""

    def __init__(
        self, machine: Machine, expected: ExpectedPath, matching: "Matching", max_rows: int, programmed: Codes
    ) -> None:
        self._wanted, self._pairs, self._programmed = expected, matching, programmed
        self._tip, self._axis = _Gatherer(max_rows), _Gatherer(max_rows)
        self._frame = RotaryGeometry.of(machine)
        self._ends = [matching.cl.before(section.end) for section in expected.sections]

    def take(self, first: int, end: int, poses: RowPositions) -> None:
        """Add the pairs of the rows from ``first`` on, in order; ``poses`` is the ``Run.stretch`` of them."""
        start, stop = self._pairs.nc.before(first), self._pairs.nc.before(end)
        while start < stop:
            k = bisect_right(self._ends, start)
            count = min(stop, self._ends[k]) - start
            self._compare(start, count, first, poses, self._wanted.sections[k])
            start += count

    def _compare(self, start: int, count: int, first: int, poses: RowPositions, section: Section) -> None:
        """Matching of one operation."""
        frame, moves = self._frame, section.operation.moves
        nc = self._pairs.nc.part(start, start + count) - (first - 1)
        cl = self._pairs.cl.part(start, start + count) - section.first
        off_tip, off_axis = np.empty(count), np.empty(count)
        squares = compare_rows(
            poses.tip, poses.axis, poses.joints, moves.tip, moves.axis, nc, cl, frame.column, frame.sense, frame.first,
            frame.second, off_tip, off_axis,
        )  # fmt: skip
        said = (self._programmed[nc + (first - 1)] & int(ProgrammedWord.VECTOR)) != 0
        if said.any():  # a tool axis that is said as a vector is off by an angle of its own
            apart = np.linalg.norm(poses.axis[nc[said]] - moves.axis[cl[said]], axis=1)
            off_axis[said] = np.degrees(2.0 * np.arcsin(np.minimum(0.5 * apart, 1.0)))
        beyond = (
            np.flatnonzero(off_axis > section.tolerances.angle) if section.tolerances.plane else np.zeros(0, np.int64)
        )
        if len(beyond):
            apart = np.linalg.norm(poses.axis[nc[beyond]] - moves.axis[cl[beyond]], axis=1)
            angle = np.degrees(2.0 * np.arcsin(np.minimum(0.5 * apart, 1.0)))
            off_axis[beyond] = np.minimum(angle, off_axis[beyond])
        self._tip.take(start, off_tip, squares[0], section.tolerances.tip)
        self._axis.take(start, off_axis, squares[1], section.tolerances.angle)

    def result(self) -> tuple[DeviationSummary, DeviationSummary]:
        """Tip and tool axis, when all rows have gone by."""
        return self._tip.off(), self._axis.off()


class _Gatherer:
    """Collects the worst of many chunks."""

    def __init__(self, max_rows: int) -> None:
        self._named = max_rows
        self._squares = 0.0
        self._rows = 0
        self._count = 0
        self._first: tuple[int, float] | None = None
        self._bad: list[tuple[int, float]] = []
        self._worst = (-1.0, 0.0, 0.0, 0)

    def take(self, start: int, off: Floats, squares: float, limit: float) -> None:
        """Add a chunk: deviations of the pairs from ``start`` on, and the sum of their squares."""
        self._squares += squares
        self._rows += len(off)
        k = int(np.argmax(off))
        excess = float(off[k]) / limit if limit else float(off[k])
        if excess > self._worst[0]:
            self._worst = excess, float(off[k]), limit, start + k
        if off[k] <= limit:
            return
        bad = np.flatnonzero(~(off <= limit))
        self._count += len(bad)
        if self._first is None:
            self._first = start + int(bad[0]), float(off[bad[0]])
        order = bad[np.argsort(-off[bad], kind="stable")[: self._named]]
        self._bad += [(start + int(k), float(off[k])) for k in order]
        self._bad = sorted(self._bad, key=lambda place: -place[1])[: self._named]

    def off(self) -> DeviationSummary:
        """Everything together."""
        excess, largest, limit, worst = self._worst
        bad = self._bad
        if self._first is not None and self._first not in bad:
            bad = [*bad, self._first]
        rms = math.sqrt(self._squares / max(self._rows, 1))
        return DeviationSummary(largest, rms, limit, excess, worst, tuple(bad), self._count)


@dataclass(frozen=True, slots=True, eq=False)
class RotaryGeometry:
    """The rotary axes of a machine, for kernels.

    column   column in ``joints`` of the rotary axis next to the workpiece
    sense    1 or -1, how its values turn it
    first    (3,) its direction, with all axes at zero
    second   (3,) the direction of the other one
    """

    column: int
    sense: float
    first: Floats
    second: Floats

    @staticmethod
    def of(machine: Machine) -> "RotaryGeometry":
        """From a definition."""
        first, second = machine.rotary
        one, two = machine.axes[first], machine.axes[second]
        return RotaryGeometry(first, one.sense, np.array(one.direction), np.array(two.direction))


@njit(cache=True, nogil=True)
def compare_rows(
    nc_tip: Floats,
    nc_axis: Floats,
    joints: Floats,
    cl_tip: Floats,
    cl_axis: Floats,
    nc: Ints,
    cl: Ints,
    column: int,
    sense: float,
    first: Floats,
    second: Floats,
    off_tip: Floats,
    off_axis: Floats,
) -> tuple[float, float]:
    """Write the largest deviation of each pair in X, Y or Z (mm) and in either rotary axis (deg).

    Returns the sums of squared distances: of tips in mm, of tool axes in degrees.
    """
    squares_tip = 0.0
    squares_axis = 0.0
    for k in range(nc.shape[0]):
        i, j = nc[k], cl[k]
        dx = nc_tip[i, 0] - cl_tip[j, 0]
        dy = nc_tip[i, 1] - cl_tip[j, 1]
        dz = nc_tip[i, 2] - cl_tip[j, 2]
        squares_tip += dx * dx + dy * dy + dz * dz
        largest = max(abs(dx), abs(dy), abs(dz))
        off_tip[k] = largest if largest == largest else np.inf
        angle, off_axis[k] = axis_difference(nc_axis, i, cl_axis, j, joints[i, column], sense, first, second)
        squares_axis += angle * angle
    return squares_tip, squares_axis * _SQUARE_DEGREES


@njit(cache=True, nogil=True)
def axis_difference(
    is_: Floats, i: int, want: Floats, j: int, value: float, sense: float, first: Floats, second: Floats
) -> tuple[float, float]:
    """Angle between two tool axes, rad, and what either rotary axis is off by for that, degrees.

    ``value`` is that of the rotary axis next to the workpiece under the tool axis ``is_[i]``, degrees; ``sense``,
    ``first`` and ``second`` are as in ``RotaryGeometry``. An angle that is free is left out.
    """
    w0, w1, w2 = first[0], first[1], first[2]
    v0, v1, v2 = second[0], second[1], second[2]
    a0, a1, a2 = is_[i, 0], is_[i, 1], is_[i, 2]
    e0, e1, e2 = a0 - want[j, 0], a1 - want[j, 1], a2 - want[j, 2]
    chord = e0 * e0 + e1 * e1 + e2 * e2
    if not chord > _NOISE * _NOISE:
        return (math.sqrt(chord), 0.0) if chord == chord else (0.0, np.inf)
    # The angle of a small chord is the chord itself, to the eleventh digit.
    angle = math.sqrt(chord) if chord < 1e-10 else 2.0 * math.asin(min(0.5 * math.sqrt(chord), 1.0))
    if chord > 1e-4:  # not a small difference any more: the angle itself
        return angle, math.degrees(angle)
    # The second axis where the first has turned it to, and the ways into which both turn the tool.
    q = math.radians(sense * value)
    cos, sin = math.cos(q), math.sin(q)
    rest = (w0 * v0 + w1 * v1 + w2 * v2) * (1.0 - cos)
    s0 = v0 * cos + (w1 * v2 - w2 * v1) * sin + w0 * rest
    s1 = v1 * cos + (w2 * v0 - w0 * v2) * sin + w1 * rest
    s2 = v2 * cos + (w0 * v1 - w1 * v0) * sin + w2 * rest
    p0, p1, p2 = w1 * a2 - w2 * a1, w2 * a0 - w0 * a2, w0 * a1 - w1 * a0
    r0, r1, r2 = s1 * a2 - s2 * a1, s2 * a0 - s0 * a2, s0 * a1 - s1 * a0
    pp = p0 * p0 + p1 * p1 + p2 * p2
    pr = p0 * r0 + p1 * r1 + p2 * r2
    rr = r0 * r0 + r1 * r1 + r2 * r2
    pe = p0 * e0 + p1 * e1 + p2 * e2
    re = r0 * e0 + r1 * e1 + r2 * e2
    volume = pp * rr - pr * pr
    if volume < 1e-5 * pp * rr or pp < 1e-12 or rr < 1e-12:
        # At a pole, or at the edge of what the axes reach: what each of them is off by cannot be told apart.
        return angle, math.degrees(max(angle - _OPEN, 0.0) / (math.sqrt(pp) + math.sqrt(rr)))
    one, two = abs((rr * pe - pr * re) / volume), abs((pp * re - pr * pe) / volume)
    # The split is one of small turns: products of both, which grow towards the pole, are left open.
    height = abs(w0 * a0 + w1 * a1 + w2 * a2)
    first_off = one * (1.0 - two * height / math.sqrt(pp)) - _NOISE / math.sqrt(pp)
    second_off = two - 0.5 * one * one - _NOISE / math.sqrt(rr)
    return angle, math.degrees(max(first_off, second_off, 0.0))
