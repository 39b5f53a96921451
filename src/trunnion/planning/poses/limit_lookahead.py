"""Lookahead: the limit that a pose runs into if nothing is changed.

It explains decisions; it does not make them.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, inverse, slide_positions
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Moves
from trunnion.planning.axis_limits import limit_violation_text, limits_of, outside_limits
from trunnion.planning.poses.contact import NO_CONTACT, contact_of
from trunnion.records import dataclass

#: Rows looked at together: at first so many, then twice as many each time.
_CHUNK: Final = 256


@dataclass(frozen=True, slots=True)
class LimitHit:
    """The first row at which an axis would leave its limits: its column, and the value it would have, mm or degrees."""

    row: int
    column: int
    value: float

    def said(self, machine: Machine, moves: Moves) -> Wording:
        """Axis, value, limit and line, as the end of a sentence."""
        violation = limit_violation_text(machine, self.column, self.value)
        return phrase("limit_in_line", violation=violation, line=int(moves.line[self.row]))


def degrees_out_of_reach(machine: Machine, axis: Floats) -> float:
    """Degrees by which a tool axis (3,) lies outside of what the rotary axes reach.

    The tool axis, the first and the second rotary axis are corners of a spherical triangle. Its other two sides are the
    angles between the rotary axes, and between the second one and the spindle.
    """
    first, second = (np.array(machine.axes[column].direction) for column in machine.rotary)
    spindle = np.array(machine.spindle_direction)
    needed, one, two = (_angle(first, axis), _angle(first, second), _angle(second, spindle))
    return max(abs(one - two) - needed, needed - min(one + two, 360.0 - one - two))


def _angle(a: Floats, b: Floats) -> float:
    """Angle between two vectors, degrees."""
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))


def first_limit_hit(
    machine: Machine, moves: Moves, row: int, branch: int, pose: Floats, keep_slide_limits: bool
) -> LimitHit | None:
    """Follow one branch from ``pose`` (2,), degrees, into ``row`` and on, until a limit is left or the cut ends."""
    low, high = limits_of(machine, keep_slide_limits)
    last, first, count = pose, row, _CHUNK
    while first < len(moves):
        in_contact = contact_of(moves, slice(first, first + count)) != NO_CONTACT
        in_contact[0] |= first == row
        end = first + (len(in_contact) if in_contact.all() else int(np.argmin(in_contact)))
        if end == first:
            return None
        rows = slice(first, end)
        rotary = continue_in_branch(machine, moves, rows, branch, last)
        joints = slide_positions(machine, moves.tip[rows], rotary)
        joints[:, list(machine.rotary)] = rotary
        outside = outside_limits(joints, low, high)
        if outside.any():
            k = int(np.argmax(outside.any(axis=1)))
            column = int(np.argmax(outside[k]))
            return LimitHit(first + k, column, float(joints[k, column]))
        if not in_contact.all():
            return None
        last, first, count = rotary[-1], end, 2 * count
    return None


def continue_in_branch(machine: Machine, moves: Moves, rows: slice | Ints, branch: int, last: Floats) -> Floats:
    """Rotary values of consecutive rows in one branch, each the shorter way from the one before.

    last  (2,) float64: the positions before, degrees

    (k, 2) float64  degrees, as they wind
    """
    solutions = inverse(machine, moves.tip[rows], moves.axis[rows])
    values = solutions.joints[branch][:, list(machine.rotary)]
    if solutions.pole.any():  # the free angle holds
        source = np.maximum.accumulate(np.where(solutions.pole, -1, np.arange(len(values))))
        values[:, 0] = np.where(source < 0, last[0], values[np.maximum(source, 0), 0])
    return np.asarray(np.unwrap(np.vstack((last[None], values)), period=360.0, axis=0)[1:])
