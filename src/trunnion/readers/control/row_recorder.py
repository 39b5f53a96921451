"""The rows that motion blocks become, the state that goes with them, and where the axes stand after them.

This half of the virtual control keeps books: it takes ends of motions and turns them into columns, by hand or from a
scan kernel. What a programmed position means is for the other half, ``trunnion.readers.control.virtual_control``.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.machines.inverse import kinematic_parameters
from trunnion.model import axis_positions
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import (
    ORIENTATION_FROM_WORDS,
    Comment,
    Diagnostic,
    EventValue,
    ModalState,
    ProgrammedWord,
    Run,
    RunEvent,
    SurfaceNormals,
)
from trunnion.model.toolpath import Arcs, Kind
from trunnion.readers.control.affine_map import affine_matrix
from trunnion.readers.control.row_buffer import RowBuffer, StepColumnBuilder
from trunnion.readers.scan.buffers import (
    COMMENTS,
    COUNTER_COUNT,
    FEEDS,
    KIND,
    LINE,
    NORMALS,
    POSITION,
    RECORD_CAPACITY,
    ROW,
    ScanRecords,
    ScanTarget,
)

#: Larger positions (mm, degrees) are none that a machine could have.
MAX_POSITION = 1e7

Note = Callable[[str, Severity], None]


class RowRecorder:
    """Rows while a program runs. ``line`` and ``block_number`` are those of the block that is being executed.

    place   (5,)     programmed X Y Z, mm, feed, and feed of the row before
    map     (3, 4)   from programmed position to the tool tip in the workpiece frame, or to the slides
    turn    (3, 3)   from programmed vector to the workpiece frame
    tips    whether ``map`` leads to the tool tip
    held    (5,)     axis values after the rows that are settled
    """

    #: The rotary axis that decides between two positions for a vector, as ``axis_positions.resolve_rotary`` has it.
    deciding_axis = axis_positions.TOTAL_ROTATION

    def __init__(self, machine: Machine, note: Note, file: StepColumnBuilder[int]) -> None:
        self.machine = machine
        self.note = note
        self._file = file
        self.line = 0
        self.block_number = -1
        self.columns = RowBuffer()
        self.events: list[RunEvent] = []
        self._kinematics = kinematic_parameters(machine)
        self._slides = axis_positions.slide_columns(machine)
        self.start = machine.home.copy()
        self.current_joints = machine.home.copy()
        self._rotary_unresolved = False

        self.feed = StepColumnBuilder(math.nan)
        self.feed_mode = StepColumnBuilder(94)
        self.rpm = StepColumnBuilder(0.0)
        self.spindle = StepColumnBuilder(0)
        self.tool = StepColumnBuilder(0)
        self.tools: dict[str, int] = {"": 0}
        self._tool_names = [""]
        self._selected_tool = 0
        self.edge = StepColumnBuilder(-1)
        self.compensation = StepColumnBuilder(0)
        self.work_offset = StepColumnBuilder(0)
        self.tcp_rows = StepColumnBuilder(False)
        self.machine_rows = StepColumnBuilder(False)
        self.inch_rows = StepColumnBuilder(False)
        self.orientation = StepColumnBuilder(ORIENTATION_FROM_WORDS)
        self.xyz_is_tip = StepColumnBuilder(False)
        self.feed_path = StepColumnBuilder(int(FeedPath.SLIDES))
        self._arcs: list[tuple[int, Floats, Floats, float, int]] = []
        self._normal_records: list[tuple[Ints, Floats]] = []

        self.counters = np.zeros(COUNTER_COUNT, np.int64)
        self.counters[KIND] = 1
        self.scan_records = ScanRecords(
            np.empty((RECORD_CAPACITY, 4), np.int64),
            np.empty(RECORD_CAPACITY, np.int64),
            np.empty(RECORD_CAPACITY),
            np.empty(RECORD_CAPACITY, np.int64),
            np.empty((RECORD_CAPACITY, 3)),
            np.zeros(12),
        )
        self.commanded = np.zeros(5)
        self.commanded[3] = math.nan
        self.position_map = affine_matrix(np.eye(3), np.zeros(3))
        self.vector_map = np.eye(3)
        self.tip_programmed = False

    @property
    def row(self) -> int:
        """The row that the next motion becomes."""
        return self.columns.n

    def add_event(self, kind: str, value: EventValue = None) -> None:
        """Note that something happens before the next row."""
        self.events.append(RunEvent(self.line, self.row, kind, value, self._file.current, bool(self.tcp_rows.current)))

    # Tools

    def select_tool(self, name: str) -> None:
        """Choose the tool for the next change."""
        self._selected_tool = self.tools.setdefault(name, len(self.tools))
        if self._selected_tool == len(self._tool_names):
            self._tool_names.append(name)
        self.add_event("tool", name)

    def change_tool(self) -> None:
        """Change to the tool that was chosen."""
        self.tool.set(self.row, self._selected_tool)
        self.add_event("tool_change", self._tool_names[self._selected_tool])

    @property
    def tool_in_spindle(self) -> str:
        """Number or name of the tool that was changed to last; empty before the first change."""
        return self._tool_names[self.tool.current]

    # With a kernel

    def scan_target(self) -> ScanTarget:
        """Return the columns, for the scan kernel."""
        c = self.columns
        return ScanTarget(c.kind, c.programmed, c.xyz, c.rotary, c.base, c.line, c.block_number, c.vector, c.turn_rule)

    def before_scan(self, position: int, line: int) -> None:
        """Set the shared counters, and see that rows may wait."""
        self._clear_if_full()
        self.counters[ROW] = self.columns.n
        self.counters[COMMENTS] = 0
        self.counters[FEEDS] = 0
        self.counters[NORMALS] = 0
        self.commanded[4] = self.feed.current
        self.counters[POSITION] = position
        self.counters[LINE] = line

    def after_scan(self) -> int:
        """Take over what the kernel did; returns the ``ProgrammedWord`` bits of all its rows together."""
        old, new = self.columns.n, int(self.counters[ROW])
        if new == old:
            return 0
        bits = int(np.bitwise_or.reduce(self.columns.programmed[old:new]))
        self._rotary_unresolved |= bool(bits & (ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR))
        noted = int(self.counters[FEEDS])
        self.feed.extend(self.scan_records.feed_rows[:noted], self.scan_records.feed_values[:noted])
        if count := int(self.counters[NORMALS]):
            self._normal_records.append(
                (self.scan_records.normal_rows[:count].copy(), self.scan_records.normals[:count].copy())
            )
        self.columns.n = new
        return bits

    @property
    def full(self) -> bool:
        """Whether the kernel came back for want of room."""
        return (
            self.columns.n == self.columns.capacity
            or self.columns.full
            or RECORD_CAPACITY in (self.counters[COMMENTS], self.counters[FEEDS], self.counters[NORMALS])
        )

    # By hand

    def add_row(
        self, kind: Kind, end: Floats, bits: int, rotary: Sequence[float], turn_rule: int, vector: Floats | None
    ) -> bool:
        """Make a row; False, with a finding, if no machine could do it.

        end      (3,) programmed position
        rotary   programmed values, NaN where there are none; ``turn_rule`` as in ``trunnion.model.axis_positions``
        vector   (3,) programmed tool axis, any length
        """
        if not within_limits(end) or any(abs(value) > MAX_POSITION for value in rotary):
            self.note("a position is farther away than any machine reaches: the block is not executed", Severity.ERROR)
            return False
        c = self.columns
        self._clear_if_full()
        c.reserve(1)
        row, pending = c.n, c.n - c.base
        c.line[pending] = self.line
        c.block_number[pending] = self.block_number
        c.kind[row] = kind
        c.programmed[row] = bits
        c.xyz[row] = self.position_map[:, :3] @ end + self.position_map[:, 3]
        c.rotary[row] = rotary
        c.turn_rule[pending] = turn_rule
        c.vector[pending] = math.nan if vector is None else self.vector_map @ vector
        self.feed.set(row, float(self.commanded[3]))
        c.n += 1
        self.commanded[:3] = end
        self._rotary_unresolved |= bool(bits & (ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR))
        return True

    def add_arc(self, row: int, centre: Floats, normal: Floats, radius: float, turns: int) -> None:
        """Note the circle of a row of kind ``Kind.ARC``, in the workpiece frame."""
        self._arcs.append((row, centre, normal, radius, turns))

    def add_normal(self, normal: Floats) -> None:
        """Note the surface's normal (3,), as it was programmed, of the row that was made last."""
        self._normal_records.append((np.array([self.row - 1]), (self.vector_map @ normal)[None]))

    def resolve_rows(self) -> None:
        """Work out where the axes are after the rows so far."""
        c = self.columns
        if c.resolved == c.n:
            return
        rows, pending = slice(c.resolved, c.n), slice(c.resolved - c.base, c.n - c.base)
        columns = list(self.machine.rotary)
        place, rotary = c.xyz[rows], c.rotary[rows]
        status = axis_positions.resolve_rotary(
            self.machine,
            self._kinematics,
            place,
            rotary,
            c.turn_rule[pending],
            c.vector[pending],
            self.current_joints[columns],
            self.tip_programmed,
            self.deciding_axis,
        )
        self.xyz_is_tip.set(c.resolved, self.tip_programmed)
        self._report(status, c.resolved - c.base)
        xyz_is_tip = np.array([self.tip_programmed])
        held = axis_positions.joints_from_rows(self.machine, self._kinematics, xyz_is_tip, place[-1:], rotary[-1:])[0]
        self.current_joints = np.where(np.isfinite(held), held, self.current_joints)
        c.resolved = c.n
        self._rotary_unresolved = False

    def _clear_if_full(self) -> None:
        if self.columns.full:
            self.resolve_rows()
            self.columns.clear()

    def _report(self, status: Codes, first: int) -> None:
        texts = (
            (axis_positions.OUT_OF_TRAVEL, "no rotary position inside the travel gives this tool axis"),
            (axis_positions.NO_ROTARY_SOLUTION, "no rotary position gives this tool axis: the axes stay"),
            (axis_positions.NO_SLIDE_SOLUTION, "the slides cannot reach this position"),
        )
        if not status.any():
            return
        here = self.line
        for row in np.flatnonzero(status):
            self.line = int(self.columns.line[first + row])
            for bit, text in texts:
                if status[row] & bit:
                    self.note(text, Severity.WARNING if bit == axis_positions.OUT_OF_TRAVEL else Severity.ERROR)
        self.line = here

    # The end

    def finish(self, files: Sequence[str], comments: list[Comment], diagnostics: Sequence[Diagnostic]) -> Run:
        """Return what was done, once everything is settled; no row may follow."""
        c = self.columns
        c.clear()
        n = c.n
        return Run(
            machine=self.machine,
            files=tuple(files),
            lines=c.lines.ramps(),
            block_numbers=c.block_numbers.ramps(),
            kind=c.kind[:n],
            programmed=c.programmed[:n],
            xyz=c.xyz[:n],
            rotary=c.rotary[:n],
            state=ModalState(
                file=self._file.steps(n, np.uint16),
                feed=self.feed.steps(n, np.float64),
                feed_mode=self.feed_mode.steps(n, np.uint8),
                rpm=self.rpm.steps(n, np.float64),
                spindle=self.spindle.steps(n, np.int8),
                tool=self.tool.steps(n, np.int32),
                edge=self.edge.steps(n, np.int32),
                compensation=self.compensation.steps(n, np.int8),
                work_offset=self.work_offset.steps(n, np.uint16),
                tcp=self.tcp_rows.steps(n, np.bool_),
                machine_frame=self.machine_rows.steps(n, np.bool_),
                inches=self.inch_rows.steps(n, np.bool_),
                orientation=self.orientation.steps(n, np.uint8),
                xyz_is_tip=self.xyz_is_tip.steps(n, np.bool_),
                feed_path=self.feed_path.steps(n, np.uint8),
            ),
            start=self.start,
            arcs=self._arc_columns(),
            normals=self._normal_columns(),
            tools=tuple(self.tools),
            comments=comments,
            events=self.events,
            diagnostics=tuple(diagnostics),
        )

    def _normal_columns(self) -> SurfaceNormals:
        if not self._normal_records:
            return SurfaceNormals.none()
        rows, vectors = zip(*self._normal_records, strict=True)
        return SurfaceNormals(np.concatenate(rows), np.concatenate(vectors))

    def _arc_columns(self) -> Arcs:
        if not self._arcs:
            return Arcs.empty()
        rows, centres, normals, radii, turns = zip(*self._arcs, strict=True)
        return Arcs(
            np.array(rows, np.int64), np.array(centres), np.array(normals), np.array(radii), np.array(turns, np.int64)
        )


def within_limits(point: Floats) -> bool:
    """Whether a machine could be so large, NaN being nowhere."""
    return float(np.abs(point).max()) < MAX_POSITION
