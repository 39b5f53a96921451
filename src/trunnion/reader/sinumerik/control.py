"""The virtual control: modal state, transformation, frames, and the rows that motion blocks become.

It knows nothing of text. The interpreter tells it what a block said; it answers with rows in ``Columns``.

Two ways to mean X Y Z. With TRAORI, or in a plane swivelled by CYCLE800, they are the tool tip in the active frame.
Otherwise they are the values of the slides, counted from the work offset: with the rotary axes at zero the tip is then
where the program says, with turned axes it is where the machine takes it.

The length of the tool, if it is known, is what the control has in its tool offset. Without TRAORI an edge (D1) adds it
to the slide that stands on the working plane, wherever the tool points; D0 takes it away.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machine import Machine, Output, forward, inverse
from trunnion.machine.inverse import pack, solve_slides
from trunnion.reader import poses
from trunnion.reader.columns import Changes, Columns, affine
from trunnion.reader.run import BY_WORDS, Happening, Orientation, Value, Written
from trunnion.reader.sinumerik import arcs
from trunnion.reader.sinumerik.cycles import Step
from trunnion.reader.sinumerik.frames import Frame, about
from trunnion.reader.sinumerik.scan import COMMENTS, FEEDS, KIND, LINE, POSITION, ROW, Notes, Target, letters
from trunnion.toolpath import Arcs, Kind

#: Motion words of group 1: G0, G1, G2, G3 and CIP.
RAPID: Final = 0
LINEAR: Final = 1
CLOCKWISE: Final = 2
COUNTER: Final = 3
THROUGH: Final = 4

INCH: Final = 25.4

#: Larger positions (mm, degrees) are none that a machine could have.
FARTHEST: Final = 1e7

#: A word's value and how it was said: "", AC, IC, DC, ACP or ACN.
Word = tuple[float, str]

#: How far tool and drilling axis may lie apart before it is worth a word, as the length of their difference.
ASKEW: Final = 2e-4

#: Comments and feeds that the kernel may note before it comes back.
_NOTES: Final = 4096

Note = Callable[[str, Severity], None]


class Control:
    """A Sinumerik at work on a machine. ``line`` and ``block_number`` are those of the block that is being executed."""

    def __init__(self, machine: Machine, note: Note, file: Changes[int], *, shortest: bool | None = None) -> None:
        self.machine = machine
        self.note = note
        self.shortest = shortest
        self._file = file
        self.line = 0
        self.block_number = -1
        self.columns = Columns()
        self.events: list[Happening] = []

        self._packed = pack(machine)
        self._slides = poses.xyz(machine)
        self._names = tuple(machine.axes[column].name.upper() for column in machine.rotary)
        self.start = machine.home.copy()
        self.held = machine.home.copy()
        self._origin_slides, self._origin_tip = self._origins()
        self._tool_length = machine.tool_length or 0.0

        self.absolute = True
        self._plane = 2
        self.lengths = 1.0
        self.feeds = 1.0
        self.tcp = False
        self.swivelled = False
        self._swivel = Frame()
        self._program = Frame()
        self._old: dict[int, float] = {}
        self._machine_vectors = False
        self._turned = False
        self._rigid: tuple[float, float, Floats] | None = None
        self._image: tuple[Floats, Floats, Floats, float, bool] | None = None

        self.feed = Changes(math.nan)
        self.feed_mode = Changes(94)
        self.rpm = Changes(0.0)
        self.spindle = Changes(0)
        self.tool = Changes(0)
        self.tools: dict[str, int] = {"": 0}
        self._tool_names = [""]
        self._chosen = 0
        self.edge = Changes(-1)
        self.offset = Changes(0)
        self._offsets: set[int] = set()
        self.tcp_rows = Changes(False)
        self.machine_rows = Changes(False)
        self.inch_rows = Changes(False)
        self.orientation = Changes(BY_WORDS)
        self.by_tip = Changes(False)
        self._arcs: list[tuple[int, Floats, Floats, float, int]] = []

        #: What the scan kernel shares with this class: see ``scan``.
        self.counts = np.zeros(6, np.int64)
        self.counts[KIND] = LINEAR
        self.notes = Notes(np.empty((_NOTES, 4), np.int64), np.empty(_NOTES, np.int64), np.empty(_NOTES))
        self.place = np.zeros(5)
        self.place[3] = math.nan
        self.table = letters((self._names[0], self._names[1]))
        self.map = affine(np.eye(3), np.zeros(3))
        self.turn = np.eye(3)
        self._remap()
        self.place[:3] = self._where()

    # Rows

    @property
    def row(self) -> int:
        """The row that the next motion becomes."""
        return self.columns.n

    def event(self, kind: str, value: Value = None) -> None:
        """Note that something happens before the next row."""
        self.events.append(Happening(self.line, self.row, kind, value, self._file.now))

    def target(self) -> Target:
        """Return the columns, for the scan kernel."""
        c = self.columns
        return Target(c.kind, c.programmed, c.place, c.rotary, c.base, c.block, c.number, c.vector, c.way)

    def before_scan(self, position: int, line: int) -> None:
        """Set the shared counters, and see that rows may wait."""
        self._clear_if_full()
        self.counts[ROW] = self.columns.n
        self.counts[COMMENTS] = 0
        self.counts[FEEDS] = 0
        self.place[4] = self.feed.now
        self.counts[POSITION] = position
        self.counts[LINE] = line

    def after_scan(self) -> None:
        """Take over what the kernel did."""
        old, new = self.columns.n, int(self.counts[ROW])
        if new == old:
            return
        bits = int(np.bitwise_or.reduce(self.columns.programmed[old:new]))
        self._turned |= bool(bits & (Written.FIRST | Written.SECOND | Written.VECTOR))
        for axis in range(3):
            if bits >> axis & 1:
                self._old.pop(axis, None)
        noted = int(self.counts[FEEDS])
        self.feed.extend(self.notes.feed_rows[:noted], self.notes.feeds[:noted])
        self.columns.n = new

    @property
    def full(self) -> bool:
        """Whether the kernel came back for want of room."""
        return (
            self.columns.n == self.columns.capacity
            or self.columns.full
            or _NOTES in (self.counts[COMMENTS], self.counts[FEEDS])
        )

    @property
    def tips(self) -> bool:
        """Whether X Y Z mean the tool tip."""
        return self.tcp or self.swivelled

    @property
    def default_way(self) -> int:
        """How plain rotary words are reached now, as two nibbles."""
        return self._way(0, "") | self._way(1, "") << 4

    def _way(self, which: int, how: str) -> int:
        axis = self.machine.axes[self.machine.rotary[which]]
        if how in ("DC", "ACP", "ACN"):
            if not axis.endless:
                self.note(f"{how}() for {axis.name}, which has ends", Severity.WARNING)
                return poses.PLAIN
            return {"DC": poses.SHORTEST, "ACP": poses.POSITIVE, "ACN": poses.NEGATIVE}[how]
        if not axis.endless:
            return poses.PLAIN
        if self.shortest is not None and self.shortest:
            return poses.SHORTEST
        if axis.output is Output.NONE:
            return poses.PLAIN
        return poses.SHORTEST if self.tcp and self.shortest is None else poses.SAME_TURN

    def settle(self) -> None:
        """Work out where the axes are after the rows so far."""
        c = self.columns
        if c.settled == c.n:
            return
        rows, waiting = slice(c.settled, c.n), slice(c.settled - c.base, c.n - c.base)
        columns = list(self.machine.rotary)
        place, rotary = c.place[rows], c.rotary[rows]
        status = poses.settle(
            self.machine,
            self._packed,
            place,
            rotary,
            c.way[waiting],
            c.vector[waiting],
            self.held[columns],
            self.tips,
        )
        self.by_tip.set(c.settled, self.tips)
        self._report(status, c.settled - c.base)
        by_tip = np.array([self.tips])
        held = poses.joints_of(self.machine, self._packed, by_tip, place[-1:], rotary[-1:])[0]
        self.held = np.where(np.isfinite(held), held, self.held)
        c.settled = c.n
        self._turned = False

    def _clear_if_full(self) -> None:
        if self.columns.full:
            self.settle()
            self.columns.clear()

    def _report(self, status: Codes, first: int) -> None:
        texts = (
            (poses.OUT_OF_TRAVEL, "no rotary position inside the travel gives this tool axis"),
            (poses.UNREACHABLE, "no rotary position gives this tool axis: the axes stay"),
            (poses.STUCK, "the slides cannot reach this position"),
        )
        if not status.any():
            return
        here = self.line
        for row in np.flatnonzero(status):
            self.line = int(self.columns.block[first + row])
            for bit, text in texts:
                if status[row] & bit:
                    self.note(text, Severity.WARNING if bit == poses.OUT_OF_TRAVEL else Severity.ERROR)
        self.line = here

    # Frames

    @property
    def frame(self) -> Frame:
        """From programmed positions to the work offset."""
        return self._swivel.then(self._program)

    def _origins(self) -> tuple[Floats, Floats]:
        """Slide values at the work offset's zero, and the tip where the machine's zero is; rotary axes at zero.

        Both without a tool: lengths are added where an edge is in force.
        """
        bare = replace(self.machine, tool_length=None)
        joints = np.zeros(5)
        solve_slides(pack(bare), 0.0, 0.0, 0.0, 0.0, 0.0, joints)
        tip = forward(bare, np.zeros((1, 5)))[0][0]
        return np.nan_to_num(joints[self._slides]), tip

    def _remap(self) -> None:
        """Bring the maps of the kernel up to date."""
        self._image = None
        frame = self.frame
        none = self.offset.now == 500
        if self.tips:
            origin = self._origin_tip if none else np.zeros(3)
        else:
            origin = np.zeros(3) if none else self._origin_slides.copy()
            if self.edge.now > 0:
                origin[self._plane] += self._tool_length
        self.map = affine(frame.linear, frame.shift + origin)
        self.turn = np.eye(3) if self._machine_vectors else np.ascontiguousarray(frame.linear)

    def _where(self) -> Floats:
        """Return the programmed position of where the axes stand; the rows must be settled."""
        tip = forward(self.machine, self.held[None])[0][0]
        return self._back(tip if self.tips else self.held[self._slides])

    def _back(self, point: Floats) -> Floats:
        return Frame(self.map[:, :3], self.map[:, 3]).solve(point)

    def change(self, *, old: bool = False) -> "_Change":
        """Bracket a change of transformation, offset or frame: the axes stand still, the position gets new numbers.

        With ``old`` the last programmed numbers stay the base of incremental words, as a control does that is set to
        traverse changed frames.
        """
        return _Change(self, old)

    def set_program_frame(self, frame: Frame) -> None:
        """Put a programmable frame in place of the one in force."""
        total = self._swivel.then(frame)
        x, y, z = total.linear
        if not abs(float(np.cross(x, y) @ z)) >= 1e-9:
            self.note("the frame would flatten space: it is not used", Severity.ERROR)
            return
        if float(np.abs(total.linear).max()) > 1e6 or float(np.abs(total.shift).max()) > FARTHEST:
            self.note("the frame is larger than any machine: it is not used", Severity.ERROR)
            return
        with self.change(old=True):
            self._program = frame

    @property
    def program_frame(self) -> Frame:
        """The programmable frame in force."""
        return self._program

    def set_tcp(self, on: bool) -> None:
        """TRAORI or TRAFOOF."""
        if on != self.tcp:
            with self.change():
                self.tcp = on
            self.tcp_rows.set(self.row, on)

    @property
    def plane(self) -> int:
        """Axis that stands on the working plane: 2 for G17."""
        return self._plane

    @plane.setter
    def plane(self, plane: int) -> None:
        if plane == self._plane:
            return
        if not self._tool_length:
            self._plane = plane
            return
        with self.change():
            self._plane = plane

    def set_edge(self, edge: int) -> None:
        """D word: the offsets of the tool, of which its length is known here."""
        if not self._tool_length or (edge > 0) == (self.edge.now > 0):
            self.edge.set(self.row, edge)
            return
        with self.change():
            self.edge.set(self.row, edge)

    def set_offset(self, code: int) -> None:
        """G54 and its kin."""
        if code != self.offset.now:
            if code != 500:
                self._offsets.add(code)
                if len(self._offsets) > 1:
                    self.note(f"G{code}: work offsets are not known here, all count as the same one", Severity.WARNING)
            if code == 500 or self.offset.now == 500:
                with self.change():
                    self.offset.set(self.row, code)
            else:
                self.offset.set(self.row, code)

    def set_machine_vectors(self, on: bool) -> None:
        """ORIMKS or ORIWKS."""
        self._machine_vectors = on
        self._remap()

    def set_orientation(self, orientation: Orientation) -> None:
        """ORIAXES or ORIVECT."""
        self.orientation.set(self.row, int(orientation))

    def set_units(self, inches: bool, feeds_too: bool) -> None:
        """G70, G71, G700 or G710; positions are kept in mm, so only new words are scaled."""
        self.lengths = INCH if inches else 1.0
        self.feeds = INCH if inches and feeds_too else 1.0
        self.inch_rows.set(self.row, inches)

    def choose(self, name: str) -> None:
        """T word: the tool for the next change."""
        self._chosen = self.tools.setdefault(name, len(self.tools))
        if self._chosen == len(self._tool_names):
            self._tool_names.append(name)
        self.event("tool", name)

    def change_tool(self) -> None:
        """M6."""
        self.tool.set(self.row, self._chosen)
        self.event("tool_change", self._tool_names[self._chosen])

    @property
    def kind(self) -> int:
        """The motion word in force."""
        return int(self.counts[KIND])

    @kind.setter
    def kind(self, kind: int) -> None:
        self.counts[KIND] = kind

    # Motion

    def move(
        self,
        axes: Mapping[str, Word],
        vector: Mapping[str, float],
        params: Mapping[str, Word],
        *,
        machine_frame: bool,
        feed_written: bool,
    ) -> None:
        """Execute the motion of a block.

        axes     X, Y, Z and rotary axes by name, in the units of the program
        vector   A3, B3, C3 by letter; empty if the block has none
        params   I, J, K, I1, J1, K1, CR, AR, TURN
        """
        bits = int(Written.FEED) if feed_written else 0
        if machine_frame:
            self._machine_move(axes, bits)
            return
        start = self.place[:3].copy()
        end = start.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                value *= self.lengths
                relative = how == "IC" or (how == "" and not self.absolute)
                end[axis] = self._old.get(axis, start[axis]) + value if relative else value
                self._old.pop(axis, None)
                bits |= 1 << axis
        arc = None
        kind = Kind.RAPID if self.kind == RAPID else Kind.LINEAR
        if self.kind in (CLOCKWISE, COUNTER, THROUGH) and _reachable(end):
            arc = self._arc(start, end, params, bits)
            if arc is not None:
                end = arc.end
        rotary, way, turned = self._rotary(axes)
        if vector and turned:
            self.note("rotary words and a vector in one block: the vector counts", Severity.ERROR)
            rotary, turned = [math.nan, math.nan], 0
        if vector:
            turned = int(Written.VECTOR)
        placed = None if arc is None else self._place_arc(arc, turned if not self.tips else 0)
        row = self.row
        self._emit(kind if placed is None else Kind.ARC, end, bits | turned, rotary, way, vector)
        if arc is not None and placed is not None and self.row > row:
            self._arcs.append((row, *placed, arc.turns))

    def _rotary(self, axes: Mapping[str, Word]) -> tuple[list[float], int, int]:
        """Return values (NaN without a word), way and bits of the rotary words of a block."""
        rotary = [math.nan, math.nan]
        way = bits = 0
        for which, name in enumerate(self._names):
            if name not in axes:
                continue
            value, how = axes[name]
            code = self._way(which, how)
            if how == "IC" or (how == "" and not self.absolute):
                self.settle()
                value += float(self.held[self.machine.rotary[which]])
                code = poses.PLAIN
            rotary[which] = value
            way |= code << (4 * which)
            bits |= int(Written.FIRST) << which
        return rotary, way, bits

    def _machine_move(self, axes: Mapping[str, Word], bits: int) -> None:
        """SUPA, G53, G153: positions of the axes themselves."""
        if self.tcp:
            self.note("machine positions while TRAORI is on are taken as positions of the slides", Severity.WARNING)
        if self.kind > LINEAR:
            self.note("a circle in machine positions is taken as a straight line", Severity.ERROR)
        self.settle()
        slides = self.held[self._slides].copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, how = axes[name]
                relative = how == "IC" or (how == "" and not self.absolute)
                slides[axis] = value * self.lengths + (slides[axis] if relative else 0.0)
                bits |= 1 << axis
        was, self.tcp = self.tcp, False
        rotary, way, turned = self._rotary(axes)
        self.tcp = was
        self.machine_rows.set(self.row, True)
        self._axes_row(Kind.RAPID if self.kind == RAPID else Kind.LINEAR, slides, rotary, way, bits | turned)
        self.machine_rows.set(self.row, False)

    def _axes_row(self, kind: Kind, slides: Floats, rotary: list[float], way: int, bits: int) -> None:
        """Make a row of slide values (X, Y, Z) and rotary values, whatever X Y Z mean now; settles."""
        was = self.tcp, self.swivelled
        self.tcp = self.swivelled = False
        kept = self.map
        self.map = affine(np.eye(3), np.zeros(3))
        self._emit(kind, slides, bits, rotary, way, {})
        self.settle()
        self.tcp, self.swivelled = was
        self.map = kept
        self._old.clear()
        self.place[:3] = self._where()

    def _emit(
        self, kind: Kind, end: Floats, bits: int, rotary: list[float], way: int, vector: Mapping[str, float]
    ) -> None:
        if not _reachable(end) or any(abs(value) > FARTHEST for value in rotary):
            self.note("a position is farther away than any machine reaches: the block is not executed", Severity.ERROR)
            return
        c = self.columns
        self._clear_if_full()
        c.reserve(1)
        row, waits = c.n, c.n - c.base
        c.block[waits] = self.line
        c.number[waits] = self.block_number
        c.kind[row] = kind
        c.programmed[row] = bits
        c.place[row] = self.map[:, :3] @ end + self.map[:, 3]
        c.rotary[row] = rotary
        c.way[waits] = way
        c.vector[waits] = math.nan
        if vector:
            c.vector[waits] = self.turn @ np.array([vector.get(letter, 0.0) for letter in "ABC"])
        self.feed.set(row, float(self.place[3]))
        c.n += 1
        self.place[:3] = end
        self._turned |= bool(bits & (Written.FIRST | Written.SECOND | Written.VECTOR))

    # Circles

    def _arc(self, start: Floats, end: Floats, params: Mapping[str, Word], bits: int) -> arcs.Arc | None:
        """Return the circle of a block in programmed coordinates; None, with a finding, if there is none."""
        turns = int(params.get("TURN", (0.0, ""))[0])
        if not 0 <= turns < 1000:
            self.note(f"TURN={turns} is not from 0 to 999", Severity.ERROR)
            return None
        if any(abs(value) * self.lengths > FARTHEST for value, _ in params.values()):
            self.note("a circle with numbers that no machine has: taken as a straight line", Severity.ERROR)
            return None
        try:
            if self.kind == THROUGH:
                through = end.copy()
                for axis, name in enumerate(("I1", "J1", "K1")):
                    value, how = params.get(name, (0.0, "IC"))
                    value *= self.lengths
                    relative = how == "IC" or (how == "" and not self.absolute)
                    through[axis] = start[axis] + value if relative else value
                return arcs.by_points(start, through, end, turns)
            return self._plane_arc(start, end, params, bits, turns)
        except arcs.ArcError as error:
            self.note(f"{error}: taken as a straight line", Severity.ERROR)
            return None

    def _plane_arc(self, start: Floats, end: Floats, params: Mapping[str, Word], bits: int, turns: int) -> arcs.Arc:
        clockwise = self.kind == CLOCKWISE
        centre = None
        for axis, name in enumerate("IJK"):
            if name not in params:
                continue
            if axis == self.plane:
                self.note(f"{name} has no meaning for a circle in this plane", Severity.WARNING)
                continue
            centre = start.copy() if centre is None else centre
            value, how = params[name]
            value *= self.lengths
            centre[axis] = value if how == "AC" else start[axis] + value
        if "CR" in params:
            radius = params["CR"][0] * self.lengths
            if centre is not None:
                self.note("CR= and a centre in one block: CR= counts", Severity.ERROR)
            return arcs.by_radius(start, end, radius, self.plane, clockwise, turns)
        in_plane = bits & 7 & ~(1 << self.plane)
        if "AR" in params:
            angle = params["AR"][0]
            if centre is None:
                return arcs.by_angle(start, end, angle, self.plane, clockwise, turns)
            arc = arcs.by_angle_and_centre(start, centre, angle, self.plane, clockwise, turns)
            arc.end[self.plane] = end[self.plane]
            return arc
        if centre is None:
            raise arcs.ArcError("the circle has no centre" if in_plane else "the circle has neither end nor centre")
        return arcs.by_centre(start, end, centre, self.plane, clockwise, turns)

    def _place_arc(self, arc: arcs.Arc, turned: int) -> tuple[Floats, Floats, float] | None:
        """Return centre, normal and radius in the workpiece frame."""
        if turned:
            self.note(
                "rotary axes turn during a circle of the slides: the tip does not make a circle", Severity.WARNING
            )
        image = self._circle_image()
        if image is None:
            self.note("a circle under unequal scales is an ellipse: taken as a straight line", Severity.ERROR)
            return None
        linear, shift, normals, scale = image
        return linear @ arc.centre + shift, normals @ arc.normal, arc.radius * scale

    def _circle_image(self) -> tuple[Floats, Floats, Floats, float] | None:
        """Return how circles come to the workpiece frame: linear (3, 3), shift (3,), normals (3, 3) and scale.

        None if they do not stay circles. Normals turn with the cofactors, which know mirrors.
        """
        rigid = None if self.tips else self._slides_to_tip()
        if self._image is None:
            linear, shift = self.map[:, :3], self.map[:, 3]
            if rigid is not None:
                linear, shift = rigid[:, :3] @ linear, rigid[:, :3] @ shift + rigid[:, 3]
            volume = float(np.linalg.det(linear))
            scale = abs(volume) ** (1.0 / 3.0)
            normals = np.linalg.inv(linear).T * (scale * math.copysign(1.0, volume))
            self._image = linear, shift, normals, scale, self.frame.even
        return self._image[:4] if self._image[4] else None

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
            self._emit(Kind.RAPID if step.rapid else Kind.LINEAR, end, 0, still, 0, {})
            self.place[3] = feed
            if step.dwell:
                self.event("dwell", step.dwell)
        self.kind = kind
        self._check_askew(self.row - first_row)

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

    def unswivel(self) -> None:
        """CYCLE800(): no swivelled plane; the axes stay."""
        with self.change():
            self._swivel = Frame()
            self._program = Frame()
            self.swivelled = False

    def swivel(self, frame: Frame, *, add: bool, direction: float, direct: tuple[float, float] | None) -> None:
        """CYCLE800: a swivelled plane, and the rotary axes to it.

        add         on top of the plane and frames in force, instead of in their place
        direction   -1 or 1: the solution with the lower or higher value of the second rotary axis; 0: do not move
        direct      rotary values that the cycle gave itself; the plane is then the one they make
        """
        self.settle()
        self._old.clear()
        outer = self.frame if add else Frame()
        rotary: tuple[float, float] | None = direct
        if direct is not None:
            frame = Frame(self._table(direct) @ frame.linear, frame.shift)
        total = outer.then(frame)
        if rotary is None and direction:
            rotary = self._solution(total.linear[:, 2], direction)
        if rotary is not None and (direction or direct is not None):
            way = self._way(0, "") | self._way(1, "") << 4
            bits = int(Written.FIRST | Written.SECOND)
            self._axes_row(Kind.RAPID, self.held[self._slides].copy(), list(rotary), way, bits)
        self._swivel, self._program, self.swivelled = total, Frame(), True
        self._remap()
        self.place[:3] = self._where()
        self._old.clear()

    def _table(self, rotary: tuple[float, float]) -> Floats:
        """(3, 3): the tool's frame as seen from the workpiece, with the rotary axes at these values."""
        linear = np.eye(3)
        for column, value in sorted(zip(self.machine.rotary, rotary, strict=True)):
            axis = self.machine.axes[column]
            linear = linear @ about(np.array(axis.direction), axis.sense * value)
        return linear

    def _solution(self, normal: Floats, direction: float) -> tuple[float, float] | None:
        """Rotary values whose tool axis is ``normal``, with the second axis on the side of ``direction``."""
        solved = inverse(self.machine, np.zeros((1, 3)), normal[None])
        columns = list(self.machine.rotary)
        pairs = [tuple(float(v) for v in solved.joints[branch, 0, columns]) for branch in range(2)]
        if not all(math.isfinite(v) for v in pairs[0]):
            self.note("CYCLE800: no rotary position stands the tool on this plane", Severity.ERROR)
            return None
        if solved.pole[0]:
            pairs = [(float(self.held[columns[0]]), second) for _, second in pairs]
        fits = [pair for pair in pairs if all(self._inside(c, v) for c, v in zip(columns, pair, strict=True))]
        if not fits:
            self.note("CYCLE800: no rotary position inside the travel stands the tool on this plane", Severity.ERROR)
            return None
        pairs.sort(key=lambda pair: pair[1], reverse=direction > 0)
        first, second = pairs[0] if pairs[0] in fits else fits[0]
        if pairs[0] not in fits:
            self.note("CYCLE800: the solution asked for is outside the travel, the other is taken", Severity.WARNING)
        return first, second

    def _inside(self, column: int, value: float) -> bool:
        axis = self.machine.axes[column]
        return axis.endless or any(axis.low <= value + turn <= axis.high for turn in (0.0, -360.0, 360.0))

    # The end

    def finish_arcs(self) -> Arcs:
        """Return the circles."""
        if not self._arcs:
            return Arcs.none()
        rows, centres, normals, radii, turns = zip(*self._arcs, strict=True)
        return Arcs(
            np.array(rows, np.int64), np.array(centres), np.array(normals), np.array(radii), np.array(turns, np.int64)
        )


def _reachable(point: Floats) -> bool:
    """Whether a machine could be so large, NaN being nowhere."""
    return float(np.abs(point).max()) < FARTHEST


class _Change:
    """A change of what programmed positions mean, while the axes stand still."""

    def __init__(self, control: Control, old: bool) -> None:
        self._control = control
        self._old = old

    def __enter__(self) -> None:
        c = self._control
        self._tips = c.tips
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
