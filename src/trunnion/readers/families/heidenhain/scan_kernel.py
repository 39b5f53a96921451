"""Scan kernel of Klartext.

In:     bytes of a program, whole lines.
Out:    the words of plain blocks: ``L`` with nothing but X Y Z, rotary words, R0, F or FMAX with plain numbers, or
        ``LN`` with NX NY NZ and TX TY TZ as well; the position of the first other block, which is left to the
        interpreter.
Units:  those of the program.

A line that turns out not to be plain has no effect.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Bytes, Codes
from trunnion.decimal_bytes import EXACT_DIGITS, POWERS_OF_TEN, parse_decimal
from trunnion.jit import ONE, kernel, signed, unsigned
from trunnion.readers.scan.buffers import FEED, NORMAL, ROTARY, ROTARY_BITS, SLIDE, VECTOR, VECTOR_BITS, BlockWords
from trunnion.readers.scan.characters import BLANK, CAPITAL, LINE_FEED, MAX_NUMBER, MINUS, PLUS, RETURN, TAB

#: Slot of R0.
COMPENSATION: Final = 2

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
_TILDE: Final = 126


def letter_table(rotary: Sequence[str]) -> Codes:
    """Return the slot of each byte, (256,) uint8, 0 for none; ``rotary`` are the names of the rotary axes, or empty."""
    table = np.zeros(256, np.uint8)
    slots = {"F": FEED, "R": COMPENSATION, "X": SLIDE, "Y": SLIDE + 1, "Z": SLIDE + 2}
    for column, name in enumerate(rotary):
        if len(name) == 1:
            slots.setdefault(name.upper(), ROTARY + column)
    for letter, slot in slots.items():
        table[ord(letter)] = table[ord(letter.lower())] = slot
    return table


# One loop with everything in it: calls of kernels for its parts would count references to the arrays at every word.
@kernel(writes="words")
def read_blocks(
    text: Bytes, position: int, limit: int, table: Codes, vectors: bool, words: BlockWords
) -> tuple[int, int]:
    """Read plain blocks until one is not plain, the text ends, or ``limit`` blocks are read.

    text      (m,) uint8    whole lines of the program
    position  first byte of the first block
    table     (256,) uint8  from ``letter_table``
    vectors   whether TX TY TZ are allowed
    returns   number of blocks, and the first byte of the next one
    """
    count = 0
    values = words.values
    while position < text.shape[0] and count < limit:
        at = unsigned(position)
        number = comment = -1
        while text[at] == BLANK or text[at] == TAB:
            at += ONE
        if _ZERO <= text[at] <= _NINE:
            number, digits, _, point, at = parse_decimal(text, at)
            if point or digits > EXACT_DIGITS:
                break
            while text[at] == BLANK or text[at] == TAB:
                at += ONE
        # The path function: L or LN and a blank. A line may also be a comment only.
        plain = text[at] == _SEMICOLON
        with_normal = False
        if (text[at] & CAPITAL) == _L:
            at += ONE
            with_normal = (text[at] & CAPITAL) == _N
            at += unsigned(with_normal)
            plain = text[at] == BLANK or text[at] == TAB
        seen = 0
        rapid = False
        while plain:
            char = text[at]
            if char in (BLANK, TAB, RETURN):
                at += ONE
                continue
            if char == LINE_FEED:
                break
            if char == _SEMICOLON:
                comment = signed(at + ONE)
                while text[at] != LINE_FEED:
                    # A comment that ends in ~ may continue the block in the next line.
                    plain = plain and text[at] != _TILDE
                    at += ONE
                break
            slot = int(table[char])
            letter = char & CAPITAL
            if with_normal and (letter == _N or (letter == _T and vectors)) and _X <= (text[at + ONE] & CAPITAL) <= _Z:
                slot = (NORMAL if letter == _N else VECTOR) + int(text[at + ONE] & CAPITAL) - _X
                at += ONE
            if slot == 0 or seen & (1 << slot):
                plain = False
                break
            seen |= 1 << slot
            at += ONE
            if slot == FEED and (text[at] & CAPITAL) == _M:
                rapid = (text[at + ONE] & CAPITAL) == _A and (text[at + ONE + ONE] & CAPITAL) == _X
                plain = rapid
                at += ONE + ONE + ONE if plain else unsigned(0)
            else:
                while slot >= SLIDE and (text[at] == BLANK or text[at] == TAB):
                    at += ONE
                negative = False
                if slot >= SLIDE and (text[at] == PLUS or text[at] == MINUS):
                    negative = text[at] == MINUS
                    at += ONE
                mantissa, digits, decimals, point, at = parse_decimal(text, at, True)
                plain = 0 < digits <= EXACT_DIGITS and (slot != COMPENSATION or (mantissa == 0 and not point))
                value = mantissa / POWERS_OF_TEN[decimals] if plain else 0.0
                plain = plain and value <= MAX_NUMBER
                values[count, slot] = -value if negative else value
            # A word may be followed by a blank, the end, a comment, or a letter that this kernel knows.
            plain = plain and (text[at] in (BLANK, TAB, RETURN, LINE_FEED, _SEMICOLON) or table[text[at]] != 0)
        if not plain:
            break
        if seen & VECTOR_BITS:
            # A vector beside rotary words, or without a length, is for the interpreter to report.
            x = values[count, VECTOR] if seen & (1 << VECTOR) else 0.0
            y = values[count, VECTOR + 1] if seen & (1 << (VECTOR + 1)) else 0.0
            z = values[count, VECTOR + 2] if seen & (1 << (VECTOR + 2)) else 0.0
            if seen & ROTARY_BITS or (x == 0.0 and y == 0.0 and z == 0.0):
                break
        words.seen[count] = seen & ~(1 << FEED) if rapid else seen
        words.kind[count] = 0 if rapid else 1
        words.number[count] = number
        words.begin[count] = position
        words.comment[count, 0] = comment
        words.comment[count, 1] = signed(at)
        count += 1
        position = signed(at + ONE)
    return count, position
