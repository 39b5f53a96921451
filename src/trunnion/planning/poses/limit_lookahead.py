"""Where a pose leads to if nothing is changed: the limit that it runs into.

Decisions are explained by this, they are not made by it.
"""

from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, inverse, slide_positions
from trunnion.model.toolpath import Moves
from trunnion.planning.axis_limits import limit_violation_text, limits_of, outside_limits
from trunnion.planning.poses.optimizer import NO_CONTACT
from trunnion.planning.poses.selection import contact_of

#: Rows looked at together, at first; then twice as many each time.
_CHUNK = 256


@dataclass(frozen=True, slots=True)
class LimitHit:
    """The first row at which an axis would leave its limits, the column of the axis, and where it would go."""

    row: int
    column: int
    value: float

    def describe(self, machine: Machine, moves: Moves) -> str:
        """Axis, value, limit and line, as the end of a sentence."""
        return f"{limit_violation_text(machine, self.column, self.value)} in line {int(moves.line[self.row])}"


def degrees_out_of_reach(machine: Machine, axis: Floats) -> float:
    """Degrees by which a tool axis (3,) lies outside of what the rotary axes reach.

    The tool axis, the first rotary axis and the second are corners of a spherical triangle whose other two sides are
    those between the rotary axes and from the second one to the spindle.
    """
    first, second = (np.array(machine.axes[column].direction) for column in machine.rotary)
    spindle = np.array(machine.spindle_direction)
    side, one, two = (_between(first, axis), _between(first, second), _between(second, spindle))
    return max(abs(one - two) - side, side - min(one + two, 360.0 - one - two))


def _between(a: Floats, b: Floats) -> float:
    """Angle between two vectors, degrees."""
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))


def first_limit_hit(
    machine: Machine, moves: Moves, row: int, branch: int, pose: Floats, keep_slides: bool
) -> LimitHit | None:
    """Follow one branch from ``pose`` (2,), degrees, into ``row`` and on, until a limit is left or the cut ends."""
    low, high = limits_of(machine, keep_slides)
    last, first, count = pose, row, _CHUNK
    while first < len(moves):
        touches = contact_of(moves, slice(first, first + count)) != NO_CONTACT
        touches[0] |= first == row
        part = slice(first, first + (len(touches) if touches.all() else int(np.argmin(touches))))
        if part.stop == first:
            return None
        values = continue_in_branch(machine, moves, part, branch, last)
        joints = slide_positions(machine, moves.tip[part], values)
        joints[:, list(machine.rotary)] = values
        outside = outside_limits(joints, low, high)
        if outside.any():
            k = int(np.argmax(outside.any(axis=1)))
            column = int(np.argmax(outside[k]))
            return LimitHit(first + k, column, float(joints[k, column]))
        if not touches.all():
            return None
        last, first, count = values[-1], part.stop, 2 * count
    return None


def continue_in_branch(machine: Machine, moves: Moves, rows: slice | Ints, branch: int, last: Floats) -> Floats:
    """Rotary values, degrees, (k, 2), of consecutive rows in one branch, each the nearer way from the one before.

    last : (2,) float64
        Where the axes stand before.
    """
    solutions = inverse(machine, moves.tip[rows], moves.axis[rows])
    values = solutions.joints[branch][:, list(machine.rotary)]
    if solutions.pole.any():  # the free angle holds
        source = np.maximum.accumulate(np.where(solutions.pole, -1, np.arange(len(values))))
        values[:, 0] = np.where(source < 0, last[0], values[np.maximum(source, 0), 0])
    return np.asarray(np.unwrap(np.vstack((last[None], values)), period=360.0, axis=0)[1:])
