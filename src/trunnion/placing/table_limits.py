"""The table on which a part is clamped, as half-spaces of X and Y of the workpiece zero.

In:     what the machine's definition states of its table, and points of stock and part.
Out:    half-spaces, and what the outline of stock and part, seen from above, has left to the edges of the table.
Frames: the machine's, all axes at zero.
"""

from collections.abc import Iterator
from enum import StrEnum
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.machines.machine import Mount, Vector
from trunnion.placing.turning import hull_points, is_upright
from trunnion.records import dataclass
from trunnion.results import EXACT, NOT_DATA, Figure
from trunnion.simulation.stock.solids import StockShape

#: An outline that is beyond an edge by less is on the table, mm: zeros are in thousandths.
KEPT: Final = 1e-3

#: Corners of the polygon around a round stock, which is wider than it by 0.1 mm in 10 m.
_SIDES: Final = 720


class TableEdge(StrEnum):
    """The edges of a table; values are words for messages and data."""

    LOW_X = "low X"
    HIGH_X = "high X"
    LOW_Y = "low Y"
    HIGH_Y = "high Y"
    RIM = "rim"


#: In the order in which half-spaces number them.
EDGES: Final = tuple(TableEdge)


@dataclass(frozen=True, slots=True)
class EdgeLimit:
    """A half-space ``normal . (x, y) <= bound`` of the zero, mm, that keeps an outline inside of an edge."""

    normal: tuple[float, float]
    bound: float
    edge: TableEdge


@dataclass(frozen=True, slots=True)
class ClampingArea:
    """Where things may be clamped: a rectangle along X and Y, a disc, or what both have in common.

    centre    mm
    size      along X and Y, mm; None: no rectangle
    diameter  mm; None: no disc
    axis      the rotary axis on which the middle is taken to be; empty where it is stated, or there is none
    """

    centre: Annotated[tuple[float, float], Figure(unit="mm", decimals=EXACT, after="diameter_mm")]
    size: Annotated[tuple[float, float] | None, Figure(unit="mm", decimals=EXACT)] = None
    diameter: Annotated[float | None, Figure(unit="mm", decimals=EXACT)] = None
    axis: Annotated[str, NOT_DATA] = ""

    @staticmethod
    def of(machine: Machine) -> "ClampingArea | None":
        """Return what a definition states; None: it states no table.

        The middle is that of the definition, or else where the rotary axis about Z that carries the part stands.
        """
        facts = machine.facts
        if facts.table_size_mm is None and facts.table_diameter_mm is None:
            return None
        rotary = [machine.axes[k] for k in machine.own_rotary]
        under = [axis for axis in rotary if axis.mount is Mount.PART and is_upright(axis)]
        if facts.table_centre_mm is not None or not under:
            return ClampingArea(facts.table_centre_mm or (0.0, 0.0), facts.table_size_mm, facts.table_diameter_mm)
        return ClampingArea(under[0].point[:2], facts.table_size_mm, facts.table_diameter_mm, under[0].name)

    def has(self, zero: Vector) -> bool:
        """Whether a point of the machine frame, mm, is above it."""
        return TableLimits(self, np.zeros((1, 2))).left(np.array(zero)) >= -KEPT

    def edge_position(self, edge: TableEdge) -> float:
        """Where an edge is along its axis; of the rim the diameter; mm."""
        if edge is TableEdge.RIM:
            assert self.diameter is not None
            return self.diameter
        assert self.size is not None
        axis, sign = int(edge in (TableEdge.LOW_Y, TableEdge.HIGH_Y)), -1.0 if "low" in edge else 1.0
        return self.centre[axis] + sign * 0.5 * self.size[axis]

    def __str__(self) -> str:
        rectangle = "" if self.size is None else f"{self.size[0]:g} x {self.size[1]:g}"
        disc = "" if self.diameter is None else f"Ø{self.diameter:g}"
        return f"{' within '.join(filter(None, (rectangle, disc)))} mm"


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """What stands on a table: its outermost points (k, 3) from the workpiece zero, mm, as it is clamped at turn 0."""

    area: ClampingArea
    points: Floats

    def turned(self, matrix: Floats) -> "Standing":
        """Return the same, turned about the workpiece zero by a matrix (3, 3)."""
        return Standing(self.area, self.points @ matrix.T)

    def limits(self) -> "TableLimits":
        """Return what the table asks of the zero."""
        flat = np.column_stack((self.points[:, :2], np.zeros(len(self.points))))
        return TableLimits(self.area, np.ascontiguousarray(flat[hull_points(flat), :2]))


@dataclass(frozen=True, slots=True, eq=False)
class TableLimits:
    """The limits of a table for one outline: the corners (h, 2) of its hull seen from above, from the zero, mm."""

    area: ClampingArea
    corners: Floats

    @property
    def extent(self) -> tuple[float, float]:
        """The size of the outline along X and Y, mm."""
        x, y = np.ptp(self.corners, axis=0).tolist()
        return x, y

    def left(self, zero: Floats) -> float:
        """Return what the outline has left to the nearest edge with the zero (3,) there, mm; negative beyond it."""
        from_centre = self.corners + zero[:2] - self.area.centre
        least = np.inf
        if self.area.size is not None:
            least = float((0.5 * np.array(self.area.size) - np.abs(from_centre)).min())
        if self.area.diameter is not None:
            least = min(least, 0.5 * self.area.diameter - float(np.hypot(*from_centre.T).max()))
        return least

    def nearest_edges(self, zero: Floats) -> list[TableEdge]:
        """Return the edges to which the outline has the least left with the zero (3,) there."""
        limits = [*self.straight_edges(), *filter(None, (self.rim_at(zero),))]
        left = [limit.bound - float(np.dot(limit.normal, zero[:2])) for limit in limits]
        return [limit.edge for limit, one in zip(limits, left, strict=True) if one <= min(left) + KEPT]

    def straight_edges(self) -> Iterator[EdgeLimit]:
        """Yield the half-spaces of a rectangle: of all its edges."""
        if self.area.size is None:
            return
        low, high = self.corners.min(axis=0).tolist(), self.corners.max(axis=0).tolist()
        for axis, (normal, edges) in enumerate((((1.0, 0.0), EDGES[:2]), ((0.0, 1.0), EDGES[2:4]))):
            x, y = normal
            yield EdgeLimit((-x, -y), low[axis] - self.area.edge_position(edges[0]), edges[0])
            yield EdgeLimit(normal, self.area.edge_position(edges[1]) - high[axis], edges[1])

    def rim_at(self, zero: Floats) -> EdgeLimit | None:
        """Return the tangent of the rim beside the corner that comes next to it with the zero (3,) there; None: no rim.

        All places at which the outline is within the rim keep it.
        """
        if self.area.diameter is None:
            return None
        from_centre = self.corners + zero[:2] - self.area.centre
        away = np.hypot(*from_centre.T)
        corner = int(np.argmax(away))
        x, y = (from_centre[corner] / away[corner]).tolist() if away[corner] > 0.0 else (1.0, 0.0)
        offset = np.array([x, y]) @ (self.corners[corner] - self.area.centre)
        return EdgeLimit((x, y), 0.5 * self.area.diameter - float(offset), TableEdge.RIM)

    def rim_around(self) -> Iterator[EdgeLimit]:
        """Yield some tangents all round, to begin with."""
        far = 10.0 * (np.abs(self.corners).max() + (self.area.diameter or 0.0)) + np.abs(self.area.centre).max()
        for angle in np.arange(16) * (np.pi / 8.0):
            limit = self.rim_at(far * np.array([np.cos(angle), np.sin(angle), 0.0]))
            if limit is not None:
                yield limit


def points_around(stock: StockShape) -> Floats:
    """Points (k, 3) whose convex hull has the stock in it, mm."""
    if stock.mesh is not None:
        return stock.mesh.vertices
    low, high = stock.low, stock.high
    flat = _circle(0.5 * float(high[0] - low[0])) if stock.is_cylinder else _corners(low[:2], high[:2])
    return np.concatenate([np.column_stack((flat, np.full(len(flat), z))) for z in (low[2], high[2])])


def _corners(low: Floats, high: Floats) -> Floats:
    return np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])])


def _circle(radius: float) -> Floats:
    """Return a polygon around a circle, of which no point is beyond by more than a hundred-thousandth of the radius."""
    angles = (np.arange(_SIDES) + 0.5) * (2.0 * np.pi / _SIDES)
    outer = radius / float(np.cos(np.pi / _SIDES))
    return outer * np.column_stack((np.cos(angles), np.sin(angles)))
