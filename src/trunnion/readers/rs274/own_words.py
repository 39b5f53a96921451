"""Words that a control of this kind has itself, so that no definition may declare another meaning for them."""

import re
from collections.abc import Collection
from typing import Final

from trunnion.readers.control import iso_m_codes
from trunnion.readers.rs274.interpreter import CANCEL, FEED_MODES, MOTIONS, PLANES, RADIUS_COMPENSATION

#: G codes, in tenths, and M codes that all these languages share.
SHARED_G: Final = frozenset({*MOTIONS, *PLANES, *FEED_MODES, *RADIUS_COMPENSATION, CANCEL, 200, 210, 900, 910})
SHARED_M: Final = frozenset({*iso_m_codes.EVENTS, iso_m_codes.TOOL_CHANGE, *iso_m_codes.PROGRAM_ENDS})

_G: Final = re.compile(r"G([0-9]{1,4})(?:\.([0-9]))?")
_M: Final = re.compile(r"M([0-9]{1,9})")
_ADDRESS: Final = re.compile(r"[A-Z][-+.0-9]*")


def is_own_word(word: str, g: Collection[int], m: Collection[int], calls: Collection[str] = ()) -> bool:
    """Whether a declared word begins with one of the control: a G or M code, or the letter of an address.

    Parameters
    ----------
    word
        In capitals, with single blanks.
    g, m
        Codes that the control knows besides those that all share, of G in tenths.
    calls
        Codes that call a program: with the name of one they are words of their own.
    """
    first, _, more = word.partition(" ")
    if more and first in calls:
        return False
    if code := _G.fullmatch(first):
        number = 10 * int(code[1]) + int(code[2] or 0)
        return number in SHARED_G or number in g
    if code := _M.fullmatch(first):
        return int(code[1]) in SHARED_M or int(code[1]) in m
    return _ADDRESS.fullmatch(first) is not None
