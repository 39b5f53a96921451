"""The text of a program beside its run: lines by number, and where in the run they stand."""

import re
from collections.abc import Collection, Iterator
from pathlib import Path

import numpy as np

from trunnion.arrays import Ints
from trunnion.reader import Run

_PREFIX = re.compile(r"\s*/?\d?\s*(?:N\d+)?\s*")

#: A word of a block without its value's sign and form: enough to tell what is said.
_WORD = re.compile(r"[GMSFDXYZABCIJKNT][-+.]?\d[\d.]*|[A-Z_][A-Z_0-9]*")


class Source:
    """The main program of a run.

    ``in_order`` says that its lines were executed from the first to the last, and no other file was: only then has a
    line one place in the run.
    """

    def __init__(self, run: Run) -> None:
        data = Path(run.files[0]).read_bytes()
        try:
            data.decode("utf-8")
            self._encoding = "utf-8"
        except UnicodeDecodeError:
            self._encoding = "latin-1"
        self._lines = data.split(b"\n")
        self._block = run.block.astype(np.int64)
        self.in_order = len(run.files) == 1 and bool((np.diff(self._block) >= 0).all())
        self.count = len(self._lines)

    def line(self, number: int) -> str:
        """A line as it stands, from 1; beyond the last one nothing."""
        return self._lines[number - 1].decode(self._encoding).rstrip("\r") if number <= self.count else ""

    def text(self, number: int) -> str:
        """A line without block skip sign and block number."""
        line = self.line(number)
        prefix = _PREFIX.match(line) if line[:1] in ("N", "/") else None
        return line[prefix.end() :] if prefix else line

    def texts(self, first: int, stop: int) -> list[tuple[int, str]]:
        """Numbers and texts of the lines from ``first`` up to ``stop``."""
        return [(number, self.text(number)) for number in range(first, min(stop, self.count + 1))]

    def words(self, number: int) -> list[str]:
        """The words of a line, in capitals, without its number and its comment."""
        return _WORD.findall(self.text(number).partition(";")[0].upper())

    def row_of(self, number: int) -> int:
        """The row before which a line stands."""
        return int(np.searchsorted(self._block, number))

    def resting(self, first: int, stop: int, rows: Ints, others: Collection[int]) -> list[int]:
        """Lines from ``first`` up to ``stop`` that are neither those of ``rows`` nor ``others``."""
        free = np.ones(max(min(stop, self.count + 1) - first, 0), bool)
        for taken in (self._block[rows], np.array(list(others), np.int64)):
            inside = taken[(taken >= first) & (taken < first + len(free))]
            free[inside - first] = False
        return [int(number) for number in np.flatnonzero(free) + first]

    def skips(self) -> Iterator[tuple[int, bool]]:
        """Lines that begin with the block skip sign after one that did not, and the reverse."""
        skipped = False
        for number, line in enumerate(self._lines, 1):
            if line.startswith(b"/") != skipped and line.strip():
                skipped = not skipped
                yield number, skipped

    def numbers_with(self, word: bytes) -> list[int]:
        """Lines in which some bytes occur."""
        return [number for number, line in enumerate(self._lines, 1) if word in line]
