"""Numbers and points of a CL file as text.

Lengths get the decimals that NX gives them, or as many more as they need to be exact. Tool axes get 12 decimals, and 17
within a twentieth of a degree of X, Y or Z, where the direction in which the tool leans depends on the last of them.
"""

from collections.abc import Iterable
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Bytes, Floats, Floats2
from trunnion.decimal_bytes import MAX_EXACT, POWERS_OF_TEN
from trunnion.jit import inner, kernel
from trunnion.model.toolpath import Moves

#: Rows that the kernel writes at a time, and the most bytes that one of them can take.
CHUNK = 1 << 15
_MAX_LINE_BYTES = 192

_INT_POWERS_OF_TEN = 10 ** np.arange(19, dtype=np.int64)
_AXIS_DECIMALS = 12
_AXIS_DECIMALS_NEAR = 17
#: Sine of the tilt against X, Y or Z below which a tool axis gets all decimals.
_NEAR = 1e-3

_GOTO = np.frombuffer(b"GOTO/", np.uint8)
_COMMA, _MINUS, _POINT, _ZERO, _NEWLINE = 44, 45, 46, 48, 10


def encode_lines(lines: Iterable[str]) -> bytes:
    """Lines as bytes of the file."""
    return "".join(f"{line}\n" for line in lines).encode()


def number_text(value: float, decimals: int) -> str:
    """A number with these decimals, or with as many more as it needs to be exact."""
    text = f"{value + 0.0:.{decimals}f}"
    return text if float(text) == value else np.format_float_positional(value, unique=True, trim="0")


def axis_texts(axis: tuple[float, float, float]) -> list[str]:
    """The numbers of a tool axis, as the kernel writes them."""
    line = np.empty(_MAX_LINE_BYTES, np.uint8)
    at = _format_axis(*axis, line)
    return line[1:at].tobytes().decode().split(",")


def write_points(moves: Moves, first: int, last: int, modal_axis: Floats, sink: BinaryIO) -> None:
    """Write the rows from ``first`` up to ``last``; ``modal_axis`` (3,) is the tool axis written last, updated."""
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
    """Write a row whose numbers have more digits than the kernel writes."""
    numbers = [number_text(value, 6) for value in moves.tip[row].tolist()]
    i, j, k = moves.axis[row].tolist()
    if (i, j, k) != tuple(modal_axis.tolist()):
        numbers += axis_texts((i, j, k))
        modal_axis[:] = i, j, k
    sink.write(encode_lines([f"GOTO/{','.join(numbers)}"]))


@kernel(writes="modal_axis out")
def _format_points(tip: Floats2, axis: Floats2, row: int, stop: int, modal_axis: Floats, out: Bytes) -> tuple[int, int]:
    """Write GOTO lines up to ``stop`` or a row with more than 15 digits; return that row and the number of bytes.

    tip       (n, 3) float64   mm
    axis      (n, 3) float64
    modal_axis (3,)  float64   the axis written last, updated
    out       (b,)   uint8     ``_MAX_LINE_BYTES`` bytes for each row
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
    """Write a length in 6, 9, 12 or 15 decimals, the fewest that are exact; return the end, or -1 if none are."""
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
