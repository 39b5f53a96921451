"""G and M words that a control has in place of the family's: ``[control.reading.words]``.

The table maps a word to the word of the family that means the same, to one of the meanings that have no word of
their own there, or to ``unknown`` where the control does not have the word, or has it with another meaning.
"""

import re
from collections.abc import Callable, Mapping
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.duplicate_keys import report_duplicates
from trunnion.messages import Wording
from trunnion.readers.program.known_words import plain_code
from trunnion.readers.program.settings import UNKNOWN
from trunnion.readers.rs274.block import Block, g_code_text
from trunnion.records import dataclass

_WORD: Final = re.compile(r"G0*([0-9]{1,4})(?:\.([0-9]))?|M0*([0-9]{1,9})")

#: G codes that plain blocks are made of, in tenths: they keep their meaning.
_PLAIN: Final = frozenset({0, 10, 20, 30})


@dataclass(frozen=True, slots=True, eq=False)
class WordMeanings:
    """What words of a control mean.

    g   G code, in tenths -> the family's, in tenths; None: unknown
    m   M code -> the family's; None: unknown
    """

    g: Mapping[int, int | None]
    m: Mapping[int, int | None]

    def own_text(self, code: int) -> str:
        """Return the G word of the control for one of the family, in tenths."""
        return g_code_text(next((own for own, meaning in self.g.items() if meaning == code), code))

    def translate(self, block: Block) -> list[str]:
        """Put the family's words in place of the control's; return the words that the control does not have."""
        if not self.g and not self.m:
            return []
        unknown = [g_code_text(code) for code in block.g if self.g.get(code, code) is None]
        unknown += [f"M{code}" for code in block.m if self.m.get(code, code) is None]
        block.g = [found for code in block.g if (found := self.g.get(code, code)) is not None]
        block.m = [found for code in block.m if (found := self.m.get(code, code)) is not None]
        return unknown


#: All words are the family's.
NO_WORDS: Final = WordMeanings({}, {})


def read_word_meanings(
    table: Table, is_own_word: Callable[[str], bool], meanings: Mapping[str, Mapping[str, int]] | None = None
) -> WordMeanings:
    """Read the words of a control; mistakes are added to the table's problems.

    table        ``[control.reading]``
    is_own_word  whether the family has a word: only such a one can be what another means
    meanings     meanings of G and of M words besides those that the family has words for: letter -> name -> code that
                 stands for it, of G in tenths
    """
    own = table.table("words")
    g: dict[int, int | None] = {}
    m: dict[int, int | None] = {}
    for key in own.names():
        value = own.text(key)
        word, target = _code(key), _code(value)
        if word is None or (word[0] == "G" and word[1] in _PLAIN):
            own.add_problem(key, Wording("NC190", "no_word_could_mean_another"))
            continue
        letter, code = word
        names = (meanings or {}).get(letter, {})
        if value == UNKNOWN:
            (g if letter == "G" else m)[code] = None
        elif value in names:
            (g if letter == "G" else m)[code] = names[value]
        elif target is not None and not is_own_word(plain_code(value)):
            own.add_problem(key, Wording("NC190", "meaning_family_lacks", value=repr(value)))
        elif target is not None and target[0] == letter:
            (g if letter == "G" else m)[code] = target[1]
        else:
            others = ", ".join((*names, UNKNOWN))
            own.add_problem(key, Wording("NC190", "unknown_meaning", value=repr(value), letter=letter, others=others))
    report_duplicates(own, lambda key: _code(key) or key)
    own.report_unread_keys()
    return WordMeanings(g, m)


def _code(text: str) -> tuple[str, int] | None:
    """Return the letter and number of a word, of G in tenths."""
    match = _WORD.fullmatch(text)
    if match is None:
        return None
    if match[3] is not None:
        return "M", int(match[3])
    return "G", 10 * int(match[1]) + int(match[2] or 0)
