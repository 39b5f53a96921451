"""What the CL files ask for, in one row of columns: all operations, seen from the coordinate system of the program.

In:     toolpaths, in the order in which they are cut.
Out:    the rows of all operations one after the other, and from which row on which spindle, tool and coolant hold.
Frame:  the program's, which is the coordinate system of the first operation that moves, or the CAM's absolute one.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines
from trunnion.errors import InputError, Problem
from trunnion.model.deviations import Deviations
from trunnion.model.toolpath import (
    Arcs,
    Coolant,
    CutterComp,
    Frame,
    Insert,
    Kind,
    LoadTool,
    Moves,
    Operation,
    Sense,
    SpindleOff,
    SpindleOn,
    Toolpath,
)
from trunnion.verification.expected.holes import Hole, SpindleSpeed, cycle_holes, spindle_at, without_holes

#: Radius compensation to either side of the path.
_SIDES = {"LEFT": 1, "RIGHT": -1}


@dataclass(frozen=True, slots=True)
class Tolerances:
    """How far a program may be from its CL points: mm in each coordinate, degrees in each rotary axis.

    chord   distance of lines from the arc that they stand for, mm
    feed    of a feed from the CL file's, in its own unit
    agreed  where it may be otherwise
    centre  mm more for the centre of a circle, which a control may have to find by a radius
    normal  of a component of the surface's normal
    plane   the tool stands on a tilted plane, and its axis may be off as an angle by itself, whatever that comes to in
            a rotary axis: near a pole one of them is nearly free
    """

    tip: float = 0.001
    angle: float = 0.001
    chord: float = 0.001
    feed: float = 0.005
    deviations: Deviations | None = None
    centre: float = 0.0
    normal: float = 1e-6
    plane: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """An operation in the program's coordinate system; its first row is row ``first`` of the columns."""

    file: str
    operation: Operation
    first: int
    tolerances: Tolerances

    @property
    def end(self) -> int:
        """The row after its last."""
        return self.first + len(self.operation.moves)


@dataclass(frozen=True, slots=True)
class ExpectedSpindle:
    """What the spindle is to do: rev/min and +1 for clockwise, -1 for the other way, 0 for standing still."""

    rpm: float
    sense: int


@dataclass(frozen=True, slots=True)
class ExpectedTool:
    """The tool that is to be in the spindle; the number is None before the first LOAD/TOOL, ``adjust`` its register."""

    number: int | None
    adjust: int = 0
    name: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """What a program may call it."""
        return tuple(str(text) for text in (self.number, self.name) if text not in (None, ""))

    @property
    def lengths(self) -> tuple[int, ...]:
        """Numbers that its length may have: its own, or the register that LOAD/TOOL names."""
        return tuple(number for number in (self.number, self.adjust) if number)


def names_tool(text: str, names: tuple[str, ...]) -> bool:
    """Whether a program's word for a tool is one of its names."""
    return text in names or (text.isdigit() and str(int(text)) in names)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Rows ``first`` to ``end`` ask for ``value``."""

    first: int
    end: int
    value: object


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """One CL point; fields as the columns of ``trunnion.model.toolpath.Moves``."""

    tip: Floats
    axis: Floats
    kind: Kind
    feed: float
    line: int


class ExpectedPath:
    """All operations of a program, end to end. Their columns stay where they are; holes are kept apart."""

    def __init__(
        self, toolpaths: Sequence[Toolpath], tolerances: Tolerances | Sequence[Tolerances], absolute: bool = False
    ) -> None:
        moving = [(path, operation) for path in toolpaths for operation in path.operations if len(operation.moves)]
        if not moving:
            file = toolpaths[0].file if toolpaths else "CL file"
            raise InputError(Problem(file, 0, "there is no motion in it to compare with", "output the toolpath again"))
        limits = [tolerances] * len(moving) if isinstance(tolerances, Tolerances) else list(tolerances)
        if len(limits) != len(moving):
            raise ValueError(f"{len(limits)} limits for {len(moving)} operations")
        frame = Frame() if absolute else moving[0][1].frame
        sections: list[Section] = []
        found: list[Hole] = []
        first = 0
        spindle: SpindleSpeed | None = None
        call = ExpectedTool(None)
        for (path, whole), limit in zip(moving, limits, strict=True):
            seen = transform_to_frame(frame, whole)
            operation, rows = without_holes(seen)
            loads = [(event.number, event.adjust) for event in seen.events if isinstance(event, LoadTool)]
            call = ExpectedTool(*loads[-1], seen.tool.name) if loads else replace(call, name=seen.tool.name)
            tools = () if call.number is None else call.names
            holes = cycle_holes(seen, rows, first, path.file, limit.tip, spindle)
            found += [replace(hole, tools=tools, lengths=call.lengths, digit=limit.feed) for hole in holes]
            spindle = spindle_at(seen, len(seen.moves), spindle)
            if limit.deviations is not None and rows.any():
                limit = replace(limit, deviations=limit.deviations.without_rows(rows))
            sections.append(Section(path.file, operation, first, limit))
            first += len(operation.moves)
        self.sections: tuple[Section, ...] = tuple(sections)
        self.holes: tuple[Hole, ...] = tuple(found)
        self.first_rows: Ints = np.array([section.first for section in sections], np.int64)

    def __len__(self) -> int:
        return self.sections[-1].end

    def tip(self, rows: Ints) -> Floats:
        """Tips at growing rows, (k, 3), mm."""
        return self._taken("tip", rows)

    def axis(self, rows: Ints) -> Floats:
        """Tool axes at growing rows, (k, 3), unit vectors."""
        return self._taken("axis", rows)

    def kind(self, rows: Ints) -> Codes:
        """Kinds at growing rows, (k,) uint8, a ``Kind``."""
        return self._taken("kind", rows)

    def feed(self, rows: Ints) -> Floats:
        """Feeds at growing rows, (k,), mm/min or mm/rev."""
        return self._taken("feed", rows)

    def per_rev(self, rows: Ints) -> Flags:
        """Whether the feeds at growing rows are per turn, (k,)."""
        return self._taken("per_rev", rows)

    def line(self, rows: Ints) -> Lines:
        """Lines of the CL file at growing rows, (k,) int32."""
        return self._taken("line", rows)

    def _taken(self, name: str, rows: Ints) -> NDArray[Any]:
        if len(rows) and rows[-1] < (section := self.section_at(int(rows[0]))).end:
            column: NDArray[Any] = getattr(section.operation.moves, name)
            first, last = int(rows[0]) - section.first, int(rows[-1]) - section.first
            if column.ndim == 1 and last - first == len(rows) - 1:
                return column[first : last + 1]
            return column[rows - section.first]
        pieces = np.split(rows, np.searchsorted(rows, self.first_rows[1:]))
        taken = zip(self.sections, pieces, strict=True)
        return np.concatenate(
            [getattr(section.operation.moves, name)[piece - section.first] for section, piece in taken]
        )

    def point(self, row: int) -> Point:
        """One row."""
        section = self.section_at(row)
        moves, k = section.operation.moves, row - section.first
        return Point(moves.tip[k], moves.axis[k], Kind(int(moves.kind[k])), float(moves.feed[k]), int(moves.line[k]))

    @property
    def rapids(self) -> int:
        """How many rows are rapids."""
        return sum(int(np.count_nonzero(section.operation.moves.kind == Kind.RAPID)) for section in self.sections)

    @cached_property
    def arcs(self) -> Arcs:
        """The circles, rows counted through all operations."""
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

    def section_at(self, row: int) -> Section:
        """The operation that a row belongs to."""
        return self.sections[int(np.searchsorted(self.first_rows, row, "right")) - 1]

    @cached_property
    def hole_exits(self) -> dict[int, tuple[Floats, Floats]]:
        """Row -> tip and tool axis where the last hole before it leaves the tool, for rows right behind holes."""
        return {hole.row: (hole.tip + hole.retract * hole.axis, hole.axis) for hole in self.holes}

    @cached_property
    def inserts(self) -> dict[int, int]:
        """Row -> how many texts of the CL file's own (INSERT) stand before it."""
        count: dict[int, int] = {}
        for section in self.sections:
            for event in section.operation.events:
                if isinstance(event, Insert):
                    count[section.first + event.row] = count.get(section.first + event.row, 0) + 1
        return count

    @property
    def insert_texts(self) -> set[str]:
        """Texts that the CL file puts into the program as they stand."""
        return {e.text.strip() for p in self.sections for e in p.operation.events if isinstance(e, Insert)}

    @property
    def compensates(self) -> bool:
        """Whether cutter radius compensation is asked for anywhere."""
        return any(isinstance(e, CutterComp) and e.side != "OFF" for p in self.sections for e in p.operation.events)

    def spindle(self) -> list[Stretch]:
        """Stretches of ``ExpectedSpindle``, or None before the first SPINDL. Each operation starts with what was last
        on."""
        last: ExpectedSpindle | None = None
        stretches: list[Stretch] = []
        for section in self.sections:
            changes: list[tuple[int, object]] = [(0, last)]
            for event in section.operation.events:
                if isinstance(event, SpindleOn):
                    last = ExpectedSpindle(event.rpm, 1 if event.sense is Sense.CLW else -1)
                    changes.append((event.row, last))
                elif isinstance(event, SpindleOff):
                    changes.append((event.row, ExpectedSpindle(last.rpm if last else 0.0, 0)))
            stretches += _stretches(section, changes)
        return stretches

    def coolant(self) -> list[Stretch]:
        """Stretches of coolant words. Each operation starts without."""
        stretches: list[Stretch] = []
        for section in self.sections:
            changes: list[tuple[int, object]] = [(0, "OFF")]
            changes += [(event.row, event.kind) for event in section.operation.events if isinstance(event, Coolant)]
            stretches += _stretches(section, changes)
        return stretches

    def compensation(self) -> list[Stretch]:
        """Stretches of sides: 1 left, -1 right, 0 none. Each operation starts without; ON is the last side again."""
        stretches: list[Stretch] = []
        for section in self.sections:
            changes: list[tuple[int, object]] = [(0, 0)]
            last = 0
            for event in section.operation.events:
                if isinstance(event, CutterComp):
                    last = _SIDES.get(event.side, last)
                    changes.append((event.row, 0 if event.side == "OFF" else last))
            stretches += _stretches(section, changes)
        return stretches

    def tools(self) -> list[Stretch]:
        """Stretches of ``ExpectedTool``."""
        call = ExpectedTool(None)
        stretches: list[Stretch] = []
        for section in self.sections:
            call = replace(call, name=section.operation.tool.name)
            changes: list[tuple[int, object]] = [(0, call)]
            for event in section.operation.events:
                if isinstance(event, LoadTool):
                    call = ExpectedTool(event.number, event.adjust, call.name)
                    changes.append((event.row, call))
            stretches += _stretches(section, changes)
        return stretches


def _stretches(section: Section, changes: list[tuple[int, object]]) -> list[Stretch]:
    """From changes at rows of an operation, in order, to stretches; of several changes at one row the last counts."""
    ends = [row for row, _ in changes[1:]] + [len(section.operation.moves)]
    return [
        Stretch(section.first + row, section.first + end, value)
        for (row, value), end in zip(changes, ends, strict=True)
        if end > row
    ]


def transform_to_frame(frame: Frame, operation: Operation) -> Operation:
    """The operation in another coordinate system, by homogeneous matrices."""
    if operation.frame == frame:
        return operation
    change = np.linalg.inv(_placement(frame)) @ _placement(operation.frame)
    turn, shift = change[:3, :3], change[:3, 3]
    moves, arcs = operation.moves, operation.arcs
    return replace(
        operation,
        frame=frame,
        moves=Moves(
            np.ascontiguousarray(moves.tip @ turn.T + shift),
            np.ascontiguousarray(moves.axis @ turn.T),
            moves.kind,
            moves.phase,
            moves.feed,
            moves.per_rev,
            moves.line,
            None if moves.normal is None else moves.normal @ turn.T,
        ),
        arcs=Arcs(arcs.row, arcs.centre @ turn.T + shift, arcs.normal @ turn.T, arcs.radius, arcs.full_turns),
    )


def _placement(frame: Frame) -> Floats:
    """(4, 4): from coordinates in the frame to the CAM's absolute system."""
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1] = frame.x, frame.y
    matrix[:3, 2] = np.cross(frame.x, frame.y)
    matrix[:3, 3] = frame.origin
    return matrix
