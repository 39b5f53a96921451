"""A smooth field of tool axes over the parameters of a family.

In:     places with a cone of allowed directions each.
Out:    a tensor-product B-spline of vectors; its directions are the tool axes.

The field has values in space, not in two angles: so it has no pole, and a cone is a set of linear conditions on its
coefficients. Where the vectors are not shorter than 1, an axis turns no faster than its vector moves. The greatest
rate of change is the least that the cones allow (one linear program), and among all fields with that rate the one that
bends least is taken (a second one). The coefficients of a spline's derivative bound the derivative.
"""

from functools import reduce
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.linear_program import INTERIOR_POINT, solve_linear_program
from trunnion.impeller.paths.axis_regions import Regions
from trunnion.records import dataclass

#: Degrees of the splines: along, across, layer.
_DEGREES: Final = (3, 2, 2)

#: The axis keeps this sine from a cone's walls where the cone is wide enough, else this part of its width.
_FROM_WALLS: Final = 0.03
_OF_WIDTH: Final = 0.3

#: How much faster than the least possible the axis may turn, so that it bends less.
_FASTER: Final = 1.1

#: What a step out of a cone costs, against the rate of change.
_OUTSIDE: Final = 1e3

#: Axes that turn less than this, radians per mm, stand still.
_STILL: Final = 1e-9

#: A change between passes counts so much, against one along them.
_BETWEEN_PASSES: Final = 0.3


@dataclass(frozen=True, slots=True, eq=False)
class AxisField:
    """A field of tool axes.

    knots         for each parameter
    degrees       for each parameter
    coefficients  (n1, .., nk, 3)
    is_closed     whether the first parameter goes round: its spline is periodic
    """

    knots: tuple[Floats, ...]
    degrees: tuple[int, ...]
    coefficients: Floats
    is_closed: bool

    def axes(self, places: Floats) -> Floats:
        """Return unit vectors (n, 3) at places (n, k)."""
        vectors = self.basis(places) @ self.coefficients.reshape(-1, 3)
        return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])

    def basis(self, places: Floats) -> Floats:
        """Values (n, n1 · .. · nk) of all basis functions at places (n, k)."""
        rows = [
            _values(knots, degree, places[:, k], is_closed=self.is_closed and k == 0)
            for k, (knots, degree) in enumerate(zip(self.knots, self.degrees, strict=True))
        ]
        return np.asarray(reduce(lambda a, b: (a[:, :, None] * b[:, None]).reshape(len(places), -1), rows))


def _values(knots: Floats, degree: int, at: Floats, *, is_closed: bool) -> Floats:
    """Basis functions (n, m) of one parameter."""
    design = import_extra("scipy.interpolate", "impeller").BSpline.design_matrix
    at = np.mod(at, 1.0) if is_closed else np.clip(at, 0.0, 1.0)
    found = np.asarray(design(at, knots, degree).toarray())
    if is_closed:
        found[:, :degree] += found[:, -degree:]
        found = found[:, :-degree]
    return np.asarray(found)


def even_knots(spans: int, degree: int, *, is_closed: bool) -> Floats:
    """Knots of so many equal spans from 0 to 1."""
    inner = np.arange(spans + 1) / spans
    if is_closed:
        return np.asarray(np.arange(-degree, spans + degree + 1) / spans)
    return np.concatenate((np.zeros(degree), inner, np.ones(degree)))


def _slopes(knots: Floats, degree: int, *, is_closed: bool) -> Floats:
    """Return the matrix that makes a derivative's coefficients of a spline's."""
    count = len(knots) - degree - 1
    width = knots[degree + 1 : degree + count] - knots[1:count]
    found = np.zeros((count - 1, count))
    k = np.arange(count - 1)
    found[k, k], found[k, k + 1] = -degree / width, degree / width
    if is_closed:
        spans = count - degree
        folded = found[:spans, :spans].copy()
        folded[:, :degree] += found[:spans, spans:]
        return folded
    return found


@dataclass(frozen=True, slots=True, eq=False)
class FieldFit:
    """A field, how fast its axes turn at most (radians per mm along, a bound), and how far it is out of a cone."""

    field: AxisField
    rate: float
    outside: float


def fit_field(
    places: Floats, regions: Regions, spans: tuple[int, ...], lengths: Floats, *, is_closed: bool
) -> FieldFit | None:
    """Return the field that turns least; None if its linear program finds no end.

    places   (n, k)
    regions  a cone at each place; places without one do not count
    spans    of the spline, for each parameter
    lengths  what a parameter from 0 to 1 is in mm, (k,)
    """
    sparse = import_extra("scipy.sparse", "impeller")
    degrees = _DEGREES[: len(spans)]
    closed = [is_closed and k == 0 for k in range(len(spans))]
    knots = tuple(even_knots(n, p, is_closed=c) for n, p, c in zip(spans, degrees, closed, strict=True))
    sizes = tuple(len(t) - p - 1 - (p if c else 0) for t, p, c in zip(knots, degrees, closed, strict=True))
    empty = AxisField(knots, degrees, np.zeros((*sizes, 3)), is_closed)
    basis = sparse.csr_matrix(empty.basis(places))
    first, second = [], []
    for k in range(len(spans)):
        weight = (1.0 if k == 0 else _BETWEEN_PASSES) / float(lengths[k])
        slope = _slopes(knots[k], degrees[k], is_closed=closed[k]) * weight
        first.append(_over_all(sparse, slope, k, sizes))
        # A derivative's knots lack the outermost ones; even knots that go round are those of any derivative.
        inner, degree = (knots[k], degrees[k]) if closed[k] else (knots[k][1:-1], degrees[k] - 1)
        bend = _slopes(inner, degree, is_closed=closed[k]) * weight * float(lengths.max())
        second.append(_over_all(sparse, bend @ slope, k, sizes))
    solved = _programs(sparse, basis, regions, sparse.vstack(first), sparse.vstack(second))
    if solved is None:
        return None
    coefficients, rate, outside = solved
    return FieldFit(AxisField(knots, degrees, coefficients.reshape(*sizes, 3), is_closed), rate, outside)


def _over_all(sparse: Any, matrix: Floats, parameter: int, sizes: tuple[int, ...]) -> Any:
    """Return a matrix for one parameter's coefficients as one for those of all, and for the three coordinates."""
    parts = [sparse.csr_matrix(matrix) if k == parameter else sparse.identity(n) for k, n in enumerate(sizes)]
    return sparse.kron(reduce(sparse.kron, parts), sparse.identity(3), format="csr")


def _programs(sparse: Any, basis: Any, regions: Regions, first: Any, second: Any) -> tuple[Floats, float, float] | None:
    """Coefficients of the field, its rate, and how far it is out of its cones, by two linear programs.

    None if the first one finds no end. Without the second one the field bends more than it must, and that is all.
    Unknowns are the coefficients, the step out of the cones, and the rate, then the bends.
    """
    there = np.flatnonzero(np.isfinite(regions.middle[:, 0]))
    walls = _rows_of(sparse, basis[regions.owner], regions.walls)
    middles = _rows_of(sparse, basis[there], regions.middle[there])
    keep = np.minimum(_FROM_WALLS, _OF_WIDTH * regions.width[regions.owner])
    count, steps, bends = first.shape[1], first.shape[0], second.shape[0]

    def conditions(more: int) -> list[Any]:
        outside = sparse.csr_matrix(np.ones((len(keep), 1)))
        none = sparse.csr_matrix((len(keep), more))
        return [sparse.hstack((-walls, -outside, none)), sparse.hstack((-middles, _none(sparse, middles, 1 + more)))]

    limits = [-keep, -np.ones(len(there))]
    one = sparse.csr_matrix(np.ones((steps, 1)))
    turns = [sparse.hstack((sign * first, _none(sparse, first, 1), -one)) for sign in (1.0, -1.0)]
    cost = np.r_[np.zeros(count), _OUTSIDE, 1.0]
    found = _solved(sparse, cost, [*conditions(1), *turns], [*limits, np.zeros(2 * steps)], count)
    if found is None:
        return None
    field, rate, out = found[:count], float(found[count + 1]), float(found[count])
    rows = [sparse.hstack((sign * second, _none(sparse, second, 1), -sparse.identity(bends))) for sign in (1.0, -1.0)]
    rows += [sparse.hstack((sign * first, _none(sparse, first, 1 + bends))) for sign in (1.0, -1.0)]
    limits += [np.zeros(2 * bends), np.full(2 * steps, _FASTER * rate + _STILL)]
    cost = np.r_[np.zeros(count), _OUTSIDE, np.full(bends, 1.0 / bends)]
    found = _solved(sparse, cost, [*conditions(bends), *rows], limits, count)
    return (field, rate, out) if found is None else (found[:count], rate, float(found[count]))


def _none(sparse: Any, beside: Any, columns: int) -> Any:
    return sparse.csr_matrix((beside.shape[0], columns))


def _rows_of(sparse: Any, basis: Any, vectors: Floats) -> Any:
    """For each row of a basis and its vector: the vector times the field there, as a row over all coefficients."""
    return sparse.hstack([basis.multiply(vectors[:, k : k + 1]) for k in range(3)]).tocsc()[
        :, np.arange(3 * basis.shape[1]).reshape(3, -1).T.ravel()
    ]


def _solved(sparse: Any, cost: Floats, rows: list[Any], limits: list[Floats], free: int) -> Floats | None:
    bounds: list[tuple[float | None, float | None]] = [(None, None)] * free + [(0.0, None)] * (len(cost) - free)
    return solve_linear_program(cost, sparse.vstack(rows).tocsc(), np.concatenate(limits), bounds, INTERIOR_POINT)
