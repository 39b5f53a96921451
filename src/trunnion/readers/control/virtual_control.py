"""The virtual control: what programmed positions mean, and the motions that they ask for.

It knows nothing of text and of no language. The interpreter of a family tells it what a block said; it answers with
rows. What only one family does is in that family's own control, which extends this one.

Two ways to mean X Y Z. With TCP, or in a tilted plane, they are the tool tip in the active frame. Otherwise they are
the values of the slides, counted from the work offset: with the rotary axes at zero the tip is then where the program
says, with turned axes it is where the machine takes it.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine, forward
from trunnion.machines.inverse import kinematic_parameters
from trunnion.model import axis_positions
from trunnion.model.run import Orientation, ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import arcs
from trunnion.readers.control.affine_map import AffineMap, affine_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.hole_motion import HoleMotion
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.row_recorder import MAX_POSITION, Note, RowRecorder, within_limits
from trunnion.readers.scan.buffers import KIND

#: Kinds of motion in force.
RAPID: Final = 0
LINEAR: Final = 1

INCH: Final = 25.4

#: How far tool and drilling axis may lie apart before it is worth a word, as the length of their difference.
MAX_DRILLING_AXIS_ERROR: Final = 2e-4

#: Makes the circle of a block from its start and end, programmed positions; raises ``arcs.ArcError``.
Circle = Callable[[Floats, Floats], arcs.Arc]


class VirtualControl(RowRecorder, ABC):
    """A control at work on a machine."""

    #: The work offset that is none: positions count from the machine's zero.
    no_offset = -1

    #: Rotary words are positions as they wind, whatever the machine's definition says of its display.
    absolute_turns = False

    def __init__(
        self, machine: Machine, note: Note, file: StepColumnBuilder[int], *, shortest: bool | None = None
    ) -> None:
        super().__init__(machine, note, file)
        self.shortest = shortest
        self.rotary_names = tuple(machine.axes[column].name.upper() for column in machine.rotary)
        self._origin_slides, self._origin_tip = self._zero_positions()
        self.absolute = True
        #: The axis that stands on the working plane.
        self.plane_axis = 2
        #: Millimetres of a programmed length, and of the length in a programmed feed.
        self.length_unit = 1.0
        self.feed_unit = 1.0
        self.tcp = False
        self.tilted = False
        self._plane = AffineMap()
        self._program = AffineMap()
        self._increment_base: dict[int, float] = {}
        self._offsets: set[int] = set()
        self._slide_map_cache: tuple[float, float, Floats] | None = None
        self._arc_map_cache: tuple[arcs.ArcMap, bool] | None = None
        self._update_maps()
        self.commanded[:3] = self._programmed_position()

    def after_scan(self) -> int:
        """Take over what the kernel did."""
        bits = super().after_scan()
        for axis in range(3):
            if bits >> axis & 1:
                self._increment_base.pop(axis, None)
        return bits

    # Rotary words

    @property
    def default_turn_rules(self) -> int:
        """How plain rotary words are reached now, as two nibbles."""
        return self.turn_rule(0, PositionMode.MODAL) | self.turn_rule(1, PositionMode.MODAL) << 4

    def turn_rule(self, which: int, how: PositionMode) -> int:
        """How a word for the first or second rotary axis is reached; see ``trunnion.model.axis_positions``."""
        axis = self.machine.axes[self.machine.rotary[which]]
        if how in (PositionMode.SHORTEST, PositionMode.POSITIVE, PositionMode.NEGATIVE):
            if not axis.endless:
                self.note(f"{how}() for {axis.name}, which has ends", Severity.WARNING)
                return axis_positions.PLAIN
            return {
                PositionMode.SHORTEST: axis_positions.SHORTEST,
                PositionMode.POSITIVE: axis_positions.POSITIVE_DIRECTION,
                PositionMode.NEGATIVE: axis_positions.NEGATIVE_DIRECTION,
            }[how]
        if not axis.endless:
            return axis_positions.PLAIN
        if self.shortest or (self.shortest is None and self.takes_shortest_path(axis)):
            return axis_positions.SHORTEST
        return (
            axis_positions.PLAIN if self.absolute_turns or axis.output is AngleOutput.NONE else axis_positions.SAME_TURN
        )

    @abstractmethod
    def takes_shortest_path(self, axis: Axis) -> bool:
        """Whether plain words for an endless rotary axis take the shorter way now.

        Else they stay inside the turn, or are taken as they are where values are written as they wind.
        """

    # Frames

    @property
    def frame(self) -> AffineMap:
        """From programmed positions to the work offset."""
        return self._plane.compose(self._program)

    def _zero_positions(self) -> tuple[Floats, Floats]:
        """Slide values at the work offset's zero, and the tip where the machine's zero is; rotary axes at zero.

        Both without a tool.
        """
        bare = replace(self.machine, tool_length=None)
        tip_is_given, tip, rotary = np.ones(1, np.bool_), np.zeros((1, 3)), np.zeros((1, 2))
        joints = axis_positions.joints_from_rows(bare, kinematic_parameters(bare), tip_is_given, tip, rotary)[0]
        tip = forward(bare, np.zeros((1, 5)))[0][0]
        return np.nan_to_num(joints[self._slides]), tip

    def _update_maps(self) -> None:
        """Bring the maps of rows up to date."""
        self._arc_map_cache = None
        self.tip_programmed = self.tcp or self.tilted
        frame = self.frame
        none = self.work_offset.current == self.no_offset
        if self.tip_programmed:
            origin = self._origin_tip if none else np.zeros(3)
        else:
            origin = self._length_offset + (0.0 if none else self._origin_slides)
        self.position_map = affine_matrix(frame.linear, frame.shift + origin)
        self.vector_map = self._vector_map(frame)

    @property
    def _length_offset(self) -> Floats:
        """What is added to the slides X Y Z for the length of the tool where positions are theirs, (3,) mm."""
        return np.zeros(3)

    def _vector_map(self, frame: AffineMap) -> Floats:
        """From programmed vectors to the workpiece frame, (3, 3)."""
        return np.ascontiguousarray(frame.linear)

    def _programmed_position(self) -> Floats:
        """Return the programmed position of where the axes stand; the rows must be settled."""
        tip = forward(self.machine, self.current_joints[None])[0][0]
        return self._to_programmed(tip if self.tip_programmed else self.current_joints[self._slides])

    def _to_programmed(self, point: Floats) -> Floats:
        return AffineMap(self.position_map[:, :3], self.position_map[:, 3]).solve(point)

    def frame_change(self, *, keep_base: bool = False) -> "_FrameChange":
        """Bracket a change of transformation, offset or frame: the axes stand still, the position gets new numbers.

        With ``keep_base`` the last programmed numbers stay the base of incremental words, as a control does that is
        set to traverse changed frames; only frames may change then.
        """
        return _FrameChange(self, keep_base)

    def set_program_frame(self, frame: AffineMap, *, keep_base: bool = True) -> None:
        """Put a programmable frame in place of the one in force; ``keep_base`` as in ``change``."""
        total = self._plane.compose(frame)
        x, y, z = total.linear
        if not abs(float(np.cross(x, y) @ z)) >= 1e-9:
            self.note("the frame would flatten space: it is not used", Severity.ERROR)
            return
        if float(np.abs(total.linear).max()) > 1e6 or float(np.abs(total.shift).max()) > MAX_POSITION:
            self.note("the frame is larger than any machine: it is not used", Severity.ERROR)
            return
        with self.frame_change(keep_base=keep_base):
            self._program = frame

    @property
    def program_frame(self) -> AffineMap:
        """The programmable frame in force."""
        return self._program

    def set_plane(self, plane: AffineMap | None, program: AffineMap | None = None) -> None:
        """Tilt the plane, from it to the work offset, or take the tilted one away; the axes stay.

        ``program`` is the programmable frame from now on, none by default.
        """
        with self.frame_change():
            self._plane = plane or AffineMap()
            self._program = program or AffineMap()
            self.tilted = plane is not None

    def set_tcp(self, on: bool) -> None:
        """Switch tool centre point control."""
        if on != self.tcp:
            with self.frame_change():
                self.tcp = on
            self.tcp_rows.set(self.row, on)

    def set_offset(self, code: int, name: str) -> None:
        """Take another work offset; ``name`` is for messages."""
        if code == self.work_offset.current:
            return
        if code != self.no_offset:
            self._offsets.add(code)
            if len(self._offsets) > 1:
                self.note(f"{name}: work offsets are not known here, all count as the same one", Severity.WARNING)
        if self.no_offset in (code, self.work_offset.current):
            with self.frame_change():
                self.work_offset.set(self.row, code)
        else:
            self.work_offset.set(self.row, code)

    def set_orientation(self, orientation: Orientation) -> None:
        """How the tool axis moves between rows from now on."""
        self.orientation.set(self.row, int(orientation))

    def set_units(self, inches: bool, feeds_too: bool) -> None:
        """Inches or millimetres; positions are kept in mm, so only new words are scaled."""
        self.length_unit = INCH if inches else 1.0
        self.feed_unit = INCH if inches and feeds_too else 1.0
        self.inch_rows.set(self.row, inches)

    @property
    def kind(self) -> int:
        """The kind of motion in force."""
        return int(self.counters[KIND])

    @kind.setter
    def kind(self, kind: int) -> None:
        self.counters[KIND] = kind

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
        """Execute the motion of a block.

        axes     X, Y, Z and rotary axes by name, in the units of the program
        vector   (3,) tool axis, programmed
        circle   of a block that is one
        """
        bits = int(ProgrammedWord.FEED) if feed_written else 0
        if machine_frame:
            self._machine_move(axes, bits, circle is not None)
            return
        start = self.commanded[:3].copy()
        end = start.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                value *= self.length_unit
                end[axis] = self._increment_base.get(axis, start[axis]) + value if self._is_incremental(how) else value
                self._increment_base.pop(axis, None)
                bits |= 1 << axis
        arc = None
        if circle is not None and within_limits(end):
            try:
                arc = circle(start, end)
                end = arc.end
            except arcs.ArcError as error:
                self.note(f"{error}: taken as a straight line", Severity.ERROR)
        rotary, turn_rule, turned = self.rotary_words(axes)
        if vector is not None and turned:
            self.note("rotary words and a vector in one block: the vector counts", Severity.ERROR)
            rotary, turned = [math.nan, math.nan], 0
        if vector is not None:
            turned = int(ProgrammedWord.VECTOR)
        placed = None if arc is None else self._arc_in_workpiece(arc, bool(turned) and not self.tip_programmed)
        kind = Kind.RAPID if self.kind == RAPID else Kind.LINEAR
        row = self.row
        made = self.add_row(kind if placed is None else Kind.ARC, end, bits | turned, rotary, turn_rule, vector)
        if arc is not None and placed is not None and made:
            self.add_arc(row, *placed, arc.turns)

    def _is_incremental(self, how: PositionMode) -> bool:
        return how is PositionMode.INCREMENTAL or (how is PositionMode.MODAL and not self.absolute)

    def rotary_words(self, axes: Mapping[str, AxisWord]) -> tuple[list[float], int, int]:
        """Return values (NaN without a word), way and bits of the rotary words of a block."""
        rotary = [math.nan, math.nan]
        turn_rule = bits = 0
        for which, name in enumerate(self.rotary_names):
            if name not in axes:
                continue
            value, how = axes[name]
            code = self.turn_rule(which, how)
            if self._is_incremental(how):
                self.resolve_rows()
                value += float(self.current_joints[self.machine.rotary[which]])
                code = axis_positions.PLAIN
            rotary[which] = value
            turn_rule |= code << (4 * which)
            bits |= int(ProgrammedWord.FIRST) << which
        return rotary, turn_rule, bits

    def _machine_move(self, axes: Mapping[str, AxisWord], bits: int, circle: bool) -> None:
        """Positions of the axes themselves, whatever frames and TCP say."""
        if self.tcp:
            self.note("machine positions while TCP is on are taken as positions of the slides", Severity.WARNING)
        if circle:
            self.note("a circle in machine positions is taken as a straight line", Severity.ERROR)
        self.resolve_rows()
        slides = self.current_joints[self._slides].copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                slides[axis] = value * self.length_unit + (slides[axis] if self._is_incremental(how) else 0.0)
                bits |= 1 << axis
        was, self.tcp = self.tcp, False
        rotary, turn_rule, turned = self.rotary_words(axes)
        self.tcp = was
        self.machine_rows.set(self.row, True)
        self.move_axes(Kind.RAPID if self.kind == RAPID else Kind.LINEAR, slides, rotary, turn_rule, bits | turned)
        self.machine_rows.set(self.row, False)

    def move_axes(self, kind: Kind, slides: Floats, rotary: list[float], turn_rule: int, bits: int) -> None:
        """Make a row of slide values (X, Y, Z) and rotary values, whatever X Y Z mean now; settles."""
        self.resolve_rows()
        tips, kept = self.tip_programmed, self.position_map
        self.tip_programmed, self.position_map = False, affine_matrix(np.eye(3), np.zeros(3))
        self.add_row(kind, slides, bits, rotary, turn_rule, None)
        self.resolve_rows()
        self.tip_programmed, self.position_map = tips, kept
        self._increment_base.clear()
        self.commanded[:3] = self._programmed_position()

    # Circles

    def _arc_in_workpiece(self, arc: arcs.Arc, turned: bool) -> tuple[Floats, Floats, float] | None:
        """Return centre, normal and radius in the workpiece frame; None, with a finding, if it is no circle there."""
        if turned:
            self.note(
                "rotary axes turn during a circle of the slides: the tip does not make a circle", Severity.WARNING
            )
        rigid = None if self.tip_programmed else self._slides_to_tip()
        if self._arc_map_cache is None:
            linear, shift = self.position_map[:, :3], self.position_map[:, 3]
            if rigid is not None:
                linear, shift = rigid[:, :3] @ linear, rigid[:, :3] @ shift + rigid[:, 3]
            self._arc_map_cache = arcs.ArcMap.of(linear, shift), self.frame.keeps_circles
        image, even = self._arc_map_cache
        if not even:
            self.note("a circle under unequal scales is an ellipse: taken as a straight line", Severity.ERROR)
            return None
        return image.map_arc(arc)

    def _slides_to_tip(self) -> Floats:
        """(3, 4) from slide values to the tip, with the rotary axes where they are."""
        if self._rotary_unresolved:
            self.resolve_rows()
        first, second = (float(self.current_joints[column]) for column in self.machine.rotary)
        if self._slide_map_cache is None or self._slide_map_cache[:2] != (first, second):
            joints = np.zeros((4, 5))
            joints[:, list(self.machine.rotary)] = first, second
            for axis, column in enumerate(self._slides):
                joints[axis + 1, column] = 1.0
            tip = forward(self.machine, joints)[0]
            self._slide_map_cache = first, second, affine_matrix((tip[1:] - tip[0]).T, tip[0])
            self._arc_map_cache = None
        return self._slide_map_cache[2]

    # Cycles

    def drill(self, steps: list[HoleMotion]) -> None:
        """Make the motions of a drilling cycle where the tool is."""
        hole = self.commanded[:3].copy()
        kind, feed, first_row = self.kind, float(self.commanded[3]), self.row
        first, second = (self.plane_axis + 1) % 3, (self.plane_axis + 2) % 3
        still = [math.nan, math.nan]
        for step in steps:
            end = hole.copy()
            end[self.plane_axis] = (
                self.commanded[self.plane_axis] if step.height is None else step.height * self.length_unit
            )
            end[first] += step.lateral[0] * self.length_unit
            end[second] += step.lateral[1] * self.length_unit
            if step.feed is not None:
                # A negative feed is a part of the one in force.
                self.commanded[3] = -step.feed * feed if step.feed < 0.0 else step.feed
            if step.turns:
                self._add_helix(hole, end, step.turns)
            else:
                self.add_row(Kind.RAPID if step.rapid else Kind.LINEAR, end, 0, still, 0, None)
            self.commanded[3] = feed
            if step.dwell:
                self.add_event("dwell", step.dwell)
        self.kind = kind
        self._check_drilling_axis(self.row - first_row)

    def _add_helix(self, hole: Floats, end: Floats, turns: int) -> None:
        """Whole turns about a hole, from where the tool is to a point above or below; positive counter-clockwise."""
        arc = arcs.by_centre(self.commanded[:3].copy(), end, hole, self.plane_axis, turns < 0, abs(turns) - 1)
        placed, row = self._arc_in_workpiece(arc, turned=False), self.row
        still = [math.nan, math.nan]
        if self.add_row(Kind.LINEAR if placed is None else Kind.ARC, end, 0, still, 0, None) and placed is not None:
            self.add_arc(row, *placed, arc.turns)

    def _check_drilling_axis(self, rows: int) -> None:
        """Say so if the tool does not stand along the drilling axis."""
        self.resolve_rows()
        along = self.position_map[:, self.plane_axis]
        along = along / np.linalg.norm(along)
        if not self.tip_programmed:
            return
        axis = forward(self.machine, self.current_joints[None])[1][0]
        if rows and float(np.linalg.norm(axis - along)) > MAX_DRILLING_AXIS_ERROR:
            self.note("the cycle drills along the axis of the frame, which is not the tool axis", Severity.WARNING)


class _FrameChange:
    """A change of what programmed positions mean, while the axes stand still."""

    def __init__(self, control: VirtualControl, keep_base: bool) -> None:
        self._control = control
        self._increment_base = keep_base

    def __enter__(self) -> None:
        c = self._control
        self._programmed = c.commanded[:3].copy()
        self._kept = dict(c._increment_base)
        if self._increment_base:
            # Only the frame changes: the point is known without asking the axes.
            self._point = c.position_map[:, :3] @ self._programmed + c.position_map[:, 3]
        else:
            c.resolve_rows()

    def __exit__(self, *_: object) -> None:
        c = self._control
        c._update_maps()
        if not self._increment_base:
            c._increment_base.clear()
            c.commanded[:3] = c._programmed_position()
            return
        c.commanded[:3] = c._to_programmed(self._point)
        c._increment_base = {axis: self._kept.get(axis, float(self._programmed[axis])) for axis in range(3)}
