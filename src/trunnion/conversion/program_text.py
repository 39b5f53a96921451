"""The text of a program, by line: for what the columns of a run do not hold."""

import re
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

import numpy as np

from trunnion.arrays import Bytes, Flags, Ints
from trunnion.encoding import decode

#: What precedes the words of a block: the block skip sign, and a number after its letter or without one.
_BLOCK_PREFIX = r"\s*/?\d?\s*(?:{letter}\d+)?\s*"
_NUMBER_PREFIX = r"\s*\d+\s+/?"

#: Words that dense motion does not repeat in every block: words of several letters, M words, and G words but G0 to G3.
_SPARSE_WORDS = rb"(?<![A-Z_])(?:[A-Z_]{2}[A-Z_0-9]*|G(?!0?[0-3](?![\d.]))\d+(?:\.\d)?|M\d+)"
_SLASH, _NEWLINE, _RETURN = b"/\n\r"

#: What lines of dense motion consist of: these bytes, and letters that stand alone.
_NUMERIC, _LETTERS = b"0123456789.+-= \t\r\n", b"ABCDEFGHIJKLMNOPQRSTUVWXYZ_abcdefghijklmnopqrstuvwxyz"
_IS_LETTER: Flags = np.isin(np.arange(256), list(_LETTERS))
_IS_DENSE: Flags = _IS_LETTER | np.isin(np.arange(256), list(_NUMERIC))
_CHUNK = 1 << 20  #: bytes that are looked through at a time


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
        numbers, data = self._sparse_lines
        starts = self._line_starts
        ends = np.cumsum(starts[numbers] - starts[numbers - 1])
        line, words = 0, list[str]()
        for match in self._word_pattern.finditer(data):
            if match[1] is None:
                continue
            number = int(numbers[np.searchsorted(ends, match.start(), "right")])
            if number != line and words:
                yield line, words
                words = []
            line = number
            words.append(match[0].decode("ascii").upper())
        if words:
            yield line, words

    @cached_property
    def _sparse_lines(self) -> tuple[Ints, bytes]:
        """Numbers (n,) and text of the lines that may hold sparse words; comments begin and end on such lines."""
        data = np.frombuffer(self._data + b"\n", np.uint8)
        found = np.zeros(self.line_count, np.bool_)
        begin = 0
        while begin < self.line_count:
            end = max(begin + 1, int(np.searchsorted(self._line_starts, self._line_starts[begin] + _CHUNK)))
            starts = self._line_starts[begin : end + 1]
            marked = np.flatnonzero(_sparse_bytes(data[starts[0] : starts[-1]]))
            found[begin + np.searchsorted(starts - starts[0], marked, "right") - 1] = True
            begin = end
        return np.flatnonzero(found) + 1, data[np.repeat(found, np.diff(self._line_starts))].tobytes()


def _sparse_bytes(lines: Bytes) -> Flags:
    """Mark at least one of the bytes (n,) of each sparse word and comment, and none in lines of dense motion alone."""
    letters = _IS_LETTER[lines]
    capitals = lines & 0xDF
    marked: Flags = ~_IS_DENSE[lines] | (capitals == ord("M"))
    marked[1:] |= letters[1:] & letters[:-1]
    words = np.flatnonzero(capitals == ord("G"))
    following = np.concatenate((lines, [_NEWLINE] * 3)).astype(np.int64)
    first, second, third = (following[words + place] for place in (1, 2, 3))
    padded = (first == ord("0")) & np.isin(second, list(b"0123"))
    digit, behind = np.where(padded, second, first), np.where(padded, third, second)
    marked[words] |= ~np.isin(digit, list(b"0123")) | np.isin(behind, list(b"0123456789."))
    return marked
