"""Plain motion blocks of letters and numbers straight from bytes to columns.

In:     bytes of a program, whole lines; where the control stands; columns with room.
Out:    rows for the blocks that hold nothing but N, G0 or G1, X Y Z, rotary words, A3= B3= C3= and F with plain
        numbers; the place of the first block that holds anything else, which is the interpreter's.
Units:  mm and degrees; ``lengths`` and ``feeds`` turn inches into mm.

What letters and signs mean in a language is in the table of ``letter_table``.

A line is read to its end before anything is written: a line that turns out not to be plain has had no effect. Numbers
have at most 15 digits, so that mantissa and power of ten are exact and the quotient is the nearest double, the same
that Python would read; longer ones are the interpreter's.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Bytes, Codes, Floats, Floats2, Ints
from trunnion.jit import ONE, kernel, signed, unsigned
from trunnion.readers.scan.buffers import COMMENTS, FEEDS, KIND, LINE, POSITION, ROW, ScanRecords, ScanTarget

NUMBER: Final = 1
PREPARATORY: Final = 2
FEED: Final = 3
SLIDE: Final = 4  # and the two after it: X, Y, Z
ROTARY: Final = 7  # and the one after it
VECTOR: Final = 9  # and the two after it: the tool axis
COMMENT: Final = 12
ASSIGN: Final = 13
GAP: Final = 14

#: What a byte means, and the flag that its whole numbers are none of the kernel's.
_MEANING: Final = 15
_POINTED: Final = 16

_POWERS: Final = np.array([10.0**k for k in range(23)])

#: Digits that a double holds exactly, whatever they are.
_DIGITS: Final = 15

#: Larger numbers are looked at by the interpreter, which knows how far machines reach.
_MAX_NUMBER: Final = 1e5

_TAB: Final = 9
_LF: Final = 10
_CR: Final = 13
_SPACE: Final = 32
_PLUS: Final = 43
_MINUS: Final = 45
_POINT: Final = 46
_ZERO: Final = 48
_THREE: Final = 51
_EQUALS: Final = 61


def letter_table(
    rotary: tuple[str, str],
    *,
    comment: str = "",
    assign: str = "",
    gaps: bool = False,
    pointed: str = "",
    vector: str = "",
) -> Codes:
    """Table (256,) uint8 from a byte to what it means to ``scan``.

    rotary    names of the two rotary axes
    comment   what begins a comment that goes on to the end of the line
    assign    what may stand between the letter of an axis and its number
    gaps      blanks may stand there
    vector    letters of the tool axis, besides A3= B3= C3=
    pointed   letters whose numbers need a point, 0 apart: others are counted in increments
    """
    table = np.zeros(256, np.uint8)
    meanings = {"N": NUMBER, "G": PREPARATORY, "F": FEED, "X": SLIDE, "Y": SLIDE + 1, "Z": SLIDE + 2}
    for column, name in enumerate(rotary):
        if len(name) == 1:
            meanings.setdefault(name.upper(), ROTARY + column)
    meanings |= {letter: VECTOR + axis for axis, letter in enumerate(vector)}
    for letter, meaning in meanings.items():
        flag = _POINTED if letter in pointed else 0
        table[ord(letter)] = table[ord(letter.lower())] = meaning | flag
    for sign, meaning in ((comment, COMMENT), (assign, ASSIGN), (" " if gaps else "", GAP)):
        if sign:
            table[ord(sign)] = meaning
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
    vectors   bool             A3= B3= C3= are allowed
    frame     (3, 4) float64   from programmed position to ``target.xyz``
    turn      (3, 3) float64   from programmed vector to ``target.vector``
    counts    (6,) int64       KIND, ROW, COMMENTS, POSITION (byte), LINE (of the next block) and FEEDS, updated
    place     (5,) float64     programmed X Y Z, mm, feed, and feed of the row before, updated
    """
    kind = counters[KIND]
    row = counters[ROW]
    noted = counters[COMMENTS]
    feeds_noted = counters[FEEDS]
    position = counters[POSITION]
    line = counters[LINE]
    comments = records.comments
    room = min(target.kind.shape[0], target.base + target.turn_rule.shape[0])
    values = records.numbers
    gaps = table[_SPACE] == GAP
    while position < end and row < room and noted < comments.shape[0] and feeds_noted < records.feed_values.shape[0]:
        at = unsigned(position)
        seen = 0
        number = -1
        motion = kind
        plain = True
        comment = -1
        while True:
            char = text[at]
            if char in (_SPACE, _TAB, _CR):
                at += ONE
                continue
            if char == _LF:
                break
            if table[char] == COMMENT:
                comment = signed(at + ONE)
                while text[at] != _LF:
                    at += ONE
                break
            what = int(table[char]) & _MEANING
            pointed = (table[char] & _POINTED) != 0
            upper = char & 0xDF
            slot = what
            at += ONE
            if vectors and 65 <= upper <= 67 and text[at] == _THREE and text[at + ONE] == _EQUALS:
                slot = VECTOR + upper - 65
                what = ROTARY
                at += ONE + ONE
            elif what == 0 or what > VECTOR + 2:
                plain = False
                break
            elif what >= SLIDE and table[text[at]] == ASSIGN:
                at += ONE
            while gaps and (text[at] == _SPACE or text[at] == _TAB):
                at += ONE
            if seen & (1 << slot) or (what == NUMBER and seen != 0):
                plain = False
                break
            seen |= 1 << slot
            # The number: sign, digits, point, digits.
            negative = False
            if what >= SLIDE and (text[at] == _PLUS or text[at] == _MINUS):
                negative = text[at] == _MINUS
                at += ONE
            mantissa = 0
            decimals = 0
            first = at
            digit = int(text[at]) - _ZERO
            while 0 <= digit <= 9:
                mantissa = 10 * mantissa + digit
                at += ONE
                digit = int(text[at]) - _ZERO
            digits = signed(at - first)
            point = what > PREPARATORY and text[at] == _POINT
            if point:
                at += ONE
                first = at
                digit = int(text[at]) - _ZERO
                while 0 <= digit <= 9:
                    mantissa = 10 * mantissa + digit
                    at += ONE
                    digit = int(text[at]) - _ZERO
                decimals = signed(at - first)
                digits += decimals
            # Of more digits than fit into a mantissa nothing is used.
            if digits == 0 or digits > _DIGITS or (pointed and not point and mantissa != 0):
                plain = False
                break
            # What may follow a number: a blank, the end, a comment, or a word of one letter that this kernel knows.
            follows = text[at]
            if not (
                follows in (_SPACE, _TAB, _CR, _LF) or table[follows] != 0 or (vectors and 65 <= (follows & 0xDF) <= 67)
            ):
                plain = False
                break
            if what == NUMBER:
                number = mantissa
            elif what == PREPARATORY:
                if mantissa > 1 or digits > 2:
                    plain = False
                    break
                motion = mantissa
            else:
                value = mantissa / _POWERS[decimals]
                if value > _MAX_NUMBER:
                    plain = False
                    break
                values[slot] = -value if negative else value
        moves = (seen >> SLIDE) & 0xFF
        if not plain or (moves and motion > 1) or ((moves >> 5) and (moves & 0b11000)):
            break
        kind = motion
        if seen & (1 << FEED):
            commanded[3] = values[FEED] * feed_unit
        for k in range(3):
            if seen & (1 << (SLIDE + k)):
                commanded[k] = values[SLIDE + k] * length_unit
        if moves:
            pending = row - target.base
            target.line[pending] = line
            target.block_number[pending] = number
            target.kind[row] = kind
            # A feed that is not known (NaN) differs from itself, but is no change.
            if commanded[3] != commanded[4] and (commanded[3] == commanded[3] or commanded[4] == commanded[4]):
                records.feed_rows[feeds_noted] = row
                records.feed_values[feeds_noted] = commanded[3]
                commanded[4] = commanded[3]
                feeds_noted += 1
            bits = moves & 0b11111
            if seen & (1 << FEED):
                bits |= 64
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
            if moves >> 5:
                bits |= 32
                for k in range(3):
                    # Components that a block does not write count as zero.
                    values[9 + k] = values[9 + k] if seen & (1 << (9 + k)) else 0.0
                for k in range(3):
                    target.vector[pending, k] = (
                        vector_map[k, 0] * values[9] + vector_map[k, 1] * values[10] + vector_map[k, 2] * values[11]
                    )
            target.programmed[row] = bits
            target.turn_rule[pending] = turn_rule
            row += 1
        if comment >= 0:
            comments[noted, 0] = line
            comments[noted, 1] = row
            comments[noted, 2] = comment
            comments[noted, 3] = signed(at)
            noted += 1
        position = signed(at + ONE)
        line += 1
    counters[KIND] = kind
    counters[ROW] = row
    counters[COMMENTS] = noted
    counters[FEEDS] = feeds_noted
    counters[POSITION] = position
    counters[LINE] = line
