"""What a curve does between the points that it passes."""

import math
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.geometry.closest import closest_parameters
from trunnion.geometry.curves import BSplineCurve
from trunnion.records import dataclass
from trunnion.results import Figure

#: Spans that are measured at once: memory does not grow with the number of points.
_CHUNK: Final = 1024

#: A larger radius is that of a straight line, mm.
_STRAIGHT: Final = 1e9

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

    length: Annotated[float, Figure(unit="mm", decimals=9)]
    sag: Annotated[float, Figure(unit="mm", decimals=9)]
    radius: Annotated[float, Figure(unit="mm", decimals=9, take=lambda radius: radius if radius < _STRAIGHT else None)]
    turn: Annotated[float, Figure(unit="deg", decimals=9)]
    bend: Annotated[float, Figure("off_natural", unit="mm", decimals=9)]

    @property
    def runs_back(self) -> bool:
        """Whether the curve goes against the straight line somewhere."""
        return self.turn > 90.0


def spans_between(curve: BSplineCurve, parameters: Floats, natural: BSplineCurve) -> list[Span]:
    """Return the spans of a curve between parameters (n,) that rise; ``natural`` is the curve that ``bend`` is told
    from.
    """
    lengths = curve.lengths(parameters)
    found: list[Span] = []
    for first in range(0, len(parameters) - 1, _CHUNK):
        part = slice(first, first + _CHUNK)
        found += _spans(curve, parameters[first : first + _CHUNK + 1], lengths[part], natural)
    return found


def _spans(curve: BSplineCurve, parameters: Floats, lengths: Floats, natural: BSplineCurve) -> list[Span]:
    share = np.linspace(0.0, 1.0, _SAMPLES)
    at = (parameters[:-1, None] * (1.0 - share) + parameters[1:, None] * share).ravel()
    shape = (len(parameters) - 1, _SAMPLES, 3)
    points, first = (array.reshape(shape) for array in curve.derivatives(at, 1))
    chords = points[:, -1] - points[:, 0]
    along = chords / np.maximum(np.linalg.norm(chords, axis=1), 1e-300)[:, None]
    off = points - points[:, :1]
    off = off - np.einsum("ijk,ik->ij", off, along)[:, :, None] * along[:, None]
    speeds = np.linalg.norm(first, axis=2)
    cosine = np.where(speeds > 0.0, np.einsum("ijk,ik->ij", first, along) / np.maximum(speeds, 1e-300), 1.0)
    turns = np.degrees(np.arccos(np.clip(cosine.min(axis=1), -1.0, 1.0)))
    curvatures = np.linalg.norm(curve.curvatures(at), axis=1).reshape(shape[:2]).max(axis=1)
    bends = np.zeros(len(lengths))
    if natural is not curve:
        beside = natural.points(closest_parameters(natural, points.reshape(-1, 3))).reshape(shape)
        bends = np.linalg.norm(points - beside, axis=2).max(axis=1)
    columns = lengths, np.linalg.norm(off, axis=2).max(axis=1), curvatures, turns, bends
    return [
        Span(length, sag, 1.0 / bent if bent > 0.0 else math.inf, turn, bend)
        for length, sag, bent, turn, bend in zip(*(column.tolist() for column in columns), strict=True)
    ]
