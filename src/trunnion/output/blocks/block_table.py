"""The words of successive motion blocks as columns."""

from collections.abc import Mapping
from dataclasses import field

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.controls.vocabulary import VECTOR_LINE_WORD
from trunnion.controls.words import ABSENT
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class BlockTable:
    """The words of ``rows`` motion blocks, filled in by one subject after the other.

    columns  word -> (n,) int64 counts, ``ABSENT`` where the block lacks the word
    forced   word -> (n,) int64, 1 where the word is written even if it is modal and unchanged
    lines    row -> a line of its own before the block
    absolute  rows in which X, Y and Z must not be increments
    """

    rows: int
    columns: dict[str, Ints] = field(default_factory=dict)
    forced: dict[str, Ints] = field(default_factory=dict)
    lines: dict[int, str] = field(default_factory=dict)
    absolute: set[int] = field(default_factory=set)

    def column(self, word: str) -> Ints:
        """Return the column of a word; a new one is empty."""
        return self.columns.setdefault(word, np.full(self.rows, ABSENT, np.int64))

    def force(self, word: str, flags: Flags | Ints) -> None:
        """Write a word in the flagged rows even if it is modal and unchanged."""
        self.forced[word] = np.asarray(flags, np.int64) | self.forced.get(word, 0)

    def write_in_full_behind(self, ends: Flags, words: str) -> bool:
        """Write each word in full in the first row with it behind rows that end elsewhere than their words say.

        Returns whether such a row is still to come for one of the words.
        """
        rows, late = np.arange(self.rows), False
        ended = np.maximum.accumulate(np.where(ends, rows, -1))
        for word in words:
            has = self.column(word) != ABSENT
            waits = ended > np.maximum.accumulate(np.where(has, rows, -1))
            first = has & np.concatenate(([False], waits[:-1]))
            self.force(word, first)
            self.absolute |= set(np.flatnonzero(first).tolist())
            late = late or bool(waits[-1])
        return late

    def write_if_changed(self, word: str, row: int) -> None:
        """Write a word in a row only where it is new there."""
        if word in self.forced:
            self.forced[word][row] = 0

    def set_words(self, row: int, words: Mapping[str, int]) -> None:
        """Put words, as counts, into a row."""
        for word, count in words.items():
            self.column(word)[row] = count

    def set_missing(self, row: int, words: Mapping[str, int]) -> None:
        """Put words, as counts, into a row where it has none of them."""
        present = self.words_of_row(row)
        self.set_words(row, {w: c for w, c in words.items() if present.get(w, ABSENT) == ABSENT})

    def relative_rows(self, first: int) -> Flags:
        """Return the rows whose X, Y and Z may be increments, (n,) bool.

        The first row of a motion, where ``first`` is 0, is none: whatever brought the tool there, it begins anew. Nor
        are rows with a surface normal or a tool axis as a vector.
        """
        may = np.ones(self.rows, np.bool_)
        may[[row for row in self.absolute if row < self.rows]] = False
        may[: first == 0] = False
        vectors = self.columns.get(VECTOR_LINE_WORD)
        return may if vectors is None else np.asarray(may & (vectors == ABSENT))

    def words_of_row(self, row: int) -> dict[str, int]:
        """Return the words of a row, as counts."""
        return {word: int(column[row]) for word, column in self.columns.items()}
