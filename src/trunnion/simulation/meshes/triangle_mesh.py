"""A surface of triangles."""

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class TriangleMesh:
    """A surface of triangles, seen counter-clockwise from outside; read-only.

    vertices  (n, 3) float64  mm
    faces     (m, 3) int64    rows of ``vertices``
    name      what messages call it

    Raises
    ------
    ValueError
        If an array has another shape, or a face names a vertex that is not there.
    """

    vertices: Floats
    faces: Ints
    name: str = ""

    def __post_init__(self) -> None:
        vertices = np.ascontiguousarray(self.vertices, np.float64)
        faces = np.ascontiguousarray(self.faces, np.int64)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
            raise ValueError(f"vertices (n, 3) and faces (m, 3) are wanted, not {vertices.shape} and {faces.shape}")
        if len(faces) and not (faces.min() >= 0 and faces.max() < len(vertices)):
            raise ValueError("a face names a vertex that is not there")
        for name, array in (("vertices", vertices), ("faces", faces)):
            view = array.view()
            view.setflags(write=False)
            object.__setattr__(self, name, view)

    @property
    def bounds(self) -> Floats:
        """Lowest and highest coordinates, (2, 3) mm; the mesh must not be empty."""
        return np.stack((self.vertices.min(axis=0), self.vertices.max(axis=0)))

    @property
    def volume(self) -> float:
        """Enclosed volume, mm^3: negative if the mesh is inside out, without meaning if it leaks."""
        # About the middle of the mesh, so that a small one far from the origin loses no digits.
        corners = (self.vertices - self.vertices.mean(axis=0))[self.faces]
        return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0)

    def moved(self, pose: Floats) -> "TriangleMesh":
        """Return the mesh in another frame; ``pose`` (4, 4) maps this frame into that one, without mirroring."""
        return TriangleMesh(self.vertices @ pose[:3, :3].T + pose[:3, 3], self.faces, self.name)

    def named(self, name: str) -> "TriangleMesh":
        """Return the mesh with another name."""
        return TriangleMesh(self.vertices, self.faces, name)

    def turned_out(self) -> "TriangleMesh":
        """Return the mesh with all faces seen from their other side."""
        return TriangleMesh(self.vertices, self.faces[:, ::-1], self.name)
