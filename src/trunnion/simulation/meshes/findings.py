"""What is wrong with a mesh: open edges, facets turned against each other, inside out, too small to be in mm."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

#: A body whose largest extent is less is taken for one in metres, mm.
SMALLEST_EXTENT: Final = 1.5

#: A body whose largest extent is more is taken for one in a wrong unit, mm.
LARGEST_EXTENT: Final = 20_000.0

#: How many places of open edges are told.
_PLACES: Final = 3


@dataclass(frozen=True, slots=True)
class MeshFindings:
    """What is wrong with a mesh.

    open_edges   edges of one facet only, or of three: the surface has holes there
    places       middles of the first few of them, mm
    turned       edges whose two facets are seen from different sides
    inside_out   the surface is closed, and its facets are seen from inside
    """

    open_edges: int
    places: tuple[tuple[float, float, float], ...]
    turned: int
    inside_out: bool

    @property
    def is_closed(self) -> bool:
        """Whether the mesh has an inside: no edge is open, and all facets agree on their sides."""
        return not self.open_edges and not self.turned


def judge_mesh(mesh: TriangleMesh) -> MeshFindings:
    """Find what is wrong with a mesh whose facets share their vertices."""
    begin = mesh.faces.reshape(-1)
    end = np.roll(mesh.faces, -1, axis=1).reshape(-1)
    key = np.minimum(begin, end) * np.int64(len(mesh.vertices)) + np.maximum(begin, end)
    order = np.argsort(key, kind="stable")
    key = key[order]
    first = np.flatnonzero(np.concatenate((np.ones(min(1, len(key)), np.bool_), key[1:] != key[:-1])))
    if not len(first):
        return MeshFindings(0, (), 0, False)
    count = np.diff(np.append(first, len(key)))
    balance = np.add.reduceat(np.where(begin[order] < end[order], 1, -1), first)
    is_open = count % 2 == 1
    turned = int(np.count_nonzero(~is_open & (balance != 0)))
    places = _middles(mesh.vertices, key[first[is_open]][:_PLACES])
    closed = not turned and not is_open.any()
    return MeshFindings(int(np.count_nonzero(is_open)), places, turned, closed and mesh.volume < 0.0)


def _middles(vertices: Floats, keys: Ints) -> tuple[tuple[float, float, float], ...]:
    middles = (vertices[keys // len(vertices)] + vertices[keys % len(vertices)]) / 2.0
    return tuple((float(x), float(y), float(z)) for x, y, z in middles)
