"""The state of the CL reader between two statements: the operation being read, the row, and what is modal."""

from dataclasses import field, replace
from typing import Any, NamedTuple, TypeVar

from trunnion.cl.builder import AxisStatement, MoveColumns, NoAxis, OperationBuilder, SurfaceSpeed
from trunnion.cl.conventions import Conventions
from trunnion.cl.diagnostics import Diagnostics, StatementError
from trunnion.cl.statement import Statement
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import CycleOff, CycleOn, Event, LoadTool, SpindleOn, UnknownStatement
from trunnion.records import dataclass

MM_PER_INCH = 25.4
MM_PER_FOOT = 304.8

#: Feed words: mm in the length unit that they name, and whether the feed is per revolution.
FEED_UNITS = {
    "MMPM": (1.0, False),
    "MMPR": (1.0, True),
    "IPM": (MM_PER_INCH, False),
    "IPR": (MM_PER_INCH, True),
    "FPM": (MM_PER_FOOT, False),
    "FPR": (MM_PER_FOOT, True),
}

#: Feed words without a unit of their own: feeds in the length unit of the file.
FILE_UNIT_FEEDS = {"PERMIN": False, "PERREV": True}

#: What operations state once (``ReaderState.state_once``), and are compared by elsewhere.
TOOL_NUMBER = "number of the tool"
LENGTH_REGISTER = "length register"
COORDINATE_SYSTEM = "coordinate system"

#: Numbers of a coordinate system are printed with five decimals or more.
_SAME_SYSTEM = 2e-5

_Own = TypeVar("_Own")


class ArcDirection(NamedTuple):
    """An INDIRV: the row of the arc that must follow, and the direction in which that begins."""

    row: int
    line: int
    vector: tuple[float, ...]

    def report_lost_arc(self, diagnostics: Diagnostics) -> None:
        """Report that the motion behind it, if any, is no arc."""
        diagnostics.error(self.line, Wording("CL560", "indirv_without_arc"))


@dataclass(slots=True, eq=False)
class ReaderState:
    """What the handlers of statements (``trunnion.cl.statements``) read and change.

    dialect          the conventions of the dialect
    strict           an unknown statement is an error
    builders         the operations that are complete
    builder          the operation being read; outside of operations one without a name, which the next one takes over
    in_operation     between TOOL PATH and END-OF-PATH
    part             name of the part
    line, row        line of the statement, and the row of the columns before which it stands
    has_row          the statement is a motion, and ``row`` is reserved for it
    end_row          row before which FINI or END stands, -1 if none has come
    length_unit      mm and line of the UNITS statement
    feed_factor      mm in the modal length unit of feeds
    feed_per_rev     feeds are per revolution
    feed_inverse     feeds are one over the minutes of a move
    bare_feeds       feeds are in units of the file: no FEDRAT has named one yet
    first_mm_feed    line of the first feed in mm, 0 if there is none
    first_inch_feed  line of the first feed in inches, 0 if there is none
    spindle, cycle   last ones of the operation, which SPINDL/ON and CYCLE/ON repeat
    turned_left      the operation before, if its spindle turned counter-clockwise last; else empty
    cycle_line       line where the cycle began that is on, 0 if none is
    tool             the last LoadTool of the file
    no_axis          the tool axis of a point that gives none
    vectors          what points give behind their coordinates are tool axes
    direction        the INDIRV whose arc has not followed yet
    turns            turns of all arcs so far
    clearance        height of the clearance plane
    stock            kind and numbers of the stock, in units of the file; None: it gives none
    system           the coordinate system of the points as the file gives it, empty if it gives none
    """

    columns: MoveColumns
    diagnostics: Diagnostics
    dialect: Conventions
    strict: bool
    builders: list[OperationBuilder] = field(default_factory=list)
    builder: OperationBuilder = field(default_factory=lambda: OperationBuilder("", 0, 0))
    in_operation: bool = False
    part: str = ""
    line: int = 0
    row: int = 0
    has_row: bool = False
    end_row: int = -1
    length_unit: tuple[float, int] | None = None
    feed_factor: float = 1.0
    feed_per_rev: bool = False
    feed_inverse: bool = False
    bare_feeds: bool = True
    first_mm_feed: int = 0
    first_inch_feed: int = 0
    spindle: SpindleOn | SurfaceSpeed | None = None
    turned_left: str = ""
    cycle: CycleOn | None = None
    cycle_line: int = 0
    tool: LoadTool | None = None
    no_axis: NoAxis = NoAxis.MODAL
    vectors: bool = True
    direction: ArcDirection | None = None
    turns: int = 0
    clearance: float | None = None
    stock: tuple[str, tuple[float, ...]] | None = None
    system: tuple[float, ...] = ()
    _own: dict[type, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.no_axis, self.vectors = self.dialect.no_axis, self.dialect.vectors
        if not self.dialect.in_sections:
            self.builder.name, self.builder.line = "OPERATION 1", 1
            self.builder.axes.append(AxisStatement(0, 0, None, self.no_axis, self.vectors))
            self.builder.tilted = self.dialect.upright

    def own(self, kind: type[_Own]) -> _Own:
        """Return what the handlers of one dialect or one module keep: by its class, made when it is first asked for."""
        found: _Own | None = self._own.get(kind)
        if found is None:
            found = self._own[kind] = kind()
        return found

    @property
    def operation_row(self) -> int:
        """Row within the operation."""
        return self.row - self.builder.first

    def add(self, event: Event) -> None:
        """Add an event to the operation."""
        self.builder.events.append(event)

    def split_operation(self) -> None:
        """Begin another operation here, where the dialect has no sections; feed, tool and tool axis go on.

        Of a cycle that is on somebody must say whether it goes on. An operation without rows goes on itself.
        """
        before = self.builder
        if self.dialect.in_sections or self.row == before.first:
            return
        at = self.operation_row
        self.builder = OperationBuilder(
            f"OPERATION {len(self.builders) + 2}", self.line, self.row, continues=True, tool=before.tool,
            frame=before.frame, intol=before.intol, outtol=before.outtol,
            feeds=[feed._replace(row=0, is_kept=True) for feed in before.feeds[-1:]],
            rapids=[0] if at in before.rapids else [],
            starts=[start._replace(row=0) for start in before.starts if start.row == at],
            axes=[AxisStatement(0, self.line, None, self.no_axis, self.vectors)], tilted=before.tilted,
            open_cycle=self._open_cycle(),
        )  # fmt: skip
        self.cycle_line = 0
        before.stop = self.row
        self._check_tool(before)
        self.builders.append(before)

    def _open_cycle(self) -> CycleOn | None:
        """Return the cycle that is on, or that has been since the operation before, if it went on there."""
        if self.cycle_line:
            return self.cycle
        own = any(isinstance(event, CycleOn | CycleOff) for event in self.builder.events)
        return None if own else self.builder.open_cycle

    def name_operation(self, name: str) -> None:
        """Begin an operation with a name; what was stated for one without motion no longer counts."""
        self.split_operation()
        self.builder.name, self.builder.line, self.builder.named = name, self.line, True
        self.builder.stated.clear()

    def state_once(self, what: str, value: object) -> None:
        """Note what holds for the whole operation, also for its rows before this line.

        Raises ``StatementError`` if the operation has stated another value: which of them is meant is unknown.
        """
        line, before = self.builder.stated.setdefault(what, (self.line, value))
        if before != value:
            raise StatementError(Wording("CL320", "another_line_operation", subject=what, line=line))

    def load_tool(self, number: int, adjust: int) -> None:
        """Load a tool, at the beginning of an operation; a tool that is loaded already is not loaded again."""
        if not self.dialect.in_sections:
            is_loaded = self.tool is not None and self.tool.number == number and adjust in (0, self.tool.adjust)
            adjust = self.tool.adjust if self.tool is not None and is_loaded else adjust
            if is_loaded and self.operation_row:
                return
            self.split_operation()
        if self.operation_row == 0:
            self.state_once(TOOL_NUMBER, number)
            if adjust:
                self.state_once(LENGTH_REGISTER, adjust)
            self._leave_out_tools(number)
        self.tool = LoadTool(self.operation_row, self.line, number, adjust)
        self.add(self.tool)

    def _check_tool(self, builder: OperationBuilder) -> None:
        """Report an operation that states the number of its tool and cuts with another one."""
        line, number = builder.stated.get(TOOL_NUMBER, (0, 0))
        if line and self.tool is not None and self.tool.number != number and not self.dialect.in_sections:
            self.diagnostics.error(line, Wording("CL780", "tool_stated_not", number=number, loaded=self.tool.number))

    def _leave_out_tools(self, number: int) -> None:
        """Leave out tool changes before this one that belong to no operation, or to one without motion."""
        events = self.builder.events
        for event in [event for event in events if isinstance(event, LoadTool)]:
            events.remove(event)
            if event.number != number:
                self.diagnostics.remark(
                    event.line, Wording("CL780", "tool_loaded_does", number=event.number, next_number=number)
                )

    def set_axis(self, axis: tuple[float, float, float] | None, no_axis: NoAxis) -> None:
        """Set the tool axis of the rows that follow, and that of points that give none."""
        self.no_axis = no_axis
        self.builder.axes.append(AxisStatement(self.operation_row, self.line, axis, no_axis, self.vectors))

    def set_system(self, numbers: tuple[float, ...]) -> None:
        """Note the coordinate system of the points in that of the model, which must stay the same in a file.

        Whether rows or columns of such a matrix are its axes is settled for CATIA alone, whose dialect calls this once;
        points of two others cannot be put together.
        """
        if self.system and any(abs(a - b) > _SAME_SYSTEM for a, b in zip(self.system, numbers, strict=True)):
            raise StatementError(Wording("CL430", "coordinate_system_points"))
        self.system = numbers

    def note_feed_unit(self, word: str, feed: float) -> None:
        """Note the first line with a feed in mm, and in inches: they give the unit of a file without UNITS.

        Where UNITS stands, the first feed of the other unit is a remark: ``word`` may be a slip of the CAM system.
        """
        factor = FEED_UNITS[word][0]
        is_metric = factor == 1.0
        is_first = not (self.first_mm_feed if is_metric else self.first_inch_feed)
        if is_metric:
            self.first_mm_feed = self.first_mm_feed or self.line
        else:
            self.first_inch_feed = self.first_inch_feed or self.line
        if self.length_unit is not None and is_first and is_metric is not (self.length_unit[0] == 1.0):
            variant = "metric_in_inch_file" if is_metric else "inch_in_metric_file"
            said = {"word": word, "feed": feed, "value": feed * factor, "line": self.length_unit[1]}
            self.diagnostics.remark(self.line, Wording("CL716", variant, **said))

    def note_unknown(
        self, statement: Statement, what: Wording, *words: str, acts: bool = True, meant: tuple[str, ...] = ()
    ) -> None:
        """Note that a statement, or some ``words`` of it, are not known: one event a statement, which says why.

        ``acts``: it may change the machine, as all known statements with unknown words do. ``meant``: the words that it
        may be, damaged or in one line.
        """
        events = self.builder.events
        if "" in words:
            what = phrase("nothing_behind_comma", major=statement.major)
        if self.strict:
            self.diagnostics.error(self.line, Wording("CL210", "unknown_in_strict", unknown=what))
        found = UnknownStatement(self.operation_row, self.line, statement.source, words, what, acts, meant)
        for k in range(len(events) - 1, -1, -1):
            before = events[k]
            if before.line != self.line:
                break
            if isinstance(before, UnknownStatement):
                events[k] = replace(
                    found, words=before.words + words, what=phrase("both_faults", fault=before.what, other=what)
                )
                return
        self.add(found)

    def close_operation(self) -> None:
        """Finish the operation being read."""
        self.builder.stop = self.row
        self._check_tool(self.builder)
        self.builders.append(self.builder)
        self.builder = OperationBuilder("", self.line, self.row)
        self.in_operation = False

    def report_motion_outside(self) -> None:
        """Report rows that belong to no operation."""
        self.diagnostics.error(int(self.columns.line[self.builder.first]), Wording("CL350", "motion_outside_any"))
