"""An impeller: its blades, hub, shroud and stock as exact surfaces.

In:     ``ImpellerDefinition``.
Out:    ``Impeller``; what does not make an impeller is refused with the rows of its tables.
Units:  mm, axis Z.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from operator import attrgetter
from typing import Annotated

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, Severity
from trunnion.geometry.curves import BSplineCurve
from trunnion.geometry.interpolation import interpolate
from trunnion.geometry.parameters import parameters_of
from trunnion.geometry.point_faults import point_faults
from trunnion.geometry.surfaces import BSplineSurface, loft
from trunnion.impeller.blade import Blade
from trunnion.impeller.definition import ImpellerDefinition
from trunnion.impeller.faults import blade_faults, direction_faults, section_faults
from trunnion.impeller.profiles import Profile
from trunnion.impeller.stock_faults import stock_faults
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure

#: How far blades go on beyond hub, shroud and stock, mm, besides their thickness.
_BEYOND = 1.0

#: The most that a blade goes on beyond hub and shroud, as a part of its own height there.
_MOST_BEYOND = 0.6


@dataclass(frozen=True, slots=True, eq=False)
class Impeller:
    """An impeller.

    curves    of the blade from hub to shroud
    blade     the first one
    splitter  the first splitter, half a pitch behind; None: there is none
    hub       the first curve turned about Z
    shroud    the last curve turned about Z
    remarks   warnings of what is probably not meant
    """

    definition: Annotated[
        ImpellerDefinition,
        Figure("name", take=attrgetter("name")),
        Figure("blades", take=attrgetter("number")),
    ]
    curves: Annotated[tuple[BSplineCurve, ...], NOT_DATA]
    blade: Annotated[Blade, NOT_DATA]
    splitter: Annotated[Blade | None, NOT_DATA]
    hub: Annotated[Profile, NOT_DATA]
    shroud: Annotated[Profile, NOT_DATA]
    remarks: Annotated[tuple[Problem, ...], NOT_DATA] = ()

    @property
    @Figure()
    def splitters(self) -> int:
        """How many splitters there are."""
        return 0 if self.splitter is None else self.definition.number

    def blades(self) -> Iterator[tuple[Blade, float]]:
        """All blades and splitters, each with the angle in radians by which it is turned about Z."""
        pitch = 2.0 * np.pi / self.definition.number
        for k in range(self.definition.number):
            yield self.blade, k * pitch
            if self.splitter is not None:
                yield self.splitter, (k + 0.5) * pitch


def build_impeller(definition: ImpellerDefinition) -> Impeller:
    """Make the surfaces of an impeller.

    Raises ``InputError`` if the points make no blade: the same twice, out of order, a section that crosses itself or is
    below the one before, blades that overlap or stand out of the stock, a trailing edge that the stock does not cut;
    each with the rows.
    """
    problems = [fault for table in definition.sections for fault in point_faults(table)]
    if problems:
        raise InputError([replace(one, severity=Severity.ERROR) for one in problems])
    _raise_errors(direction_faults(definition))
    curves = tuple(
        interpolate(table.points, parameters_of(table.points, definition.parameterization))
        for table in definition.sections
    )
    hub, shroud = Profile.of_curve(curves[0]), Profile.of_curve(curves[-1])
    remarks = _raise_errors([*section_faults(definition, curves), *stock_faults(definition, hub)])
    surface = loft(curves)
    blade = _blade(definition, curves, surface, 0.0)
    splitter = None if definition.splitter is None else _blade(definition, curves, surface, definition.splitter)
    found = Impeller(definition, curves, blade, splitter, hub, shroud, remarks)
    _raise_errors(blade_faults(definition, list(found.blades()), hub, shroud))
    return found


def _raise_errors(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return warnings; raise ``InputError`` with all problems if one is an error."""
    found = tuple(problems)
    if any(problem.severity == Severity.ERROR for problem in found):
        raise InputError(found)
    return found


def _blade(
    definition: ImpellerDefinition, curves: tuple[BSplineCurve, ...], surface: BSplineSurface, start: float
) -> Blade:
    """Return the blade that begins at a share of its length; its round edges end where the measured points end."""
    half = np.array([definition.hub_thickness, definition.tip_thickness]) / 2.0
    ends = curves[0], curves[-1]
    leading = [_at_length(curve, start, radius) for curve, radius in zip(ends, half, strict=True)]
    if definition.trailing_edge == "cut":
        trailing = [_beyond_stock(definition, curve, radius) for curve, radius in zip(ends, half, strict=True)]
    else:
        trailing = [_at_length(curve, 1.0, -radius) for curve, radius in zip(ends, half, strict=True)]
    at = np.linspace(min(leading), max(trailing), 65)
    heights = np.linalg.norm(surface.points(at, np.ones(65)) - surface.points(at, np.zeros(65)), axis=1)
    low, high = np.minimum((2.0 * half + _BEYOND) / heights.min(), _MOST_BEYOND)
    edges = np.array([leading, trailing])
    return Blade(surface, edges, np.array([half, half]), -float(low), 1.0 + float(high))


def _at_length(curve: BSplineCurve, share: float, more: float) -> float:
    """Return the parameter at a share of a curve's length, and so many mm farther on."""
    at = np.linspace(0.0, 1.0, 2001)
    lengths = np.r_[0.0, np.cumsum(curve.lengths(at))]
    return float(np.interp(share * lengths[-1] + more, lengths, at))


def _beyond_stock(definition: ImpellerDefinition, curve: BSplineCurve, radius: float) -> float:
    """Return the parameter at which a curve that goes straight on beyond its end is outside of the stock with its edge.

    Raises ``InputError`` if it does not lead out of the stock.
    """
    (point,), (slope,) = curve.derivatives(np.ones(1), 1)
    outward = float(point[:2] @ slope[:2]) / float(np.hypot(*point[:2]))
    if outward < 0.2 * float(np.linalg.norm(slope)):
        raise InputError(definition.problem("blade.trailing_edge", Wording("IMP213", "trailing_edge_does")))
    missing = definition.stock.diameter / 2.0 - float(np.hypot(*point[:2])) + radius + _BEYOND
    return 1.0 + max(missing, radius + _BEYOND) / outward


def rotated(points: Floats, angle: float) -> Floats:
    """Points (k, 3) turned about Z by an angle in radians."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]))
