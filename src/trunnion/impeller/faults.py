"""What makes no impeller: sections that cross themselves, a hub above the shroud, blades that overlap."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem
from trunnion.extras import import_extra
from trunnion.geometry.curves import BSplineCurve
from trunnion.geometry.point_tables import PointTable
from trunnion.impeller.blade import Blade
from trunnion.impeller.definition import ImpellerDefinition
from trunnion.impeller.fillet import FilletError
from trunnion.impeller.profiles import Profile
from trunnion.messages import Wording

_SAMPLES: Final = 400

#: Two places of a section are apart along it if the way is so many times the straight line.
_WAY: Final = 5.0

#: Sections that are nearer to each other are the same there, mm.
_APART: Final = 1e-3


#: A blade is farther out than its points where it goes straight on to the stock, mm.
_BEYOND: Final = 0.1


def direction_faults(definition: ImpellerDefinition) -> Iterator[Problem]:
    """Sections that do not go from the inlet, on top or near the axis, to the outlet."""
    for table in definition.sections:
        across, up = np.hypot(*table.points[[0, -1], :2].T), table.points[[0, -1], 2]
        if across[1] - across[0] <= up[1] - up[0]:
            way = "from radius {:.4g} and height {:.4g} to {:.4g} and {:.4g}".format(
                *np.column_stack((across, up)).flat
            )
            yield Problem(
                table.file, table.lines[0], Wording("IMP210", "goes_upward_inward", table_called=table.called, way=way)
            )


def section_faults(definition: ImpellerDefinition, curves: Sequence[BSplineCurve]) -> Iterator[Problem]:
    """Yield what is wrong with the sections of a blade."""
    thickness = max(definition.hub_thickness, definition.tip_thickness)
    for table, curve in zip(definition.sections, curves, strict=True):
        yield from _crossings(table, curve, thickness)
    for below, curve, above in zip(definition.sections, curves, definition.sections[1:], strict=False):
        height = Profile.of_curve(curve).distances(above.points)[0]
        for k in np.flatnonzero(height <= _APART)[:1].tolist():
            yield Problem(
                above.file,
                above.lines[k],
                Wording(
                    "IMP210", "mm_below_named", above_called=above.called, height=-height[k], below_called=below.called
                )
                if height[k] < -_APART
                else Wording("IMP210", "same_here_named", above_called=above.called, below_called=below.called),
            )


def _crossings(table: PointTable, curve: BSplineCurve, thickness: float) -> Iterator[Problem]:
    """Yield the first place where a section comes so near to itself that the blade would meet itself."""
    at = np.linspace(0.0, 1.0, _SAMPLES + 1)
    points = curve.points(at)
    lengths = np.r_[0.0, np.cumsum(curve.lengths(at))]
    near = import_extra("scipy.spatial", "impeller").cKDTree(points).query_pairs(thickness, output_type="ndarray")
    way = np.abs(lengths[near[:, 0]] - lengths[near[:, 1]])
    straight = np.linalg.norm(points[near[:, 0]] - points[near[:, 1]], axis=1)
    found = near[(way > _WAY * straight) & (way > _WAY * thickness)]
    if len(found):
        one, other = (_line(table, points[k]) for k in found[0])
        yield Problem(
            table.file, one, Wording("IMP211", "crosses_itself_nearly", table_called=table.called, other=other)
        )


def _line(table: PointTable, place: Floats) -> int:
    """Return the line of the point that is nearest to a place."""
    return table.lines[int(np.linalg.norm(table.points - place, axis=1).argmin())]


def blade_faults(
    definition: ImpellerDefinition, blades: Sequence[tuple[Blade, float]], hub: Profile, shroud: Profile
) -> Iterator[Problem]:
    """Yield what is wrong between the blades, and between them, hub and shroud."""
    first, _ = blades[0]
    w, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0.0, 1.0, 41), np.linspace(0.0, 1.0, 13)))
    centre, half = first.frames(w, v)[0], first.halves(w, v)
    radius = definition.stock.diameter / 2.0
    inside = np.hypot(centre[:, 0], centre[:, 1]) <= radius
    for other, angle in blades[1:2]:
        turned = centre @ _turn(angle)
        gap = other.distances(turned)[0] - half
        k = int(np.where(inside, gap, np.inf).argmin())
        if gap[k] <= 0.0:
            table = definition.sections[0 if v[k] < 0.5 else -1]
            yield Problem(table.file, _line(table, centre[k]), Wording("IMP212", "blades_overlap_mm", gap=-gap[k]))
    edge = min(radius, max(float(np.hypot(*table.points[:, :2].T).max()) for table in definition.sections) + _BEYOND)
    w = np.linspace(0.0, 1.0, 201)
    foot, top = (first.frames(w, np.full(len(w), at))[0] for at in (first.low, first.high))
    for table, place, missing, body in (
        (definition.sections[0], foot, hub.distances(foot)[0] >= 0.0, "into the hub"),
        (definition.sections[-1], top, shroud.distances(top)[0] <= 0.0, "the shroud"),
    ):
        if not missing.any():
            continue
        k = int(missing.argmax())
        across = float(np.hypot(*place[k, :2]))
        if across > edge:
            yield definition.problem(
                "stock.diameter_mm", Wording("IMP213", "blade_goes_straight", body=body, across=across)
            )
        else:
            yield Problem(table.file, _line(table, place[k]), Wording("IMP213", "blade_does_not", body=body))


def fillet_faults(
    definition: ImpellerDefinition, centres: Floats, radius: float, blades: Sequence[tuple[Blade, float]]
) -> Iterator[Problem]:
    """Yield a fillet that has no room between two blades; ``centres`` (k, 3) are those of its ball."""
    limit = definition.stock.diameter / 2.0
    inside = centres[np.hypot(centres[:, 0], centres[:, 1]) <= limit]
    for other, angle in (blades[1], blades[-1]):
        gap = other.distances(inside @ _turn(angle))[0]
        k = int(gap.argmin())
        if gap[k] < radius:
            table = definition.sections[0]
            yield Problem(
                table.file, _line(table, inside[k]), Wording("IMP214", "fillet_mm_no", radius=radius, gap=gap[k])
            )
            return


def no_place(definition: ImpellerDefinition, error: FilletError) -> Problem:
    """Return a fillet that finds no place, at the row of the points that is nearest to where it finds none."""
    table, (problem,) = definition.sections[0], error.problems
    return Problem(table.file, _line(table, error.place), problem.wording.within("near_this_point"))


def _turn(angle: float) -> Floats:
    """Return the matrix that multiplies rows of points to turn them about Z by minus an angle in radians."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
