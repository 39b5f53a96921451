"""Scan kernel of languages whose blocks are letters with numbers: Sinumerik, Fanuc, LinuxCNC and Fidia.

In:     bytes of a program, whole lines; the settings of the control; columns with room.
Out:    words of plain blocks, which hold nothing but N, G0 to G3, X Y Z, rotary words, A3= B3= C3=, I J K and F with
        plain numbers; the position of the first block that holds anything else, which is left to the interpreter.
Units:  mm and degrees; ``ScanSettings`` converts inches.

What letters and signs mean in a language is in the table made by ``letter_table``. A line is read to its end before
anything is written: a line that turns out not to be plain has no effect.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Bytes, Codes
from trunnion.decimal_bytes import EXACT_DIGITS, POWERS_OF_TEN, parse_decimal
from trunnion.jit import ONE, kernel, signed, unsigned
from trunnion.readers.scan.buffers import (
    CENTRE,
    CENTRE_BITS,
    FEED,
    MOTION_BITS,
    ROTARY,
    ROTARY_BITS,
    SLIDE,
    VECTOR,
    VECTOR_BITS,
    BlockModes,
    BlockWords,
)
from trunnion.readers.scan.characters import (
    BLANK,
    CAPITAL,
    LINE_FEED,
    MAX_NUMBER,
    MINUS,
    PLUS,
    RETURN,
    TAB,
)

#: Meanings of bytes besides the slots of words: block number, G word, and signs.
NUMBER: Final = 1
PREPARATORY: Final = 2
COMMENT: Final = 12
ASSIGN: Final = 13
GAP: Final = 14

#: The part of a table entry that is the meaning, and the flag of letters whose whole numbers count in increments.
_MEANING: Final = 31
_NEEDS_POINT: Final = 32

#: The highest motion that is no circle.
_LINE: Final = 1
_LAST_CIRCLE: Final = 3

_THREE: Final = 51
_EQUALS: Final = 61
_A: Final = 65
_C: Final = 67


def letter_table(
    rotary: Sequence[str],
    *,
    comment: str = "",
    assign: str = "",
    gaps: bool = False,
    need_point: str = "",
    vector: str = "",
) -> Codes:
    """Return the meaning of each byte to ``read_blocks``, (256,) uint8.

    rotary      names of the rotary axes, two at most
    comment     the sign of a comment that extends to the end of the line
    assign      a sign that may stand between the letter of an axis and its number
    gaps        whether blanks may stand there
    need_point  letters whose numbers, other than 0, must have a point: without it they count in increments
    vector      letters of the tool axis, besides A3= B3= C3=; without them, I J K are the centre of a circle
    """
    table = np.zeros(256, np.uint8)
    meanings = {"N": NUMBER, "G": PREPARATORY, "F": FEED, "X": SLIDE, "Y": SLIDE + 1, "Z": SLIDE + 2}
    for column, name in enumerate(rotary):
        if len(name) == 1:
            meanings.setdefault(name.upper(), ROTARY + column)
    meanings |= {letter: CENTRE + axis for axis, letter in enumerate("IJK")}
    meanings |= {letter: VECTOR + axis for axis, letter in enumerate(vector)}
    for letter, meaning in meanings.items():
        flag = _NEEDS_POINT if letter in need_point else 0
        table[ord(letter)] = table[ord(letter.lower())] = meaning | flag
    for sign, meaning in ((comment, COMMENT), (assign, ASSIGN), (" " if gaps else "", GAP)):
        if sign:
            table[ord(sign)] = meaning
    return table


@kernel(writes="words")
def read_blocks(
    text: Bytes, position: int, limit: int, table: Codes, modes: BlockModes, words: BlockWords
) -> tuple[int, int]:
    """Read plain blocks until one is not plain, the text ends, or ``limit`` blocks are read.

    text      (m,) uint8    whole lines of the program
    position  first byte of the first block
    table     (256,) uint8  from ``letter_table``
    modes     what holds before the first block
    returns   number of blocks, and the first byte of the next one
    """
    gaps = table[BLANK] == GAP
    motion, vectors, plane = modes.motion, modes.vectors, modes.plane
    last_motion = _LINE if plane < 0 else _LAST_CIRCLE
    # The words of a circle in the plane: its end, of which one at least is written, and its centre.
    in_plane = (0b111 << SLIDE) & ~(1 << (SLIDE + plane)) if plane >= 0 else 0
    along = 1 << (CENTRE + plane) if plane >= 0 else 0
    count = 0
    while position < text.shape[0] and count < limit:
        at = unsigned(position)
        seen = 0
        number = comment = -1
        kind = motion
        plain = True
        while True:
            char = text[at]
            if char in (BLANK, TAB, RETURN):
                at += ONE
                continue
            if char == LINE_FEED:
                break
            if table[char] == COMMENT:
                comment = signed(at + ONE)
                while text[at] != LINE_FEED:
                    at += ONE
                break
            meaning = int(table[char]) & _MEANING
            needs_point = (table[char] & _NEEDS_POINT) != 0
            letter = char & CAPITAL
            slot = meaning
            at += ONE
            if vectors and _A <= letter <= _C and text[at] == _THREE and text[at + ONE] == _EQUALS:
                slot = VECTOR + letter - _A
                meaning = ROTARY
                at += ONE + ONE
            elif meaning == 0 or (meaning > VECTOR + 2 and meaning < CENTRE):
                plain = False
                break
            elif meaning >= SLIDE and table[text[at]] == ASSIGN:
                at += ONE
            while gaps and (text[at] == BLANK or text[at] == TAB):
                at += ONE
            if seen & (1 << slot) or (meaning == NUMBER and seen != 0):
                plain = False
                break
            seen |= 1 << slot
            # The number: sign, digits, point, digits.
            negative = False
            if meaning >= SLIDE and (text[at] == PLUS or text[at] == MINUS):
                negative = text[at] == MINUS
                at += ONE
            mantissa, digits, decimals, point, at = parse_decimal(text, at)
            plain = 0 < digits <= EXACT_DIGITS and (point or not needs_point or mantissa == 0)
            value = mantissa / POWERS_OF_TEN[decimals] if plain else 0.0
            if meaning == NUMBER:
                number = mantissa
                plain = plain and not point
            elif meaning == PREPARATORY:
                kind = mantissa
                plain = plain and not point and mantissa <= last_motion and digits <= 2
            else:
                words.values[count, slot] = -value if negative else value
                plain = plain and value <= MAX_NUMBER
            # It may be followed by a blank, the end, a comment, or a word of one letter that this kernel knows.
            plain = plain and (
                text[at] in (BLANK, TAB, RETURN, LINE_FEED)
                or table[text[at]] != 0
                or (vectors and _A <= (text[at] & CAPITAL) <= _C)
            )
            if not plain:
                break
        if not plain or (seen & VECTOR_BITS and seen & ROTARY_BITS):
            break
        if kind <= _LINE:
            if seen & CENTRE_BITS:
                break
        elif seen & (MOTION_BITS | CENTRE_BITS | 1 << PREPARATORY) and (
            kind > last_motion
            or not seen & in_plane
            or not seen & CENTRE_BITS
            or seen & (along | VECTOR_BITS | ROTARY_BITS)
        ):
            break
        motion = kind
        words.seen[count] = seen
        words.kind[count] = kind
        words.number[count] = number
        words.begin[count] = position
        words.comment[count, 0] = comment
        words.comment[count, 1] = signed(at)
        count += 1
        position = signed(at + ONE)
    return count, position
