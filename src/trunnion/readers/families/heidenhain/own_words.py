"""The words that Klartext has itself."""

import re
from typing import Final

from trunnion.readers.families.heidenhain import words
from trunnion.readers.families.heidenhain.cycles import CYCLES, LEGACY_CYCLES

_M: Final = frozenset(
    {
        words.M_MACHINE, words.M_SECOND_MACHINE, words.M_SHORTEST, words.M_NOT_SHORTEST, words.M_TCP, words.M_TCP_OFF,
        words.M_RETRACT, words.M_CALL, words.M_CALL_MODAL, words.M_PER_TURN, words.M_PER_MINUTE,
        words.M_FEED_AT_TIP, words.M_FEED_IN_DEGREES, words.M_TOOL_CHANGE, *words.M_PROGRAM_ENDS, *words.M_EVENTS,
        words.M_AT_ENDS, words.M_AT_ENDS_OFF, *words.M_WITHOUT_PATH_EFFECT,
        *(code for code, (_, changes_path) in words.M_NOT_SIMULATED.items() if changes_path),
    }
)  # fmt: skip

#: Cycles that the reader executes.
_CYCLES: Final = frozenset(
    {
        *CYCLES, *LEGACY_CYCLES, words.DATUM, words.MIRROR, words.DWELL, words.ROTATION, words.SCALING,
        words.ORIENTATION, words.TILT, words.AXIS_SCALING, words.TOLERANCE, words.PRESET, words.BORE_MILLING,
    }
)  # fmt: skip

#: Blocks that no machine has otherwise: path functions, and what begins, ends, branches, calculates or tilts.
_BLOCKS: Final = frozenset(
    {*words.PATHS, *words.BLOCKS_NOT_SIMULATED, "BEGIN", "END", "BLK", "TOOL", "LBL", "FN", "PLANE", "CC", "STOP"}
) - {"TCH"}

#: Blocks whose words after the first decide: those that the reader executes.
_CYCLE: Final = re.compile(r"CYCLE?(?: (?:DEF|CALL)(?: ([0-9]+)(?:\..*)?)?)?")
_NAMED_CALL: Final = re.compile(r"CALL PGM .+")
_OTHER_FUNCTION: Final = re.compile(r"FUNCTION (?!TCPM|RESET|MODE).+")
_CODE: Final = re.compile(r"M([0-9]{1,9})")
_ADDRESS: Final = re.compile(r"(?:Q[LRS]?|[A-Z])[-+.0-9]*|[IT][XYZABC]|F(?:MAX|U|Z|AUTO)|R[0LR]")


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control; cycles and programs of the builder do not."""
    first = word.partition(" ")[0]
    if code := _CODE.fullmatch(first):
        return int(code[1]) in _M
    if cycle := _CYCLE.match(word):
        return cycle[1] is None or int(cycle[1]) in _CYCLES
    if first == "CALL":
        return _NAMED_CALL.fullmatch(word) is None
    if first == "FUNCTION":
        return _OTHER_FUNCTION.fullmatch(word) is None
    return first in _BLOCKS or _ADDRESS.fullmatch(first) is not None or (first == "TCH" and word == first)
