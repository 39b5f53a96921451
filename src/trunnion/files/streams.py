"""Streams that take output: those of the caller, and devices or pipes."""

import errno
import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO, Final, cast

from trunnion.errors import InputError, Problem
from trunnion.files.places import OutputPlace, cannot_write, of_full_disk
from trunnion.messages import Wording

_PIECE: Final = 1 << 20


def check_stream(stream: object, argument: str) -> None:
    """Raise ``InputError`` for an argument that takes no bytes: a text stream, a closed one, no stream at all."""
    name, wording = argument, Wording("FIL190", "no_stream")
    write = getattr(stream, "write", None)
    if callable(write):
        try:
            write(b"")
        except TypeError:
            wording = Wording("FIL190", "takes_text")
        except (OSError, ValueError) as error:
            name, reason = stream_name(stream), getattr(error, "strerror", None) or error
            wording = of_full_disk(error) or Wording("FIL230", "stream", strerror=reason)
        else:
            return
    raise InputError(Problem(name, 0, wording))


def stream_name(stream: object) -> str:
    """Return what messages call a stream."""
    name = getattr(stream, "name", None)
    return name.strip("<>") if isinstance(name, str) else "the stream"


@contextmanager
def open_stream(place: OutputPlace) -> Iterator[BinaryIO]:
    """Open a device or a pipe, as it is.

    Raises ``InputError`` if it cannot be opened.
    """

    def open_existing(path: str, flags: int) -> int:
        return os.open(path, flags & ~(os.O_CREAT | os.O_TRUNC))

    try:
        stream = open(place.path, "wb", buffering=0, opener=open_existing)  # noqa: SIM115 - closed below
    except OSError as error:
        raise cannot_write(place.name, error) from None
    with stream:
        yield cast("BinaryIO", stream)


def send(source: BinaryIO, stream: BinaryIO) -> None:
    """Write all of a file to a stream, however little it takes at a time.

    Raises ``OSError`` if it does not take everything.
    """
    source.seek(0)
    while piece := source.read(_PIECE):
        while piece:
            taken = stream.write(piece)
            if taken is None and not isinstance(stream, io.RawIOBase):
                break  # streams that do not count take everything
            if not taken:
                raise BlockingIOError(errno.EAGAIN, "it takes no more bytes")
            piece = piece[taken:]
    flush = getattr(stream, "flush", None)
    if callable(flush):
        flush()
