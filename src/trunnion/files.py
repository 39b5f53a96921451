"""Files that appear whole or not at all, alone or several together."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from threading import Condition
from typing import BinaryIO

from trunnion.errors import InputError, Problem


class WriteProgress:
    """How far the writing of a file has come, for whoever reads it at the same time."""

    def __init__(self) -> None:
        self._changed = Condition()
        self._size = self._expected_size = 0
        self._finished = False

    def advance(self, size: int, expected_size: int = 0) -> None:
        """Say that ``size`` bytes can be read, and how many there will be if the file goes on as it began."""
        with self._changed:
            self._size, self._expected_size = size, expected_size
            self._changed.notify_all()

    def finish(self) -> None:
        """Say that nothing more will be written."""
        with self._changed:
            self._finished = True
            self._changed.notify_all()

    def wait_for(self, size: int) -> bool:
        """Wait until so many bytes can be read, or nothing more is written: then False, be they there or not."""
        with self._changed:
            self._changed.wait_for(lambda: self._finished or self._size >= size)
            return not self._finished

    def wait_until_finished(self) -> None:
        """Wait until nothing more will be written."""
        with self._changed:
            self._changed.wait_for(lambda: self._finished)

    @property
    def expected_size(self) -> int:
        """About how many bytes there will be, and no fewer than there are."""
        with self._changed:
            return max(self._size, self._expected_size)


class OutputFiles:
    """A file that is being written, and others beside it; nobody sees them before all of them are complete.

    main   sink of the file itself
    path   under which it can be read back, once it is flushed
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.path = folder / name
        self.main: BinaryIO = self.path.open("w+b")
        self._other_files: dict[Path, BinaryIO] = {}
        self._sync_thread: ThreadPoolExecutor | None = None

    def add_file(self, name: str) -> BinaryIO:
        """Begin another file of the same folder."""
        path = self.path.parent / name
        assert path not in (self.path, *self._other_files), f"{name} is begun twice"
        self._other_files[path] = path.open("w+b")
        return self._other_files[path]

    @property
    def other_paths(self) -> list[Path]:
        """The files beside the first, in the order in which they were begun."""
        return list(self._other_files)

    def flush(self) -> None:
        """See that all can be read back."""
        for sink in (self.main, *self._other_files.values()):
            sink.flush()

    def start_sync(self) -> None:
        """Begin to bring what is written to the disk, beside whatever comes next: ``sync`` has less to wait for."""
        self.flush()
        self._sync_thread = self._sync_thread or ThreadPoolExecutor(1)
        self._sync_thread.submit(os.fsync, self.main.fileno())

    def sync(self) -> None:
        """See that all is on the disk for good, so that no power failure leaves half a file under its new name."""
        self.flush()
        for sink in (self.main, *self._other_files.values()):
            os.fsync(sink.fileno())

    def restart(self) -> None:
        """Forget all that was written."""
        self.main.seek(0)
        self.main.truncate()
        for path, sink in self._other_files.items():
            sink.close()
            path.unlink()
        self._other_files.clear()

    def close(self) -> None:
        """Write no more."""
        if self._sync_thread is not None:
            self._sync_thread.shutdown()
        for sink in (self.main, *self._other_files.values()):
            sink.close()


@contextmanager
def atomic_output(target: str | BinaryIO) -> Iterator[OutputFiles]:
    """A file, and others beside it, that reach ``target`` (a path or a stream) when the block ends without an error.

    Others go into the folder of the first; a stream takes none.

    Raises
    ------
    InputError
        When they cannot be written; for the first file this is found out before anything is computed. Files that were
        there before are then as they were.
    """
    if not isinstance(target, str):
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
        return
    path = Path(target)
    try:
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(13, "Permission denied")
        # Beside the target, so that a file gets there by a new name and not by a copy.
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


@contextmanager
def atomic_file(target: str) -> Iterator[BinaryIO]:
    """A sink whose bytes reach ``target`` as the one file of ``atomic_output``.

    Its ``name`` is the path under which it can be read back before that, once it is flushed.
    """
    with atomic_output(target) as files:
        yield files.main


def _move_all(files: list[Path], folder: Path) -> None:
    """Take files to a folder, all or none: what was there before comes back where one cannot be taken there."""
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
    """Another name for a file, if there is one, under which it lives on when it is replaced."""
    if not file.exists():
        return None
    try:
        os.link(file, under)
    except OSError:  # some systems have no second names
        shutil.copy2(file, under)
    return under


def _cannot_write(target: str, error: OSError) -> InputError:
    return InputError(Problem(target, 0, f"cannot be written: {error.strerror or error}", "name another file"))
