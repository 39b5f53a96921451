"""Rows of motion blocks, and the axis positions after them.

This part of the virtual control records: it takes the ends of motions, one by one or from a scan, and writes columns.
What programmed positions mean is the subject of ``trunnion.readers.control.coordinates``.
"""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.machines.inverse import kinematic_parameters
from trunnion.messages import Wording
from trunnion.model.axis_positions import (
    NO_ROTARY_SOLUTION,
    NO_SLIDE_SOLUTION,
    OUT_OF_TRAVEL,
    TOTAL_ROTATION,
    RotaryWords,
    joints_from_rows,
    resolve_rotary,
    slide_columns,
)
from trunnion.model.run import Comment, Diagnostic, ProgrammedWord, Run
from trunnion.model.run_columns import SurfaceNormals
from trunnion.model.spindle_work import SpindleHole, SpindleWork
from trunnion.model.splines import SplineRows, Splines
from trunnion.model.toolpath import Kind
from trunnion.readers.control.affine_map import affine_matrix
from trunnion.readers.control.axis_word import NO_ROTARY, RotaryTarget
from trunnion.readers.control.circle_columns import CircleColumns
from trunnion.readers.control.event_recorder import EventRecorder, Note
from trunnion.readers.control.start_modes import Relied, assumed_modes
from trunnion.readers.scan.buffers import MAX_BLOCKS, BlockWords, RowColumns, ScanRecords, ScanSettings
from trunnion.readers.scan.rows import execute_blocks

#: Larger positions (mm, degrees) are mistakes: no machine reaches so far.
MAX_POSITION: Final = 1e7

_ROTARY_WORDS: Final = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR)


class ScannedRows(NamedTuple):
    """What a scan added: its rows, its comments (k, 4) as in ``ScanRecords``, and its feed changes.

    rows         the rows, consecutive
    words        the ``ProgrammedWord`` bits of all rows together
    feed_before  the feed before the first of them
    """

    rows: range
    words: int
    comments: Ints
    feed_before: float
    feed_rows: Ints
    feed_values: Floats


#: Splines that are recorded before they become columns.
_SPLINES_AT_A_TIME: Final = 4096

#: Normals of planes that differ by less are the same.
_SAME_NORMAL: Final = 1e-9


class RowRecorder(EventRecorder):
    """Records the rows and events of a run.

    line, block_number   of the block that is being executed
    programmed_position  (3,)    X, Y and Z as programmed, mm
    programmed_feed              feed of the next motion
    position_map         (3, 4)  from programmed position to the tool tip in the workpiece frame, or to the slides
    vector_map           (3, 3)  from programmed vector to the workpiece frame
    tip_programmed               whether ``position_map`` gives the tool tip
    resolutions                  how often the axes have been worked out
    current_joints       (5,)    axis values after the rows that are resolved
    """

    #: The rotary axis that decides between two solutions for a vector, as in ``resolve_rotary``.
    deciding_axis = TOTAL_ROTATION

    #: Whether the control counts in millimetres unless the program says otherwise.
    knows_units = False

    #: The modes that a program may rely on without saying them: the word with which the control starts, by mode.
    start_modes: Mapping[str, str] = MappingProxyType({})

    def __init__(self, machine: Machine, note: Note) -> None:
        super().__init__(note)
        self._plane_axis = 2
        self.machine = machine
        self.block_number = -1
        self.units_from: int | None = 0 if self.knows_units else None
        self._circles = CircleColumns()
        #: Whole turns of all arcs so far.
        self.turns = 0
        self._splines: list[SplineRows] = []
        self._spline_columns: list[Splines] = []
        self._spindle_holes: list[SpindleHole] = []
        self._compensation_planes: list[Floats] = []
        self._planes: list[Floats] = []
        self._plane_numbers: dict[bytes, int] = {}
        self._normals: list[tuple[Ints, Floats]] = []
        self._kinematics = kinematic_parameters(machine)
        self._slides = list(slide_columns(machine))
        self._rotary_columns = machine.rotary
        self.start = machine.home.copy()
        self.current_joints = machine.home.copy()
        self._rotary_unresolved = False
        self.resolutions = 0
        # X, Y, Z, the feed, and the feed of the row before: the kernel needs one array.
        self._commanded = np.array([0.0, 0.0, 0.0, math.nan, math.nan])
        self.position_map = affine_matrix(np.eye(3), np.zeros(3))
        self.vector_map = np.eye(3)
        self.tip_programmed = False
        self.words = BlockWords.empty()
        self._records = ScanRecords.empty()

    @property
    def plane_axis(self) -> int:
        """Index of the axis across the working plane: 2 for G17."""
        return self._plane_axis

    @plane_axis.setter
    def plane_axis(self, axis: int) -> None:
        self._plane_axis = axis
        self.modal.working_plane.set(self.row, axis)

    @property
    def programmed_position(self) -> Floats:
        """X, Y and Z as programmed, (3,) mm; writable."""
        return self._commanded[:3]

    @programmed_position.setter
    def programmed_position(self, position: Floats) -> None:
        self._commanded[:3] = position

    @property
    def programmed_feed(self) -> float:
        """The feed of the next motion, in the unit of the feed mode; NaN before the first F."""
        return float(self._commanded[3])

    @programmed_feed.setter
    def programmed_feed(self, feed: float) -> None:
        self._commanded[3] = feed

    # Rows

    def add_row(
        self, kind: Kind, end: Floats, rotary: RotaryTarget = NO_ROTARY, bits: int = 0, vector: Floats | None = None
    ) -> bool:
        """Add a row; False, with a diagnostic, if no machine could reach its end.

        end      (3,) programmed position
        bits     ``ProgrammedWord`` bits of the words besides rotary ones and the vector
        vector   (3,) programmed tool axis, of any length
        """
        is_far = rotary is not NO_ROTARY and any(abs(value) > MAX_POSITION for value in rotary.values)
        if is_far or not within_limits(end):
            self.note(Wording("NC310", "too_far"), Severity.ERROR)
            return False
        bits |= rotary.bits if vector is None else int(ProgrammedWord.VECTOR)
        c = self.columns
        self._clear_if_full()
        c.reserve(1)
        row, pending = c.n, c.n - c.base
        c.line[pending] = self.line
        c.block_number[pending] = self.block_number
        c.kind[row] = kind
        c.programmed[row] = bits
        c.xyz[row] = self._mapped(end)
        c.rotary[row] = rotary.values
        c.turn_rule[pending] = rotary.turn_rule
        c.vector[pending] = math.nan if vector is None else self.vector_map @ vector
        self.modal.feed.set(row, self.programmed_feed)
        c.n += 1
        self.programmed_position = end
        self._rotary_unresolved |= bool(bits & _ROTARY_WORDS)
        return True

    def add_lines(self, ends: Floats, bits: int) -> bool:
        """Add lines of one block to programmed positions (k, 3); the rest is as ``add_row`` has it."""
        if not within_limits(ends):
            self.note(Wording("NC310", "too_far"), Severity.ERROR)
            return False
        c, begin = self.columns, 0
        tips = ends @ self.position_map[:, :3].T + self.position_map[:, 3]
        while begin < len(ends):
            self._clear_if_full()
            stop = min(begin + c.free, len(ends))
            c.reserve(stop - begin)
            rows, pending = slice(c.n, c.n + stop - begin), slice(c.n - c.base, c.n - c.base + stop - begin)
            c.line[pending], c.block_number[pending] = self.line, self.block_number
            c.kind[rows], c.programmed[rows] = Kind.LINEAR, bits
            c.xyz[rows], c.rotary[rows] = tips[begin:stop], math.nan
            c.turn_rule[pending], c.vector[pending] = NO_ROTARY.turn_rule, math.nan
            self.modal.feed.set(c.n, self.programmed_feed)
            c.n += stop - begin
            begin = stop
        self.programmed_position = ends[-1]
        return True

    def _mapped(self, position: Floats) -> Floats:
        """Return a programmed position as a tool tip or slide positions, (3,) mm."""
        return np.asarray(self.position_map[:, :3] @ position + self.position_map[:, 3])

    def add_arc(self, row: int, centre: Floats, normal: Floats, radius: float, turns: int) -> None:
        """Record the circle of a row of kind ``Kind.ARC``, in the workpiece frame."""
        self._circles.add(row, centre, normal, radius, turns)
        self.turns += turns

    def add_spline(self, rows: SplineRows) -> None:
        """Record the spline in the workpiece frame for which rows stand."""
        self._splines.append(rows)
        if len(self._splines) >= _SPLINES_AT_A_TIME:
            self._collect_splines()

    def _collect_splines(self) -> None:
        """Put the splines so far into columns, which take a tenth of the memory."""
        self._spline_columns.append(Splines.of(self._splines))
        self._splines.clear()

    def add_spindle_hole(self, first: int, work: SpindleWork) -> None:
        """Record that the rows from ``first`` on are a hole whose cycle drives the spindle."""
        self._spindle_holes.append(SpindleHole(first, self.row, self.line, int(self.modal.file.current), work))

    def set_compensation_plane(self, normal: Floats | None) -> None:
        """Record the normal of the plane of radius compensation from the next row on; None: it is across the tool."""
        if normal is None:
            self.modal.compensation_plane.set(self.row, -1)
            return
        planes = self._compensation_planes
        if not planes or float(np.abs(planes[-1] - normal).max()) > _SAME_NORMAL:
            planes.append(normal)
        self.modal.compensation_plane.set(self.row, len(planes) - 1)

    def add_normal(self, normal: Floats) -> None:
        """Record the programmed surface normal (3,) of the last row."""
        self._normals.append((np.array([self.row - 1]), (self.vector_map @ normal)[None]))

    def record_plane(self, plane: Floats | None) -> None:
        """Record the tilted plane of the next rows, the map (3, 4) from programmed positions to the workpiece frame."""
        number = -1
        if plane is not None:
            number = self._plane_numbers.setdefault(plane.tobytes(), len(self._planes))
            if number == len(self._planes):
                self._planes.append(plane)
        self.modal.plane.set(self.row, number)

    # Scans

    def scan_limit(self) -> int:
        """Return the number of blocks that the next scan may read, at least 1 if ``columns`` has free rows."""
        self._clear_if_full()
        c = self.columns
        return min(c.capacity - c.n, c.free, MAX_BLOCKS)

    def execute_scanned(self, count: int, settings: ScanSettings) -> ScannedRows:
        """Execute the first ``count`` blocks of ``words``, which begin at ``line``."""
        c, records, first = self.columns, self._records, self.row
        feed_before, self._commanded[4] = self.programmed_feed, self.modal.feed.current
        rows = RowColumns(c.kind, c.programmed, c.xyz, c.rotary, c.base, c.line, c.block_number, c.vector, c.turn_rule)
        c.n, comments, feeds, normals = execute_blocks(
            count, self.line, first, self.words, settings, self._commanded, rows, records
        )
        bits = int(np.bitwise_or.reduce(c.programmed[first : c.n]))
        self._rotary_unresolved |= bool(bits & _ROTARY_WORDS)
        self.modal.feed.extend(records.feed_rows[:feeds], records.feed_values[:feeds])
        if normals:
            self._normals.append((records.normal_rows[:normals].copy(), records.normals[:normals].copy()))
        return ScannedRows(
            range(first, c.n),
            bits,
            records.comments[:comments],
            feed_before,
            records.feed_rows[:feeds],
            records.feed_values[:feeds],
        )

    # Axis positions

    def resolve_rows(self) -> None:
        """Determine the axis positions after the rows so far."""
        c = self.columns
        if c.resolved == c.n:
            return
        self.resolutions += 1
        rows, pending = slice(c.resolved, c.n), slice(c.resolved - c.base, c.n - c.base)
        xyz, words = c.xyz[rows], RotaryWords(c.rotary[rows], c.turn_rule[pending], c.vector[pending])
        status = resolve_rotary(
            self.machine,
            self._kinematics,
            words,
            self.current_joints[list(self.machine.rotary)],
            xyz if self.tip_programmed else None,
            self.deciding_axis,
        )
        self.modal.xyz_is_tip.set(c.resolved, self.tip_programmed)
        self._report(status, c.resolved - c.base)
        xyz_is_tip = np.array([self.tip_programmed])
        joints = joints_from_rows(self.machine, self._kinematics, xyz_is_tip, xyz[-1:], words.rotary[-1:])[0]
        self.current_joints = np.where(np.isfinite(joints), joints, self.current_joints)
        c.resolved = c.n
        self._rotary_unresolved = False

    def _clear_if_full(self) -> None:
        if not self.columns.free:
            self.resolve_rows()
            self.columns.clear()

    def _report(self, status: Codes, first: int) -> None:
        wordings = (
            (OUT_OF_TRAVEL, Wording("NC350", "axis_outside_travel")),
            (NO_ROTARY_SOLUTION, Wording("NC350", "no_position_for_axis")),
            (NO_SLIDE_SOLUTION, Wording("NC310", "out_of_reach")),
        )
        if not status.any():
            return
        here = self.line
        for row in np.flatnonzero(status):
            self.line = int(self.columns.line[first + row])
            for bit, wording in wordings:
                if status[row] & bit:
                    self.note(wording, Severity.WARNING if bit == OUT_OF_TRAVEL else Severity.ERROR)
        self.line = here

    # The end

    def finish(self, files: Sequence[str], comments: list[Comment], diagnostics: Sequence[Diagnostic]) -> Run:
        """Return the run once all rows are resolved; no row may follow."""
        c = self.columns
        c.clear()
        n = c.n
        self._collect_splines()
        return Run(
            machine=self.machine,
            files=tuple(files),
            lines=c.lines.ramps(),
            block_numbers=c.block_numbers.ramps(),
            kind=c.kind[:n],
            programmed=c.programmed[:n],
            xyz=c.xyz[:n],
            rotary=c.rotary[:n],
            state=self.modal.state(n),
            start=self.start,
            arcs=self._circles.joined(),
            splines=Splines.joined(self._spline_columns),
            normals=self._normal_columns(),
            tools=tuple(self.tools),
            comments=comments,
            events=[*self.events, *self.left_variables],
            diagnostics=tuple(diagnostics),
            units_from=self.units_from,
            spindle_holes=tuple(self._spindle_holes),
            compensation_planes=np.array(self._compensation_planes).reshape(-1, 3),
            planes=np.array(self._planes).reshape(-1, 3, 4),
            mode_words=tuple(self.mode_words),
            assumed_modes=assumed_modes(self.machine, self.start_modes, self._relied()),
        )

    def _relied(self) -> Relied:
        n, c = self.columns.n, self.columns
        in_machine = self.modal.machine_frame.part(0, n)
        tcp = self.modal.tcp.part(0, n)
        return Relied(self.said_from, self.relied_from, c.kind[:n], c.programmed[:n], in_machine, tcp)

    def _normal_columns(self) -> SurfaceNormals:
        if not self._normals:
            return SurfaceNormals.empty()
        rows, vectors = zip(*self._normals, strict=True)
        return SurfaceNormals(np.concatenate(rows), np.concatenate(vectors))


def within_limits(point: Floats) -> bool:
    """Whether some machine could reach a point; NaN is nowhere."""
    if point.ndim == 1:  # one of many: numpy's way costs more than the three comparisons
        return all(-MAX_POSITION < value < MAX_POSITION for value in point.tolist())
    return float(np.abs(point).max()) < MAX_POSITION
