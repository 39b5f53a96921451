"""Questions about two meshes in one pose: do they touch, how far are they apart, how deep are they in each other.

A pose (4, 4) maps the frame of the first mesh into that of the second. python-fcl answers what it can, within 1e-6 mm;
the depth is computed here, since that of a pair of triangles is not the depth of the bodies.
"""

import math
from dataclasses import field
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3
from trunnion.extras import import_extra
from trunnion.jit import inner, kernel
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh

#: How many contacts are asked for when the place of a touch is told.
_CONTACTS: Final = 4096

#: Points times triangles that one depth may cost.
_MOST_TESTS: Final = 20_000_000


@dataclass(slots=True, eq=False)
class Solid:
    """A mesh made ready for questions.

    centre, radius   of a ball around it, mm
    corners          of its triangles, (n, 3, 3) mm
    """

    mesh: TriangleMesh
    centre: Floats = field(init=False)
    radius: float = field(init=False)
    corners: Floats3 = field(init=False)
    model: Any = field(init=False)

    def __post_init__(self) -> None:
        fcl = import_extra("fcl", "simulate")
        self.model = fcl.BVHModel()
        self.model.beginModel(len(self.mesh.faces), len(self.mesh.vertices))
        self.model.addSubModel(self.mesh.vertices, self.mesh.faces)
        self.model.endModel()
        self.corners = np.ascontiguousarray(self.mesh.vertices[self.mesh.faces])
        self.centre = self.mesh.bounds.mean(axis=0)
        self.radius = float(np.linalg.norm(self.mesh.vertices - self.centre, axis=1).max())

    def object(self) -> Any:
        """Return an object of its own that can be moved."""
        fcl = import_extra("fcl", "simulate")
        return fcl.CollisionObject(self.model, fcl.Transform())


class PairQuery:
    """Answers questions about two solids, one pose after the other."""

    def __init__(self, one: Solid, other: Solid) -> None:
        self._fcl = import_extra("fcl", "simulate")
        self.one, self.other = one, other
        self._moving, self._still = one.object(), other.object()

    def distance(self, pose: Floats) -> float:
        """How far the surfaces are apart, mm; 0 where they touch. Less may be told if they are far apart."""
        middle = pose[:3, :3] @ self.one.centre + pose[:3, 3]
        apart = float(np.linalg.norm(middle - self.other.centre)) - self.one.radius - self.other.radius
        if apart > 0.25 * (self.one.radius + self.other.radius):
            return apart
        self._place(pose)
        return max(float(self._fcl.distance(self._moving, self._still, self._fcl.DistanceRequest())), 0.0)

    def touches(self, pose: Floats) -> bool:
        """Whether the surfaces meet."""
        self._place(pose)
        return bool(self._fcl.collide(self._moving, self._still, self._fcl.CollisionRequest()))

    def contact(self, pose: Floats) -> Floats:
        """Return the middle of where the surfaces meet, (3,) mm in the frame of the second."""
        self._place(pose)
        request = self._fcl.CollisionRequest(num_max_contacts=_CONTACTS, enable_contact=True)
        result = self._fcl.CollisionResult()
        self._fcl.collide(self._moving, self._still, request, result)
        pairs = np.array([(contact.b1, contact.b2) for contact in result.contacts], np.int64).reshape(-1, 2)
        one = self.one.corners[pairs[:, 0]] @ pose[:3, :3].T + pose[:3, 3]
        other = self.other.corners[pairs[:, 1]]
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        crossing_box(one, other, low, high)
        crossing_box(other, one, low, high)
        if low[0] > high[0]:  # the faces only touch
            return np.asarray(pose[:3, :3] @ self.one.centre + pose[:3, 3])
        return np.asarray((low + high) / 2.0)

    def contains(self, pose: Floats) -> bool:
        """Whether one of two solids whose surfaces do not meet is inside of the other."""
        back = np.linalg.inv(pose)
        one = self.one.mesh.vertices[:1] @ pose[:3, :3].T + pose[:3, 3]
        other = self.other.mesh.vertices[:1] @ back[:3, :3].T + back[:3, 3]
        return bool(_depth(one, self.other) > 0.0 or _depth(other, self.one) > 0.0)

    def depth(self, pose: Floats) -> tuple[float, Floats]:
        """How deep two solids that overlap are in each other, at least, and the place (3,) in the frame of the second.

        The deepest corner of either in the other counts, or what both have in common where they cross.
        """
        back = np.linalg.inv(pose)
        crossing = self.contact(pose)
        common = _depth(crossing[None], self.other)
        in_one = _depth((crossing @ back[:3, :3].T + back[:3, 3])[None], self.one)
        best, place = max(common, 0.0) + max(in_one, 0.0) if min(common, in_one) > 0.0 else 0.0, crossing
        corners = self.one.mesh.vertices @ pose[:3, :3].T + pose[:3, 3]
        deepest, at = _deepest_corner(corners, self.other)
        if deepest > best:
            best, place = deepest, at
        deepest, at = _deepest_corner(self.other.mesh.vertices @ back[:3, :3].T + back[:3, 3], self.one)
        if deepest > best:
            best, place = deepest, pose[:3, :3] @ at + pose[:3, 3]
        return best, place

    def nearest(self, pose: Floats) -> Floats:
        """Return the middle between the nearest points of two solids that do not touch, (3,) mm in the frame of the
        second.
        """
        self._place(pose)
        result = self._fcl.DistanceResult()
        distance = self._fcl.distance(
            self._moving, self._still, self._fcl.DistanceRequest(enable_nearest_points=True), result
        )
        one, other = (np.array(point) for point in result.nearest_points)
        if abs(float(np.linalg.norm(one - other)) - distance) > 1e-3 * (1.0 + distance):
            one, other = pose[:3, :3] @ one + pose[:3, 3], other
        return np.asarray((one + other) / 2.0)

    def _place(self, pose: Floats) -> None:
        self._moving.setTransform(self._fcl.Transform(pose[:3, :3], pose[:3, 3]))


@kernel(writes="low high")
def crossing_box(edges_of: Floats3, faces: Floats3, low: Floats, high: Floats) -> None:
    """Extend a box by the points where edges of triangles cross the triangles of the same rows, (n, 3, 3) both."""
    for k in range(faces.shape[0]):
        ax, ay, az = faces[k, 0, 0], faces[k, 0, 1], faces[k, 0, 2]
        ux, uy, uz = faces[k, 1, 0] - ax, faces[k, 1, 1] - ay, faces[k, 1, 2] - az
        vx, vy, vz = faces[k, 2, 0] - ax, faces[k, 2, 1] - ay, faces[k, 2, 2] - az
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        size = nx * nx + ny * ny + nz * nz
        for e in range(3):
            bx, by, bz = edges_of[k, e, 0], edges_of[k, e, 1], edges_of[k, e, 2]
            to = (e + 1) % 3
            dx, dy, dz = edges_of[k, to, 0] - bx, edges_of[k, to, 1] - by, edges_of[k, to, 2] - bz
            rise = dx * nx + dy * ny + dz * nz
            if rise == 0.0:
                continue
            share = -((bx - ax) * nx + (by - ay) * ny + (bz - az) * nz) / rise
            if not 0.0 <= share <= 1.0:
                continue
            px, py, pz = bx + share * dx, by + share * dy, bz + share * dz
            wx, wy, wz = px - ax, py - ay, pz - az
            s = (wy * vz - wz * vy) * nx + (wz * vx - wx * vz) * ny + (wx * vy - wy * vx) * nz
            t = (uy * wz - uz * wy) * nx + (uz * wx - ux * wz) * ny + (ux * wy - uy * wx) * nz
            if s >= 0.0 and t >= 0.0 and s + t <= size:
                low[0], low[1], low[2] = min(low[0], px), min(low[1], py), min(low[2], pz)
                high[0], high[1], high[2] = max(high[0], px), max(high[1], py), max(high[2], pz)


def touches(one: Solid, other: Solid, pose: Floats) -> bool:
    """Whether two solids overlap: their surfaces meet, or one is inside of the other."""
    query = PairQuery(one, other)
    return query.touches(pose) or query.contains(pose)


def _deepest_corner(points: Floats, solid: Solid) -> tuple[float, Floats]:
    low, high = solid.mesh.bounds
    points = points[((points > low) & (points < high)).all(axis=1)]
    place = np.zeros(3)
    if not len(points):
        return 0.0, place
    stride = max(1, math.ceil(len(points) * len(solid.corners) / _MOST_TESTS))
    return deepest_point(points[::stride], solid.corners, place), place


def _depth(point: Floats, solid: Solid) -> float:
    """How deep a point (1, 3) is inside of a solid, mm; negative outside."""
    depths = np.empty(1)
    point_depths(point, solid.corners, depths)
    return float(depths[0])


@kernel(writes="place")
def deepest_point(points: Floats2, corners: Floats3, place: Floats) -> float:
    """Return how deep the deepest of points (n, 3) is inside of a surface of triangles (m, 3, 3), and write its place.

    0 if all are outside. Depths are those of ``point_depths``; no more triangles are looked at for a point once one is
    so near that another point is deeper.
    """
    deepest = 0.0
    for k in range(points.shape[0]):
        px, py, pz = points[k, 0], points[k, 1], points[k, 2]
        nearest = np.inf
        for m in range(corners.shape[0]):
            nearest = min(
                nearest,
                _from_triangle(
                    corners[m, 0, 0] - px, corners[m, 0, 1] - py, corners[m, 0, 2] - pz,
                    corners[m, 1, 0] - px, corners[m, 1, 1] - py, corners[m, 1, 2] - pz,
                    corners[m, 2, 0] - px, corners[m, 2, 1] - py, corners[m, 2, 2] - pz,
                ),
            )  # fmt: skip
            if nearest <= deepest:
                break
        if nearest > deepest and _covering(px, py, pz, corners) > 2.0 * math.pi:
            deepest = nearest
            place[0], place[1], place[2] = px, py, pz
    return math.sqrt(deepest)


@inner
def _covering(px: float, py: float, pz: float, corners: Floats3) -> float:
    """How much of the sphere around a point triangles (m, 3, 3) cover: the sum of their solid angles."""
    angle = 0.0
    for m in range(corners.shape[0]):
        ax, ay, az = corners[m, 0, 0] - px, corners[m, 0, 1] - py, corners[m, 0, 2] - pz
        bx, by, bz = corners[m, 1, 0] - px, corners[m, 1, 1] - py, corners[m, 1, 2] - pz
        cx, cy, cz = corners[m, 2, 0] - px, corners[m, 2, 1] - py, corners[m, 2, 2] - pz
        la = math.sqrt(ax * ax + ay * ay + az * az)
        lb = math.sqrt(bx * bx + by * by + bz * bz)
        lc = math.sqrt(cx * cx + cy * cy + cz * cz)
        ab, bc, ca = ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz, cx * ax + cy * ay + cz * az
        volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        angle += 2.0 * math.atan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    return angle


@kernel(writes="depths")
def point_depths(points: Floats2, corners: Floats3, depths: Floats) -> None:
    """Write the distance of points (n, 3) from a surface of triangles (m, 3, 3), negative for points outside.

    A point is inside where the triangles, seen from it, cover the whole sphere: their solid angles add up to it.
    """
    for k in range(points.shape[0]):
        px, py, pz = points[k, 0], points[k, 1], points[k, 2]
        nearest = np.inf
        for m in range(corners.shape[0]):
            ax, ay, az = corners[m, 0, 0] - px, corners[m, 0, 1] - py, corners[m, 0, 2] - pz
            bx, by, bz = corners[m, 1, 0] - px, corners[m, 1, 1] - py, corners[m, 1, 2] - pz
            cx, cy, cz = corners[m, 2, 0] - px, corners[m, 2, 1] - py, corners[m, 2, 2] - pz
            nearest = min(nearest, _from_triangle(ax, ay, az, bx, by, bz, cx, cy, cz))
        distance = math.sqrt(nearest)
        depths[k] = distance if _covering(px, py, pz, corners) > 2.0 * math.pi else -distance


@inner
def _from_triangle(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float, cx: float, cy: float, cz: float
) -> float:
    """Squared distance of the origin from a triangle."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    nn = nx * nx + ny * ny + nz * nz
    if nn > 0.0:
        # Barycentric coordinates of the foot on the plane: within the triangle, the plane's distance counts.
        wx, wy, wz = -ax, -ay, -az
        s = ((wy * vz - wz * vy) * nx + (wz * vx - wx * vz) * ny + (wx * vy - wy * vx) * nz) / nn
        t = ((uy * wz - uz * wy) * nx + (uz * wx - ux * wz) * ny + (ux * wy - uy * wx) * nz) / nn
        if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
            height = ax * nx + ay * ny + az * nz
            return height * height / nn
    return min(
        _from_edge(ax, ay, az, bx, by, bz), _from_edge(bx, by, bz, cx, cy, cz), _from_edge(cx, cy, cz, ax, ay, az)
    )


@inner
def _from_edge(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """Squared distance of the origin from an edge."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    length = ux * ux + uy * uy + uz * uz
    share = 0.0 if length == 0.0 else min(max(-(ax * ux + ay * uy + az * uz) / length, 0.0), 1.0)
    x, y, z = ax + share * ux, ay + share * uy, az + share * uz
    return x * x + y * y + z * z
