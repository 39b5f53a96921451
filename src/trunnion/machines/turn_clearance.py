"""How far the tool stays from the part while rotary axes turn and the slides rest.

In:     a machine, axis values before and after the turn, and what the part fills.
Out:    the least distance between part and tool, mm.
Frames: the part is in workpiece coordinates. Seen from the part it is the tool that moves, so that turning the part
        and turning the tool are the same computation.
"""

import math
from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines.forward import forward
from trunnion.machines.machine import Machine, Mount
from trunnion.records import dataclass

#: The least distance, mm, that counts as safe. It stands for what nobody states: the radius of tool and holder,
#: clamps, and stock beyond the points of a program.
SAFE_DISTANCE: Final = 20.0

#: Positions within a turn are this far apart, degrees.
_STEP: Final = 0.1

#: By two thirds each time, the stretch of the tool is narrowed down to its point nearest to the part.
_NARROWINGS: Final = 60


@dataclass(frozen=True, slots=True, eq=False)
class SweptPart:
    """What a part may fill, in workpiece coordinates, mm.

    On a rotary table it is the cylinder about the axis of the table that holds all its points and reaches down to where
    the rotary axes have theirs: nothing says how the part lies on the table, nor what of it is not cut. Elsewhere it
    is the box around its points.

    low, high  corners of the box, (3,)
    centre     a point on the axis of the table, (3,); None without one
    direction  of that axis, (3,)
    radius     of the cylinder
    ends       of the cylinder, along the axis from ``centre``
    """

    low: Floats
    high: Floats
    centre: Floats | None
    direction: Floats
    radius: float
    ends: tuple[float, float]

    @staticmethod
    def around(machine: Machine, points: Floats) -> "SweptPart":
        """Return the part around points (n, 3), workpiece coordinates; at least one."""
        low, high = points.min(axis=0), points.max(axis=0)
        table = machine.axes[machine.rotary[0]]
        direction = np.array(table.direction)
        if table.mount is not Mount.PART:
            return SweptPart(low, high, None, direction, 0.0, (0.0, 0.0))
        zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0), np.float64)
        centre = np.array(table.point) - zero
        down = [np.array(axis.point) - zero for axis in machine.axes if axis.is_rotary and axis.mount is Mount.PART]
        corners = np.array(list(product(*zip(low, high, strict=True))))
        along = np.concatenate((corners, down)) @ direction - centre @ direction
        across = np.linalg.norm(np.cross(corners - centre, direction), axis=1)
        return SweptPart(low, high, centre, direction, float(across.max()), (float(along.min()), float(along.max())))

    def distance(self, points: Floats) -> Floats:
        """Distance of points (n, 3) from the part, (n,) mm; 0.0 inside."""
        if self.centre is None:
            outside = np.maximum(np.maximum(self.low - points, points - self.high), 0.0)
            return np.asarray(np.linalg.norm(outside, axis=1))
        along = (points - self.centre) @ self.direction
        across = np.linalg.norm(points - self.centre - along[:, None] * self.direction, axis=1)
        beyond = np.maximum(np.maximum(self.ends[0] - along, along - self.ends[1]), 0.0)
        return np.asarray(np.hypot(beyond, np.maximum(across - self.radius, 0.0)))

    @property
    def size(self) -> float:
        """No two of its points are farther apart, mm."""
        if self.centre is None:
            return float(np.linalg.norm(self.high - self.low))
        return math.hypot(2.0 * self.radius, self.ends[1] - self.ends[0])


def turns_part_alone(machine: Machine, before: Floats, after: Floats, still: float) -> bool:
    """Whether a turn keeps the tilt: only the rotary axis next to the part turns, and carries the part.

    before, after  (5,) float64: axis values
    still          smaller motion, degrees, is none
    """
    first, second = machine.rotary
    return machine.axes[first].mount is Mount.PART and abs(float(after[second] - before[second])) <= still


def turn_clearance(machine: Machine, before: Floats, after: Floats, part: SweptPart) -> float:
    """Return the least distance between tool and part during a turn, mm; 0.0 where they meet.

    The tool is the half-line from its tip through the spindle: what surrounds it is left to the distance that is asked
    for. The rotary axes turn evenly, and the slides rest at the values of ``before``.

    machine        with its workpiece zero; None counts as on the machine's own zero
    before, after  (5,) float64: axis values, mm or deg; of ``after`` only the rotary ones count
    part           what the part fills, in workpiece coordinates
    """
    rotary = list(machine.rotary)
    turn = after[rotary] - before[rotary]
    steps = max(2, math.ceil(float(np.abs(turn).max()) / _STEP) + 1)
    joints = np.tile(before, (steps, 1))
    joints[:, rotary] += np.linspace(0.0, 1.0, steps)[:, None] * turn
    tip, axis = forward(machine, joints)
    reach = part.distance(tip) + part.size
    along = _nearest_along(tip, axis, reach, part)
    distance = part.distance(tip + along[:, None] * axis)
    between = np.linalg.norm(np.diff(tip, axis=0), axis=1) + reach.max() * np.linalg.norm(np.diff(axis, axis=0), axis=1)
    sweeps_itself = turns_part_alone(machine, before, after, 0.0)
    return max(0.0, float(distance.min() - (0.0 if sweeps_itself else between.max() / 2.0)))


def _nearest_along(tip: Floats, axis: Floats, reach: Floats, part: SweptPart) -> Floats:
    """How far from each tip (n, 3) along its axis the tool is nearest to a part, (n,) mm, at most ``reach``.

    The distance from a convex body is convex along a line, so the stretch with its minimum can be narrowed down.
    """
    near, far = np.zeros(len(tip)), reach.copy()
    for _ in range(_NARROWINGS):
        third = (far - near) / 3.0
        one, two = near + third, far - third
        nearer = part.distance(tip + one[:, None] * axis) <= part.distance(tip + two[:, None] * axis)
        far, near = np.where(nearer, two, far), np.where(nearer, near, one)
    return np.asarray((near + far) / 2.0)
