"""A curve for points: through them, or near them with few control points; and how good it is."""

from collections.abc import Iterator
from dataclasses import field
from operator import attrgetter
from typing import Annotated

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, Severity, argument_problem, warning
from trunnion.geometry.approximation import approximate
from trunnion.geometry.closest import closest_parameters
from trunnion.geometry.curves import DEGREE, BSplineCurve
from trunnion.geometry.ends import Ends
from trunnion.geometry.fairing import LEAST_POINTS, fair_points
from trunnion.geometry.interpolation import interpolate
from trunnion.geometry.parameters import parameters_of
from trunnion.geometry.point_faults import point_faults
from trunnion.geometry.point_tables import PointTable
from trunnion.geometry.spans import Span, spans_between
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure


@dataclass(frozen=True, slots=True)
class Wanted:
    """What curve is wanted.

    ends              of a curve through points
    parameterization  one of ``parameters.PARAMETERIZATIONS``
    tolerance         the curve passes points, as they are moved, within so many mm; None: it goes through them
    fair              points may be moved by so many mm first; None: they stay
    """

    ends: Ends = field(default_factory=Ends)
    parameterization: str = "chord-length"
    tolerance: float | None = None
    fair: float | None = None


@dataclass(frozen=True, slots=True)
class FittedPoint:
    """A point (3,) as given, mm, the parameter of the curve's nearest point, and how far that is off."""

    point: tuple[float, ...]
    parameter: Annotated[float, Figure(decimals=12)]
    off: Annotated[float, Figure(unit="mm", decimals=9)]


@dataclass(frozen=True, slots=True, eq=False)
class CurveFit:
    """A curve, and how far it is off.

    name        of the curve; empty if it has none
    points      (n, 3) mm, as given
    parameters  (n,) of the points of the curve that are nearest to them
    offsets     (n,) how far they are from the curve, mm
    curve       over the parameters 0 to 1
    spans       the curve between two points that follow each other, n - 1
    remarks     what is probably wrong with the points, and what the curve does that nobody wants
    """

    name: str
    points: Annotated[Floats, NOT_DATA]
    parameters: Annotated[Floats, NOT_DATA]
    offsets: Annotated[Floats, NOT_DATA]
    curve: Annotated[
        BSplineCurve,
        Figure("degree", take=lambda _: DEGREE),
        Figure("control_points", decimals=9, take=attrgetter("control_points")),
        Figure("knots", decimals=12, take=attrgetter("knots")),
    ]
    spans: tuple[Span, ...]
    remarks: tuple[Problem, ...]

    @property
    @Figure("points", after="length_mm")
    def fitted_points(self) -> list["FittedPoint"]:
        """The points one by one."""
        columns = (self.points.tolist(), self.parameters.tolist(), self.offsets.tolist())
        return [FittedPoint(tuple(point), at, off) for point, at, off in zip(*columns, strict=True)]

    @property
    @Figure(unit="mm", decimals=9, after="knots")
    def length(self) -> float:
        """Length of the curve, mm."""
        return float(self.curve.lengths(np.array([0.0, 1.0]))[0])


def fit(table: PointTable, wanted: Wanted, weights: Floats | None = None) -> CurveFit:
    """Fit a curve to the points of a table.

    Raises ``InputError`` if the points do not make a curve, or what is wanted contradicts itself; with every mistake.
    """
    faults = list(point_faults(table))
    faults += _contradictions(wanted, weights, len(table.points))
    if any(fault.severity == Severity.ERROR for fault in faults):
        raise InputError(faults)
    points, given = table.points, parameters_of(table.points, wanted.parameterization)
    if wanted.fair is not None:
        points = fair_points(points, given, wanted.fair)
        given = parameters_of(points, wanted.parameterization)
    through = interpolate(points, given, wanted.ends, weights)
    curve = through if wanted.tolerance is None else approximate(points, given, wanted.tolerance)
    exact = curve is through and wanted.fair is None
    parameters = given if exact else closest_parameters(curve, table.points)
    offsets = np.linalg.norm(curve.points(parameters) - table.points, axis=1)
    natural = curve if wanted.ends.is_natural else interpolate(points, given, Ends(), weights)
    rising = np.maximum.accumulate(parameters)
    spans = tuple(spans_between(curve, rising, natural))
    remarks = (*faults, *_runs_back(table, spans))
    return CurveFit(table.name, table.points, parameters, offsets, curve, spans, remarks)


def _contradictions(wanted: Wanted, weights: Floats | None, count: int) -> Iterator[Problem]:
    if wanted.tolerance is not None and not wanted.ends.is_natural:
        yield argument_problem(
            "start" if wanted.ends.start != Ends().start else "end", Wording("IMP130", "curve_through_points")
        )
    if wanted.tolerance is not None and weights is not None:
        yield argument_problem("weights", Wording("IMP130", "curve_through"))
    if wanted.fair is not None and count < LEAST_POINTS:
        yield argument_problem("fair", Wording("IMP132", "needs_points", least_points=LEAST_POINTS, count=count))
    if weights is not None and not (weights.shape == (count,) and np.isfinite(weights).all() and (weights > 0.0).all()):
        yield argument_problem("weights", Wording("IMP132", "not_number_above", count=count))


def _runs_back(table: PointTable, spans: tuple[Span, ...]) -> Iterator[Problem]:
    """Spans in which the curve goes against its points: an end whose tangent does not belong to them, mostly."""
    for k, span in enumerate(spans):
        if span.runs_back:
            yield warning(
                table.file,
                table.lines[k + 1],
                Wording("IMP123", "runs_back_before", table_called=table.called, turn=span.turn, radius=span.radius),
            )
