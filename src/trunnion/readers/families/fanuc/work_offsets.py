"""Work offsets of a Fanuc: G54 to G59, and the extended ones of G54.1 P."""

import re
from typing import Final

from trunnion.readers.program.work_offsets import WorkOffsetWords, g_word

#: The value of G54.1 P1 less 1.
_EXTENDED_BASE: Final = 600

#: P of G54.1 on a control with all of them.
_HIGHEST_EXTENDED: Final = 300


def extended_offset(number: int) -> int:
    """Return the value of the column ``work_offset`` for P of G54.1; 0 if there is none of this number."""
    return _EXTENDED_BASE + number if 1 <= number <= _HIGHEST_EXTENDED else 0


def offset_name(value: int) -> str:
    """Return the word that selects a work offset: ``G54``, ``G54.1 P3``."""
    return g_word(value) if value <= _EXTENDED_BASE else f"G54.1 P{value - _EXTENDED_BASE}"


WORK_OFFSETS: Final = WorkOffsetWords(
    "G54 to G59, or G54.1 P1 to P300",
    re.compile(r"G(5[4-9])|G54\.1 ?P([0-9]{1,3})"),
    lambda numbers: numbers[0] or extended_offset(numbers[1] or 0),
    offset_name,
)
