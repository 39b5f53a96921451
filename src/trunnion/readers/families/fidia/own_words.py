"""The words that a Fidia has itself."""

from typing import Final

from trunnion.readers.families.fidia import cycles, words
from trunnion.readers.rs274 import own_words

_G: Final = frozenset(
    {
        *words.TCP_ON, *words.TCP_OFF, *words.UNITS, *words.WITHOUT_PATH_EFFECT, *words.NOT_SIMULATED, *cycles.CYCLES,
        words.OFFSET, words.TAKE_PLANE, words.NO_PLANE, words.DWELL, words.MACHINE,
    }
)  # fmt: skip
_M: Final = frozenset({words.TOOL, words.RETRACT})


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control."""
    return own_words.is_own_word(word, _G, _M)
