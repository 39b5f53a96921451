"""Where results are kept: a folder, or a place that fsspec knows (S3, a web server's store, memory).

A file appears whole or not at all. Names are relative, with ``/``.
"""

import errno
import os
import stat
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import Any, Final, Protocol

from trunnion.batch.result_keys import digest
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.files import atomic_file
from trunnion.files.places import FULL
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Files that are asked for at once where that takes a journey each.
_AT_ONCE: Final = 256


class Store(Protocol):
    """Keeps files by name.

    label         what messages call it
    address       by which any process of this computer opens it; empty: only this process does
    worker_url    by which workers write to it themselves; empty: they cannot
    is_exact      whether ``holds`` looks at the content
    folder        of this computer; None: it is elsewhere
    """

    label: str
    address: str
    worker_url: str
    is_exact: bool
    folder: Path | None

    def read(self, name: str) -> bytes | None:
        """Return a file; None: there is none."""

    def read_many(self, names: Sequence[str]) -> Iterator[bytes | None]:
        """Files one after another, in their order."""

    def write(self, name: str, content: bytes, *, lasting: bool = True) -> None:
        """Write a file, or replace it; it is whole at once, and if ``lasting`` after a power failure, too."""

    def remove(self, name: str) -> None:
        """Remove a file, if it is there."""

    def remove_empty(self, name: str) -> None:
        """Remove the folders in which a file was and nothing is any more."""

    def digest(self, name: str) -> str | None:
        """SHA-256 of a file; None: there is none."""

    def holds(self, name: str, size: int, checksum: str) -> bool:
        """Whether a file is as it was written, as far as that is quickly found out."""

    def names(self, folder: str) -> list[str]:
        """Return the files in a folder and below, in order."""


@dataclass(frozen=True, slots=True)
class Kept:
    """A file in a store, for a process that opens the store itself."""

    address: str
    name: str

    def read(self) -> bytes:
        """Its content; empty if it is not there."""
        return open_store(self.address).read(self.name) or b""


class TakenError(InputError):
    """A name has no file, and cannot have one: something that is no file stands there, or in place of its folder."""


#: What the system says where a folder is in place of a file, or a file in place of a folder; or of names too long.
_TAKEN: Final = (errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.ENAMETOOLONG)


def _taken(name: str, error: OSError) -> TakenError:
    return TakenError(
        Problem(name, 0, Wording("BAT320", "result_would_cannot", name=name[:200], strerror=error.strerror or error))
    )


def _leads_out(name: str) -> TakenError:
    return TakenError(Problem(name, 0, Wording("BAT320", "result_would_leads", name=name)))


def _refuse_odd(path: Path, folder: Path, name: str) -> None:
    """Refuse what is no regular file, as to open a pipe waits for ever, and what links lead to outside the folder."""
    if path.is_symlink() and not is_within(path, folder):
        raise _leads_out(name)
    try:
        mode = path.stat().st_mode
    except OSError:  # it is not there, or to read it tells
        return
    if stat.S_ISDIR(mode):
        raise _taken(name, IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR)))
    if not stat.S_ISREG(mode):
        raise _taken(name, OSError(errno.EEXIST, "something that is no file stands there"))
    if not is_within(path, folder):
        raise _leads_out(name)


def _remove_empty(path: Path, folder: Path) -> None:
    """Remove the folders above a path, up to the folder of results, as long as they are empty."""
    with suppress(OSError):
        for parent in path.relative_to(folder).parents[:-1]:
            (folder / parent).rmdir()


class FolderStore:
    """A folder of this computer, which is made when something is written."""

    worker_url = ""
    is_exact = True

    def __init__(self, folder: Path) -> None:
        self.label, self.address = str(folder), str(folder.absolute())
        self._folder = folder
        self.folder: Path | None = folder

    def read(self, name: str) -> bytes | None:
        """Return a file; None: there is none."""
        _refuse_odd(self._folder / name, self._folder, name)
        try:
            return (self._folder / name).read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            if (self._folder / name).is_dir() or error.errno in _TAKEN:
                raise _taken(name, error) from None
            raise self._unusable(name, "cannot be read", error) from None

    def read_many(self, names: Sequence[str]) -> Iterator[bytes | None]:
        """Files one after another, in their order."""
        return map(self.read, names)

    def write(self, name: str, content: bytes, *, lasting: bool = True) -> None:
        """Write a file, or replace it; what leads out of the folder by a link is refused."""
        path = self._folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            if error.errno in _TAKEN and self._folder.is_dir():
                raise _taken(name, error) from None
            raise self._unusable(name, "cannot be written", error) from None
        if not is_within(path.parent, self._folder):
            raise _leads_out(name)
        _refuse_odd(path, self._folder, name)
        if not lasting:  # to wait for the disk takes longer than most of the work on a small file
            part = path.with_name(f".{os.getpid()}.{os.urandom(4).hex()}.part")
            try:
                part.write_bytes(content)
                part.replace(path)
            except OSError as error:
                with suppress(OSError):
                    part.unlink()
                raise self._unusable(name, "cannot be written", error) from None
            return
        try:
            with atomic_file(path) as sink:
                sink.write(content)
        except InputError as error:
            if isinstance(cause := error.__context__, OSError):
                raise self._unusable(name, "cannot be written", cause) from None
            raise

    def remove(self, name: str) -> None:
        """Remove a file, if it is there; what leads out of the folder by a link stays."""
        path = self._folder / name
        if is_within(path.parent, self._folder):
            with suppress(FileNotFoundError, NotADirectoryError):
                path.unlink()

    def remove_empty(self, name: str) -> None:
        """Remove the folders in which a file was and nothing is any more."""
        _remove_empty(self._folder / name, self._folder)

    def digest(self, name: str) -> str | None:
        """SHA-256 of a file; None: there is none."""
        content = self.read(name)
        return None if content is None else digest(content)

    def holds(self, name: str, size: int, checksum: str) -> bool:
        """Whether a file is as it was written."""
        try:
            return (self._folder / name).stat().st_size == size and self.digest(name) == checksum
        except OSError:
            return False

    def names(self, folder: str) -> list[str]:
        """Return the files in a folder and below, in order."""
        found = (self._folder / folder).rglob("*")
        return sorted(each.relative_to(self._folder).as_posix() for each in found if each.is_file())

    def _unusable(self, name: str, what: str, error: OSError) -> InputError:
        reason = str(error.strerror or error)
        if error.errno in FULL:
            wording = Wording("FIL230", "store_full", what_failed=what, reason=reason)
        else:
            wording = Wording("FIL230", "store", what_failed=what, reason=reason)
        return InputError(Problem(str(self._folder / name), 0, wording))


class UrlStore:
    """A place of fsspec. One PUT writes a file, so that it appears whole in stores of objects; others move it."""

    def __init__(self, url: str) -> None:
        fsspec = import_extra("fsspec", "cluster")
        self.label = url
        try:
            self._files, self._root = fsspec.core.url_to_fs(url.rstrip("/"))
        except (ValueError, ImportError, OSError) as error:
            raise InputError(Problem(url, 0, Wording("BAT130", "no_place_results", error=error))) from None
        protocol = self._files.protocol
        self._protocol = protocol if isinstance(protocol, str) else protocol[0]
        self.address = self.worker_url = "" if self._protocol == "memory" else url
        self.is_exact = self._protocol in ("file", "local", "memory")
        self._is_local = self._protocol in ("file", "local")
        self.folder = Path(self._root) if self._is_local else None
        self._moves = self._protocol in ("file", "local", "sftp", "ssh", "ftp", "smb")

    def read(self, name: str) -> bytes | None:
        """Return a file; None: there is none."""
        self._refuse_odd(name)
        try:
            return bytes(self._files.cat_file(self._path(name)))
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            if error.errno in _TAKEN:
                raise _taken(name, error) from None
            raise self._unusable(error) from None

    def read_many(self, names: Sequence[str]) -> Iterator[bytes | None]:
        """Files one after another, in their order; some hundred are asked for at once."""
        for first in range(0, len(names), _AT_ONCE):
            paths = [self._path(name) for name in names[first : first + _AT_ONCE]]
            found: dict[str, Any] = self._files.cat(paths, on_error="return")
            for path in paths:
                content = found.get(path)
                if isinstance(content, Exception) and not isinstance(content, FileNotFoundError | NotADirectoryError):
                    raise self._unusable(content)
                yield bytes(content) if isinstance(content, bytes | bytearray) else None

    def write(self, name: str, content: bytes, *, lasting: bool = True) -> None:
        """Write a file, or replace it."""
        path = self._path(name)
        self._refuse_odd(name)
        part = f"{path}.{os.getpid()}.{os.urandom(4).hex()}.part"
        try:
            self._files.makedirs(path.rpartition("/")[0], exist_ok=True)
            if not self._moves:
                self._files.pipe_file(path, content)
                return
            self._files.pipe_file(part, content)
            self._files.mv(part, path)
        except OSError as error:
            if self._moves:
                with suppress(OSError):
                    self._files.rm_file(part)
            if error.errno in _TAKEN:
                raise _taken(name, error) from None
            raise self._unusable(error) from None

    def remove(self, name: str) -> None:
        """Remove a file, if it is there."""
        with suppress(FileNotFoundError):
            self._files.rm_file(self._path(name))

    def remove_empty(self, name: str) -> None:
        """Remove the folders in which a file was and nothing is any more; stores of objects have none."""
        if self._is_local:
            _remove_empty(Path(self._path(name)), Path(self._root))

    def digest(self, name: str) -> str | None:
        """SHA-256 of a file; None: there is none."""
        content = self.read(name)
        return None if content is None else digest(content)

    def holds(self, name: str, size: int, checksum: str) -> bool:
        """Whether a file is as it was written; far away only whether it has the size: its content had to be fetched."""
        try:
            is_as_long = bool(self._files.info(self._path(name)).get("size") == size)
            return is_as_long and (not self.is_exact or self.digest(name) == checksum)
        except (OSError, InputError):
            return False

    def names(self, folder: str) -> list[str]:
        """Return the files in a folder and below, in order."""
        try:
            found = self._files.find(self._path(folder))
        except FileNotFoundError:
            return []
        return sorted(PurePosixPath(each).relative_to(self._root).as_posix() for each in found)

    def _refuse_odd(self, name: str) -> None:
        if self._is_local:
            _refuse_odd(Path(self._path(name)), Path(self._root), name)

    def _path(self, name: str) -> str:
        return f"{self._root}/{name}"

    def _unusable(self, error: Exception) -> InputError:
        is_full = isinstance(error, OSError) and error.errno in FULL
        return InputError(
            Problem(
                self.label,
                0,
                Wording("BAT130", "does_not_take" if is_full else "does_not_take_results", error=error),
            )
        )


def open_store(place: str | os.PathLike[str]) -> Store:
    """Return the store at a folder or an address.

    Raises ``InputError`` if it is no place for results, or the package that knows it is not installed.
    """
    if isinstance(place, str) and "://" in place:
        return UrlStore(place)
    folder = Path(place)
    if folder.exists() and not folder.is_dir():
        raise InputError(Problem(str(place), 0, Wording("FIL230", "file")))
    return FolderStore(folder)
