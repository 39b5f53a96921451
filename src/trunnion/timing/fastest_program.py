"""The linear programs of the fastest run: a faster one near a run that keeps all limits (``fastest``)."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.extras import import_extra
from trunnion.records import dataclass

#: Degree of the square of the rate as a spline of the place.
DEGREE: Final = 3

#: Weights of the four places of each piece at which a program keeps the limits (Lobatto's quadrature).
_WEIGHTS: Final = (1 / 12, 5 / 12, 5 / 12, 1 / 12)

#: The time that a place takes is convex in the square of its rate: tangents where that is so many times as now.
_TANGENTS: Final = (0.2, 0.5, 0.8, 1.0, 1.25, 1.7, 3.0)

#: Shares of the way to the solution of a program that are tried.
_STEPS: Final = (1.0, 0.9, 0.7, 0.4, 0.1)

#: Share of a piece by which a place at its end is moved inside, to get the value on its side of a step.
_INSIDE: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class SquareRates:
    """Squares of rates as splines with steps of the second derivative at breaks.

    edges  (m + 1,) ends of the pieces, from 0 to 1
    knots  of the spline; those at breaks are double
    """

    edges: Floats
    knots: Floats

    @staticmethod
    def of(edges: Floats, breaks: Floats) -> "SquareRates":
        """With these pieces; breaks are among their ends."""
        inner = np.sort(np.concatenate((edges[1:-1], breaks[1:-1])))
        ends = np.ones(DEGREE + 1)
        return SquareRates(edges, np.concatenate((edges[0] * ends, inner, edges[-1] * ends)))

    @property
    def count(self) -> int:
        """Of coefficients."""
        return len(self.knots) - DEGREE - 1

    def spline(self, coefficients: Floats) -> Any:
        """Return the ``scipy.interpolate.BSpline``."""
        return import_extra("scipy.interpolate", "geometry").BSpline(self.knots, coefficients, DEGREE)

    def middles(self) -> Floats:
        """Return a place for each coefficient, near which it counts most."""
        return np.array([self.knots[k + 1 : k + DEGREE + 1].mean() for k in range(self.count)])

    def places(self, even: int = 0) -> tuple[Floats, Flags]:
        """Places of all pieces, their ends included, and whether it is the end of one; so many evenly, or few."""
        share = _shares(even)
        places = self.edges[:-1, None] + np.diff(self.edges)[:, None] * share
        places[:, -1] = self.edges[1:]
        return places.ravel(), np.tile(share == 1.0, len(self.edges) - 1)

    def matrices(self, even: int = 0) -> tuple[Any, Any, Any]:
        """Sparse matrices that make value, slope and second derivative at ``places`` of coefficients."""
        share = np.clip(_shares(even), _INSIDE, 1.0 - _INSIDE)
        return (*(self._matrix((self.edges[:-1, None] + np.diff(self.edges)[:, None] * share).ravel(), k)
                  for k in range(3)),)  # fmt: skip

    def quadrature(self) -> tuple[Any, Floats]:
        """Return a matrix that makes values at nodes, and the weights of these nodes."""
        nodes, weights = np.polynomial.legendre.leggauss(8)
        width = np.diff(self.edges)[:, None]
        return self._matrix((self.edges[:-1, None] + width * 0.5 * (1.0 + nodes)).ravel(), 0), (
            0.5 * width * weights
        ).ravel()

    def _matrix(self, places: Floats, order: int) -> Any:
        sparse = import_extra("scipy.sparse", "geometry")
        made, knots = sparse.identity(self.count, format="csr"), self.knots
        for degree in range(DEGREE, DEGREE - order, -1):
            rows = made.shape[0]
            factor = degree / (knots[degree + 1 : degree + rows] - knots[1:rows])
            made = sparse.diags([-factor, factor], [0, 1], shape=(rows - 1, rows)) @ made
            knots = knots[1:-1]
        design = import_extra("scipy.interpolate", "geometry").BSpline.design_matrix
        return (design(places, knots, DEGREE - order) @ made).tocsr()


def _shares(even: int) -> Floats:
    if even:
        return np.linspace(0.0, 1.0, even)
    return np.array((0.0, 0.5 - math.sqrt(0.05), 0.5 + math.sqrt(0.05), 1.0))


@dataclass(frozen=True, slots=True, eq=False)
class MotionLimits:
    """The limits of axes at places, with what makes their motion of coefficients.

    speed  (places, axes): share of its speed that an axis has at the rate 1
    acceleration, jerk  for each axis a sparse matrix (places, coefficients): shares of an acceleration, and of a jerk
                        over the rate
    value  sparse matrix (places, coefficients) that makes the squares of the rate
    """

    speed: Floats
    acceleration: tuple[Any, ...]
    jerk: tuple[Any, ...]
    value: Any

    @staticmethod
    def of(q: Floats, matrices: Sequence[Any], table: Floats) -> "MotionLimits":
        """Of axis values with three derivatives, (4, places, axes), and limits of speed to jerk, (3, axes)."""
        diagonal = import_extra("scipy.sparse", "geometry").diags
        b0, b1, b2 = matrices
        speed, acceleration, jerk = ((q[1:] / limit) for limit in table)

        def every(*parts: tuple[Floats, Any]) -> tuple[Any, ...]:
            return tuple(sum(diagonal(p[:, k]) @ matrix for p, matrix in parts) for k in range(q.shape[2]))

        return MotionLimits(
            speed[0],
            every((acceleration[1], b0), (0.5 * acceleration[0], b1)),
            every((jerk[2], b0), (1.5 * jerk[1], b1), (0.5 * jerk[0], b2)),
            b0,
        )

    def in_unit(self, seconds: float) -> "MotionLimits":
        """Return the same with another unit of time."""
        return replace(
            self,
            speed=self.speed / seconds,
            acceleration=tuple(matrix / seconds**2 for matrix in self.acceleration),
            jerk=tuple(matrix / seconds**3 for matrix in self.jerk),
        )

    def tightened(self, shares: Floats) -> "MotionLimits":
        """Return the same with limits of speed, acceleration and jerk that are so many times lower, (3, pieces)."""
        speed, acceleration, jerk = np.repeat(shares, len(_WEIGHTS), axis=1)
        diagonal = import_extra("scipy.sparse", "geometry").diags
        return replace(
            self,
            speed=self.speed * speed[:, None],
            acceleration=tuple(diagonal(acceleration) @ matrix for matrix in self.acceleration),
            jerk=tuple(diagonal(jerk) @ matrix for matrix in self.jerk),
        )

    def shares(self, coefficients: Floats) -> tuple[Floats, Floats, Floats]:
        """Shares of speed, acceleration and jerk, (places, axes) each."""
        rate = np.sqrt(self.value @ coefficients)[:, None]
        acceleration = np.stack([matrix @ coefficients for matrix in self.acceleration], axis=1)
        jerk = np.stack([matrix @ coefficients for matrix in self.jerk], axis=1)
        return self.speed * rate, acceleration, jerk * rate

    def excess(self, coefficients: Floats) -> float:
        """By what time must be stretched, or may be pressed, so that some axis just reaches a limit."""
        shares = self.shares(coefficients)
        return max(math.pow(np.abs(share).max(), 1.0 / order) for order, share in enumerate(shares, 1))


def faster(
    rates: SquareRates, limits: MotionLimits, coefficients: Floats, least_gain: float, most_programs: int
) -> Floats:
    """Coefficients of a run that keeps all limits at the places, and that no further program makes faster.

    coefficients  of any run; a stretch of its time must make it keep the limits
    least_gain    share of the time; a program that saves less was the last one
    """
    matrix, weights = rates.quadrature()

    def stretched(found: Floats) -> tuple[float, Floats]:
        if (limits.value @ found).min() <= 0.0 or (matrix @ found).min() <= 0.0:
            return np.inf, found
        found = found / limits.excess(found) ** 2
        return float((weights / np.sqrt(matrix @ found)).sum()), found

    seconds, best = stretched(coefficients)
    program = _Program(rates, limits)
    for _ in range(most_programs):
        solved = program.solve(best)
        if solved is None:
            break
        tried = [stretched(best + step * (solved - best)) for step in _STEPS]
        found = min(tried, key=lambda one: one[0])
        gain = seconds - found[0]
        if gain > 0.0:
            seconds, best = found
        if gain <= least_gain * seconds:
            break
    return best


class _Program:
    """The linear programs of one spline: what all of them share."""

    def __init__(self, rates: SquareRates, limits: MotionLimits) -> None:
        self._sparse = import_extra("scipy.sparse", "geometry")
        self._value = limits.value
        self._weights = (np.diff(rates.edges)[:, None] * np.array(_WEIGHTS)).ravel()
        with np.errstate(divide="ignore"):
            highest = 1.0 / (limits.speed**2).max(axis=1)
        bound = np.isfinite(highest)
        signed = [sign * one for one in limits.acceleration if one.nnz for sign in (1.0, -1.0)]
        self._rows = [limits.value[bound], *signed]
        self._limits = [highest[bound], *(np.ones(one.shape[0]) for one in signed)]
        self._jerks = [sign * one for one in limits.jerk if abs(one).max() > 0.0 for sign in (1.0, -1.0)]

    def solve(self, now: Floats) -> Floats | None:
        """Coefficients that are faster in the program with tangents at the present ones; None if none were found."""
        sparse = self._sparse
        b = self._value @ now
        tangent = sparse.diags(0.5 * b**-1.5) @ self._value
        rows = [*self._rows, *(one + tangent for one in self._jerks)]
        limits = [*self._limits, *(1.5 * b**-0.5 for _ in self._jerks)]
        count = len(b)
        above: list[Any] = [sparse.csr_matrix((sum(one.shape[0] for one in rows), count))]
        for factor in _TANGENTS:
            rows.append(sparse.diags(-0.5 * factor**-1.5 / b) @ self._value)
            above.append(-sparse.identity(count))
            limits.append(np.full(count, -1.5 * factor**-0.5))
        matrix = sparse.hstack((sparse.vstack(rows), sparse.vstack(above))).tocsr()
        scale = 1.0 / np.maximum(abs(matrix).max(axis=1).toarray().ravel(), 1e-300)
        cost = np.concatenate((np.zeros(len(now)), self._weights * b**-0.5))
        solved = import_extra("scipy.optimize", "geometry").linprog(
            cost, sparse.diags(scale) @ matrix, scale * np.concatenate(limits), bounds=(0.0, None), method="highs-ipm"
        )
        return None if solved.x is None else np.asarray(solved.x[: len(now)])
