"""Words that may stand in raw text: those that a family's reader follows, so that running them shows what they do.

Of all other words nobody knows that they change nothing: offsets of tools, overrides, limits of the speed, modes of the
compensation, system variables are among them. So the words that may be there are listed, and not those that may not.
"""

import re
from collections.abc import Iterable
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.program.known_words import begins_with, known_words
from trunnion.readers.program.words_beside import has_other_codes
from trunnion.records import dataclass

#: Parts of words: a number, what a variable may become, and comments of languages of the RS274 kind. A comment that
#: begins with a name and a comma may be a command, and some are one without a comma.
NUMBER: Final = r"[-+]?(?:[0-9]++(?:\.[0-9]*+)?+|\.[0-9]+)"
RS274_COMMENT: Final = r"\((?!\s*(?:[A-Z_]+\s*,|(?:LOG|PROBE)(?:OPEN|APPEND|CLOSE)|ACTIVE_))[^()]*\)"
RS274_VALUE: Final = rf"(?:{NUMBER}|[-+]?#[0-9]+|\[[^\[\]]*\])"

_SHORT: Final = 40
_FIRST_CODE: Final = re.compile(r"[ \t]*G[0-9.]+", re.IGNORECASE)


@dataclass(frozen=True, slots=True, eq=False)
class RawWords:
    """The words of one family.

    word     pattern of one word or comment that may stand in raw text; a group ``m`` is the number of an M code. It is
             compiled when it is first used: few programs have raw text
    other_m  M codes of the family that the reader does not follow: they may not; codes of the machine's builder may
    """

    word: str
    other_m: frozenset[int] = frozenset()

    def not_known(self, text: str, machine: Machine) -> str:
        """Return the first part of a text of which nobody knows what it changes; empty if there is none."""
        declared = known_words(machine)
        if begins_with(declared, text) and not has_other_codes(_FIRST_CODE.sub("", text, 1), of_klartext=False):
            return ""
        codes = {word.code for word in declared}
        word = re.compile(self.word, re.IGNORECASE)
        at, end = 0, len(text)
        while at < end:
            if text[at] in " \t":
                at += 1
                continue
            match = word.match(text, at)
            code = match and match.groupdict().get("m")
            refused = code is not None and int(code) in self.other_m and int(code) not in codes
            if match is None or match.end() == at or refused:
                return text[at:].strip()[:_SHORT]
            at = match.end()
        return ""


def raw_words(comments: Iterable[str], words: Iterable[str], other_m: Iterable[int] = ()) -> RawWords:
    """Return the words of a family from regular expressions; no rest of a number or value follows one."""
    pattern = rf"{'|'.join(comments)}|(?:{'|'.join(words)})(?![0-9.=])"
    return RawWords(pattern, frozenset(other_m))


#: No word at all.
NO_RAW_WORDS: Final = RawWords(r"(?!)")
