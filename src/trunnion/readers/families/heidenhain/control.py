"""The virtual control of a TNC."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.compensation.styles import CIRCLES
from trunnion.errors import Severity
from trunnion.machines import Axis, Machine, Mount
from trunnion.messages import Wording
from trunnion.model.feed_path import FeedPath
from trunnion.model.mode_words import FOLLOWING, TOOL_AXIS
from trunnion.model.run import ProgrammedWord
from trunnion.readers.control.affine_map import AffineMap
from trunnion.readers.control.arcs import Arc
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import Circle
from trunnion.readers.families.heidenhain.leads import LeadControl
from trunnion.readers.families.heidenhain.plane_frames import spatial
from trunnion.readers.families.heidenhain.scan_kernel import letter_table
from trunnion.readers.families.heidenhain.settings import START_MODES, has_m114

#: What ends TCP, by what switches it on.
_TCP_ENDS: Final = {"M128": "M129", "FUNCTION TCPM": "FUNCTION RESET TCPM"}


class HeidenhainControl(LeadControl):
    """A TNC on a machine.

    has_m114               it has M114, which places the tip at the ends of blocks
    shortest_path          M126: endless rotary axes take the shorter way
    spatial_angles_active  TCPM with AXIS SPAT: rotary words are spatial angles
    angles                 the last spatial angles, degrees
    pole                   pole of circles and polar coordinates, programmed position, (3,) mm
    """

    compensation_style = CIRCLES
    compensation_off = "R0"
    drills_within_compensation = "refused"
    start_modes = START_MODES
    doubtful_modes = frozenset({"M89", "M116", "M118", "M120", "feed"})
    reset_by = "whether the end of a program cancels it depends on the software of the control"

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        self.shortest_path = False
        # Lines that end an operation with M126 on, with what they do; and whether the program ever writes M127.
        self._shortest_path_left_on: list[tuple[int, Wording]] = []
        self._cancels_shortest_path = False
        self.spatial_angles_active = False
        self.angles = [0.0, 0.0, 0.0]
        self.pole: Floats | None = None
        self.has_m114 = has_m114(machine)
        # What F counts without M114, where the control counts the path of the tip.
        self._feed_path = FeedPath.AXES
        # A tool has been called: its length counts where positions are those of the slides.
        self._length_active = False
        # Length L and radius R of TOOL DEF, mm, by the name of the tool.
        self._tool_sizes: dict[str, dict[str, float]] = {}
        # The row before which the last tool was fetched.
        self._fetched_from = -1
        # The word that has switched TCP on: M128 or FUNCTION TCPM; empty: another one, or none.
        self._tcp_word = ""
        # The preset that cycle 247 has activated before the first motion at the part; None: none.
        self._head_preset: int | None = None
        super().__init__(machine, note, shortest=shortest)
        self.modal.feed_path.set(0, int(FeedPath.AXES))
        self._letter_tables = letter_table(self.rotary_names), letter_table(("", ""))

    @property
    def letter_table(self) -> Codes:
        """The letter table for the present modes: rotary words are plain only if they are positions of one axis."""
        return self._letter_tables[self.spatial_angles_active or (self.tilted and not self.tcp)]

    def switch_tcp_by(self, word: str, *, on: bool) -> None:
        """Note which of ``M128`` and ``FUNCTION TCPM`` switches TCP on, and that it ends by a word of the other one."""
        if not on and self.tcp and self._tcp_word not in ("", word):
            self.note(Wording("NC341", "ended_by_other", on=self._tcp_word, off=_TCP_ENDS[word]), Severity.ERROR)
        self._tcp_word = word if on else ""

    def set_tcp(self, on: bool) -> None:
        """M128, M129 and the like."""
        if on and self.at_ends:
            self.note(Wording("NC340", "m114_with", word="M128"), Severity.ERROR)
        super().set_tcp(on)
        self.judge_compensation()
        self._judge_feed_path()

    def set_at_ends(self, on: bool) -> None:
        """M114, with which F is the feed of the tip, and M115."""
        if on and (self.tcp or self.tilted):
            self.note(Wording("NC340", "m114_in_plane" if self.tilted else "m114_with_tcp"), Severity.ERROR)
        self.say_mode("TCP")
        if on != self.at_ends:
            with self.frame_change():
                self.at_ends = on
            self.modal.at_ends.set(self.row, on)
        self.judge_compensation()
        self._set_feed_path()

    def set_plane(self, plane: AffineMap | None, program: AffineMap | None = None) -> None:
        """Tilt the working plane, or end the tilt; with M114 on nobody knows what a tilt does."""
        if plane is not None:
            self._refuse_at_ends("a tilted plane")
        super().set_plane(plane, program)

    def _refuse_at_ends(self, word: str) -> None:
        """Note what stands while M114 is on, of which no manual says what the control does then."""
        if self.at_ends:
            self.note(Wording("NC340", "m114_with", word=word), Severity.ERROR)

    def _arc_in_workpiece(self, arc: Arc, axes_turn: bool) -> tuple[Floats, Floats, float] | None:
        self._refuse_at_ends("a circle")
        return super()._arc_in_workpiece(arc, axes_turn)

    def limit_compensating_feed(self, feed: float | None) -> None:
        """M128 F: how fast the linear axes may follow the rotary ones, as written; None: as the machine sets it."""
        self.say_mode(FOLLOWING, "" if feed is None else f"F{feed * self.feed_unit:.6g}")

    def say_tool_axis(self) -> None:
        """Record whether rotary words under TCP are positions of axes or angles in space."""
        self.say_mode(TOOL_AXIS, "AXIS SPAT" if self.spatial_angles_active else "AXIS POS")

    def _judge_feed_path(self) -> None:
        """Note M116 with TCP: the manuals say that they exclude each other."""
        if self.tcp and self._feed_path == FeedPath.TIP:
            self.note(Wording("NC340", "m116_m128_exclude_each_other"), Severity.ERROR)

    def judge_compensation(self) -> None:
        """Note radius compensation with M128, which takes the delta values (DR) and not the radius (TNC 640 manual)."""
        if self.tcp and self.modal.compensation.current:
            self.note(Wording("NC340", "compensation_with_m128"), Severity.ERROR)
        if self.at_ends and self.modal.compensation.current:
            self.note(Wording("NC340", "compensation_with_m114"), Severity.ERROR)

    def note_preset(self, number: int) -> None:
        """Remember the preset of a cycle 247; going back to that of the head leaves nothing to the next program."""
        if not self._in_use.at_part:
            self._head_preset = number
        if number == self._head_preset:
            self.forget_stored_offsets()
        elif number != self.modal.work_offset.current:
            self.note_stored_offset(f"cycle 247 with preset {number}", 0, clears=False)

    def takes_shortest_path(self, axis: Axis) -> bool:
        """With M126."""
        return self.shortest_path

    def set_shortest_path(self, on: bool) -> None:
        """M126, M127."""
        self._cancels_shortest_path |= self.shortest_path and not on
        self.shortest_path = on

    def end_operation(self, variant: str) -> None:
        """Remember M126 that is still on where an operation is over."""
        if self.shortest_path:
            self._shortest_path_left_on.append((self.line, Wording("NC363", variant)))

    def end_program(self, word: str) -> None:
        """End the program by a word, and note every M126 that was left on.

        The manuals say that the end of a program cancels it, so that programs without any M127 are sound; one
        that cancels it elsewhere has lost a block. What cycles 7, 8, 10, 11 and 26 have set ends with it on some
        controls only, and so does a tilted plane.
        """
        self.report_unused_offsets()
        self.report_trailing_modes()
        if left := self.left_on():
            self.report_left(left, may_begin=True, in_use=not (self.in_unused_plane or self.unused_shift))
        if self._cancels_shortest_path:
            self.end_operation("ends_with_m126")
            end = self.line
            for line, left_on in self._shortest_path_left_on:
                self.line = line
                self.note(left_on, Severity.ERROR)
            self.line = end
        self.add_event("end", word)

    def feed_at_tip(self, on: bool) -> None:
        """M116: F is that of the tip where rotary tables turn; M117: a degree counts as a millimetre."""
        heads = [axis.name for axis in self.machine.own_axes if axis.is_rotary and axis.mount is Mount.TOOL]
        if on and heads:
            self.note(Wording("NC241", "feed_of_head_unknown", axes=tuple(heads)), Severity.WARNING)
        self._feed_path = FeedPath.TIP if on else FeedPath.AXES
        self._set_feed_path()
        self._judge_feed_path()

    def _set_feed_path(self) -> None:
        self.modal.feed_path.set(self.row, int(FeedPath.ENDS if self.at_ends else self._feed_path))

    # Tools

    @property
    def _length_axis(self) -> int:
        return self.plane_axis if self._length_active else -1

    def call_tool(self, name: str | None, tool_axis: int | None) -> None:
        """TOOL CALL: another tool, or None; and another tool axis, which is normal to the working plane, or None."""
        self._refuse_at_ends("TOOL CALL")
        if self.tcp and name is None:
            self.note(Wording("NC340", "tool_call_m128_switch_off"), Severity.ERROR)
        if name is not None:
            self.select_tool(name)
        active = self._length_active if name is None else name.strip("0") != ""
        along = self.plane_axis if tool_axis is None else tool_axis
        if self.machine.tool_length and (active, along) != (self._length_active, self.plane_axis):
            with self.frame_change():
                self._length_active, self.plane_axis = active, along
        else:
            self._length_active, self.plane_axis = active, along
        self.record_length()
        if name is not None:
            self.judge_within_compensation("TOOL CALL")
            self.end_operation("changes_tool_with_m126")
            self.change_tool()
            self._fetched_from = self.row
            self._report_sizes(name)

    def define_tool(self, name: str, sizes: Mapping[str, float]) -> None:
        """TOOL DEF: length L and radius R of a tool, mm, which count when it is called, or at once in the spindle."""
        self._tool_sizes[name] = dict(sizes)
        if name == self.tool_in_spindle:
            self._report_sizes(name)

    def _report_sizes(self, name: str) -> None:
        """Record the length and radius that the program gives the tool in the spindle: the path does not show them."""
        for letter, value in self._tool_sizes.get(name, {}).items():
            if value:
                self.add_event("delta", (f"TOOL DEF {letter}", value))
                self.note(Wording("NC360", "tool_def_size", tool=name, letter=letter, value=value), Severity.WARNING)

    def fetch_tool(self) -> None:
        """M6: change to the tool that TOOL CALL has called, unless the tool has not moved since then."""
        if self._fetched_from != self.row:
            self.end_operation("changes_tool_with_m126")
            self.change_tool()

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

        In a tilted plane without TCP a rotary axis turns alone, and the programmed positions turn with it.
        """
        if self.spatial_angles_active and vector is None and not machine_frame and axes.keys() & {"A", "B", "C"}:
            vector = self._vector_of_angles(axes)
            axes = {name: word for name, word in axes.items() if name not in ("A", "B", "C")}
        if machine_frame:
            self._refuse_at_ends("a position of the machine (M91, M92)")
        turns_in_plane = self.tilted and not self.tcp and bool(axes.keys() & set(self.rotary_names))
        if machine_frame or vector is not None or not turns_in_plane:
            super().move(axes, vector, circle=circle, machine_frame=machine_frame, feed_written=feed_written)
            return
        if circle is not None:
            self.note(Wording("NC321", "circle_of_plane_turns"), Severity.ERROR)
        self._turn_in_plane(axes, int(ProgrammedWord.FEED) if feed_written else 0)

    def _vector_of_angles(self, axes: Mapping[str, AxisWord]) -> Floats:
        for axis, name in enumerate("ABC"):
            if name in axes:
                value, mode = axes[name]
                self.angles[axis] = self.angles[axis] + value if self._is_incremental(mode) else value
        return np.asarray(spatial(*self.angles)[:, 2])

    def _turn_in_plane(self, axes: Mapping[str, AxisWord], bits: int) -> None:
        self.resolve_rows()
        goal = self.programmed_position.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, mode = axes[name]
                goal[axis] = value * self.length_unit + (goal[axis] if self._is_incremental(mode) else 0.0)
                bits |= 1 << axis
        rotary = self.rotary_target(axes)
        slides: Floats | None = self.current_joints[self._slides].copy()
        if bits & int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z):
            self.preconditions.report_motion()
            joints = self._joints_after(rotary)
            reachable = not np.abs(goal).max() > MAX_POSITION
            slides = self._slides_for(self._mapped(goal), joints) if reachable else None
        if slides is None:
            self.note(Wording("NC310", "slides_cannot_reach"), Severity.ERROR)
            return
        self.move_axes(self._line_kind, slides, rotary, bits)
