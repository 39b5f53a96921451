"""Hidden folders beside files that are being written, from which these are moved into place all together."""

import os
import shutil
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.files.interrupts import held_interrupts
from trunnion.files.places import OutputPlace, cannot_write
from trunnion.messages import Wording

#: Characters of a file's name that the name of its hidden folder repeats: both have room in 255 bytes.
_NAME_LENGTH = 32


class HiddenFolders:
    """Folders that are removed with everything in them, whatever happens."""

    def __init__(self) -> None:
        self._folders: dict[Path, Path] = {}

    def beside(self, place: OutputPlace) -> Path:
        """Return the hidden folder beside a file, from which it can be moved and need not be copied."""
        try:
            return self._make(place.path.parent, f".{place.path.name[:_NAME_LENGTH]}.")
        except OSError as error:
            raise cannot_write(place.name, error) from None

    def temporary(self) -> Path:
        """Return a folder for files that have no place of their own."""
        try:
            return self._make(Path(tempfile.gettempdir()), "trunnion-")
        except OSError as error:
            raise InputError(
                Problem("output", 0, Wording("FIL230", "no_temporary_file", strerror=error.strerror or error))
            ) from None

    def _make(self, parent: Path, prefix: str) -> Path:
        if parent not in self._folders:
            with held_interrupts():
                self._folders[parent] = folder = parent / f"{prefix}{os.urandom(6).hex()}"
                try:
                    folder.mkdir(mode=0o700)
                except OSError:
                    del self._folders[parent]
                    raise
        return self._folders[parent]

    def remove(self) -> None:
        """Remove all of them; can be called again if it was interrupted."""
        with held_interrupts():
            for parent, folder in list(self._folders.items()):
                shutil.rmtree(folder, ignore_errors=True)
                del self._folders[parent]

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


def move_all(files: Sequence[tuple[Path, OutputPlace]], withdrawn: Sequence[OutputPlace] = ()) -> None:
    """Move complete files to their places, all or none: if one of them fails, the earlier files are restored.

    files      each from a hidden folder beside its place
    withdrawn  places of files that must not be seen beside the older ones of others: their older files go away first

    Raises ``InputError`` if a file cannot be written.
    """
    undone: list[tuple[Path, Path, Path]] = []
    place = files[0][1]
    with held_interrupts():
        try:
            earlier = [_place_for_earlier(file, k) for k, (file, _) in enumerate(files)]
            for (file, place), before in zip(files, earlier, strict=True):
                if place in withdrawn and place.path.exists():
                    undone.append((file, place.path, before))
                    place.path.replace(before)
            gone = {target for _, target, _ in undone}
            for (file, place), before in zip(files, earlier, strict=True):
                if place not in withdrawn:
                    _keep(place.path, before)
                if place.path not in gone:
                    undone.append((file, place.path, before))
                file.replace(place.path)
        except BaseException as error:
            if files[-1][0].exists():
                for each in reversed(undone):
                    with suppress(OSError):
                        _restore(*each)
            if isinstance(error, OSError):
                raise cannot_write(place.name, error) from None
            raise


def _place_for_earlier(file: Path, number: int) -> Path:
    """Where a file survives that is replaced by a new one, in the hidden folder of that."""
    folder = file.parent / ".earlier"
    folder.mkdir(exist_ok=True)
    return folder / str(number)


def _keep(target: Path, before: Path) -> None:
    """Give a file, if it exists, a second name under which it survives being replaced."""
    if not target.exists():
        return
    if target.is_dir():
        raise IsADirectoryError(21, f"{target.name} is a folder")
    try:
        os.link(target, before)
    except OSError:  # some file systems have no hard links
        shutil.copy2(target, before)


def _restore(new: Path, target: Path, before: Path) -> None:
    """Undo what was done to a place."""
    if new.exists() and target.exists():
        return
    if before.exists():
        before.replace(target)
    elif not new.exists():
        target.unlink(missing_ok=True)
