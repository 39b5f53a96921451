"""Plain Klartext blocks straight from bytes to columns.

In:     bytes of a program, whole lines; where the control stands; columns with room.
Out:    rows for the blocks that are ``L`` with nothing but X Y Z, rotary words, R0, F or FMAX, with plain numbers, or
        ``LN`` with NX NY NZ and TX TY TZ besides; the place of the first block that is anything else, which is the
        interpreter's.
Units:  mm and degrees; ``lengths`` and ``feeds`` turn inches into mm.

A line is read to its end before anything is written: a line that turns out not to be plain has had no effect. Numbers
have at most 15 digits, so that mantissa and power of ten are exact and the quotient is the nearest double, the same
that Python would read; longer ones are the interpreter's.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Bytes, Codes, Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.readers.scan.buffers import COMMENTS, FEEDS, LINE, NORMALS, POSITION, ROW, ScanRecords, ScanTarget

FEED: Final = 1
COMPENSATION: Final = 2
SLIDE: Final = 3  # and the two after it: X, Y, Z
ROTARY: Final = 6  # and the one after it
TOOL: Final = 8  # and the two after it: TX, TY, TZ
NORMAL: Final = 11  # and the two after it: NX, NY, NZ

_POWERS: Final = np.array([10.0**k for k in range(23)])

#: Larger numbers are looked at by the interpreter, which knows how far machines reach.
_MAX_NUMBER: Final = 1e5

_TAB: Final = 9
_LF: Final = 10
_CR: Final = 13
_SPACE: Final = 32
_PLUS: Final = 43
_COMMA: Final = 44
_MINUS: Final = 45
_POINT: Final = 46
_ZERO: Final = 48
_NINE: Final = 57
_SEMICOLON: Final = 59
_A: Final = 65
_L: Final = 76
_M: Final = 77
_N: Final = 78
_T: Final = 84
_X: Final = 88
_Z: Final = 90
_CAPITAL: Final = 0xDF


def letter_table(rotary: tuple[str, str]) -> Codes:
    """Table (256,) uint8 from a byte to what it means to ``scan``, for the names of the two rotary axes or ""."""
    table = np.zeros(256, np.uint8)
    meanings = {"F": FEED, "R": COMPENSATION, "X": SLIDE, "Y": SLIDE + 1, "Z": SLIDE + 2}
    for column, name in enumerate(rotary):
        if len(name) == 1:
            meanings.setdefault(name.upper(), ROTARY + column)
    for letter, meaning in meanings.items():
        table[ord(letter)] = table[ord(letter.lower())] = meaning
    return table


@kernel(writes="counters commanded target records")
def scan_blocks(
    text: Bytes,
    end: int,
    table: Codes,
    vectors: bool,
    length_unit: float,
    feed_unit: float,
    turn_rule: int,
    position_map: Floats2,
    vector_map: Floats2,
    counters: Ints,
    commanded: Floats,
    target: ScanTarget,
    records: ScanRecords,
) -> None:
    """Take plain blocks until one is not, the text ends, or the columns or the notes are full.

    text      (m,) uint8       the program; whole lines up to ``end``
    table     (256,) uint8     from ``letter_table``
    vectors   bool             TX TY TZ are allowed
    frame     (3, 4) float64   from programmed position to ``target.xyz``
    turn      (3, 3) float64   from programmed vector to ``target.vector``
    counts    (6,) int64       see ``trunnion.readers.scan.buffers``, updated
    place     (5,) float64     programmed X Y Z, mm, feed, and feed of the row before, updated
    """
    row = counters[ROW]
    noted = counters[COMMENTS]
    feeds_noted = counters[FEEDS]
    normals_noted = counters[NORMALS]
    position = counters[POSITION]
    line = counters[LINE]
    comments = records.comments
    room = min(target.kind.shape[0], target.base + target.turn_rule.shape[0])
    values = np.zeros(14)
    while (
        position < end
        and row < room
        and noted < comments.shape[0]
        and feeds_noted < records.feed_values.shape[0]
        and normals_noted < records.normal_rows.shape[0]
    ):
        at = position
        seen = 0
        number = -1
        rapid = False
        comment = -1
        while text[at] == _SPACE or text[at] == _TAB:
            at += 1
        if _ZERO <= text[at] <= _NINE:
            number = 0
            digits = 0
            while _ZERO <= text[at] <= _NINE and digits < 15:
                number = 10 * number + int(text[at]) - _ZERO
                digits += 1
                at += 1
            while text[at] == _SPACE or text[at] == _TAB:
                at += 1
        # The comment of a whole line, or L and a blank.
        plain = text[at] == _SEMICOLON
        spatial = False
        if (text[at] & _CAPITAL) == _L:
            at += 1
            spatial = (text[at] & _CAPITAL) == _N
            at += spatial
            plain = text[at] == _SPACE or text[at] == _TAB
        while plain:
            char = text[at]
            if char in (_SPACE, _TAB, _CR):
                at += 1
                continue
            if char == _LF:
                break
            if char == _SEMICOLON:
                comment = at + 1
                while text[at] != _LF:
                    # A comment that ends in ~ may hold together the lines of a block.
                    plain = plain and text[at] != 126
                    at += 1
                break
            what = int(table[char])
            upper = char & _CAPITAL
            if spatial and (upper == _N or (upper == _T and vectors)) and _X <= (text[at + 1] & _CAPITAL) <= _Z:
                what = (NORMAL if upper == _N else TOOL) + (text[at + 1] & _CAPITAL) - _X
                at += 1
            if what == 0 or seen & (1 << what):
                plain = False
                break
            seen |= 1 << what
            at += 1
            if what == FEED and (text[at] & _CAPITAL) == _M:
                plain = (text[at + 1] & _CAPITAL) == _A and (text[at + 2] & _CAPITAL) == _X
                rapid = plain
                if not plain:
                    break
                at += 3
            else:
                while what >= SLIDE and (text[at] == _SPACE or text[at] == _TAB):
                    at += 1
                negative = False
                if what >= SLIDE and (text[at] == _PLUS or text[at] == _MINUS):
                    negative = text[at] == _MINUS
                    at += 1
                mantissa = 0
                digits = 0
                decimals = 0
                point = False
                while True:
                    char = text[at]
                    if _ZERO <= char <= _NINE:
                        mantissa = 10 * mantissa + int(char) - _ZERO
                        digits += 1
                        if point:
                            decimals += 1
                    elif char in (_POINT, _COMMA) and not point:
                        point = True
                    else:
                        break
                    at += 1
                    if digits > 15:
                        break
                if digits == 0 or digits > 15:
                    plain = False
                    break
                value = mantissa / _POWERS[decimals]
                if value > _MAX_NUMBER or (what == COMPENSATION and (mantissa != 0 or point)):
                    plain = False
                    break
                values[what] = -value if negative else value
            # What may follow a word: a blank, the end, a comment, or a letter that this kernel knows.
            follows = text[at]
            if not (follows in (_SPACE, _TAB, _CR, _LF, _SEMICOLON) or table[follows] != 0):
                plain = False
                break
        if not plain:
            break
        moves = (seen >> SLIDE) & 0xFF
        tilts = moves >> 5
        # A vector beside rotary words, or without a length, is for the interpreter to name.
        if tilts:
            for k in range(3):
                values[TOOL + k] = values[TOOL + k] if seen & (1 << (TOOL + k)) else 0.0
            if moves & 0b11000 or (values[TOOL] == 0.0 and values[TOOL + 1] == 0.0 and values[TOOL + 2] == 0.0):
                break
        if seen & (1 << FEED) and not rapid:
            commanded[3] = values[FEED] * feed_unit
        for k in range(3):
            if seen & (1 << (SLIDE + k)):
                commanded[k] = values[SLIDE + k] * length_unit
        if moves:
            pending = row - target.base
            target.line[pending] = line
            target.block_number[pending] = number
            target.kind[row] = 0 if rapid else 1
            # A feed that is not known (NaN) differs from itself, but is no change.
            if commanded[3] != commanded[4] and (commanded[3] == commanded[3] or commanded[4] == commanded[4]):
                records.feed_rows[feeds_noted] = row
                records.feed_values[feeds_noted] = commanded[3]
                commanded[4] = commanded[3]
                feeds_noted += 1
            for k in range(3):
                target.xyz[row, k] = (
                    position_map[k, 0] * commanded[0]
                    + position_map[k, 1] * commanded[1]
                    + position_map[k, 2] * commanded[2]
                    + position_map[k, 3]
                )
            for k in range(2):
                target.rotary[row, k] = values[ROTARY + k] if seen & (1 << (ROTARY + k)) else np.nan
            target.vector[pending, 0] = np.nan
            if tilts:
                for k in range(3):
                    target.vector[pending, k] = (
                        vector_map[k, 0] * values[TOOL]
                        + vector_map[k, 1] * values[TOOL + 1]
                        + vector_map[k, 2] * values[TOOL + 2]
                    )
            bits = (moves & 0b11111) | (32 if tilts else 0)
            target.programmed[row] = bits | (64 if seen & (1 << FEED) and not rapid else 0)
            target.turn_rule[pending] = turn_rule
            if seen >> NORMAL:
                for k in range(3):
                    values[NORMAL + k] = values[NORMAL + k] if seen & (1 << (NORMAL + k)) else 0.0
                for k in range(3):
                    records.normals[normals_noted, k] = (
                        vector_map[k, 0] * values[NORMAL]
                        + vector_map[k, 1] * values[NORMAL + 1]
                        + vector_map[k, 2] * values[NORMAL + 2]
                    )
                records.normal_rows[normals_noted] = row
                normals_noted += 1
            row += 1
        if comment >= 0:
            comments[noted, 0] = line
            comments[noted, 1] = row
            comments[noted, 2] = comment
            comments[noted, 3] = at
            noted += 1
        position = at + 1
        line += 1
    counters[ROW] = row
    counters[COMMENTS] = noted
    counters[FEEDS] = feeds_noted
    counters[NORMALS] = normals_noted
    counters[POSITION] = position
    counters[LINE] = line
