"""What all writers of CL files have in common: the order of statements, and those that every dialect has.

In:     a toolpath, lengths in mm.
Out:    UTF-8 lines; points by a compiled kernel in chunks, the statements between them as text.

A dialect is a subclass. None of it is shared with the readers: what one writes, the other must understand by itself.
"""

import codecs
from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field, replace
from typing import BinaryIO, ClassVar

import numpy as np

from trunnion.cl.writers.checks import is_detected_as_utf8, joined, problems_of
from trunnion.cl.writers.lengths import INCH, in_unit
from trunnion.cl.writers.points import PointForm, axis_texts, encode_lines, number_text, write_points
from trunnion.errors import InputError, Problem, warning
from trunnion.messages import Wording
from trunnion.model.toolpath import (
    Arcs,
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    From,
    GoHome,
    Insert,
    Kind,
    LoadTool,
    Message,
    Moves,
    Operation,
    SelectTool,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    Toolpath,
    UnknownStatement,
)
from trunnion.records import dataclass

#: A line of a statement is no longer, where a dialect divides its statements.
_LINE = 72

#: What becomes of ``Toolpath.system`` in another dialect.
UNSETTLED_SYSTEM = Wording("CL930", "unsettled_system")


@dataclass(slots=True)
class _RowStatements:
    """The statements before a row.

    axis      the tool axis that they make modal, if they do
    is_point  the last of them is the row itself
    """

    lines: list[str] = field(default_factory=list)
    axis: tuple[float, float, float] | None = None
    is_point: bool = False


class ClWriter(ABC):
    """Writes toolpaths in one dialect.

    name      of the dialect
    title     of what it is, for messages
    slash     between the word of a statement and its values
    comma     between two values
    form      of a point
    has_stock  a file says what the stock is
    has_work_offsets  an operation says in which work offset it is
    """

    name: ClassVar[str]
    title: ClassVar[str]
    slash: ClassVar[str] = "/"
    comma: ClassVar[str] = ","
    form: ClassVar[PointForm] = PointForm()
    divides_lines: ClassVar[bool] = True
    has_stock: ClassVar[bool] = False
    has_work_offsets: ClassVar[bool] = False

    def __init__(self, toolpath: Toolpath, *, inch: bool = False) -> None:
        self.remarks: list[Problem] = []
        self.source = toolpath
        if toolpath.stock and not self.has_stock:
            self.remark(0, Wording("CL930", "stock", title=self.title))
        if not self.has_work_offsets and any(operation.work_offset for operation in toolpath.operations):
            self.remark(0, Wording("CL930", "work_offsets", title=self.title))
            without = tuple(replace(operation, work_offset=0) for operation in toolpath.operations)
            toolpath = replace(toolpath, operations=without)
        self.toolpath = self.prepared(toolpath)
        self.inch = inch

    def prepared(self, toolpath: Toolpath) -> Toolpath:
        """Return the toolpath as the dialect can say it; what it cannot say goes to ``remarks``."""
        return toolpath

    def problems(self, comments: Sequence[str]) -> list[Problem]:
        """Everything that keeps the toolpath from being written."""
        found = problems_of(self.toolpath, comments)
        return found + [problem for operation in self.toolpath.operations for problem in self.losses(operation)]

    def losses(self, operation: Operation) -> Iterator[Problem]:
        """Motion, tools and cycles that the dialect has no words for."""
        yield from ()

    def write(self, sink: BinaryIO, comments: Iterable[str] = ()) -> None:
        """Write the file.

        Raises
        ------
        InputError
            Before anything is written, if the dialect cannot hold the toolpath.
        """
        comments = tuple(comments)
        if problems := self.problems(comments):
            raise InputError(problems)
        if not is_detected_as_utf8(self.toolpath, comments):
            sink.write(codecs.BOM_UTF8)
        sink.write(encode_lines(self.head(comments)))
        for number, operation in enumerate(self.toolpath.operations, 1):
            if self.inch or self.toolpath.unit != 1.0:
                operation = in_unit(operation, INCH if self.inch else 1.0)
            self._write_operation(number, operation, sink)
        sink.write(encode_lines(self.foot()))

    def _write_operation(self, number: int, operation: Operation, sink: BinaryIO) -> None:
        moves = operation.moves
        sink.write(encode_lines(self.begin(number, operation)))
        before = self._statements(operation)
        done = 0
        modal_axis = np.array([0.0, 0.0, 1.0])
        for row in sorted({*before, len(moves)}):
            write_points(moves, done, row, self.form, modal_axis, sink)
            done = row
            if row in before:
                sink.write(encode_lines(before[row].lines))
                if (axis := before[row].axis) is not None:
                    modal_axis[:] = axis
                done += before[row].is_point
        sink.write(encode_lines(self.end(operation)))

    def _statements(self, operation: Operation) -> dict[int, _RowStatements]:
        """Row -> the statements before it: events, colour, feed, RAPID and arc."""
        moves, arcs = operation.moves, operation.arcs
        found: defaultdict[int, _RowStatements] = defaultdict(_RowStatements)
        events = _written_events(operation)
        for event in (event for event in events if event.row == 0):
            self._add_event(found, event)
        for row, line in self.colours(operation):
            found[row].lines.append(line)
        for event in sorted((event for event in events if event.row > 0), key=lambda event: event.row):
            self._add_event(found, event)
        for row in _feed_rows(moves):
            found[row].lines += self.feed(float(moves.feed[row]), per_rev=bool(moves.per_rev[row]))
        for row in np.flatnonzero(moves.kind == Kind.RAPID).tolist():
            found[row].lines.append("RAPID")
        for index, row in enumerate(arcs.row.tolist()):
            lines, is_point = self.arc(operation, index)
            found[row].lines += lines
            found[row].is_point = is_point
        return found

    def _add_event(self, found: dict[int, _RowStatements], event: Event) -> None:
        found[event.row].lines += self.event(event)
        if isinstance(event, From) and self.form == PointForm():
            found[event.row].axis = event.axis

    def statement(self, major: str, *values: str) -> list[str]:
        """Return a statement in one line, or in several that are continued."""
        lines, line = [], f"{major}{self.slash}"
        for n, value in enumerate(values):
            text = value + (self.comma if n + 1 < len(values) else "")
            if self.divides_lines and n and len(line) + len(text) > _LINE:
                lines.append(f"{line.rstrip()}$")
                line = "  "
            line += text
        return [*lines, line]

    def length(self, value: float) -> str:
        """Return a length as text."""
        return number_text(value, 6)

    def feed_unit(self, *, per_rev: bool) -> str:
        """Return the word of feeds."""
        return ("IPR" if per_rev else "IPM") if self.inch else ("MMPR" if per_rev else "MMPM")

    @abstractmethod
    def head(self, comments: Sequence[str]) -> list[str]:
        """Return the lines at the beginning of the file."""

    def foot(self) -> list[str]:
        """Return the lines at its end."""
        return []

    @abstractmethod
    def begin(self, number: int, operation: Operation) -> list[str]:
        """Return the lines at the beginning of an operation, the ``number``-th of the file."""

    @abstractmethod
    def end(self, operation: Operation) -> list[str]:
        """Return the lines at its end."""

    def colours(self, operation: Operation) -> list[tuple[int, str]]:
        """Rows, and the statements before them that give the phase."""
        return []

    def feed(self, value: float, *, per_rev: bool) -> list[str]:
        """Return the statement of a feed."""
        return self.statement("FEDRAT", number_text(value, 4), self.feed_unit(per_rev=per_rev))

    @abstractmethod
    def arc(self, operation: Operation, index: int) -> tuple[list[str], bool]:
        """Return the statement of an arc, and whether it has the end point in it."""

    def circle(self, arcs: Arcs, index: int) -> list[str]:
        """Centre, normal and radius of an arc as numbers."""
        numbers = [self.length(value) for value in arcs.centre[index].tolist()]
        numbers += [number_text(value, 7) for value in arcs.normal[index].tolist()]
        return [*numbers, number_text(float(arcs.radius[index]), 4)]

    @abstractmethod
    def load_tool(self, event: LoadTool) -> list[str]:
        """Return the statement that loads a tool."""

    @abstractmethod
    def select_tool(self, event: SelectTool) -> list[str]:
        """Return the statement that preselects a tool."""

    def spindle(self, event: SpindleOn) -> list[str]:
        """Return the statement that turns the spindle on."""
        return self.statement("SPINDL", "RPM", number_text(event.rpm, 4), event.sense.value)

    @abstractmethod
    def cycle(self, event: CycleOn) -> list[str]:
        """Return the statement that begins a cycle."""

    def message(self, event: Message) -> list[str]:
        """Return a text in the program, or on the display."""
        return [f"{'DISPLY' if event.display else 'PPRINT'}/{event.text}"]

    def mode(self, event: SetMode) -> list[str]:
        """Return a statement about the form of a program that every program fulfils."""
        major, *words = event.words
        return [major + (f"/{','.join(words)}" if words else "")]

    def event(self, event: Event) -> list[str]:
        """Return the statements of an event."""
        match event:
            case LoadTool():
                return self.load_tool(event)
            case SelectTool():
                return self.select_tool(event)
            case SpindleOn():
                return self.spindle(event)
            case CycleOn():
                return self.cycle(event)
            case Message():
                return self.message(event)
            case SetMode():
                return self.mode(event)
            case GoHome():
                return ["GOHOME"]
            case From():
                return self.statement("FROM", *(self.length(value) for value in event.tip), *axis_texts(event.axis))
            case UnknownStatement():
                return [joined(event.text)]
        return self._switch(event)

    def _switch(self, event: Event) -> list[str]:
        """Return the statements of events that all dialects write alike."""
        match event:
            case SpindleOff():
                return self.statement("SPINDL", "OFF")
            case Coolant():
                return self.statement("COOLNT", event.kind)
            case CutterComp():
                words = [event.side, event.plane, str(event.register or "")]
                return self.statement("CUTCOM", *(word for word in words if word))
            case Dwell():
                return self.statement("DELAY", number_text(event.amount, 3), *["REV"] * event.revolutions)
            case Stop():
                return [("OPSTOP" if event.optional else "STOP") + (f"/{event.text}" if event.text else "")]
            case Insert():
                return [f"INSERT/{event.text}"]
            case BlockSkip():
                return self.statement("OPSKIP", "ON" if event.on else "OFF")
            case CycleOff():
                return self.statement("CYCLE", "OFF")
        raise TypeError(type(event).__name__)

    def remark(self, line: int, wording: Wording) -> None:
        """Note what is lost."""
        self.remarks.append(warning(self.source.file, line, wording))


def _written_events(operation: Operation) -> tuple[Event, ...]:
    """Return the events without those that a statement says of which only some words are not known: it is written
    whole.
    """
    whole = {event.line for event in operation.events if isinstance(event, UnknownStatement) and event.words}
    if not whole:
        return operation.events
    return tuple(event for event in operation.events if isinstance(event, UnknownStatement) or event.line not in whole)


def _feed_rows(moves: Moves) -> list[int]:
    """Rows whose feed is not that of the row before; NaN is no feed yet."""
    last = np.concatenate(([np.nan], moves.feed[:-1]))
    last_per_rev = np.concatenate(([False], moves.per_rev[:-1]))
    changed = (moves.feed != last) | (moves.per_rev != last_per_rev)
    return [int(row) for row in np.flatnonzero(changed & ~np.isnan(moves.feed))]
