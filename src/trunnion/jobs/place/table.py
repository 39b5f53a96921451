"""What stands on the table while a part is placed: stock and part, and what is said of them and the table."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem, Severity, argument_problem
from trunnion.jobs.inputs.arguments import check_path
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.placing.table_limits import ClampingArea, Standing, points_around
from trunnion.placing.turning import hull_points
from trunnion.simulation.meshes import TriangleMesh, load_mesh
from trunnion.simulation.stock.solids import stock_shape


def standing_on(
    machine: Machine,
    stock: str | Path | TriangleMesh | None,
    part: str | Path | TriangleMesh | None,
    remarks: list[Problem],
) -> Standing | None:
    """Return the outermost points of stock and part, with the table that the machine's definition states.

    ``remarks`` gets warnings about meshes, and one where no table is stated. None: there is nothing to judge.

    Raises ``InputError`` if a mesh cannot be used, or the text of a stock is none.
    """
    points = [*_outlines(stock, part, remarks)]
    if not points:
        return None
    area = ClampingArea.of(machine)
    if area is None:
        name = "part" if stock is None else "stock"
        remarks.append(
            argument_problem(name, Wording("PLC260", "no_table_stated", machine=machine.key), severity=Severity.WARNING)
        )
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
        yield points_around(stock_shape(stock, remarks.append))
    if part is not None:
        if not isinstance(part, TriangleMesh):
            check_path("part", part)
            part = load_mesh(part, name="part", closed=True, warn=remarks.append)
        yield part.vertices
