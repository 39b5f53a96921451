"""CL files read with progress, as a terminal or an observer shows it."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import BinaryIO, TypeAlias

from trunnion.cl.read import ClReading, read_cl_files
from trunnion.errors import unusable_file
from trunnion.messages import phrase
from trunnion.model.toolpath import Toolpath

#: Name, size and unit of what is read -> a context that gives a function for how much more is read.
Watch: TypeAlias = Callable[[str, int, str], AbstractContextManager[Callable[[int], None]]]


def read_watched(file: Path | BinaryIO, watch: Watch, how: ClReading) -> list[Toolpath]:
    """Read as ``read_cl_files`` does, and let ``watch`` accompany it.

    Raises ``InputError`` if a file cannot be used, with every problem found.
    """
    is_plain = isinstance(file, Path) and unusable_file(file, phrase("file_of_cl")) is None
    size = file.stat().st_size if isinstance(file, Path) and is_plain else 0
    with watch(file.name if isinstance(file, Path) else "stdin", size, "B") as advance:
        done = 0

        def so_far(read: int) -> None:
            nonlocal done
            advance(read - done)
            done = read

        return read_cl_files(file, how, so_far)
