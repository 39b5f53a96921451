"""Writes Trunnion's own APT profile."""

import re
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cl.writers.checks import joined
from trunnion.cl.writers.clsf import ClsfWriter
from trunnion.cl.writers.lengths import INCH
from trunnion.cl.writers.points import number_text
from trunnion.cl.writers.writer import UNSETTLED_SYSTEM
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import LoadTool, Operation, SelectTool, SetMode, Tool, Toolpath, UnknownStatement

_IDENTITY: Final = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)

_SIZES: Final = (
    ("DIAMETER", "diameter"), ("CORNER", "corner_radius"), ("LENGTH", "length"), ("FLUTE", "flute_length"),
    ("TAPER", "taper_angle"), ("TIP", "tip_angle"), ("UPPER", "upper_radius"), ("EXTENSION", "extension"),
    ("GAUGE", "set_length"), ("CENTRE", "corner_centre"), ("UPPER-CENTRE", "upper_centre"),
)  # fmt: skip


class TrunnionWriter(ClsfWriter):
    """Sections of NX, with the whole tool in words, and a head that names the profile."""

    name = "trunnion"
    title = "Trunnion APT"
    has_stock = True
    has_work_offsets = True

    def prepared(self, toolpath: Toolpath) -> Toolpath:
        """Return the toolpath as it is; a coordinate system whose meaning is not settled is lost."""
        if toolpath.system and toolpath.system != _IDENTITY:
            self.remark(0, UNSETTLED_SYSTEM)
        return toolpath

    def losses(self, operation: Operation) -> Iterator[Problem]:
        """Statements that are not known, but PROBE in the unit of the file, and a holder whose name a dollar sign would
        cut off.
        """
        yield from super().losses(operation)
        is_same_unit = self.source.unit == (INCH if self.inch else 1.0)
        for event in operation.events:
            if isinstance(event, UnknownStatement):
                text = joined(event.text)
                if is_same_unit and re.match(r"\s*PROBE\s*/", text, re.ASCII):
                    continue
                yield Problem(
                    self.source.file, event.line, Wording("CL910", "unknown_statement", text=text, title=self.title)
                )
        if "$" in operation.tool.holder:
            yield Problem(
                self.source.file, operation.line, Wording("CL910", "dollar_in_holder", holder=operation.tool.holder)
            )

    def head(self, comments: Sequence[str]) -> list[str]:
        """Return the profile with its version, comments, part, unit and stock."""
        lines = ["$$-> TRUNNION / 1", *(f"$$ {text}" for text in comments)]
        if self.toolpath.part:
            lines.append(f"PARTNO/{self.toolpath.part}")
        lines.append(f"UNITS/{'INCHES' if self.inch else 'MM'}")
        if self.toolpath.stock:
            kind, _, sizes = self.toolpath.stock.partition(":")
            unit = INCH if self.inch else 1.0
            numbers = ",".join(number_text(float(size) / unit, 4) for size in sizes.split(","))
            lines.append(f"$$-> STOCK / {kind.upper()},{numbers}")
        return lines

    def begin(self, number: int, operation: Operation) -> list[str]:
        """Return what sections of NX begin with, and the work offset."""
        offset = [f"$$-> WORK-OFFSET / {operation.work_offset}"] if operation.work_offset else []
        return [*super().begin(number, operation), *offset]

    def foot(self) -> list[str]:
        """Return the end of the file."""
        return ["FINI"]

    def tool_lines(self, tool: Tool) -> list[str]:
        """Return the form of the tool with the sizes that something states, and its holder."""
        words = [tool.kind]
        for word, field in _SIZES:
            stated = getattr(tool, field)
            if stated:
                numbers = stated if isinstance(stated, tuple) else (stated,)
                words += [word, *(number_text(number, 4) for number in numbers)]
        lines = [f"$$-> TOOL / {','.join(words)}"] if words != ["UNKNOWN"] else []
        return [*lines, *([f"$$-> HOLDER / {tool.holder}"] if tool.holder else [])]

    def load_tool(self, event: LoadTool) -> list[str]:
        """LOADTL."""
        return [f"LOADTL/{event.number}" + (f",ADJUST,{event.adjust}" if event.adjust else "")]

    def select_tool(self, event: SelectTool) -> list[str]:
        """SELCTL."""
        return [f"SELCTL/{event.number}"]

    def mode(self, event: SetMode) -> list[str]:
        """Nothing: every file of the profile means it."""
        return []
