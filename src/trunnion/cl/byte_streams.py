"""Binary streams beneath the text of a CL file: one that several readers share, and bzip2."""

import bz2
import io
from typing import BinaryIO, Final

_PIECE: Final = 1 << 20


class SharedStream(io.RawIOBase):
    """A stream from its beginning, which stays open when this is closed."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        return self._stream.seek(offset, whence)

    def tell(self) -> int:
        return self._stream.tell()

    def readinto(self, buffer: memoryview, /) -> int:  # type: ignore[override]
        piece = self._stream.read(len(buffer))
        buffer[: len(piece)] = piece
        return len(piece)


class Bzip2Stream(io.RawIOBase):
    """A text packed by bzip2, in one stream or several behind each other, as programs with several threads write it.

    ``bz2.BZ2File`` ends without an error at data that is no stream, and loses all that follows.
    """

    def __init__(self, packed: BinaryIO) -> None:
        self._packed = packed
        self._stream = bz2.BZ2Decompressor()

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview, /) -> int:  # type: ignore[override]
        while True:
            rest = self._stream.unused_data if self._stream.eof else b""
            given = rest or (self._packed.read(_PIECE) if self._stream.needs_input or self._stream.eof else b"")
            if self._stream.eof:
                if not given:
                    return 0
                self._stream = bz2.BZ2Decompressor()
            elif self._stream.needs_input and not given:
                raise EOFError("it ends in the middle")
            piece = self._stream.decompress(given, len(buffer))
            if piece:
                buffer[: len(piece)] = piece
                return len(piece)
