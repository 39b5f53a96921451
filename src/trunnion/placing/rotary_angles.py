"""The positions of the rotary axes in every row of a path, for given branches.

In:     tool axes, the branch of each row, limits and starting positions.
Out:    positions with their turns, degrees; or the first row that has none within the limits.

Each axis takes the turn within its limits that is nearest to where it stands. At the pole the first axis keeps its
position, as the planner has it.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.machines.inverse import POLE, UNREACHABLE, branch_angles, solve_tilt
from trunnion.placing.path_rows import PathRows
from trunnion.records import dataclass

#: A value beyond a limit by less prints as the limit, degrees.
_ROUNDING: Final = 1e-5


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Why a turn is impossible wherever the zero is: a row that the axes do not reach, or a table that is too small.

    axis     column of the rotary axis beyond its limits; -1: no angles give the tool axis, or the slides cannot follow
    outline  size along X and Y, seen from above, of what is larger than the table, mm; then there is no row
    """

    row: int
    axis: int = -1
    outline: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class RotaryAngles:
    """Positions (n, 2) in the order of ``machine.rotary``, degrees.

    held  (n,) bool: at the pole since its stretch began, so that the first axis stands where it stood before that
    """

    positions: Floats
    held: Flags


def rotary_angles(machine: Machine, rows: PathRows) -> RotaryAngles | Obstacle:
    """Return the positions of the rotary axes in all rows."""
    positions, held = np.empty((len(rows), 2)), np.empty(len(rows), np.bool_)
    limits = np.array([(machine.axes[column].low, machine.axes[column].high) for column in machine.rotary])
    row, lacking = _fill_angles(
        kinematic_parameters(machine), limits, rows.axis, rows.branch, rows.begins, rows.start, positions, held
    )
    if row < 0:
        return RotaryAngles(positions, held)
    return Obstacle(row) if lacking < 0 else Obstacle(row, machine.rotary[lacking])


@kernel(writes="angles held")
def _fill_angles(
    kinematics: KinematicParameters,
    limits: Floats2,
    axis: Floats2,
    branch: Codes,
    begins: Flags,
    start: Floats2,
    angles: Floats2,
    held: Flags,
) -> tuple[int, int]:
    """Write the positions of all rows up to the first that has none; it, and 0 or 1 for its axis, -1 for both."""
    stretch, last_1, last_2, kept, at_start = -1, 0.0, 0.0, 0.0, True
    for row in range(axis.shape[0]):
        if begins[row]:
            stretch += 1
            last_1, last_2 = start[stretch, 0], start[stretch, 1]
            kept, at_start = last_1, True
        status, u0, u1, cos, sin = solve_tilt(kinematics, axis[row, 0], axis[row, 1], axis[row, 2])
        if status & UNREACHABLE:
            return row, -1
        if branch[row]:
            sin = -sin
        first, second, _, _, _, _ = branch_angles(kinematics, u0, u1, cos, sin, status)
        if status & POLE:
            first = kept
        else:
            at_start = False
        kept, held[row] = first, at_start
        last_1 = _nearest_turn(first, last_1, limits[0, 0], limits[0, 1])
        if math.isnan(last_1):
            return row, 0
        last_2 = _nearest_turn(second, last_2, limits[1, 0], limits[1, 1])
        if math.isnan(last_2):
            return row, 1
        angles[row, 0], angles[row, 1] = last_1, last_2
    return -1, 0


@inner
def _nearest_turn(angle: float, last: float, low: float, high: float) -> float:
    """Return the angle with the turns that bring it nearest to ``last`` within the limits, degrees; NaN if
    none does.
    """
    turns = math.floor((last - angle) / 360.0 + 0.5)
    least, most = (low - _ROUNDING - angle) / 360.0, (high + _ROUNDING - angle) / 360.0
    if turns < least:
        turns = math.ceil(least)
    if turns > most:
        turns = math.floor(most)
    if turns < least:
        return math.nan
    return angle + 360.0 * turns
