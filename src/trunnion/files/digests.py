"""Digests of files: each file is read once in a job, as long as it stays as it is.

In:     files, before and after a job writes.
Out:    their digests; where a file has another size, time or place on the disk than when it was read, it is read anew.
"""

import hashlib
import os
from pathlib import Path
from typing import BinaryIO, TypeAlias

#: What the system says of a file that is another one, or was written since.
_Version: TypeAlias = tuple[int, ...]


class FileDigests:
    """The digests of the files of one job; ``known`` are those that were read, each with what the file was then."""

    def __init__(self) -> None:
        self.known: dict[Path, tuple[_Version, str]] = {}

    def of(self, file: Path) -> str | None:
        """Return the digest of a file; None: there is none; empty: it cannot be read."""
        try:
            with file.open("rb") as stream:
                version = _version(stream)
                found = self.known.get(file)
                if found is None or found[0] != version:
                    found = self.known[file] = version, hashlib.file_digest(stream, "sha256").hexdigest()
                return found[1]
        except FileNotFoundError:
            return None
        except OSError:
            return ""

    def take(self, others: "FileDigests") -> None:
        """Take what others know."""
        self.known.update(others.known)


def digest_of(file: Path) -> str | None:
    """Return the digest of a file, which is read; None: there is none; empty: it cannot be read."""
    return FileDigests().of(file)


def _version(stream: BinaryIO) -> _Version:
    found = os.fstat(stream.fileno())
    return found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns
