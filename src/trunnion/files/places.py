"""Where output goes: names that are no files, links, devices, and files that a command reads, before any work.

In:     what a caller names.
Out:    an ``OutputPlace``, or an ``InputError`` that says what is wrong with it.
"""

import errno
import os
import stat
from collections.abc import Hashable, Iterable
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass

#: What the system says where there is no more space.
FULL: Final = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))


@dataclass(frozen=True, slots=True)
class OutputPlace:
    """Note a file that is going to be written.

    name       as the caller wrote it
    path       of the file itself, behind symbolic links
    is_stream  a device or a pipe: takes bytes, and is never replaced by a file
    """

    name: str
    path: Path
    is_stream: bool = False

    @property
    def entry(self) -> Hashable:
        """The same for two names of one place in one folder."""
        return _entry(self.path)


def resolve_output(file: object) -> OutputPlace:
    """Find out where a file will be written.

    file  a path as text or as ``os.PathLike``

    Raises ``InputError`` if it names no file, a folder, or what cannot be written: something of another type, a name
    with a NUL or with a slash at its end, a file in a folder that does not exist, a disk.
    """
    name = _file_name(file)
    path = Path(name)
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return OutputPlace(name, _new_file(name))
    except OSError as error:
        raise cannot_write(name, error) from None
    if stat.S_ISDIR(mode):
        raise InputError(Problem(name, 0, Wording("FIL210", "cannot_written_folder")))
    if not os.access(path, os.W_OK):
        raise cannot_write(name, PermissionError(13, "Permission denied"))
    if stat.S_ISCHR(mode) or stat.S_ISFIFO(mode):
        return OutputPlace(name, path, is_stream=True)
    if not stat.S_ISREG(mode):
        raise InputError(Problem(name, 0, Wording("FIL210", "cannot_written_no")))
    real = Path(os.path.realpath(path))
    # The descriptor of a file that has been removed has no name that could be replaced.
    if not real.exists():
        return OutputPlace(name, path, is_stream=True)
    return OutputPlace(name, _in_writable_folder(name, real))


def _file_name(file: object) -> str:
    """Return the name as text."""
    name = os.fspath(file) if isinstance(file, str | os.PathLike) else None
    if not isinstance(name, str):
        raise InputError(Problem(f"{file!r:.60}", 0, Wording("FIL210", "no_name_file")))
    if not name or "\0" in name or not _is_encodable(name):
        raise InputError(Problem(repr(name), 0, Wording("FIL210", "cannot_name_file")))
    if name.endswith((os.sep, os.altsep or os.sep)):
        raise InputError(Problem(name, 0, Wording("FIL210", "cannot_written_names")))
    return name


def _is_encodable(name: str) -> bool:
    try:
        os.fsencode(name)
    except UnicodeEncodeError:
        return False
    return True


def _new_file(name: str) -> Path:
    """Path of a file that does not exist, but can be made."""
    real = Path(os.path.realpath(name))
    try:
        if not stat.S_ISDIR(real.parent.stat().st_mode):
            raise NotADirectoryError(20, f"{real.parent} is no folder")
    except FileNotFoundError:
        raise InputError(Problem(name, 0, Wording("FIL220", "cannot_written_no", parent=real.parent))) from None
    except OSError as error:
        raise cannot_write(name, error) from None
    return _in_writable_folder(name, real)


def _in_writable_folder(name: str, path: Path) -> Path:
    """Return the path, unless its folder takes no new files: a file appears by being moved there."""
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise cannot_write(name, PermissionError(13, f"nothing may be written into {path.parent}"))
    return path


def cannot_write(name: str, error: OSError) -> InputError:
    """Return the error for a file that the system does not let us write."""
    reason = error.strerror or error
    return InputError(Problem(name, 0, of_full_disk(error) or Wording("FIL230", "cannot_written", strerror=reason)))


def of_full_disk(error: BaseException) -> Wording | None:
    """Return what is said where there is no more space; None where something else is wrong."""
    if not isinstance(error, OSError) or error.errno not in FULL:
        return None
    return Wording("FIL230", "disk_full", strerror=error.strerror or error)


def file_on_disk(name: str | os.PathLike[str]) -> str:
    """Return the file that a name leads to: itself, or the archive that holds it (``jobs.zip`` of
    ``jobs.zip/top.cls``).
    """
    text = os.fspath(name)
    try:
        return next((str(path) for path in (Path(text), *Path(text).parents) if path.is_file()), text)
    except (OSError, ValueError):
        return text


def file_identity(path: str | os.PathLike[str]) -> Hashable:
    """Return the same for all names of a file, hard links too; for what does not exist, the same for all spellings."""
    try:
        found = Path(path).stat()
        if found.st_ino:
            return found.st_dev, found.st_ino
    except (OSError, ValueError):
        pass
    try:
        return os.path.realpath(path).casefold()
    except (OSError, ValueError):
        return os.fspath(path)


def _entry(path: Path) -> Hashable:
    """Return the same for two names of one place in one folder, also where small letters are other ones than
    capitals.
    """
    return file_identity(path.parent), path.name.casefold()


class Claims:
    """The files that are read and those that are written: none may be two of them."""

    def __init__(self) -> None:
        self._read: set[Hashable] = set()
        self._written: dict[Hashable, OutputPlace] = {}

    def read(self, files: Iterable[str | os.PathLike[str]]) -> None:
        """Files that are read.

        Raises ``InputError`` if one of them is going to be written.
        """
        named = list(files)
        self._read.update(map(file_identity, named))
        self._read.update(map(_entry, map(Path, named)))
        for place in self._written.values():
            self._check_input(place)

    def write(self, place: OutputPlace) -> None:
        """Note a file that is going to be written.

        Raises ``InputError`` if it is read, or written already.
        """
        self.check(place)
        self._written[place.entry] = place

    def check(self, place: OutputPlace) -> None:
        """Raise ``InputError`` as ``write`` does, without keeping the file."""
        self._check_input(place)
        if place.entry in self._written:
            raise InputError(
                Problem(
                    place.name, 0, Wording("FIL240", "would_written_twice", written=self._written[place.entry].name)
                )
            )

    def release(self, place: OutputPlace) -> None:
        """Forget a file that is not going to be written after all."""
        self._written.pop(place.entry, None)

    def _check_input(self, place: OutputPlace) -> None:
        if not self._read.isdisjoint((file_identity(place.path), place.entry)):
            raise InputError(Problem(place.name, 0, Wording("FIL240", "would_written_over")))


def check_outputs(outputs: Iterable[object], inputs: Iterable[str | os.PathLike[str]]) -> list[OutputPlace]:
    """Find out where files will be written that must neither be among those that are read nor the same file twice.

    Raises ``InputError`` as ``resolve_output`` and ``Claims`` raise it.
    """
    claims = Claims()
    claims.read(inputs)
    places = [resolve_output(file) for file in outputs]
    for place in places:
        claims.write(place)
    return places
