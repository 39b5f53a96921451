"""Writes Creo NCL."""

import re
from collections.abc import Sequence
from typing import Final

from trunnion.cl.writers.apt import AptWriter
from trunnion.cl.writers.points import AxisRule, PointForm
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOn, LoadTool, Operation

#: The only name that an operation of the dialect has: its number.
_NUMBER: Final = re.compile(r"FEATNO ([0-9]{1,9})")


class NclWriter(AptWriter):
    """The tool axis stands only where it is not Z; commands of Creo's own in ``$$->`` comments."""

    name = "ncl"
    title = "Creo NCL"
    slash = " / "
    comma = ", "
    form = PointForm("GOTO / ", ", ", ",  $\n  ", AxisRule.NOT_Z)
    has_retract_plane = True

    def head(self, comments: Sequence[str]) -> list[str]:
        """Comments, part, unit, and the coordinate system if it is that of an NCL file."""
        names = [operation.name for operation in self.toolpath.operations if not _NUMBER.fullmatch(operation.name)]
        if names:
            self.remark(self.toolpath.operations[0].line, Wording("CL930", "names_operation_become", count=len(names)))
        lines = [f"$$ {text}" for text in comments]
        if self.toolpath.part:
            lines.append(f"PARTNO / {self.toolpath.part}")
        lines.append(f"UNITS / {'INCHES' if self.inch else 'MM'}")
        if numbers := self.system_numbers():
            lines += self.statement("$$-> CSYS", *numbers)
        return [*lines, "MULTAX / ON"]

    def foot(self) -> list[str]:
        """Return the end of the file."""
        return ["$$-> END / ", "FINI"]

    def title_lines(self, number: int, operation: Operation) -> list[str]:
        """Return the number of the operation, with its name as a comment."""
        found = _NUMBER.fullmatch(operation.name)
        return [f"$$-> FEATNO / {found[1]}"] if found else [f"$$ {operation.name}", f"$$-> FEATNO / {number}"]

    def cutter(self, numbers: list[str]) -> list[str]:
        """Return a command of Creo's own: the diameter alone for a flat mill."""
        if not numbers:
            return []
        plain = not any(float(number) for number in (*numbers[1:2], *numbers[4:]))
        return self.statement("$$-> CUTTER", *(numbers[:1] if plain else numbers))

    def load_tool(self, event: LoadTool) -> list[str]:
        """LOADTL, with the length in the spindle and its register."""
        length = ["LENGTH", *self.set_length] * bool(self.set_length)
        return self.statement("LOADTL", str(event.number), *length, *["OSETNO", str(event.adjust)] * bool(event.adjust))

    def cycle(self, event: CycleOn) -> list[str]:
        """Return a cycle in couplets; RETURN,0 is the height before it."""
        values = self.hole_values(event)
        fields = [self.hole_word(event), "DEPTH", *values.pop("DEPTH")]
        if "STEP" in values:
            fields += ["STEP", *values.pop("STEP")]
        fields += values.pop("FEED", [])
        fields += ["CLEAR", *values.pop("RAPTO")]
        if ("RTRCTO", "AUTO") in event.words:
            fields += ["RETURN", "0.0"]
        elif "RTRCTO" in values:
            fields += ["RETURN", *values.pop("RTRCTO")]
        for word, numbers in values.items():
            fields += [word, *numbers]
        return self.statement("CYCLE", *fields)

    def arc(self, operation: Operation, index: int) -> tuple[list[str], bool]:
        """CIRCLE; the end point is a GOTO."""
        return self.statement("CIRCLE", *self.circle(operation.arcs, index)), False
