"""Bodies as pieces whose hulls say how far they are apart.

A piece is exact where it fills its hull: a convex body, one of the convex parts that a mesh consists of, a flat face, a
frustum of a tool. The hulls of the other pieces stand out beyond them: what they say is a bound, and their triangles
decide.
"""

from collections.abc import Iterator
from dataclasses import field
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints, distinct
from trunnion.extras import import_extra
from trunnion.records import dataclass
from trunnion.simulation.collisions.bodies import section_outline
from trunnion.simulation.collisions.hull_points import HullPoints, hull_points
from trunnion.simulation.meshes import TriangleMesh, revolved_mesh
from trunnion.simulation.tools.profile import Section

#: A mesh fills its hull where it lacks no more of its volume, or a face of its area.
_FILLED: Final = 1e-6

#: Parts into which a mesh falls, beyond which it stays whole; and pieces of a part that is not convex.
_MOST_PARTS: Final = 64
_MOST_PIECES: Final = 48


@dataclass(frozen=True, slots=True, eq=False)
class HullPiece:
    """A part of a body.

    corners  (n, 3) float64, mm: those of its hull, in the frame of the body's mesh
    mesh     its surface
    exact    whether it fills its hull
    hollow   whether it is of the surface of a body alone
    hull     its corners, in blocks
    """

    corners: Floats
    mesh: TriangleMesh
    exact: bool
    hollow: bool = False
    hull: HullPoints = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "hull", hull_points(self.corners))


def section_pieces(section: Section, pose: Floats) -> tuple[HullPiece, ...]:
    """Return the frustums of a section of a tool; ``pose`` (4, 4) maps the frame of the tool into that of the body."""
    outline = section_outline(section)
    found = []
    for (r0, z0), (r1, z1) in pairwise(outline.tolist()):
        if z1 - z0 > 1e-9:
            mesh = revolved_mesh(np.array([(0.0, z0), (r0, z0), (r1, z1), (0.0, z1)])).moved(pose)
            found.append(HullPiece(_hull_corners(mesh.vertices), mesh, exact=True))
    return tuple(found)


def mesh_pieces(mesh: TriangleMesh) -> tuple[HullPiece, ...]:
    """Return the pieces of a mesh: all of its surface is in them, and what is within exact ones."""
    parts = list(_parts(mesh))
    if len(parts) > _MOST_PARTS or any(part.volume < 0.0 for part in parts):
        parts = [mesh]
    return tuple(piece for part in parts for piece in _pieces_of_part(part))


def _pieces_of_part(part: TriangleMesh) -> Iterator[HullPiece]:
    scipy_spatial = import_extra("scipy.spatial", "place")
    try:
        hull = scipy_spatial.ConvexHull(part.vertices)
    except scipy_spatial.QhullError:  # flat
        yield HullPiece(part.vertices, part, exact=False, hollow=True)
        return
    if part.volume >= (1.0 - _FILLED) * hull.volume:
        yield HullPiece(np.ascontiguousarray(part.vertices[hull.vertices]), part, exact=True)
        return
    for faces in _face_groups(part):
        piece = _some_faces(part, faces)
        yield HullPiece(_hull_corners(piece.vertices), piece, _fills_its_hull(piece), hollow=True)


def _parts(mesh: TriangleMesh) -> Iterator[TriangleMesh]:
    """Yield the parts of a mesh that hang together; corners at one place are one."""
    sparse = import_extra("scipy.sparse", "place")
    places, own = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    faces = own.reshape(-1)[mesh.faces]
    ends = np.concatenate((faces[:, :2], faces[:, 1:]))
    graph = sparse.coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(places), len(places)))
    _, label = sparse.csgraph.connected_components(graph, directed=False)
    of_face = label[faces[:, 0]]
    for part in distinct(of_face).tolist():
        yield _some_faces(mesh, np.flatnonzero(of_face == part))


def _some_faces(mesh: TriangleMesh, faces: Ints) -> TriangleMesh:
    used, own = np.unique(mesh.faces[faces], return_inverse=True)
    return TriangleMesh(mesh.vertices[used], own.reshape(-1, 3), mesh.name)


def _face_groups(part: TriangleMesh) -> Iterator[Ints]:
    """Yield the flat faces of a part if they are few, each with all its triangles; else triangles that lie together."""
    corners = part.vertices[part.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normals, axis=1)
    unit = normals / np.maximum(size, 1e-300)[:, None]
    away = np.einsum("ij,ij->i", unit, corners[:, 0])
    plane = np.round(np.column_stack((unit / 1e-6, away / 1e-5)))
    _, label = np.unique(plane, axis=0, return_inverse=True)
    label = label.reshape(-1)
    if label.max() < _MOST_PIECES:
        yield from (np.flatnonzero(label == k) for k in range(int(label.max()) + 1))
        return
    yield from _halved(corners.mean(axis=1), np.arange(len(corners)), _MOST_PIECES)


def _halved(middles: Floats, faces: Ints, count: int) -> Iterator[Ints]:
    """Triangles in groups of as many, each time across the longest side of where they lie."""
    if count < 2 or len(faces) < 2:
        yield faces
        return
    own = middles[faces]
    order = np.argsort(own[:, int(np.argmax(np.ptp(own, axis=0)))], kind="stable")
    half = len(faces) // 2
    yield from _halved(middles, faces[order[:half]], count // 2)
    yield from _halved(middles, faces[order[half:]], count - count // 2)


def _hull_corners(points: Floats) -> Floats:
    """Return the corners of the hull of points (n, 3); of flat ones all of them."""
    scipy_spatial = import_extra("scipy.spatial", "place")
    try:
        return np.ascontiguousarray(points[scipy_spatial.ConvexHull(points).vertices])
    except scipy_spatial.QhullError:
        return np.ascontiguousarray(points)


def _fills_its_hull(piece: TriangleMesh) -> bool:
    """Whether the triangles of a flat piece cover its hull."""
    corners = piece.vertices[piece.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if len(normals) == 1:
        return True
    normal = normals.sum(axis=0)
    area = float(np.linalg.norm(normal))
    if area <= 0.0:
        return False
    normal /= area
    if np.ptp(piece.vertices @ normal) > 1e-5 or (normals @ normal < 0.0).any():
        return False
    across = np.linalg.svd(normal[None])[2][1:]
    scipy_spatial = import_extra("scipy.spatial", "place")
    try:
        hull = scipy_spatial.ConvexHull(piece.vertices @ across.T)
    except scipy_spatial.QhullError:
        return False
    return bool(area / 2.0 >= (1.0 - _FILLED) * hull.volume)
