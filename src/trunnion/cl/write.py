"""Writes a ``Toolpath`` as an NX CLSF, such that ``read_cl`` reads the same one back.

In:     operations, lengths in mm.
Out:    UTF-8 lines; points through a compiled kernel in chunks, what stands between them as text.

Lengths get the decimals that NX gives them, or as many more as it takes to say the number exactly. Tool axes get 12
decimals, and 17 where it stands within a twentieth of a degree of X, Y or Z: there the direction in which the
tool leans hangs on the last of them.
"""

import codecs
from collections.abc import Iterable, Iterator, Sequence
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Bytes, Floats, Floats2
from trunnion.cl.assemble import COLOUR_PHASES, RADIUS_TOLERANCE, fill_phases
from trunnion.cl.encoding import EncodingDetector
from trunnion.decimal_bytes import MAX_EXACT, POWERS_OF_TEN
from trunnion.errors import InputError, Problem, Severity
from trunnion.jit import inner, kernel
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    From,
    GoHome,
    Insert,
    Kind,
    LoadTool,
    Message,
    Moves,
    Operation,
    Phase,
    SelectTool,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    Tool,
    Toolpath,
    UnknownStatement,
)

#: Rows that the kernel writes at a time, and the most bytes that one of them can take.
CHUNK = 1 << 15
_MAX_LINE_BYTES = 192

_INT_POWERS_OF_TEN = 10 ** np.arange(19, dtype=np.int64)
_AXIS_DECIMALS = 12
_AXIS_DECIMALS_NEAR = 17
#: Sine of the tilt against X, Y or Z below which a tool axis gets all decimals.
_NEAR = 1e-3

_PHASE_COLOURS = {phase: colour for colour, phase in COLOUR_PHASES.items()} | {
    Phase.INITIAL: 186,
    Phase.DEPARTURE: 211,
    Phase.TRAVERSE: 211,
}
_GOTO = np.frombuffer(b"GOTO/", np.uint8)
_COMMA, _MINUS, _POINT, _ZERO, _NEWLINE = 44, 45, 46, 48, 10


def write_cl(toolpath: Toolpath, sink: BinaryIO, *, comments: Iterable[str] = ()) -> tuple[Problem, ...]:
    """Write a CLSF.

    Parameters
    ----------
    toolpath
        Events in the order of their rows, as ``read_cl`` gives them.
    sink
        Takes UTF-8 bytes in order.
    comments
        Lines that go to the head as ``$$`` comments.

    Returns
    -------
    tuple of Problem
        Remarks on what a CLSF cannot say and reads back otherwise.

    Raises
    ------
    InputError
        Before anything is written, when a CLSF cannot hold the toolpath at all.
    """
    problems = [problem for operation in toolpath.operations for problem in _unsupported(toolpath, operation)]
    comments = tuple(comments)
    texts = {"part name": toolpath.part, **{f"comment {text!r}": text for text in comments}}
    problems += [_bad_text(toolpath.file, 0, what) for what, text in texts.items() if not _is_one_line(text)]
    if not toolpath.operations:
        problems.append(Problem(toolpath.file, 0, "there is no operation in it", "give a toolpath with motion"))
    if problems:
        raise InputError(problems)
    if not _is_detected_as_utf8([*texts.values(), *(text for o in toolpath.operations for _, _, text in _texts(o))]):
        sink.write(codecs.BOM_UTF8)
    head = [f"$$ {text}" for text in comments]
    if toolpath.part:
        head.append(f"PARTNO/{toolpath.part}")
    sink.write(_lines(head))
    remarks: list[Problem] = []
    for operation in toolpath.operations:
        remarks += _write_operation(toolpath.file, operation, sink)
    return tuple(remarks)


# What cannot be said


def _unsupported(toolpath: Toolpath, operation: Operation) -> Iterator[Problem]:
    """What no CLSF can hold of an operation."""
    file = toolpath.file
    yield from (_bad_text(file, line, what) for line, what, text in _texts(operation) if not _is_one_line(text))
    if ",TOOL," in operation.name:
        what = f"operation name {operation.name!r} has ',TOOL,' in it, which ends the name in a CL file"
        yield Problem(file, operation.line, what, "rename the operation")
    arcs, moves = operation.arcs, operation.moves
    starts = {event.row: event.tip for event in operation.events if isinstance(event, From)}
    for index, row in enumerate(arcs.row.tolist()):
        start = starts.get(row) or (tuple(moves.tip[row - 1].tolist()) if row else None)
        if start is None:
            what = f"operation {operation.name} begins with an arc, which has no start"
            yield Problem(file, int(moves.line[row]), what, "put a point before it")
            continue
        off = max(
            abs(
                _distance_from_line(np.array(point) - arcs.centre[index], arcs.normal[index])
                - float(arcs.radius[index])
            )
            for point in (start, moves.tip[row])
        )
        if off > RADIUS_TOLERANCE:
            what = f"an end of the arc lies {off:.3f} mm off its radius, of which a CL file allows {RADIUS_TOLERANCE}"
            yield Problem(file, int(moves.line[row]), what, "make it a line, or correct its centre")


def _texts(operation: Operation) -> Iterator[tuple[int, str, str]]:
    """Line, meaning and text of what people have named or written."""
    yield operation.line, "operation name", operation.name
    yield operation.line, "tool name", operation.tool.name
    for event in operation.events:
        if isinstance(event, Stop | Message | Insert | UnknownStatement):
            yield event.line, f"text of {type(event).__name__}", event.text
        elif isinstance(event, SetMode | CycleOn):
            for word in event.words if isinstance(event, SetMode) else event.mode:
                yield event.line, "word", word


def _is_detected_as_utf8(texts: Iterable[str]) -> bool:
    """Whether a reader sees that the texts are UTF-8; a few letters of some alphabets look like Chinese in GBK."""
    detector = EncodingDetector()
    detector.add("\n".join(texts).encode())
    return detector.encoding() == "utf-8"


def _distance_from_line(offset: Floats, normal: Floats) -> float:
    """Distance from the line through the origin along ``normal``."""
    return float(np.linalg.norm(offset - (offset @ normal) * normal))


def _is_one_line(text: str) -> bool:
    return not any(ord(character) < 32 or ord(character) == 127 for character in text.replace("\t", " "))


def _bad_text(file: str, line: int, what: str) -> Problem:
    return Problem(file, line, f"{what} has a line break or a control character in it", "write it in one line")


# Operations


def _write_operation(file: str, operation: Operation, sink: BinaryIO) -> list[Problem]:
    moves = operation.moves
    sink.write(_lines(_head(operation)))
    colours, remarks = _colours(file, operation)
    before = _statements(operation, colours)
    done = 0
    modal_axis = np.array([0.0, 0.0, 1.0])
    for row in sorted({*before, len(moves)}):
        _write_rows(moves, done, row, modal_axis, sink)
        if row in before:
            lines, axis = before[row]
            sink.write(_lines(lines))
            if axis is not None:
                modal_axis[:] = axis
        done = row
    sink.write(b"END-OF-PATH\n")
    return remarks


def _head(operation: Operation) -> list[str]:
    frame = operation.frame
    origin = [_number(value, 4) for value in frame.origin]
    vectors = [_number(value, 7) for value in (*frame.x, *frame.y)]
    lines = [f"TOOL PATH/{operation.name},TOOL,{operation.tool.name}", *_tldata(operation.tool)]
    lines.append(f"MSYS/{','.join([*origin, *vectors])}")
    for word, tolerance in (("INTOL", operation.intol), ("OUTTOL", operation.outtol)):
        if tolerance is not None:
            lines.append(f"{word}/{_number(tolerance, 6)}")
    return lines


def _tldata(tool: Tool) -> list[str]:
    """The statement of the tool; none for a tool of which nothing is known."""
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
    return [f"TLDATA/{tool.kind},{','.join(_number(number, 4) for number in numbers)}"]


def _statements(
    operation: Operation, colours: Sequence[tuple[int, int]]
) -> dict[int, tuple[list[str], tuple[float, float, float] | None]]:
    """What stands before which row, and the tool axis that it puts into force, if it does."""
    moves, arcs = operation.moves, operation.arcs
    found: dict[int, tuple[list[str], tuple[float, float, float] | None]] = {}

    def put(row: int, *lines: str, axis: tuple[float, float, float] | None = None) -> None:
        old, known = found.get(row, ([], None))
        found[row] = [*old, *lines], axis or known

    head = [event for event in operation.events if event.row == 0]
    later = sorted((event for event in operation.events if event.row > 0), key=lambda event: event.row)
    for event in head:
        put(0, _event_statement(event), axis=event.axis if isinstance(event, From) else None)
    for row, colour in colours:
        put(row, f"PAINT/COLOR,{colour}")
    for event in later:
        put(event.row, _event_statement(event), axis=event.axis if isinstance(event, From) else None)
    for row in _feed_rows(moves):
        word = "MMPR" if moves.per_rev[row] else "MMPM"
        put(row, f"FEDRAT/{word},{_number(float(moves.feed[row]), 4)}")
    for row in np.flatnonzero(moves.kind == Kind.RAPID).tolist():
        put(row, "RAPID")
    for index, row in enumerate(arcs.row.tolist()):
        numbers = [_number(value, 6) for value in arcs.centre[index].tolist()]
        numbers += [_number(value, 7) for value in arcs.normal[index].tolist()]
        numbers.append(_number(float(arcs.radius[index]), 4))
        turns = int(arcs.full_turns[index])
        put(row, f"CIRCLE/{','.join(numbers)}" + (f",TIMES,{turns + 1}" if turns else ""))
    return found


def _feed_rows(moves: Moves) -> list[int]:
    """Rows whose feed is not that of the row before; NaN is no feed yet."""
    last = np.concatenate(([np.nan], moves.feed[:-1]))
    last_per_rev = np.concatenate(([False], moves.per_rev[:-1]))
    changed = (moves.feed != last) | (moves.per_rev != last_per_rev)
    return [int(row) for row in np.flatnonzero(changed & ~np.isnan(moves.feed))]


def _event_statement(event: Event) -> str:
    """The statement of an event."""
    match event:
        case LoadTool():
            return f"LOAD/TOOL,{event.number}" + (f",ADJUST,{event.adjust}" if event.adjust else "")
        case SelectTool():
            return f"SELECT/TOOL,{event.number}"
        case SpindleOn():
            return f"SPINDL/RPM,{_number(event.rpm, 4)},{event.sense.value}"
        case SpindleOff():
            return "SPINDL/OFF"
        case Coolant():
            return f"COOLNT/{event.kind}"
        case CutterComp():
            words = [event.side, event.plane, str(event.register or "")]
            return f"CUTCOM/{','.join(word for word in words if word)}"
        case Dwell():
            return f"DELAY/{_number(event.amount, 3)}" + (",REV" if event.revolutions else "")
        case Stop():
            return ("OPSTOP" if event.optional else "STOP") + (f"/{event.text}" if event.text else "")
        case Message():
            return f"{'DISPLY' if event.display else 'PPRINT'}/{event.text}"
        case Insert():
            return f"INSERT/{event.text}"
        case BlockSkip():
            return f"OPSKIP/{'ON' if event.on else 'OFF'}"
        case CycleOn():
            return _cycle(event)
        case CycleOff():
            return "CYCLE/OFF"
        case From():
            tip = [_number(value, 6) for value in event.tip]
            return f"FROM/{','.join([*tip, *_axis_numbers(event.axis)])}"
        case GoHome():
            return "GOHOME"
        case SetMode():
            major, *words = event.words
            return major + (f"/{','.join(words)}" if words else "")
        case UnknownStatement():
            return event.text
    raise TypeError(type(event).__name__)


def _cycle(event: CycleOn) -> str:
    """A cycle: its mode words, then couplets and words without numbers, each kind in its own order."""
    values = list(event.values)
    parts = list(event.mode)
    if values and parts and values[0][0] == parts[-1]:
        parts += [_number(number, 4) for number in values.pop(0)[1]]
    for word, after in event.words:
        while word in (name for name, _ in values) and values[0][0] != word:
            parts += _couplet(*values.pop(0))
        parts += [text for text in (word, after) if text]
        if values and values[0][0] == word:
            parts += _couplet(*values.pop(0))[1:]
    for word, numbers in values:
        parts += _couplet(word, numbers)
    return f"CYCLE/{','.join(parts)}"


def _couplet(word: str, numbers: tuple[float, ...]) -> list[str]:
    return [word, *(_number(number, 4) for number in numbers)]


# Phases


def _colours(file: str, operation: Operation) -> tuple[list[tuple[int, int]], list[Problem]]:
    """(row, colour) of each PAINT/COLOR that makes the phases read back, and a remark where none does."""
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
    what = f"{len(off)} points of operation {operation.name} change their phase, the first from {was} to {now}"
    return colours, [
        Problem(file, int(moves.line[row]), what, "colours of a CL file cannot say this order", Severity.WARNING)
    ]


# Numbers and points


def _lines(lines: Iterable[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()


def _number(value: float, decimals: int) -> str:
    """A number with these decimals, or as many more as it takes to say it exactly."""
    text = f"{value + 0.0:.{decimals}f}"
    return text if float(text) == value else np.format_float_positional(value, unique=True, trim="0")


def _axis_numbers(axis: tuple[float, float, float]) -> list[str]:
    """A tool axis as the kernel writes it."""
    line = np.empty(_MAX_LINE_BYTES, np.uint8)
    at = _format_axis(*axis, line)
    return line[1:at].tobytes().decode().split(",")


def _write_rows(moves: Moves, first: int, last: int, modal_axis: Floats, sink: BinaryIO) -> None:
    """Write the rows ``first`` to ``last``; ``modal_axis`` (3,) is the tool axis, kept up to date."""
    if first == last:
        return
    out = np.empty(min(last - first, CHUNK) * _MAX_LINE_BYTES, np.uint8)
    row = first
    while row < last:
        stop = min(row + CHUNK, last)
        row, size = _format_points(moves.tip, moves.axis, row, stop, modal_axis, out)
        sink.write(out[:size].data)
        if row < stop:
            _write_long_point(moves, row, modal_axis, sink)
            row += 1


def _write_long_point(moves: Moves, row: int, modal_axis: Floats, sink: BinaryIO) -> None:
    """Write a row at which the kernel stopped: its numbers have more digits than 15."""
    numbers = [_number(value, 6) for value in moves.tip[row].tolist()]
    i, j, k = moves.axis[row].tolist()
    if (i, j, k) != tuple(modal_axis.tolist()):
        numbers += _axis_numbers((i, j, k))
        modal_axis[:] = i, j, k
    sink.write(_lines([f"GOTO/{','.join(numbers)}"]))


@kernel(writes="modal_axis out")
def _format_points(tip: Floats2, axis: Floats2, row: int, stop: int, modal_axis: Floats, out: Bytes) -> tuple[int, int]:
    """Write GOTO lines; return the row where it ended, ``stop`` or one whose numbers need a slower way, and the bytes.

    tip       (n, 3) float64   mm
    axis      (n, 3) float64
    in_force  (3,)   float64   the axis that was written last; kept up to date
    out       (b,)   uint8     room for ``_MAX_LINE_BYTES`` bytes a row
    """
    at = 0
    while row < stop:
        line = at
        for letter in _GOTO:
            out[at] = letter
            at += 1
        for k in range(3):
            if k:
                out[at] = _COMMA
                at += 1
            at = _put_length(tip[row, k], out, at)
            if at < 0:
                return row, line
        i, j, k_ = axis[row, 0], axis[row, 1], axis[row, 2]
        if i != modal_axis[0] or j != modal_axis[1] or k_ != modal_axis[2]:
            at = _put_axis(i, j, k_, out, at)
            modal_axis[0], modal_axis[1], modal_axis[2] = i, j, k_
        out[at] = _NEWLINE
        at += 1
        row += 1
    return row, at


@kernel(writes="out")
def _format_axis(i: float, j: float, k: float, out: Bytes) -> int:
    """Write a tool axis, a comma before each number; return the end."""
    return _put_axis(i, j, k, out, 0)


@inner
def _put_length(value: float, out: Bytes, at: int) -> int:
    """Write a length in 6, 9, 12 or 15 decimals, the fewest that say it exactly; return the end, or -1 if none does."""
    for decimals in range(6, 16, 3):
        count = np.rint(abs(value) * POWERS_OF_TEN[decimals])
        if not count <= MAX_EXACT:
            return -1
        if count / POWERS_OF_TEN[decimals] == abs(value):
            return _put_decimal(value < 0.0, int(count), decimals, 6, out, at)
    return -1


@inner
def _put_axis(i: float, j: float, k: float, out: Bytes, at: int) -> int:
    """Write a tool axis, a comma before each number; return the end."""
    a, b, c = abs(i), abs(j), abs(k)
    near = (a < _NEAR and b < _NEAR) or (a < _NEAR and c < _NEAR) or (b < _NEAR and c < _NEAR)
    for value in (i, j, k):
        out[at] = _COMMA
        decimals = _AXIS_DECIMALS
        if near:
            decimals = _AXIS_DECIMALS_NEAR if abs(value) < _NEAR else 15
        at = _put_decimal(
            value < 0.0, int(np.rint(abs(value) * POWERS_OF_TEN[decimals])), decimals, _AXIS_DECIMALS, out, at + 1
        )
    return at


@inner
def _put_decimal(negative: bool, count: int, decimals: int, fewest: int, out: Bytes, at: int) -> int:
    """Write a whole number of the last decimal, without zeros at the end beyond ``fewest`` decimals; return the end."""
    if negative and count > 0:
        out[at] = _MINUS
        at += 1
    while decimals > fewest and count % 10 == 0:
        count //= 10
        decimals -= 1
    whole = count // _INT_POWERS_OF_TEN[decimals]
    digits = 1
    while digits < 18 and whole >= _INT_POWERS_OF_TEN[digits]:
        digits += 1
    for index in range(at + digits - 1, at - 1, -1):
        out[index] = _ZERO + whole % 10
        whole //= 10
    at += digits
    out[at] = _POINT
    at += 1
    part = count % _INT_POWERS_OF_TEN[decimals]
    for index in range(at + decimals - 1, at - 1, -1):
        out[index] = _ZERO + part % 10
        part //= 10
    return at + decimals
