"""The rows that motion blocks become, the state that goes with them, and where the axes stand after them.

This half of the virtual control keeps books: it takes ends of motions and turns them into columns, by hand or from a
scan kernel. What a programmed position means is for the other half, ``trunnion.readers.common.virtual_control``.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.machines.inverse import pack
from trunnion.model import axis_positions as poses
from trunnion.model.columns import Changes, Columns, affine
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import BY_WORDS, Comment, Finding, Happening, Normals, Run, State, Value, Written
from trunnion.model.toolpath import Arcs, Kind
from trunnion.readers.common.scan_buffers import (
    COMMENTS,
    FEEDS,
    FIELDS,
    KIND,
    LINE,
    NORMALS,
    POSITION,
    ROOM,
    ROW,
    Notes,
    Target,
)

#: Larger positions (mm, degrees) are none that a machine could have.
FARTHEST = 1e7

Note = Callable[[str, Severity], None]


class Rows:
    """Rows while a program runs. ``line`` and ``block_number`` are those of the block that is being executed.

    place   (5,)     programmed X Y Z, mm, feed, and feed of the row before
    map     (3, 4)   from programmed position to the tool tip in the workpiece frame, or to the slides
    turn    (3, 3)   from programmed vector to the workpiece frame
    tips    whether ``map`` leads to the tool tip
    held    (5,)     axis values after the rows that are settled
    """

    #: The rotary axis that decides between two positions for a vector, as ``poses.settle`` has it.
    deciding = poses.BOTH

    def __init__(self, machine: Machine, note: Note, file: Changes[int]) -> None:
        self.machine = machine
        self.note = note
        self._file = file
        self.line = 0
        self.block_number = -1
        self.columns = Columns()
        self.events: list[Happening] = []
        self._packed = pack(machine)
        self._slides = poses.xyz(machine)
        self.start = machine.home.copy()
        self.held = machine.home.copy()
        self._turned = False

        self.feed = Changes(math.nan)
        self.feed_mode = Changes(94)
        self.rpm = Changes(0.0)
        self.spindle = Changes(0)
        self.tool = Changes(0)
        self.tools: dict[str, int] = {"": 0}
        self._tool_names = [""]
        self._chosen = 0
        self.edge = Changes(-1)
        self.compensation = Changes(0)
        self.offset = Changes(0)
        self.tcp_rows = Changes(False)
        self.machine_rows = Changes(False)
        self.inch_rows = Changes(False)
        self.orientation = Changes(BY_WORDS)
        self.by_tip = Changes(False)
        self.feed_path = Changes(int(FeedPath.SLIDES))
        self._arcs: list[tuple[int, Floats, Floats, float, int]] = []
        self._touching: list[tuple[Ints, Floats]] = []

        self.counts = np.zeros(FIELDS, np.int64)
        self.counts[KIND] = 1
        self.notes = Notes(
            np.empty((ROOM, 4), np.int64),
            np.empty(ROOM, np.int64),
            np.empty(ROOM),
            np.empty(ROOM, np.int64),
            np.empty((ROOM, 3)),
            np.zeros(12),
        )
        self.place = np.zeros(5)
        self.place[3] = math.nan
        self.map = affine(np.eye(3), np.zeros(3))
        self.turn = np.eye(3)
        self.tips = False

    @property
    def row(self) -> int:
        """The row that the next motion becomes."""
        return self.columns.n

    def event(self, kind: str, value: Value = None) -> None:
        """Note that something happens before the next row."""
        self.events.append(Happening(self.line, self.row, kind, value, self._file.now, bool(self.tcp_rows.now)))

    # Tools

    def choose(self, name: str) -> None:
        """Choose the tool for the next change."""
        self._chosen = self.tools.setdefault(name, len(self.tools))
        if self._chosen == len(self._tool_names):
            self._tool_names.append(name)
        self.event("tool", name)

    def change_tool(self) -> None:
        """Change to the tool that was chosen."""
        self.tool.set(self.row, self._chosen)
        self.event("tool_change", self._tool_names[self._chosen])

    @property
    def tool_in_spindle(self) -> str:
        """Number or name of the tool that was changed to last; empty before the first change."""
        return self._tool_names[self.tool.now]

    # With a kernel

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
        self.counts[NORMALS] = 0
        self.place[4] = self.feed.now
        self.counts[POSITION] = position
        self.counts[LINE] = line

    def after_scan(self) -> int:
        """Take over what the kernel did; returns the ``Written`` bits of all its rows together."""
        old, new = self.columns.n, int(self.counts[ROW])
        if new == old:
            return 0
        bits = int(np.bitwise_or.reduce(self.columns.programmed[old:new]))
        self._turned |= bool(bits & (Written.FIRST | Written.SECOND | Written.VECTOR))
        noted = int(self.counts[FEEDS])
        self.feed.extend(self.notes.feed_rows[:noted], self.notes.feeds[:noted])
        if said := int(self.counts[NORMALS]):
            self._touching.append((self.notes.touching[:said].copy(), self.notes.normals[:said].copy()))
        self.columns.n = new
        return bits

    @property
    def full(self) -> bool:
        """Whether the kernel came back for want of room."""
        return (
            self.columns.n == self.columns.capacity
            or self.columns.full
            or ROOM in (self.counts[COMMENTS], self.counts[FEEDS], self.counts[NORMALS])
        )

    # By hand

    def emit(
        self, kind: Kind, end: Floats, bits: int, rotary: Sequence[float], way: int, vector: Floats | None
    ) -> bool:
        """Make a row; False, with a finding, if no machine could do it.

        end      (3,) programmed position
        rotary   programmed values, NaN where there are none; ``way`` as in ``trunnion.model.axis_positions``
        vector   (3,) programmed tool axis, any length
        """
        if not reachable(end) or any(abs(value) > FARTHEST for value in rotary):
            self.note("a position is farther away than any machine reaches: the block is not executed", Severity.ERROR)
            return False
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
        c.vector[waits] = math.nan if vector is None else self.turn @ vector
        self.feed.set(row, float(self.place[3]))
        c.n += 1
        self.place[:3] = end
        self._turned |= bool(bits & (Written.FIRST | Written.SECOND | Written.VECTOR))
        return True

    def curve(self, row: int, centre: Floats, normal: Floats, radius: float, turns: int) -> None:
        """Note the circle of a row of kind ``Kind.ARC``, in the workpiece frame."""
        self._arcs.append((row, centre, normal, radius, turns))

    def touch(self, normal: Floats) -> None:
        """Note the surface's normal (3,), as it was programmed, of the row that was made last."""
        self._touching.append((np.array([self.row - 1]), (self.turn @ normal)[None]))

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
            self.deciding,
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

    # The end

    def finish(self, files: Sequence[str], comments: list[Comment], findings: Sequence[Finding]) -> Run:
        """Return what was done, once everything is settled; no row may follow."""
        c = self.columns
        c.clear()
        n = c.n
        return Run(
            machine=self.machine,
            files=tuple(files),
            blocks=c.blocks.ramps(),
            numbers=c.numbers.ramps(),
            kind=c.kind[:n],
            programmed=c.programmed[:n],
            place=c.place[:n],
            rotary=c.rotary[:n],
            state=State(
                file=self._file.steps(n, np.uint16),
                feed=self.feed.steps(n, np.float64),
                feed_mode=self.feed_mode.steps(n, np.uint8),
                rpm=self.rpm.steps(n, np.float64),
                spindle=self.spindle.steps(n, np.int8),
                tool=self.tool.steps(n, np.int32),
                edge=self.edge.steps(n, np.int32),
                compensation=self.compensation.steps(n, np.int8),
                offset=self.offset.steps(n, np.uint16),
                tcp=self.tcp_rows.steps(n, np.bool_),
                machine_frame=self.machine_rows.steps(n, np.bool_),
                inches=self.inch_rows.steps(n, np.bool_),
                orientation=self.orientation.steps(n, np.uint8),
                by_tip=self.by_tip.steps(n, np.bool_),
                feed_path=self.feed_path.steps(n, np.uint8),
            ),
            start=self.start,
            arcs=self._curves(),
            normals=self._normals(),
            tools=tuple(self.tools),
            comments=comments,
            events=self.events,
            findings=tuple(findings),
        )

    def _normals(self) -> Normals:
        if not self._touching:
            return Normals.none()
        rows, vectors = zip(*self._touching, strict=True)
        return Normals(np.concatenate(rows), np.concatenate(vectors))

    def _curves(self) -> Arcs:
        if not self._arcs:
            return Arcs.none()
        rows, centres, normals, radii, turns = zip(*self._arcs, strict=True)
        return Arcs(
            np.array(rows, np.int64), np.array(centres), np.array(normals), np.array(radii), np.array(turns, np.int64)
        )


def reachable(point: Floats) -> bool:
    """Whether a machine could be so large, NaN being nowhere."""
    return float(np.abs(point).max()) < FARTHEST
