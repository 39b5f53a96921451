"""The compiled scan over the bytes of a CL file: points into columns, spans of bytes for everything else.

In:     a buffer of whole lines.
Out:    tip and axis of each plain ``GOTO`` as numbers of the file, and the span of every other statement.
Units:  those of the file; nothing is scaled here.

The kernels know only the syntax; the meaning of a statement is in ``trunnion.cl.statements``.
"""

from typing import NamedTuple

import numpy as np

from trunnion.arrays import Bytes, Floats, Floats2, Ints, Ints2, Lines
from trunnion.decimal_bytes import MAX_DIGITS, MAX_EXACT, POWERS_OF_TEN, parse_decimal
from trunnion.jit import ONE, inlined, inner, kernel, signed, unsigned

#: No CL statement is longer; it bounds the memory that a statement can take.
MAX_STATEMENT_BYTES = 1 << 20

#: Number of columns of a span: offset in the buffer, bytes, line, row before which it stands, marks.
SPAN_COLUMNS = 5

# Marks of a span, which may be combined. Plain integers, since every statement is tested for them.
#: The statement is a motion, and a row is reserved for it.
MAKES_ROW = 1
#: The file ended after a continuation sign.
UNFINISHED = 2
#: The statement is longer than ``MAX_STATEMENT_BYTES``.
TOO_LONG = 4
#: A line that is nothing but a ``$$`` comment.
COMMENT = 8


_TAB, _NEWLINE, _RETURN, _BLANK = 9, 10, 13, 32
_DOLLAR, _PLUS, _COMMA, _MINUS, _POINT, _SLASH, _ZERO, _NINE, _ARROW, _LETTER_A = 36, 43, 44, 45, 46, 47, 48, 57, 62, 65

_GOTO = np.frombuffer(b"GOTO", np.uint8)
_GODLTA = np.frombuffer(b"GODLTA", np.uint8)
_GOHOME = np.frombuffer(b"GOHOME", np.uint8)
_TLON = np.frombuffer(b"TLON", np.uint8)
_GOFWD = np.frombuffer(b"GOFWD", np.uint8)
_CNTRL = np.frombuffer(b"CNTRL", np.uint8)
_RETRCT = np.frombuffer(b"RETRCT", np.uint8)
#: Major words whose text is taken as it stands, dollar signs included.
_TEXT_MAJORS = (
    np.frombuffer(b"PPRINT", np.uint8),
    np.frombuffer(b"INSERT", np.uint8),
    np.frombuffer(b"DISPL", np.uint8),
    np.frombuffer(b"PARTNO", np.uint8),
    np.frombuffer(b"TPRINT", np.uint8),
    np.frombuffer(b"TOOLPATH", np.uint8),
    np.frombuffer(b"STOP", np.uint8),
    np.frombuffer(b"OPSTOP", np.uint8),
    np.frombuffer(b"REMARK", np.uint8),
)


class PointColumns(NamedTuple):
    """The columns that the scan writes.

    tip   (n, 3) float64   NaN in the rows of spans marked ``MAKES_ROW``
    axis  (n, 3) float64   NaN where the GOTO gives no vector
    line  (n,)   int32     line of the file
    """

    tip: Floats2
    axis: Floats2
    line: Lines


class Piece(NamedTuple):
    """Whole lines of a file.

    data   (b,) uint8  the lines are ``data[start:stop]``, and ``data[stop - 1]`` is a newline
    line   of the file that begins at ``start``
    last   the file ends at ``stop``
    """

    data: Bytes
    start: int
    stop: int
    line: int
    last: bool


@kernel(writes="columns spans")
def scan(
    apt: bool, text_width: int, piece: Piece, row: int, columns: PointColumns, spans: Ints2
) -> tuple[int, int, int, int]:
    """Read a piece of a file until its lines, the rows or the spans are used up.

    apt      comments with an arrow are statements, and GOFWD and RETRCT are motions
    text_width  column in which a dollar sign at the end of a line continues a text as well; 0: texts are one line
    row      first row of ``columns`` to write
    spans    (s, 5) int64      written from 0 on, see ``SPAN_COLUMNS``
    returns  where to go on in ``data``, the line there, the next row, number of spans written

    Before the end of the file, a statement whose continuation lies behind ``stop`` is left for the next call.
    """
    # Unpacked once: every access to a field would count references, which takes a quarter of the time.
    tip, axis, lines = columns.tip, columns.axis, columns.line
    data, at, stop, line, last = piece.data, piece.start, piece.stop, piece.line, piece.last
    count = 0
    while at < stop and count < spans.shape[0] and row < lines.shape[0]:
        following, continued = _parse_goto(data, at, stop, tip, axis, row)
        if following > 0 and following - at <= MAX_STATEMENT_BYTES:
            lines[row] = line
            row += 1
            line += 1 + continued
            at = following
            continue
        begin, end, line_count, mark = _find_statement(data, at, stop, apt, text_width)
        if mark & UNFINISHED and not last:
            break
        following = _next_line(data, end)
        if following - at > MAX_STATEMENT_BYTES:
            mark = TOO_LONG
        if end > begin or mark:
            if mark != COMMENT and _makes_row(data, begin, end, apt):
                mark |= MAKES_ROW
            _write_span(spans[count], begin, end, line, row, mark)
            count += 1
            if mark & MAKES_ROW:
                _reserve_row(columns, row, line)
                row += 1
            if mark & TOO_LONG:
                break
        line += line_count
        at = following
    return at, line, row, count


@inner
def _write_span(span: Ints, begin: int, end: int, line: int, row: int, mark: int) -> None:
    span[0], span[1], span[2], span[3], span[4] = begin, end - begin, line, row, mark


@inner
def _reserve_row(columns: PointColumns, row: int, line: int) -> None:
    """Leave a row for the interpreter to write: NaN in tip and axis."""
    columns.line[row] = line
    for k in range(3):
        columns.tip[row, k] = columns.axis[row, k] = np.nan


@inlined
def _parse_goto(data: Bytes, begin: int, stop: int, tip: Floats2, axis: Floats2, row: int) -> tuple[int, int]:
    """Parse a plain ``GOTO/x,y,z[,i,j,k]`` into a row; return the start of the next line, or 0 if it is not plain.

    Blanks may stand around the numbers, a ``$$`` comment behind them, and the statement may be continued after a
    comma; the second value returned counts these lines. Few bounds are checked: the newline at the end of the buffer
    stops every loop.
    """
    continued = 0
    at = unsigned(begin)
    for letter in _GOTO:
        if data[at] != letter:
            return 0, 0
        at += ONE
    at = _skip_spaces(data, at)
    if data[at] != _SLASH:
        return 0, 0
    count = 0
    while count == 0 or data[at] == _COMMA:
        at = _skip_spaces(data, at + ONE)
        if data[at] == _DOLLAR:
            at = _continued_line(data, at, stop)
            continued += 1
        negative = data[at] == _MINUS
        if negative or data[at] == _PLUS:
            at += ONE
        mantissa, digits, decimals, _, at = parse_decimal(data, at)
        if digits == 0 or digits > MAX_DIGITS or mantissa > MAX_EXACT or count == 6:
            return 0, 0
        value = mantissa / POWERS_OF_TEN[decimals]
        if negative:
            value = -value
        if count < 3:
            tip[row, count] = value
        else:
            axis[row, count - 3] = value
        count += 1
        at = _skip_spaces(data, at)
    if count == 3:
        axis[row, 0] = axis[row, 1] = axis[row, 2] = np.nan
    elif count != 6:
        return 0, 0
    return _next_line_after_comment(data, at), continued


@inlined
def _skip_spaces(data: Bytes, at: int) -> int:
    """Place (uint64) of the next byte that is no space."""
    while data[at] == _BLANK:
        at += ONE
    return at


@inner
def _continued_line(data: Bytes, at: int, stop: int) -> int:
    """First byte behind blanks in the line after the continuation sign at ``at`` (uint64); ``at`` if there is none."""
    end = _skip_spaces(data, at + ONE)
    if data[end] == _RETURN:
        end += ONE
    if data[end] != _NEWLINE or signed(end + ONE) >= stop:
        return at
    return _skip_spaces(data, end + ONE)


@inlined
def _next_line_after_comment(data: Bytes, at: int) -> int:
    """Start of the next line if there are but numbers in a ``$$`` comment between ``at`` (uint64) and it; else 0."""
    if data[at] == _DOLLAR and data[at + ONE] == _DOLLAR:
        while not _may_end_comment(data[at]):
            at += ONE
    if data[at] == _RETURN:
        at += ONE
    return signed(at + ONE) if data[at] == _NEWLINE else 0


@inlined
def _may_end_comment(byte: int) -> bool:
    """Whether a byte of a comment may belong to a statement in it: a letter, or a control character."""
    return byte >= _LETTER_A or (byte < _BLANK and byte != _TAB)


@inner
def _find_statement(data: Bytes, at: int, stop: int, apt: bool, text_width: int) -> tuple[int, int, int, int]:
    """Begin, end, lines and mark of the statement at ``at``, without blanks and comment around it; it may be empty."""
    first = at
    while _is_blank(data[at]) and data[at] != _NEWLINE:
        at += 1
    if data[at] == _DOLLAR and data[at + 1] == _DOLLAR:
        if not apt or data[at + 2] != _MINUS or data[at + 3] != _ARROW:
            content, end = _find_content_end(data, at, True)
            return at, content, 1, COMMENT
        at += 2  # "$$-> WORD / ..." is a statement, which may be continued
    begin = at
    content, end = _find_content_end(data, at, False)
    dollars = data[end] == _DOLLAR or (content > at and data[content - 1] == _DOLLAR)
    lines = 1
    if dollars and content > begin and _is_text_statement(data, begin, content):
        content, end = _find_content_end(data, at, True)
        while text_width and content - first == text_width and data[content - 1] == _DOLLAR:
            first = _next_line(data, end)
            if first >= stop:
                return begin, content, lines, UNFINISHED
            lines += 1
            content, end = _find_content_end(data, first, True)
        return begin, content, lines, 0
    while content > at and data[content - 1] == _DOLLAR:
        # The rest of the line after a continuation sign is a comment.
        at = _next_line(data, end)
        if at >= stop:
            return begin, content, lines, UNFINISHED
        lines += 1
        content, end = _find_content_end(data, at, False)
    return begin, max(content, begin, _end_of_full_comment(data, end)), lines, 0


@inner
def _end_of_full_comment(data: Bytes, at: int) -> int:
    """End of the comment at ``at`` if a statement may stand in it, for the interpreter to see; else 0."""
    if data[at] == _NEWLINE:
        return 0
    content, _ = _find_content_end(data, at, True)
    for place in range(at, content):
        if _may_end_comment(data[place]):
            return content
    return 0


@inner
def _find_content_end(data: Bytes, at: int, text: bool) -> tuple[int, int]:
    """End of the content of the line at ``at``, and the place of its ``$$`` comment (not in text) or newline."""
    content = at
    while data[at] != _NEWLINE and (text or data[at] != _DOLLAR or data[at + 1] != _DOLLAR):
        if not _is_blank(data[at]):
            content = at + 1
        at += 1
    return content, at


@inner
def _next_line(data: Bytes, at: int) -> int:
    """Start of the next line."""
    while data[at] != _NEWLINE:
        at += 1
    return at + 1


@inner
def _is_blank(byte: int) -> bool:
    return byte in (_BLANK, _TAB, _RETURN, _NEWLINE)


@inner
def _skip_word(data: Bytes, at: int, stop: int, word: Bytes) -> int:
    """Return the end of ``word`` if it stands at ``at``, in upper or lower case and with blanks anywhere; else 0."""
    for letter in word:
        while at < stop and (_is_blank(data[at]) or data[at] == _DOLLAR):
            at += 1
        if at >= stop or (data[at] != letter and data[at] != letter + 32):
            return 0
        at += 1
    while at < stop and (_is_blank(data[at]) or data[at] == _DOLLAR):
        at += 1
    return at


@inner
def _makes_row(data: Bytes, begin: int, end: int, apt: bool) -> bool:
    """Whether a statement is a motion: GOTO/, GODLTA/, CNTRL/, GOHOME/ with a number; in APT also GOFWD/ and RETRCT."""
    for word in (_GOTO, _GODLTA, _CNTRL):
        at = _skip_word(data, begin, end, word)
        if at and at < end and data[at] == _SLASH:
            return True
    if apt:
        at = _skip_word(data, begin, end, _TLON)
        if at and at < end and data[at] == _COMMA:
            at += 1
        at = _skip_word(data, max(at, begin), end, _GOFWD)
        if at and at < end and data[at] == _SLASH:
            return True
        at = _skip_word(data, begin, end, _RETRCT)
        if at and (at >= end or data[at] == _SLASH):
            return True
    at = _skip_word(data, begin, end, _GOHOME)
    if at == 0 or at >= end or data[at] != _SLASH:
        return False
    at += 1
    while at < end and (_is_blank(data[at]) or data[at] == _DOLLAR):
        at += 1
    if at < end and (data[at] == _PLUS or data[at] == _MINUS or data[at] == _POINT):
        return True
    return at < end and _ZERO <= data[at] <= _NINE


@inner
def _is_text_statement(data: Bytes, begin: int, end: int) -> bool:
    """Whether a statement carries text, in which a dollar sign is a dollar sign."""
    for word in _TEXT_MAJORS:  # noqa: SIM110 - Numba has no generators here
        if _skip_word(data, begin, end, word):
            return True
    return False


@kernel(writes="axis modal_axis bad")
def fill_modal_axes(axis: Floats2, start: int, stop: int, modal_axis: Floats, bad: Ints) -> int:
    """Give rows without a vector the one before them, and every vector the length 1.

    axis        (n, 3) float64   rows ``start:stop`` are changed in place
    modal_axis  (3,)   float64   the vector before ``start``; on return the one of the last row
    bad         (b,)   int64     written: the first rows whose vector is zero, or more than 1 % off length 1
    returns     how many such rows there are
    """
    bad_count = 0
    i, j, k = modal_axis[0], modal_axis[1], modal_axis[2]
    for row in range(start, stop):
        if not np.isnan(axis[row, 0]):
            i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
            length = np.sqrt(i * i + j * j + k * k)
            if not 0.99 <= length <= 1.01:
                if bad_count < bad.shape[0]:
                    bad[bad_count] = row
                bad_count += 1
            elif abs(length - 1.0) > 1e-15:
                i, j, k = i / length, j / length, k / length
        axis[row, 0], axis[row, 1], axis[row, 2] = i, j, k
    modal_axis[0], modal_axis[1], modal_axis[2] = i, j, k
    return bad_count
