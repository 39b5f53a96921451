"""The text of a program, by line: for what the columns of a run do not hold."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from trunnion.encoding import decode

#: What precedes the words of a block: the block skip sign, and a number after its letter or without one.
_BLOCK_PREFIX = r"\s*/?\d?\s*(?:{letter}\d+)?\s*"
_NUMBER_PREFIX = r"\s*\d+\s+/?"

#: Words that dense motion does not repeat in every block: words of several letters, M words, and G words but G0 to G3.
_SPARSE_WORDS = rb"(?<![A-Z_])(?:[A-Z_]{2}[A-Z_0-9]*|G(?!0?[0-3](?![\d.]))\d+(?:\.\d)?|M\d+)"
_SLASH, _NEWLINE, _RETURN = b"/\n\r"


class ProgramText:
    """One file of a program; lines count from 1.

    letter    letter of block numbers, empty for numbers without one
    comments  regular expression of comments and texts, as in ``FamilyReader``
    encoding  of names and texts; empty: what is likeliest for each line
    """

    def __init__(self, file: str, letter: str, comments: bytes, encoding: str = "") -> None:
        self._prefix = re.compile(_BLOCK_PREFIX.format(letter=letter) if letter else _NUMBER_PREFIX)
        self._prefix_starts = (letter, "/") if letter else tuple("0123456789")
        self._word_pattern = re.compile(comments + b"|(" + _SPARSE_WORDS + b")", re.IGNORECASE | re.MULTILINE)
        self._data = Path(file).read_bytes()
        self._encoding = encoding
        ends = np.flatnonzero(np.frombuffer(self._data, np.uint8) == _NEWLINE)
        self._line_starts = np.concatenate(([0], ends + 1, [len(self._data) + 1]))
        self.line_count = len(self._line_starts) - 1

    def line_text(self, number: int) -> str:
        """Return a line without its block skip sign and block number."""
        begin, end = self._line_starts[number - 1], self._line_starts[number] - 1
        line = decode(self._data[begin:end], self._encoding).rstrip("\r")
        prefix = self._prefix.match(line) if line.startswith(self._prefix_starts) else None
        return line[prefix.end() :] if prefix else line

    def line_texts(self, first: int, end: int) -> list[tuple[int, str]]:
        """Numbers and texts of the lines from ``first`` up to ``end``."""
        return [(number, self.line_text(number)) for number in range(first, min(end, self.line_count + 1))]

    def skip_changes(self) -> Iterator[tuple[int, bool]]:
        """Yield the lines where block skip signs begin (True) and where they end (False)."""
        begins = np.frombuffer(self._data + b"\n", np.uint8)[self._line_starts[:-1]]
        filled = np.flatnonzero((begins != _NEWLINE) & (begins != _RETURN))
        skipped = begins[filled] == _SLASH
        for change in np.flatnonzero(np.diff(skipped, prepend=False)).tolist():
            yield int(filled[change]) + 1, bool(skipped[change])

    def sparse_words(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the lines with words that dense motion does not repeat, and these words in capitals."""
        line, words = 0, list[str]()
        for match in self._word_pattern.finditer(self._data):
            if match[1] is None:
                continue
            number = int(np.searchsorted(self._line_starts, match.start(), "right"))
            if number != line and words:
                yield line, words
                words = []
            line = number
            words.append(match[0].decode("ascii").upper())
        if words:
            yield line, words
