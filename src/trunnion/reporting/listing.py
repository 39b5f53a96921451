"""A listing of a program as text: what the control does, one line a motion.

In:     the run of a program, the rows of its operations.
Out:    UTF-8 text, in pieces: positions, spindle, feed of each motion, and lines where tool, operation or file change.
Units:  mm, degrees, rev/min; feeds in mm/min, mm/rev or 1/min, as a column says.

Rows are written a chunk at a time, so that a program of any length takes little memory.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Bytes, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.reporting.extents import at_workpiece_zero
from trunnion.reporting.known_tips import KnownTips
from trunnion.reporting.text import clean
from trunnion.verification.results import OperationRows
from trunnion.wording import one_line

#: Decimals of positions, speeds and feeds: finer positions are printed by few controls.
_POSITION_DECIMALS: Final = 4
_SPEED_DECIMALS: Final = 1
_FEED_DECIMALS: Final = 3

#: Characters that numbers take, with a blank before them: positions and feeds, lines, block numbers, speeds.
_WIDTH: Final = 12
_LINE_WIDTH: Final = 9
_NUMBER_WIDTH: Final = 10
_SPEED_WIDTH: Final = 9

#: What the feed counts, and how a motion is made: by ``Run.feed_mode`` and ``Kind``, from their least values.
_LEAST_FEED_MODE: Final = 93
_FEED_UNITS: Final = ("1/min ", "mm/min", "mm/rev")
_KINDS: Final = ("rapid", "line", "arc")
_TEXTS: Final = tuple(
    f"{unit if kind != 'rapid' else '':6}  {kind:5}{frame:8}"
    for frame in ("", " machine")
    for kind in _KINDS
    for unit in _FEED_UNITS
)


@dataclass(frozen=True, slots=True)
class Column:
    """Numbers of one column: (n,) float64, NaN for none; their decimals, and the characters that they take."""

    values: Floats
    decimals: int
    width: int = _WIDTH

    @property
    def fits(self) -> bool:
        """Whether all numbers leave room for a sign and a blank before them."""
        most = float(np.nanmax(np.abs(self.values), initial=0.0)) * 10**self.decimals
        return bool(most + 1.0 < 10.0 ** (self.width - 2 - (self.decimals > 0)))


def listing(
    run: Run, program: str, operations: Sequence[OperationRows] = (), *, slides: bool = False, made_by: str = ""
) -> Iterator[bytes]:
    """Yield the listing of a program, piece by piece.

    program     its name
    operations  whose first rows get a line of their own
    slides      add the positions of the slides, as the machine shows them if the workpiece zero is known, or else from
                the workpiece zero
    made_by     what made it, in words
    """
    yield "".join(f"; {line}\n" for line in _head(run, _word(program), slides, made_by)).encode()
    lines, numbers = run.line, run.block_number
    marks = _marks(run, operations)
    placed = all(run.machine.is_placed(k) for k in run.machine.linear)
    zero = np.zeros(5) if placed else at_workpiece_zero(run.machine)
    known = KnownTips(run)
    for first, end, poses in run.chunks():
        rows, state = slice(first, end), run.state
        kind = run.kind[rows].astype(np.int64)
        speed = np.where(state.spindle.part(first, end) == 0, 0.0, state.rpm.part(first, end))
        feed = np.where(kind == Kind.RAPID, np.nan, state.feed.part(first, end))
        joints = [*run.machine.rotary_words, *(run.machine.linear if slides else ())]
        number = np.where(numbers[rows] < 0, np.nan, numbers[rows])
        columns = [Column(lines[rows].astype(np.float64), 0, _LINE_WIDTH), Column(number, 0, _NUMBER_WIDTH)]
        is_known = known.part(first, end)
        columns += [Column(np.where(is_known, poses.tip[1:, k], np.nan), _POSITION_DECIMALS) for k in range(3)]
        for k in joints:
            shown = is_known | placed | (k in run.machine.rotary)
            positions = run.machine.axes[k].displayed(poses.joints[1:, k] - zero[k], _POSITION_DECIMALS)
            columns.append(Column(np.where(shown, positions, np.nan), _POSITION_DECIMALS))
        columns += [Column(speed, _SPEED_DECIMALS, _SPEED_WIDTH), Column(feed, _FEED_DECIMALS)]
        unit = np.where(np.isfinite(feed), state.feed_mode.part(first, end).astype(np.int64) - _LEAST_FEED_MODE, 0)
        in_machine = state.machine_frame.part(first, end).astype(np.int64)
        text, ends = row_texts(columns, _TEXTS, len(_FEED_UNITS) * (kind + len(_KINDS) * in_machine) + unit)
        yield from _with_marks(text, ends, first, marks)
    yield b"".join(_mark(text) for row, text in marks if row >= len(run))


def _head(run: Run, program: str, slides: bool, made_by: str) -> Iterator[str]:
    machine = run.machine
    names = [_word(machine.axes[k].name) for k in machine.rotary_words]
    yield f"LISTING OF {program}: what the control does with it, one line a motion"
    yield f"Machine: {_word(machine.name)}" + (f". Made by {made_by}" if made_by else "")
    yield "X Y Z: tip of the tool in the workpiece, mm, at the end of the motion, with and without TCP"
    if names:
        ranks = zip(names, ("primary", "secondary"), strict=False)
        rotary = ", ".join(f"{name}: {rank} rotary axis" for name, rank in ranks)
        yield f"{rotary}, as the machine shows them, degrees"
    if slides:
        placed = all(machine.is_placed(k) for k in machine.linear)
        shown = "as the machine shows them" if placed else "counted from the workpiece zero"
        yield f"SX SY SZ: linear axes, mm, {shown}"
    yield "machine: the block states positions of the machine; the tip is known again when X, Y and Z are programmed"
    yield "S: rev/min, 0 where the spindle stands. F: as programmed; a rapid has none"
    widths = [_LINE_WIDTH, _NUMBER_WIDTH, *[_WIDTH] * (3 + len(names) + (3 if slides else 0)), _SPEED_WIDTH, _WIDTH]
    heads = ["LINE", "N", "X", "Y", "Z", *names, *(("SX", "SY", "SZ") if slides else ()), "S", "F"]
    texts = (head.rjust(width) for head, width in zip(heads, widths, strict=True))
    yield "".join(texts)[2:] + "         MOTION"


def _marks(run: Run, operations: Sequence[OperationRows]) -> list[tuple[int, str]]:
    """Lines before rows, in order: where operation, tool and file change."""
    found = [(each.first, 1, f"operation {number}: {_word(each.name)}") for number, each in enumerate(operations, 1)]
    found += [(row, 2, f"tool {_word(run.tools[int(value)])}") for row, value in _changes(run, "tool") if value]
    files = [_word(Path(file).name) for file in run.files]
    found += [(row, 0, f"file {files[int(value)]}") for row, value in _changes(run, "file") if len(files) > 1]
    return [(row, text) for row, _, text in sorted(found)]


def _changes(run: Run, name: str) -> list[tuple[int, float]]:
    """Rows from which a column has another value, and the value."""
    if not len(run):
        return []
    column = getattr(run.state, name)
    found = [(0, column[0])]
    for first in range(0, len(run), 1 << 20):
        part = column.part(max(first - 1, 0), min(first + (1 << 20), len(run)))
        rows = np.flatnonzero(np.diff(part)) + 1
        found += [(max(first - 1, 0) + int(row), part[row]) for row in rows]
    return found


def _with_marks(text: bytes, ends: Ints, first: int, marks: Sequence[tuple[int, str]]) -> Iterator[bytes]:
    """Yield the lines of rows from ``first`` on, which end at ``ends`` (n,), with the lines before them."""
    done = 0
    for row, mark in marks:
        if first <= row < first + len(ends):
            start = int(ends[row - first - 1]) if row > first else 0
            yield text[done:start] + _mark(mark)
            done = start
    yield text[done:]


def _word(text: str) -> str:
    """Text from outside as a part of a line."""
    return one_line(clean(text))


def _mark(text: str) -> bytes:
    return f"; {text}\n".encode()


def row_texts(columns: Sequence[Column], texts: Sequence[str], text_of: Ints) -> tuple[bytes, Ints]:
    """Write rows of numbers, each to the right of its column, and a text at the end of each.

    columns         with n rows
    texts, text_of  (n,) int64: the texts, all of one length, and which of them each row has

    text, ends  all lines, and where each ends, (n,) int64
    """
    if not all(each.fits for each in columns):
        return _slow_row_texts(columns, texts, text_of)
    ends_of_lines = np.array([list(f" {text}\n".encode()) for text in texts], np.uint8)
    parts = [_fixed(each) for each in columns]
    table = np.concatenate((*parts, ends_of_lines[text_of].T))
    lines = np.ascontiguousarray(table.T)
    return lines.tobytes(), np.arange(1, len(lines) + 1) * lines.shape[1]


def _slow_row_texts(columns: Sequence[Column], texts: Sequence[str], text_of: Ints) -> tuple[bytes, Ints]:
    """Return the same for numbers of any size, of which large ones move what comes after them to the right."""
    lines = []
    for row, text in enumerate(text_of.tolist()):
        numbers = (_number(float(each.values[row]), each.decimals).rjust(each.width) for each in columns)
        lines.append(f"{''.join(numbers)} {texts[text]}\n".encode())
    return b"".join(lines), np.cumsum([len(line) for line in lines], dtype=np.int64)


def _number(value: float, decimals: int) -> str:
    if not np.isfinite(value):
        return ""
    return f" {np.rint(value * 10**decimals) / 10**decimals + 0.0:.{decimals}f}"


def _fixed(column: Column) -> Bytes:
    """Numbers as texts to the right of their column, (width, n); blanks for NaN."""
    present = np.isfinite(column.values)
    counts = np.rint(np.where(present, column.values, 0.0) * 10**column.decimals).astype(np.int64)
    negative = counts < 0
    rest = np.abs(counts)
    if len(rest) and rest.max() < 1 << 32:
        rest = rest.astype(np.uint32)  # divided in half of the time
    out = np.full((column.width, len(counts)), ord(" "), np.uint8)
    place = column.width - 1
    for digit in range(column.width - 1):
        if digit == column.decimals and digit:
            out[place] = np.where(present, ord("."), ord(" "))
            place -= 1
        shown = present & (rest > 0) if digit > column.decimals else present
        if not shown.any():
            break
        quotient = rest // 10
        out[place] = np.where(shown, ord("0") + (rest - 10 * quotient), ord(" "))
        ended = ~shown & negative
        if ended.any():
            out[place][ended] = ord("-")
            negative &= shown
        rest = quotient
        place -= 1
    if negative.any():
        out[place][negative & present] = ord("-")
    return out
