"""Writes NX CLSF."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.cl.phases import COLOUR_PHASES, fill_phases
from trunnion.cl.writers.checks import called
from trunnion.cl.writers.points import number_text
from trunnion.cl.writers.writer import UNSETTLED_SYSTEM, ClWriter
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOn, Kind, LoadTool, Operation, Phase, SelectTool, Tool, Toolpath

_PHASE_COLOURS: Final = {phase: colour for colour, phase in COLOUR_PHASES.items()} | {
    Phase.INITIAL: 186,
    Phase.DEPARTURE: 211,
    Phase.TRAVERSE: 211,
}

_IDENTITY: Final = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


class ClsfWriter(ClWriter):
    """Operations between TOOL PATH and END-OF-PATH; colours give the phase."""

    name = "clsf"
    title = "NX CLSF"
    divides_lines = False

    def prepared(self, toolpath: Toolpath) -> Toolpath:
        """Return the toolpath as it is; a coordinate system whose meaning is not settled is lost."""
        if toolpath.system and toolpath.system != _IDENTITY:
            self.remark(0, UNSETTLED_SYSTEM)
        for operation in toolpath.operations:
            tool = operation.tool
            sizes = {"holder": tool.holder, "extension": tool.extension, "length in the spindle": tool.set_length}
            if lost := [word for word, said in sizes.items() if said]:
                self.remark(
                    operation.line,
                    Wording("CL930", "not_carried", called=called(operation), lost=tuple(lost), title=self.title),
                )
        return toolpath

    def losses(self, operation: Operation) -> Iterator[Problem]:
        """Report a name that cannot be distinguished from that of the tool."""
        if ",TOOL," in operation.name:
            yield Problem(
                self.source.file,
                operation.line,
                Wording("CL910", "operation_name_tool", operation=repr(operation.name)),
            )

    def head(self, comments: Sequence[str]) -> list[str]:
        """Comments, unit and part."""
        lines = [f"$$ {text}" for text in comments]
        if self.inch:
            lines.append("UNITS/INCHES")
        if self.toolpath.part:
            lines.append(f"PARTNO/{self.toolpath.part}")
        return lines

    def begin(self, number: int, operation: Operation) -> list[str]:
        """Names, tool, coordinate system and tolerances."""
        frame = operation.frame
        origin = [number_text(value, 4) for value in frame.origin]
        vectors = [number_text(value, 7) for value in (*frame.x, *frame.y)]
        lines = [f"TOOL PATH/{operation.name},TOOL,{operation.tool.name}", *self.tool_lines(operation.tool)]
        lines.append(f"MSYS/{','.join([*origin, *vectors])}")
        for word, tolerance in (("INTOL", operation.intol), ("OUTTOL", operation.outtol)):
            if tolerance is not None:
                lines.append(f"{word}/{number_text(tolerance, 6)}")
        return lines

    def tool_lines(self, tool: Tool) -> list[str]:
        """Return the statements of the tool; none for an unknown tool."""
        return _tldata(tool)

    def end(self, operation: Operation) -> list[str]:
        """Return the end of the path."""
        return ["END-OF-PATH"]

    def colours(self, operation: Operation) -> list[tuple[int, str]]:
        """PAINT/COLOR so that the phases read back, and a remark if no colours do that."""
        moves = operation.moves
        rapids = np.flatnonzero(moves.kind == Kind.RAPID)
        read = np.empty(len(moves), np.uint8)
        fill_phases(read, rapids, ())
        if not len(moves) or np.array_equal(read, moves.phase):
            return []
        starts = np.flatnonzero(np.diff(moves.phase.astype(np.int16), prepend=-1)).tolist()
        colours = [(row, _PHASE_COLOURS[Phase(int(moves.phase[row]))]) for row in starts]
        fill_phases(read, rapids, colours)
        off = np.flatnonzero(read != moves.phase)
        if len(off):
            row = int(off[0])
            was, now = Phase(int(moves.phase[row])).name.lower(), Phase(int(read[row])).name.lower()
            self.remark(
                int(moves.line[row]),
                Wording("CL930", "point_another_phase", operation=operation.name, count=len(off), now=now, was=was),
            )
        return [(row, f"PAINT/COLOR,{colour}") for row, colour in colours]

    def feed(self, value: float, *, per_rev: bool) -> list[str]:
        """Return the unit stands in front of the feed."""
        return [f"FEDRAT/{self.feed_unit(per_rev=per_rev)},{number_text(value, 4)}"]

    def arc(self, operation: Operation, index: int) -> tuple[list[str], bool]:
        """CIRCLE; the end point is a GOTO."""
        turns = int(operation.arcs.full_turns[index])
        times = ["TIMES", str(turns + 1)] if turns else []
        return self.statement("CIRCLE", *self.circle(operation.arcs, index), *times), False

    def load_tool(self, event: LoadTool) -> list[str]:
        """LOAD/TOOL."""
        return [f"LOAD/TOOL,{event.number}" + (f",ADJUST,{event.adjust}" if event.adjust else "")]

    def select_tool(self, event: SelectTool) -> list[str]:
        """SELECT/TOOL."""
        return [f"SELECT/TOOL,{event.number}"]

    def cycle(self, event: CycleOn) -> list[str]:
        """Return a cycle: its mode words, then couplets and words without numbers, each in their order."""
        values = list(event.values)
        parts = list(event.mode)
        if values and parts and values[0][0] == parts[-1]:
            parts += [number_text(number, 4) for number in values.pop(0)[1]]
        for word, after in event.words:
            while word in (name for name, _ in values) and values[0][0] != word:
                parts += self._couplet(*values.pop(0))
            parts += [text for text in (word, after) if text]
            if values and values[0][0] == word:
                parts += self._couplet(*values.pop(0))[1:]
        for word, numbers in values:
            parts += self._couplet(word, numbers)
        return [f"CYCLE/{','.join(parts)}"]

    def _couplet(self, word: str, numbers: tuple[float, ...]) -> list[str]:
        if word in ("MMPM", "MMPR"):
            word = self.feed_unit(per_rev=word == "MMPR")
        return [word, *(number_text(number, 4) for number in numbers)]


def _tldata(tool: Tool) -> list[str]:
    """Return the statement of the tool; none for an unknown tool."""
    if tool.kind in ("MILL", "BARREL"):
        numbers = [tool.diameter, tool.corner_radius, tool.length, tool.taper_angle, tool.tip_angle]
        if tool.upper_radius or tool.corner_centre:
            numbers += tool.corner_centre or (0.0, 0.0)
        if tool.upper_radius:
            numbers += [tool.upper_radius, *(tool.upper_centre or (0.0, 0.0))]
    elif tool.kind == "DRILL":
        numbers = [tool.diameter, tool.corner_radius, tool.length, tool.tip_angle, tool.flute_length]
    elif tool.kind == "TCUTTER":
        numbers = [tool.diameter, tool.corner_radius, tool.upper_radius, tool.length, tool.flute_length]
    else:
        return []
    return [f"TLDATA/{tool.kind},{','.join(number_text(number, 4) for number in numbers)}"]
