"""How far pieces are apart whose hulls stand out beyond them: their triangles say it."""

from typing import Any

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.records import dataclass
from trunnion.simulation.collisions.hull_gap import pose_gap
from trunnion.simulation.collisions.hull_pieces import HullPiece
from trunnion.simulation.collisions.hull_points import HullPoints, hull_points
from trunnion.simulation.collisions.queries import Solid, point_depths
from trunnion.simulation.meshes import TriangleMesh


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceGap:
    """A distance, mm, and the points (n, 3) of both pieces whose hulls are as far apart, each in its own frame."""

    distance: float
    one: Floats
    other: Floats


class SurfacePair:
    """Two pieces, made ready for questions."""

    def __init__(self, one: HullPiece, other: HullPiece) -> None:
        self._fcl: Any = import_extra("fcl", "simulate")
        self._one, self._other = one, other
        self._moving, self._still = Solid(one.mesh).object(), Solid(other.mesh).object()
        self._up = np.array([0.0, 0.0, 1.0])

    def gap(self, pose: Floats) -> SurfaceGap:
        """How far the pieces are apart; ``pose`` (4, 4) maps the frame of the first into that of the second."""
        one, other = self._one, self._other
        if one.exact and self._holds(one.hull, hull_points(other.mesh.vertices[:1]), pose):
            return SurfaceGap(0.0, one.corners, other.mesh.vertices[:1])
        if other.exact and self._holds(hull_points(one.mesh.vertices[:1]), other.hull, pose):
            return SurfaceGap(0.0, one.mesh.vertices[:1], other.corners)
        self._moving.setTransform(self._fcl.Transform(pose[:3, :3], pose[:3, 3]))
        result = self._fcl.DistanceResult()
        distance = float(self._fcl.distance(self._moving, self._still, self._fcl.DistanceRequest(), result))
        ends = one.mesh.vertices[one.mesh.faces[result.b1]], other.mesh.vertices[other.mesh.faces[result.b2]]
        return SurfaceGap(max(distance, 0.0), *map(np.ascontiguousarray, ends))

    def _holds(self, one: HullPoints, other: HullPoints, pose: Floats) -> bool:
        """Whether a point is in a hull."""
        return pose_gap(one, other, pose, self._up.copy())[1] <= 0.0

    @staticmethod
    def depth_inside(one: TriangleMesh, other: TriangleMesh, pose: Floats) -> tuple[Floats, Floats, float] | None:
        """Return a point of one body that is inside of another, in the frame of either, (1, 3), and how deep, mm; or
        None.
        """
        point = one.vertices[:1] @ pose[:3, :3].T + pose[:3, 3]
        if (depth := _depth(point, other)) > 0.0:
            return one.vertices[:1], point, depth
        back = np.linalg.inv(pose)
        point = other.vertices[:1] @ back[:3, :3].T + back[:3, 3]
        if (depth := _depth(point, one)) > 0.0:
            return point, other.vertices[:1], depth
        return None


def _depth(point: Floats, mesh: TriangleMesh) -> float:
    low, high = mesh.bounds
    if (point[0] <= low).any() or (point[0] >= high).any():
        return 0.0
    depths = np.empty(1)
    point_depths(np.ascontiguousarray(point), mesh.vertices[mesh.faces], depths)
    return float(depths[0])
