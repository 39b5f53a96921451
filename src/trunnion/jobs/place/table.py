"""What stands on the table while a part is placed: stock and part, and what is said of them and the table."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem, Severity, argument_problem
from trunnion.jobs.inputs.arguments import check_path
from trunnion.machines import Machine
from trunnion.placing.placement import Limit
from trunnion.placing.table_limits import ClampingArea, Standing, TableEdge
from trunnion.placing.turning import hull_points
from trunnion.simulation.meshes import TriangleMesh, load_mesh
from trunnion.simulation.stock.solids import stock_shape

#: Corners of the polygon around a round stock, which is wider than it by 0.1 mm in 10 m.
_SIDES: Final = 720


def standing_on(
    machine: Machine,
    stock: str | Path | TriangleMesh | None,
    part: str | Path | TriangleMesh | None,
    remarks: list[Problem],
) -> Standing | None:
    """The outermost points of stock and part, with the table that the machine's definition states.

    ``remarks`` gets warnings about meshes, and one where no table is stated. None: there is nothing to judge.

    Raises
    ------
    InputError
        If a mesh cannot be used, or the text of a stock is none.
    """
    points = [*_outlines(stock, part, remarks)]
    if not points:
        return None
    area = ClampingArea.of(machine)
    if area is None:
        what = f"is not held against the table: the definition of {machine.key} states none"
        cure = "state table_size_mm or table_diameter_mm in its [facts]"
        name = "part" if stock is None else "stock"
        remarks.append(argument_problem(name, what, cure, Severity.WARNING, code="PLC260"))
        return None
    every = np.concatenate(points)
    return Standing(area, every[hull_points(every)])


def _outlines(
    stock: str | Path | TriangleMesh | None, part: str | Path | TriangleMesh | None, remarks: list[Problem]
) -> Iterator[Floats]:
    """Points (k, 3) around what is given, mm, from the workpiece zero."""
    if stock is not None:
        if not isinstance(stock, TriangleMesh):
            check_path("stock", stock)
        shape = stock_shape(stock, remarks.append)
        if shape.mesh is not None:
            yield shape.mesh.vertices
        else:
            low, high = shape.low, shape.high
            flat = _round(0.5 * float(high[0] - low[0])) if shape.is_cylinder else _corners(low[:2], high[:2])
            yield np.concatenate([np.column_stack((flat, np.full(len(flat), z))) for z in (low[2], high[2])])
    if part is not None:
        if not isinstance(part, TriangleMesh):
            check_path("part", part)
            part = load_mesh(part, name="part", closed=True, warn=remarks.append)
        yield part.vertices


def _corners(low: Floats, high: Floats) -> Floats:
    return np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])])


def _round(radius: float) -> Floats:
    """A polygon around a circle, of which no point is beyond by more than a hundred-thousandth of the radius."""
    angles = (np.arange(_SIDES) + 0.5) * (2.0 * np.pi / _SIDES)
    outer = radius / float(np.cos(np.pi / _SIDES))
    return outer * np.column_stack((np.cos(angles), np.sin(angles)))


def larger_than_table(machine: Machine, outline: tuple[float, float]) -> str:
    """Why no place is on the table, for an outline (2,) along X and Y, mm."""
    return f"seen from above it is {outline[0]:.1f} x {outline[1]:.1f} mm, and the table is {ClampingArea.of(machine)}"


def limit_of_table(machine: Machine, edge: TableEdge) -> Limit:
    """The edge of the table that holds a part."""
    area = ClampingArea.of(machine)
    assert area is not None
    return Limit("table", str(edge), area.edge_position(edge), "", 0)
