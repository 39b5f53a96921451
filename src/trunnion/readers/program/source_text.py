"""The text of a program: in chunks as long as it runs from top to bottom, whole as soon as it jumps.

Lines count from 1. Buffers always hold whole lines: the last one ends in a line feed even if the file does not.
"""

import os
import re
from collections.abc import Sequence
from copy import copy
from pathlib import Path
from typing import Final, Self

import numpy as np

from trunnion.arrays import Bytes, Ints
from trunnion.errors import InputError, Problem
from trunnion.files import WriteProgress

#: Bytes read at a time.
CHUNK: Final = 1 << 20

#: Longer lines belong to no program.
MAX_LINE_LENGTH: Final = 1 << 16

#: No block that moves is shorter.
SHORTEST_ROW: Final = len("X1\n")

#: Bytes looked at for the end of a line at first.
_LINE: Final = 256

#: The largest file that may jump or be a subprogram: it is held whole.
MAX_LOADED_SIZE: Final = 256 << 20


class SourceText:
    """A program file, the place where it is being read, and where its jumps lead.

    buffer    (m,) uint8   whole lines
    position  int          byte of the buffer where the next line begins
    line      int          number of that line
    """

    def __init__(self, path: Path, *, whole: bool = False) -> None:
        self.path = path
        self.name = path.name
        try:
            if not path.is_file():
                raise InputError(Problem(str(path), 0, "is no file"))
            # Held open while the program is read; ``close`` is called by whoever runs it.
            self._file = path.open("rb", buffering=0)
        except (OSError, ValueError) as error:
            raise InputError(Problem(str(path), 0, f"cannot be read: {error}")) from None
        self.whole = False
        self._write_progress: WriteProgress | None = None
        self._size = os.fstat(self._file.fileno()).st_size
        #: Row of the run before which this text began.
        self.first_row = 0
        self._ended = False
        # A chunk, and before it what the last one held of its line.
        self._chunk = bytearray(0 if whole else MAX_LINE_LENGTH + CHUNK + 1)
        self._remainder = self._filled = 0
        self.buffer: Bytes = np.zeros(0, np.uint8)
        self.position = 0
        self.line = 1
        self._starts: Ints | None = None
        if whole:
            self.load()

    def restarted(self) -> Self:
        """Return the same text, held whole, at its first line: what it knows of itself is shared."""
        self.load()
        other = copy(self)
        other.jump(1)
        return other

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def problem(self, line: int, what: str, cure: str = "") -> InputError:
        """Return the error that says what is wrong at a line."""
        return InputError(Problem(str(self.path), line, what, cure))

    def follow(self, write_progress: WriteProgress) -> None:
        """Take it that the file is still being written: what is not there yet is waited for."""
        self._write_progress = write_progress

    @property
    def size(self) -> int:
        """Bytes of the file; while it is being written, about as many as it will have, and no fewer than it has."""
        if self._write_progress is not None:
            return self._write_progress.expected_size
        return len(self.buffer) if self.whole else self._size

    @property
    def _bytes_read(self) -> int:
        """Bytes before the next line."""
        return self.position + (0 if self.whole else self._file.tell() - self._filled)

    def expected_rows(self, rows: int) -> int:
        """How many rows there will be if the text goes on as it began, with ``rows`` up to here.

        A loop makes many rows of few bytes: what lies ahead bounds what may be expected of it.
        """
        behind, size, here = self._bytes_read, self.size, rows - self.first_row
        return self.first_row + min(here * size // max(behind, 1), here + (size - behind) // SHORTEST_ROW)

    def fill(self) -> bool:
        """See that the buffer holds a line; False at the end of the program."""
        while self.position >= len(self.buffer):
            if self.whole or self._ended:
                return False
            self._read()
        return True

    def next_line(self) -> str:
        """Return the next line and step over it; only after ``fill``."""
        size = _LINE
        while True:
            window = self.buffer[self.position : self.position + size].tobytes()
            length = window.find(b"\n")
            if length >= 0:
                break
            if size > MAX_LINE_LENGTH:
                what = f"is longer than {MAX_LINE_LENGTH} characters"
                raise self.problem(self.line, what, "this is no program")
            size *= 8
        self.position += length + 1
        self.line += 1
        return decode(window[:length])

    def _read(self) -> None:
        """Take the next chunk: what is left of the last one goes before it, in the same memory."""
        self._wait(self._file.tell() + CHUNK)
        left, end = self._remainder, self._filled
        self._chunk[: end - left] = self._chunk[left:end]
        filled = end - left
        try:
            got = self._file.readinto(memoryview(self._chunk)[filled : filled + CHUNK])
        except OSError as error:
            raise self.problem(0, f"cannot be read: {error}") from None
        if not got:
            self._ended = True
            self._chunk[filled : filled + 1] = b"\n"
            got = 1 if filled else 0
        filled += got
        cut = self._chunk.rfind(b"\n", 0, filled) + 1
        if filled - cut > MAX_LINE_LENGTH:
            raise self.problem(self.line, f"is longer than {MAX_LINE_LENGTH} characters", "this is no program")
        self._remainder, self._filled = cut, filled
        self.buffer = np.frombuffer(self._chunk, np.uint8, cut)
        self.buffer.setflags(write=False)
        self.position = 0

    def _wait(self, size: int) -> None:
        """See that so many bytes of a file that is being written are there, or all of them."""
        if self._write_progress is not None and not self._write_progress.wait_for(size):
            self._write_progress = None
            self._size = os.fstat(self._file.fileno()).st_size

    def load(self) -> None:
        """Hold the whole program, at the same line: from now on it may jump."""
        if self.whole:
            return
        if self._write_progress is not None:
            self._write_progress.wait_until_finished()
            self._wait(0)
        size = self.size
        if size > MAX_LOADED_SIZE:
            what = f"has {size} bytes, more than the {MAX_LOADED_SIZE} that a program with jumps may have"
            raise self.problem(0, what)
        try:
            if self._file.closed:
                self._file = self.path.open("rb", buffering=0)
            self._file.seek(0)
            data = self._file.read(size)
        except OSError as error:
            raise self.problem(0, f"cannot be read: {error}") from None
        self._file.close()
        if not data.endswith(b"\n"):
            data += b"\n"
        self.whole = True
        self.buffer = np.frombuffer(data, np.uint8)
        self._starts = np.concatenate((np.zeros(1, np.int64), np.flatnonzero(self.buffer == 10) + 1))
        self.jump(self.line)

    def whole_bytes(self) -> bytes:
        """Return the whole program."""
        self.load()
        return self.buffer.tobytes()

    @property
    def known_lines(self) -> int:
        """Number of lines, as far as it is known without holding the program whole."""
        return self.lines if self.whole else self.line

    @property
    def lines(self) -> int:
        """Number of lines; the program must be held whole."""
        return len(self.starts) - 1

    @property
    def starts(self) -> Ints:
        """First byte of each line, and one more; (lines + 1,) int64."""
        if self._starts is None:
            self.load()
        assert self._starts is not None
        return self._starts

    def jump(self, line: int) -> None:
        """Go on at a line."""
        line = min(line, self.lines + 1)
        self.line = line
        self.position = int(self.starts[line - 1])

    def line_of(self, byte: int) -> int:
        """Return the line that a byte belongs to; the program must be held whole."""
        return int(np.searchsorted(self.starts, byte, side="right"))


def decode(data: bytes) -> str:
    """Return text: UTF-8, or one character a byte where it is none."""
    try:
        return data.decode()
    except UnicodeDecodeError:
        return data.decode("latin-1")


class Subprograms:
    """The files that a program may call: those that whoever runs it has named, and no others.

    suffixes   how names of programs end on this control, those first that go before others; "" for no ending
    prefix     what the control may write before a name
    """

    def __init__(self, named: Sequence[Path], suffixes: Sequence[str], prefix: str = "") -> None:
        self._suffixes = tuple(suffixes)
        self._prefix = prefix
        self._files: dict[str, Path] = {}
        problems = []
        found: dict[tuple[str, int], Path] = {}
        for path in named:
            rank = self._rank(path.name.upper())
            if not _is_file(path):
                problems.append(Problem(str(path), 0, "is no file"))
            elif rank is None:
                endings = ", ".join(suffix for suffix in self._suffixes if suffix)
                problems.append(Problem(str(path), 0, "is no name of a subprogram", f"let it end in one of {endings}"))
            elif (first := found.setdefault((self._stem(path.name), rank), path)) is not path:
                problems.append(Problem(str(path), 0, f"is called as {first} is", "name one of them"))
        if problems:
            raise InputError(problems)
        for (stem, _), path in sorted(found.items(), key=lambda each: each[0][1]):
            self._files.setdefault(stem, path)

    def find(self, name: str) -> Path | None:
        """Return the subprogram of this name, whatever the case of its letters, or None.

        A name may have its ending and prefix or not. Folders of the control are not those of this computer: of a name
        with a folder its last part counts.
        """
        parts = [part for part in re.split(r"[/\\:]", name.strip()) if part]
        if not parts or ".." in parts or len(name) > 200:
            return None
        return self._files.get(self._stem(parts[-1]))

    def _rank(self, upper: str) -> int | None:
        """Place among the suffixes of the one with which a name ends."""
        for k, suffix in enumerate(self._suffixes):
            if upper.endswith(suffix) if suffix else "." not in upper:
                return k
        return None

    def _stem(self, name: str) -> str:
        stem = name.upper()
        for suffix in self._suffixes:
            stem = stem.removesuffix(suffix)
        return stem.removeprefix(self._prefix)


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError, RuntimeError):  # links in circles, names that no system has
        return False
