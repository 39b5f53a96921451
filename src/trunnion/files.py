"""Output files that appear complete or not at all, alone or several together."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from threading import Condition
from typing import BinaryIO

from trunnion.errors import InputError, Problem


class WriteProgress:
    """How much of a file has been written, for a thread that reads it at the same time."""

    def __init__(self) -> None:
        self._changed = Condition()
        self._size = self._expected_size = 0
        self._finished = False

    def advance(self, size: int, expected_size: int = 0) -> None:
        """Report that ``size`` bytes can be read, and how many there will be at the end by extrapolation."""
        with self._changed:
            self._size, self._expected_size = size, expected_size
            self._changed.notify_all()

    def finish(self) -> None:
        """Report that nothing more will be written."""
        with self._changed:
            self._finished = True
            self._changed.notify_all()

    def wait_for(self, size: int) -> bool:
        """Wait until ``size`` bytes can be read; return False if writing has finished, with whatever size."""
        with self._changed:
            self._changed.wait_for(lambda: self._finished or self._size >= size)
            return not self._finished

    def wait_until_finished(self) -> None:
        """Wait until nothing more will be written."""
        with self._changed:
            self._changed.wait_for(lambda: self._finished)

    @property
    def expected_size(self) -> int:
        """Expected number of bytes at the end, at least the present one."""
        with self._changed:
            return max(self._size, self._expected_size)


class OutputFiles:
    """A file being written, and further files beside it, in a hidden folder until all of them are complete.

    main   sink of the first file
    path   path at which it can be read back after ``flush``
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.path = folder / name
        self.main: BinaryIO = self.path.open("w+b")
        self._other_files: dict[Path, BinaryIO] = {}
        self._sync_thread: ThreadPoolExecutor | None = None

    def add_file(self, name: str) -> BinaryIO:
        """Begin a further file in the same folder, and return its sink."""
        path = self.path.parent / name
        assert path not in (self.path, *self._other_files), f"{name} is begun twice"
        self._other_files[path] = path.open("w+b")
        return self._other_files[path]

    @property
    def other_paths(self) -> list[Path]:
        """Paths of the further files, in the order in which they were begun."""
        return list(self._other_files)

    def flush(self) -> None:
        """Make everything written readable at the paths."""
        for sink in self.sinks():
            sink.flush()

    def start_sync(self) -> None:
        """Begin to bring the first file to the disk in a thread, so that ``sync`` has less to wait for."""
        self.flush()
        self._sync_thread = self._sync_thread or ThreadPoolExecutor(1)
        self._sync_thread.submit(os.fsync, self.main.fileno())

    def sync(self) -> None:
        """Bring all files to the disk, so that a power failure cannot leave half a file under its final name."""
        self.flush()
        for sink in self.sinks():
            os.fsync(sink.fileno())

    def restart(self) -> None:
        """Discard everything written."""
        self.main.seek(0)
        self.main.truncate()
        for path, sink in self._other_files.items():
            sink.close()
            path.unlink()
        self._other_files.clear()

    def close(self) -> None:
        """Close all files."""
        if self._sync_thread is not None:
            self._sync_thread.shutdown()
        for sink in self.sinks():
            sink.close()

    def sinks(self) -> list[BinaryIO]:
        """Return the sinks of all files, the first file's first."""
        return [self.main, *self._other_files.values()]


def atomic_output(target: str | BinaryIO) -> AbstractContextManager[OutputFiles]:
    """Files that reach ``target`` together when the block ends, or not at all if it raises.

    Parameters
    ----------
    target
        Path of the first file, whose folder takes the others, or a stream, which takes one file only.

    Raises
    ------
    InputError
        If a file cannot be written. For the first file this is known when the block begins. Earlier files of the same
        names stay as they were.
    """
    return _output_to_path(target) if isinstance(target, str) else _output_to_stream(target)


@contextmanager
def atomic_file(target: str) -> Iterator[BinaryIO]:
    """The sink of a single file, as ``atomic_output`` makes it.

    Its ``name`` is the path at which the file can be read back after a flush.
    """
    with atomic_output(target) as files:
        yield files.main


@contextmanager
def _output_to_stream(target: BinaryIO) -> Iterator[OutputFiles]:
    with tempfile.TemporaryDirectory(prefix="trunnion-") as folder:
        files = OutputFiles(Path(folder), "stream")
        try:
            yield files
            assert not files.other_paths, "a stream is one file"
            files.main.seek(0)
            shutil.copyfileobj(files.main, target)
            target.flush()
        finally:
            files.close()


@contextmanager
def _output_to_path(target: str) -> Iterator[OutputFiles]:
    path = Path(target)
    try:
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(13, "Permission denied")
        # Beside the target, so that files are renamed into place and not copied.
        hidden = Path(tempfile.mkdtemp(prefix=f".{path.name}.", dir=path.parent))
    except OSError as error:
        raise _cannot_write(target, error) from None
    try:
        files = OutputFiles(hidden, path.name)
        try:
            yield files
            files.sync()
        finally:
            files.close()
        _move_all([*files.other_paths, files.path], path.parent)
    except OSError as error:
        raise _cannot_write(target, error) from None
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


def _move_all(files: list[Path], folder: Path) -> None:
    """Move files to a folder, all or none: if one of them fails, the earlier files of those names are restored."""
    targets = [folder / file.name for file in files]
    for target in targets:
        if target.is_dir():
            raise IsADirectoryError(21, f"{target.name} is a folder")
    moved: list[tuple[Path, Path | None]] = []
    try:
        for file, target in zip(files, targets, strict=True):
            last = file is files[-1]
            moved.append((target, None if last else _backup(target, file.with_name(f"{file.name}.before"))))
            file.replace(target)
    except OSError:
        for target, before in reversed(moved[:-1]):
            if before is None:
                target.unlink(missing_ok=True)
            else:
                before.replace(target)
        raise


def _backup(file: Path, under: Path) -> Path | None:
    """Give a file, if it exists, a second name under which it survives being replaced."""
    if not file.exists():
        return None
    try:
        os.link(file, under)
    except OSError:  # some file systems have no hard links
        shutil.copy2(file, under)
    return under


def _cannot_write(target: str, error: OSError) -> InputError:
    return InputError(Problem(target, 0, f"cannot be written: {error.strerror or error}", "name another file"))
