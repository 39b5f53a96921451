"""Writes CATIA APTSOURCE."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.cl.writers.apt import AptWriter
from trunnion.cl.writers.points import AxisRule, PointForm, number_text
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOn, Event, From, LoadTool, Operation, SpindleOn

#: A tool axis that turns by no more than this between the ends of an arc stays, as its last decimal may differ.
_SAME_AXIS: Final = 1e-9

_TANGENT_DECIMALS: Final = 12

#: CATIA prints no longer lines; a dollar sign in the last column continues a text.
_COLUMNS: Final = 72
_TEXTS: Final = ("PPRINT/", "DISPLY/", "INSERT/", "PARTNO/", "TPRINT/", "STOP/", "OPSTOP/")


class CatiaWriter(AptWriter):
    """MULTAX with a tool axis in every point; arcs by INDIRV and TLON,GOFWD."""

    name = "catia"
    title = "CATIA APTSOURCE"
    slash = "/ "
    comma = ", "
    form = PointForm("GOTO  / ", ", ", ",$\n  ", AxisRule.EVERY)

    def head(self, comments: Sequence[str]) -> list[str]:
        """Comments, part and unit."""
        part = _in_columns([f"PARTNO/{self.toolpath.part}"] if self.toolpath.part else [])
        head = [*self._system(), *(f"$$ {text}" for text in comments), *part]
        return [*head, f"UNITS/{'INCHES' if self.inch else 'MM'}", "MULTAX"]

    def _system(self) -> list[str]:
        """Return the coordinate system as a CATIA file had it: an identifier and three lines of four numbers."""
        numbers = self.system_numbers()
        rows = [numbers[k : k + 4] for k in range(0, len(numbers), 4)]
        return ["$$*CATIA0", "$$ SYSTEM", *(f"$$ {' '.join(row)}" for row in rows)] if rows else []

    def title_lines(self, number: int, operation: Operation) -> list[str]:
        """Return the comment that names an operation."""
        return [f"$$ OPERATION NAME : {operation.name}"]

    def begin(self, number: int, operation: Operation) -> list[str]:
        """Return the lines at the beginning of an operation."""
        return _in_columns(super().begin(number, operation))

    def event(self, event: Event) -> list[str]:
        """Return the statements of an event."""
        return _in_columns(super().event(event))

    def load_tool(self, event: LoadTool) -> list[str]:
        """LOADTL, with the register behind it; with a length in the spindle, the register is a couplet too."""
        number, register = str(event.number), [str(event.adjust)] * bool(event.adjust)
        if not self.set_length:
            return self.statement("LOADTL", number, *register)
        return self.statement("LOADTL", number, "LENGTH", *self.set_length, *["OSETNO", *register] * bool(register))

    def spindle(self, event: SpindleOn) -> list[str]:
        """Return the speed stands first."""
        return self.statement("SPINDL", number_text(event.rpm, 4), "RPM", event.sense.value)

    def cycle(self, event: CycleOn) -> list[str]:
        """Return a cycle in couplets."""
        values = self.hole_values(event)
        fields = [self.hole_word(event), "DEPTH", *values.pop("DEPTH")]
        if "STEP" in values:
            fields += ["STEP", *values.pop("STEP")]
        fields += values.pop("FEED", [])
        fields += ["CLEAR", *values.pop("RAPTO")]
        for word, numbers in values.items():
            fields += [word, *numbers]
        return self.statement("CYCLE", *fields)

    def arc_losses(self, operation: Operation, index: int) -> Iterator[Problem]:
        """Yield an arc along which the tool turns: its statement has a place for the tip alone."""
        row = int(operation.arcs.row[index])
        start = _axis_before(operation, row)
        if start is not None and float(np.abs(operation.moves.axis[row] - start).max()) > _SAME_AXIS:
            yield Problem(self.source.file, int(operation.moves.line[row]), Wording("CL910", "tool_axis_turns"))

    def arc(self, operation: Operation, index: int) -> tuple[list[str], bool]:
        """Return the direction at the start, the circle, and where it ends."""
        arcs, row = operation.arcs, int(operation.arcs.row[index])
        start, end = _tip_before(operation, row), operation.moves.tip[row]
        centre, normal = arcs.centre[index], arcs.normal[index]
        radius = number_text(float(arcs.radius[index]), 6)
        tangent = np.cross(normal, start - centre)
        tangent = tangent / np.linalg.norm(tangent)
        direction = [f"{value + 0.0:.{_TANGENT_DECIMALS}f}" for value in tangent.tolist()]
        lines = ["AUTOPS", *self.statement("INDIRV", *direction)]
        middle, last = self._point(centre), self._point(end)
        stop = "ON,2,INTOF," if _turn(start - centre, end - centre, normal) > math.pi else "ON,"
        if abs(float(normal[2])) == 1.0:
            lines += [f"TLON,GOFWD/(CIRCLE/{middle},$", f"  {radius}),{stop}$", f"  (LINE/{middle},$", f"  {last})"]
            return lines, True
        axis = ", ".join(number_text(value, 7) for value in normal.tolist())
        lines += [
            f"TLON,GOFWD/(CYLNDR/{middle},$", f"  {axis},$", f"  {radius}),{stop}(PLANE/PERPTO,$",
            f"  (PLANE/(POINT/{middle}),$", "  PERPTO,(VECTOR/$", f"  {axis})),$", f"  (POINT/{middle}),$",
            f"  (POINT/{last}))",
        ]  # fmt: skip
        return lines, True

    def _point(self, point: Floats) -> str:
        return ", ".join(self.length(value) for value in point.tolist())


def _in_columns(lines: Sequence[str]) -> list[str]:
    """Return the lines, a text that ends with a dollar sign in the last column continued, so that it stays one."""
    divided = []
    for line in lines:
        ends = line.endswith("$") and len(line.encode()) == _COLUMNS and line.startswith(_TEXTS)
        divided += [line, "$"] if ends else [line]
    return divided


def _axis_before(operation: Operation, row: int) -> Floats | None:
    """(3,) the tool axis in force before a row; None where that is not known."""
    starts = {event.row: np.array(event.axis) for event in operation.events if isinstance(event, From)}
    return starts.get(row, operation.moves.axis[row - 1] if row else None)


def _tip_before(operation: Operation, row: int) -> Floats:
    """(3,) the start of the move to a row."""
    starts = {event.row: np.array(event.tip) for event in operation.events if isinstance(event, From)}
    return np.asarray(starts.get(row, operation.moves.tip[row - 1]), np.float64)


def _turn(start: Floats, end: Floats, normal: Floats) -> float:
    """Return the angle of an arc, radians, from 0 to a full turn."""
    across = float(np.cross(start, end) @ normal)
    along = float(start @ end - (start @ normal) * (end @ normal))
    return math.atan2(across, along) % (2.0 * math.pi)
