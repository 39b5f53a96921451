"""What CATIA APTSOURCE and Creo NCL write alike: one coordinate system, CUTTER, flat arcs of less than a turn."""

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import ClassVar, Final

import numpy as np

from trunnion.cl.writers.checks import called, rows_with_own_feed
from trunnion.cl.writers.half_circles import with_half_circles
from trunnion.cl.writers.lengths import INCH
from trunnion.cl.writers.points import number_text
from trunnion.cl.writers.writer import UNSETTLED_SYSTEM, ClWriter
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.apt_cutter import apt_cutter
from trunnion.model.arcs import FLAT_ARC
from trunnion.model.frames import into_frame
from trunnion.model.toolpath import (
    CutterComp,
    CycleOff,
    CycleOn,
    Event,
    Frame,
    From,
    GoHome,
    Kind,
    LoadTool,
    Message,
    Operation,
    Phase,
    SelectTool,
    SetMode,
    Tool,
    Toolpath,
)

#: Kinds of holes as one word, by the modes that a toolpath has.
_CYCLES: Final = {
    ("DRILL",): "DRILL",
    ("FACE",): "FACE",
    ("DRILL", "FACE"): "FACE",
    ("DRILL", "DEEP"): "DEEP",
    ("DRILL", "BRKCHP"): "BRKCHP",
    ("TAP",): "TAP",
    ("REAM",): "REAM",
}

#: Words of CYCLE that all have; any other is one of which a dialect says nothing.
_CYCLE_WORDS: Final = frozenset({"RAPTO", "FEDTO", "RTRCTO", "STEP", "DWELL", "MMPM", "MMPR"})
_BARE_WORDS: Final = frozenset({("RTRCTO", "AUTO"), ("DWELL", "REV")})

#: A tip flatter than this, degrees from the horizontal, is that of a mill.
_FLATTEST_DRILL: Final = 1.0


class AptWriter(ClWriter):
    """Writes APT: operations follow each other without an end of their own, in one coordinate system."""

    has_retract_plane: ClassVar[bool] = False

    #: The length of the tool in the spindle, if the operation states it.
    set_length: list[str]

    _title: list[str]
    _rows: int
    _has_form = False

    def prepared(self, toolpath: Toolpath) -> Toolpath:
        """All operations in the coordinate system of the first one, full circles in two halves."""
        frames = [operation.frame for operation in toolpath.operations]
        if any(frame != frames[0] for frame in frames):
            first = next(operation for operation in toolpath.operations if operation.frame != frames[0])
            self.remark(first.line, Wording("CL930", "operations_have_coordinate", title=self.title))
        elif frames and frames[0] != Frame():
            self.remark(toolpath.operations[0].line, Wording("CL930", "where_coordinate_system", title=self.title))
        self._remark_system(toolpath)
        operations, halved = [], 0
        for operation in toolpath.operations:
            found, count = with_half_circles(into_frame(operation, frames[0]))
            operations.append(found)
            halved += count
        if halved:
            self.remark(0, Wording("CL930", "full_circle_become", halved=halved, title=self.title))
        self._remark_phases(operations)
        self._remark_tolerances(operations)
        for operation in operations:
            self._remark_tool(operation)
        return replace(toolpath, operations=tuple(operations))

    def _remark_system(self, toolpath: Toolpath) -> None:
        identity = tuple(np.eye(3, 4).ravel().tolist())
        if toolpath.system not in ((), identity) and toolpath.dialect != self.name:
            self.remark(0, UNSETTLED_SYSTEM)

    def system_numbers(self) -> list[str]:
        """Return the coordinate system of the file in that of the model, if it comes from a file of this dialect."""
        if self.source.dialect != self.name:
            return []
        unit = INCH if self.inch else 1.0
        return [number_text(n / unit if k % 4 == 3 else n, 10) for k, n in enumerate(self.source.system)]

    def _remark_phases(self, operations: Sequence[Operation]) -> None:
        """Report that colours are lost, which give phases such as approach and engage."""
        for operation in operations:
            moves = operation.moves
            plain = np.where(moves.kind == Kind.RAPID, Phase.RAPID, Phase.CUT)
            off = np.flatnonzero(moves.phase != plain)
            if len(off):
                self.remark(int(moves.line[off[0]]), Wording("CL930", "phases_motion_colours", title=self.title))
                return

    def _remark_tolerances(self, operations: Sequence[Operation]) -> None:
        """Report where a tolerance goes on that an operation does not have."""
        for before, operation in pairwise(operations):
            pairs = ((before.intol, operation.intol), (before.outtol, operation.outtol))
            if any(was is not None and now is None for was, now in pairs):
                self.remark(
                    operation.line, Wording("CL930", "states_no_tolerance", operation=operation.name, title=self.title)
                )

    def _remark_tool(self, operation: Operation) -> None:
        """Report the sizes of a tool for which CUTTER has no place."""
        tool = operation.tool
        sizes = {
            "flute length": tool.flute_length,
            "upper radius": tool.upper_radius,
            "extension": tool.extension,
            "length in the spindle": 0.0 if _loads(operation) else tool.set_length,
        }
        lost = [word for word, size in sizes.items() if size]
        if tool.kind in ("BARREL", "TCUTTER"):
            lost.append(f"form {tool.kind}")
        if tool.kind == "DRILL" and tool.corner_radius:
            lost.append("form DRILL")
        if tool.kind == "MILL" and not tool.corner_radius and tool.tip_angle > _FLATTEST_DRILL:
            lost.append("form MILL of a pointed tool")
        if "," in tool.name:
            lost.append("name behind the comma")
        if lost:
            self.remark(
                operation.line, Wording("CL930", "not_carried_over", called=called(operation), lost=tuple(lost))
            )

    def losses(self, operation: Operation) -> Iterator[Problem]:
        """Helices, several turns, and cycles of which the dialect says nothing."""
        moves, arcs = operation.moves, operation.arcs
        starts = {event.row: np.array(event.tip) for event in operation.events if isinstance(event, From)}
        for index, row in enumerate(arcs.row.tolist()):
            start = starts.get(row, moves.tip[row - 1])
            rise = abs(float((moves.tip[row] - start) @ arcs.normal[index]))
            if rise > FLAT_ARC or arcs.full_turns[index]:
                yield self._lost(int(moves.line[row]), Wording("CL910", "helix_arc_several", title=self.title))
            yield from self.arc_losses(operation, index)
        for event in operation.events:
            if isinstance(event, CycleOn):
                yield from self._cycle_losses(event)
            elif isinstance(event, LoadTool) and event.row > 0:
                yield self._lost(
                    event.line, Wording("CL910", "loads_second_tool", operation=operation.name, title=self.title)
                )
        yield from self._side_losses(operation)
        yield from self._feed_losses(operation)

    def arc_losses(self, operation: Operation, index: int) -> Iterator[Problem]:
        """Yield what the dialect cannot say of a flat arc."""
        yield from ()

    def _cycle_losses(self, event: CycleOn) -> Iterator[Problem]:
        words = [word for word, _ in event.values if word not in _CYCLE_WORDS]
        words += [f"{word},{after}" for word, after in event.words if (word, after) not in _BARE_WORDS]
        if ("RTRCTO", "AUTO") in event.words and not self.has_retract_plane:
            words.append("RTRCTO,AUTO")
        if event.mode not in _CYCLES:
            words.append(",".join(event.mode))
        if words:
            yield self._lost(event.line, Wording("CL910", "cycle_not_settled", words=tuple(words), title=self.title))
        if not {"FEDTO", "RAPTO"} <= {word for word, _ in event.values}:
            yield self._lost(event.line, Wording("CL910", "cycle_without_fedto"))

    def _side_losses(self, operation: Operation) -> Iterator[Problem]:
        """Radius compensation that is on at a GOHOME with motion behind it, which begins another operation here."""
        side = "OFF"
        for event in operation.events:
            if isinstance(event, CutterComp):
                side = event.side
            elif isinstance(event, GoHome) and 0 < event.row < len(operation.moves) and side != "OFF":
                yield self._lost(event.line, Wording("CL910", "cutcom_gohome_another", side=side, title=self.title))

    def _feed_losses(self, operation: Operation) -> Iterator[Problem]:
        """Points without a feed behind operations that have one: here feeds go on."""
        operations = self.toolpath.operations
        before = operations[: next(n for n, each in enumerate(operations) if each is operation)]
        bare = np.isnan(operation.moves.feed) & (operation.moves.kind != Kind.RAPID) & ~rows_with_own_feed(operation)
        if bare.any() and any(not np.isnan(each.moves.feed).all() for each in before):
            yield self._lost(
                int(operation.moves.line[bare.argmax()]),
                Wording("CL910", "cuts_before_feed", operation=operation.name, title=self.title),
            )

    def _lost(self, line: int, wording: Wording) -> Problem:
        return Problem(self.source.file, line, wording)

    def begin(self, number: int, operation: Operation) -> list[str]:
        """Return the name, the tool and the tolerances."""
        self._title = self.title_lines(number, operation)
        self._rows = len(operation.moves)
        self.set_length = [self.length(operation.tool.set_length)] if operation.tool.set_length else []
        lines = [*self._title, *self.tool_lines(operation.tool)]
        for word, tolerance in (("INTOL", operation.intol), ("OUTTOL", operation.outtol)):
            if tolerance is not None:
                lines += self.statement(word, number_text(tolerance, 6))
        return lines

    def event(self, event: Event) -> list[str]:
        """Return the statements of an event; behind GOHOME another operation begins, which gets the same name."""
        lines = super().event(event)
        return [*lines, *self._title] if isinstance(event, GoHome) and event.row < self._rows else lines

    def end(self, operation: Operation) -> list[str]:
        """Return the ends of a cycle and of radius compensation: in a toolpath they end with their operation."""
        cycles = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
        lines = self.statement("CYCLE", "OFF") if cycles and isinstance(cycles[-1], CycleOn) else []
        sides = [event.side for event in operation.events if isinstance(event, CutterComp)]
        return [*lines, *(self.statement("CUTCOM", "OFF") if sides and sides[-1] != "OFF" else [])]

    def foot(self) -> list[str]:
        """Return the end of the file."""
        return ["FINI"]

    @abstractmethod
    def title_lines(self, number: int, operation: Operation) -> list[str]:
        """Return the lines that name an operation."""

    def tool_lines(self, tool: Tool) -> list[str]:
        """Return the tool's form and name; a form that is in force would count for a tool without one, too."""
        numbers = _cutter_numbers(tool)
        lines = self.cutter([number_text(number, 6) for number in numbers or [0.0] * self._has_form])
        self._has_form = bool(numbers)
        names = ",".join(name for name in (tool.name, tool.holder) if name or tool.holder)
        return [*lines, *([f"TPRINT/{names}"] if names else [])]

    def cutter(self, numbers: list[str]) -> list[str]:
        """Return the statement of a tool's form; none if nothing is known of it."""
        return self.statement("CUTTER", *numbers) if numbers else []

    def select_tool(self, event: SelectTool) -> list[str]:
        """SELCTL."""
        return self.statement("SELCTL", str(event.number))

    def message(self, event: Message) -> list[str]:
        """Return a text; quotation marks around a text of the program are not part of it, so that its own need
        others.
        """
        quoted = len(event.text) > 1 and event.text[0] == event.text[-1] == "'"
        if not event.display and quoted:
            return [f"PPRINT/'{event.text}'"]
        return super().message(event)

    def mode(self, event: SetMode) -> list[str]:
        """Nothing: every file of the dialect says or means it."""
        return []

    def hole_word(self, event: CycleOn) -> str:
        """Return the word for the kind of a hole."""
        return _CYCLES[event.mode]

    def hole_values(self, event: CycleOn) -> dict[str, list[str]]:
        """Return the numbers of a cycle by their words, a depth without its sign, feeds under FEED with their unit."""
        found: dict[str, list[str]] = {}
        for word, numbers in event.values:
            texts = [number_text(number, 4) for number in numbers]
            if word == "FEDTO":
                found["DEPTH"] = [number_text(abs(numbers[0]), 4)]
            elif word in ("MMPM", "MMPR"):
                found["FEED"] = [self.feed_unit(per_rev=word == "MMPR"), *texts]
            else:
                found[word] = texts
        if ("DWELL", "REV") in event.words:
            found["DWELL"] = ["REV", *found["DWELL"]]
        return found


def _loads(operation: Operation) -> bool:
    """Whether an operation loads its tool."""
    return any(isinstance(event, LoadTool) for event in operation.events)


def _cutter_numbers(tool: Tool) -> list[float]:
    """Return the numbers of CUTTER: d, r, e, f, a, b, h; none for an unknown tool without sizes."""
    if tool.kind == "UNKNOWN" and not tool.diameter:
        return []
    return list(apt_cutter(tool))
