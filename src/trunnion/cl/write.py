"""Writes a ``Toolpath`` as an NX CLSF that ``read_cl`` reads back the same.

In:     operations, lengths in mm.
Out:    UTF-8 lines; points by a compiled kernel in chunks, the statements between them as text.
"""

import codecs
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import BinaryIO

import numpy as np

from trunnion.cl.phases import COLOUR_PHASES, fill_phases
from trunnion.cl.write_checks import is_detected_as_utf8, problems_of
from trunnion.cl.write_events import event_statement
from trunnion.cl.write_points import encode_lines, number_text, write_points
from trunnion.errors import InputError, Problem, Severity
from trunnion.model.toolpath import Arcs, Event, From, Kind, Moves, Operation, Phase, Tool, Toolpath
from trunnion.wording import counted

_PHASE_COLOURS = {phase: colour for colour, phase in COLOUR_PHASES.items()} | {
    Phase.INITIAL: 186,
    Phase.DEPARTURE: 211,
    Phase.TRAVERSE: 211,
}


def write_cl(toolpath: Toolpath, sink: BinaryIO, *, comments: Iterable[str] = ()) -> tuple[Problem, ...]:
    """Write a CLSF.

    Parameters
    ----------
    toolpath
        Events in the order of their rows, as ``read_cl`` gives them.
    sink
        Takes UTF-8 bytes in order.
    comments
        Lines for the head of the file, as ``$$`` comments.

    Returns
    -------
    tuple of Problem
        Remarks on what a CLSF cannot express and reads back otherwise.

    Raises
    ------
    InputError
        Before anything is written, if a CLSF cannot hold the toolpath at all.
    """
    comments = tuple(comments)
    if problems := problems_of(toolpath, comments):
        raise InputError(problems)
    if not is_detected_as_utf8(toolpath, comments):
        sink.write(codecs.BOM_UTF8)
    head = [f"$$ {text}" for text in comments]
    if toolpath.part:
        head.append(f"PARTNO/{toolpath.part}")
    sink.write(encode_lines(head))
    remarks: list[Problem] = []
    for operation in toolpath.operations:
        remarks += _write_operation(toolpath.file, operation, sink)
    return tuple(remarks)


def _write_operation(file: str, operation: Operation, sink: BinaryIO) -> list[Problem]:
    moves = operation.moves
    sink.write(encode_lines(_head(operation)))
    colours, remarks = _colours(file, operation)
    before = _statements(operation, colours)
    done = 0
    modal_axis = np.array([0.0, 0.0, 1.0])
    for row in sorted({*before, len(moves)}):
        write_points(moves, done, row, modal_axis, sink)
        if row in before:
            sink.write(encode_lines(before[row].lines))
            if before[row].axis is not None:
                modal_axis[:] = before[row].axis
        done = row
    sink.write(b"END-OF-PATH\n")
    return remarks


def _head(operation: Operation) -> list[str]:
    frame = operation.frame
    origin = [number_text(value, 4) for value in frame.origin]
    vectors = [number_text(value, 7) for value in (*frame.x, *frame.y)]
    lines = [f"TOOL PATH/{operation.name},TOOL,{operation.tool.name}", *_tldata(operation.tool)]
    lines.append(f"MSYS/{','.join([*origin, *vectors])}")
    for word, tolerance in (("INTOL", operation.intol), ("OUTTOL", operation.outtol)):
        if tolerance is not None:
            lines.append(f"{word}/{number_text(tolerance, 6)}")
    return lines


def _tldata(tool: Tool) -> list[str]:
    """The statement of the tool; none for an unknown tool."""
    if tool.kind in ("MILL", "BARREL"):
        numbers = [tool.diameter, tool.corner_radius, tool.length, tool.taper_angle, tool.tip_angle]
        if tool.upper_radius:
            numbers += [0.0, 0.0, tool.upper_radius, 0.0, 0.0]
    elif tool.kind == "DRILL":
        numbers = [tool.diameter, tool.corner_radius, tool.length, tool.tip_angle, tool.flute_length]
    elif tool.kind == "TCUTTER":
        numbers = [tool.diameter, tool.corner_radius, tool.upper_radius, tool.length, tool.flute_length]
    else:
        return []
    return [f"TLDATA/{tool.kind},{','.join(number_text(number, 4) for number in numbers)}"]


@dataclass(slots=True)
class _RowStatements:
    """The statements before a row, and the tool axis that they make modal, if they do."""

    lines: list[str] = field(default_factory=list)
    axis: tuple[float, float, float] | None = None


def _statements(operation: Operation, colours: Sequence[tuple[int, int]]) -> dict[int, _RowStatements]:
    """Row -> the statements before it: events, colour, feed, RAPID and CIRCLE."""
    moves = operation.moves
    found: defaultdict[int, _RowStatements] = defaultdict(_RowStatements)
    before_first = [event for event in operation.events if event.row == 0]
    later = sorted((event for event in operation.events if event.row > 0), key=lambda event: event.row)
    for event in before_first:
        _add_event(found, event)
    for row, colour in colours:
        found[row].lines.append(f"PAINT/COLOR,{colour}")
    for event in later:
        _add_event(found, event)
    for row in _feed_rows(moves):
        word = "MMPR" if moves.per_rev[row] else "MMPM"
        found[row].lines.append(f"FEDRAT/{word},{number_text(float(moves.feed[row]), 4)}")
    for row in np.flatnonzero(moves.kind == Kind.RAPID).tolist():
        found[row].lines.append("RAPID")
    for index, row in enumerate(operation.arcs.row.tolist()):
        found[row].lines.append(_circle(operation.arcs, index))
    return found


def _add_event(found: defaultdict[int, _RowStatements], event: Event) -> None:
    found[event.row].lines.append(event_statement(event))
    if isinstance(event, From):
        found[event.row].axis = event.axis


def _circle(arcs: Arcs, index: int) -> str:
    numbers = [number_text(value, 6) for value in arcs.centre[index].tolist()]
    numbers += [number_text(value, 7) for value in arcs.normal[index].tolist()]
    numbers.append(number_text(float(arcs.radius[index]), 4))
    turns = int(arcs.full_turns[index])
    return f"CIRCLE/{','.join(numbers)}" + (f",TIMES,{turns + 1}" if turns else "")


def _feed_rows(moves: Moves) -> list[int]:
    """Rows whose feed is not that of the row before; NaN is no feed yet."""
    last = np.concatenate(([np.nan], moves.feed[:-1]))
    last_per_rev = np.concatenate(([False], moves.per_rev[:-1]))
    changed = (moves.feed != last) | (moves.per_rev != last_per_rev)
    return [int(row) for row in np.flatnonzero(changed & ~np.isnan(moves.feed))]


def _colours(file: str, operation: Operation) -> tuple[list[tuple[int, int]], list[Problem]]:
    """(row, colour) of each PAINT/COLOR so that the phases read back, and a remark if no colours do that."""
    moves = operation.moves
    rapids = np.flatnonzero(moves.kind == Kind.RAPID)
    read = np.empty(len(moves), np.uint8)
    fill_phases(read, rapids, ())
    if not len(moves) or np.array_equal(read, moves.phase):
        return [], []
    starts = np.flatnonzero(np.diff(moves.phase.astype(np.int16), prepend=-1)).tolist()
    colours = [(row, _PHASE_COLOURS[Phase(int(moves.phase[row]))]) for row in starts]
    fill_phases(read, rapids, colours)
    off = np.flatnonzero(read != moves.phase)
    if not len(off):
        return colours, []
    row = int(off[0])
    was, now = Phase(int(moves.phase[row])).name.lower(), Phase(int(read[row])).name.lower()
    what = f"{operation.name}: {counted(len(off), 'point')} in another phase, the first in {now} instead of {was}"
    cure = "the colours of a CL file cannot express this order"
    return colours, [Problem(file, int(moves.line[row]), what, cure, Severity.WARNING)]
