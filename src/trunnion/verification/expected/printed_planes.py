"""How far a program in tilted planes may be from its CL points, because origin, angles and positions are rounded.

In:     the planes of the run, an operation in the program's frame, and the last digits that the program prints.
Out:    the tolerances of the operation.
Units:  mm and degrees.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.frames import TURNING_NOISE
from trunnion.model.run import Run
from trunnion.model.toolpath import Operation
from trunnion.records import dataclass
from trunnion.verification.expected.tolerances import Tolerances

#: A plane belongs to CL points whose tool axis is no farther off upright in it, degrees.
_UPRIGHT: Final = 0.1

#: So many last digits of an angle a plane is off by that three angles describe.
_ANGLES: Final = 1.5

#: The origin of a plane counts as no farther from the points than so many times their distance from the zero.
_FARTHEST: Final = 2.0


@dataclass(frozen=True, slots=True)
class PrintedDigits:
    """What the last digits of a program are worth: of coordinates, mm, and of the angles of planes, degrees."""

    length: float
    angle: float


def tolerances_in_planes(run: Run, tolerances: Tolerances, digits: PrintedDigits) -> Callable[[Operation], Tolerances]:
    """Return the tolerances by operation: wider by what is rounded where it runs in a tilted plane of the program.

    Coordinates and origin are off by half a digit along each axis of the plane, and the plane itself by its angles.
    """
    return lambda operation: _of_operation(run.planes, operation, tolerances, digits)


def _of_operation(planes: Floats, operation: Operation, tolerances: Tolerances, digits: PrintedDigits) -> Tolerances:
    moves = operation.moves
    tilt = math.radians(_ANGLES * digits.angle)
    tip, in_plane = tolerances.tip, False
    for plane in planes:
        upright = moves.axis @ plane[:, 2] >= math.cos(math.radians(_UPRIGHT)) * np.linalg.norm(plane[:, 2])
        if not upright.any():
            continue
        tips = moves.tip[upright]
        reach = float(np.linalg.norm(tips - plane[:, 3], axis=1).max())
        reach = min(reach, _FARTHEST * float(np.linalg.norm(tips, axis=1).max()))
        widest = float(np.abs(plane[:, :3]).sum(axis=1).max())
        # Origin and positions; the axes of the plane turn what they show of the reach.
        rounded = 0.5 * digits.length * (1.0 + widest) + TURNING_NOISE * widest
        tip, in_plane = max(tip, rounded + tilt * reach), True
    if not in_plane:
        return tolerances
    angle = max(tolerances.angle, math.sqrt(2.0) * math.degrees(tilt))
    return replace(tolerances, tip=tip, angle=angle, plane=True)
