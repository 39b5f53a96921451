"""Names that files can have on every system, and that show what they are."""

import re
import unicodedata
from pathlib import PurePosixPath
from typing import Final

from trunnion.transliteration import is_seen

#: Names of devices on Windows, whatever follows a point.
_DEVICES: Final = re.compile(r"(con|prn|aux|nul|clock\$|conin\$|conout\$|(com|lpt)[0-9¹²³]) *(\..*)?", re.IGNORECASE)

#: What names of files on Windows do not have.
_NOT_IN_NAMES: Final = re.compile(r'[<>:"/\\|?*]')

#: Bytes of a name that every file system takes.
_MOST_BYTES: Final = 255


def name_fault(path: PurePosixPath) -> str:
    """Return what is wrong with a relative path as that of a file that is written; empty if every system takes it.

    A name that begins with a point is wrong, too: such files are settings of other programs, and hidden.

    >>> name_fault(PurePosixPath("top/top.mpf")), name_fault(PurePosixPath(".git/hooks/pre-commit"))
    ('', '".git" begins with a point')
    """
    return next((f'"{part}" {fault}' for part in path.parts if (fault := _fault(part))), "")


def _fault(name: str) -> str:
    if name.startswith("."):
        return "begins with a point"
    if name != name.strip() or name.endswith("."):
        return "begins with a blank, or ends in one or in a point"
    if _DEVICES.fullmatch(name):
        return "is a device of Windows"
    if _NOT_IN_NAMES.search(name):
        return "has a character that is no part of a name"
    if not is_seen(name):
        return "has a character that nobody sees"
    if len(unicodedata.normalize("NFD", name).encode("utf-8")) > _MOST_BYTES:
        return "is too long"
    return ""
