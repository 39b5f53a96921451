"""The impeller as a closed mesh.

In:     ``Impeller``.
Out:    ``ImpellerModel``: the mesh, and how far it is off the exact surfaces.
Units:  mm.
"""

import math
from collections.abc import Iterator
from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats, Ints, distinct
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.impeller.blade import Blade
from trunnion.impeller.deviation import off_surfaces
from trunnion.impeller.faults import fillet_faults, no_place
from trunnion.impeller.fillet import Fillet, FilletError, root_fillet, root_stations
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.meshing import blade_mesh, fillet_mesh, solid, turned_mesh, union
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Figure
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

#: Part of the tolerance that each kind of facet takes: along and across, and what simplifying adds, make one together.
_SHARE: Final = 0.3

#: The deviation is measured at so many vertices and middles of facets, or a few more.
_SAMPLES: Final = 20_000

#: Rings of points round a blade, from below the hub to above the shroud.
_RINGS: Final = 33

#: Facets are off by no more than this part of a fillet's radius, whose body goes a quarter of it into blade and hub.
_OF_FILLET: Final = 0.2

#: Facets that change the surface by less than this part of the tolerance are joined.
_SIMPLER: Final = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class ImpellerModel:
    """A closed mesh of an impeller.

    volume     mm³
    deviation  how far vertices and middles of facets are from the exact surfaces at most, mm
    """

    mesh: Annotated[
        TriangleMesh,
        Figure("facets", take=lambda mesh: len(mesh.faces), after="volume_mm3"),
        Figure("extents", take=attrgetter("bounds"), after="deviation_mm"),
    ]
    volume: Annotated[float, Figure(unit="mm3", decimals=6)]
    deviation: Annotated[float, Figure(unit="mm", decimals=6)]


def impeller_model(impeller: Impeller, tolerance: float) -> ImpellerModel:
    """Make a closed mesh of an impeller.

    impeller   its surfaces
    tolerance  mm: how far facets may be off the surfaces

    Raises ``InputError`` if the fillet finds no place, the bodies make no closed solid, or its facets are farther off
    than the tolerance.
    """
    definition = impeller.definition
    share = min(_SHARE * tolerance, _OF_FILLET * definition.fillet)
    stock = definition.stock
    segments = _segments(stock.diameter / 2.0, share)
    fillets = _fillets(impeller, share)
    far, bottom = stock.height + stock.diameter, stock.bottom - stock.height
    hub, shroud = (_below(one.outline(share, far), bottom) for one in (impeller.hub, impeller.shroud))
    bodies = [turned_mesh(hub, segments), *_blade_bodies(impeller, fillets, share)]
    blank = turned_mesh(_cylinder(stock.diameter / 2.0, stock.top, stock.bottom), segments)
    found = union(bodies) ^ solid(turned_mesh(shroud, segments)) ^ solid(blank)
    if stock.bore:
        found -= solid(turned_mesh(_cylinder(stock.bore / 2.0, stock.top + 1.0, stock.bottom - 1.0), segments))
    data = found.simplify(_SIMPLER * tolerance).to_mesh64()
    vertices, faces = np.asarray(data.vert_properties)[:, :3], np.asarray(data.tri_verts).astype(np.int64)
    faces = faces if found.status() == import_extra("manifold3d", "impeller").Error.NoError else faces[:0]
    mesh = TriangleMesh(*_joined(vertices, faces), definition.name)
    if not is_closed(mesh.faces):
        raise InputError(Problem(definition.file, 0, Wording("IMP220", "bodies_make_no")))
    points = np.vstack((mesh.vertices, mesh.vertices[mesh.faces].mean(axis=1)))
    deviation = float(off_surfaces(impeller, points[:: max(1, len(points) // _SAMPLES)], fillets).max())
    if deviation > tolerance:
        raise InputError(
            Problem(definition.file, 0, Wording("IMP220", "facets_would_mm", deviation=deviation, tolerance=tolerance))
        )
    return ImpellerModel(mesh, mesh.volume, deviation)


def _joined(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Vertices and facets of a mesh without edges that have no length in the numbers of an STL file."""
    _, first, number = np.unique(vertices.astype(np.float32), axis=0, return_index=True, return_inverse=True)
    a, b, c = faces = number.ravel()[faces].T
    faces = np.ascontiguousarray(faces[:, (a != b) & (b != c) & (c != a)].T)
    _, one, count = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    return vertices[first], faces[count[one.ravel()] == 1]  # a facet and its back have nothing between them


def is_closed(faces: Ints) -> bool:
    """Whether each edge of a mesh belongs to two facets that go along it in opposite directions."""
    a, b = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    size = int(faces.max(initial=0)) + 1
    edges, count = np.unique(a * size + b, return_counts=True)
    return len(faces) > 0 and bool((count == 1).all()) and np.array_equal(edges, distinct(b * size + a))


def _fillets(impeller: Impeller, tolerance: float) -> list[tuple[Blade, Fillet]]:
    """Return the fillet of the blade, and of the splitter if there is one.

    Raises ``InputError`` if one finds no place.
    """
    definition, blades = impeller.definition, list(impeller.blades())
    # The ball goes round the edges on a circle that is by its own radius larger than theirs.
    around = _segments(definition.hub_thickness / 2.0 + definition.fillet, tolerance) // 2
    is_round = definition.trailing_edge == "round"
    stations = root_stations(2 * _count(impeller, tolerance), max(around, 24), round_trailing=is_round)
    found = []
    for blade in [impeller.blade] if impeller.splitter is None else [impeller.blade, impeller.splitter]:
        try:
            fillet = root_fillet(blade, impeller.hub, definition.fillet, stations)
        except FilletError as error:
            raise InputError(no_place(definition, error)) from None
        found.append((blade, fillet))
    problems = list(fillet_faults(definition, found[0][1].centre, definition.fillet, blades))
    if problems:
        raise InputError(problems)
    return found


def _blade_bodies(impeller: Impeller, fillets: list[tuple[Blade, Fillet]], tolerance: float) -> Iterator[TriangleMesh]:
    """All blades, splitters and their fillets."""
    definition = impeller.definition
    around = max(_segments(definition.hub_thickness / 2.0, tolerance) // 2, 6)
    steps = max(_segments(definition.fillet, tolerance) // 3, 6)
    for own, fillet in fillets:
        meshes = (
            blade_mesh(own, _count(impeller, tolerance), around, _RINGS),
            fillet_mesh(fillet, definition.fillet, steps),
        )
        for blade, angle in impeller.blades():
            if blade is own:
                yield from (TriangleMesh(rotated(mesh.vertices, angle), mesh.faces) for mesh in meshes)


def _segments(radius: float, tolerance: float) -> int:
    """So many chords make a full circle within a tolerance."""
    return max(24, math.ceil(math.pi / math.acos(max(1.0 - tolerance / radius, -1.0))))


def _count(impeller: Impeller, tolerance: float) -> int:
    """Places along a blade, so that chords are within a tolerance: their sag goes with the square of their length."""
    curve = impeller.curves[-1]
    at = np.linspace(0.0, 1.0, 201)
    bend = np.linalg.norm(curve.curvatures(at), axis=1).max()
    length = float(curve.lengths(np.array([0.0, 1.0]))[0])
    return max(41, math.ceil(1.6 * length / math.sqrt(8.0 * tolerance / max(float(bend), 1e-6))))


def _cylinder(radius: float, top: float, bottom: float) -> Floats:
    """Return the outline of a cylinder about Z."""
    return np.array([[0.0, top], [radius, top], [radius, bottom], [0.0, bottom]])


def _below(outline: Floats, bottom: float) -> Floats:
    """Return the outline of the body below a profile: from the axis along the profile, down, and back to the axis.

    ``bottom`` is lower where the profile is: an outline that crosses itself would turn the body inside out.
    """
    first, last = outline[0], outline[-1]
    bottom = min(bottom, float(outline[:, 1].min()) - 1.0)
    start = outline if first[0] <= 1e-9 else np.vstack(([[0.0, first[1]]], outline))
    return np.vstack((start, [[last[0], bottom], [0.0, bottom]]))
