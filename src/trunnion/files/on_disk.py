"""Files and names that have reached the disk, so that a power failure cannot take them away again.

In:     files and folders.
Out:    the same, on the disk: a file holds what was written, and a folder has the names that it was given.
"""

import os
from contextlib import suppress
from pathlib import Path


def write_whole(file: Path, text: str, part: Path) -> None:
    """Write a file to the disk under another name (``part``), and give it its own once it is whole.

    Raises ``OSError`` if it cannot be written. Its name has reached the disk only after ``sync_folder``.
    """
    with part.open("wb") as stream:
        stream.write(text.encode())
        stream.flush()
        os.fsync(stream.fileno())
    part.replace(file)


def sync_folder(folder: Path) -> None:
    """Bring the names in a folder to the disk, where the system can."""
    with suppress(OSError):  # Windows opens no folders
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
