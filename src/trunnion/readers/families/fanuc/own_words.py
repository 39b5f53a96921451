"""The words that a Fanuc has itself."""

from typing import Final

from trunnion.readers.families.fanuc import cycles, words
from trunnion.readers.rs274 import own_words

_G: Final = frozenset(
    {
        *words.OFFSETS, *words.TAKING_AXIS_WORDS, *words.WITHOUT_PATH_EFFECT, *words.NOT_SIMULATED, *cycles.CYCLES,
        words.MORE_OFFSETS, words.MACHINE, words.ALIGN_TOOL, words.MODAL_MACRO_OFF, words.ROTATION_OFF, words.TCP,
        words.TCP_VECTOR, words.LENGTH_OFF, 430, 440, 980, 990,
    }
)  # fmt: skip
_M: Final = frozenset({words.CALL, words.RETURN, words.CALL_FILE})
_CALLS: Final = frozenset({f"G{words.MACRO // 10}", f"M{words.CALL}", f"M{words.CALL_FILE}"})


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control; a call of a named program does not."""
    return word.partition(" ")[0].rstrip("0123456789") in words.FLOW or own_words.is_own_word(word, _G, _M, _CALLS)
