"""The state of the CL reader between two statements: the operation being read, the row, and what is modal."""

from dataclasses import dataclass, field, replace

from trunnion.cl.builder import MoveColumns, OperationBuilder, SurfaceSpeed
from trunnion.cl.diagnostics import Diagnostics
from trunnion.cl.statement import Statement
from trunnion.model.toolpath import CycleOn, Event, SpindleOn, UnknownStatement

MM_PER_INCH = 25.4

#: Feed words: mm in the length unit that they name, and whether the feed is per revolution.
FEED_UNITS = {"MMPM": (1.0, False), "MMPR": (1.0, True), "IPM": (MM_PER_INCH, False), "IPR": (MM_PER_INCH, True)}


@dataclass(slots=True)
class ReaderState:
    """What the handlers of statements (``trunnion.cl.statements``) read and change.

    strict           an unknown statement is an error
    builders         the operations that are complete
    builder          the operation being read; outside of operations one without a name, which the next one takes over
    in_operation     between TOOL PATH and END-OF-PATH
    part             name of the part
    line, row        line of the statement, and the row of the columns before which it stands
    has_row          the statement is a motion, and ``row`` is reserved for it
    length_unit      mm and line of the UNITS statement
    feed_factor      mm in the modal length unit of feeds
    feed_per_rev     feeds are per revolution
    feed_inverse     feeds are one over the minutes of a move
    bare_feeds       feeds are in units of the file: no FEDRAT has named one yet
    first_mm_feed    line of the first feed in mm, 0 if there is none
    first_inch_feed  line of the first feed in inches, 0 if there is none
    spindle, cycle   last ones of the operation, which SPINDL/ON and CYCLE/ON repeat
    spline_reported  the file has splines, and an error says so
    """

    columns: MoveColumns
    diagnostics: Diagnostics
    strict: bool
    builders: list[OperationBuilder] = field(default_factory=list)
    builder: OperationBuilder = field(default_factory=lambda: OperationBuilder("", 0, 0))
    in_operation: bool = False
    part: str = ""
    line: int = 0
    row: int = 0
    has_row: bool = False
    length_unit: tuple[float, int] | None = None
    feed_factor: float = 1.0
    feed_per_rev: bool = False
    feed_inverse: bool = False
    bare_feeds: bool = True
    first_mm_feed: int = 0
    first_inch_feed: int = 0
    spindle: SpindleOn | SurfaceSpeed | None = None
    cycle: CycleOn | None = None
    spline_reported: bool = False

    @property
    def operation_row(self) -> int:
        """Row within the operation."""
        return self.row - self.builder.first

    def add(self, event: Event) -> None:
        """Add an event to the operation."""
        self.builder.events.append(event)

    def note_feed_unit(self, word: str) -> None:
        """Remember the first line with a feed in mm, and in inches: they tell the unit of a file without UNITS."""
        if FEED_UNITS[word][0] == 1.0:
            self.first_mm_feed = self.first_mm_feed or self.line
        else:
            self.first_inch_feed = self.first_inch_feed or self.line

    def note_unknown(self, statement: Statement, what: str, *words: str) -> None:
        """Note that a statement, or some ``words`` of it, are not known: one event a statement, which says why."""
        events = self.builder.events
        if self.strict:
            self.diagnostics.error(self.line, what, "remove the statement, or read without strict")
        found = UnknownStatement(self.operation_row, self.line, statement.source, words, what)
        for k in range(len(events) - 1, -1, -1):
            before = events[k]
            if before.line != self.line:
                break
            if isinstance(before, UnknownStatement):
                events[k] = replace(found, words=before.words + words, what=f"{before.what}; {what}")
                return
        self.add(found)

    def close_operation(self) -> None:
        """Finish the operation being read."""
        self.builder.stop = self.row
        self.builders.append(self.builder)
        self.builder = OperationBuilder("", self.line, self.row)
        self.in_operation = False

    def report_motion_outside(self) -> None:
        """Report rows that belong to no operation."""
        self.diagnostics.error(
            int(self.columns.line[self.builder.first]),
            "motion outside any operation",
            "write TOOL PATH/name,TOOL,tool before it and END-OF-PATH behind it",
        )
