"""Cycles 27 and 28: a contour and a slot on a cylinder that is clamped on the centre of a rotary axis.

The rotary axis and the linear axis along it move together, the tool stands across the axis and over it, and goes in
along its own. What the axis is, and where it lies, comes from the chain of the machine.
"""

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import forward
from trunnion.messages import Wording
from trunnion.model.axis_positions import slide_columns
from trunnion.model.feed_path import FeedPath
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.hole_motion import MAX_FEED, CycleExecutionError, finite, peck_depths
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.cycle_values import check_given, check_signs
from trunnion.readers.families.heidenhain.cylinder_contours import CylinderContour, read_contour
from trunnion.readers.families.heidenhain.parameters import Parameters
from trunnion.readers.families.heidenhain.text import KlartextText
from trunnion.readers.families.heidenhain.words import CYLINDER_SLOT
from trunnion.records import dataclass

#: How far the tool may stand beside the axis of the cylinder, mm, and tool and axes may be off square.
_BESIDE: Final = 0.01
_OFF_SQUARE: Final = 1e-4


@dataclass(frozen=True, slots=True)
class CylinderCycle:
    """The values of a cycle, in mm and mm/min.

    depths     of the infeeds below the surface
    clearance  of the tip above the surface where it goes at rapid
    degrees    rotary words of the contour are degrees, and not lengths of arc
    """

    radius: float
    depths: tuple[float, ...]
    clearance: float
    plunge: float
    feed: float
    degrees: bool


def cylinder_cycle(number: int, values: Mapping[int, float], unit: float, feed_unit: float) -> CylinderCycle:
    """Return a cycle from its Q parameters; ``unit`` and ``feed_unit``: millimetres of lengths and of those in feeds.

    Raises ``CycleExecutionError``.
    """
    check_given(number, values)
    for parameter in values:
        finite(values[parameter])
    check_signs(values, (6, 10, 11, 12, 16, *((20,) if number == CYLINDER_SLOT else ())))
    if values[17] not in (0.0, 1.0):
        raise CycleExecutionError(Wording("NC380", "bad_dimension_type", value=values[17]))
    if values[1] > 0.0:
        raise CycleExecutionError(Wording("NC380", "depth_above_surface", value=f"Q1={values[1]:+g}"))
    if values[1] == 0.0:
        raise CycleExecutionError(Wording("NC380", "depth_0"))
    if -values[1] >= values[16]:
        raise CycleExecutionError(Wording("NC380", "deeper_than_radius", depth=-values[1], radius=values[16]))
    if max(values[11], values[12]) * feed_unit > MAX_FEED:
        raise CycleExecutionError(Wording("NC380", "feed_no_machine"))
    return CylinderCycle(
        values[16] * unit,
        tuple(depth * unit for depth in peck_depths(-values[1], values[10])),
        values[6] * unit,
        values[11] * feed_unit,
        values[12] * feed_unit,
        values[17] == 0.0,
    )


@dataclass(frozen=True, slots=True)
class _Place:
    """Where the tool stands over a cylinder.

    across   letter of the axis along the tool
    outward  1.0 or -1.0: its sense away from the axis of the cylinder
    radius   of the tip from the axis, mm
    """

    across: str
    outward: float
    radius: float


def mill_cylinder(
    control: HeidenhainControl,
    number: int,
    values: Mapping[int, float],
    contour: tuple[KlartextText, str, Parameters],
) -> int:
    """Execute cycle 27 or 28 with the contour of a label in a program; returns the number of motions.

    Raises ``CycleExecutionError`` where the cycle is impossible, or what a control does is not known.
    """
    source, label, parameters = contour
    cycle = cylinder_cycle(number, values, control.length_unit, control.feed_unit)
    lines = source.subprogram(label)
    if lines is None:
        raise CycleExecutionError(Wording("NC380", "no_contour_label", label=label))
    arc_unit = math.radians(cycle.radius) if cycle.degrees else control.length_unit
    path = read_contour(lines, parameters, unit=control.length_unit, arc_unit=arc_unit)
    place = _place(control, path)
    if number == CYLINDER_SLOT:
        control.note(Wording("NC221", "cylinder_slot_walls", width=values[20]), Severity.WARNING)
    elif path.side:
        control.note(Wording("NC221", "cylinder_tool_radius"), Severity.WARNING)
    rows = control.row
    before = control.motion, control.programmed_feed, int(control.modal.feed_path.current)
    control.modal.feed_path.set(control.row, int(FeedPath.TIP))
    _Milling(control, cycle, path, place).run()
    control.motion, control.programmed_feed = before[:2]
    control.modal.feed_path.set(control.row, before[2])
    return control.row - rows


class _Milling:
    """The motions of one call."""

    def __init__(self, control: HeidenhainControl, cycle: CylinderCycle, path: CylinderContour, place: _Place) -> None:
        self._control, self._cycle, self._path, self._place = control, cycle, path, place
        column = "XYZ".index(place.across)
        self._surface = float(control.programmed_position[column]) - place.outward * place.radius

    def run(self) -> None:
        cycle, points = self._cycle, self._path.points
        high = cycle.radius + cycle.clearance
        if self._place.radius < high:
            self._go(RAPID, {self._place.across: self._height(high)})
        self._go(RAPID, self._point(points[0], PositionMode.ABSOLUTE))
        self._go(RAPID, {self._place.across: self._height(high)})
        for depth in cycle.depths:
            self._go(LINEAR, {self._place.across: self._height(cycle.radius - depth)}, cycle.plunge)
            for before, point in pairwise(points):
                self._go(LINEAR, self._step(before, point), cycle.feed)
            self._go(RAPID, {self._place.across: self._height(high)})
            if not np.array_equal(points[-1], points[0]):
                self._go(RAPID, self._step(points[-1], points[0]))

    def _go(self, motion: int, axes: Mapping[str, AxisWord], feed: float | None = None) -> None:
        self._control.motion = motion
        if feed is not None:
            self._control.programmed_feed = feed
        self._control.move(axes, None)

    def _height(self, radius: float) -> AxisWord:
        return (self._surface + self._place.outward * radius) / self._control.length_unit, PositionMode.ABSOLUTE

    def _point(self, point: Floats, rotary: PositionMode) -> dict[str, AxisWord]:
        return {
            self._path.rotary: (math.degrees(float(point[0]) / self._cycle.radius), rotary),
            self._path.along: (float(point[1]) / self._control.length_unit, PositionMode.ABSOLUTE),
        }

    def _step(self, before: Floats, point: Floats) -> dict[str, AxisWord]:
        """Return the words from a point to another: the rotary axis goes by the difference, over full turns too."""
        words = self._point(point, PositionMode.ABSOLUTE)
        turn = math.degrees(float(point[0] - before[0]) / self._cycle.radius)
        return {**words, self._path.rotary: (turn, PositionMode.INCREMENTAL)}


def _place(control: HeidenhainControl, path: CylinderContour) -> _Place:
    """Return where the tool stands over the cylinder; refuse what it cannot be milled from."""
    if control.tcp or control.at_ends or control.tilted:
        raise CycleExecutionError(Wording("NC380", "cylinder_in_frame"))
    if control.machine.workpiece_zero is None:
        raise CycleExecutionError(Wording("NC380", "cylinder_without_zero"))
    if path.rotary not in control.rotary_names:
        raise CycleExecutionError(Wording("NC380", "no_axis_for_cylinder", axis=path.rotary))
    if not np.array_equal(control.position_map[:, :3], np.eye(3)):
        raise CycleExecutionError(Wording("NC380", "cylinder_in_turned_datum"))
    control.end_contour()
    control.resolve_rows()
    machine, here = control.machine, control.current_joints
    column = machine.rotary[control.rotary_names.index(path.rotary)]
    joints = np.tile(here, (6, 1))
    joints[1, column] += 180.0
    joints[2, column] += 90.0
    for row, slide in enumerate(slide_columns(machine), 3):
        joints[row, slide] += 1.0
    tips, tools = forward(machine, joints)
    # The axis of the cylinder, in the workpiece: the middle of half a turn, and across two tool axes.
    axis = np.cross(tools[0], tools[2])
    centre, steps = 0.5 * (tips[0] + tips[1]), tips[3:] - tips[0]
    square = abs(float(np.linalg.norm(axis)) - 1.0) < _OFF_SQUARE
    along = float(abs(steps["XYZ".index(path.along)] @ axis))
    if not square or abs(along - 1.0) > _OFF_SQUARE:
        raise CycleExecutionError(Wording("NC380", "tool_not_across", axis=path.rotary, linear=path.along))
    out = tips[0] - centre
    beside = float(np.linalg.norm(out - (out @ tools[0]) * tools[0]))
    if beside > _BESIDE:
        raise CycleExecutionError(Wording("NC380", "tool_beside_axis", gap=beside, axis=path.rotary))
    reach = steps @ tools[0]
    across = int(np.argmax(np.abs(reach)))
    return _Place("XYZ"[across], 1.0 if reach[across] > 0.0 else -1.0, float(out @ tools[0]))
