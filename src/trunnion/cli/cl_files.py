"""Reading CL files for a command, with a progress bar."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from pathlib import Path
from threading import Event

from trunnion.cl import read_cl
from trunnion.cli.progress import progress
from trunnion.model.toolpath import Toolpath


def read_toolpaths(
    files: Sequence[str], units: str | None, strict: bool, executor: Executor, dialect: str | None = None
) -> Iterator[Toolpath]:
    """Toolpaths of CL files, one after the other; units, dialect and ``strict`` as ``trunnion.cl.read_cl`` has them.

    The first one is read at once in ``executor``, the others when they are due; none is kept. Returns when reading runs
    in its kernel, which leaves the interpreter to the imports of the caller.
    """
    scanning = Event()
    begun = [executor.submit(_read, files[0], units, dialect, strict, scanning)]
    begun[0].add_done_callback(lambda _: scanning.set())
    scanning.wait()

    def one_by_one() -> Iterator[Toolpath]:
        yield begun.pop().result()
        for file in files[1:]:
            yield _read(file, units, dialect, strict, Event())

    return one_by_one()


def _read(file: str, units: str | None, dialect: str | None, strict: bool, scanning: Event) -> Toolpath:
    path = Path(file)
    size = path.stat().st_size if path.is_file() else 0
    with progress(path.name, size, "B") as advance:
        done = 0

        def so_far(read: int) -> None:
            nonlocal done
            advance(read - done)
            done = read
            scanning.set()

        return read_cl(path, units=units, dialect=dialect, strict=strict, progress=so_far)
