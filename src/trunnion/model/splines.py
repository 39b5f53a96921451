"""Splines as columns: what they are, beside the points that stand for them.

Lengths are in mm, in the coordinates of the points.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, make_read_only
from trunnion.records import dataclass


class Spline(NamedTuple):
    """One B-spline, rational where its weights differ.

    degree  of its polynomials
    knots   (n + degree + 1,) float64  with their multiplicities; it goes from ``knots[degree]`` to ``knots[n]``
    poles   (n, 3) float64  control points, mm
    weights (n,) float64    of the control points, more than 0
    """

    degree: int
    knots: Floats
    poles: Floats
    weights: Floats

    @property
    def is_rational(self) -> bool:
        """Whether the weights differ."""
        return bool((self.weights != self.weights[0]).any())

    @property
    def spans(self) -> Ints:
        """(s,) int64: the knots at which its polynomials begin, those between equal knots left out."""
        inner = self.knots[self.degree : len(self.poles) + 1]
        return self.degree + np.flatnonzero(np.diff(inner) > 0.0)


class SplineRows(NamedTuple):
    """A spline and the rows of its points: ``first`` is the one behind its start, ``last`` that of its end."""

    first: int
    last: int
    spline: Spline


@dataclass(frozen=True, slots=True, eq=False)
class Splines:
    """The splines of one operation, or of a run, in row order. Rows ``first`` to ``last`` are lines that stand for one.

    first       (m,) int64      row of the first point behind its start, which is the point before
    last        (m,) int64      row of its end
    degree      (m,) int64
    pole_begin  (m + 1,) int64  where its control points begin in ``poles``
    knot_begin  (m + 1,) int64  where its knots begin in ``knots``
    poles       (p, 3) float64  mm
    weights     (p,) float64
    knots       (k,) float64
    """

    first: Ints
    last: Ints
    degree: Ints
    pole_begin: Ints
    knot_begin: Ints
    poles: Floats
    weights: Floats
    knots: Floats

    def __post_init__(self) -> None:
        make_read_only(self.first, self.last, self.degree, self.pole_begin, self.knot_begin)
        make_read_only(self.poles, self.weights, self.knots)

    def __len__(self) -> int:
        return len(self.first)

    def __getitem__(self, k: int) -> SplineRows:
        if not 0 <= k < len(self):
            raise IndexError(k)
        poles = slice(int(self.pole_begin[k]), int(self.pole_begin[k + 1]))
        knots = slice(int(self.knot_begin[k]), int(self.knot_begin[k + 1]))
        spline = Spline(int(self.degree[k]), self.knots[knots], self.poles[poles], self.weights[poles])
        return SplineRows(int(self.first[k]), int(self.last[k]), spline)

    @staticmethod
    def of(each: Sequence[SplineRows]) -> "Splines":
        """Return the columns of single splines, in row order."""
        if not each:
            return Splines.empty()
        splines = [one.spline for one in each]
        return Splines(
            np.array([one.first for one in each], np.int64),
            np.array([one.last for one in each], np.int64),
            np.array([one.degree for one in splines], np.int64),
            np.cumsum([0, *(len(one.poles) for one in splines)], dtype=np.int64),
            np.cumsum([0, *(len(one.knots) for one in splines)], dtype=np.int64),
            np.concatenate([one.poles for one in splines]),
            np.concatenate([one.weights for one in splines]),
            np.concatenate([one.knots for one in splines]),
        )

    @staticmethod
    def empty() -> "Splines":
        """No splines."""
        none, begin = np.zeros(0, np.int64), np.zeros(1, np.int64)
        return Splines(none, none, none, begin, begin, np.zeros((0, 3)), np.zeros(0), np.zeros(0))

    @staticmethod
    def joined(parts: Sequence["Splines"]) -> "Splines":
        """Return the splines of all parts, in their order."""
        if len(parts) < 2:
            return parts[0] if parts else Splines.empty()
        pole_counts = np.concatenate([np.diff(part.pole_begin) for part in parts])
        knot_counts = np.concatenate([np.diff(part.knot_begin) for part in parts])
        return Splines(
            np.concatenate([part.first for part in parts]),
            np.concatenate([part.last for part in parts]),
            np.concatenate([part.degree for part in parts]),
            np.concatenate(([0], np.cumsum(pole_counts))),
            np.concatenate(([0], np.cumsum(knot_counts))),
            np.concatenate([part.poles for part in parts]),
            np.concatenate([part.weights for part in parts]),
            np.concatenate([part.knots for part in parts]),
        )

    def select(self, keep: Flags) -> "Splines":
        """Those for which ``keep`` (m,) is set."""
        if bool(keep.all()):
            return self
        return Splines.of([self[k] for k in np.flatnonzero(keep).tolist()])

    def at_rows(self, first: Ints, last: Ints) -> "Splines":
        """Return the same splines with points in other rows."""
        return Splines(
            first, last, self.degree, self.pole_begin, self.knot_begin, self.poles, self.weights, self.knots
        )  # fmt: skip

    def with_poles(self, poles: Floats) -> "Splines":
        """Return the same splines with other control points (p, 3): a map of these by a matrix and a shift maps the
        curve.
        """
        return Splines(
            self.first, self.last, self.degree, self.pole_begin, self.knot_begin, poles, self.weights, self.knots
        )  # fmt: skip

    def inside(self, first: int, end: int) -> "Splines":
        """Those that start and end from row ``first`` to the one before ``end``, with rows counted from there."""
        kept = self.select((self.first > first) & (self.last < end))
        return kept.at_rows(kept.first - first, kept.last - first)
