"""Number formats and words.

A number is rounded once, to a count: a whole number of its last printed digit. Modal words are compared by their
counts, which is what is printed: -0.0004 with three decimals is 0.
"""

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.jit import kernel
from trunnion.messages import Wording
from trunnion.records import dataclass

#: The count of a word that is not in the block.
ABSENT = np.iinfo(np.int64).min

#: Above this count a double no longer holds every last digit.
LARGEST_COUNT = 2**53


@dataclass(frozen=True, slots=True)
class NumberFormat:
    """How a number is printed.

    decimals         digits after the point; the exact binary value is rounded to them, halves to even
    point            print a decimal point behind whole numbers (``20.``), if there are decimals
    leading_zero     ``0.5`` rather than ``.5``
    trailing_zeros   ``20.000`` rather than ``20.``
    plus             ``+20.`` rather than ``20.``
    zero             the text for zero, such as ``0.0``; empty: by the other rules
    least, greatest  limits of the value; a program with a number beyond them is refused
    unit             what one printed unit is: 25.4 for lengths in mm that are printed in inches, else 1
    """

    decimals: int
    point: bool = True
    leading_zero: bool = False
    trailing_zeros: bool = False
    plus: bool = False
    zero: str = ""
    least: float = -99999999.0
    greatest: float = 99999999.0
    unit: float = 1.0

    @property
    def digit(self) -> float:
        """The value of the last printed digit, in the unit of the values."""
        return self.unit * 10.0**-self.decimals

    def counts(self, value: Floats) -> Ints:
        """Return values (n,) as counts, (n,); ``ABSENT`` for NaN. Errors as ``round_to_counts``."""
        value = np.ascontiguousarray(value)
        return round_to_counts(value if self.unit == 1.0 else value / self.unit, self.decimals)

    def values(self, count: Ints) -> Floats:
        """Return the values (n,) that counts (n,) are printed for."""
        return np.asarray(count / 10.0**self.decimals * self.unit)

    def count(self, value: float) -> int:
        """Return a value as a count."""
        return int(self.counts(np.array([value]))[0])

    def rounded(self, value: float) -> float:
        """Return the value that is printed for ``value``."""
        return self.count(value) / 10.0**self.decimals * self.unit

    def text(self, value: float) -> str:
        """Return ``value`` as it is printed."""
        return self.text_of_count(self.count(value))

    def text_of_count(self, count: int) -> str:
        """Return the printed form of a count; the reference implementation of the block kernel's digits."""
        if count == 0 and self.zero:
            return self.zero
        sign = "-" if count < 0 else "+" if self.plus else ""
        whole, rest = divmod(abs(count), 10**self.decimals)
        decimals = str(rest).rjust(self.decimals, "0") if self.decimals else ""
        if not self.trailing_zeros:
            decimals = decimals.rstrip("0")
        point = "." if self.decimals and (self.point or decimals) else ""
        integer = "" if whole == 0 and decimals and not self.leading_zero else str(whole)
        return f"{sign}{integer}{point}{decimals}"


@dataclass(frozen=True, slots=True)
class Word:
    """An address and its number.

    key      its name in definitions
    letter   printed before the number
    format   of the number
    modal    leave the word out of a block if it would print as it did last
    closing  one character printed behind the number, or none
    bare     letters without a number, such as ``FMAX``: printed wherever the column has a count, never modal, and no
             block by itself
    """

    key: str
    letter: str
    format: NumberFormat
    modal: bool = True
    closing: str = ""
    bare: bool = False

    def text(self, value: float) -> str:
        """Return the whole word, such as ``X-.31289``."""
        return self.letter if self.bare else self.letter + self.format.text(value) + self.closing


@dataclass(frozen=True, slots=True)
class IncrementWords:
    """How a family says that X, Y and Z count from the position before them.

    on, off  the blocks that begin and end it; empty where each word says it
    prefix   what stands before the letter of each word; empty where blocks say it
    circles  circles can be said so too
    """

    on: str = ""
    off: str = ""
    prefix: str = ""
    circles: bool = True


class WordRangeError(InputError):
    """A number beyond the limits of its format; ``row`` of a table that has it."""

    def __init__(self, wording: Wording, row: int = 0, file: str = "program", line: int = 0) -> None:
        super().__init__(Problem(file, line, wording))
        self.wording, self.row, self.line = wording, row, line

    def at(self, file: str, line: int) -> "WordRangeError":
        """Return the error with the file and the line of the CL file to which it belongs, unless it has them."""
        return self if self.line else WordRangeError(self.wording, self.row, file, line)


@kernel(writes="out")
def round_column(value: Floats, scale: float, out: Ints) -> None:
    """Round ``value * scale`` to whole numbers as if the product were exact.

    The product of two doubles is hi + lo with lo no more than half a last place of hi, so hi alone decides unless its
    fraction is exactly one half; then the sign of lo does (Dekker, A floating-point technique for extending the
    available precision, 1971). NaN becomes ABSENT.
    """
    splitter = 134217729.0  # 2**27 + 1
    scale_high = splitter * scale - (splitter * scale - scale)
    scale_low = scale - scale_high
    for row in range(value.shape[0]):
        v = value[row]
        if np.isnan(v):
            out[row] = ABSENT
            continue
        product = v * scale
        floor = np.floor(product)
        fraction = product - floor
        count = np.int64(floor)
        if fraction > 0.5:
            count += 1
        elif fraction == 0.5:
            v_high = splitter * v - (splitter * v - v)
            v_low = v - v_high
            low = ((v_high * scale_high - product) + v_high * scale_low + v_low * scale_high) + v_low * scale_low
            if low > 0.0 or (low == 0.0 and count % 2 != 0):
                count += 1
        out[row] = count


def round_to_counts(value: Floats, decimals: int) -> Ints:
    """Return values as counts, rounded as ``f"{value:.{decimals}f}"`` rounds.

    value     (n,) float64; NaN for an absent word
    decimals  digits after the point, at most 9

    (n,) int64  ``ABSENT`` where ``value`` is NaN

    Raises ``OverflowError`` if a count has more digits than a double.
    """
    out, scale = np.empty(len(value), np.int64), float(10**decimals)
    if len(value):
        widest = max(abs(float(np.fmax.reduce(value))), abs(float(np.fmin.reduce(value))))
        if widest * scale > LARGEST_COUNT:  # False for NaN: a column without a number
            raise OverflowError(f"{widest:g} with {decimals} decimals has more digits than a control can read")
    round_column(np.asarray(value, np.float64), scale, out)
    return out


@dataclass(frozen=True, slots=True)
class BlockNumbers:
    """How blocks are numbered.

    letter       before the number; may be empty
    start, step  of the numbers
    highest      after it the numbers start again
    numbered     False: blocks have no numbers
    every        only every so-manieth block has a number
    at_operations  only the first block of each operation has one
    unnumbered   lines of text that begin with one of these characters have neither a number nor a skip sign
    """

    letter: str = "N"
    start: int = 10
    step: int = 10
    highest: int = 99999999
    numbered: bool = True
    unnumbered: str = ""
    every: int = 1
    at_operations: bool = False
