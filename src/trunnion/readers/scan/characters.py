"""Bytes that the scan kernels look for, and the limit of the numbers that they read."""

from typing import Final

#: Larger numbers are left to the interpreter, which knows how far machines reach.
MAX_NUMBER: Final = 1e5

TAB: Final = 9
LINE_FEED: Final = 10
RETURN: Final = 13
BLANK: Final = 32
PLUS: Final = 43
MINUS: Final = 45
#: Clears the bit that tells small letters from capitals.
CAPITAL: Final = 0xDF
