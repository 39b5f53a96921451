"""What a control did with a program: columns with one row per motion, and the events between the rows.

A run stores what its blocks program and what a single row does not determine. Values that change seldom are stored by
their changes (``ModalState``). Linear axes, tips and tool axes follow from the machine's kinematics: ``positions`` and
``chunk`` compute them for some rows; the whole columns are computed on first access and cached.

Units: mm, degrees, unit vectors, rev/min; feeds in mm/min, mm/rev or 1/min according to ``feed_mode``.
Frame: the machine's workpiece frame, zeroed by the work offset; programmed frames and tilted planes are resolved.
"""

from collections.abc import Callable, Iterator
from dataclasses import field, fields
from enum import IntEnum, IntFlag
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines
from trunnion.concurrency import prefetch
from trunnion.errors import Severity
from trunnion.machines import Machine, forward, kinematic_parameters, tool_axes
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.columns import RampColumn, StepColumn
from trunnion.model.diagnostics import Diagnostic as Diagnostic
from trunnion.model.mode_words import ModeWord
from trunnion.model.run_columns import ModalState, SurfaceNormals
from trunnion.model.run_positions import PositionChunk as PositionChunk
from trunnion.model.run_positions import RowPositions as RowPositions
from trunnion.model.run_positions import joined_chunks
from trunnion.model.run_setups import RunSetups
from trunnion.model.spindle_work import SpindleHole
from trunnion.model.splines import Splines
from trunnion.model.stated_words import StatedWord
from trunnion.model.toolpath import Arcs
from trunnion.records import dataclass

#: Rows computed at a time: a few megabytes, and long enough that handing over to the other thread costs nothing.
CHUNK_ROWS = 16384


class ProgrammedWord(IntFlag):
    """The words that a block contains, as bits of ``Run.programmed``; FIRST and SECOND are the rotary axes."""

    X = 1
    Y = 2
    Z = 4
    FIRST = 8
    SECOND = 16
    VECTOR = 32
    FEED = 64


class Orientation(IntEnum):
    """How the tool axis moves within a block under TCP: rotary angles linear, or the vector on a great circle."""

    ANGLES = 0
    GREAT_CIRCLE = 1


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment of the program, without its delimiters, and the row that follows it; ``file`` as in ``Run.file``."""

    line: int
    before_row: int
    text: str
    file: int = 0


EventValue = float | str | tuple[float | str | None, ...] | None


def _plain_offset_name(number: int) -> str:
    """Name a work offset where the family has no words of its own."""
    return f"work offset {number}"


@dataclass(frozen=True, slots=True)
class RunEvent:
    """Something that happens before row ``before_row``, or after the last row where that is n.

    kind    one of the names in ``docs/reader.md``: tool, tool_change, spindle, coolant, dwell, stop, message, ...
    value   a number, a text or the values of a cycle, depending on the kind
    file    as in ``Run.file``
    tcp     TCP was on; the neighbouring rows do not always show it
    """

    line: int
    before_row: int
    kind: str
    value: EventValue = None
    file: int = 0
    tcp: bool = False


#: ``Run.work_offset`` where work offsets are suppressed and positions count from the machine's zero (G500).
NO_OFFSET = 500

#: ``ModalState.orientation`` before the program sets an ``Orientation``: a block with a vector moves on a great circle.
ORIENTATION_FROM_WORDS = 2


_Item = TypeVar("_Item", bound=np.generic)


def _whole(name: str, kind: type[_Item]) -> "cached_property[NDArray[_Item]]":
    """Return a property of ``Run``: a value of ``ModalState``, whose items are of a kind, as a whole column."""

    def column(run: "Run") -> NDArray[_Item]:
        column: StepColumn = getattr(run.state, name)
        return column.column()

    return cached_property(column)


@dataclass(frozen=True, slots=True, eq=False)
class SkippedRun:
    """What a program does while the switches of some levels of block skip (``/``) are on."""

    levels: frozenset[int]
    run: "Run"


@dataclass(frozen=True, eq=False)
class Run:
    """A program as the control of a machine ran it; columns have n rows and are read-only.

    Stored:

    lines          (n,)   RampColumn    line of the file, from 1
    block_numbers  (n,)   RampColumn    N number of the block, -1 where it has none
    kind           (n,)   uint8    a ``trunnion.model.toolpath.Kind``
    programmed     (n,)   uint8    ``ProgrammedWord`` bits
    xyz            (n, 3) float64  target of X, Y and Z, mm: the tool tip in the workpiece frame where
                                   ``state.xyz_is_tip``, else the positions of the linear axes X, Y and Z
    rotary         (n, 2) float64  positions of the rotary axes with all their turns, deg, order of ``machine.rotary``
    start          (5,)   float64  axis values before row 0
    splines                        the splines for which rows stand, tips in the workpiece frame
    normals                        a ``SurfaceNormals``: those of blocks that program them (LN)
    units_from                     row from which on the program has said mm or inches, or its control is known to
                                   count so; None: never
    assumed_modes                  words of modes, such as ``G90``, that hold at the first motion although neither the
                                   program nor the definition states them
    language                       the same for all programs whose words mean the same; empty: not known
    encoding                       of names and texts, as it was stated; empty: the likeliest for each line
    uses_length_numbers            programs select the tool length by a number (H), which is the column ``edge``
    work_offset_name               what programs of this control call a value of the column ``work_offset``
    compensation_planes  (k, 3)    unit normals of the planes in which radius compensation works, workpiece frame
    setups                         lengths and zeros where tools or work offsets have their own. None: ``machine`` has
                                   them throughout; else it is that of which the most is known
    planes         (k, 3, 4)       tilted planes and rotated frames in which positions are tips: maps from programmed
                                   positions to the workpiece frame
    spindle_holes                  the holes whose cycles drive the spindle: threads, oriented and stopped bores
    stated                         words and variables of which somebody has stated what they do or hold
    skipped                        the program with the switches of block skip on, in each combination of levels that is
                                   looked at (``skip_combinations``), all together first; in ``Run`` itself all are off

    Computed on first access:

    tip            (n, 3) float64  tool tip, mm, workpiece frame
    axis           (n, 3) float64  unit vector from tip to holder, workpiece frame
    line           (n,)   int32    ``lines`` as a whole column
    block_number   (n,)   int64    ``block_numbers`` as a whole column
    joints         (n, 5) float64  axis values as displayed, mm or deg, machine order; rotary values with all turns
    file           (n,)   uint16   index into ``files``: 0 is the program itself, others are its subprograms
    feed           (n,)   float64  NaN before the first F; rapids keep the last one
    feed_mode      (n,)   uint8    94 mm/min, 95 mm/rev, 93 inverse time (1/min)
    rpm            (n,)   float64  programmed spindle speed, 0 before the first S
    spindle        (n,)   int8     +1 M3, -1 M4, 0 off
    tool           (n,)   int32    index into ``tools``; 0, the empty name, before the first tool
    edge           (n,)   int32    D number, -1 before the first; Fanuc, LinuxCNC: H of the active length, else -1
    compensation   (n,)   int8     cutter radius compensation: +1 left (G41), -1 right (G42), 0 off; tips as programmed
    work_offset    (n,)   uint16   work offset as the program numbers it (G54, preset 2), 0 before the first
    tcp            (n,)   bool     tool centre point control is on
    machine_frame  (n,)   bool     the block programs positions of the machine axes: SUPA, G53, M91
    inches         (n,)   bool     lengths are programmed in inches (the columns are in mm)
    orientation    (n,)   uint8    an ``Orientation``: how the tool axis moves to this row
    """

    machine: Machine
    files: tuple[str, ...]
    lines: RampColumn
    block_numbers: RampColumn
    kind: Codes
    programmed: Codes
    xyz: Floats
    rotary: Floats
    state: ModalState
    start: Floats
    arcs: Arcs
    normals: SurfaceNormals = field(default_factory=SurfaceNormals.empty)
    splines: Splines = field(default_factory=Splines.empty)
    tools: tuple[str, ...] = ("",)
    comments: list[Comment] = field(default_factory=list)
    events: list[RunEvent] = field(default_factory=list)
    diagnostics: tuple[Diagnostic, ...] = ()
    language: str = ""
    encoding: str = ""
    uses_length_numbers: bool = False
    units_from: int | None = 0
    work_offset_name: Callable[[int], str] = field(default=_plain_offset_name)
    spindle_holes: tuple[SpindleHole, ...] = ()
    compensation_planes: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    planes: Floats = field(default_factory=lambda: np.zeros((0, 3, 4)))
    mode_words: tuple[ModeWord, ...] = ()
    assumed_modes: tuple[str, ...] = ()
    setups: RunSetups | None = None
    stated: tuple[StatedWord, ...] = ()
    skipped: tuple[SkippedRun, ...] = ()

    def __post_init__(self) -> None:
        for each in fields(self):
            column = getattr(self, each.name)
            if isinstance(column, np.ndarray):
                column.setflags(write=False)

    def __len__(self) -> int:
        return len(self.kind)

    def __repr__(self) -> str:
        """Return what matters in a notebook: the columns would fill pages."""
        name = self.files[0] if self.files else ""
        return f"Run({name!r}, {self.machine.key}, {len(self)} motions, {len(self.diagnostics)} diagnostics)"

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """The diagnostics that put the columns in doubt: words that are unknown or not executed."""
        return tuple(diagnostic for diagnostic in self.diagnostics if diagnostic.severity is Severity.ERROR)

    def with_skips(self, levels: frozenset[int]) -> "Run":
        """Return what the program does while the switches of some levels of block skip are on."""
        own = levels & self.skipped[0].levels if self.skipped else frozenset()
        return next((each.run for each in self.skipped if each.levels == own), self)

    # Some rows

    @property
    def first_without_units(self) -> int | None:
        """The first row that states a position before the program says whether it counts in mm or inches, if any."""
        positions = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)
        rows = np.flatnonzero((self.programmed[: self.units_from] & positions) != 0)
        return int(rows[0]) if len(rows) else None

    # Set-ups

    def machine_at(self, row: int) -> Machine:
        """Return the machine with the tool and the work offset of a row; -1: those of the first."""
        return self.machine if self.setups is None else self.setups.at(row).machine

    def length_of(self, tool: str) -> float | None:
        """Return the length of a tool as the machine is set up, mm; None: nobody has stated it."""
        return self.machine.tool_length if self.setups is None else self.setups.length_of(tool)

    def by_machine(self, rows: Ints) -> Iterator[tuple[Machine, Ints]]:
        """Yield the machines that rows run on, each with the indices of its rows."""
        if self.setups is None:
            yield self.machine, np.arange(len(rows))
        else:
            yield from self.setups.by_machine(rows)

    def forward_at(self, rows: Ints, joints: Floats) -> tuple[Floats, Floats]:
        """Return tips and tool axes (k, 3) at axis values (k, 5) within rows (k,)."""
        if self.setups is None:
            return forward(self.machine, joints)
        tip, axis = np.empty((len(rows), 3)), np.empty((len(rows), 3))
        for machine, at in self.by_machine(rows):
            tip[at], axis[at] = forward(machine, joints[at])
        return tip, axis

    def solved_at(self, rows: Ints, xyz_is_tip: Flags, xyz: Floats, rotary: Floats) -> Floats:
        """Return axis values (k, 5) within rows (k,), as ``joints_from_rows`` does."""
        if self.setups is None:
            return joints_from_rows(self.machine, kinematic_parameters(self.machine), xyz_is_tip, xyz, rotary)
        joints = np.empty((len(rows), 5))
        for machine, at in self.by_machine(rows):
            kinematics = kinematic_parameters(machine)
            joints[at] = joints_from_rows(machine, kinematics, xyz_is_tip[at], xyz[at], rotary[at])
        return joints

    def positions(self, rows: Ints) -> RowPositions:
        """Return axes and tool at the end of rows, in any order; row -1 is the start of the program."""
        if not len(self) or not len(rows):
            joints = np.tile(self.start, (len(rows), 1))
            return RowPositions(joints, *forward(self.machine, joints))
        xyz_is_tip = self.state.xyz_is_tip.at(rows)
        xyz = self.xyz[rows]
        joints = self.solved_at(rows, xyz_is_tip, xyz, self.rotary[rows])
        first = rows < 0
        joints[first] = self.start
        tip, axis = self.forward_at(rows, joints)
        xyz_is_tip &= ~first
        tip[xyz_is_tip] = xyz[xyz_is_tip]
        return RowPositions(joints, tip, axis)

    def chunk(self, first: int, end: int) -> PositionChunk:
        """Return axes and tool of consecutive rows, preceded by those of the row before: (end - first + 1) rows.

        Where another set-up comes into force within them, each row has the tip of its own; ``chunks`` yields none such.
        """
        return joined_chunks([self._chunk(*bounds) for bounds in self._in_one_setup(first, end)])

    def _in_one_setup(self, first: int, end: int) -> list[tuple[int, int]]:
        """Return the bounds of consecutive rows, divided where another set-up comes into force."""
        return [(first, end)] if self.setups is None else self.setups.divided(first, end)

    def _chunk(self, first: int, end: int) -> PositionChunk:
        machine, rows = self.machine_at(first), slice(max(first - 1, 0), end)
        xyz_is_tip = self.state.xyz_is_tip.part(rows.start, end).copy()
        xyz = self.xyz[rows]
        joints = joints_from_rows(machine, kinematic_parameters(machine), xyz_is_tip, xyz, self.rotary[rows])
        if first == 0:
            joints = np.concatenate((self.start[None], joints))
        elif self.machine_at(first - 1) is not machine:
            # The axes stay where the set-up before has put them; their tip is another one now.
            joints[0] = self.positions(np.array([first - 1])).joints[0]
            xyz_is_tip[0] = False
        if first and xyz_is_tip.all():
            return PositionChunk(joints, xyz, *tool_axes(machine, joints))
        tip, _ = forward(machine, joints)
        reached = tip[1:] if first == 0 else tip
        reached[xyz_is_tip] = xyz[xyz_is_tip]
        return PositionChunk(joints, tip, *tool_axes(machine, joints))

    def chunk_bounds(self, rows: int) -> list[tuple[int, int]]:
        """Return the bounds of the chunks of the first rows, each in one set-up."""
        parts = self._in_one_setup(0, rows) if rows else []
        return [
            (first, min(first + CHUNK_ROWS, end)) for begin, end in parts for first in range(begin, end, CHUNK_ROWS)
        ]

    def chunks(self) -> Iterator[tuple[int, int, PositionChunk]]:
        """Yield all rows, ``CHUNK_ROWS`` at a time: first row, row after the last, and their ``chunk``.

        Another thread computes the next chunk while the caller works on this one.
        """
        bounds = self.chunk_bounds(len(self))
        for (first, end), poses in zip(bounds, prefetch(lambda rows: self.chunk(*rows), bounds), strict=True):
            yield first, end, poses

    def orientation_between(self, first: int, end: int) -> Codes:
        """Return column ``orientation`` of consecutive rows."""
        set_by_program = self.state.orientation.part(first, end)
        vectors = (self.programmed[first:end] & int(ProgrammedWord.VECTOR)) != 0
        return np.where(set_by_program == ORIENTATION_FROM_WORDS, vectors, set_by_program).astype(np.uint8)

    # Whole columns

    @cached_property
    def line(self) -> Lines:
        """Line of the file of each row, from 1, (n,)."""
        return self.lines.column(np.int32)

    @cached_property
    def block_number(self) -> Ints:
        """N number of each block, (n,), -1 where it has none."""
        return self.block_numbers.column(np.int64)

    @cached_property
    def tip(self) -> Floats:
        """Tool tip at the end of each row, (n, 3), mm, workpiece frame."""
        return self._compute_column("tip", 3)

    @cached_property
    def axis(self) -> Floats:
        """Unit vectors from tip to holder, (n, 3), workpiece frame."""
        return self._compute_column("axis", 3)

    @cached_property
    def joints(self) -> Floats:
        """Axis values as displayed, (n, 5), mm or degrees, machine order; rotary values with all turns."""
        return self._compute_column("joints", 5)

    def _compute_column(self, name: str, width: int) -> Floats:
        column = np.empty((len(self), width))
        for first, end, poses in self.chunks():
            column[first:end] = getattr(poses, name)[1:]
        column.setflags(write=False)
        return column

    @cached_property
    def orientation(self) -> Codes:
        """How the tool axis moves to each row, (n,): an ``Orientation``."""
        column = self.orientation_between(0, len(self))
        column.setflags(write=False)
        return column

    file = _whole("file", np.uint16)
    feed = _whole("feed", np.float64)
    feed_mode = _whole("feed_mode", np.uint8)
    rpm = _whole("rpm", np.float64)
    spindle = _whole("spindle", np.int8)
    tool = _whole("tool", np.int32)
    edge = _whole("edge", np.int32)
    compensation = _whole("compensation", np.int8)
    work_offset = _whole("work_offset", np.uint16)
    tcp = _whole("tcp", np.bool_)
    machine_frame = _whole("machine_frame", np.bool_)
    inches = _whole("inches", np.bool_)
