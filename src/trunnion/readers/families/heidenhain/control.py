"""The virtual control of a TNC: what only it does with planes, datums, retracts and rotary axes."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Axis, Machine, Mount, forward
from trunnion.model import axis_positions
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import tool_orientation
from trunnion.readers.control.affine_map import AffineMap
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.row_recorder import MAX_POSITION, Note
from trunnion.readers.control.virtual_control import RAPID, Circle, VirtualControl
from trunnion.readers.families.heidenhain.plane_frames import Datum, spatial
from trunnion.readers.families.heidenhain.scan_kernel import letter_table

#: How far the values of a rotary solution may lie from each other and count as the same, degrees.
_SAME: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Positioning:
    """How a PLANE block moves the rotary axes.

    manner      TURN the rotary axes, MOVE them with the tip kept, or STAY
    sequence    1 or -1: the solution with the master axis, that next to the tool, positive or negative; 0: the shortest
    table       TABLE ROT: a rotary axis that is free turns the table instead of the coordinates
    distance    from the tip to the centre of a MOVE, mm
    rapid       FMAX; else at ``feed``, mm/min, or at the feed in force
    retract     along the tool axis before, mm; inf: as far as the travel goes; 0: not at all
    """

    mode: str = "STAY"
    sequence: int = 0
    table: bool = False
    distance: float = 0.0
    rapid: bool = False
    feed: float | None = None
    retract: float = 0.0


class HeidenhainControl(VirtualControl):
    """A TNC at work on a machine."""

    def __init__(
        self, machine: Machine, note: Note, file: StepColumnBuilder[int], *, shortest: bool | None = None
    ) -> None:
        self.shortest_path = False
        #: TCPM with AXIS SPAT: rotary words are spatial angles, and these are the last ones.
        self.spatial_angles_active = False
        self.angles = [0.0, 0.0, 0.0]
        #: Cycles 7, 8, 10 and 11 before the plane was tilted, and in it.
        self._base_datum = Datum()
        self._plane_datum = Datum()
        #: The first row from which on rows mean the same by their place.
        self._comparable_from = 0
        #: A tool has been called: where positions are those of the slides its length counts.
        self._length_active = False
        #: Pole of circles and polar coordinates, programmed position, mm.
        self.pole: Floats | None = None
        super().__init__(machine, note, file, shortest=shortest)
        self.feed_path.set(0, int(FeedPath.AXES))
        self._tables = letter_table((self.rotary_names[0], self.rotary_names[1])), letter_table(("", ""))

    @property
    def table(self) -> np.ndarray[tuple[int], np.dtype[np.uint8]]:
        """What letters mean to the kernel now: rotary words only where they are positions and nothing else moves."""
        return self._tables[self.spatial_angles_active or (self.tilted and not self.tcp)]

    def takes_shortest_path(self, axis: Axis) -> bool:
        """With M126."""
        return self.shortest_path

    def feed_at_tip(self, on: bool) -> None:
        """M116: F is that of the tip where rotary tables turn; M117: a degree counts as a millimetre."""
        heads = [axis.name for axis in self.machine.axes if axis.is_rotary and axis.mount is Mount.TOOL]
        if on and heads:
            text = f"M116 leaves out the axes of a head: the feed where {' and '.join(heads)} turns is unknown"
            self.note(text, Severity.WARNING)
        self.feed_path.set(self.row, int(FeedPath.TIP if on else FeedPath.AXES))

    # Tools

    @property
    def _length_offset(self) -> Floats:
        length = np.zeros(3)
        if self._length_active:
            length[self.plane_axis] = self.machine.tool_length or 0.0
        return length

    def call_tool(self, name: str | None, plane: int | None) -> None:
        """TOOL CALL: another tool, or None; and the axis that it lies along, which stands on the working plane."""
        if name is not None:
            self.select_tool(name)
        longer = self._length_active if name is None else name.strip("0") != ""
        along = self.plane_axis if plane is None else plane
        if self.machine.tool_length and (longer, along) != (self._length_active, self.plane_axis):
            with self.frame_change():
                self._length_active, self.plane_axis = longer, along
        else:
            self._length_active, self.plane_axis = longer, along
        if name is not None:
            self.change_tool()

    # Datum, mirror, rotation, scale

    @property
    def datum(self) -> Datum:
        """What holds where programs are now: in the tilted plane, or without one."""
        return self._plane_datum if self.tilted else self._base_datum

    def set_datum(self, datum: Datum) -> None:
        """Shift, mirror, turn or scale; the axes stand still."""
        frame = datum.frame(self.plane_axis)
        self.set_program_frame(frame, keep_base=False)
        if self.program_frame is not frame:
            return
        if self.tilted:
            if datum == Datum() and self._plane_datum == Datum() and self._base_datum != Datum():
                text = "the shift from before the tilted plane stays: taken as a reset of the plane's own (unconfirmed)"
                self.note(text, Severity.WARNING)
            self._plane_datum = datum
        else:
            self._base_datum = datum

    # Planes

    def tilt(self, linear: Floats, how: Positioning, *, relative: bool = False) -> tuple[float, float] | None:
        """Tilt the plane about the datum; returns the rotary position that it needs, None if there is none.

        linear     (3, 3) from the tilted plane to the coordinates below it
        relative   on top of the plane in force
        """
        base = self.frame if relative else self._base
        total = base.compose(AffineMap(linear))
        normal = total.linear[:, 2] / np.linalg.norm(total.linear[:, 2])
        self.resolve_rows()
        rotary = self._rotary_solution(normal, how)
        if rotary is None:
            return None
        if how.table and tool_orientation.first_axis_is_free(self.machine, rotary):
            rotary = self._in_reached_turn(tool_orientation.align_first_axis(self.machine, rotary, total.linear[:, 0]))
        self._position_rotary(rotary, how)
        self._enter_plane(total)
        return rotary

    def tilt_axial(self, rotary: tuple[float, float], how: Positioning) -> None:
        """The plane that the tool stands on with the rotary axes at these positions."""
        self.resolve_rows()
        linear = tool_orientation.tool_frame(self.machine, rotary)
        self._position_rotary(rotary, how)
        self._enter_plane(AffineMap(linear, self._base.shift))

    def untilt(self, how: Positioning) -> None:
        """PLANE RESET: no tilted plane; what was set in it ends with it."""
        self._position_rotary((0.0, 0.0), how)
        if self.tilted:
            self.set_plane(None, self._base_datum.frame(self.plane_axis))
        self._plane_datum = Datum()

    @property
    def _base(self) -> AffineMap:
        """Where tilted planes begin."""
        return self._base_datum.frame(self.plane_axis)

    def _enter_plane(self, plane: AffineMap) -> None:
        self.set_plane(plane)
        self._plane_datum = Datum()

    def _rotary_solution(self, normal: Floats, how: Positioning) -> tuple[float, float] | None:
        """Rotary position that stands the tool on a plane, as the block asks for it."""
        pairs = [
            self._in_reached_turn(pair)
            for pair in tool_orientation.solutions(self.machine, normal, self.current_joints)
        ]
        if not pairs:
            self.note("PLANE: no rotary position stands the tool on this plane", Severity.ERROR)
            return None
        inside = [pair for pair in pairs if tool_orientation.is_in_travel(self.machine, pair)]
        if how.sequence:
            # A master axis at zero has no sign: either sequence takes it.
            inside = [pair for pair in inside if pair[1] * how.sequence > 0.0 or abs(pair[1]) < _SAME]
        if not inside:
            text = "inside the travel" if not how.sequence else f"with SEQ{'-' if how.sequence < 0 else '+'}"
            self.note(f"PLANE: no rotary position {text} stands the tool on this plane", Severity.ERROR)
            return None
        held = [float(self.current_joints[column]) for column in self.machine.rotary]
        return min(inside, key=lambda pair: sum(abs(value - was) for value, was in zip(pair, held, strict=True)))

    def _in_reached_turn(self, rotary: tuple[float, float]) -> tuple[float, float]:
        """The same position in the turn that the axes take to it."""
        found = []
        for column, value in zip(self.machine.rotary, rotary, strict=True):
            axis = self.machine.axes[column]
            held = float(self.current_joints[column])
            found.append(
                axis_positions.nearest_turn(held, value, False, axis.low, axis.high) if not axis.endless else value
            )
        return found[0], found[1]

    def _position_rotary(self, rotary: tuple[float, float], how: Positioning) -> None:
        """Move the rotary axes as the block says."""
        if how.retract:
            self.retract(how.retract, rapid=how.rapid, feed=how.feed)
        if how.mode == "STAY":
            return
        kept = float(self.commanded[3])
        if how.feed is not None:
            self.commanded[3] = how.feed
        self.resolve_rows()
        kind = Kind.RAPID if how.rapid else Kind.LINEAR
        bits = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND)
        slides = self.current_joints[self._slides].copy()
        if how.mode == "MOVE":
            reached = self._joints_after_words(rotary, self.default_turn_rules)
            tip, axis = forward(self.machine, self.current_joints[None])
            after = forward(self.machine, reached[None])[1][0]
            wanted = tip[0] + how.distance * (after - axis[0])
            found = self._slides_for(wanted, reached)
            if found is None:
                self.note("PLANE MOVE: the slides cannot follow", Severity.ERROR)
            else:
                slides = found
        self.move_axes(kind, slides, list(rotary), self.default_turn_rules, bits)
        self.commanded[3] = kept

    def _joints_after_words(self, rotary: Sequence[float], turn_rule: int) -> Floats:
        """Where the axes are once the rotary ones have followed their words, and the slides have not moved."""
        joints = self.current_joints.copy()
        for which, column in enumerate(self.machine.rotary):
            low = self.machine.axes[column].display_low
            lowest = 0.0 if math.isnan(low) else low
            joints[column] = axis_positions.rotary_position(
                float(joints[column]), rotary[which], turn_rule >> (4 * which) & 15, lowest
            )
        return joints

    def _slides_for(self, tip: Floats, joints: Floats) -> Floats | None:
        """Slides X, Y, Z that bring the tip to a point of the workpiece frame, with the rotary axes of ``joints``."""
        rotary = joints[None, list(self.machine.rotary)]
        tip_is_given = np.ones(1, np.bool_)
        found = axis_positions.joints_from_rows(self.machine, self._kinematics, tip_is_given, tip[None], rotary)[0]
        slides = found[self._slides]
        return slides if np.isfinite(slides).all() else None

    # Directions

    def end_direction(self) -> Floats | None:
        """Where the last motion went to at its end, in programmed coordinates; None if there was none."""
        if not self.row:
            return None
        back = np.linalg.inv(self.position_map[:, :3])
        if self._arcs and self._arcs[-1][0] == self.row - 1:
            _, centre, normal, _, _ = self._arcs[-1]
            tip = self._tip_of(self.commanded[:3])
            if self.tip_programmed:
                return np.asarray(back @ np.cross(normal, tip - centre))
            rigid = self._slides_to_tip()
            tip = rigid[:, :3] @ tip + rigid[:, 3]
            return np.asarray(back @ np.linalg.solve(rigid[:, :3], np.cross(normal, tip - centre)))
        if self.row - 2 < self._comparable_from:
            return None
        return np.asarray(back @ (self.columns.xyz[self.row - 1] - self.columns.xyz[self.row - 2]))

    def _update_maps(self) -> None:
        tips = self.tip_programmed
        super()._update_maps()
        if tips != self.tip_programmed:
            self._comparable_from = self.row

    def move_axes(self, kind: Kind, slides: Floats, rotary: list[float], turn_rule: int, bits: int) -> None:
        """Make a row of slide values and rotary values; see ``VirtualControl.move_axes``."""
        super().move_axes(kind, slides, rotary, turn_rule, bits)
        self._comparable_from = self.row

    # Retract

    def retract(self, distance: float, *, rapid: bool, feed: float | None) -> None:
        """M140: back along the tool axis, mm; inf: as far as the travel of the slides goes."""
        self.resolve_rows()
        tip, axis = forward(self.machine, self.current_joints[None])
        slides = self.current_joints[self._slides].copy()
        one = self._slides_for(tip[0] + axis[0], self.current_joints)
        if one is None:
            self.note("M140: the slides cannot go along the tool axis", Severity.ERROR)
            return
        per_mm = one - slides
        # To the end of the travel is a position of the machine, wherever the workpiece sits.
        to_the_end = math.isinf(distance)
        if to_the_end:
            distance = self._free_travel(slides, per_mm)
            if math.isinf(distance):
                self.note("M140 MB MAX: the travel of the slides is not known, the tool stays", Severity.WARNING)
                return
        kept = float(self.commanded[3])
        if feed is not None:
            self.commanded[3] = feed
        bits = sum(1 << axis for axis in range(3) if abs(per_mm[axis]) > 1e-9)
        still = [math.nan, math.nan]
        self.add_event(*(("retract", "M140") if to_the_end else ("leave", distance)))
        self.machine_rows.set(self.row, to_the_end)
        self.move_axes(Kind.RAPID if rapid else Kind.LINEAR, slides + distance * per_mm, still, 0, bits)
        self.machine_rows.set(self.row, False)
        self.commanded[3] = kept

    def _free_travel(self, slides: Floats, per_mm: Floats) -> float:
        """How far the slides can go, mm along the tool axis; inf if nothing ends them."""
        room = math.inf
        for column, at, step in zip(self._slides, slides, per_mm, strict=True):
            axis = self.machine.axes[column]
            if abs(step) > 1e-9:
                end = axis.high if step > 0.0 else axis.low
                room = min(room, max((end - float(at)) / float(step), 0.0))
        return room

    # Motion

    def move(
        self,
        axes: Mapping[str, AxisWord],
        vector: Floats | None,
        *,
        circle: Circle | None = None,
        machine_frame: bool = False,
        feed_written: bool = False,
    ) -> None:
        """Execute the motion of a block; see ``VirtualControl.move``.

        In a tilted plane without TCP a rotary axis turns alone, and takes the programmed positions with it.
        """
        if self.spatial_angles_active and vector is None and not machine_frame and axes.keys() & {"A", "B", "C"}:
            vector = self._vector_of_angles(axes)
            axes = {name: word for name, word in axes.items() if name not in ("A", "B", "C")}
        if (
            not self.tilted
            or self.tcp
            or machine_frame
            or vector is not None
            or not axes.keys() & set(self.rotary_names)
        ):
            super().move(axes, vector, circle=circle, machine_frame=machine_frame, feed_written=feed_written)
            return
        if circle is not None:
            self.note("rotary axes turn during a circle of a tilted plane: taken as a straight line", Severity.ERROR)
        self._turn_in_plane(axes, int(ProgrammedWord.FEED) if feed_written else 0)

    def _vector_of_angles(self, axes: Mapping[str, AxisWord]) -> Floats:
        for axis, name in enumerate("ABC"):
            if name in axes:
                value, how = axes[name]
                self.angles[axis] = self.angles[axis] + value if self._is_incremental(how) else value
        return np.asarray(spatial(*self.angles)[:, 2])

    def _turn_in_plane(self, axes: Mapping[str, AxisWord], bits: int) -> None:
        self.resolve_rows()
        wanted = self.commanded[:3].copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                wanted[axis] = value * self.length_unit + (wanted[axis] if self._is_incremental(how) else 0.0)
                bits |= 1 << axis
        rotary, turn_rule, turned = self.rotary_words(axes)
        slides = self.current_joints[self._slides].copy()
        if bits & 7:
            reached = self._joints_after_words(rotary, turn_rule)
            found = None if np.abs(wanted).max() > MAX_POSITION else self._slides_for(self._tip_of(wanted), reached)
            if found is None:
                self.note("the slides cannot reach this position: the block is not executed", Severity.ERROR)
                return
            slides = found
        kind = Kind.RAPID if self.kind == RAPID else Kind.LINEAR
        self.move_axes(kind, slides, rotary, turn_rule, bits | turned)

    def _tip_of(self, place: Floats) -> Floats:
        return np.asarray(self.position_map[:, :3] @ place + self.position_map[:, 3])
