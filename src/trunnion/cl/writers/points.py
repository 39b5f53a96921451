"""Numbers and points of a CL file as text, in the form that a dialect gives them.

Lengths get the decimals that NX gives them, or as many more as they need to be exact. Tool axes get 12 decimals, and 17
within a twentieth of a degree of X, Y or Z, where the direction in which the tool leans depends on the last of them.
"""

from collections.abc import Iterable
from enum import IntEnum
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Bytes, Floats, Floats2
from trunnion.decimal_bytes import MAX_EXACT, POWERS_OF_TEN
from trunnion.jit import inner, kernel
from trunnion.model.toolpath import Moves
from trunnion.records import dataclass

#: Rows that the kernel writes at a time, and the most bytes that one of them can take.
CHUNK = 1 << 15
_MAX_LINE_BYTES = 192

_INT_POWERS_OF_TEN = 10 ** np.arange(19, dtype=np.int64)
_AXIS_DECIMALS = 12
_AXIS_DECIMALS_NEAR = 17
#: Sine of the tilt against X, Y or Z below which a tool axis gets all decimals.
_NEAR = 1e-3

_MINUS, _POINT, _ZERO, _NEWLINE = 45, 46, 48, 10


class AxisRule(IntEnum):
    """Which points give their tool axis."""

    CHANGED = 0  # those with another axis than the point before: it is modal
    EVERY = 1
    NOT_Z = 2  # those with another axis than (0, 0, 1)


_CHANGED, _EVERY = int(AxisRule.CHANGED), int(AxisRule.EVERY)


@dataclass(frozen=True, slots=True)
class PointForm:
    """How a dialect writes a point.

    begin        in front of the first number
    comma        between two numbers
    before_axis  in front of the tool axis
    axis         which points give it
    """

    begin: str = "GOTO/"
    comma: str = ","
    before_axis: str = ","
    axis: AxisRule = AxisRule.CHANGED

    def line(self, lengths: list[str], axis: list[str]) -> str:
        """Return a point as a line, or two; without a tool axis if ``axis`` is empty."""
        return self.begin + self.comma.join(lengths) + (self.before_axis + self.comma.join(axis) if axis else "")

    def bytes(self) -> tuple[Bytes, Bytes, Bytes]:
        """``begin``, ``comma`` and ``before_axis``, (b,) uint8 each."""
        begin, comma, before = (
            np.frombuffer(text.encode(), np.uint8) for text in (self.begin, self.comma, self.before_axis)
        )
        return begin, comma, before


def encode_lines(lines: Iterable[str]) -> bytes:
    """Lines as bytes of the file."""
    return "".join(f"{line}\n" for line in lines).encode()


def number_text(value: float, decimals: int) -> str:
    """Return a number with these decimals, or with as many more as it needs to be exact."""
    text = f"{value + 0.0:.{decimals}f}"
    return text if float(text) == value else np.format_float_positional(value, unique=True, trim="0")


def axis_texts(axis: tuple[float, float, float]) -> list[str]:
    """Return the numbers of a tool axis, as the kernel writes them."""
    line = np.empty(_MAX_LINE_BYTES, np.uint8)
    _, comma, _ = PointForm().bytes()
    at = _format_axis(*axis, comma, line)
    return line[:at].tobytes().decode().split(",")


def write_points(moves: Moves, first: int, last: int, form: PointForm, modal_axis: Floats, sink: BinaryIO) -> None:
    """Write the rows from ``first`` up to ``last``.

    ``modal_axis`` (3,) is the tool axis that need not be written: updated where it is modal.
    """
    if first == last:
        return
    out = np.empty(min(last - first, CHUNK) * _MAX_LINE_BYTES, np.uint8)
    row = first
    while row < last:
        stop = min(row + CHUNK, last)
        row, size = _format_points(moves.tip, moves.axis, row, stop, modal_axis, *form.bytes(), int(form.axis), out)
        sink.write(out[:size].data)
        if row < stop:
            _write_long_point(moves, row, form, modal_axis, sink)
            row += 1


def _write_long_point(moves: Moves, row: int, form: PointForm, modal_axis: Floats, sink: BinaryIO) -> None:
    """Write a row whose numbers have more digits than the kernel writes."""
    i, j, k = moves.axis[row].tolist()
    needed = form.axis is AxisRule.EVERY or (i, j, k) != tuple(modal_axis.tolist())
    sink.write(encode_lines([point_line(form, moves, row, with_axis=needed)]))
    if needed and form.axis is AxisRule.CHANGED:
        modal_axis[:] = i, j, k


def point_line(form: PointForm, moves: Moves, row: int, *, with_axis: bool) -> str:
    """Return a row as a line, with or without its tool axis."""
    i, j, k = moves.axis[row].tolist()
    return form.line([number_text(value, 6) for value in moves.tip[row].tolist()], axis_texts((i, j, k)) * with_axis)


@kernel(writes="modal_axis out")
def _format_points(
    tip: Floats2,
    axis: Floats2,
    row: int,
    stop: int,
    modal_axis: Floats,
    begin: Bytes,
    comma: Bytes,
    before_axis: Bytes,
    rule: int,
    out: Bytes,
) -> tuple[int, int]:
    """Write GOTO lines up to ``stop`` or a row with more than 15 digits; return that row and the number of bytes.

    tip         (n, 3) float64   mm
    axis        (n, 3) float64
    modal_axis  (3,)  float64    the axis that need not be written, updated if ``rule`` is CHANGED
    out         (b,)   uint8     ``_MAX_LINE_BYTES`` bytes for each row
    """
    at = 0
    while row < stop:
        line = at
        at = _put_text(begin, out, at)
        for k in range(3):
            if k:
                at = _put_text(comma, out, at)
            at = _put_length(tip[row, k], out, at)
            if at < 0:
                return row, line
        i, j, k_ = axis[row, 0], axis[row, 1], axis[row, 2]
        if rule == _EVERY or i != modal_axis[0] or j != modal_axis[1] or k_ != modal_axis[2]:
            at = _put_text(before_axis, out, at)
            at = _put_axis(i, j, k_, comma, out, at)
            if rule == _CHANGED:
                modal_axis[0], modal_axis[1], modal_axis[2] = i, j, k_
        out[at] = _NEWLINE
        at += 1
        row += 1
    return row, at


@kernel(writes="out")
def _format_axis(i: float, j: float, k: float, comma: Bytes, out: Bytes) -> int:
    """Write a tool axis; return the end."""
    return _put_axis(i, j, k, comma, out, 0)


@inner
def _put_text(text: Bytes, out: Bytes, at: int) -> int:
    """Write bytes as they are; return the end."""
    for letter in text:
        out[at] = letter
        at += 1
    return at


@inner
def _put_length(value: float, out: Bytes, at: int) -> int:
    """Write a length in 6, 9, 12 or 15 decimals, the fewest that are exact; return the end, or -1 if none are."""
    for decimals in range(6, 16, 3):
        count = np.rint(abs(value) * POWERS_OF_TEN[decimals])
        if not count <= MAX_EXACT:
            return -1
        if count / POWERS_OF_TEN[decimals] == abs(value):
            return _put_decimal(value < 0.0, int(count), decimals, 6, out, at)
    return -1


@inner
def _put_axis(i: float, j: float, k: float, comma: Bytes, out: Bytes, at: int) -> int:
    """Write a tool axis; return the end."""
    a, b, c = abs(i), abs(j), abs(k)
    near = (a < _NEAR and b < _NEAR) or (a < _NEAR and c < _NEAR) or (b < _NEAR and c < _NEAR)
    begin = at
    for value in (i, j, k):
        if at > begin:
            at = _put_text(comma, out, at)
        decimals = _AXIS_DECIMALS
        if near:
            decimals = _AXIS_DECIMALS_NEAR if abs(value) < _NEAR else 15
        at = _put_decimal(
            value < 0.0, int(np.rint(abs(value) * POWERS_OF_TEN[decimals])), decimals, _AXIS_DECIMALS, out, at
        )
    return at


@inner
def _put_decimal(negative: bool, count: int, decimals: int, fewest: int, out: Bytes, at: int) -> int:
    """Write ``count`` units of the last decimal, without trailing zeros beyond ``fewest`` decimals; return the end."""
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
