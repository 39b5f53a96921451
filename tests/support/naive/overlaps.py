"""Where triangles cross and how deep points are inside of a surface, by NumPy and one point after the other."""

import numpy as np

from trunnion.arrays import Floats
from trunnion.simulation.collisions.queries import point_depths


def crossings(edges_of: Floats, faces: Floats) -> Floats:
    """Where the edges of triangles cross the triangles of the same rows, (k, 3); both (n, 3, 3)."""
    begin, way = edges_of, np.roll(edges_of, -1, axis=1) - edges_of
    u, v = faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]
    normal = np.cross(u, v)
    rise = np.einsum("nej,nj->ne", way, normal)
    height = np.einsum("nej,nj->ne", begin - faces[:, None, 0], normal)
    share = np.divide(-height, rise, out=np.full_like(rise, np.nan), where=rise != 0.0)
    points = begin + share[..., None] * way
    w, size = points - faces[:, None, 0], np.einsum("nj,nj->n", normal, normal)[:, None]
    s = np.einsum("nej,nj->ne", np.cross(w, v[:, None]), normal)
    t = np.einsum("nej,nj->ne", np.cross(u[:, None], w), normal)
    inside = (share >= 0.0) & (share <= 1.0) & (s >= 0.0) & (t >= 0.0) & (s + t <= size)
    return np.asarray(points[inside])


def deepest(points: Floats, corners: Floats) -> tuple[float, Floats]:
    """Return how deep the deepest point is, and the first that is; 0 and the origin if all are outside."""
    depths = np.empty(len(points))
    point_depths(np.ascontiguousarray(points), corners, depths)
    best = int(depths.argmax())
    return (float(depths[best]), np.asarray(points[best])) if depths[best] > 0.0 else (0.0, np.zeros(3))
