"""Contour control and look-ahead of a Fanuc: modes that no path shows, each of which only its own word ends."""

from collections.abc import Callable
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.families.fanuc.words import SMOOTHING
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.word_table import Word

#: The letter that switches each: 0 ends it.
_LETTERS: Final = {"G5": "P", "G5.1": "Q", "G8": "P"}


class ContourModes:
    """The modes that are on, as they are written."""

    def __init__(self, note: Callable[[Wording, Severity], None]) -> None:
        self._note = note
        self._on: dict[str, str] = {}

    @property
    def on(self) -> list[str]:
        """The words of the modes that are on."""
        return list(self._on.values())

    def switch(self, word: Word, block: Block) -> None:
        """Execute a word; one that ends its mode, while only others are on, is an error."""
        letter = _LETTERS[word.text]
        if letter not in block.words:
            if letter == "Q":
                self._note(Wording("NC215", "g5_1_needs_q1_q0"), Severity.ERROR)
            return
        value = block.words[letter].value
        written = f"{word.text} {letter}{value:g}"
        if value:
            self._on[word.text] = written
        elif self._on.pop(word.text, None) is None and self._on:
            self._note(Wording("NC351", "ends_other_mode", word=written, on=self.on[0]), Severity.ERROR)
        if written in SMOOTHING:
            self._note(Wording("NC224", "smooths_path", word=written), Severity.ERROR)
