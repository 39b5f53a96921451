"""What a curve does between the points that it passes."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.geometry.closest import closest_parameters
from trunnion.geometry.curves import BSplineCurve

#: Samples of a span.
_SAMPLES: Final = 65


@dataclass(frozen=True, slots=True)
class Span:
    """The curve between two points that follow each other.

    length  mm
    sag     how far it is off the straight line between them, mm
    radius  least radius of curvature, mm
    turn    largest angle between the curve and that straight line, degrees; above 90 it runs back
    bend    how far it is off the curve through the same points with natural ends, mm
    """

    length: float
    sag: float
    radius: float
    turn: float
    bend: float

    @property
    def runs_back(self) -> bool:
        """Whether the curve goes against the straight line somewhere."""
        return self.turn > 90.0


def spans_between(curve: BSplineCurve, parameters: Floats, natural: BSplineCurve) -> list[Span]:
    """The spans of a curve between parameters (n,) that rise; ``natural`` is the curve that ``bend`` is told from."""
    return [_span(curve, start, end, natural) for start, end in pairwise(parameters)]


def _span(curve: BSplineCurve, start: float, end: float, natural: BSplineCurve) -> Span:
    at = np.linspace(start, end, _SAMPLES)
    points, first = curve.derivatives(at, 1)
    chord = points[-1] - points[0]
    along = chord / np.linalg.norm(chord)
    off = points - points[0]
    sag = np.linalg.norm(off - np.outer(off @ along, along), axis=1).max()
    speeds = np.linalg.norm(first, axis=1)
    cosine = np.where(speeds > 0.0, first @ along / np.maximum(speeds, 1e-300), 1.0)
    beside = natural.points(closest_parameters(natural, points))
    curvature = np.linalg.norm(curve.curvatures(at), axis=1).max()
    return Span(
        length=float(curve.lengths(np.array([start, end]))[0]),
        sag=float(sag),
        radius=float(1.0 / curvature) if curvature > 0.0 else float("inf"),
        turn=float(np.degrees(np.arccos(np.clip(cosine.min(), -1.0, 1.0)))),
        bend=float(np.linalg.norm(points - beside, axis=1).max()),
    )
