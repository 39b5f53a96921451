"""Work offsets of a Fanuc: G54 to G59, and the extended ones of G54.1 P, or of another word that means the same."""

import re
from functools import partial
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.families.fanuc.settings import settings_of
from trunnion.readers.families.fanuc.words import MORE_OFFSETS
from trunnion.readers.program.work_offsets import WorkOffsetWords, g_word
from trunnion.readers.rs274.block import g_code_text

#: The value of G54.1 P1 less 1.
_EXTENDED_BASE: Final = 600

#: P of G54.1 on a control with all of them.
_HIGHEST_EXTENDED: Final = 300


def extended_offset(number: int) -> int:
    """Return the value of the column ``work_offset`` for P of G54.1; 0 if there is none of this number."""
    return _EXTENDED_BASE + number if 1 <= number <= _HIGHEST_EXTENDED else 0


def offset_name(value: int, extended: str = "G54.1") -> str:
    """Return the word that selects a work offset: ``G54``, ``G54.1 P3``."""
    return g_word(value) if value <= _EXTENDED_BASE else f"{extended} P{value - _EXTENDED_BASE}"


WORK_OFFSETS: Final = WorkOffsetWords(
    "G54 to G59, or G54.1 P1 to P300",
    re.compile(r"G(5[4-9])|G54\.1 ?P([0-9]{1,3})"),
    lambda numbers: numbers[0] or extended_offset(numbers[1] or 0),
    offset_name,
)


def offsets_of(machine: Machine) -> WorkOffsetWords:
    """Return the work offsets of a machine's control, which may have another word in place of G54.1."""
    meanings = settings_of(machine).words.g
    own = next((code for code, meaning in meanings.items() if meaning == MORE_OFFSETS), None)
    if own is None:
        return WORK_OFFSETS
    word = g_code_text(own)
    return WorkOffsetWords(
        f"G54 to G59, or {word} P1 to P{_HIGHEST_EXTENDED}",
        re.compile(rf"G(5[4-9])|{re.escape(word)} ?P([0-9]{{1,3}})"),
        WORK_OFFSETS.value,
        partial(offset_name, extended=word),
    )
