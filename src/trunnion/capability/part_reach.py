"""Which facets of a part the tip reaches along their normals, or near them."""

import math
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine
from trunnion.machines.reach import reached_points
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure
from trunnion.simulation.meshes import TriangleMesh

#: Directions on a ring around a normal.
_AROUND: Final = 12


@dataclass(frozen=True, slots=True, eq=False)
class PartReach:
    """What is reached of the surface of a part.

    name      of its file
    lean      how far the tool axis may lean from the normal, degrees
    rings     how many rings of directions around each normal were tried
    area      of each facet, (m,) mm^2
    centre    of each facet, (m, 3) mm
    normal    unit vectors outwards, (m, 3)
    axis      the rotary axes give a tool axis for the facet, (m,)
    travel    and the slides reach all its corners with it, (m,)
    """

    name: str
    lean: Annotated[float, Figure(unit="deg")]
    rings: Annotated[int, NOT_DATA]
    area: Annotated[Floats, Figure("facets", take=len), Figure(unit="mm2", decimals=6, take=np.sum)]
    centre: Annotated[Floats, NOT_DATA]
    normal: Annotated[Floats, NOT_DATA]
    axis: Annotated[Flags, NOT_DATA]
    travel: Annotated[Flags, NOT_DATA]

    @property
    @Figure("reached_share", decimals=6)
    def share(self) -> float:
        """Share of the surface that is reached."""
        return float(self.area[self.travel].sum() / self.area.sum())

    @property
    @Figure("no_tool_axis")
    def without_axis(self) -> Ints:
        """Facets for which the rotary axes give no tool axis."""
        return np.asarray(np.flatnonzero(~self.axis))

    @property
    @Figure("no_travel")
    def without_travel(self) -> Ints:
        """Facets that have a tool axis with which the linear axes do not reach them."""
        return np.asarray(np.flatnonzero(self.axis & ~self.travel))

    @property
    def missed(self) -> Ints:
        """Facets that are not reached, the largest first."""
        rows = np.flatnonzero(~self.travel)
        return np.asarray(rows[np.argsort(-self.area[rows], kind="stable")])


def facet_reach(machine: Machine, mesh: TriangleMesh, lean: float, step: float) -> PartReach:
    """Judge all facets; directions that lean are tried on rings at most ``step`` degrees apart."""
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    twice = np.linalg.norm(across, axis=1)
    normal = across / twice[:, None]
    axis, travel = np.zeros(len(normal), np.bool_), np.zeros(len(normal), np.bool_)
    rings = math.ceil(lean / step - 1e-9)
    for tilt, azimuth in _directions(lean, rings):
        rows = np.flatnonzero(~travel)
        if not len(rows):
            break
        found = reached_points(machine, corners[rows], _leaning(normal[rows], tilt, azimuth), step)
        axis[rows] |= found.axis
        travel[rows] = found.travel
    return PartReach(mesh.name, lean, rings, 0.5 * twice, corners.mean(axis=1), normal, axis, travel)


def _directions(lean: float, rings: int) -> list[tuple[float, float]]:
    """Tilts and azimuths within a cone, radians: the normal itself, then rings."""
    tilts = [math.radians(lean) * (ring + 1) / rings for ring in range(rings)]
    return [(0.0, 0.0)] + [(tilt, 2.0 * math.pi * k / _AROUND) for tilt in tilts for k in range(_AROUND)]


def _leaning(normal: Floats, tilt: float, azimuth: float) -> Floats:
    """Return unit vectors (n, 3) that lean from normals by an angle, to a side."""
    if tilt == 0.0:
        return normal
    # Beside the coordinate in which the normal is shortest it is certainly not parallel to it.
    helper = np.eye(3)[np.abs(normal).argmin(axis=1)]
    first = np.cross(normal, helper)
    first /= np.linalg.norm(first, axis=1)[:, None]
    side = math.cos(azimuth) * first + math.sin(azimuth) * np.cross(normal, first)
    return np.asarray(math.cos(tilt) * normal + math.sin(tilt) * side)
