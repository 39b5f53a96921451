"""Names that files can have on every system, and that show what they are."""

import re
import unicodedata
from pathlib import PurePosixPath
from typing import Final

from trunnion.messages import Wording, phrase
from trunnion.transliteration import is_seen

#: Names of devices on Windows, whatever follows a point.
_DEVICES: Final = re.compile(r"(con|prn|aux|nul|clock\$|conin\$|conout\$|(com|lpt)[0-9¹²³]) *(\..*)?", re.IGNORECASE)

#: What names of files on Windows do not have.
_NOT_IN_NAMES: Final = re.compile(r'[<>:"/\\|?*]')

#: Bytes of a name that every file system takes.
_MOST_BYTES: Final = 255


def name_fault(path: PurePosixPath) -> Wording | None:
    """Return what is wrong with a relative path as that of a file that is written; None if every system takes
    it.

    A name that begins with a point is wrong, too: such files are settings of other programs, and hidden.

    >>> name_fault(PurePosixPath("top/top.mpf")), str(name_fault(PurePosixPath(".git/hooks/pre-commit")))
    (None, '".git" begins with a point')
    """
    return next((fault for part in path.parts if (fault := _fault(part))), None)


def _fault(name: str) -> Wording | None:
    if name.startswith("."):
        return phrase("name_begins_with_point", name=name)
    if name != name.strip() or name.endswith("."):
        return phrase("name_with_blank_at_end", name=name)
    if _DEVICES.fullmatch(name):
        return phrase("name_of_device", name=name)
    if _NOT_IN_NAMES.search(name):
        return phrase("name_with_odd_character", name=name)
    if not is_seen(name):
        return phrase("name_with_unseen_character", name=name)
    if len(unicodedata.normalize("NFD", name).encode("utf-8")) > _MOST_BYTES:
        return phrase("name_too_long", name=name)
    return None
