"""Splines as blocks program them: their points within a chord tolerance.

The second author's evaluation: it shares nothing with that of CL files and of writers.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.model.splines import Spline
from trunnion.readers.control.worded_error import WordedError

#: How far a spline may be from the chords of its points, mm.
CHORD: Final = 0.001

#: Chords of each span that are tried first.
_FIRST_CHORDS: Final = 2

#: More points than this are a mistake of the program.
MOST_POINTS: Final = 10_000

#: The same of all spans of a NURBS together.
_MOST_IN_ALL: Final = 1_000_000


class SplineError(WordedError):
    """The reason why blocks program no spline."""


def polynomial_spline(coefficients: Floats, interval: float) -> Spline:
    """Return the spline of polynomials: ``coefficients`` (d + 1, 3) of the powers of a parameter from 0 to
    ``interval``.
    """
    degree = len(coefficients) - 1
    powers = coefficients * interval ** np.arange(degree + 1)[:, None]
    poles = [
        sum(math.comb(j, i) / math.comb(degree, i) * powers[i] for i in range(j + 1)) for j in range(degree + 1)
    ]  # fmt: skip
    knots = np.repeat([0.0, interval], degree + 1)
    return Spline(degree, knots, np.array(poles), np.ones(degree + 1))


def points_of_polynomial(coefficients: Floats, interval: float, length_unit: float = 1.0) -> Floats:
    """(k, 3): points behind the start of polynomials as those of ``polynomial_spline``, in units of ``length_unit`` mm.

    A chord of a parameter's step h is off by no more than the greatest second derivative times h squared over 8.
    """
    degree = len(coefficients) - 1
    bend = np.zeros(3)
    for power in range(2, degree + 1):
        bend += power * (power - 1) * np.abs(coefficients[power]) * interval ** (power - 2)
    chords = interval * math.sqrt(float(np.linalg.norm(bend)) * length_unit / (8.0 * CHORD))
    if not chords <= MOST_POINTS:
        raise SplineError(Wording("NC322", "spline_too_long", most=MOST_POINTS, chord=CHORD))
    at = np.linspace(0.0, interval, max(math.ceil(chords), 1) + 1)[1:]
    points = np.zeros((len(at), 3))
    for row in coefficients[::-1]:
        points = points * at[:, None] + row
    return points


def nurbs_points(spline: Spline) -> Floats:
    """(k, 3): points of a spline behind its start, in its coordinates, mm; chords are halved until they are near."""
    found: list[Floats] = []
    total = 0
    for span in spline.spans.tolist():
        chords = _FIRST_CHORDS
        while True:
            at = np.linspace(spline.knots[span], spline.knots[span + 1], chords + 1)
            pieces = _bezier_pieces(spline, span, at)
            if _farthest_from_chords(pieces) <= CHORD:
                break
            chords *= 2
            if not chords <= MOST_POINTS:
                raise SplineError(Wording("NC322", "spline_too_long", most=MOST_POINTS, chord=CHORD))
        found.append(pieces[-1, :, :3] / pieces[-1, :, 3:])
        total += chords
        if total > _MOST_IN_ALL:
            raise SplineError(Wording("NC322", "spline_too_long", most=_MOST_IN_ALL, chord=CHORD))
    return np.concatenate(found)


def at_parameters(spline: Spline, at: Floats) -> tuple[Floats, Floats]:
    """Return the points (k, 3) of a spline at rising parameters, and its directions there, of length 1.

    A direction leads to the control point beside the point, of the curve from there to the farther end of its span.
    """
    points, directions = np.empty((len(at), 3)), np.empty((len(at), 3))
    first = 0
    for span in spline.spans.tolist():
        begin, end = spline.knots[span], spline.knots[span + 1]
        last = len(at) if span == spline.spans[-1] else int(np.searchsorted(at, end))
        here = at[first:last]
        ahead = here < 0.5 * (begin + end)
        point = _blossom(spline, span, [here] * spline.degree)
        beside = _blossom(spline, span, [*[here] * (spline.degree - 1), np.where(ahead, end, begin)])
        points[first:last] = point[:, :3] / point[:, 3:]
        way = np.where(ahead, 1.0, -1.0)[:, None] * (beside[:, :3] / beside[:, 3:] - points[first:last])
        length = np.linalg.norm(way, axis=1)[:, None]
        directions[first:last] = way / np.where(length > 0.0, length, 1.0)
        first = last
    return points, directions


def _bezier_pieces(spline: Spline, span: int, at: Floats) -> Floats:
    """(d + 1, k, 4): control points times weights, and weights, of the curves between k + 1 parameters of a span."""
    begin, end, degree = at[:-1], at[1:], spline.degree
    return np.stack([_blossom(spline, span, [begin] * (degree - i) + [end] * i) for i in range(degree + 1)])


def _farthest_from_chords(pieces: Floats) -> float:
    """How far curves of ``_bezier_pieces`` can be from their chords at most, mm.

    The distance from a chord is convex, so that of a curve is at most the mean of its control points' distances with
    their shares: that of the ends is 0, and the inner ones together have at most the share ``inner``. Points of the
    curve bound nothing: a curve that goes out and comes back turns between them.
    """
    weights = pieces[..., 3]
    points = pieces[..., :3] / weights[..., None]
    if len(points) < 3:
        return 0.0
    step = points[-1] - points[0]
    arm = points[1:-1] - points[0]
    share = np.clip(np.einsum("dij,ij->di", arm, step) / np.maximum(np.einsum("ij,ij->i", step, step), 1e-30), 0.0, 1.0)
    away = np.linalg.norm(arm - share[..., None] * step, axis=2).max(axis=0)
    ends = 2.0 ** (2 - len(points))  # the least share of the ends where all weights are equal
    heavy = (1.0 - ends) * weights[1:-1].max(axis=0)
    inner = heavy / (heavy + ends * np.minimum(weights[0], weights[-1]))
    return float((inner * away).max())


def _blossom(spline: Spline, span: int, at: Sequence[Floats]) -> Floats:
    """Points (k, 4) of de Boor's triangle with an own parameter for each level, times their weights, and these.

    Of ``d - i`` times one and ``i`` times another parameter it is control point ``i`` of the curve between both.
    """
    degree, knots = spline.degree, spline.knots
    triangle = [
        np.tile(np.append(spline.poles[i] * spline.weights[i], spline.weights[i]), (len(at[0]), 1))
        for i in range(span - degree, span + 1)
    ]
    for level in range(1, degree + 1):
        for j in range(degree, level - 1, -1):
            low, high = knots[span - degree + j], knots[span + 1 + j - level]
            right = ((at[level - 1] - low) / (high - low))[:, None]
            triangle[j] = triangle[j - 1] * (1.0 - right) + triangle[j] * right
    return triangle[degree]
