"""Files that appear whole or not at all."""

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Condition
from typing import BinaryIO

from trunnion.errors import InputError, Problem


class Growing:
    """How far the writing of a file has come, for whoever reads it at the same time."""

    def __init__(self) -> None:
        self._news = Condition()
        self._size = self._foreseen = 0
        self._ended = False

    def grow(self, size: int, foreseen: int = 0) -> None:
        """Say that ``size`` bytes can be read, and how many there will be if the file goes on as it began."""
        with self._news:
            self._size, self._foreseen = size, foreseen
            self._news.notify_all()

    def end(self) -> None:
        """Say that nothing more will be written."""
        with self._news:
            self._ended = True
            self._news.notify_all()

    def reach(self, size: int) -> bool:
        """Wait until so many bytes can be read, or nothing more is written: then False, be they there or not."""
        with self._news:
            self._news.wait_for(lambda: self._ended or self._size >= size)
            return not self._ended

    @property
    def foreseen(self) -> int:
        """About how many bytes there will be, and no fewer than there are."""
        with self._news:
            return max(self._size, self._foreseen)


@contextmanager
def whole(target: str) -> Iterator[BinaryIO]:
    """A sink whose bytes reach ``target`` (a path, or ``-`` for stdout) when the block ends without an error.

    Its ``name`` is the path under which it can be read back before that, once it is flushed.

    Raises
    ------
    InputError
        When the target cannot be written; this is found out before anything is computed.
    """
    if target == "-":
        with tempfile.TemporaryDirectory(prefix="trunnion-") as folder, (Path(folder) / "stdout").open("w+b") as spool:
            yield spool
            spool.seek(0)
            sys.stdout.flush()
            shutil.copyfileobj(spool, sys.stdout.buffer)
            sys.stdout.buffer.flush()
        return
    path = Path(target)
    try:
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(13, "Permission denied")
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    except OSError as error:
        raise _cannot_write(target, error) from None
    part = Path(name)
    try:
        os.close(handle)
        with part.open("wb") as sink:
            yield sink
        if os.name == "posix":
            umask = os.umask(0)
            os.umask(umask)
            part.chmod(0o666 & ~umask)  # mkstemp makes files that nobody else may read
        part.replace(path)
    except OSError as error:
        raise _cannot_write(target, error) from None
    finally:
        part.unlink(missing_ok=True)


def _cannot_write(target: str, error: OSError) -> InputError:
    return InputError(Problem(target, 0, f"cannot be written: {error.strerror or error}", "name another file"))
