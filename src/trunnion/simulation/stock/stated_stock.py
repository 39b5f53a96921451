"""The stock that CL files state, in the coordinates of the program that is made of them.

In:     toolpaths as they are read, whose stock is in the CAM system's absolute coordinate system.
Out:    the stock as a simulation takes it, and the file that states it.
Units:  mm.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import Frame, Toolpath
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.solids import stock_shape

#: Elements of a matrix are taken for 0, 1 and -1 within this.
_SAME: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class StatedStock:
    """Stock that a CL file states.

    stock  in the coordinates of the program: a text as ``--stock`` takes it, or a mesh where that cannot say it
    file   the CL file
    """

    stock: str | TriangleMesh
    file: str


def stated_stock(toolpaths: Sequence[Toolpath], *, absolute: bool = False) -> StatedStock | None:
    """Return the stock that toolpaths state, of the part as it is drawn; None where none does.

    absolute  the program has the absolute coordinate system, not that of its first operation with motion

    Raises ``InputError`` if they state different ones.
    """
    stating = [path for path in toolpaths if path.stock]
    if not stating:
        return None
    first = stating[0]
    for other in stating[1:]:
        if other.stock != first.stock:
            wording = Wording("SIM110", "two_stocks", stock=other.stock, first=first.stock, file=first.file)
            raise InputError(Problem(other.file, 0, wording))
    moving = (operation for path in toolpaths for operation in path.operations if len(operation.moves))
    frame = Frame() if absolute else next((operation.frame for operation in moving), Frame())
    return StatedStock(_in_frame(first.stock, frame), first.file)


def _in_frame(text: str, frame: Frame) -> str | TriangleMesh:
    """Return stock of the absolute coordinate system in another one."""
    if frame == Frame():
        return text
    shape, turn, origin = stock_shape(text), frame.matrix(), np.array(frame.origin)
    low, high = (shape.low - origin) @ turn, (shape.high - origin) @ turn
    low, high = np.minimum(low, high), np.maximum(low, high)
    if not shape.is_cylinder and _is_among(np.abs(turn), (0.0, 1.0)):
        return "box:" + _listed(*(high - low), *low)
    about_z = _is_among(turn[2], (0.0, 1.0)) and _is_among(origin[:2], (0.0,))
    if shape.is_cylinder and about_z:
        return "cylinder:" + _listed(shape.high[0] - shape.low[0], high[2] - low[2], low[2])
    mesh = shape.as_mesh()
    return TriangleMesh((mesh.vertices - origin) @ turn, mesh.faces, "stock")


def _is_among(values: Floats, wanted: Sequence[float]) -> bool:
    """Whether each value is one of those that are wanted."""
    return bool(np.isclose(values[..., None], np.array(wanted), rtol=0.0, atol=_SAME).any(axis=-1).all())


def _listed(*values: float) -> str:
    return ",".join(f"{round(float(value), 9) + 0.0:.9f}".rstrip("0").rstrip(".") for value in values)
