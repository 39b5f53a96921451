"""Files that appear whole or not at all."""

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from trunnion.errors import InputError, Problem


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
