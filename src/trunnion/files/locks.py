"""Locks by which a hidden folder says that its job is alive: the system lets go of them, however a process ends."""

import os
import sys
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Final

from trunnion.files.hidden_names import is_sealed

#: The file in a hidden folder that its job holds locked.
LOCK: Final = ".trunnion-lock"

#: How often a folder is made again that somebody removes meanwhile, and how long it is waited for that, s.
_ATTEMPTS: Final = 100
_WAIT: Final = 0.01

#: Folders that jobs of this process hold: some network file systems know one lock for a whole process.
_held: Final[set[Path]] = set()


class FolderLock:
    """A hidden folder that this process holds."""

    def __init__(self, folder: Path, descriptor: int) -> None:
        self._folder, self._descriptor = folder, descriptor
        _held.add(folder)

    def release(self) -> None:
        """Let go of the folder; can be called again."""
        if self._folder in _held:
            _held.discard(self._folder)
            os.close(self._descriptor)


def hold(folder: Path) -> FolderLock | None:
    """Return the lock of an existing folder; None if a job holds it, or nobody can know.

    A folder without the file of a lock is that of somebody else, unless its name has a seal, or it is empty: its job
    has just begun, or never came further.
    """
    if folder in _held:
        return None
    try:
        if not (folder / LOCK).is_file() and not is_sealed(folder.name) and any(folder.iterdir()):
            return None
        descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o600)
    except OSError:
        return None
    try:
        _lock(descriptor)
        if os.path.samestat(os.fstat(descriptor), (folder / LOCK).stat()):
            return FolderLock(folder, descriptor)
    except OSError:
        pass
    os.close(descriptor)
    return None


def make_held(folder: Path) -> FolderLock | None:
    """Make a folder, and hold it; None: there are no locks on its disk.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    folder.mkdir(mode=0o700)
    for _ in range(_ATTEMPTS):
        if (held := hold(folder)) is not None:
            return held
        if folder.is_dir():
            # Where there are no locks, a file of a lock would say that the job is dead.
            with suppress(OSError):
                (folder / LOCK).unlink()
            return None
        time.sleep(_WAIT)  # it was taken for one of a dead job, and is gone
        folder.mkdir(mode=0o700, exist_ok=True)
    return None


class PlaceLock:
    """A folder in which this job alone moves files."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def release(self) -> None:
        """Let others move files; can be called again."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def hold_places(folders: Iterable[Path], seconds: float) -> list[PlaceLock] | None:
    """Return locks by which no two jobs move files in one of these folders at the same time.

    There are none where the system locks no folders, as Windows and some network disks; so it is without them there.

    folders  in any order
    seconds  how long it is waited for other jobs; None is returned if one has not ended by then
    """
    end = time.monotonic() + seconds
    held: list[PlaceLock] = []
    for folder in sorted(set(folders)):
        try:
            descriptor = os.open(folder, os.O_RDONLY)
        except OSError:
            continue
        held.append(PlaceLock(descriptor))
        while (is_free := _is_free(descriptor)) is False:
            if time.monotonic() >= end:
                for lock in held:
                    lock.release()
                return None
            time.sleep(_WAIT)
        if is_free is None:
            held.pop().release()
    return held


def _is_free(descriptor: int) -> bool | None:
    """Lock a folder, and return whether that was possible; None: it never is."""
    try:
        _lock(descriptor)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


if sys.platform == "win32":
    import msvcrt

    def _lock(descriptor: int) -> None:
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
