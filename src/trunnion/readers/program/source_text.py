"""The text of a program: read in chunks while it runs from top to bottom, loaded as a whole as soon as it jumps.

Lines count from 1. Buffers always hold whole lines: the last one ends in a line feed even if the file does not.
"""

import codecs
import os
import re
from collections.abc import Iterator
from copy import copy
from itertools import pairwise
from pathlib import Path
from typing import Final, Self

import numpy as np

from trunnion.arrays import Bytes, Ints
from trunnion.encoding import decode
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.files import WriteProgress
from trunnion.messages import Wording, phrase

#: Bytes read at a time.
CHUNK: Final = 1 << 20

#: A file with longer lines is no program.
MAX_LINE_LENGTH: Final = 1 << 16

#: The shortest block that makes a row.
_SHORTEST_ROW: Final = len("X1\n")

#: Bytes at the beginning of a file in which zeros are looked for.
_PROBED: Final = 4096

#: Bytes in which the end of a line is looked for first.
_LINE_WINDOW: Final = 256

#: Ends a text in DOS, and what may fill up the file behind it.
_CTRL_Z: Final = 0x1A
_FILLING: Final = b"\x1a\0 \t\r\n"

#: The largest file that may jump or be a subprogram, and so is loaded as a whole.
MAX_LOADED_SIZE: Final = 256 << 20


class SourceText:
    """A program file and the position at which it is read; subclasses find the targets of jumps.

    buffer     (m,) uint8  whole lines
    position   first byte of the next line in the buffer
    line       number of that line
    whole      the buffer is the whole file
    first_row  row of the run before which the text began
    jumps_back jumps back without a choice since the last condition with a variable in it
    ctrl_z     the line in which Ctrl-Z ends the text, 0 for none

    ``encoding`` is that of its texts; empty: what is likeliest for each line.
    """

    def __init__(self, path: Path, *, whole: bool = False, encoding: str = "") -> None:
        self.path = path
        self._encoding = encoding
        self.name = path.name
        unusable = unusable_file(path, phrase("file_of_program"))
        if unusable:
            raise InputError(unusable)
        try:
            # Stays open while the program is read; the interpreter calls ``close``.
            self._file = path.open("rb", buffering=0)
        except (OSError, ValueError) as error:
            raise InputError(Problem(str(path), 0, Wording("NC111", "cannot_read", error=error))) from None
        self.whole = False
        self._write_progress: WriteProgress | None = None
        self._size = os.fstat(self._file.fileno()).st_size
        self.first_row = 0
        self.jumps_back = 0
        self.ctrl_z = 0
        self._content = -1
        self._ended = False
        # A chunk, preceded by the beginning of its first line from the chunk before.
        self._chunk = bytearray(0 if whole else MAX_LINE_LENGTH + CHUNK + 1)
        self._remainder = self._filled = 0
        self.buffer: Bytes = np.zeros(0, np.uint8)
        self.position = 0
        self.line = 1
        self._starts: Ints | None = None
        if whole:
            self.load()

    def restarted(self) -> Self:
        """Return the loaded text at its first line; buffer and jump targets are shared."""
        self.load()
        other = copy(self)
        other.jump(1)
        return other

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def text_of(self, data: bytes) -> str:
        """Return bytes of the program as text."""
        return data.decode() if data.isascii() else decode(data, self._encoding)

    def problem(self, line: int, wording: Wording) -> InputError:
        """Return the error for a fault at a line."""
        return InputError(Problem(str(self.path), line, wording))

    def follow(self, write_progress: WriteProgress) -> None:
        """Read a file that is still being written: wait for what is not there yet."""
        self._write_progress = write_progress

    @property
    def size(self) -> int:
        """Bytes of the file; while it is being written, an estimate that is no smaller than what is there."""
        if self._write_progress is not None:
            return self._write_progress.expected_size
        return len(self.buffer) if self.whole else self._size

    @property
    def _bytes_read(self) -> int:
        """Bytes before the next line."""
        return self.position + (0 if self.whole else self._file.tell() - self._filled)

    def expected_rows(self, rows: int) -> int:
        """Estimate the rows of the run if the text continues as it began, with ``rows`` rows so far.

        Loops make many rows of few bytes, so the estimate is bounded by the bytes that are left.
        """
        read, size, own = self._bytes_read, self.size, rows - self.first_row
        return self.first_row + min(own * size // max(read, 1), own + (size - read) // _SHORTEST_ROW)

    def fill(self) -> bool:
        """Make sure that the buffer holds the next line; False at the end of the program."""
        while self.position >= len(self.buffer):
            if self.whole or self._ended:
                return False
            self._read()
        return True

    def rest(self) -> bytes:
        """Return what follows."""
        self.load()
        return self.buffer[self.position :].tobytes()

    def next_line(self) -> str:
        """Return the next line and go past it; call ``fill`` before."""
        size = _LINE_WINDOW
        while True:
            window = self.buffer[self.position : self.position + size].tobytes()
            length = window.find(b"\n")
            if length >= 0:
                break
            if size > MAX_LINE_LENGTH:
                raise self.problem(self.line, Wording("NC110", "long_line", most=MAX_LINE_LENGTH))
            size *= 8
        if _CTRL_Z in window[:length]:
            length = self._length_before_ctrl_z(window[:length])
        self.position += window.find(b"\n", length) + 1
        self.line += 1
        return self.text_of(window[:length])

    def _length_before_ctrl_z(self, line: bytes) -> int:
        """Return how much of the next line stands before a Ctrl-Z that ends the text; all of it, if more follows."""
        self.load()
        if self._content < 0:
            self._content = len(self.buffer.tobytes().rstrip(_FILLING))
        length = line.index(_CTRL_Z)
        if self.position + length < self._content:
            return len(line)
        self.ctrl_z = self.ctrl_z or self.line
        return length

    def lines_before(self, line: int) -> Iterator[str]:
        """Yield the lines before one; loads the program."""
        for first, end in pairwise(self.starts[:line].tolist()):
            yield self.text_of(self.buffer[first:end].tobytes().rstrip(b"\r\n"))

    def _read(self) -> None:
        """Read the next chunk behind the incomplete last line of the chunk before."""
        self._wait(self._file.tell() + CHUNK)
        left, end = self._remainder, self._filled
        self._chunk[: end - left] = self._chunk[left:end]
        filled = end - left
        try:
            got = self._file.readinto(memoryview(self._chunk)[filled : filled + CHUNK])
        except OSError as error:
            raise self.problem(0, Wording("NC111", "cannot_be_read", error=error)) from None
        if not self._filled:
            self._chunk[:got] = self._as_text(bytes(self._chunk[:got]))
        if not got:
            self._ended = True
            self._chunk[filled : filled + 1] = b"\n"
            got = 1 if filled else 0
        filled += got
        cut = self._chunk.rfind(b"\n", 0, filled) + 1
        if filled - cut > MAX_LINE_LENGTH:
            raise self.problem(self.line, Wording("NC110", "long_line", most=MAX_LINE_LENGTH))
        self._remainder, self._filled = cut, filled
        self.buffer = np.frombuffer(self._chunk, np.uint8, cut)
        self.buffer.setflags(write=False)
        self.position = 0

    def _wait(self, size: int) -> None:
        """Wait until ``size`` bytes of a file that is being written are there, or all of them."""
        if self._write_progress is not None and not self._write_progress.wait_for(size):
            self._write_progress = None
            self._size = os.fstat(self._file.fileno()).st_size

    def load(self) -> None:
        """Load the whole program, staying at the same line: from now on it may jump."""
        if self.whole:
            return
        if self._write_progress is not None:
            self._write_progress.wait_until_finished()
            self._wait(0)
        size = self.size
        if size > MAX_LOADED_SIZE:
            raise self.problem(0, Wording("NC140", "too_large_for_jumps", size=size, most=MAX_LOADED_SIZE))
        try:
            if self._file.closed:
                self._file = self.path.open("rb", buffering=0)
            self._file.seek(0)
            data = self._file.read(size)
        except OSError as error:
            raise self.problem(0, Wording("NC111", "cannot_be_read", error=error)) from None
        self._file.close()
        data = self._as_text(data)
        if not data.endswith(b"\n"):
            data += b"\n"
        self.whole = True
        self.buffer = np.frombuffer(data, np.uint8)
        self._starts = np.concatenate((np.zeros(1, np.int64), np.flatnonzero(self.buffer == 10) + 1))
        self.jump(self.line)

    def _as_text(self, data: bytes) -> bytes:
        """Return the beginning of the file with blanks in place of a byte order mark; text of two bytes is refused."""
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\0" in data[:_PROBED]:
            raise self.problem(0, Wording("NC110", "no_text"))
        if b"\r" in data[:_PROBED] and b"\n" not in data:
            raise self.problem(0, Wording("NC110", "line_ends_of_cr"))
        if data.startswith(codecs.BOM_UTF8):
            self._encoding = "utf-8"
            return data.replace(codecs.BOM_UTF8, b"   ", 1)
        return data

    def whole_bytes(self) -> bytes:
        """Return the bytes of the whole program."""
        self.load()
        return self.buffer.tobytes()

    def search(self, pattern: re.Pattern[bytes], first: int = 1, end: int | None = None) -> re.Match[bytes] | None:
        """Search the buffer; in a program that is loaded from one line to another, which no longer counts."""
        if not self.whole:
            return pattern.search(self.buffer.data)
        last = self.lines if end is None else end - 1
        return pattern.search(self.buffer.data, int(self.starts[first - 1]), int(self.starts[last]))

    @property
    def known_lines(self) -> int:
        """Number of lines, as far as it is known without loading the program."""
        return self.lines if self.whole else self.line

    @property
    def lines(self) -> int:
        """Number of lines; loads the program."""
        return len(self.starts) - 1

    @property
    def starts(self) -> Ints:
        """First byte of each line, and the end; (lines + 1,) int64."""
        if self._starts is None:
            self.load()
        assert self._starts is not None
        return self._starts

    def jump(self, line: int) -> None:
        """Continue at a line."""
        line = min(line, self.lines + 1)
        self.line = line
        self.position = int(self.starts[line - 1])

    def jump_without_choice(self, line: int) -> None:
        """Continue at a line that no condition chooses: if it lies before, the program may go in circles."""
        self.jumps_back += line < self.line
        self.jump(line)

    def line_of(self, byte: int) -> int:
        """Return the line of a byte; the program must be loaded."""
        return int(np.searchsorted(self.starts, byte, side="right"))
