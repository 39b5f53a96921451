"""What programmed positions mean: units, work offsets, TCP, tilted planes and programmable frames.

X, Y and Z have two meanings. With TCP or M114, or in a tilted plane, they are the tool tip in the active frame.
Otherwise they are the positions of the slides, counted from the work offset: with the rotary axes at zero the tip is at
the programmed position, with the axes turned the kinematics of the machine determine where it is.
"""

from collections.abc import Hashable
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, forward
from trunnion.machines.inverse import kinematic_parameters
from trunnion.messages import Wording
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.run import Orientation
from trunnion.model.run_columns import BY_PARAMETER
from trunnion.readers.control.affine_map import AffineMap, affine_matrix
from trunnion.readers.control.arcs import ArcMap
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.row_recorder import MAX_POSITION, RowRecorder
from trunnion.readers.control.rows_in_use import RowsInUse
from trunnion.readers.control.trailing_modes import USUAL_MODES, TrailingModes, WordPlace

#: Millimetres of an inch.
INCH: Final = 25.4

#: What of the next program a stored work offset changes, for messages.
OFFSET: Final = "the work offset of"

#: Modes without whose words a program goes elsewhere when the one before it has left them otherwise.
_NEEDED: Final = frozenset({"plane", "distances", "feed", "compensation", "length", "centres"})


class CoordinateControl(RowRecorder):
    """Knows the coordinate systems in force, and keeps the maps of the rows up to date.

    absolute     G90; else incremental
    length_unit  millimetres of a programmed length
    feed_unit    millimetres of the length in a programmed feed
    tcp          tool centre point control is on
    at_ends      M114: the tip is placed at the ends of blocks
    tilted       the working plane is tilted
    """

    #: The code of suppressed work offsets, when positions count from the machine zero; -1: the control has none.
    no_offset = -1

    #: Names of modes of ``set_mode`` that outlive the end of a program on this control, and of those that may.
    kept_modes: frozenset[str] = frozenset()
    doubtful_modes: frozenset[str] = frozenset()

    #: What decides whether the latter do, for messages.
    reset_by = ""

    #: Work offsets have zeros of their own: those without one are not known.
    knows_zeros = False

    def __init__(self, machine: Machine, note: Note) -> None:
        super().__init__(machine, note)
        self._zero_slides, self._zero_tip = self._zero_positions()
        self.absolute = True
        self.usual_modes = dict(USUAL_MODES)
        self.length_unit = self.feed_unit = 1.0
        self.tcp = self.at_ends = self.tilted = False
        self._tilted_from = self._shifted_from = -1
        self._rows_in_use = RowsInUse()
        # Work offsets that were written since the last motion at the part: row, line, file and word; the first row of
        # each.
        self._stored_offsets: list[tuple[int, int, int, str, str]] = []
        self._stored_systems: dict[int, int] = {}
        # Work offsets that other programs find as this one has written them: line, file and word.
        self._changed_offsets: dict[int, tuple[int, int, str]] = {}
        self._trailing = TrailingModes(self._used_until)
        self._plane = AffineMap()
        self._program = AffineMap()
        # Programmed values of axes that incremental words still count from after a frame change, by axis.
        self._increment_base: dict[int, float] = {}
        self._offsets: set[int] = set()
        self._arc_map: tuple[ArcMap, bool] | None = None
        self._update_maps()
        self.programmed_position = self._position_of_axes()

    def _zero_positions(self) -> tuple[Floats, Floats]:
        """Return the slide positions at the zero of the work offset, and the tip with the machine at its zero.

        Both are (3,) mm, with the rotary axes at zero and without a tool.
        """
        without_tool = replace(self.machine, tool_length=None)
        at_zero = np.ones(1, np.bool_), np.zeros((1, 3)), np.zeros((1, 2))
        joints = joints_from_rows(without_tool, kinematic_parameters(without_tool), *at_zero)[0]
        tip = forward(without_tool, np.zeros((1, 5)))[0][0]
        return np.nan_to_num(joints[self._slides]), tip

    # Maps

    @property
    def frame(self) -> AffineMap:
        """The map from programmed positions to the work offset."""
        return self._plane.compose(self._program)

    @property
    def _length_axis(self) -> int:
        """Index of the linear axis along which the tool length counts where positions are those of the linear axes.

        -1: none.
        """
        return -1

    @property
    def _length_offset(self) -> Floats:
        """What the tool length adds to positions of the linear axes X, Y, Z, (3,) mm."""
        length = np.zeros(3)
        if self._length_axis >= 0:
            length[self._length_axis] = self.machine.tool_length or 0.0
        return length

    def record_length(self, by_parameter: int = -1) -> None:
        """Record along which linear axis the tool length counts; ``by_parameter``: or along this one."""
        axis = by_parameter + BY_PARAMETER if by_parameter >= 0 else self._length_axis
        self.modal.length_axis.set(self.row, axis)

    def _vector_map(self, frame: AffineMap) -> Floats:
        """Return the map from programmed vectors to the workpiece frame, (3, 3)."""
        return np.ascontiguousarray(frame.linear)

    def _update_maps(self) -> None:
        self._arc_map = None
        self.tip_programmed = self.tcp or self.at_ends or self.tilted
        frame = self.frame
        suppressed = self.modal.work_offset.current == self.no_offset
        if self.tip_programmed:
            origin = self._zero_tip if suppressed else np.zeros(3)
        else:
            origin = self._length_offset + (0.0 if suppressed else self._zero_slides)
        self.position_map = affine_matrix(frame.linear, frame.shift + origin)
        in_plane = self.tip_programmed and not np.array_equal(frame.linear, np.eye(3))
        self.record_plane(self.position_map if in_plane else None)
        self.vector_map = self._vector_map(frame)

    def _position_of_axes(self) -> Floats:
        """Return the programmed position at which the axes stand, (3,) mm; all rows must be resolved."""
        tip = forward(self.machine, self.current_joints[None])[0][0]
        return self._to_programmed(tip if self.tip_programmed else self.current_joints[self._slides])

    def _to_programmed(self, point: Floats) -> Floats:
        return AffineMap(self.position_map[:, :3], self.position_map[:, 3]).solve(point)

    def frame_change(self, *, keep_base: bool = False) -> "_FrameChange":
        """Return a context in which TCP, offset or frames change: the axes stay, their position gets new coordinates.

        With ``keep_base`` incremental words still count from the values programmed before, as on a control that is
        set to traverse changed frames; then only frames may change.
        """
        return _FrameChange(self, keep_base)

    def end_contour(self) -> None:
        """Do what is due where the contour is interrupted."""

    # Frames and planes

    @property
    def program_frame(self) -> AffineMap:
        """The programmable frame in force."""
        return self._program

    def set_program_frame(self, frame: AffineMap, *, keep_base: bool = True) -> None:
        """Replace the programmable frame; ``keep_base`` as in ``frame_change``."""
        total = self._plane.compose(frame)
        x, y, z = total.linear
        if not abs(float(np.cross(x, y) @ z)) >= 1e-9:
            self.note(Wording("NC330", "frame_would_flatten_space_not"), Severity.ERROR)
            return
        if float(np.abs(total.linear).max()) > 1e6 or float(np.abs(total.shift).max()) > MAX_POSITION:
            self.note(Wording("NC330", "frame_larger_than_any_machine"), Severity.ERROR)
            return
        with self.frame_change(keep_base=keep_base):
            self._program = frame

    def set_plane(self, plane: AffineMap | None, program: AffineMap | None = None) -> None:
        """Tilt the working plane, or end the tilt; the axes stay.

        plane    from the plane to the work offset, None for no tilted plane
        program  the programmable frame from now on, none by default
        """
        self.say_mode("tilted plane")
        with self.frame_change():
            self._plane = plane or AffineMap()
            self._program = program or AffineMap()
            self.tilted = plane is not None
        self._tilted_from = self.row

    @property
    def in_unused_plane(self) -> bool:
        """Whether the working plane is tilted and nothing has moved in it since."""
        return self.tilted and self._tilted_from >= self._in_use.at_part

    def note_shift(self) -> None:
        """Remember where a shift, a rotation, a mirror image or a scale was set."""
        self._shifted_from = self.row

    @property
    def unused_shift(self) -> bool:
        """Whether nothing has moved with it since a shift was set: what it does is left to the next program.

        Others may be left on: many sound programs begin with one and never cancel it.
        """
        return self._shifted_from >= self._in_use.at_part

    def note_stored_offset(self, word: str, system: int, *, clears: bool, what: str = OFFSET) -> None:
        """Remember where the program wrote a work offset, or a position, that the control keeps beyond its end.

        word    of the block, for messages
        system  which offset it wrote; a number of its own for anything else
        clears  whether it is zero now: that only tidies up an offset which the program wrote before it moved
        """
        first, used = self._stored_systems.setdefault(system, self.row), self._in_use.at_part
        if clears:
            self._changed_offsets.pop(system, None)
        elif system:
            self._changed_offsets[system] = self.line, self.modal.file.current, word
        if self._stored_offsets and self._stored_offsets[0][0] < used:
            self._stored_offsets.clear()
        if used and not (clears and first < used):
            self._stored_offsets.append((self.row, self.line, self.modal.file.current, word, what))

    def forget_stored_offsets(self) -> None:
        """Forget what ``note_stored_offset`` has remembered: the control is again as the program began."""
        self._stored_offsets.clear()

    def is_at_unknown_place(self, axis: int) -> bool:
        """Whether it is not known where an axis stands in the workpiece: it went to a position of the machine.

        Before the first motion it stands where an earlier program has left it.
        """
        if self.machine.workpiece_zero is not None:
            return False
        rows = np.flatnonzero(self.columns.programmed[: self.row] & (1 << axis))
        return not len(rows) or bool(self.modal.machine_frame.part(int(rows[-1]), int(rows[-1]) + 1)[0])

    def report_unused_offsets(self) -> None:
        """Report each stored work offset behind the last motion at the part: only the next program moves with it.

        A program without such motions sets up the machine, and may write them.
        """
        here = self.line
        for row, line, file, word, what in self._stored_offsets:
            # Other positions, such as another home, are for moves to machine positions.
            if row >= (self._in_use.at_part if what == OFFSET else self.row):
                self.line = line if file == self.modal.file.current else here
                variant = "offset_behind_motion" if what == OFFSET else "position_behind_motion"
                self._note_left(Wording("NC351", variant, word=word, changes=what))
                self._changed_offsets = {
                    each: place for each, place in self._changed_offsets.items() if place != (line, file, word)
                }
        for line, file, word in self._changed_offsets.values() if self._in_use.cuts else ():
            self.line = line if file == self.modal.file.current else here
            self.note(Wording("NC351", "offset_stays", word=word), Severity.WARNING)
        self.line = here

    # What the next program begins with

    def set_mode(self, name: str, word: str, before: Hashable, after: Hashable) -> None:
        """Remember a word that sets a mode, for ``report_trailing_modes``; ``name`` is that of the mode."""
        if name in _NEEDED:
            self.say_mode(name)
        self._trailing.set(name, word, WordPlace(self.row, self.line, self.modal.file.current), before, after)

    def usual(self, name: str) -> Hashable:
        """Return the value of a mode with which any program may end; that of the units is up to the control."""
        return self.usual_modes.get(name, False)

    def report_trailing_modes(self) -> None:
        """Report the modes that the program sets behind the last motion with a use for them, if they outlive its end.

        A program without motions at the part sets up the machine, and may set them.
        """
        here = self.line
        for mode in self._trailing.changed():
            stays = mode.name in self.kept_modes
            if (
                not self._in_use.at_part
                or mode.after == self.usual(mode.name)
                or not (stays or mode.name in self.doubtful_modes)
            ):
                continue
            self.line = mode.place.line if mode.place.file == self.modal.file.current else here
            wording = (
                Wording("NC351", "mode_stays", word=mode.word)
                if stays
                else Wording("NC351", "mode_may_stay", word=mode.word, reset_by=self.reset_by)
            )
            self._note_left(wording, stays=stays)
        self.line = here

    def sets_behind_use(self, name: str) -> bool:
        """Whether the program sets a mode behind the last motion with a use for it, as is reported then."""
        return any(mode.name == name for mode in self._trailing.changed())

    def report_left(self, left: Wording, *, may_begin: bool = False, in_use: bool = False) -> None:
        """Report a plane, a rotation or a shift that is left to the next program; one in use is warned of."""
        self._note_left(Wording("NC351", "may_be_left" if may_begin else "left", left=left), stays=not in_use)

    def _note_left(self, wording: Wording, *, stays: bool = True) -> None:
        """Note what is left to the next program; one that never cuts may leave it on purpose, as a set-up does."""
        self.note(wording, Severity.ERROR if stays and self._in_use.cuts else Severity.WARNING)

    @property
    def _in_use(self) -> RowsInUse:
        self._rows_in_use.update(self.columns, self.modal)
        return self._rows_in_use

    def _used_until(self, mode: str) -> int:
        """Return the row behind the last one that uses a mode, 0 if none has: G91 has its use in ``G91 G28 Z0``."""
        if mode == "distances":
            return self.row
        return self._in_use.at_feed if mode in ("feed", "M116") else self._in_use.at_part

    def cuts_behind(self, row: int) -> bool:
        """Whether the program cuts, and moves at the part from a row on."""
        return self._in_use.cuts and row < self._in_use.at_part

    def report_left_on(self, word: str) -> None:
        """Report a word that is still in force at the end of the program, which the next program may begin with."""
        self.note(Wording("NC351", "left_on", word=word, reset_by=self.reset_by), Severity.WARNING)

    # Modes

    def set_tcp(self, on: bool) -> None:
        """Switch tool centre point control."""
        self.say_mode("TCP")
        if on != self.tcp:
            with self.frame_change():
                self.tcp = on
            self.modal.tcp.set(self.row, on)

    def set_offset(self, code: int, name: str) -> None:
        """Select a work offset; ``name`` is for messages."""
        offset = self.modal.work_offset
        if code == offset.current:
            return
        if code != self.no_offset:
            self._offsets.add(code)
            if len(self._offsets) > 1 and not self.knows_zeros:
                self.note(Wording("NC331", "work_offsets_not_known_here", name=name), Severity.WARNING)
        if self.no_offset in (code, offset.current):
            with self.frame_change():
                offset.set(self.row, code)
        else:
            offset.set(self.row, code)

    def set_orientation(self, orientation: Orientation) -> None:
        """Set how the tool axis moves within blocks."""
        self.modal.orientation.set(self.row, int(orientation))

    def set_units(self, inches: bool, feeds_too: bool) -> None:
        """Set inches or millimetres; positions are kept in mm, so only new words are scaled."""
        self.length_unit = INCH if inches else 1.0
        self.feed_unit = INCH if inches and feeds_too else 1.0
        self.modal.inches.set(self.row, inches)
        self.said_from.setdefault("units", self.row)
        if self.units_from is None:
            self.units_from = self.row


class _FrameChange:
    """The axes stay while the meaning of programmed positions changes."""

    def __init__(self, control: CoordinateControl, keep_base: bool) -> None:
        self._control = control
        self._keep_base = keep_base

    def __enter__(self) -> None:
        control = self._control
        control.end_contour()
        control.resolutions += 1
        self._programmed = control.programmed_position.copy()
        self._base = dict(control._increment_base)
        if self._keep_base:
            # Only the frame changes: the point does not depend on the axes.
            self._point = control._mapped(self._programmed)
        else:
            control.resolve_rows()

    def __exit__(self, *_: object) -> None:
        control = self._control
        control._update_maps()
        if not self._keep_base:
            control._increment_base.clear()
            control.programmed_position = control._position_of_axes()
            return
        control.programmed_position = control._to_programmed(self._point)
        control._increment_base = {axis: self._base.get(axis, float(self._programmed[axis])) for axis in range(3)}
