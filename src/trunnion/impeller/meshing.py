"""Closed meshes of the bodies of an impeller, and the impeller as their union.

In:     blade, fillet and profiles.
Out:    ``TriangleMesh``; vertices lie on the surfaces, facets within a tolerance of them.
Units:  mm.
"""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.extras import import_extra
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import Fillet
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

#: How far a fillet's body goes into the hub, as a part of its radius: more than facets are off.
_INTO: Final = 0.25


def turned_mesh(outline: Floats, segments: int) -> TriangleMesh:
    """Return the body that a polygon (k, 2) of radius and height sweeps about Z; its first and last points are on the
    axis.

    The polygon goes round the body's half section so that the body is on its right.
    """
    angle = 2.0 * np.pi * np.arange(segments) / segments
    rings = outline[1:-1]
    circle = np.column_stack((np.cos(angle), np.sin(angle)))
    points = np.empty((len(rings), segments, 3))
    points[:, :, :2] = rings[:, None, :1] * circle
    points[:, :, 2] = rings[:, 1:]
    top, low = np.array([[0.0, 0.0, outline[0, 1]]]), np.array([[0.0, 0.0, outline[-1, 1]]])
    vertices = np.vstack((points.reshape(-1, 3), top, low))
    ring = np.arange(len(rings) * segments).reshape(len(rings), segments)
    sides = _strip(ring[:-1], ring[1:])
    first = np.column_stack((np.full(segments, len(vertices) - 2), np.roll(ring[0], -1), ring[0]))
    last = np.column_stack((np.full(segments, len(vertices) - 1), ring[-1], np.roll(ring[-1], -1)))
    return _outward(TriangleMesh(vertices, np.vstack((sides, first, last))))


def blade_mesh(blade: Blade, along: int, around: int, across: int) -> TriangleMesh:
    """Return a blade from ``low`` to ``high``: ``across`` rings of points round it."""
    w = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, along))
    turn = np.linspace(0.0, 1.0, around + 2)[1:-1]
    rings = []
    for v in np.linspace(blade.low, blade.high, across):
        parts = [
            (*blade.sides(w, np.full(along, v), 1.0), w),
            (*blade.edge(1.0, turn, np.full(around, v)), np.ones(around)),
            (*blade.sides(w[::-1], np.full(along, v), -1.0), w[::-1]),
            (*blade.edge(0.0, turn, np.full(around, v)), np.zeros(around)),
        ]
        rings.append(np.vstack([c + blade.halves(at, np.full(len(at), v))[:, None] * m for c, m, at in parts]))
    size = len(rings[0])
    number = np.arange(across * size).reshape(across, size)
    low, high = _lid(number[0], along, around)[:, ::-1], _lid(number[-1], along, around)
    sides = _strip(number[:-1], number[1:])
    return _outward(TriangleMesh(np.vstack(rings), np.vstack((sides, low, high))))


def _lid(ring: Ints, along: int, around: int) -> Ints:
    """Triangles between the two sides of a ring: from the middle of the leading edge to that of the trailing edge."""
    size = len(ring)
    mirror = np.concatenate((np.arange(size - around)[::-1], size - 1 - np.arange(around)))
    order = np.concatenate((np.arange(size - around + around // 2, size), np.arange(along + (around + 1) // 2)))
    one, other = ring[order], ring[mirror[order]]
    a, b, c, d = one[:-1], other[:-1], one[1:], other[1:]
    faces = np.concatenate((np.column_stack((a, c, d)), np.column_stack((a, d, b))))
    a, b, c = faces.T
    return np.asarray(faces[(a != b) & (b != c) & (c != a)])


def fillet_mesh(fillet: Fillet, radius: float, steps: int) -> TriangleMesh:
    """Return the body between fillet, blade and hub, which goes a little into both."""
    count = len(fillet.centre)
    share = np.linspace(0.0, 1.0, steps + 1)[None, :, None]
    a, b = fillet.to_blade[:, None], fillet.to_hub[:, None]
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", fillet.to_blade, fillet.to_hub), -1.0, 1.0))[:, None, None]
    arc = (np.sin((1.0 - share) * angle) * a + np.sin(share * angle) * b) / np.sin(angle)
    centre = fillet.centre[:, None]
    upper, lower = fillet.inside[:, :, None]
    below = centre + (1.0 + _INTO) * radius * b
    vertices = np.concatenate((centre + radius * arc, below, lower, upper), axis=1).reshape(-1, 3)
    ring = np.arange(len(vertices)).reshape(count, -1)
    if fillet.is_closed:
        return _outward(TriangleMesh(vertices, _strip(ring, np.roll(ring, -1, axis=0))))
    # From the corner inside, the whole section is seen.
    first, last = (np.concatenate((one[-1:], one[:-2])) for one in (ring[0], ring[-1]))
    lids = np.column_stack((np.full(len(first) - 1, ring[0, -2]), first[1:], first[:-1]))
    ends = np.column_stack((np.full(len(last) - 1, ring[-1, -2]), last[:-1], last[1:]))
    return _outward(TriangleMesh(vertices, np.vstack((_strip(ring[:-1], ring[1:]), lids, ends))))


def _strip(first: Ints, second: Ints) -> Ints:
    """Triangles between rings (k, n) and the next ones (k, n), closed round each ring."""
    a, b = first, np.roll(first, -1, axis=1)
    c, d = second, np.roll(second, -1, axis=1)
    return np.concatenate((np.stack((a, b, d), axis=-1).reshape(-1, 3), np.stack((a, d, c), axis=-1).reshape(-1, 3)))


def _outward(mesh: TriangleMesh) -> TriangleMesh:
    return mesh if mesh.volume > 0.0 else mesh.turned_out()


def union(meshes: Sequence[TriangleMesh]) -> Any:
    """Return the union of bodies, as a solid of manifold3d."""
    kernel = import_extra("manifold3d", "impeller")
    return kernel.Manifold.batch_boolean([solid(mesh) for mesh in meshes], kernel.OpType.Add)


def solid(mesh: TriangleMesh) -> Any:
    """Return a closed mesh as a solid of manifold3d."""
    kernel = import_extra("manifold3d", "impeller")
    data = kernel.Mesh64(np.array(mesh.vertices), np.array(mesh.faces, np.uint64))
    return kernel.Manifold(data)
