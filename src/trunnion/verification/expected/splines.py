"""Points of splines, for the proof: by the recursion of Cox and de Boor in four coordinates, x w, y w, z w and w."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints, distinct
from trunnion.model.splines import Splines

#: Shares of a span at which two splines are compared: more than a polynomial of degree 5 has coefficients.
_SHARES: Final = np.linspace(0.0, 1.0, 9)


def span_counts(splines: Splines) -> Ints:
    """(m,) int64: how many polynomials each spline has."""
    return np.bincount(_spans(splines)[0], minlength=len(splines))


def dense_points(splines: Splines, begin: int, end: int) -> Floats:
    """(s, 9, 3): points at equal shares of each span of splines ``begin`` to ``end - 1``, mm, in their order.

    The first and the last of a span are those of its knots. Splines of one degree with as many spans are the same
    curve if these points are the same.
    """
    which, span = _spans(splines, begin, end)
    which += begin
    points = np.empty((len(span), len(_SHARES), 3))
    for degree in distinct(splines.degree[begin:end]).tolist():
        here = splines.degree[which] == degree
        points[here] = _points(splines, which[here], span[here], degree)
    return points


def _spans(splines: Splines, begin: int = 0, end: int | None = None) -> tuple[Ints, Ints]:
    """Return the spline, counted from ``begin``, and the knot at which it begins, of each span that has a length."""
    end = len(splines) if end is None else end
    first, last = int(splines.knot_begin[begin]), int(splines.knot_begin[end])
    counts = np.diff(splines.knot_begin[begin : end + 1])
    which = np.repeat(np.arange(end - begin), counts)
    place = np.arange(last - first) - np.repeat(splines.knot_begin[begin:end] - first, counts)
    degree = splines.degree[begin:end][which]
    inside = (place >= degree) & (place < counts[which] - degree - 1)
    longer = np.diff(splines.knots[first:last], append=0.0) > 0.0
    found = np.flatnonzero(inside & longer)
    return which[found], first + found


def _points(splines: Splines, which: Ints, span: Ints, degree: int) -> Floats:
    """Points (s, 9, 3) of polynomials of one degree: those of splines ``which`` (s,) that begin at knots ``span``."""
    knots = splines.knots
    pole = splines.pole_begin[which] + span - splines.knot_begin[which] - degree
    at = knots[span][:, None] + (knots[span + 1] - knots[span])[:, None] * _SHARES
    basis = np.zeros((degree + 1, *at.shape))
    basis[0] = 1.0
    for order in range(1, degree + 1):
        carried = np.zeros(at.shape)
        for i in range(order):
            right, left = knots[span + 1 + i][:, None], knots[span + 1 + i - order][:, None]
            part = basis[i] / (right - left)
            basis[i] = carried + (right - at) * part
            carried = (at - left) * part
        basis[order] = carried
    raised = np.column_stack((splines.poles * splines.weights[:, None], splines.weights))
    found = sum(basis[i][:, :, None] * raised[pole + i][:, None] for i in range(degree + 1))
    return np.asarray(found[:, :, :3] / found[:, :, 3:])
