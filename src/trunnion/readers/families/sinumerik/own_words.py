"""The words that a Sinumerik has itself."""

import re
from typing import Final

from trunnion.readers.control import iso_m_codes
from trunnion.readers.families.sinumerik import cycles, words

_G: Final = frozenset(
    {
        0, 1, 2, 3, 4, 90, 91, *words.G_PLANES, *words.G_UNITS, *words.G_FEEDS, *words.G_OFFSETS, *words.G_MACHINE,
        *words.G_RADIUS_COMPENSATION, 62, *words.G_NOT_SIMULATED,
        *words.G_WITHOUT_PATH_EFFECT,
    }
)  # fmt: skip
_M: Final = frozenset(
    {
        *iso_m_codes.EVENTS, iso_m_codes.TOOL_CHANGE, *iso_m_codes.PROGRAM_ENDS, words.M_RETURN, words.M_AXIS_MODE,
    }
)  # fmt: skip
_NAMES: Final = (
    words.WITHOUT_PATH_EFFECT
    | words.WITHOUT_PATH_EFFECT_VALUES
    | words.WITHOUT_PATH_EFFECT_CALLS
    | words.NOT_SIMULATED
    | words.ORIENTATION
    | words.FRAMES
    | words.TOOL_FRAMES
    | words.FLOW
    | words.TYPES
    | words.POSITION_MODES
    | words.ACTIVE
    | {*cycles.CYCLES, words.FEED_GROUP, *words.CONSTANTS, "CYCLE800", "CYCLE832"}
)

#: Words that call a program: with the name of one they are words of their own.
_CALLS: Final = frozenset({"CALL", "EXTCALL", "MCALL"})

_CODE: Final = re.compile(r"([GM])([0-9]{1,9})")
#: An address with a number or without; L with a number is a subprogram.
_ADDRESS: Final = re.compile(r"[A-Z]|[A-KM-Z][-+.0-9]+")


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control; a call of a named program does not."""
    first, _, more = word.partition(" ")
    if more and first in _CALLS:
        return False
    if code := _CODE.fullmatch(first):
        return int(code[2]) in (_G if code[1] == "G" else _M)
    return first in _NAMES or _ADDRESS.fullmatch(first) is not None
