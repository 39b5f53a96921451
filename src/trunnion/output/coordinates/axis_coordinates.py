"""Motion without TCP: the words X Y Z and F where the control does not hold the tip.

X Y Z are positions of the linear axes, counted from where they are with the tip at the workpiece zero and the rotary
axes at zero: that is the work offset, with the tool length in it. They are computed for the printed rotary positions,
so that rounding an angle does not move the tip.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.definition import Control
from trunnion.controls.words import NumberFormat
from trunnion.machines import Machine, forward, slide_positions
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs
from trunnion.records import dataclass

#: A tip (or all linear axes) that moves by less rests, mm: a degree then counts as a millimetre.
AT_REST: Final = 1e-4

#: The value of the setting ``rotary_feed`` with which F is the feed of the tip all the same.
FEED_AT_TIP: Final = "tip"


@dataclass(frozen=True, slots=True, eq=False)
class AxisCoordinates:
    """A motion in coordinates of the linear axes; lengths are those of the path that leads to a row.

    motion           tips and centres of arcs are positions of the linear axes X, Y and Z
    rotary_moves     (n,) bool     a rotary axis moves
    tip_length       (n,) float64  of the tip, for which the feed is meant: mm, or degrees where the tip rests
    linear_length    (n,) float64  of the linear axes: mm, or degrees where they rest
    all_axes_length  (n,) float64  of all axes together, a degree as a millimetre
    wraps            (n, 2) bool   the rotary axis crosses the end of its displayed turn
    """

    motion: Motion
    rotary_moves: Flags
    tip_length: Floats
    linear_length: Floats
    all_axes_length: Floats
    wraps: Flags

    def select(self, rows: Ints | slice) -> "AxisCoordinates":
        """Return some rows of the columns; the motion stays whole."""
        lengths = self.tip_length[rows], self.linear_length[rows], self.all_axes_length[rows]
        return AxisCoordinates(self.motion, self.rotary_moves[rows], *lengths, self.wraps[rows])


def to_axis_coordinates(machine: Machine, motion: Motion, decimals: int) -> AxisCoordinates:
    """Return a motion without TCP in coordinates of the linear axes; ``decimals`` are those of the angles."""
    moves = motion.operation.moves
    rotary = np.round(motion.rotary, decimals)
    columns = [machine.column(name) for name in "XYZ"]
    offset = _work_offset(machine, columns)
    linear = slide_positions(machine, moves.tip, rotary)[:, columns] - offset
    arcs = _arcs_of_linear_axes(machine, motion.operation.arcs, rotary, columns, offset)
    _print_upper_end_as_lower(machine, rotary, decimals)
    steps, wraps = _rotary_steps(machine, rotary)
    turned = np.abs(steps).max(axis=1)
    tip_length, linear_length = _step_lengths(moves.tip), _step_lengths(linear)
    operation = replace(motion.operation, moves=replace(moves, tip=np.ascontiguousarray(linear)), arcs=arcs)
    return AxisCoordinates(
        replace(motion, operation=operation, rotary=rotary),
        turned > 0.0,
        np.where(tip_length < AT_REST, turned, tip_length),
        np.where(linear_length < AT_REST, turned, linear_length),
        np.hypot(linear_length, np.linalg.norm(steps, axis=1)),
        wraps,
    )


def _arcs_of_linear_axes(machine: Machine, arcs: Arcs, rotary: Floats, columns: list[int], offset: Floats) -> Arcs:
    """Return the arcs in coordinates of the linear axes, about Z; the rotary axes rest along each of them."""
    if not len(arcs.row):
        return arcs
    sense = np.sign(np.einsum("ij,ij->i", _z_axis_direction(machine, rotary[arcs.row]), arcs.normal))
    centre = slide_positions(machine, arcs.centre, rotary[arcs.row])[:, columns] - offset
    return replace(arcs, centre=centre, normal=np.outer(sense, [0.0, 0.0, 1.0]))


def _print_upper_end_as_lower(machine: Machine, rotary: Floats, decimals: int) -> None:
    """Set positions that print as the upper end of the displayed turn to the lower end, in place."""
    for r, column in enumerate(machine.rotary):
        top = machine.axes[column].display_low + 360.0
        rotary[rotary[:, r] >= top - 0.5 * 10.0**-decimals, r] -= 360.0


def _rotary_steps(machine: Machine, rotary: Floats) -> tuple[Floats, Flags]:
    """How far each rotary axis turns to each row, (n, 2) degrees; and where it crosses the end of its turn."""
    steps = np.diff(rotary, axis=0, prepend=rotary[:1])
    wraps = np.zeros(steps.shape, np.bool_)
    for r, column in enumerate(machine.rotary):
        if not np.isnan(machine.axes[column].display_low):
            wraps[:, r] = np.abs(steps[:, r]) > 180.0
            steps[:, r] -= 360.0 * np.rint(steps[:, r] / 360.0)
    return steps, wraps


def _step_lengths(points: Floats) -> Floats:
    """(n,): the distance of each point from the one before, 0 for the first."""
    return np.asarray(np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1))


def _work_offset(machine: Machine, columns: list[int]) -> Floats:
    """X Y Z of the linear axes with the tip at the workpiece zero and the rotary axes at zero.

    Solved with forward kinematics; the reader finds the same offset by inverse kinematics.
    """
    joints = np.zeros((4, 5))
    for k, column in enumerate(columns):
        joints[k + 1, column] = 1.0
    tip, _ = forward(machine, joints)
    directions = (tip[1:] - tip[0]).T
    return np.asarray(np.linalg.solve(directions, -tip[0]))


def _z_axis_direction(machine: Machine, rotary: Floats) -> Floats:
    """(k, 3): the direction in which the tip moves in the workpiece as Z grows, at rotary positions (k, 2)."""
    joints = np.zeros((2, len(rotary), 5))
    joints[:, :, list(machine.rotary)] = rotary
    joints[1, :, machine.column("Z")] = 1.0
    tip, _ = forward(machine, joints.reshape(-1, 5))
    return np.asarray(tip[len(rotary) :] - tip[: len(rotary)])


def feed_rule(control: Control, settings: Mapping[str, str]) -> str:
    """Return what F means while rotary axes turn: one of ``FEEDS_WITHOUT_TCP``, or ``FEED_AT_TIP`` by a setting."""
    return FEED_AT_TIP if settings.get("rotary_feed") == FEED_AT_TIP else control.feed_without_tcp


def feed_format(rule: str) -> str:
    """Return the name of the number format of F under a feed rule."""
    return "inverse_time" if rule == "inverse_time" else "feed"


def feed_words(
    motion: AxisCoordinates, feed: Floats, rule: str, number_format: NumberFormat
) -> tuple[Floats, Flags, Flags]:
    """Return the F with which the tip has its feed: one over the minutes of a block, or what the control counts.

    motion         of n rows
    feed           (n,) float64: of the tip, mm/min; NaN in rapids
    rule           as ``feed_rule`` returns it
    number_format  Of F; its limits count

    value, below, above  (n,) float64, moved onto the limit it exceeds; (n,) bool, below the least; (n,) bool, above the
                         greatest. They are valid only in rows in which rotary axes turn
    """
    lengths: dict[str, Floats] = {
        "all_axes": motion.all_axes_length,
        "slides": motion.linear_length,
        FEED_AT_TIP: motion.tip_length,
    }
    counted = lengths.get(rule, np.ones(len(feed)))
    value = feed * counted / np.maximum(motion.tip_length, 1e-12)
    least, greatest = number_format.least, number_format.greatest
    return np.clip(value, least, greatest), value < least, value > greatest
