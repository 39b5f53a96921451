"""A part that is clamped otherwise than it is drawn, and its toolpaths.

First it is tilted about X of the program's coordinate system, as by a fixture with that angle, then turned about Z of
the machine frame; both right-handed, and about the workpiece zero.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.api.arguments import wrong_argument
from trunnion.model.frames import frame_from_vectors, into_frame, into_plane
from trunnion.model.toolpath import Frame, Operation, Toolpath
from trunnion.placing.path_rows import turn_and_tilt


def checked_angles(turn: object, tilt: object) -> tuple[float, float]:
    """Turn and tilt as arguments, checked; None is 0.

    Raises
    ------
    InputError
        If one is no number from -360 to 360.
    """
    found = []
    for name, value in (("turn", turn), ("tilt", tilt)):
        value = 0.0 if value is None else value
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= 360.0:
            raise wrong_argument(name, value, "give degrees, -360 to 360")
        found.append(float(value))
    return found[0], found[1]


def is_turned(turn: float, tilt: float) -> bool:
    """Whether a part is clamped otherwise than it is drawn, degrees."""
    return turn % 360.0 != 0.0 or tilt != 0.0


def turned_toolpaths(
    toolpaths: Sequence[Toolpath], degrees: float, tilt: float = 0.0, *, absolute: bool = False
) -> list[Toolpath]:
    """Toolpaths of a part that is tilted about X and then turned about Z, in the program's coordinate system.

    That is the coordinate system of the first operation with motion, or the ``absolute`` one of the CAM system.
    """
    if not is_turned(degrees, tilt):
        return list(toolpaths)
    moving = (operation for path in toolpaths for operation in path.operations if len(operation.moves))
    frame = Frame() if absolute else next((operation.frame for operation in moving), Frame())
    back = turn_and_tilt(degrees, tilt).T
    plane = frame_from_vectors(np.zeros(3), back[:, 0], back[:, 1])

    def turned(operation: Operation) -> Operation:
        return replace(into_plane(into_frame(operation, frame), plane), frame=frame)

    return [replace(path, operations=tuple(map(turned, path.operations))) for path in toolpaths]
