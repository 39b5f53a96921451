"""Exact solids of tools, sweeps and stock, by manifold3d: a judge that shares nothing with the rays."""

import itertools
import math
from collections.abc import Iterable, Sequence

import numpy as np
from manifold3d import CrossSection, Error, Manifold, Mesh64, OpType

from trunnion.arrays import Floats
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.tools.profile import Element, ProfileArc, Role, ToolShape

#: Facets around a tool, and along a round corner: 0.0006 of the radius is lost between them.
_AROUND = 96
_ARC = 24


def box(low: Sequence[float], high: Sequence[float]) -> Manifold:
    """A box."""
    size = np.array(high, np.float64) - np.array(low, np.float64)
    return Manifold.cube(size).translate(np.array(low, np.float64))


def cutter(shape: ToolShape) -> Manifold:
    """What cuts of a tool, its tip at the origin."""
    points = [(0.0, 0.0)]
    for section in shape.sections:
        if section.role is Role.CUTTER:
            points += [point for element in section.outline for point in _points(element)]
    points.append((0.0, points[-1][1]))
    return Manifold.revolve(CrossSection([np.array(points)]), _AROUND)


def _points(element: Element) -> list[tuple[float, float]]:
    if not isinstance(element, ProfileArc):
        return [element.start, element.end]
    (r, z), radius = element.centre, element.radius
    low, high = (math.asin((point[1] - z) / radius) for point in (element.start, element.end))
    turns = np.linspace(low, high, _ARC)[1:-1].tolist()
    return [element.start, *((r + radius * math.cos(a), z + radius * math.sin(a)) for a in turns), element.end]


def swept(tool: Manifold, tips: Floats, axis: Sequence[float]) -> Manifold:
    """What a convex tool with a fixed axis goes through on lines between tips: hulls of both ends, all together."""
    up = np.array(axis, np.float64) / np.linalg.norm(axis)
    side = np.cross((0.31, 0.77, 0.55), up)
    side /= np.linalg.norm(side)
    turn = np.column_stack((side, np.cross(up, side), up))
    poses = [tool.transform(np.column_stack((turn, tip))) for tip in tips]
    hulls = [Manifold.batch_hull([one, other]) for one, other in itertools.pairwise(poses)]
    return Manifold.batch_boolean(hulls, OpType.Add)


def as_solid(mesh: TriangleMesh) -> Manifold:
    """A mesh as a solid; an error if it is none."""
    # It takes arrays that may be written only.
    solid = Manifold(Mesh64(mesh.vertices.copy(order="C"), mesh.faces.astype(np.uint64, order="C")))
    if solid.status() != Error.NoError:
        raise ValueError(f"{mesh.name} is no solid: {solid.status()}")
    return solid


def difference(one: Manifold, other: Manifold) -> float:
    """Volume that only one of two solids has, mm³."""
    return float((one - other).volume() + (other - one).volume())


def crossings(solid: Manifold, begin: Iterable[float], end: Iterable[float]) -> list[float]:
    """Where a line goes into a solid or out of it, mm from its begin."""
    start, stop = np.array(list(begin)), np.array(list(end))
    length = float(np.linalg.norm(stop - start))
    return [hit.distance * length for hit in solid.ray_cast(start, stop)]
