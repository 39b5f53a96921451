"""Reading CL files for a command, with a progress bar."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from pathlib import Path

from trunnion.cl import read_cl
from trunnion.cli.progress import progress
from trunnion.toolpath import Toolpath


def toolpaths(files: Sequence[str], units: str | None, strict: bool, aside: Executor) -> Iterator[Toolpath]:
    """Toolpaths of CL files, one after the other; units and ``strict`` as ``trunnion.cl.read_cl`` has them.

    The first one is read from now on, ``aside``, and the others when they are asked for: none is kept.
    """
    begun = [aside.submit(_read, files[0], units, strict)]

    def one_by_one() -> Iterator[Toolpath]:
        yield begun.pop().result()
        for file in files[1:]:
            yield _read(file, units, strict)

    return one_by_one()


def _read(file: str, units: str | None, strict: bool) -> Toolpath:
    path = Path(file)
    size = path.stat().st_size if path.is_file() else 0
    with progress(path.name, size, "B") as advance:
        done = 0

        def so_far(read: int) -> None:
            nonlocal done
            advance(read - done)
            done = read

        return read_cl(path, units=units, strict=strict, progress=so_far)
