"""The G and M words of a control, one record each: blocks are executed by them, and the docs are made of them."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, field, replace
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any, Final

from trunnion.readers.program.word_values import Values
from trunnion.readers.rs274.block import g_code_text
from trunnion.records import dataclass

if TYPE_CHECKING:
    from trunnion.readers.rs274.word_meanings import WordMeanings

_CODE: Final = re.compile(r"G([0-9]{1,4})(?:\.([0-9]))?|M([0-9]{1,9})")
_RANGE: Final = re.compile(r"M([0-9]+)\.\.M([0-9]+)")
_ADDRESS: Final = re.compile(r"[A-Z][-+.0-9]*")


#: Modes by the group of their words, where what the word does shows in the path.
_SHOWN: Final = {
    "rotation": "tilted plane",
    "plane of the tool": "tilted plane",
    "plane of the rotary position": "plane of the rotary position",
}

#: Groups whose words are no modes for themselves, or say theirs where they act.
_NO_MODES: Final = frozenset({"compensation", "length", "centres", "limits", "motion", "non-modal"})


class Effect(Enum):
    """What a word does to the path."""

    PATH = "changes the path"
    NONE = "no effect on the path"
    WARNING = "not simulated, and the path is right without it"
    ERROR = "not simulated, and the path may be wrong without it"
    UNKNOWN = "not a word of the control"


class When(IntEnum):
    """When a word acts within its block."""

    BEFORE_FEED = 0
    BEFORE_MOTION = 1
    BEHIND_MODES = 2
    AFTER_MOTION = 3


@dataclass(frozen=True, slots=True, eq=False)
class Word:
    """What a control does with a word, or with several that differ in nothing but what they set: a row of its table.

    text      as written: ``G54.1``; several words with blanks between them; ``M100..M199``: all between them too;
              ``G: a meaning``: a word that only some controls of the family have, each with a code of its own
    does      what it does, as the docs have it; what the message says of a word that is not simulated
    effect    on the path
    act       the method of the interpreter that executes it, without its underscore; empty: there is none
    sets      the value that the method sets; in a record of several words a tuple, one for each
    group     the name of its group, of which a block has one; empty: none
    letters   letters that belong to it
    values    what they may be, by letter; they count as they are written
    needs     letters that a cycle must have
    when      it acts
    moves     the axis words of its block are positions; else the block makes no other motion
    numbered  its P is the number of something, also where a cycle is in force
    own       no definition may declare another meaning for it
    calls     with the name of a program it is a word that a definition may declare
    problem   code of the message of a word that is not simulated; empty: that of its effect
    code      its number, of G in tenths; negative: it has none
    row       the text of its row
    """

    text: str
    does: str = ""
    _: KW_ONLY
    effect: Effect = Effect.PATH
    act: str = ""
    sets: Any = None
    group: str = ""
    letters: str = ""
    values: Mapping[str, Values] = field(default_factory=dict)
    needs: str = ""
    when: When = When.BEFORE_MOTION
    moves: bool = True
    numbered: bool = False
    own: bool = True
    calls: bool = False
    problem: str = ""
    code: int = 0
    row: str = ""

    @property
    def is_motion(self) -> bool:
        """Whether it selects a motion or a cycle."""
        return self.act in ("motion", "line", "cycle")

    @property
    def mode(self) -> str:
        """The mode that it says, beside those that its method does; empty: none."""
        if (self.row or self.text)[0] != "G" or self.group in _NO_MODES or self.sets == "block":
            return ""
        return _SHOWN.get(self.group, (self.group or self.text) if self.effect is Effect.NONE else "")

    @property
    def shows(self) -> bool:
        """Whether the path shows what it does."""
        return self.effect is not Effect.NONE or self.group in _SHOWN


class WordTable:
    """The words of a control; of two records of one word the later one counts.

    modes     when G codes act whose records do not say it, and those that the control does not have
    within_compensation  what becomes of words while radius compensation is on, by group, method or text: a variant of
              the message NC343
    rows      the records, as written
    groups    the codes of each group, by letter
    meanings  the codes of words that only some controls of the family have: letter -> meaning -> code
    """

    def __init__(
        self, *rows: Word, modes: When = When.BEFORE_MOTION, within_compensation: Mapping[str, str] | None = None
    ) -> None:
        self.rows = rows
        self._within_compensation = within_compensation or {}
        self._modes = modes
        self.meanings: dict[str, dict[str, int]] = {"G": {}, "M": {}}
        self._words: dict[tuple[str, int], Word] = {}
        for row in rows:
            self._words |= {(letter, word.code): word for letter, word in self._each(row)}
        groups: dict[tuple[str, str], set[int]] = {}
        for (letter, code), word in self._words.items():
            groups.setdefault((letter, word.group), set()).add(code)
        self.groups = {
            letter: tuple(frozenset(codes) for (kind, group), codes in groups.items() if kind == letter and group)
            for letter in "GM"
        }
        self.acts = {word.act for word in self} - {""}
        self.cycles = {word.code: word for word in self if word.act == "cycle"}
        self.without_path = frozenset(word.text for word in self if word.effect is Effect.NONE)

    def __iter__(self) -> Iterator[Word]:
        return iter(self._words.values())

    def _each(self, row: Word) -> Iterator[tuple[str, Word]]:
        """Return the letters and the words of a row."""
        letter, colon, meaning = row.text.partition(": ")
        if colon:
            code = -1 - len(self.meanings[letter])
            self.meanings[letter][meaning] = code
            yield letter, replace(row, text=meaning, code=code, row=row.text)
            return
        texts = row.text.split()
        if between := _RANGE.fullmatch(row.text):
            texts = [f"M{code}" for code in range(int(between[1]), int(between[2]) + 1)]
        for k, text in enumerate(texts):
            letter, code = _code(text)
            sets = row.sets[k] if isinstance(row.sets, tuple) else row.sets
            when = self._modes if letter == "G" and row.when is When.BEFORE_MOTION else row.when
            yield letter, replace(row, text=text, code=code, sets=sets, when=when, row=row.text)

    def without_path_by(self, meanings: "WordMeanings") -> frozenset[str]:
        """Return the words without effect on the path of a control that has some in place of the family's."""
        own = {("G", code): meaning for code, meaning in meanings.g.items()}
        own |= {("M", code): meaning for code, meaning in meanings.m.items()}
        found = set(self.without_path)
        for (letter, code), meaning in own.items():
            text = f"M{code}" if letter == "M" else g_code_text(code)
            found.discard(text)
            if meaning is not None and self.words(letter, [meaning])[0].effect is Effect.NONE:
                found.add(text)
        return frozenset(found)

    def words(self, letter: str, codes: Sequence[int]) -> list[Word]:
        """Return the words of codes, of G in tenths."""
        return [self._words.get((letter, code)) or self._unknown(letter, code) for code in codes]

    def _unknown(self, letter: str, code: int) -> Word:
        if letter == "M":
            return Word(f"M{code}", code=code, effect=Effect.UNKNOWN)
        return Word(g_code_text(code), code=code, effect=Effect.UNKNOWN, when=self._modes)

    def within_compensation(self, word: Word) -> str:
        """Return what becomes of a word while radius compensation is on, a variant of NC343; empty: it acts."""
        names = (word.text, word.act, word.group)
        return next((self._within_compensation[name] for name in names if name in self._within_compensation), "")

    def code(self, text: str) -> int:
        """Return the code of a word, of G in tenths, or of a meaning that has no word, ``G: …``."""
        letter, colon, meaning = text.partition(": ")
        return self.meanings[letter][meaning] if colon else _code(text)[1]

    def is_own(self, declared: str) -> bool:
        """Whether a declared word, in capitals with single blanks, begins with one of the control, or an address."""
        first, _, more = declared.partition(" ")
        if _CODE.fullmatch(first) is None:
            return _ADDRESS.fullmatch(first) is not None
        word = self._words.get(_code(first))
        return word is not None and word.own and not (more and word.calls)


def _code(text: str) -> tuple[str, int]:
    """Return the letter and the number of a word, of G in tenths."""
    match = _CODE.fullmatch(text)
    assert match is not None, text
    return ("M", int(match[3])) if match[3] else ("G", 10 * int(match[1]) + int(match[2] or 0))
