"""A closed body as data: vertices, edges with their curves, faces with their surfaces.

In:     what the parts of an impeller add.
Out:    ``Body``, as a CAD kernel is told it.
Units:  mm and rad.

Each edge is there once, and both of its faces use it. On a face it has a second curve, in the parameters of the face's
surface, which goes with the curve in space: the same parameter is the same place.
"""

from collections.abc import Sequence
from dataclasses import field
from typing import TypeAlias

import numpy as np

from trunnion.arrays import Floats
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Spline:
    """A clamped cubic spline: in space, points (n, 3), or on a surface, points (n, 2)."""

    knots: Floats
    points: Floats


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line: ``origin`` + parameter · ``direction``, which has length 1; in space or on a surface."""

    origin: tuple[float, ...]
    direction: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle about Z at a height, by the angle from X; on a plane that lies across Z the height does not count."""

    radius: float
    height: float


Curve: TypeAlias = Spline | Line | Circle


@dataclass(frozen=True, slots=True, eq=False)
class SplineSurface:
    """A surface of degree 3 by 3, points (n, m, 3)."""

    u_knots: Floats
    v_knots: Floats
    points: Floats


@dataclass(frozen=True, slots=True, eq=False)
class TurnedSurface:
    """A curve turned about Z: u is the angle from the curve, v the curve's parameter."""

    curve: Spline


@dataclass(frozen=True, slots=True)
class Plane:
    """A plane across Z: u is X, v is Y."""

    height: float


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder about Z: u is the angle from ``start``, v the height."""

    radius: float
    start: float


Surface: TypeAlias = SplineSurface | TurnedSurface | Plane | Cylinder


@dataclass(frozen=True, slots=True, eq=False)
class Edge:
    """An edge from one vertex to another; without a curve it is a point, where a turned surface touches the axis."""

    curve: Curve | None
    ends: tuple[int, int]
    span: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class EdgeUse:
    """How a face goes along an edge, and the edge's curve in the parameters of its surface."""

    edge: int
    backwards: bool
    flat: Curve


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A face: the first loop round it counter-clockwise in its parameters, the others round holes.

    outward  whether the cross product of the surface's derivatives by u and by v points out of the body
    """

    surface: Surface
    loops: Sequence[Sequence[EdgeUse]]
    outward: bool


@dataclass(slots=True, eq=False)
class Body:
    """A body that grows until it is closed."""

    vertices: list[Floats] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)
    faces: list[Face] = field(default_factory=list)

    def vertex(self, point: Floats) -> int:
        """Add a vertex (3,); its number."""
        self.vertices.append(np.array(point, float))
        return len(self.vertices) - 1

    def edge(self, curve: Curve | None, ends: tuple[int, int], span: tuple[float, float]) -> int:
        """Add an edge; its number."""
        self.edges.append(Edge(curve, ends, (float(span[0]), float(span[1]))))
        return len(self.edges) - 1

    def face(self, surface: Surface, loops: Sequence[Sequence[EdgeUse]], *, outward: bool) -> None:
        """Add a face."""
        self.faces.append(Face(surface, loops, outward))


def along_u(u: float, v: float) -> Line:
    """Return the line on a surface from a place along u."""
    return Line((float(u), float(v)), (1.0, 0.0))


def along_v(u: float, v: float) -> Line:
    """Return the line on a surface from a place along v."""
    return Line((float(u), float(v)), (0.0, 1.0))
