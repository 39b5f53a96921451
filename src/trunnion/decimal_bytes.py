"""Decimal numbers in the bytes of a text, parsed by a compiled kernel.

A mantissa of up to 2**53 and a power of ten of up to 10**22 are exact doubles, so one division of the two gives the
double nearest to the decimal number, the same that Python's ``float`` gives. Callers refuse longer numbers, or parse
them otherwise.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Bytes
from trunnion.jit import ONE, inlined, signed, unsigned

#: So many digits always fit into a double, whatever they are.
EXACT_DIGITS: Final = 15

#: Whole numbers up to here are exact doubles.
MAX_EXACT: Final = 1 << 53

#: So many digits always fit into the mantissa, an int64.
MAX_DIGITS: Final = 18

#: The powers of ten that a double holds exactly.
POWERS_OF_TEN: Final = 10.0 ** np.arange(23)

_COMMA, _POINT, _ZERO = 44, 46, 48


# Inlined, because a call would count references to ``text`` for every number, a fifth of the time of a scan. The
# digits are compared as unsigned bytes, where everything below "0" wraps round to more than 9.
@inlined
def parse_decimal(text: Bytes, at: int, comma: bool = False) -> tuple[int, int, int, bool, int]:
    """Parse digits with at most one decimal point in them; signs and blanks are the caller's.

    No bounds are checked: the text must end in a byte that is neither digit nor point, such as a line feed.

    text   (m,) uint8: the bytes
    at     uint64: where the number begins (see ``trunnion.jit.unsigned``)
    comma  whether a comma may stand in place of the point

    mantissa  int64: All digits as one whole number; meaningless if there are more than ``MAX_DIGITS``
    digits    int64: Number of digits; 0 if there is no number
    decimals  int64: Number of digits after the point; the value is ``mantissa / POWERS_OF_TEN[decimals]``
    point     bool: Whether there is a point
    at        uint64: The byte after the number
    """
    mantissa = 0
    first = at
    digit = np.uint8(text[at] - _ZERO)
    while digit <= 9:
        mantissa = mantissa * 10 + int(digit)
        at += ONE
        digit = np.uint8(text[at] - _ZERO)
    whole_digits = at - first
    # Without a point the byte is no digit either, and the second loop does not begin.
    point = text[at] == _POINT or (comma and text[at] == _COMMA)
    at += unsigned(point)
    first = at
    digit = np.uint8(text[at] - _ZERO)
    while digit <= 9:
        mantissa = mantissa * 10 + int(digit)
        at += ONE
        digit = np.uint8(text[at] - _ZERO)
    decimals = at - first
    return mantissa, signed(whole_digits + decimals), signed(decimals), point, at
