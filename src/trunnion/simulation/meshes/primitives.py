"""Meshes of boxes, cylinders and solids of revolution."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

#: How far the flat sides of a round body may stand out beyond it, mm; a body is nowhere smaller than it is.
ROUND_EXCESS: Final = 0.02

_FEWEST_SIDES: Final = 12
_MOST_SIDES: Final = 256


def box_mesh(low: Floats, high: Floats, name: str = "") -> TriangleMesh:
    """Return the box between two corners, (3,) mm each."""
    corners = np.array([[x, y, z] for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])])
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return TriangleMesh(corners, np.array(faces), name)


def cylinder_mesh(
    diameter: float, low: float, high: float, name: str = "", excess: float = ROUND_EXCESS
) -> TriangleMesh:
    """Return a cylinder about Z between two heights; its sides stand out by at most ``excess``."""
    radius = diameter / 2.0
    return revolved_mesh(np.array([(0.0, low), (radius, low), (radius, high), (0.0, high)]), name, excess)


def revolved_mesh(outline: Floats, name: str = "", excess: float = ROUND_EXCESS) -> TriangleMesh:
    """Return a solid of revolution about Z.

    outline  (k, 2) float64, mm: radii and heights from the axis at the bottom, going up, back to the axis: the first
             and the last radius are 0
    name     of the mesh
    excess   its sides touch the round body from outside, and stand out by at most this, mm
    """
    sides = _sides(float(outline[:, 0].max()), excess)
    about = 2.0 * np.pi * np.arange(sides) / sides
    stretch = 1.0 / math.cos(math.pi / sides)
    circle = np.stack((np.cos(about), np.sin(about)), axis=1) * stretch
    rings = outline[1:-1]
    ring_points = np.concatenate(
        [np.concatenate((radius * circle, np.full((sides, 1), height)), axis=1) for radius, height in rings]
    )
    vertices = np.concatenate(([[0.0, 0.0, outline[0, 1]]], ring_points, [[0.0, 0.0, outline[-1, 1]]]))
    here = np.arange(sides)
    beside = (here + 1) % sides
    faces = [np.stack((np.zeros(sides, np.int64), 1 + beside, 1 + here), axis=1)]
    for ring in range(len(rings) - 1):
        a, b = 1 + ring * sides, 1 + (ring + 1) * sides
        faces += [
            np.stack((a + here, a + beside, b + beside), axis=1),
            np.stack((a + here, b + beside, b + here), axis=1),
        ]
    last, top = 1 + (len(rings) - 1) * sides, len(vertices) - 1
    faces.append(np.stack((last + here, last + beside, np.full(sides, top)), axis=1))
    return TriangleMesh(vertices, np.concatenate(faces), name)


def _sides(radius: float, excess: float) -> int:
    """Return number of sides, a multiple of four, that keeps the excess."""
    if radius <= excess:
        return _FEWEST_SIDES
    wanted = math.pi / math.acos(radius / (radius + excess))
    return min(max(4 * math.ceil(wanted / 4.0), _FEWEST_SIDES), _MOST_SIDES)
