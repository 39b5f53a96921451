"""Work offsets of a Fanuc: G54 to G59, and the extended ones of G54.1 P, or of another word that means the same."""

import re
from functools import partial
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.families.fanuc.settings import HIGHEST_EXTENDED, settings_of
from trunnion.readers.program.work_offsets import WorkOffsetWords, g_word

#: The value of G54.1 P1 less 1.
_EXTENDED_BASE: Final = 600

#: How many there are before the extended ones: G54 to G59.
_PLAIN: Final = 6


def extended_offset(number: int, highest: int = HIGHEST_EXTENDED) -> int:
    """Return the value of the column ``work_offset`` for P of G54.1; 0 if there is none of this number."""
    return _EXTENDED_BASE + number if 1 <= number <= highest else 0


def offset_name(value: int, extended: str = "G54.1") -> str:
    """Return the word that selects a work offset: ``G54``, ``G54.1 P3``."""
    return g_word(value) if value <= _EXTENDED_BASE else f"{extended} P{value - _EXTENDED_BASE}"


def _offsets(word: str, highest: int) -> WorkOffsetWords:
    """Return the work offsets of a control with another word for the extended ones, or with fewer of them."""
    return WorkOffsetWords(
        f"G54 to G59, or {word} P1 to P{highest}",
        re.compile(rf"G(5[4-9])|{re.escape(word)} ?P([0-9]{{1,3}})"),
        lambda numbers: numbers[0] or extended_offset(numbers[1] or 0, highest),
        partial(offset_name, extended=word),
        lambda n: 53 + n if n <= _PLAIN else extended_offset(n - _PLAIN, highest),
    )


WORK_OFFSETS: Final = _offsets("G54.1", HIGHEST_EXTENDED)


def offsets_of(machine: Machine) -> WorkOffsetWords:
    """Return the work offsets of a machine's control, which may have another word in place of G54.1."""
    settings = settings_of(machine)
    return _offsets(settings.extended_word, settings.extended_offsets)
