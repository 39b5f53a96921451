"""CL files of a command: files, archives and stdin; and reading them with a progress bar."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from typing import BinaryIO

from trunnion.cl.read import ClReading
from trunnion.cli.progress import progress
from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.cl_or_program import read_cl_file
from trunnion.jobs.job import STDIN, streams
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath

#: Endings that archives add to the name of what they hold.
_PACKED = frozenset({".gz", ".bz2"})


def result_stem(file: str) -> str:
    """Return the name of what is made of a CL file, without its ending.

    Raises ``InputError`` for stdin, which has no name.
    """
    if file == STDIN:
        raise InputError(Problem("stdin", 0, Wording("FIL270", "result_without_name")))
    path = Path(file)
    return Path(path.stem).stem if path.suffix.lower() in _PACKED else path.stem


def begin_reading(
    files: Sequence[str],
    how: ClReading,
    executor: Executor,
) -> Iterator[list[Toolpath]]:
    """Toolpaths of CL files, those of one file or archive after the other.

    The first file is read at once in ``executor``, the others when they are due; none is kept. Returns when reading
    runs in its kernel, which leaves the interpreter to the imports of the caller.
    """
    scanning, inputs = Event(), streams(files)
    begun = [executor.submit(_read, inputs[0], how, scanning)]
    begun[0].add_done_callback(lambda _: scanning.set())
    scanning.wait()

    def one_by_one() -> Iterator[list[Toolpath]]:
        yield begun.pop().result()
        for file in inputs[1:]:
            yield _read(file, how, Event())

    return one_by_one()


def spline_tolerance(text: str) -> float | None:
    """Return the tolerance of splines; None for a text that the check of the settings will refuse."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if 1e-4 <= value <= 1.0 else None


def _read(file: str | BinaryIO, how: ClReading, scanning: Event) -> list[Toolpath]:
    @contextmanager
    def watch(name: str, size: int, unit: str) -> Iterator[Callable[[int], None]]:
        with progress(name, size, unit) as advance:

            def tell(more: int) -> None:
                advance(more)
                scanning.set()

            yield tell

    path = Path(file) if isinstance(file, str) else file
    return read_cl_file(path, watch, how)
