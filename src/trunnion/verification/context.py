"""What checks are given: the run, the settings, and the expected path with its matching; and how they name places."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from itertools import islice

import numpy as np

from trunnion.arrays import Floats
from trunnion.compensation.stretches import RegisterValue
from trunnion.messages import Wording
from trunnion.model.axis_tolerance import AxisTolerance
from trunnion.model.run import ProgrammedWord, Run, RunEvent
from trunnion.records import dataclass
from trunnion.verification.block_names import block_name_of
from trunnion.verification.expected.path import ExpectedPath, OperationSettings
from trunnion.verification.matching.pairs import Matching
from trunnion.verification.results import Check, Place

#: Places that each check names.
MAX_PLACES = 8

#: How many rows back the block is searched that positioned the rotary axes.
_POSITIONING_WINDOW = 64


@dataclass(frozen=True, slots=True)
class ExpectedValues:
    """What a program is expected to be where the CL files leave it open.

    tool                   tool number or name instead of that of LOAD/TOOL; empty: as in the CL file
    work_offset            as in ``Run.work_offset``; None: any, but the same throughout
    edge                   number of the cutting edge (D); None: any
    last_edge              ADJUST of LOAD/TOOL up to this number is the cutting edge; 0: it is not
    radius_offset          what is added to the tool's number for the register of the radius
    register_holds         what radius compensation works with
    span                   how far the tool axis may be off between points, degrees; None: ``axis_tolerance``
    span_tip               how far the tip may be off its line between points without TCP, mm; None: reported, not
                           checked
    absolute               the program's coordinate system is the absolute one of the CAM, not that of the first
                           operation
    rapid_feed             feed of lines that replace rapids, mm/min; None: rapids are rapids
    below_rapid_feed       feed that cuts at that very feed have instead, mm/min; None: none
    max_inverse_time_feed  largest inverse-time F of the control: no block need be quicker; None: no limit
    smoothing              widest tolerance for the control's own smoothing that the settings ask for, mm
    rigid_tap              M code before threads that are cut without a compensating chuck; None: the control has none
    coolant                M number of each kind of coolant, as the control's definition states it
    tool_deltas            what the program may add to a tool, mm, by word (DL, DR)
    axis_tolerance         how far the tool axis may be off between points of a cut where ``span`` does not say it
    max_feed               largest F per minute of the control: no block need be faster; None: no limit
    blocks_in_compensation  most blocks in a row without motion in the plane within radius compensation
    stops_in_compensation  whether a stop may stand within it
    fastest_feed           feeds are those that the axes reach under the feeds of the CL files, or under ``feed_limit``
    feed_limit             greatest feed of cuts then, in place of those of the CL files, mm/min; None: theirs
    feeds_as_programmed    those of the program stand for the declaration of a post, which is not known
    by_operation           tool, work offset and edge of single operations, by their names
    swivel_data            names of the swivel data set (_TC of CYCLE800) that the settings give; empty: any
    clearance              how far above all operations the tool may go from one to the next, mm; None: it must not
    operation_clearance    how high above all operations the setting same_tool=clearance leads, mm, whether it is given
    in_turn                axes move one group after the other from home to an operation
    left_out               numbers of the OPSKIP of the CL files whose points are left out, counted through all of them
    stop_between           an optional stop stands between operations
    has_settings           names of the settings that the control has: only those can be told again
    texts                  lines of the definition's templates: what words the control's programs have anyhow
    demands                what the proof must stand on besides what the machine's definition demands
    """

    tool: str = ""
    work_offset: int | None = None
    edge: int | None = None
    radius_offset: int = 0
    register_holds: RegisterValue = RegisterValue.UNKNOWN
    last_edge: int = 0
    span: float | None = None
    span_tip: float | None = None
    absolute: bool = False
    rapid_feed: float | None = None
    below_rapid_feed: float | None = None
    max_inverse_time_feed: float | None = None
    max_feed: float | None = None
    smoothing: float | None = None
    rigid_tap: int | None = None
    coolant: Mapping[str, int] = field(default_factory=dict)
    tool_deltas: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    axis_tolerance: AxisTolerance = field(default_factory=AxisTolerance)
    blocks_in_compensation: int = 1
    stops_in_compensation: bool = False
    fastest_feed: bool = False
    feed_limit: float | None = None
    feeds_as_programmed: bool = False
    by_operation: Mapping[str, OperationSettings] = field(default_factory=dict)
    swivel_data: tuple[str, ...] = ()
    left_out: frozenset[int] = frozenset()
    stop_between: bool = False
    clearance: float | None = None
    operation_clearance: float = math.inf
    in_turn: bool = False
    has_settings: frozenset[str] = frozenset()
    texts: tuple[str, ...] = ()
    demands: tuple[str, ...] = ()

    def repeated(self, fault: Wording, name: str, value: object, **others: object) -> Wording:
        """Return a fault with the settings of the post that would explain it, if the control has them."""
        given = {name: value, **others}
        if not given.keys() <= self.has_settings:
            return fault
        texts = tuple(f"{key}={each}" for key, each in given.items())
        return fault.within("if_posted", settings=texts)

    def for_operation(self, name: str) -> OperationSettings:
        """Tool, work offset and edge of an operation."""
        every = OperationSettings(self.tool, self.work_offset, self.edge, self.radius_offset, self.last_edge)
        return self.by_operation.get(name, every)


@dataclass(frozen=True, slots=True, eq=False)
class Context:
    """A program that is checked by itself, without CL files."""

    run: Run
    settings: ExpectedValues

    def place(self, row: int, value: float, said: Wording) -> Place:
        """Return the place of a row."""
        run = self.run
        file = self.file_name(run.state.file[row])
        return Place(run.lines[row], run.block_numbers[row], value, said, nc_file=file, row=row)

    def place_of_event(self, event: RunEvent, value: float, said: Wording) -> Place:
        """Return the place of something that happens between rows."""
        row = min(event.before_row, len(self.run) - 1)
        return Place(event.line, -1, value, said, nc_file=self.file_name(event.file), row=row)

    def file_name(self, number: int) -> str:
        """Return the file of a row or an event as places have it: empty for the program itself."""
        return self.run.files[number] if number else ""

    def next_row(self, row: int) -> int:
        """Return the row after a row, or the last one."""
        return min(row + 1, len(self.run) - 1)

    def block_name(self, row: int) -> Wording:
        """Return what a programmer calls the block of a row."""
        return block_name_of(self.run, row)

    @property
    def last_line(self) -> int:
        """The last line of the program itself with an event or a comment."""
        lines = [e.line for e in self.run.events if not e.file] + [c.line for c in self.run.comments if not c.file]
        return max(lines, default=0)


@dataclass(frozen=True, slots=True, eq=False)
class ComparedContext(Context):
    """A program that is compared with CL files."""

    expected: ExpectedPath
    matching: Matching

    def highest_point(self, axis: Floats) -> float:
        """Return how high the CL files come along a direction (3,), mm from the program's zero."""
        return max(float((section.whole.moves.tip @ axis).max(initial=-np.inf)) for section in self.expected.sections)

    def place_with_cl(self, row: int, value: float, said: Wording, cl: int) -> Place:
        """Return the place of a row, with that of a CL row."""
        return self.at_cl_row(self.place(row, value, said), cl)

    def at_cl_row(self, place: Place, cl: int) -> Place:
        """Return a place with the file and line of a CL row."""
        return replace(place, cl_file=self.expected.section_at(cl).file, cl_line=self.expected.point(cl).line)

    def place_of_cl_row(self, cl: int, value: float, said: Wording) -> Place:
        """Return the place of a CL row, at the motion that goes to it."""
        if cl not in self.matching.cl:
            return replace(self.place_of_missing(cl, said), value=value)
        return self.place_with_cl(self.matching.nc[self.matching.cl.count_before(cl)], value, said, cl)

    def place_of_missing(self, cl: int, said: Wording) -> Place:
        """Return the place of a CL row to which no motion goes: the block before which one is missing."""
        nc, k = self.matching.nc, self.matching.cl.count_before(cl)
        ends = [event for event in self.run.events if event.kind == "end"]
        if not len(nc) and ends:  # the program ends before the first one
            return self.at_cl_row(self.place_of_event(ends[0], 0.0, said), cl)
        if not len(self.run):
            return Place(0, -1, 0.0, said)
        row = nc[k] if k < len(nc) else self.next_row(nc[-1] if k else 0)
        return self.place_with_cl(row, 0.0, said, cl)

    def rotary_positioning_place(self, row: int) -> Place | None:
        """Return the block before a row that positioned the rotary axes for it; None if that is the row itself or a
        match, or if points between them are right: ``row`` is the first that is not.
        """
        run, first = self.run, max(row - _POSITIONING_WINDOW, 0)
        bits = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR)
        written = np.flatnonzero((run.programmed[first : row + 1] & bits) != 0)
        if not len(written):
            return None
        by = first + int(written[-1])
        if by == row or by in self.matching.nc:
            return None
        before = self.matching.nc.count_before(row)
        if before and self.matching.nc[before - 1] > by:
            return None  # the points from there to the row are right, and so are the rotary axes
        return self.place(by, 0.0, Wording("all", "positioned_for", block=self.block_name(row)))


def check_from_places(key: str, places: Sequence[Place], good: Wording | None) -> Check:
    """Return a check that passes, with the answer ``good``, if there are no places; else the first is the answer."""
    return Faults(list(places), len(places)).check(key, good)


@dataclass(slots=True, eq=False)
class Faults:
    """What a check finds: how many faults, and the places of the first of them, so that a million cost no more."""

    places: list[Place] = field(default_factory=list)
    count: int = 0

    def add(self, *places: Place) -> None:
        """Take faults, each with its place."""
        self.add_rows(len(places), places)

    def add_rows(self, count: int, places: Iterable[Place]) -> None:
        """Take ``count`` faults; their places are made one by one, as long as they are named."""
        self.count += count
        self.places += islice(places, max(MAX_PLACES - len(self.places), 0))

    def check(self, key: str, good: Wording | None) -> Check:
        """Return the check: passed with the answer ``good`` if there are no faults; else the first is the answer."""
        if not self.places:
            return Check(key, True, good)
        return Check(key, False, self.answer(), places=tuple(self.places[:MAX_PLACES]))

    def answer(self) -> Wording:
        """Return the first fault, and how many more there are."""
        first = self.places[0]
        fault = Wording("all", "fault", block=first.block_name, fault=first.said)
        return fault.within("and_more", count=self.count - 1) if self.count > 1 else fault
