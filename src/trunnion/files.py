"""Files that appear whole or not at all, alone or several together."""

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from threading import Condition
from typing import BinaryIO

from trunnion.errors import InputError, Problem


class Growing:
    """How far the writing of a file has come, for whoever reads it at the same time."""

    def __init__(self) -> None:
        self._news = Condition()
        self._size = self._foreseen = 0
        self._ended = False

    def grow(self, size: int, foreseen: int = 0) -> None:
        """Say that ``size`` bytes can be read, and how many there will be if the file goes on as it began."""
        with self._news:
            self._size, self._foreseen = size, foreseen
            self._news.notify_all()

    def end(self) -> None:
        """Say that nothing more will be written."""
        with self._news:
            self._ended = True
            self._news.notify_all()

    def reach(self, size: int) -> bool:
        """Wait until so many bytes can be read, or nothing more is written: then False, be they there or not."""
        with self._news:
            self._news.wait_for(lambda: self._ended or self._size >= size)
            return not self._ended

    def wait(self) -> None:
        """Wait until nothing more will be written."""
        with self._news:
            self._news.wait_for(lambda: self._ended)

    @property
    def foreseen(self) -> int:
        """About how many bytes there will be, and no fewer than there are."""
        with self._news:
            return max(self._size, self._foreseen)


class Output:
    """A file that is being written, and others beside it; nobody sees them before all of them are complete.

    main   sink of the file itself
    path   under which it can be read back, once it is flushed
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.path = folder / name
        self.main: BinaryIO = self.path.open("w+b")
        self._others: dict[Path, BinaryIO] = {}
        self._aside: ThreadPoolExecutor | None = None

    def begin(self, name: str) -> BinaryIO:
        """Begin another file of the same folder."""
        path = self.path.parent / name
        assert path not in (self.path, *self._others), f"{name} is begun twice"
        self._others[path] = path.open("w+b")
        return self._others[path]

    @property
    def others(self) -> list[Path]:
        """The files beside the first, in the order in which they were begun."""
        return list(self._others)

    def flush(self) -> None:
        """See that all can be read back."""
        for sink in (self.main, *self._others.values()):
            sink.flush()

    def settle(self) -> None:
        """Begin to bring what is written to the disk, beside whatever comes next: ``keep`` has less to wait for."""
        self.flush()
        self._aside = self._aside or ThreadPoolExecutor(1)
        self._aside.submit(os.fsync, self.main.fileno())

    def keep(self) -> None:
        """See that all is on the disk for good, so that no power failure leaves half a file under its new name."""
        self.flush()
        for sink in (self.main, *self._others.values()):
            os.fsync(sink.fileno())

    def begin_again(self) -> None:
        """Forget all that was written."""
        self.main.seek(0)
        self.main.truncate()
        for path, sink in self._others.items():
            sink.close()
            path.unlink()
        self._others.clear()

    def close(self) -> None:
        """Write no more."""
        if self._aside is not None:
            self._aside.shutdown()
        for sink in (self.main, *self._others.values()):
            sink.close()


@contextmanager
def output(target: str) -> Iterator[Output]:
    """A file, and others beside it, that reach ``target`` (a path, or ``-`` for stdout) when the block ends without an
    error.

    Others go into the folder of the first; stdout takes none.

    Raises
    ------
    InputError
        When they cannot be written; for the first file this is found out before anything is computed. Files that were
        there before are then as they were.
    """
    if target == "-":
        with tempfile.TemporaryDirectory(prefix="trunnion-") as folder:
            made = Output(Path(folder), "stdout")
            try:
                yield made
                assert not made.others, "stdout is one file"
                made.main.seek(0)
                sys.stdout.flush()
                shutil.copyfileobj(made.main, sys.stdout.buffer)
                sys.stdout.buffer.flush()
            finally:
                made.close()
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
        made = Output(hidden, path.name)
        try:
            yield made
            made.keep()
        finally:
            made.close()
        _move([*made.others, made.path], path.parent)
    except OSError as error:
        raise _cannot_write(target, error) from None
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


@contextmanager
def whole(target: str) -> Iterator[BinaryIO]:
    """A sink whose bytes reach ``target`` as the one file of ``output``.

    Its ``name`` is the path under which it can be read back before that, once it is flushed.
    """
    with output(target) as made:
        yield made.main


def _move(files: list[Path], folder: Path) -> None:
    """Take files to a folder, all or none: what was there before comes back where one cannot be taken there."""
    targets = [folder / file.name for file in files]
    for target in targets:
        if target.is_dir():
            raise IsADirectoryError(21, f"{target.name} is a folder")
    moved: list[tuple[Path, Path | None]] = []
    try:
        for file, target in zip(files, targets, strict=True):
            last = file is files[-1]
            moved.append((target, None if last else _kept(target, file.with_name(f"{file.name}.before"))))
            file.replace(target)
    except OSError:
        for target, before in reversed(moved[:-1]):
            if before is None:
                target.unlink(missing_ok=True)
            else:
                before.replace(target)
        raise


def _kept(file: Path, under: Path) -> Path | None:
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
