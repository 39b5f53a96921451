"""The path that the CL files ask for: all operations end to end, in the coordinate system of the program.

In:     toolpaths, in the order in which they are cut.
Out:    the rows of all operations one after the other, without holes; and the holes.
Frame:  the program's: the coordinate system of the first operation that moves, or the absolute one of the CAM.
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.frames import TURNING_NOISE
from trunnion.model.toolpath import (
    Arcs,
    BlockSkip,
    CutterComp,
    Frame,
    Insert,
    Kind,
    LoadTool,
    Operation,
    Toolpath,
)
from trunnion.records import dataclass
from trunnion.verification.expected.frames import transform_to_frame
from trunnion.verification.expected.holes import Hole, HoleSource, holes_of_operation, without_holes, without_rows
from trunnion.verification.expected.skipped import rows_without_retract, skipped_stretches, without_stretches
from trunnion.verification.expected.spindle_and_tool import ExpectedSpindle, ExpectedSpindles, ExpectedTool
from trunnion.verification.expected.tolerances import Tolerances


@dataclass(frozen=True, slots=True)
class OperationSettings:
    """What the CL file leaves open about one operation.

    tool         tool number or name instead of that of LOAD/TOOL; empty: as in the CL file
    work_offset  54..59, 505..599, or 600 plus the P of G54.1; None: any, but the same throughout
    edge         number of the cutting edge (D); None: any
    last_edge    ADJUST of LOAD/TOOL up to this number is the cutting edge; 0: it is not
    radius_offset  what is added to the tool's number for the register of the radius
    """

    tool: str = ""
    work_offset: int | None = None
    edge: int | None = None
    radius_offset: int = 0
    last_edge: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """One operation within the expected path: rows ``first`` to ``end`` (exclusive), in the program's frame.

    ``kept`` has the row of the CL file's operation for each of its rows; None where all are here. ``whole`` is that
    operation with all of them.
    """

    file: str
    operation: Operation
    first: int
    tolerances: Tolerances
    settings: OperationSettings
    whole: Operation
    kept: Ints | None = None

    @property
    def end(self) -> int:
        """The row after its last."""
        return self.first + len(self.operation.moves)


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """One CL point; fields as the columns of ``trunnion.model.toolpath.Moves``."""

    tip: Floats
    axis: Floats
    kind: Kind
    feed: float
    line: int


@dataclass(frozen=True, slots=True)
class WrittenSpline:
    """A spline of the CL files that a program writes as such, by splines ``begin`` to ``begin + count - 1`` of the run.

    section, number  of the section, and of the spline in it
    first, last      rows of the run from the first point behind its start to its end
    """

    section: int
    number: int
    begin: int
    count: int
    first: int
    last: int


class ExpectedPath:
    """All operations of a program end to end: rows are counted through them, and holes are kept apart.

    ``hole_ends`` has, for each section, how many holes there are up to its end. ``written_splines`` are those that the
    program writes as such: each has one row here, that of its end, as an arc has. The path is that of an operator who
    has switched block skip on: rows and events of the OPSKIP with the numbers ``left_out`` are not there. They count
    through all operations. ``without_retract`` are lines of the CL files that leave the cut sideways then.
    ``assumes_unit``: a CL file is taken to be in mm, which nothing says.

    The columns of an operation are not copied; ``tip``, ``axis`` and the like gather some rows of them.
    """

    def __init__(
        self,
        toolpaths: Sequence[Toolpath],
        tolerances: Tolerances | Sequence[Tolerances] | Callable[[Operation], Tolerances],
        absolute: bool = False,
        settings_of: Callable[[str], OperationSettings] = lambda name: OperationSettings(),
        written_splines: Sequence[WrittenSpline] = (),
        *,
        left_out: frozenset[int] = frozenset(),
    ) -> None:
        self.assumes_unit = any(not path.states_unit for path in toolpaths)
        moving = [(path, operation) for path in toolpaths for operation in path.operations if len(operation.moves)]
        if not moving:
            file = toolpaths[0].file if toolpaths else "CL file"
            raise InputError(Problem(file, 0, Wording("NC180", "no_motion_compare")))
        frame = Frame() if absolute else moving[0][1].frame
        limits = _by_operation(tolerances, len(moving))
        sections: list[Section] = []
        found: list[Hole] = []
        hole_ends: list[int] = []
        without_retract = set[tuple[str, int]]()
        first = stretch = 0
        spindle: ExpectedSpindle | None = None
        tool = ExpectedTool(None)
        for (path, whole), limit_of in zip(moving, limits, strict=True):
            placed = transform_to_frame(frame, whole)
            limit = limit_of(placed)
            if left_out:
                own = range(stretch, stretch := stretch + len(list(skipped_stretches(placed))))
                complete = placed
                placed, skipped = without_stretches(complete, {k - own.start for k in own if k in left_out})
                rows = rows_without_retract(complete, skipped)
                without_retract.update((path.file, line) for line in complete.moves.line[rows].tolist())
                limit = _without_rows(limit, skipped)
            if whole.frame != frame:  # points of another coordinate system have the noise of turning
                limit = replace(limit, tip=limit.tip + TURNING_NOISE)
            operation, hole_rows = without_holes(placed)
            loads = [(event.number, event.adjust) for event in placed.events if isinstance(event, LoadTool)]
            settings = settings_of(placed.name)
            tool = ExpectedTool(*loads[-1]) if loads else tool
            tool = tool.of_operation(placed.tool.name, settings.tool)
            source = HoleSource(path.file, first, limit, tool, spindle)
            found += holes_of_operation(placed, hole_rows, source)
            spindle = ExpectedSpindles(placed, spindle).at(len(placed.moves))
            limit = _without_rows(limit, hole_rows)
            kept = np.flatnonzero(~hole_rows) if hole_rows.any() else None
            if (gone := _inside_splines(operation, written_splines, len(sections))) is not None:
                limit = _without_rows(limit, gone)
                operation = without_rows(operation, gone)
                kept = np.flatnonzero(~gone) if kept is None else kept[~gone]
            sections.append(Section(path.file, operation, first, limit, settings, placed, kept))
            hole_ends.append(len(found))
            first += len(operation.moves)
        self.sections: tuple[Section, ...] = tuple(sections)
        self.holes: tuple[Hole, ...] = tuple(found)
        self.hole_ends: tuple[int, ...] = tuple(hole_ends)
        self.without_retract = frozenset(without_retract)
        self.written_splines: tuple[WrittenSpline, ...] = tuple(written_splines)
        self.first_rows: Ints = np.array([section.first for section in sections], np.int64)

    def __len__(self) -> int:
        return self.sections[-1].end

    def with_sections(self, sections: Sequence[Section]) -> "ExpectedPath":
        """Return the same path with other tool axes and feeds in its sections."""
        changed = copy(self)
        changed.sections = tuple(sections)
        return changed

    # Columns, at increasing rows

    def tip(self, rows: Ints) -> Floats:
        """Tips, (k, 3), mm."""
        return self._gather("tip", rows)

    def axis(self, rows: Ints) -> Floats:
        """Tool axes, (k, 3), unit vectors."""
        return self._gather("axis", rows)

    def kind(self, rows: Ints) -> Codes:
        """Kinds, (k,) uint8, a ``Kind`` each."""
        return self._gather("kind", rows)

    def feed(self, rows: Ints) -> Floats:
        """Return feeds, (k,), mm/min or mm/rev."""
        return self._gather("feed", rows)

    def per_rev(self, rows: Ints) -> Flags:
        """Whether the feeds are per revolution, (k,)."""
        return self._gather("per_rev", rows)

    def line(self, rows: Ints) -> Lines:
        """Lines of the CL file, (k,) int32."""
        return self._gather("line", rows)

    def _gather(self, name: str, rows: Ints) -> NDArray[Any]:
        if len(rows) and rows[-1] < (section := self.section_at(int(rows[0]))).end:
            column: NDArray[Any] = getattr(section.operation.moves, name)
            first, last = int(rows[0]) - section.first, int(rows[-1]) - section.first
            # A row with intermediate points stands several times, and others may be missing.
            if column.ndim == 1 and last - first == len(rows) - 1 and (np.diff(rows) == 1).all():
                return column[first : last + 1]
            return column[rows - section.first]
        by_section = zip(self.sections, np.split(rows, np.searchsorted(rows, self.first_rows[1:])), strict=True)
        return np.concatenate(
            [getattr(section.operation.moves, name)[some - section.first] for section, some in by_section]
        )

    def point(self, row: int) -> Point:
        """One row."""
        section = self.section_at(row)
        moves, k = section.operation.moves, row - section.first
        return Point(moves.tip[k], moves.axis[k], Kind(int(moves.kind[k])), float(moves.feed[k]), int(moves.line[k]))

    def section_at(self, row: int) -> Section:
        """Return the section that a row belongs to."""
        return self.sections[int(np.searchsorted(self.first_rows, row, "right")) - 1]

    @cached_property
    def arcs(self) -> Arcs:
        """All circles, with rows counted through all operations."""
        if len(self.sections) == 1:
            return self.sections[0].operation.arcs
        each = [(section.first, section.operation.arcs) for section in self.sections]
        return Arcs(
            np.concatenate([first + arcs.row for first, arcs in each]),
            np.concatenate([arcs.centre for _, arcs in each]),
            np.concatenate([arcs.normal for _, arcs in each]),
            np.concatenate([arcs.radius for _, arcs in each]),
            np.concatenate([arcs.full_turns for _, arcs in each]),
        )

    @cached_property
    def hole_exits(self) -> dict[int, tuple[Floats, Floats]]:
        """Row after holes -> tip and tool axis at which the last of these holes leaves the tool."""
        return {hole.row: (hole.exit_tip, hole.axis) for hole in self.holes}

    @property
    def rapid_count(self) -> int:
        """How many rows are rapids."""
        return sum(int(np.count_nonzero(section.operation.moves.kind == Kind.RAPID)) for section in self.sections)

    @property
    def max_tip_tolerance(self) -> float:
        """The largest tip tolerance of all operations, mm."""
        return max(section.tolerances.tip for section in self.sections)

    @cached_property
    def behind_skipped(self) -> frozenset[int]:
        """Rows right behind those that an OPSKIP lets the operator skip."""
        return self._at_skips(on=False)

    @cached_property
    def first_skipped(self) -> frozenset[int]:
        """The first rows of those that an OPSKIP lets the operator skip."""
        return self._at_skips(on=True)

    def _at_skips(self, *, on: bool) -> frozenset[int]:
        return frozenset(
            section.first + event.row
            for section in self.sections
            for event in section.operation.events
            if isinstance(event, BlockSkip) and event.on == on and event.row < len(section.operation.moves)
        )

    @cached_property
    def insert_counts(self) -> dict[int, int]:
        """Row -> number of INSERT statements before it."""
        count: dict[int, int] = {}
        for section in self.sections:
            for event in section.operation.events:
                if isinstance(event, Insert):
                    count[section.first + event.row] = count.get(section.first + event.row, 0) + 1
        return count

    @property
    def insert_texts(self) -> set[str]:
        """Texts of the INSERT statements, which stand in the program as they are."""
        return {
            event.text.strip()
            for section in self.sections
            for event in section.operation.events
            if isinstance(event, Insert)
        }

    @property
    def uses_compensation(self) -> bool:
        """Whether any operation asks for cutter radius compensation."""
        return any(
            isinstance(event, CutterComp) and event.side != "OFF"
            for section in self.sections
            for event in section.operation.events
        )


def _without_rows(limit: Tolerances, gone: Flags) -> Tolerances:
    """Return tolerances whose deviations count without some rows (n,)."""
    if limit.deviations is None or not gone.any():
        return limit
    return replace(limit, deviations=limit.deviations.without_rows(gone))


def _inside_splines(operation: Operation, written: Sequence[WrittenSpline], section: int) -> Flags | None:
    """Return the rows between start and end of the splines that are written, (n,); None: there are none."""
    numbers = [spline.number for spline in written if spline.section == section]
    if not numbers:
        return None
    gone = np.zeros(len(operation.moves), np.bool_)
    for k in numbers:
        first, last, _ = operation.splines[k]
        gone[first:last] = True
    return gone


def _by_operation(
    tolerances: Tolerances | Sequence[Tolerances] | Callable[[Operation], Tolerances], count: int
) -> list[Callable[[Operation], Tolerances]]:
    """Return how to get the tolerances of each operation."""
    if callable(tolerances):
        return [tolerances] * count
    each = [tolerances] * count if isinstance(tolerances, Tolerances) else list(tolerances)
    if len(each) != count:
        raise ValueError(f"{len(each)} tolerances for {count} operations")
    return [partial(_given, tolerance) for tolerance in each]


def _given(tolerances: Tolerances, operation: Operation) -> Tolerances:
    return tolerances
