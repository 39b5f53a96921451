"""A part that is clamped otherwise than it is drawn, and its toolpaths.

First it is tilted about X of the program's coordinate system, as by a fixture with that angle, then turned about Z of
the machine frame; both right-handed, and about the workpiece zero. A CL file that was made of a program may state that
its part is clamped so already; what is given comes after that.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.clamping import Clamping, number
from trunnion.model.frames import frame_from_vectors, into_frame, into_plane
from trunnion.model.toolpath import Frame, Operation, Toolpath


def stated_clamping(toolpaths: Sequence[Toolpath]) -> Clamping | None:
    """How the part is clamped as its CL files state; None: they state nothing.

    Raises ``InputError`` if they state different clampings, one of which may be that of the drawing.
    """
    first = next((path for path in toolpaths if path.clamping is not None), None)
    if first is None or first.clamping is None:
        return None
    for path in toolpaths:
        own = path.clamping or Clamping()
        if not own.is_like(first.clamping):
            raise InputError(
                Problem(
                    path.file,
                    0,
                    Wording("PLC310", "states_nothing_part", first_file=first.file, clamping=first.clamping)
                    if path.clamping is None
                    else Wording("PLC310", "states_part", own=own, first_file=first.file, clamping=first.clamping),
                )
            )
    return first.clamping


def clamped_after(stated: Clamping | None, angles: tuple[float, float], file: str) -> Clamping:
    """How a part is clamped that is ``stated`` to be clamped so, and is tilted and turned by ``angles`` then, degrees.

    Raises ``InputError`` if that is no tilt with a turn behind it, as a head has to state it.
    """
    found = (stated or Clamping()).then(*angles)
    if found is None:
        raise InputError(
            Problem(file, 0, Wording("PLC320", "states_part_tilt", stated=stated, number=number(angles[1])))
        )
    return found


def turned_toolpaths(
    toolpaths: Sequence[Toolpath], degrees: float, tilt: float = 0.0, *, absolute: bool = False
) -> list[Toolpath]:
    """Toolpaths of a part that is tilted about X and then turned about Z, in the program's coordinate system.

    That is the coordinate system of the first operation with motion, or the ``absolute`` one of the CAM system.
    """
    if not Clamping(degrees, tilt).is_turned:
        return list(toolpaths)
    return [
        replace(path, clamping=(path.clamping or Clamping()).then(degrees, tilt))
        for path in _rotated(toolpaths, Clamping(degrees, tilt).rotation, absolute)
    ]


def toolpaths_clamped(toolpaths: Sequence[Toolpath], degrees: float, tilt: float) -> list[Toolpath]:
    """Toolpaths of a part that is clamped so against its drawing, whatever they state of it themselves.

    Raises ``InputError`` if they state different clampings.
    """
    stated = stated_clamping(toolpaths) or Clamping()
    if stated.is_as_drawn:
        return turned_toolpaths(toolpaths, degrees, tilt)
    if stated.is_like(Clamping(degrees, tilt)):
        return list(toolpaths)
    return _rotated(toolpaths, Clamping(degrees, tilt).rotation @ Clamping(stated.turn, stated.tilt).rotation.T, False)


def _rotated(toolpaths: Sequence[Toolpath], rotation: Floats, absolute: bool) -> list[Toolpath]:
    moving = (operation for path in toolpaths for operation in path.operations if len(operation.moves))
    frame = Frame() if absolute else next((operation.frame for operation in moving), Frame())
    back = rotation.T
    plane = frame_from_vectors(np.zeros(3), back[:, 0], back[:, 1])

    def turned(operation: Operation) -> Operation:
        return replace(into_plane(into_frame(operation, frame), plane), frame=frame)

    return [replace(path, operations=tuple(map(turned, path.operations))) for path in toolpaths]
