"""Where a result goes: to a file, to a stream, or into memory."""

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, TypeAlias

from trunnion.api.arguments import check_stream
from trunnion.files import OutputFiles, atomic_output

#: A file by its path, a stream that takes bytes, or None: the result keeps the text.
OutputLike: TypeAlias = str | os.PathLike[str] | BinaryIO | None


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """A result that is being written; nothing of it appears before the block of ``open_target`` has ended.

    files   takes what is written
    name    what messages call it
    path    of the file; None: it is no file
    memory  takes the text where there is no other place; None: there is
    """

    files: OutputFiles
    name: str = "the program"
    path: Path | None = None
    memory: io.BytesIO | None = None

    @property
    def subprograms(self) -> tuple[Path, ...]:
        """The files beside the first, once the block has ended."""
        return tuple(self.path.with_name(file.name) for file in self.files.other_paths) if self.path else ()


@contextmanager
def open_target(place: OutputLike) -> Iterator[Target]:
    """Open the place of a result.

    Raises
    ------
    InputError
        When a file cannot be written; this is found out before anything is computed.
    """
    if isinstance(place, str | os.PathLike):
        with atomic_output(os.fspath(place)) as files:
            yield Target(files, os.fspath(place), Path(place))
    elif place is not None:
        check_stream("output", place)
        with atomic_output(place) as files:
            yield Target(files)
    else:
        memory = io.BytesIO()
        with atomic_output(memory) as files:
            yield Target(files, memory=memory)


def written_text(path: Path | None, memory: io.BytesIO | None) -> str | None:
    """What was written to a file or into memory; None where it went to a stream."""
    if memory is not None:
        return memory.getvalue().decode("utf-8")
    return None if path is None else path.read_bytes().decode("utf-8")
