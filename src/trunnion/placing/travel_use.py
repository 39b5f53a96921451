"""What a place of the workpiece zero leaves of the travel of each axis, and which limits hold it.

Units: mm, degrees. Positions of slides are those of the machine.
"""

import math
from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.machines.machine import Vector
from trunnion.messages import Wording, phrase
from trunnion.placing.path_rows import PathRows
from trunnion.placing.placement import AxisUse, Limit, PartPlace, RotaryUse
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.table_limits import EDGES, ClampingArea, TableEdge
from trunnion.placing.travel_limits import TABLE, Cut, CutSet

#: From the lowest corner of a cube to each of them.
_CORNERS: Final = np.array(list(product((0.0, 1.0), repeat=3)))

#: Limits that are nearer than others by less are both told, mm.
_AS_NEAR: Final = 1e-3


def larger_than_table(machine: Machine, outline: tuple[float, float]) -> Wording:
    """Why no place is on the table, for an outline (2,) along X and Y, mm."""
    return phrase("larger_than_table", x=outline[0], y=outline[1], table=str(ClampingArea.of(machine)))


def limit_of_table(machine: Machine, edge: TableEdge) -> Limit:
    """Return the edge of the table that holds a part."""
    area = ClampingArea.of(machine)
    assert area is not None
    return Limit("table", str(edge), area.edge_position(edge), "", 0)


def obstacle_text(machine: Machine, rows: PathRows, obstacle: Obstacle) -> Wording:
    """Why a turn is impossible, with the line."""
    if obstacle.outline is not None:
        return larger_than_table(machine, obstacle.outline)
    stretch = rows.stretch_of(obstacle.row)
    place = {"file": stretch.file, "line": int(rows.line[obstacle.row])}
    if obstacle.axis < 0:
        return phrase("no_rotary_positions", **place)
    axis = machine.axes[obstacle.axis]
    return phrase("axis_leaves_travel", **place, axis=axis.name, low=axis.low, high=axis.high)


def place_at(machine: Machine, rows: PathRows, cuts: CutSet, zero: Floats, turn: float) -> PartPlace:
    """Return a place with what it leaves each slide."""
    reached = cuts.at(zero)
    axes = []
    for slide, column in enumerate(machine.linear):
        low, high = (limit_at(machine, rows, cuts.row(reached, slide, side), slide, side) for side in (0, 1))
        least, greatest = reached.extremes[slide].tolist()
        axes.append(AxisUse(machine.axes[column].name, least, greatest, float(reached.margins[slide].min()), low, high))
    table = None if cuts.edges is None else reached.table
    return PartPlace(vector(zero), turn, reached.margin, tuple(axes), table_mm=table)


def rounded_zero(cuts: CutSet, zero: Floats) -> Floats:
    """Return a place in whole thousandths of a millimetre, as controls have it, unless the part fits at the exact one
    only.

    Of the eight around it the nearest at which slides and stock keep their limits, else that which is nearest of all.
    """
    down = np.floor(zero * 1000.0)
    around = sorted(
        ((down + corner) / 1000.0 for corner in _CORNERS), key=lambda each: float(np.linalg.norm(each - zero))
    )
    inside = next((each for each in around if cuts.at(each).least >= 0.0), None)
    if inside is not None:
        return np.asarray(inside)
    rounded = np.round(zero, 3)
    exact, near = (cuts.at(each).margin for each in (zero, rounded))
    return rounded if near >= 0.0 or exact < 0.0 else zero


def rotary_uses(machine: Machine, positions: Floats) -> tuple[RotaryUse, ...]:
    """How the rotary axes use their travel in positions (n, 2), degrees."""
    uses = []
    for k, column in enumerate(machine.own_rotary):
        axis, least, greatest = machine.axes[column], float(positions[:, k].min()), float(positions[:, k].max())
        margin = min(least - axis.low, axis.high - greatest)
        uses.append(RotaryUse(axis.name, least, greatest, margin, axis.low, axis.high))
    return tuple(uses)


def limit_of_cut(machine: Machine, rows: PathRows, cut: Cut) -> Limit:
    """Return the limit that a half-space is."""
    if cut.slide == TABLE:
        return limit_of_table(machine, EDGES[cut.side])
    return limit_at(machine, rows, cut.row, cut.slide, cut.side)


def nearest_limits(machine: Machine, cuts: CutSet, place: PartPlace) -> tuple[Limit, ...]:
    """Return the limits to which slides have the least left at a place, like ones all; before them edges that are as
    near.
    """
    left = [(axis.least_mm - axis.low.limit_mm, axis.low) for axis in place.axes]
    left += [(axis.high.limit_mm - axis.greatest_mm, axis.high) for axis in place.axes]
    least = min(one for one, _ in left)
    slides = tuple(limit for one, limit in left if one <= least + _AS_NEAR)
    if cuts.edges is None or place.table_mm is None or place.table_mm > least + _AS_NEAR:
        return slides
    edges = cuts.edges.nearest_edges(np.array(place.zero_mm))
    return (*(limit_of_table(machine, edge) for edge in edges), *slides)


def limit_at(machine: Machine, rows: PathRows, row: int, slide: int, side: int) -> Limit:
    """Return the limit of a slide with the row that comes nearest to it."""
    axis, stretch = machine.axes[machine.linear[slide]], rows.stretch_of(row)
    limit = axis.high if side else axis.low
    return Limit(axis.name, ("low", "high")[side], limit, stretch.file, int(rows.line[row]), stretch.operation)


def vector(values: Floats) -> Vector:
    """Three numbers, without -0."""
    x, y, z = (value + 0.0 for value in values.tolist())
    assert math.isfinite(x + y + z)
    return x, y, z
