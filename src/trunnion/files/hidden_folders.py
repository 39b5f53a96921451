"""Hidden folders beside files that are being written, from which these are moved into place all together.

Each is locked as long as its job lives. One that nobody holds is of a dead job (``dead_jobs``).
"""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.files.hidden_names import TEMPORARY, hidden_name, is_hidden_name
from trunnion.files.interrupts import held_interrupts
from trunnion.files.locks import LOCK, FolderLock, make_held
from trunnion.files.places import OutputPlace, cannot_write
from trunnion.messages import Wording

#: Characters of a file's name that the name of its hidden folder repeats: both have room in 255 bytes.
_NAME_LENGTH: Final = 32

#: The file in which a folder says which files are on their way to which places.
JOURNAL: Final = ".trunnion-journal"


class HiddenFolders:
    """Folders that are removed with everything in them, whatever happens.

    is_waiting  whether complete files wait in them for others, so that they stay when their own job ends
    """

    def __init__(self) -> None:
        self.is_waiting = False
        self._folders: dict[Path, Path] = {}
        self._locks: list[FolderLock] = []

    def beside(self, place: OutputPlace) -> Path:
        """Return the hidden folder beside a file, from which it can be moved and need not be copied."""
        try:
            return self._make(place.path.parent, f".{place.path.name[:_NAME_LENGTH]}.")
        except OSError as error:
            raise cannot_write(place.name, error) from None

    def temporary(self) -> Path:
        """Return a folder for files that have no place of their own."""
        try:
            return self._make(Path(tempfile.gettempdir()), TEMPORARY)
        except OSError as error:
            raise InputError(
                Problem("output", 0, Wording("FIL230", "no_temporary_file", strerror=error.strerror or error))
            ) from None

    def _make(self, parent: Path, prefix: str) -> Path:
        if parent not in self._folders:
            with held_interrupts():
                self._folders[parent] = folder = parent / hidden_name(prefix)
                try:
                    lock = make_held(folder)
                except OSError:
                    del self._folders[parent]
                    raise
                self._locks += [] if lock is None else [lock]
        return self._folders[parent]

    def remove(self) -> None:
        """Remove all of them; can be called again if it was interrupted.

        One with a journal stays: its files could not be brought to their places, nor back, and the next command tries
        it again.
        """
        if self.is_waiting:
            return
        with held_interrupts():
            self._remove_contents()  # before the locks go: nobody takes them for those of a dead job
            for lock in self._locks:
                lock.release()
            self._remove_contents()  # with the files of the locks, where the system removes none that is open
            self._folders.clear()

    def _remove_contents(self) -> None:
        for folder in self._folders.values():
            if not (folder / JOURNAL).exists():
                remove_folder(folder)

    def bring(self, file: Path, place: OutputPlace) -> Path:
        """Return a complete file, copied if need be into a folder from which it can be moved to its place."""
        own = self.beside(place)
        try:
            if own not in file.parents:
                file = Path(shutil.copyfile(file, own / f".{sum(1 for _ in own.iterdir())}"))
                with file.open("r+b") as copy:
                    os.fsync(copy.fileno())
            if place.path.exists():
                with suppress(OSError):
                    shutil.copymode(place.path, file)
        except OSError as error:
            raise cannot_write(place.name, error) from None
        return file


def hidden_folders_in(folder: Path) -> Iterator[Path]:
    """Yield the folders that have names as those of jobs."""
    try:
        with os.scandir(folder) as entries:
            names = [entry.name for entry in entries if is_hidden_name(entry.name) and is_folder(entry)]
    except OSError:
        return
    yield from (folder / name for name in sorted(names))


def remove_folder(folder: Path) -> None:
    """Remove a hidden folder, the file of its lock last: without that it is nobody's, unless it is empty."""
    with suppress(OSError):
        for entry in list(os.scandir(folder)):
            if is_folder(entry):
                shutil.rmtree(entry.path, ignore_errors=True)
            elif entry.name != LOCK:
                with suppress(OSError):
                    Path(entry.path).unlink()
    with suppress(OSError):
        (folder / LOCK).unlink(missing_ok=True)
    with suppress(OSError):
        folder.rmdir()


def is_folder(entry: "os.DirEntry[str]") -> bool:
    """Whether an entry is a folder itself, and no link to one."""
    try:
        return entry.is_dir(follow_symlinks=False)
    except OSError:
        return False


def is_hidden_folder(folder: Path) -> bool:
    """Whether a path is that of a folder with a name as those of jobs, and no link."""
    return is_hidden_name(folder.name) and folder.is_dir() and not folder.is_symlink()
