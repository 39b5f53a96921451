"""Words and variables whose meaning a program does not say: somebody has stated it, and nobody checks it."""

from trunnion.messages import Wording, phrase
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class StatedWord:
    """A word that a run met, or a variable that it read.

    word      as it was stated: ``G65 P9810``, ``Q13``
    says      what it does or holds, as it was stated
    is_given  it was stated for this run only; else the definition states it
    instead   what the definition states, where a call has stated something else; empty: nothing else
    """

    word: str
    says: str
    is_given: bool
    instead: str = ""

    @property
    def wording(self) -> Wording:
        """What a verdict says of it."""
        if self.instead:
            return phrase("stated_word_instead", word=self.word, says=self.says, instead=self.instead)
        return phrase("stated_word", word=self.word, says=self.says)
