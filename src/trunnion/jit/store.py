"""Folders that keep machine code: where they are, what they hold, and who may write to them.

A kernel's folder is complete when it holds the checksums of its files. What a process has left unfinished has none.
"""

import hashlib
import json
import logging
import os
import stat
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from shutil import rmtree
from typing import IO, Any, Final

import numba

from trunnion.user_cache import user_cache

if sys.platform == "win32":
    import msvcrt
    import time
else:
    import fcntl

_CHECKSUMS = "checksums.json"
_LOCK = "lock"

_log = logging.getLogger("trunnion.jit")

_config: Any = numba.config

#: The code of messages about folders for kernels.
_CODE: Final = "FIL310"


@cache
def cache_folder() -> Path | None:
    """Return the folder that holds those of all kernels; None if no folder can be written to.

    It is in the folder that the user has chosen for Numba (``NUMBA_CACHE_DIR``), the package's own, the user's cache or
    a temporary one of the user's: the first that can be written to.
    """
    for folder in _candidates():
        try:
            folder.parent.mkdir(parents=True, exist_ok=True)
            if _is_anothers(folder):
                continue
            if _is_private(folder):
                tempfile.TemporaryFile(dir=folder).close()
                return folder
        except OSError:
            continue
        text = (
            "warning: %s is not used for compiled kernels: other users can write to it; let only its owner write to it"
        )
        _log.warning(f"{text} [%s]", folder, _CODE)
    text = "warning: no folder can be written to: kernels are compiled in every run; NUMBA_CACHE_DIR can name a folder"
    _log.warning(f"{text} [%s]", _CODE)
    return None


def _candidates() -> Iterator[Path]:
    version = f"trunnion-{sys.implementation.cache_tag}-numba-{numba.__version__}"
    if _config.CACHE_DIR:
        yield Path(_config.CACHE_DIR) / version
    yield Path(__file__).parent / "__pycache__" / version
    cache = user_cache()
    if cache is not None:
        yield cache / "trunnion" / version
    temporary = Path(tempfile.gettempdir())
    if sys.platform == "win32":
        yield temporary / "trunnion" / version
    else:
        yield temporary / f"trunnion-{os.getuid()}-{version}"


def _is_anothers(folder: Path) -> bool:
    """Whether a folder belongs to another user, as that of an installation for all: each user has one of their own."""
    if sys.platform == "win32" or not folder.exists():
        return False
    return folder.lstat().st_uid != os.getuid()


def _is_private(folder: Path) -> bool:
    """Whether only the user can write to a folder, which is made if need be: machine code of others is not run."""
    folder.mkdir(mode=0o700, exist_ok=True)
    if sys.platform == "win32":
        return True
    found = folder.lstat()
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o022


class Store:
    """The folder of one kernel, with a checksum of each file."""

    def __init__(self, root: Path, name: str, digest: str) -> None:
        self._root = root
        # Short, as whole paths have 260 characters on Windows, and Numba adds its own to them.
        self._prefix = f"{name.rpartition('.')[2]}-{hashlib.sha256(name.encode()).hexdigest()[:6]}-"
        self.folder = root / f"{self._prefix}{digest}"

    @property
    def is_sealed(self) -> bool:
        """Whether it was complete once."""
        return (self.folder / _CHECKSUMS).exists()

    def is_whole(self) -> bool:
        """Whether it is complete and undamaged."""
        try:
            sums = json.loads((self.folder / _CHECKSUMS).read_text(encoding="utf-8"))
            return isinstance(sums, dict) and bool(sums) and sums == self._sums(list(sums))
        except (OSError, ValueError, RecursionError):
            return False

    def seal(self) -> None:
        """Write the checksums: it is complete."""
        files = [str(file.relative_to(self.folder)) for file in self.folder.rglob("*.nb[ic]")]
        try:
            part = self.folder / f"{_CHECKSUMS}.{os.getpid()}"
            part.write_text(json.dumps(self._sums(files)), encoding="utf-8")
            part.replace(self.folder / _CHECKSUMS)
        except OSError as error:
            _log.debug("%s: %s", self.folder, error)

    def clear(self) -> None:
        """Empty it, and remove the folders of the same kernel in other states of the sources."""
        self.remove()
        for old in self._root.glob(f"{self._prefix}*"):
            if old != self.folder:
                rmtree(old, ignore_errors=True)

    def remove(self) -> None:
        """Remove all but the lock."""
        (self.folder / _CHECKSUMS).unlink(missing_ok=True)
        for found in self.folder.glob("*/"):
            rmtree(found, ignore_errors=True)

    @contextmanager
    def locked(self, *, wait: bool = True) -> Iterator[bool]:
        """Keep other processes from writing to it; gives False if one does already and ``wait`` is off.

        The system lifts the lock of a process that ends. Where there are no locks, processes do the same work twice.
        """
        with ExitStack() as held:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                free = _lock(held.enter_context((self.folder / _LOCK).open("ab")), wait)
            except OSError:
                free = True
            yield free

    def _sums(self, files: Sequence[str]) -> dict[str, str]:
        return {file: hashlib.sha256((self.folder / file).read_bytes()).hexdigest() for file in files}


if sys.platform == "win32":

    def _lock(file: IO[bytes], wait: bool) -> bool:
        """Lock a file until it is closed; False if another process has locked it and ``wait`` is off."""
        file.seek(0)
        while True:
            try:
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
            except OSError:
                if not wait:
                    return False
                time.sleep(0.05)
            else:
                return True

else:

    def _lock(file: IO[bytes], wait: bool) -> bool:
        """Lock a file until it is closed; False if another process has locked it and ``wait`` is off."""
        try:
            fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True
