"""Operations whose points are in the coordinates of a turned plane: their points, axes and arcs in those of the file.

A plane is three unit vectors, square to each other, one behind the other: its X, Y and Z in the system of the file. Its
origin is that of the file.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.cl.builder import PlaneStatement
from trunnion.model.toolpath import Event, From, Operation

#: The plane that turns nothing.
TOP: Final = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

#: Vectors of planes are printed with six decimals.
_SAME: Final = 1e-5


def squared(numbers: Sequence[float]) -> tuple[float, ...] | None:
    """Return a plane with its vectors exactly unit and square; None if they are neither, or left-handed."""
    given = np.array(numbers).reshape(3, 3)
    if not np.abs(given @ given.T - np.eye(3)).max() <= _SAME or np.linalg.det(given) < 0.0:
        return None
    x = given[0] / np.linalg.norm(given[0])
    z = np.cross(x, given[1])
    z /= np.linalg.norm(z)
    return tuple((np.concatenate((x, np.cross(z, x), z)) + 0.0).tolist())


def turned(operation: Operation, planes: Sequence[PlaneStatement]) -> Operation:
    """Return an operation with everything in the system of the file; ``planes`` in the order of their rows."""
    if all(plane.axes == TOP for plane in planes):
        return operation
    moves, arcs, events = operation.moves, operation.arcs, list(operation.events)
    tip, axis, centre, normal = (each.copy() for each in (moves.tip, moves.axis, arcs.centre, arcs.normal))
    stops = [plane.row for plane in planes[1:]] + [len(moves)]
    for plane, stop in zip(planes, stops, strict=True):
        matrix = np.array(plane.axes).reshape(3, 3)
        rows, own = slice(plane.row, stop), (plane.row <= arcs.row) & (arcs.row < stop)
        tip[rows], axis[rows] = tip[rows] @ matrix, axis[rows] @ matrix
        centre[own], normal[own] = centre[own] @ matrix, normal[own] @ matrix
        events = [_turned_start(event, matrix) if plane.row <= event.row < stop else event for event in events]
    return replace(
        operation, moves=replace(moves, tip=tip, axis=axis), arcs=replace(arcs, centre=centre, normal=normal),
        events=tuple(events),
    )  # fmt: skip


def _turned_start(event: Event, matrix: Floats) -> Event:
    if not isinstance(event, From):
        return event
    (x, y, z), (i, j, k) = ((np.array(each) @ matrix).tolist() for each in (event.tip, event.axis))
    return replace(event, tip=(x, y, z), axis=(i, j, k))
