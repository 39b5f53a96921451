"""The compiled scan over CL files of pairs of lines, as Mastercam writes them: a code, and below it its values.

In:     a buffer of whole lines.
Out:    tip and axis of plain lines (records 1 and 11) as numbers of the file, and the span of every other pair.
Units:  those of the file; nothing is scaled here.

A record is plain where the one before it in the same piece had the same feed and the same place in the contour, so that
nothing changes but the point. All others go to their handlers in ``trunnion.cl.statements.nci_motion``.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Bytes, Floats, Ints, Ints2
from trunnion.cl.scan import MAKES_ROW, MAX_STATEMENT_BYTES, TOO_LONG, UNFINISHED, Piece, PointColumns
from trunnion.decimal_bytes import MAX_DIGITS, MAX_EXACT, POWERS_OF_TEN, parse_decimal
from trunnion.jit import ONE, inner, kernel, signed, unsigned

#: How far the second point of a record 11 may be from the tip plus the vector: all are printed with six decimals.
SECOND_POINT_TOLERANCE: Final = 1e-5

#: Values of a record 0 or 1, and of a record 11.
LINE_VALUES: Final = 6
FIVE_AXIS_VALUES: Final = 12

_TAB, _NEWLINE, _RETURN, _END, _BLANK = 9, 10, 13, 26, 32
_PLUS, _MINUS, _ZERO, _NINE = 43, 45, 48, 57

#: Feeds of the record before: none in this piece; unchanged from one that the piece does not have.
_NO_FEED, _UNCHANGED, _RAPID = -3.0, -1.0, -2.0

#: Places in the contour that several records in a row may have.
_BEFORE, _WITHIN, _BEHIND = 42.0, 22.0, 52.0

#: No code has more digits.
_CODE_DIGITS = 6


def scan_pairs(piece: Piece, row: int, columns: PointColumns, spans: Ints2) -> tuple[int, int, int, int]:
    """Read a piece of a file; ``trunnion.cl.text_format.Scan`` says how."""
    return pair_scan(piece, row, columns, spans, np.empty(FIVE_AXIS_VALUES))


@kernel(writes="columns spans values")
def pair_scan(piece: Piece, row: int, columns: PointColumns, spans: Ints2, values: Floats) -> tuple[int, int, int, int]:
    """Read a piece of a file until its lines, the rows or the spans are used up.

    row      first row of ``columns`` to write
    spans    (s, 5) int64     written from 0 on
    values   (12,)  float64   room for the values of a record
    returns  where to go on in ``data``, the line there, the next row, number of spans written
    """
    tip, axis, lines = columns.tip, columns.axis, columns.line
    data, at, stop, line, last = piece.data, piece.start, piece.stop, piece.line, piece.last
    count = 0
    feed, place = _NO_FEED, 0.0
    while at < stop and count < spans.shape[0] and row < lines.shape[0]:
        code, middle = _code_of(data, at)
        if code < 0 and _is_blank_to(data, at, stop):
            if last:
                at = stop
            break
        if middle >= stop:
            if not last:
                break
            _write_pair(spans[count], at, middle - 1, line, row, UNFINISHED)
            count += 1
            at = middle
            break
        given, following = _values_of(data, middle, values)
        mark = TOO_LONG if following - at > MAX_STATEMENT_BYTES else 0
        is_line = (code == 0 or code == 1) and given == LINE_VALUES
        is_five_axis = code == 11 and given == FIVE_AXIS_VALUES
        if mark == 0 and (
            (is_five_axis and _is_plain_five_axis(values, feed, place))
            or (is_line and code == 1 and values[0] == 0.0 and values[5] == 0.0 and _goes_on(values[4], feed))
        ):
            first = 0 if is_five_axis else 1
            for k in range(3):
                tip[row, k] = values[first + k]
                axis[row, k] = values[9 + k] if is_five_axis else np.nan
            lines[row] = line
            row += 1
            line += 2
            at = following
            continue
        if is_line or is_five_axis:
            feed = _feed_behind(values[6] if is_five_axis else values[4], feed)
            place = values[7] if is_five_axis else 0.0
        else:
            feed, place = _NO_FEED, 0.0
        if mark == 0 and (0 <= code <= 3 or code in (11, 81, 100)):
            mark = MAKES_ROW
            lines[row] = line
            for k in range(3):
                tip[row, k] = axis[row, k] = np.nan
        _write_pair(spans[count], at, following - 1, line, row, mark)
        count += 1
        if mark & MAKES_ROW:
            row += 1
        if mark & TOO_LONG:
            break
        line += 2
        at = following
    return at, line, row, count


@inner
def _write_pair(span: Ints, begin: int, end: int, line: int, row: int, mark: int) -> None:
    span[0], span[1], span[2], span[3], span[4] = begin, end - begin, line, row, mark


@inner
def _code_of(data: Bytes, at: int) -> tuple[int, int]:
    """Return the code in the line at ``at``, -1 if the line has anything else, and the start of the line below."""
    code, digits = 0, 0
    while data[at] == _BLANK or data[at] == _TAB:
        at += 1
    while _ZERO <= data[at] <= _NINE and digits <= _CODE_DIGITS:
        code = code * 10 + int(data[at]) - _ZERO
        digits += 1
        at += 1
    while data[at] == _BLANK or data[at] == _TAB or data[at] == _RETURN:
        at += 1
    is_plain = data[at] == _NEWLINE and 0 < digits <= _CODE_DIGITS
    while data[at] != _NEWLINE:
        at += 1
    return (code if is_plain else -1), at + 1


@inner
def _is_blank_to(data: Bytes, at: int, stop: int) -> bool:
    """Whether there is nothing but blanks and the end mark of a DOS file."""
    while at < stop:
        byte = data[at]
        if byte not in (_BLANK, _TAB, _RETURN, _NEWLINE, _END):
            return False
        at += 1
    return True


@inner
def _values_of(data: Bytes, begin: int, values: Floats) -> tuple[int, int]:
    """Count of plain numbers of the line at ``begin``, written to ``values``, and the start of the line behind it.

    The count is 0 where there is anything but plain numbers, or more of them than have room.
    """
    count = 0
    at = unsigned(begin)
    while True:
        while data[at] == _BLANK or data[at] == _TAB or data[at] == _RETURN:
            at += ONE
        if data[at] == _NEWLINE:
            return count, signed(at + ONE)
        negative = data[at] == _MINUS
        if negative or data[at] == _PLUS:
            at += ONE
        mantissa, digits, decimals, _, at = parse_decimal(data, at)
        plain = 0 < digits <= MAX_DIGITS and mantissa <= MAX_EXACT and count < values.shape[0]
        byte = data[at]
        if not plain or byte not in (_BLANK, _TAB, _RETURN, _NEWLINE):
            while data[at] != _NEWLINE:
                at += ONE
            return 0, signed(at + ONE)
        value = mantissa / POWERS_OF_TEN[decimals]
        values[count] = -value if negative else value
        count += 1


@inner
def _goes_on(feed: float, before: float) -> bool:
    """Whether a record cuts with the feed of the one before it, which cuts as well."""
    if feed == _UNCHANGED:
        return before > 0.0 or before == _UNCHANGED
    return feed > 0.0 and feed == before


@inner
def _feed_behind(feed: float, before: float) -> float:
    """Return the feed that the next record is compared with."""
    if feed == _UNCHANGED and before > 0.0:
        return before
    return feed


@inner
def _is_plain_five_axis(values: Floats, feed: float, place: float) -> bool:
    """Whether a record 11 changes nothing but the point, and its second point is the tip plus the vector."""
    if values[7] != place or (place != _WITHIN and place != _BEFORE and place != _BEHIND) or values[8] != 0.0:
        return False
    for k in range(3):
        if abs(values[k] + values[9 + k] - values[3 + k]) > SECOND_POINT_TOLERANCE:
            return False
    return _goes_on(values[6], feed)
