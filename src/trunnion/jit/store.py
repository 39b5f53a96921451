"""Folders that keep machine code: where they are, what they hold, and who may write to them.

A folder belongs to a version of Python, of Numba and of LLVM, and to a kind of processor: what another one made is not
seen. A kernel's machine code is complete when its checksum is there. What a process has left unfinished has none.
"""

import hashlib
import logging
import os
import platform
import re
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from shutil import rmtree
from typing import IO, Final

from trunnion.jit.library import is_as_expected
from trunnion.user_cache import temporary_folder, user_cache

if sys.platform == "win32":
    import msvcrt
    import time
else:
    import fcntl

_log = logging.getLogger("trunnion.jit")

#: The code of messages about folders for kernels.
_CODE: Final = "FIL310"

#: The folder of this installation alone.
_OWN: Final = Path(__file__).parent / "__pycache__"

#: The file in each folder that says for which processor its machine code is.
_MARK: Final = "processor.txt"

#: The names of folders of any version, and what is in them: machine code, its checksums and locks, what Numba keeps.
_FOLDER: Final = re.compile(rf"trunnion-{re.escape(str(sys.implementation.cache_tag))}-(numba-[\d.]+|[\da-f]{{10}})")
_OURS: Final = re.compile(r".*\.(so|o|sum|lock|nbi|nbc|txt)(\.\d+)?")


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
                if not (folder / _MARK).exists():
                    _begin(folder)
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


def _begin(folder: Path) -> None:
    """Mark a folder in which nothing is yet, and remove former ones where no other installation keeps any."""
    with suppress(OSError):
        _write(folder / _MARK, _processor_name().encode("ascii"))
    if folder.parent == _OWN:
        remove_former(folder)


def remove_former(folder: Path) -> int:
    """Remove the folders beside this one that former versions made for the same processor; return how many.

    What is not named as one of ours, belongs to another user, or holds anything else than machine code, stays.
    """
    found = [
        each
        for each in sorted(folder.parent.glob("trunnion-*"))
        if each != folder and _FOLDER.fullmatch(each.name) and _is_former(each)
    ]
    for each in found:
        rmtree(each, ignore_errors=True)
    return len(found)


def _is_former(folder: Path) -> bool:
    """Whether a folder is ours, and not made for another processor: an installation may be shared by computers."""
    try:
        if folder.is_symlink() or not folder.is_dir() or _is_anothers(folder):
            return False
        mark = folder / _MARK
        if mark.exists() and mark.read_text(encoding="ascii") != _processor_name():
            return False
        return all(_OURS.fullmatch(each.name) for each in folder.rglob("*") if not each.is_dir())
    except (OSError, ValueError):
        return False


def holds_nothing(folder: Path) -> bool:
    """Whether no machine code is in a folder."""
    return all(each.name == _MARK for each in folder.iterdir())


def _candidates() -> Iterator[Path]:
    version = f"trunnion-{sys.implementation.cache_tag}-{_made_for()}"
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        yield Path(chosen) / version
    yield _OWN / version
    cache = user_cache()
    if cache is not None:
        yield cache / "trunnion" / version
    temporary = temporary_folder()
    if temporary is None:
        return
    if sys.platform == "win32":
        yield temporary / "trunnion" / version
    else:
        yield temporary / f"trunnion-{os.getuid()}-{version}"


def _made_for() -> str:
    """Return a short name for what makes machine code here (Numba, LLVM, ``trunnion.jit``), and what it is made for.

    Neither Numba nor LLVM is imported for it: their versions are in the names of the folders that installers write.
    """
    versions = ""
    found = find_spec("numba")
    if found is not None and found.origin is not None:
        packages = Path(found.origin).parents[1]
        versions = " ".join(sorted(each.name for one in ("numba", "llvmlite") for each in packages.glob(f"{one}-*")))
    makers = [Path(__file__).with_name(f"{name}.py") for name in ("build", "runtime", "library", "arguments")]
    made_by = [hashlib.sha256(file.read_bytes()).hexdigest() for file in makers if file.exists()]
    arrays = (is_as_expected(), object.__basicsize__)
    whole = (versions, made_by, sys.platform, platform.machine(), _processor(), arrays)
    return hashlib.sha256(repr(whole).encode()).hexdigest()[:10]


def _processor_name() -> str:
    """Return a short name for what the processor can do."""
    return hashlib.sha256(f"{platform.machine()} {_processor()}".encode()).hexdigest()[:16]


def _processor() -> str:
    """Return what the processor can do; where the system does not say it, the computer's name."""
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith(("flags", "Features")):
                return line
    return f"{platform.processor()} {platform.node()}"


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
    """The files of one kernel: its machine code, and a checksum of it."""

    def __init__(self, root: Path, name: str, digest: str) -> None:
        self._root = root
        # Short, as whole paths have 260 characters on Windows.
        self._prefix = f"{name.rpartition('.')[2]}-{hashlib.sha256(name.encode()).hexdigest()[:6]}-"
        self._stem = f"{self._prefix}{digest}"
        self._sum = root / f"{self._stem}.sum"
        self._found: Path | None = None

    @property
    def folder(self) -> Path:
        """A folder for what Numba itself keeps of it."""
        return self._root / self._stem

    @property
    def is_sealed(self) -> bool:
        """Whether it was complete once."""
        return self._sum.exists()

    def whole(self) -> Path | None:
        """Return its machine code if it is complete and undamaged: a linked library (``.so``), or object code."""
        if self._found is None:
            try:
                name, _, checksum = self._sum.read_text(encoding="ascii").partition(" ")
                file = self._root / name
                if file.stem == self._stem and hashlib.sha256(file.read_bytes()).hexdigest() == checksum:
                    self._found = file
            except (OSError, ValueError):
                return None
        return self._found

    def keep(self, code: bytes, *, is_linked: bool) -> Path:
        """Write it, and remove the files of the same kernel in other states of the sources.

        Raises ``OSError`` where it cannot be written.
        """
        self.remove()
        for old in self._root.glob(f"{self._prefix}*"):
            if old.stem != self._stem:
                _remove(old)
        file = self._root / f"{self._stem}{'.so' if is_linked else '.o'}"
        _write(file, code)
        _write(self._sum, f"{file.name} {hashlib.sha256(code).hexdigest()}".encode("ascii"))
        self._found = file
        return file

    def remove(self) -> None:
        """Remove all but the lock."""
        self._found = None
        for file in (self._sum, *(self._root / f"{self._stem}{suffix}" for suffix in (".so", ".o"))):
            _remove(file)

    @contextmanager
    def locked(self, *, wait: bool = True) -> Iterator[bool]:
        """Keep other processes from writing to it; gives False if one does already and ``wait`` is off.

        The system lifts the lock of a process that ends. Where there are no locks, processes do the same work twice.
        """
        with ExitStack() as held:
            try:
                free = _lock(held.enter_context((self._root / f"{self._stem}.lock").open("ab")), wait)
            except OSError:
                free = True
            yield free


def _write(file: Path, content: bytes) -> None:
    """Write a file that another process sees whole or not at all."""
    part = file.with_name(f"{file.name}.{os.getpid()}")
    try:
        part.write_bytes(content)
        part.replace(file)
    except OSError:  # on a full disk, half a file would only fill it more
        _remove(part)
        raise


def _remove(path: Path) -> None:
    """Remove a file or a folder; one that is in use, as a loaded library on Windows, stays."""
    if path.is_dir():
        rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError):
            path.unlink(missing_ok=True)


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
