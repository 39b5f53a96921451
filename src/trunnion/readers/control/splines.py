"""Splines as blocks program them: their points within a chord tolerance.

The second author's evaluation: it shares nothing with that of CL files and of writers.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.splines import Spline

#: How far a spline may be from the chords of its points, mm.
CHORD: Final = 0.001

#: Chords of each span that are tried first.
_FIRST_CHORDS: Final = 2

#: More points than this are a mistake of the program.
MOST_POINTS: Final = 10_000

#: The same of all spans of a NURBS together.
_MOST_IN_ALL: Final = 1_000_000


class SplineError(Exception):
    """The reason why blocks program no spline."""


def polynomial_spline(coefficients: Floats, interval: float) -> Spline:
    """The spline of polynomials: ``coefficients`` (d + 1, 3) of the powers of a parameter from 0 to ``interval``."""
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
        raise SplineError(f"a spline that takes more than {MOST_POINTS} points within {CHORD:g} mm")
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
            at = np.linspace(spline.knots[span], spline.knots[span + 1], 4 * chords + 1)
            points = _de_boor(spline, span, at)
            if _farthest_from_chords(points) <= CHORD:
                break
            chords *= 2
            if not chords <= MOST_POINTS:
                raise SplineError(f"a spline that takes more than {MOST_POINTS} points within {CHORD:g} mm")
        found.append(points[4::4])
        total += chords
        if total > _MOST_IN_ALL:
            raise SplineError(f"a spline that takes more than {_MOST_IN_ALL} points within {CHORD:g} mm")
    return np.concatenate(found)


def _farthest_from_chords(points: Floats) -> float:
    """How far points between every fourth one are from its chords, mm."""
    begin, step = points[:-1:4], points[4::4] - points[:-1:4]
    square = np.maximum(np.einsum("ij,ij->i", step, step), 1e-30)
    farthest = 0.0
    for k in (1, 2, 3):
        arm = points[k::4] - begin
        share = np.clip(np.einsum("ij,ij->i", arm, step) / square, 0.0, 1.0)
        farthest = max(farthest, float(np.linalg.norm(arm - share[:, None] * step, axis=1).max()))
    return farthest


def _de_boor(spline: Spline, span: int, at: Floats) -> Floats:
    """Points (k, 3) at parameters (k,) of the span that begins at a knot, by de Boor's triangle."""
    degree, knots = spline.degree, spline.knots
    triangle = [
        np.tile(np.append(spline.poles[i] * spline.weights[i], spline.weights[i]), (len(at), 1))
        for i in range(span - degree, span + 1)
    ]
    for level in range(1, degree + 1):
        for j in range(degree, level - 1, -1):
            low, high = knots[span - degree + j], knots[span + 1 + j - level]
            right = ((at - low) / (high - low))[:, None]
            triangle[j] = triangle[j - 1] * (1.0 - right) + triangle[j] * right
    return np.asarray(triangle[degree][:, :3] / triangle[degree][:, 3:])
