"""Statements about operations: where they begin and end, their tool, frame, tolerances and colours; units and part."""

import math
import re
from dataclasses import replace
from typing import Any

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import COORDINATE_SYSTEM, LENGTH_REGISTER, MM_PER_INCH, TOOL_NUMBER, ReaderState
from trunnion.cl.statement import Statement, numbers, whole_number
from trunnion.messages import Wording
from trunnion.model.apt_cutter import stated_centre
from trunnion.model.toolpath import Frame, Sense, Tool

#: Names of length units, in mm.
LENGTH_UNITS = {"MM": 1.0, "INCHES": MM_PER_INCH, "INCH": MM_PER_INCH, "IN": MM_PER_INCH}

#: How far the vectors of MSYS may be off unit length and off square: they are printed with seven decimals.
_FRAME_TOLERANCE = 1e-3

#: No operation is roughed within more than this, mm or inches.
_WIDEST_TOLERANCE = 1.0

#: Stands between the names of operation and tool.
_TOOL_WORD = re.compile(r",\s*TOOL\s*,", re.IGNORECASE)

_MILL = ("diameter", "corner_radius", "length", "taper_angle", "tip_angle")
_DRILL = ("diameter", "corner_radius", "length", "tip_angle", "flute_length")
_TCUTTER = ("diameter", "corner_radius", "upper_radius", "length", "flute_length")

#: Forms of TLDATA: for each possible count of numbers, the fields of ``Tool`` that they are; empty where there is none.
_TLDATA_FIELDS: dict[str, dict[int, tuple[str, ...]]] = {
    "MILL": {5: _MILL, 7: _MILL, 10: (*_MILL, "", "", "upper_radius")},
    "DRILL": {5: _DRILL},
    "TCUTTER": {5: _TCUTTER},
    "BARREL": {5: _MILL, 7: _MILL, 10: (*_MILL, "", "", "upper_radius")},
}


def tool_path(state: ReaderState, statement: Statement) -> None:
    """Begin an operation."""
    if state.in_operation:
        state.diagnostics.error(
            state.builder.line, Wording("CL350", "operation_no_end", builder=state.builder.name, state_line=state.line)
        )
        state.close_operation()
    elif state.operation_row:
        state.report_motion_outside()
        state.builder.starts.clear()
    # The name of the tool may have commas in it.
    name, tool = (*_TOOL_WORD.split(statement.text, maxsplit=1), "")[:2]
    outside = state.builder
    state.builder = replace(
        outside, name=name.strip(), line=state.line, first=state.row, colours=[], rapids=[], circles=[], splines=[]
    )
    # A tool that stands before the operation is only the one before that of the operation.
    for what in (TOOL_NUMBER, LENGTH_REGISTER):
        outside.stated.pop(what, None)
    state.builder.tool = replace(outside.tool, name=tool.strip() or outside.tool.name)
    state.in_operation = True
    if state.spindle is not None:
        before = state.builders[-1].name if state.builders else ""
        state.turned_left = (before or "1") if state.spindle.sense is Sense.CCLW else ""
    state.spindle = None
    state.cycle = None
    state.cycle_line = 0


def end_of_path(state: ReaderState, statement: Statement) -> None:
    """End an operation."""
    if not state.in_operation:
        raise StatementError(Wording("CL350", "end_path_without"))
    state.close_operation()


def tldata(state: ReaderState, statement: Statement) -> None:
    """Set the tool of the operation."""
    words = statement.words()
    given = numbers("TLDATA", statement.values[len(words) :])
    form = words[0] if words else ""
    layouts = _TLDATA_FIELDS.get(form, {})
    if form in _TLDATA_FIELDS and len(given) not in layouts:
        *others, last = map(str, layouts)
        raise StatementError(
            Wording("CL770", "tldata_number_expected", words=form, count=len(given), others=tuple(others), last=last)
            if others
            else Wording("CL770", "tldata_number", words=form, count=len(given), last=last)
        )
    sizes = zip(layouts.get(len(given), ()), given, strict=False)
    fields: dict[str, Any] = {field: number for field, number in sizes if field}
    if len(given) in (7, 10):
        fields["corner_centre"] = stated_centre(given[0], given[1], *given[5:7])
    if len(given) == 10:
        fields["upper_centre"] = None if given[8] == given[9] == 0.0 else given[8:]
    kind = form if form in _TLDATA_FIELDS else "UNKNOWN"
    state.state_once("tool", (form, given))
    state.state_once("diameter of the tool", fields.get("diameter"))
    state.builder.tool = Tool(kind=kind, name=state.builder.tool.name, **fields)
    if form not in _TLDATA_FIELDS:
        state.diagnostics.remark(
            state.line,
            Wording("CL770", "tldata_not_known", words=words[0])
            if words
            else Wording("CL770", "tldata_not_known_form"),
        )


def msys(state: ReaderState, statement: Statement) -> None:
    """Set the coordinate system of the operation: origin, X and Y, made exactly unit and square."""
    if state.operation_row:
        raise StatementError(Wording("CL430", "msys_after_motion"))
    state.state_once(COORDINATE_SYSTEM, statement.numbers(9))
    ox, oy, oz, *vectors = statement.numbers(9)
    x, y = vectors[:3], vectors[3:]
    for name, vector in (("X", x), ("Y", y)):
        if abs(math.hypot(*vector) - 1) > _FRAME_TOLERANCE:
            raise StatementError(Wording("CL440", "vector_msys_length", name=name, vector=math.hypot(*vector)))
    x = _unit(x)
    along = _dot(x, y)
    if abs(along) > _FRAME_TOLERANCE:
        raise StatementError(Wording("CL440", "x_y_msys"))
    y = _unit([b - along * a for a, b in zip(x, y, strict=True)])
    state.builder.frame = Frame((ox, oy, oz), (x[0], x[1], x[2]), (y[0], y[1], y[2]))


def _dot(a: list[float], b: list[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(vector: list[float]) -> list[float]:
    length = math.hypot(*vector)
    return [number / length for number in vector]


def partno(state: ReaderState, statement: Statement) -> None:
    """Set the name of the part; the first one counts."""
    state.part = state.part or statement.text


def units(state: ReaderState, statement: Statement) -> None:
    """Set the length unit of the file."""
    word = statement.values[0] if statement.values else ""
    if not isinstance(word, str) or word not in LENGTH_UNITS or len(statement.values) > 1:
        raise StatementError(Wording("CL410", "units_not_known", listed=statement.listed()))
    if state.length_unit is not None and state.length_unit[0] != LENGTH_UNITS[word]:
        raise StatementError(
            Wording("CL410", "units_after_another", values=statement.values[0], length_unit=state.length_unit[1])
        )
    state.length_unit = state.length_unit or (LENGTH_UNITS[word], state.line)


def intol(state: ReaderState, statement: Statement) -> None:
    """Set the inner tolerance; without sections, another one begins an operation."""
    tolerance = _tolerance(state, statement)
    if state.builder.intol != tolerance:
        state.split_operation()
    state.state_once("inner tolerance", tolerance)
    state.builder.intol = tolerance


def outtol(state: ReaderState, statement: Statement) -> None:
    """Set the outer tolerance; without sections, another one begins an operation."""
    tolerance = _tolerance(state, statement)
    if state.builder.outtol != tolerance:
        state.split_operation()
    state.state_once("outer tolerance", tolerance)
    state.builder.outtol = tolerance


def _tolerance(state: ReaderState, statement: Statement) -> float:
    """Return a tolerance in units of the file, 0 or more."""
    (tolerance,) = statement.numbers(1)
    if tolerance < 0.0:
        raise StatementError(Wording("CL340", "negative", major=statement.major, tolerance=tolerance))
    if tolerance > _WIDEST_TOLERANCE:
        state.diagnostics.remark(
            state.line, Wording("CL800", "control_may_leave", major=statement.major, tolerance=tolerance)
        )
    return tolerance


def paint(state: ReaderState, statement: Statement) -> None:
    """Note the colour of the path, which gives the phase; other PAINT statements only say how it is drawn."""
    if statement.values[:1] == ("COLOR",):
        state.builder.colours.append((state.operation_row, whole_number("PAINT/COLOR", statement.values[1:])))


def end_of_file(state: ReaderState, statement: Statement) -> None:
    """Note that no motion is missing: it is the last statement of a file whose operations have no end of their own."""
    if 0 <= state.end_row < state.row:
        state.diagnostics.remark(state.line, Wording("CL170", "motion_stands_behind"))
    state.end_row = state.row


def ignore(state: ReaderState, statement: Statement) -> None:
    """Do nothing: names of machines, and what only listings have."""
