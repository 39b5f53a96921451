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
from trunnion.machines import Axis, Machine, Output, forward
from trunnion.machines.inverse import pack, solve_slides
from trunnion.model import axis_positions as poses
from trunnion.model.columns import Changes, affine
from trunnion.model.run import Orientation, Written
from trunnion.model.toolpath import Kind
from trunnion.readers.common import arcs
from trunnion.readers.common.drilling import Step
from trunnion.readers.common.frames import Frame
from trunnion.readers.common.rows import FARTHEST, Note, Rows, reachable
from trunnion.readers.common.scan_buffers import KIND
from trunnion.readers.common.word import How, Word

#: Kinds of motion in force.
RAPID: Final = 0
LINEAR: Final = 1

INCH: Final = 25.4

#: How far tool and drilling axis may lie apart before it is worth a word, as the length of their difference.
ASKEW: Final = 2e-4

#: Makes the circle of a block from its start and end, programmed positions; raises ``arcs.ArcError``.
Circle = Callable[[Floats, Floats], arcs.Arc]


class Control(Rows, ABC):
    """A control at work on a machine."""

    #: The work offset that is none: positions count from the machine's zero.
    no_offset = -1

    #: Rotary words are positions as they wind, whatever the machine's definition says of its display.
    winds = False

    def __init__(self, machine: Machine, note: Note, file: Changes[int], *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, file)
        self.shortest = shortest
        self.names = tuple(machine.axes[column].name.upper() for column in machine.rotary)
        self._origin_slides, self._origin_tip = self._origins()
        self.absolute = True
        #: The axis that stands on the working plane.
        self.plane = 2
        #: Millimetres of a programmed length, and of the length in a programmed feed.
        self.lengths = 1.0
        self.feeds = 1.0
        self.tcp = False
        self.tilted = False
        self._plane = Frame()
        self._program = Frame()
        self._old: dict[int, float] = {}
        self._offsets: set[int] = set()
        self._rigid: tuple[float, float, Floats] | None = None
        self._image: tuple[arcs.Image, bool] | None = None
        self._remap()
        self.place[:3] = self._where()

    def after_scan(self) -> int:
        """Take over what the kernel did."""
        bits = super().after_scan()
        for axis in range(3):
            if bits >> axis & 1:
                self._old.pop(axis, None)
        return bits

    # Rotary words

    @property
    def default_way(self) -> int:
        """How plain rotary words are reached now, as two nibbles."""
        return self.way(0, How.AS_SET) | self.way(1, How.AS_SET) << 4

    def way(self, which: int, how: How) -> int:
        """How a word for the first or second rotary axis is reached; see ``trunnion.model.axis_positions``."""
        axis = self.machine.axes[self.machine.rotary[which]]
        if how in (How.SHORTEST, How.GROWING, How.FALLING):
            if not axis.endless:
                self.note(f"{how}() for {axis.name}, which has ends", Severity.WARNING)
                return poses.PLAIN
            return {How.SHORTEST: poses.SHORTEST, How.GROWING: poses.POSITIVE, How.FALLING: poses.NEGATIVE}[how]
        if not axis.endless:
            return poses.PLAIN
        if self.shortest or (self.shortest is None and self.shorter(axis)):
            return poses.SHORTEST
        return poses.PLAIN if self.winds or axis.output is Output.NONE else poses.SAME_TURN

    @abstractmethod
    def shorter(self, axis: Axis) -> bool:
        """Whether plain words for an endless rotary axis take the shorter way now.

        Else they stay inside the turn, or are taken as they are where values are written as they wind.
        """

    # Frames

    @property
    def frame(self) -> Frame:
        """From programmed positions to the work offset."""
        return self._plane.then(self._program)

    def _origins(self) -> tuple[Floats, Floats]:
        """Slide values at the work offset's zero, and the tip where the machine's zero is; rotary axes at zero.

        Both without a tool.
        """
        bare = replace(self.machine, tool_length=None)
        joints = np.zeros(5)
        solve_slides(pack(bare), 0.0, 0.0, 0.0, 0.0, 0.0, joints)
        tip = forward(bare, np.zeros((1, 5)))[0][0]
        return np.nan_to_num(joints[self._slides]), tip

    def _remap(self) -> None:
        """Bring the maps of rows up to date."""
        self._image = None
        self.tips = self.tcp or self.tilted
        frame = self.frame
        none = self.offset.now == self.no_offset
        if self.tips:
            origin = self._origin_tip if none else np.zeros(3)
        else:
            origin = self._length + (0.0 if none else self._origin_slides)
        self.map = affine(frame.linear, frame.shift + origin)
        self.turn = self._vectors(frame)

    @property
    def _length(self) -> Floats:
        """What is added to the slides X Y Z for the length of the tool where positions are theirs, (3,) mm."""
        return np.zeros(3)

    def _vectors(self, frame: Frame) -> Floats:
        """From programmed vectors to the workpiece frame, (3, 3)."""
        return np.ascontiguousarray(frame.linear)

    def _where(self) -> Floats:
        """Return the programmed position of where the axes stand; the rows must be settled."""
        tip = forward(self.machine, self.held[None])[0][0]
        return self._back(tip if self.tips else self.held[self._slides])

    def _back(self, point: Floats) -> Floats:
        return Frame(self.map[:, :3], self.map[:, 3]).solve(point)

    def change(self, *, old: bool = False) -> "_Change":
        """Bracket a change of transformation, offset or frame: the axes stand still, the position gets new numbers.

        With ``old`` the last programmed numbers stay the base of incremental words, as a control does that is set to
        traverse changed frames; only frames may change then.
        """
        return _Change(self, old)

    def set_program_frame(self, frame: Frame, *, old: bool = True) -> None:
        """Put a programmable frame in place of the one in force; ``old`` as in ``change``."""
        total = self._plane.then(frame)
        x, y, z = total.linear
        if not abs(float(np.cross(x, y) @ z)) >= 1e-9:
            self.note("the frame would flatten space: it is not used", Severity.ERROR)
            return
        if float(np.abs(total.linear).max()) > 1e6 or float(np.abs(total.shift).max()) > FARTHEST:
            self.note("the frame is larger than any machine: it is not used", Severity.ERROR)
            return
        with self.change(old=old):
            self._program = frame

    @property
    def program_frame(self) -> Frame:
        """The programmable frame in force."""
        return self._program

    def set_plane(self, plane: Frame | None, program: Frame | None = None) -> None:
        """Tilt the plane, from it to the work offset, or take the tilted one away; the axes stay.

        ``program`` is the programmable frame from now on, none by default.
        """
        with self.change():
            self._plane = plane or Frame()
            self._program = program or Frame()
            self.tilted = plane is not None

    def set_tcp(self, on: bool) -> None:
        """Switch tool centre point control."""
        if on != self.tcp:
            with self.change():
                self.tcp = on
            self.tcp_rows.set(self.row, on)

    def set_offset(self, code: int, name: str) -> None:
        """Take another work offset; ``name`` is for messages."""
        if code == self.offset.now:
            return
        if code != self.no_offset:
            self._offsets.add(code)
            if len(self._offsets) > 1:
                self.note(f"{name}: work offsets are not known here, all count as the same one", Severity.WARNING)
        if self.no_offset in (code, self.offset.now):
            with self.change():
                self.offset.set(self.row, code)
        else:
            self.offset.set(self.row, code)

    def set_orientation(self, orientation: Orientation) -> None:
        """How the tool axis moves between rows from now on."""
        self.orientation.set(self.row, int(orientation))

    def set_units(self, inches: bool, feeds_too: bool) -> None:
        """Inches or millimetres; positions are kept in mm, so only new words are scaled."""
        self.lengths = INCH if inches else 1.0
        self.feeds = INCH if inches and feeds_too else 1.0
        self.inch_rows.set(self.row, inches)

    @property
    def kind(self) -> int:
        """The kind of motion in force."""
        return int(self.counts[KIND])

    @kind.setter
    def kind(self, kind: int) -> None:
        self.counts[KIND] = kind

    # Motion

    def move(
        self,
        axes: Mapping[str, Word],
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
        bits = int(Written.FEED) if feed_written else 0
        if machine_frame:
            self._machine_move(axes, bits, circle is not None)
            return
        start = self.place[:3].copy()
        end = start.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                value *= self.lengths
                end[axis] = self._old.get(axis, start[axis]) + value if self._adds(how) else value
                self._old.pop(axis, None)
                bits |= 1 << axis
        arc = None
        if circle is not None and reachable(end):
            try:
                arc = circle(start, end)
                end = arc.end
            except arcs.ArcError as error:
                self.note(f"{error}: taken as a straight line", Severity.ERROR)
        rotary, way, turned = self.rotary_words(axes)
        if vector is not None and turned:
            self.note("rotary words and a vector in one block: the vector counts", Severity.ERROR)
            rotary, turned = [math.nan, math.nan], 0
        if vector is not None:
            turned = int(Written.VECTOR)
        placed = None if arc is None else self._place_arc(arc, bool(turned) and not self.tips)
        kind = Kind.RAPID if self.kind == RAPID else Kind.LINEAR
        row = self.row
        made = self.emit(kind if placed is None else Kind.ARC, end, bits | turned, rotary, way, vector)
        if arc is not None and placed is not None and made:
            self.curve(row, *placed, arc.turns)

    def _adds(self, how: How) -> bool:
        return how is How.INCREMENTAL or (how is How.AS_SET and not self.absolute)

    def rotary_words(self, axes: Mapping[str, Word]) -> tuple[list[float], int, int]:
        """Return values (NaN without a word), way and bits of the rotary words of a block."""
        rotary = [math.nan, math.nan]
        way = bits = 0
        for which, name in enumerate(self.names):
            if name not in axes:
                continue
            value, how = axes[name]
            code = self.way(which, how)
            if self._adds(how):
                self.settle()
                value += float(self.held[self.machine.rotary[which]])
                code = poses.PLAIN
            rotary[which] = value
            way |= code << (4 * which)
            bits |= int(Written.FIRST) << which
        return rotary, way, bits

    def _machine_move(self, axes: Mapping[str, Word], bits: int, circle: bool) -> None:
        """Positions of the axes themselves, whatever frames and TCP say."""
        if self.tcp:
            self.note("machine positions while TCP is on are taken as positions of the slides", Severity.WARNING)
        if circle:
            self.note("a circle in machine positions is taken as a straight line", Severity.ERROR)
        self.settle()
        slides = self.held[self._slides].copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                slides[axis] = value * self.lengths + (slides[axis] if self._adds(how) else 0.0)
                bits |= 1 << axis
        was, self.tcp = self.tcp, False
        rotary, way, turned = self.rotary_words(axes)
        self.tcp = was
        self.machine_rows.set(self.row, True)
        self.move_axes(Kind.RAPID if self.kind == RAPID else Kind.LINEAR, slides, rotary, way, bits | turned)
        self.machine_rows.set(self.row, False)

    def move_axes(self, kind: Kind, slides: Floats, rotary: list[float], way: int, bits: int) -> None:
        """Make a row of slide values (X, Y, Z) and rotary values, whatever X Y Z mean now; settles."""
        self.settle()
        tips, kept = self.tips, self.map
        self.tips, self.map = False, affine(np.eye(3), np.zeros(3))
        self.emit(kind, slides, bits, rotary, way, None)
        self.settle()
        self.tips, self.map = tips, kept
        self._old.clear()
        self.place[:3] = self._where()

    # Circles

    def _place_arc(self, arc: arcs.Arc, turned: bool) -> tuple[Floats, Floats, float] | None:
        """Return centre, normal and radius in the workpiece frame; None, with a finding, if it is no circle there."""
        if turned:
            self.note(
                "rotary axes turn during a circle of the slides: the tip does not make a circle", Severity.WARNING
            )
        rigid = None if self.tips else self._slides_to_tip()
        if self._image is None:
            linear, shift = self.map[:, :3], self.map[:, 3]
            if rigid is not None:
                linear, shift = rigid[:, :3] @ linear, rigid[:, :3] @ shift + rigid[:, 3]
            self._image = arcs.Image.of(linear, shift), self.frame.even
        image, even = self._image
        if not even:
            self.note("a circle under unequal scales is an ellipse: taken as a straight line", Severity.ERROR)
            return None
        return image.place(arc)

    def _slides_to_tip(self) -> Floats:
        """(3, 4) from slide values to the tip, with the rotary axes where they are."""
        if self._turned:
            self.settle()
        first, second = (float(self.held[column]) for column in self.machine.rotary)
        if self._rigid is None or self._rigid[:2] != (first, second):
            joints = np.zeros((4, 5))
            joints[:, list(self.machine.rotary)] = first, second
            for axis, column in enumerate(self._slides):
                joints[axis + 1, column] = 1.0
            tip = forward(self.machine, joints)[0]
            self._rigid = first, second, affine((tip[1:] - tip[0]).T, tip[0])
            self._image = None
        return self._rigid[2]

    # Cycles

    def drill(self, steps: list[Step]) -> None:
        """Make the motions of a drilling cycle where the tool is."""
        hole = self.place[:3].copy()
        kind, feed, first_row = self.kind, float(self.place[3]), self.row
        first, second = (self.plane + 1) % 3, (self.plane + 2) % 3
        still = [math.nan, math.nan]
        for step in steps:
            end = hole.copy()
            end[self.plane] = self.place[self.plane] if step.height is None else step.height * self.lengths
            end[first] += step.aside[0] * self.lengths
            end[second] += step.aside[1] * self.lengths
            if step.feed is not None:
                # A negative feed is a part of the one in force.
                self.place[3] = -step.feed * feed if step.feed < 0.0 else step.feed
            if step.turns:
                self._round(hole, end, step.turns)
            else:
                self.emit(Kind.RAPID if step.rapid else Kind.LINEAR, end, 0, still, 0, None)
            self.place[3] = feed
            if step.dwell:
                self.event("dwell", step.dwell)
        self.kind = kind
        self._check_askew(self.row - first_row)

    def _round(self, hole: Floats, end: Floats, turns: int) -> None:
        """Whole turns about a hole, from where the tool is to a point above or below; positive counter-clockwise."""
        arc = arcs.by_centre(self.place[:3].copy(), end, hole, self.plane, turns < 0, abs(turns) - 1)
        placed, row = self._place_arc(arc, turned=False), self.row
        still = [math.nan, math.nan]
        if self.emit(Kind.LINEAR if placed is None else Kind.ARC, end, 0, still, 0, None) and placed is not None:
            self.curve(row, *placed, arc.turns)

    def _check_askew(self, rows: int) -> None:
        """Say so if the tool does not stand along the drilling axis."""
        self.settle()
        along = self.map[:, self.plane]
        along = along / np.linalg.norm(along)
        if not self.tips:
            return
        axis = forward(self.machine, self.held[None])[1][0]
        if rows and float(np.linalg.norm(axis - along)) > ASKEW:
            self.note("the cycle drills along the axis of the frame, which is not the tool axis", Severity.WARNING)


class _Change:
    """A change of what programmed positions mean, while the axes stand still."""

    def __init__(self, control: Control, old: bool) -> None:
        self._control = control
        self._old = old

    def __enter__(self) -> None:
        c = self._control
        self._programmed = c.place[:3].copy()
        self._kept = dict(c._old)
        if self._old:
            # Only the frame changes: the point is known without asking the axes.
            self._point = c.map[:, :3] @ self._programmed + c.map[:, 3]
        else:
            c.settle()

    def __exit__(self, *_: object) -> None:
        c = self._control
        c._remap()
        if not self._old:
            c._old.clear()
            c.place[:3] = c._where()
            return
        c.place[:3] = c._back(self._point)
        c._old = {axis: self._kept.get(axis, float(self._programmed[axis])) for axis in range(3)}
