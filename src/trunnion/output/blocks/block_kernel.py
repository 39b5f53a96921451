"""The compiled kernel that writes blocks: it knows words, digits and block numbers, and no control.

It compares every word's count with the one printed last, and writes the words that differ.

``write_blocks`` is long because its loop over words must stay in one function: with the writing of a word in a function
of its own, inlined, it takes a third more time.
"""

from trunnion.arrays import Bytes, Bytes2, Flags, Ints, Ints2
from trunnion.controls.words import ABSENT
from trunnion.jit import ONE, inlined, kernel, signed, unsigned

_TWO = ONE + ONE
_U10, _U100, _U103, _ZERO = unsigned(10), unsigned(100), unsigned(103), unsigned(48)

#: Bytes of an int64 with its sign and point, and of the letter or the text for zero in a word's spelling.
DIGITS = 20
LETTERS = 12

#: Columns of the table that describes the words to the kernel.
(
    MODAL,
    DECIMALS,
    SCALE,
    POINT,
    LEADING_ZERO,
    TRAILING_ZEROS,
    PLUS,
    LETTER_LENGTH,
    ZERO_LENGTH,
    CLOSING,
    BARE,
) = range(11)


#: Columns of the state of block numbers.
NUMBER, STEP, FIRST, HIGHEST, WAIT, EVERY = range(6)


@inlined
def _put_pair(pair: int, out: Bytes, at: int) -> None:
    """Write two digits at ``at``: (pair * 103) >> 10 is pair // 10 for pairs below 100."""
    tens = (pair * _U103) >> _U10
    out[at] = _ZERO + tens
    out[at + ONE] = _ZERO + pair - tens * _U10


@inlined
def _put_whole(number: int, out: Bytes, at: int) -> int:
    """Write the digits of a number that is not negative at ``at``, two at a time; returns where they end."""
    rest, power = unsigned(number), _U10
    end: int = at + ONE
    while rest >= power:
        end += ONE
        power *= _U10
    place = end
    while rest >= _U100:
        quotient = rest // _U100
        place -= _TWO
        _put_pair(rest - quotient * _U100, out, place)
        rest = quotient
    if rest >= _U10:
        _put_pair(rest, out, at)
    else:
        out[at] = _ZERO + rest
    return end


@inlined
def _put_fraction(fraction: int, decimals: int, out: Bytes, at: int) -> int:
    """Write a number of digits at ``at``, with leading zeros; returns where they end."""
    rest = unsigned(fraction)
    end: int = at + unsigned(decimals)
    place = end
    while place - at >= _TWO:
        quotient = rest // _U100
        place -= _TWO
        _put_pair(rest - quotient * _U100, out, place)
        rest = quotient
    if place > at:
        out[at] = _ZERO + rest
    return end


@inlined
def _put_number(
    count: int,
    decimals: int,
    scale: int,
    point: bool,
    leading_zero: bool,
    trailing_zeros: bool,
    plus: bool,
    out: Bytes,
    at: int,
) -> int:
    """Write a count as ``NumberFormat.text_of_count`` does; returns where it ends."""
    rest = count
    if count < 0:
        out[at] = 45
        at += ONE
        rest = -count
    elif plus:
        out[at] = 43
        at += ONE
    # A product is faster than a division by a number unknown to the compiler, and at most one off.
    whole = int(rest * (1.0 / scale))
    fraction = rest - whole * scale
    if fraction < 0:
        whole -= 1
        fraction += scale
    elif fraction >= scale:
        whole += 1
        fraction -= scale
    trailing_zeros = trailing_zeros and decimals > 0
    if whole > 0 or leading_zero or (fraction == 0 and not trailing_zeros):
        at = _put_whole(whole, out, at)
    if fraction > 0 or trailing_zeros:
        out[at] = 46
        at = _put_fraction(fraction, decimals, out, at + ONE)
        while not trailing_zeros and out[at - ONE] == 48:
            at -= ONE
    elif decimals > 0 and point:
        out[at] = 46
        at += ONE
    return at


@kernel(writes="last number out")
def write_blocks(
    table: Ints2,
    forced: Ints,
    line_before: Ints,
    line_of: Ints,
    text_bytes: Bytes,
    text_ends: Ints,
    unnumbered: Flags,
    before_number: Ints,
    rule: Ints2,
    spelling: Bytes2,
    last: Ints,
    number: Ints,
    number_letter: Bytes,
    line_end: Bytes,
    skip: Bytes,
    out: Bytes,
) -> int:
    """Write the blocks of one table into ``out``; returns the number of bytes written.

    table        (w, n) int64   counts, ABSENT where a row lacks the word
    forced       (n,)   int64   bit k: word k is written even if it is modal and unchanged
    line_before  (n + 1,) int64 lines of text before the row and all rows above it, from 0
    line_of      (l,)   int64   which text each of these lines is
    text_bytes, text_ends       the texts, end to end
    unnumbered   (t,)   bool    the text has neither skip sign nor block number
    before_number (t,)  int64   bytes of the text that stand before the block number: a skip sign of its own
    rule         (w, 11) int64  modal, decimals, 10**decimals, point, leading zero, trailing zeros, plus, length of the
                                letter, length of the text for zero, closing byte or 0, bare
    spelling     (w, 24) uint8  the letter in the first 12 bytes, the text for zero in the last 12
    last         (w,)   int64   counts printed last; updated
    number       (6,)   int64   next block number, step, first, highest; blocks before the next number, -1 for no more;
                                blocks from one number to the next, 0 for no more. Next and wait are updated
    line_end     (1 or 2,)      LF, or CR and LF
    """
    words, rows = table.shape
    at = unsigned(0)
    for row in range(rows):
        for piece in range(line_before[row], line_before[row + 1] + 1):  # the lines, then the row itself
            # skip sign and block number are written first, and taken back if nothing follows them
            block_start = at
            headed = piece == line_before[row + 1] or not unnumbered[line_of[piece]]
            for k in range(skip.shape[0] if headed else 0):
                out[at] = skip[k]
                at += ONE
            own_sign = 0
            if piece < line_before[row + 1]:
                line = line_of[piece]
                text_start = 0 if line == 0 else text_ends[line - 1]
                own_sign = before_number[line]
                for k in range(text_start, text_start + own_sign):
                    out[at] = text_bytes[k]
                    at += ONE
            if headed and number[WAIT] == 0:
                for k in range(number_letter.shape[0]):
                    out[at] = number_letter[k]
                    at += ONE
                at = _put_whole(number[NUMBER], out, at)
                out[at] = 32
                at += ONE
            has_content = False
            if piece < line_before[row + 1]:
                has_content = True
                line = line_of[piece]
                for k in range((0 if line == 0 else text_ends[line - 1]) + own_sign, text_ends[line]):
                    out[at] = text_bytes[k]
                    at += ONE
                at += ONE  # in place of the blank behind every word
            else:
                for word in range(words):
                    count = table[word, row]
                    if count == ABSENT:
                        continue
                    if count == last[word] and rule[word, MODAL] == 1 and (forced[row] >> word) & 1 == 0:
                        continue
                    last[word] = count
                    for k in range(rule[word, LETTER_LENGTH]):
                        out[at] = spelling[word, k]
                        at += ONE
                    if rule[word, BARE] == 1:
                        out[at] = 32
                        at += ONE
                        continue
                    has_content = True
                    if count == 0 and rule[word, ZERO_LENGTH] > 0:
                        for k in range(rule[word, ZERO_LENGTH]):
                            out[at] = spelling[word, LETTERS + k]
                            at += ONE
                    else:
                        at = _put_number(
                            count,
                            rule[word, DECIMALS],
                            rule[word, SCALE],
                            rule[word, POINT] == 1,
                            rule[word, LEADING_ZERO] == 1,
                            rule[word, TRAILING_ZEROS] == 1,
                            rule[word, PLUS] == 1,
                            out,
                            at,
                        )
                    if rule[word, CLOSING]:
                        out[at] = rule[word, CLOSING]
                        at += ONE
                    out[at] = 32
                    at += ONE
            if not has_content:
                at = block_start
                continue
            at -= ONE
            for k in range(line_end.shape[0]):
                out[at] = line_end[k]
                at += ONE
            if headed and number[WAIT] == 0:
                number[NUMBER] += number[STEP]
                if number[NUMBER] > number[HIGHEST]:
                    number[NUMBER] = number[FIRST]
                number[WAIT] = number[EVERY]
            if headed and number[WAIT] >= 0:
                number[WAIT] -= 1
    written: int = signed(at)
    return written
