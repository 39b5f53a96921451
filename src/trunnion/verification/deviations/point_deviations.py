"""How far the program is from its CL points: the tip in each coordinate, the tool axis in each rotary axis.

In:     a run, the expected path, and their matching.
Out:    two deviations for each pair; the largest of them and their root mean square.
Units:  mm and degrees.
"""

import math
from bisect import bisect_right

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.machines import Machine
from trunnion.model.run import RowPositions
from trunnion.records import dataclass
from trunnion.verification.expected.path import ExpectedPath, Section
from trunnion.verification.kinematics.axis_difference import RotaryGeometry, RotaryPair, axis_difference, degrees_apart
from trunnion.verification.matching.pairs import Matching


@dataclass(frozen=True, slots=True, eq=False)
class DeviationSummary:
    """Deviations of one kind.

    largest  the deviation that takes the largest share of its tolerance
    rms      root mean square of all, of the same quantity
    limit    that tolerance
    bad      pairs beyond their tolerance as (pair, deviation): the worst, worst first, and the first of all
    count    how many pairs are beyond it
    """

    largest: float
    rms: float
    limit: float
    bad: tuple[tuple[int, float], ...]
    count: int


class PointDeviations:
    """Collects the deviations of all pairs, chunk by chunk; up to ``max_rows`` bad pairs are kept.

    ``by_vector`` (n,) says which rows of the run get their tool axis from a vector.
    """

    def __init__(
        self, machine: Machine, expected: ExpectedPath, matching: Matching, max_rows: int, by_vector: Flags
    ) -> None:
        self._expected, self._matching, self._by_vector = expected, matching, by_vector
        self._tip, self._axis = _Collector(max_rows), _Collector(max_rows)
        self._geometry = RotaryGeometry.of(machine)
        self._ends = [matching.cl.count_before(section.end) for section in expected.sections]

    def add(self, first: int, end: int, positions: RowPositions) -> None:
        """Add the pairs of the rows from ``first`` on, in order; ``positions`` is the ``Run.chunk`` of them."""
        start, stop = self._matching.nc.count_before(first), self._matching.nc.count_before(end)
        while start < stop:
            k = bisect_right(self._ends, start)
            count = min(stop, self._ends[k]) - start
            self._compare(start, count, first, positions, self._expected.sections[k])
            start += count

    def _compare(self, start: int, count: int, first: int, positions: RowPositions, section: Section) -> None:
        """Add ``count`` pairs from pair ``start`` on, all of one operation."""
        geometry, moves, tolerances = self._geometry, section.operation.moves, section.tolerances
        row = self._matching.nc.rows(start, start + count)
        nc, cl = row - (first - 1), self._matching.cl.rows(start, start + count) - section.first
        off_tip, off_axis = np.empty(count), np.empty(count)
        compare_rows(
            positions.tip, positions.axis, positions.joints, moves.tip, moves.axis, nc, cl, geometry.column,
            geometry.pair, off_tip, off_axis,
        )  # fmt: skip
        by_vector = self._by_vector[row]
        if by_vector.any():  # a programmed vector is off by an angle, not in rotary axes
            off_axis[by_vector] = degrees_apart(positions.axis[nc[by_vector]], moves.axis[cl[by_vector]])
        if tolerances.plane:
            beyond = np.flatnonzero(off_axis > tolerances.angle)
            angle = degrees_apart(positions.axis[nc[beyond]], moves.axis[cl[beyond]])
            off_axis[beyond] = np.minimum(angle, off_axis[beyond])
        self._tip.add(start, off_tip, tolerances.tip)
        self._axis.add(start, off_axis, tolerances.angle)

    def result(self) -> tuple[DeviationSummary, DeviationSummary]:
        """Tip and tool axis, once all rows have been added."""
        return self._tip.summary(), self._axis.summary()


class _Collector:
    """Collects the worst deviations of many chunks."""

    def __init__(self, max_rows: int) -> None:
        self._max_rows = max_rows
        self._squares = 0.0
        self._pairs = 0
        self._count = 0
        self._first: tuple[int, float] | None = None
        self._bad: list[tuple[int, float]] = []
        self._worst_share = -1.0
        self._largest = self._limit = 0.0

    def add(self, start: int, off: Floats, limit: float) -> None:
        """Add a chunk: deviations of the pairs from ``start`` on."""
        self._squares += float(off @ off)
        self._pairs += len(off)
        k = int(np.argmax(off))
        share = float(off[k]) / limit if limit else float(off[k])
        if share > self._worst_share:
            self._worst_share, self._largest, self._limit = share, float(off[k]), limit
        if off[k] <= limit:
            return
        bad = np.flatnonzero(~(off <= limit))
        self._count += len(bad)
        if self._first is None:
            self._first = start + int(bad[0]), float(off[bad[0]])
        order = bad[np.argsort(-off[bad], kind="stable")[: self._max_rows]]
        self._bad += [(start + int(k), float(off[k])) for k in order]
        self._bad = sorted(self._bad, key=lambda pair: -pair[1])[: self._max_rows]

    def summary(self) -> DeviationSummary:
        """Everything together."""
        bad = self._bad
        if self._first is not None and self._first not in bad:
            bad = [*bad, self._first]
        rms = math.sqrt(self._squares / max(self._pairs, 1))
        return DeviationSummary(self._largest, rms, self._limit, tuple(bad), self._count)


@kernel(writes="off_tip off_axis")
def compare_rows(
    nc_tip: Floats2,
    nc_axis: Floats2,
    joints: Floats2,
    cl_tip: Floats2,
    cl_axis: Floats2,
    nc: Ints,
    cl: Ints,
    column: int,
    pair: RotaryPair,
    off_tip: Floats,
    off_axis: Floats,
) -> None:
    """Write the largest deviation of each pair in X, Y or Z (mm) and in either rotary axis (deg).

    ``column`` is that of ``RotaryGeometry``.
    """
    for k in range(nc.shape[0]):
        i, j = nc[k], cl[k]
        dx = nc_tip[i, 0] - cl_tip[j, 0]
        dy = nc_tip[i, 1] - cl_tip[j, 1]
        dz = nc_tip[i, 2] - cl_tip[j, 2]
        largest = max(abs(dx), abs(dy), abs(dz))
        off_tip[k] = largest if largest == largest else np.inf
        _, off_axis[k] = axis_difference(nc_axis, i, cl_axis, j, joints[i, column], pair)
