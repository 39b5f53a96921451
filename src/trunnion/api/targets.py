"""Where a result goes: to a file, to a stream, or into memory."""

import io
import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, TypeAlias

from trunnion.api.arguments import check_path
from trunnion.errors import InputError, Problem
from trunnion.files import OutputFiles, OutputPlace, atomic_output, check_stream, resolve_output

#: A file by its path, a stream that takes bytes, or None: the result keeps the text.
OutputLike: TypeAlias = str | os.PathLike[str] | BinaryIO | None


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """A result that is being written; nothing of it appears before the block of ``open_target`` has ended.

    files   takes what is written
    name    what messages call it
    path    of the file; None: it is no file, or a device
    memory  takes the text where there is no other place; None: there is
    report  place of its report; None: there is none
    """

    files: OutputFiles
    name: str = "the program"
    path: Path | None = None
    memory: io.BytesIO | None = None
    report: OutputPlace | None = None

    @property
    def subprograms(self) -> tuple[Path, ...]:
        """The files beside the first, once the block has ended."""
        return tuple(self.path.with_name(file.name) for file in self.files.other_paths) if self.path else ()


def check_output_name(argument: str, file: object, endings: Sequence[str], what: str) -> OutputPlace:
    """The place of an output whose name tells its form, which is found out before any work; ``what`` says why it is so.

    Raises
    ------
    InputError
        If its name ends otherwise, or it cannot be written.
    """
    place = resolve_output(check_path(argument, file))
    if Path(place.name).suffix.lower() not in endings:
        raise InputError(Problem(place.name, 0, what, f"let its name end in {' or '.join(endings)}", code="FIL260"))
    return place


@contextmanager
def open_target(
    place: OutputLike, *, report: str | os.PathLike[str] | None = None, inputs: Iterable[str | os.PathLike[str]] = ()
) -> Iterator[Target]:
    """Open the place of a result.

    Parameters
    ----------
    place
        Of the result.
    report
        File of its report, which appears with it.
    inputs
        Files that are read: none of them is written over.

    Raises
    ------
    InputError
        When a file cannot be written; this is found out before anything is computed.
    """
    beside = None if report is None else resolve_output(report)
    if isinstance(place, str | os.PathLike):
        found = resolve_output(place)
        path = None if found.is_stream else Path(place)
        with atomic_output(found, report=beside, inputs=inputs, is_job=True) as files:
            yield Target(files, found.name, path, report=beside)
        return
    memory = io.BytesIO() if place is None else None
    stream: BinaryIO | None = memory if place is None else place
    assert stream is not None
    check_stream(stream, "output")
    with atomic_output(stream, report=beside, inputs=inputs) as files:
        yield Target(files, memory=memory, report=beside)


def written_text(path: Path | None, memory: io.BytesIO | None) -> str | None:
    """What was written to a file or into memory; None where it went to a stream."""
    if memory is not None:
        return memory.getvalue().decode("utf-8")
    return None if path is None else path.read_bytes().decode("utf-8")
