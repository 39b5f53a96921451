"""The files of a folder, and what each is by its content: nothing is read but the head of regular files.

In:     a folder.
Out:    ``FoundFile`` of each file in it and below.
"""

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Final

from trunnion.cl import is_cl_file
from trunnion.cl.dialects import recognize_dialect
from trunnion.cl.sources import cl_sources
from trunnion.errors import InputError
from trunnion.readers.program.kinds import recognize

#: Larger files are not tried, bytes: a program of so many has some five million blocks.
MOST_BYTES: Final = 200_000_000

#: So much of a file is looked at, bytes.
_HEAD: Final = 1 << 16


class FileKind(StrEnum):
    """What a file is."""

    CL = "CL file"
    PROGRAM = "program"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class FoundFile:
    """A file of the folder.

    name       from the folder on, with ``/``
    kind       what it is
    looks      dialect of a CL file; what another one looks like, or why it is not tried; empty: it says too little
    languages  folders of the readers that read a program; None: its content does not tell
    is_tried   whether anything is to be tried
    """

    name: str
    path: Path
    kind: FileKind
    looks: str = ""
    languages: tuple[str, ...] | None = None
    is_tried: bool = True


def found_files(folder: Path) -> Iterator[FoundFile]:
    """Yield the files of a folder and those below, in the order of their names; links are not followed."""
    for place, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = Path(place, name)
            yield _found(path.relative_to(folder).as_posix(), path)


def count_files(folder: Path) -> int:
    """How many files there are."""
    return sum(len(names) for _, _, names in os.walk(folder))


def _found(name: str, path: Path) -> FoundFile:
    if why := _untouchable(path):
        return FoundFile(name, path, FileKind.OTHER, why, is_tried=False)
    try:
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except OSError as error:
        return FoundFile(name, path, FileKind.OTHER, f"cannot be read: {error.strerror}", is_tried=False)
    if is_cl_file(path):
        dialect = _dialect(path)
        return FoundFile(name, path, FileKind.CL, dialect) if dialect else _other(name, path, "an archive of others")
    if not head.strip():
        return _other(name, path, "an empty file")
    if b"\0" in head:
        return _other(name, path, "a binary file")
    found = recognize(path)
    if found is None:
        return FoundFile(name, path, FileKind.PROGRAM)
    if not found.kind.languages:
        return _other(name, path, found.kind.name)
    return FoundFile(name, path, FileKind.PROGRAM, found.kind.name, found.kind.languages)


def _other(name: str, path: Path, looks: str) -> FoundFile:
    return FoundFile(name, path, FileKind.OTHER, looks, ())


def _untouchable(path: Path) -> str:
    """Return why a file is not opened; empty if it is."""
    try:
        found = path.lstat()
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    if stat.S_ISLNK(found.st_mode):
        return "a link"
    if not stat.S_ISREG(found.st_mode):
        return "a device or a pipe"
    return f"larger than {MOST_BYTES / 1e6:.0f} MB" if found.st_size > MOST_BYTES else ""


def _dialect(path: Path) -> str:
    """Return the dialect of a CL file, by the first file of an archive; empty if that is none of CL data."""
    try:
        with cl_sources(path)[0].open() as text:
            head = text.read(_HEAD)
    except (InputError, OSError):
        return ""
    return recognize_dialect(head).dialect.title
