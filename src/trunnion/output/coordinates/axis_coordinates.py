"""Motion without TCP: what the words X Y Z and F become where nobody holds the tip.

X Y Z are positions of the slides, counted from where they stand when the tip is at the workpiece zero with the rotary
axes at zero: that is the work offset, with the tool's length in it. They are worked out for the rotary positions as
they are printed, so that rounding an angle costs nothing at the tip.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.definition import Control
from trunnion.controls.words import NumberFormat
from trunnion.machines import Machine, forward, slide_positions
from trunnion.model.motion import Motion

#: A tip that moves by less than this, mm, rests: a degree counts as a millimetre then.
TIP_AT_REST: Final = 1e-4

#: The setting ``rotary_feed`` of controls that can be told that F is the tip's all the same.
FEED_AT_TIP: Final = "tip"


@dataclass(frozen=True, slots=True, eq=False)
class AxisCoordinates:
    """A motion in words of the slides.

    motion    tips and centres of circles are positions of the slides X, Y and Z
    rotary_moves     (n,) bool     a rotary axis turns on the way to the row
    tip_length    (n,) float64  of the way to the row that the feed means: mm of the tip, or degrees where it rests
    linear_length     (n,) float64  of the way to the row of the slides X, Y and Z, mm, or degrees where they rest
    all_axes_length  (n,) float64  of the way to the row with all axes as one, a degree as a millimetre
    wraps  (n, 2) bool   the rotary axis goes past the end of the turn that it displays
    """

    motion: Motion
    rotary_moves: Flags
    tip_length: Floats
    linear_length: Floats
    all_axes_length: Floats
    wraps: Flags

    def select(self, rows: Ints | slice) -> "AxisCoordinates":
        """Some rows, without their motion, which stays whole."""
        lengths = self.tip_length[rows], self.linear_length[rows], self.all_axes_length[rows]
        return AxisCoordinates(self.motion, self.rotary_moves[rows], *lengths, self.wraps[rows])


def to_axis_coordinates(machine: Machine, motion: Motion, decimals: int) -> AxisCoordinates:
    """A motion without TCP in words of the slides; angles are printed with ``decimals``."""
    moves, arcs = motion.operation.moves, motion.operation.arcs
    rotary = np.round(motion.rotary, decimals)
    columns = [machine.column(name) for name in "XYZ"]
    zero = _work_offset(machine, columns)
    slides = slide_positions(machine, moves.tip, rotary)[:, columns] - zero
    if len(arcs.row):
        about = np.sign(np.einsum("ij,ij->i", _z_slide_direction(machine, rotary[arcs.row]), arcs.normal))
        normal = np.outer(about, [0.0, 0.0, 1.0])
        centre = slide_positions(machine, arcs.centre, rotary[arcs.row])[:, columns] - zero
        arcs = replace(arcs, centre=centre, normal=normal)
    for r, column in enumerate(machine.rotary):
        top = machine.axes[column].display_low + 360.0  # which prints as the lower end
        rotary[rotary[:, r] >= top - 0.5 * 10.0**-decimals, r] -= 360.0
    steps = np.diff(rotary, axis=0, prepend=rotary[:1])
    jumps = np.zeros(steps.shape, np.bool_)
    for r, column in enumerate(machine.rotary):
        if not np.isnan(machine.axes[column].display_low):
            jumps[:, r] = np.abs(steps[:, r]) > 180.0
            steps[:, r] -= 360.0 * np.rint(steps[:, r] / 360.0)
    turned = np.abs(steps).max(axis=1)
    way = np.linalg.norm(np.diff(moves.tip, axis=0, prepend=moves.tip[:1]), axis=1)
    apart = np.linalg.norm(np.diff(slides, axis=0, prepend=slides[:1]), axis=1)
    operation = replace(motion.operation, moves=replace(moves, tip=np.ascontiguousarray(slides)), arcs=arcs)
    return AxisCoordinates(
        replace(motion, operation=operation, rotary=rotary),
        turned > 0.0,
        np.where(way < TIP_AT_REST, turned, way),
        np.where(apart < TIP_AT_REST, turned, apart),
        np.hypot(apart, np.linalg.norm(steps, axis=1)),
        jumps,
    )


def _work_offset(machine: Machine, columns: list[int]) -> Floats:
    """Slides X Y Z with the tip at the workpiece zero and the rotary axes at zero, by the forward map.

    The reader finds the same place by the inverse one.
    """
    joints = np.zeros((4, 5))
    for k, column in enumerate(columns):
        joints[k + 1, column] = 1.0
    tip, _ = forward(machine, joints)
    ways = (tip[1:] - tip[0]).T
    return np.asarray(np.linalg.solve(ways, -tip[0]))


def _z_slide_direction(machine: Machine, rotary: Floats) -> Floats:
    """(k, 3): the way of the tip in the workpiece as Z grows, at rotary positions (k, 2)."""
    joints = np.zeros((2, len(rotary), 5))
    joints[:, :, list(machine.rotary)] = rotary
    joints[1, :, machine.column("Z")] = 1.0
    tip, _ = forward(machine, joints.reshape(-1, 5))
    return np.asarray(tip[len(rotary) :] - tip[: len(rotary)])


def feed_rule(control: Control, settings: Mapping[str, str]) -> str:
    """How the feed is said where rotary axes turn: one of ``FEEDS_WITHOUT_TCP``, or ``FEED_AT_TIP`` by a setting."""
    return FEED_AT_TIP if settings.get("rotary_feed") == FEED_AT_TIP else control.feed_without_tcp


def feed_format(rule: str) -> str:
    """The format of the word that says it."""
    return "inverse_time" if rule == "inverse_time" else "feed"


def feed_words(slides: AxisCoordinates, feed: Floats, rule: str, form: NumberFormat) -> tuple[Floats, Flags, Flags]:
    """What F is so that the tip has its feed: one over the minutes of the block, or what the control counts a minute.

    Parameters
    ----------
    slides
        Of n rows.
    feed : (n,) float64
        Of the tip, mm/min; NaN in rapids.
    rule
        Of ``feed_rule``.
    form
        Of the word: its limits.

    Returns
    -------
    rate, slow, fast
        (n,) float64, put onto the limit where beyond it; (n,) bool below the least; (n,) bool above the greatest. Only
        rows in which rotary axes turn mean anything.
    """
    ones = np.ones(len(feed))
    ways: dict[str, Floats] = {
        "all_axes": slides.all_axes_length,
        "slides": slides.linear_length,
        FEED_AT_TIP: slides.tip_length,
    }
    counted = ways.get(rule, ones)
    rate = feed * counted / np.maximum(slides.tip_length, 1e-12)
    return np.clip(rate, form.least, form.greatest), rate < form.least, rate > form.greatest
