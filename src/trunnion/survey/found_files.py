"""The files of a folder, and what each is by its content: nothing is read but the head of regular files.

In:     a folder.
Out:    ``FoundFile`` of each file in it and below.
"""

import os
import stat
from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path
from typing import Final

from trunnion.cl import is_cl_file
from trunnion.cl.dialects import recognize_dialect
from trunnion.cl.sources import cl_sources
from trunnion.errors import InputError
from trunnion.messages import Wording, foreign, word_said
from trunnion.readers.program.kinds import recognize
from trunnion.records import dataclass

#: Larger files are not tried, bytes: a program of so many has some five million blocks.
MOST_BYTES: Final = 200_000_000

#: What a file looks like that says too little.
UNKNOWN: Final = foreign("")

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
    looks_said dialect of a CL file; what another one looks like, or why it is not tried; empty: it says too little
    languages  folders of the readers that read a program; None: its content does not tell
    is_tried   whether anything is to be tried
    caller     the file beside it that calls it: a subprogram is read through that one
    """

    name: str
    path: Path
    kind: FileKind
    looks_said: Wording = UNKNOWN
    languages: tuple[str, ...] | None = None
    is_tried: bool = True
    caller: str = ""

    @property
    def looks(self) -> str:
        """What it looks like, in English."""
        return str(self.looks_said)


def found_files(folder: Path) -> Iterator[FoundFile]:
    """Yield the files of a folder and those below, in the order of their names; links are not followed.

    A folder that cannot be read stands for its files.
    """
    unread = list[OSError]()
    for place, folders, names in os.walk(folder, onerror=unread.append):
        folders.sort()
        for name in sorted(names):
            path = Path(place, name)
            yield _found(_name(path, folder), path)
    for error in unread:
        path = Path(error.filename)
        yield FoundFile(_name(path, folder), path, FileKind.OTHER, _unreadable(error), is_tried=False)


def is_touchable(path: Path) -> bool:
    """Return whether a file may be opened: a regular one, and none too large."""
    return not _untouchable(path)


def _found(name: str, path: Path) -> FoundFile:
    if why := _untouchable(path):
        return FoundFile(name, path, FileKind.OTHER, why, is_tried=False)
    try:
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except OSError as error:
        return FoundFile(name, path, FileKind.OTHER, _unreadable(error), is_tried=False)
    if is_cl_file(path):
        try:
            return FoundFile(name, path, FileKind.CL, _dialect(path))
        except InputError as error:
            return _other(name, path, Wording("survey", "archive", what=error.problems[0].wording))
    if not head.strip():
        return _other(name, path, Wording("survey", "empty_file"))
    if b"\0" in head:
        return _other(name, path, Wording("survey", "binary_file"))
    found = recognize(path)
    if found is None:
        return FoundFile(name, path, FileKind.PROGRAM)
    if not found.kind.languages:
        return _other(name, path, found.kind.name)
    return FoundFile(name, path, FileKind.PROGRAM, found.kind.name, found.kind.readers)


def _other(name: str, path: Path, looks: Wording) -> FoundFile:
    return FoundFile(name, path, FileKind.OTHER, looks, ())


def _untouchable(path: Path) -> Wording | None:
    """Return why a file is not opened; None if it is."""
    try:
        found = path.lstat()
    except OSError as error:
        return _unreadable(error)
    if stat.S_ISLNK(found.st_mode):
        return Wording("survey", "link")
    if not stat.S_ISREG(found.st_mode):
        return Wording("survey", "device")
    return Wording("survey", "too_large", most=MOST_BYTES / 1e6) if found.st_size > MOST_BYTES else None


def _dialect(path: Path) -> Wording:
    """Return the dialect of a CL file, by the first file of an archive.

    Raises ``InputError`` for an archive that has none, or cannot be unpacked.
    """
    with cl_sources(path)[0].open() as text:
        return word_said(recognize_dialect(text.read(_HEAD)).dialect.title)


def _name(path: Path, folder: Path) -> str:
    """Return a name as texts can have it: what is no letter in UTF-8 is a question mark."""
    return path.relative_to(folder).as_posix().encode("utf-8", "replace").decode()


def _unreadable(error: OSError) -> Wording:
    return Wording("survey", "unreadable", strerror=str(error.strerror))
