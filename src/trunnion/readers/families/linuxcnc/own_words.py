"""The words that LinuxCNC has itself."""

import re
from typing import Final

from trunnion.readers.families.linuxcnc import cycles, words
from trunnion.readers.rs274 import own_words

_G: Final = frozenset(
    {
        *words.SPECIAL, *words.OFFSETS, *words.LENGTHS, *words.WITHOUT_PATH_EFFECT, *words.NOT_SIMULATED,
        *cycles.CYCLES, words.MACHINE, words.CONTINUOUS, words.RIGID_TAP, 610, 611, 901, 911, 980, 990,
    }
)  # fmt: skip
_M: Final = frozenset(
    {*words.WITHOUT_PATH_EFFECT_M, *words.NOT_SIMULATED_M, words.TCP_ON, words.TCP_OFF, words.TCP_USER, 60, 61}
)

#: A call of a subprogram by its number.
_CALL: Final = re.compile(r"O[0-9]+ CALL( .*)?")


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control; a call of a numbered subprogram does not."""
    return _CALL.fullmatch(word) is None and own_words.is_own_word(word, _G, _M)
