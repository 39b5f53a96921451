"""Datums and tilted planes of a TNC."""

import math
from collections.abc import Set
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, forward
from trunnion.messages import Wording, phrase
from trunnion.model import axis_positions
from trunnion.model.toolpath import Kind
from trunnion.readers.control import tool_orientation
from trunnion.readers.control.affine_map import AffineMap
from trunnion.readers.control.axis_word import RotaryTarget
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.virtual_control import VirtualControl
from trunnion.readers.families.heidenhain.plane_datums import PlaneDatums
from trunnion.readers.families.heidenhain.plane_frames import Datum
from trunnion.records import dataclass

#: A master axis within this of zero has no sign, degrees.
_ZERO: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Positioning:
    """How a PLANE block positions the rotary axes.

    mode        TURN the rotary axes, MOVE them while the tip stays, or STAY
    sequence    1 or -1: the solution with a positive or negative master axis, which is next to the tool; 0: the nearest
    table       TABLE ROT: a free rotary axis turns the table instead of the coordinates
    distance    from the tip to the centre of a MOVE, mm
    rapid       FMAX; else at ``feed``, mm/min, or at the feed in force
    retract     along the tool axis before, mm; inf: to the end of the travel; 0: none
    """

    mode: str = "STAY"
    sequence: int = 0
    table: bool = False
    distance: float = 0.0
    rapid: bool = False
    feed: float | None = None
    retract: float = 0.0


class PlaneControl(VirtualControl):
    """Executes cycles 7, 8, 10, 11 and 26, the PLANE function and M140."""

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, shortest=shortest)
        self._datums = PlaneDatums()

    # Datum shift, mirror, rotation, scale

    @property
    def datum(self) -> Datum:
        """The datum in force: that of the tilted plane, or the one without a plane."""
        return self._datums.in_plane if self.tilted else self._datums.base

    def set_datum(self, datum: Datum, parts: Set[str], *, incremental: bool = False) -> None:
        """Shift, mirror, rotate or scale; the axes stay.

        parts        those of ``plane_datums`` that are set
        incremental  they count from their values before
        """
        frame = datum.frame(self.plane_axis)
        if datum != self.datum:
            self.judge_within_compensation("a shift, rotation, mirror image or scale", "unconfirmed")
        self.note_shift()
        self.set_program_frame(frame, keep_base=False)
        if self.program_frame is not frame:
            return
        if self.tilted:
            self._datums.set_in_plane(datum, parts)
        else:
            self._datums.set_base(datum, frozenset() if incremental else parts)
        self._require_settled_datum()

    def left_on(self) -> Wording | None:
        """Return a plane without use, or a datum, that the end of the program leaves on; None if nothing."""
        if self.in_unused_plane and self._is_turned:
            return phrase("left_plane")
        return None if self.datum.frame(self.plane_axis).is_identity else phrase("left_datum")

    @property
    def _is_turned(self) -> bool:
        """Whether the plane has another direction than the work offset; its zero is that of the datum."""
        return not AffineMap(self._plane.linear).is_identity

    def _require_settled_datum(self) -> None:
        """Let no motion depend on a datum that is unsettled."""
        parts = ", ".join(sorted(self._datums.unsettled))
        if not parts:
            self.preconditions.meet("datum")
            return
        variant = "datum_in_plane_unconfirmed" if self.tilted else "datum_behind_plane_unconfirmed"
        self.preconditions.require("datum", Wording("NC351", variant, parts=parts))

    # Planes

    def tilt(self, linear: Floats, positioning: Positioning, *, relative: bool = False) -> tuple[float, float] | None:
        """Tilt the plane about the datum; returns the rotary position for it, None if there is none.

        linear     (3, 3) from the tilted plane to the coordinates in which it is defined
        relative   define it in the plane in force
        """
        base = self.frame if relative else self._base_frame
        total = base.compose(AffineMap(linear))
        normal = total.linear[:, 2] / np.linalg.norm(total.linear[:, 2])
        self.resolve_rows()
        rotary = self._rotary_solution(normal, positioning)
        if rotary is None:
            return None
        if positioning.table and tool_orientation.first_axis_is_free(self.machine, rotary):
            aligned = tool_orientation.align_first_axis(self.machine, rotary, total.linear[:, 0])
            rotary = self._in_nearest_turn(aligned)
        self._position_rotary(rotary, positioning)
        self._enter_plane(total, on_top=relative)
        return rotary

    def tilt_axial(self, rotary: tuple[float, float], positioning: Positioning) -> None:
        """Tilt to the plane that is normal to the tool at a rotary position."""
        self.resolve_rows()
        linear = tool_orientation.tool_frame(self.machine, rotary)
        self._position_rotary(rotary, positioning)
        self._enter_plane(AffineMap(linear, self._base_frame.shift))

    def untilt(self, positioning: Positioning) -> None:
        """PLANE RESET: end the tilted plane, and the datum that was set in it."""
        self._position_rotary((0.0, 0.0), positioning)
        if self.tilted:
            self._datums.leave_plane()
            self.set_plane(None, self._base_frame)
            self._require_settled_datum()

    @property
    def _base_frame(self) -> AffineMap:
        """The frame in which planes are defined."""
        return self._datums.base.frame(self.plane_axis)

    def _enter_plane(self, plane: AffineMap, *, on_top: bool = False) -> None:
        self._datums.enter_plane(on_top=on_top)
        self.set_plane(plane)
        if not self._is_turned:
            self.add_event("level")
        self._require_settled_datum()

    def _rotary_solution(self, normal: Floats, positioning: Positioning) -> tuple[float, float] | None:
        """Return the rotary position with the tool normal to a plane that the block selects."""
        solutions = tool_orientation.solutions(self.machine, normal, self.current_joints)
        pairs = [self._in_nearest_turn(pair) for pair in solutions]
        if not pairs:
            self.note(Wording("NC350", "plane_no_rotary_position_stands"), Severity.ERROR)
            return None
        inside = [pair for pair in pairs if tool_orientation.is_in_travel(self.machine, pair)]
        sequence = positioning.sequence
        if sequence:
            last = self.machine.last_rotary
            inside = [pair for pair in inside if pair[last] * sequence > 0.0 or abs(pair[last]) < _ZERO]
        if not inside:
            self.note(
                Wording("NC350", "plane_outside_sequence", sign="-" if sequence < 0 else "+")
                if sequence
                else Wording("NC350", "plane_outside_travel"),
                Severity.ERROR,
            )
            return None
        current = [float(self.current_joints[column]) for column in self.machine.rotary]
        return min(inside, key=lambda pair: sum(abs(value - now) for value, now in zip(pair, current, strict=True)))

    def _in_nearest_turn(self, rotary: tuple[float, float]) -> tuple[float, float]:
        """Return a rotary position in the turn that axes with end stops take; endless ones keep the number."""
        values = []
        for column, value in zip(self.machine.rotary, rotary, strict=True):
            axis = self.machine.axes[column]
            if not axis.endless:
                current = float(self.current_joints[column])
                value = axis_positions.nearest_turn(current, value, False, axis.low, axis.high)
            values.append(value)
        return values[0], values[1]

    # Positioning of the rotary axes

    def _position_rotary(self, rotary: tuple[float, float], positioning: Positioning) -> None:
        """Retract and move the rotary axes as the block programs it."""
        if positioning.retract:
            self.retract(positioning.retract, rapid=positioning.rapid, feed=positioning.feed)
        if positioning.mode == "STAY":
            return
        feed = self.programmed_feed
        if positioning.feed is not None:
            self.programmed_feed = positioning.feed
        self.resolve_rows()
        target = self.rotary_position(rotary)
        slides = self.current_joints[self._slides].copy()
        if positioning.mode == "MOVE":
            joints = self._joints_after(target)
            tip, axis = forward(self.machine, self.current_joints[None])
            axis_after = forward(self.machine, joints[None])[1][0]
            tip_after = tip[0] + positioning.distance * (axis_after - axis[0])
            following = self._slides_for(tip_after, joints)
            if following is None:
                self.note(Wording("NC310", "slides_cannot_follow"), Severity.ERROR)
            else:
                slides = following
        self.move_axes(Kind.RAPID if positioning.rapid else Kind.LINEAR, slides, target)
        self.programmed_feed = feed

    def _joints_after(self, target: RotaryTarget) -> Floats:
        """Return the axis values after rotary words, with the slides as they are, (5,)."""
        joints = self.current_joints.copy()
        for which, column in enumerate(self.machine.rotary):
            low = self.machine.axes[column].display_low
            turn_start = 0.0 if math.isnan(low) else low
            rule = target.turn_rule >> (4 * which) & 15
            joints[column] = axis_positions.rotary_position(
                float(joints[column]), target.values[which], rule, turn_start
            )
        return joints

    def _slides_for(self, tip: Floats, joints: Floats) -> Floats | None:
        """Return the slide positions X, Y, Z for a tip in the workpiece frame, with the rotary axes of ``joints``."""
        rotary, is_tip = joints[None, list(self.machine.rotary)], np.ones(1, np.bool_)
        found = axis_positions.joints_from_rows(self.machine, self._kinematics, is_tip, tip[None], rotary)
        slides = found[0, self._slides]
        return slides if np.isfinite(slides).all() else None

    # Retract

    def retract(self, distance: float, *, rapid: bool, feed: float | None) -> None:
        """M140: retract along the tool axis, mm; inf: to the end of the travel of the slides."""
        self.resolve_rows()
        tip, axis = forward(self.machine, self.current_joints[None])
        slides = self.current_joints[self._slides].copy()
        one_mm_on = self._slides_for(tip[0] + axis[0], self.current_joints)
        if one_mm_on is None:
            self.note(Wording("NC310", "slides_cannot_go_along_tool"), Severity.ERROR)
            return
        per_mm = one_mm_on - slides
        # The end of the travel is a position of the machine, wherever the workpiece is.
        to_the_end = math.isinf(distance)
        if to_the_end:
            distance = self._free_travel(slides, per_mm)
            if math.isinf(distance):
                self.note(Wording("NC224", "m140_mb_max_travel_slides"), Severity.WARNING)
                return
        feed_before = self.programmed_feed
        if feed is not None:
            self.programmed_feed = feed
        bits = sum(1 << axis for axis in range(3) if abs(per_mm[axis]) > 1e-9)
        self.add_event(*(("retract", "M140") if to_the_end else ("leave", distance)))
        self.modal.machine_frame.set(self.row, to_the_end)
        self.move_axes(Kind.RAPID if rapid else Kind.LINEAR, slides + distance * per_mm, bits=bits)
        self.modal.machine_frame.set(self.row, False)
        self.programmed_feed = feed_before

    def _free_travel(self, slides: Floats, per_mm: Floats) -> float:
        """Return how far the slides can move, mm along the tool axis; inf if nothing limits them."""
        free = math.inf
        for column, position, step in zip(self._slides, slides, per_mm, strict=True):
            axis = self.machine.axes[column]
            if abs(step) > 1e-9:
                end = axis.high if step > 0.0 else axis.low
                free = min(free, max((end - float(position)) / float(step), 0.0))
        return free
