"""The text of a program: what the reader's columns do not hold, by line."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

#: What stands before the words of a block: the sign of block skip, and a number behind its letter.
_PREFIX = r"\s*/?\d?\s*(?:{letter}\d+)?\s*"
_BARE_PREFIX = r"\s*\d+\s+/?"

#: Comments and texts, which are passed over.
_TEXTS = {
    "rs274": rb"\([^)\n]*\)|;[^\n]*",
    "klartext": rb";[^\n]*|^\d+ \*[^\n]*",
    "sinumerik": rb';[^\n]*|"[^"\n]*"',
}

#: Language of each family; the others' is rs274.
LANGUAGES = {"sinumerik_840d": "sinumerik", "heidenhain_itnc530": "klartext", "heidenhain_tnc640": "klartext"}

#: Words of more letters than one, G words besides G0 to G3, and M words: what dense motion does not say in every block.
_SAID = rb"(?<![A-Z_])(?:[A-Z_]{2}[A-Z_0-9]*|G(?!0?[0-3](?![\d.]))\d+(?:\.\d)?|M\d+)"
_SLASH, _NEWLINE, _RETURN = b"/\n\r"


class Source:
    """One file of a program; lines count from 1.

    ``letter`` is that of block numbers, empty for numbers without one; ``language`` a key of ``_TEXTS``.
    """

    def __init__(self, file: str, letter: str = "N", language: str = "sinumerik") -> None:
        self._prefix = re.compile(_PREFIX.format(letter=letter) if letter else _BARE_PREFIX)
        self._begins = (letter, "/") if letter else tuple("0123456789")
        self._words = re.compile(_TEXTS[language] + b"|(" + _SAID + b")", re.IGNORECASE | re.MULTILINE)
        self._data = Path(file).read_bytes()
        try:
            self._data.decode("utf-8")
            self._encoding = "utf-8"
        except UnicodeDecodeError:
            self._encoding = "latin-1"
        ends = np.flatnonzero(np.frombuffer(self._data, np.uint8) == _NEWLINE)
        self._starts = np.concatenate(([0], ends + 1, [len(self._data) + 1]))
        self.count = len(self._starts) - 1

    def text(self, number: int) -> str:
        """A line without block skip sign and block number."""
        line = self._data[self._starts[number - 1] : self._starts[number] - 1].decode(self._encoding).rstrip("\r")
        prefix = self._prefix.match(line) if line.startswith(self._begins) else None
        return line[prefix.end() :] if prefix else line

    def texts(self, first: int, stop: int) -> list[tuple[int, str]]:
        """Numbers and texts of the lines from ``first`` up to ``stop``."""
        return [(number, self.text(number)) for number in range(first, min(stop, self.count + 1))]

    def skips(self) -> Iterator[tuple[int, bool]]:
        """Lines that begin with the block skip sign after one that did not, and the reverse."""
        begins = np.frombuffer(self._data + b"\n", np.uint8)[self._starts[:-1]]
        filled = np.flatnonzero((begins != _NEWLINE) & (begins != _RETURN))
        skipped = begins[filled] == _SLASH
        for place in np.flatnonzero(np.diff(skipped, prepend=False)).tolist():
            yield int(filled[place]) + 1, bool(skipped[place])

    def words(self) -> Iterator[tuple[int, list[str]]]:
        """The lines with words that dense motion does not have, and these words in capitals."""
        line, words = 0, list[str]()
        for match in self._words.finditer(self._data):
            if match[1] is None:
                continue
            number = int(np.searchsorted(self._starts, match.start(), "right"))
            if number != line and words:
                yield line, words
                words = []
            line = number
            words.append(match[0].decode("ascii").upper())
        if words:
            yield line, words
