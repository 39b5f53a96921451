"""The file of a definition on disk: what the page may read and write, and what it must not change in passing.

In:     a folder, a name, the text of the page, whose lines end with a newline alone.
Out:    the file as it is, and the file as it is saved: with its byte order mark and the line ends that it had.
"""

import difflib
from pathlib import Path, PurePosixPath
from typing import Final

from trunnion.builder.draft import MOST_LETTERS
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.files import name_fault
from trunnion.messages import Wording, phrase

#: Letters that the name of a definition may have.
_LONGEST: Final = 120

_MARK: Final = "\ufeff"

#: Line ends of longer files are not found line by line: it takes the square of them.
_MOST_COMPARED: Final = 5_000


def is_file_name(name: str) -> bool:
    """Return whether a definition can have this name, on any system."""
    path = PurePosixPath(name)
    return name.endswith(".toml") and len(name) <= _LONGEST and path.parts == (name,) and not name_fault(path)


def check_place(file: Path) -> None:
    """Check that a file, if it is there, can be read, and that no link leads from it out of its folder.

    Raises ``InputError`` if not.
    """
    if not is_within(file, file.parent):
        raise InputError(Problem(str(file), 0, Wording("PAG211", "link_leads_out", resolve=file.resolve())))
    if file.exists() and (unusable := unusable_file(file, phrase("file_of_machine"))):
        raise InputError(unusable)


def read_raw(file: Path) -> str:
    """Return the text of a file, with its byte order mark and its line ends.

    Raises ``InputError`` if it is not there, no regular file, too long, or not UTF-8.
    """
    if unusable := unusable_file(file, phrase("file_of_machine")):
        raise InputError(unusable)
    try:
        with file.open(encoding="utf-8", newline="") as stream:
            text = stream.read(MOST_LETTERS + 2)
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(
            Problem(
                str(file),
                0,
                Wording("PAG212", "not_utf_8")
                if isinstance(error, UnicodeDecodeError)
                else Wording("PAG212", "cannot_read", strerror=error.strerror),
            )
        ) from None
    check_length(file, text)
    return text


def check_length(file: Path, text: str) -> None:
    """Raise ``InputError`` for the text of a file that is too long: one that is saved can be opened again."""
    if len(text) > MOST_LETTERS:
        raise InputError(Problem(str(file), 0, Wording("PAG213", "more_letters", most_letters=MOST_LETTERS)))


def page_text(raw: str) -> str:
    """Return the text of a file as the page has it."""
    return raw.removeprefix(_MARK).replace("\r\n", "\n")


def file_text(text: str, old: str) -> str:
    """Return a text of the page as the file gets it: each line that it had ends as before, new ones as most do.

    text  of the page
    old   of ``read_raw``; empty: there is no file yet
    """
    mark = _MARK if old.startswith(_MARK) else ""
    windows = old.count("\r\n")
    most = "\r\n" if 2 * windows > old.count("\n") else "\n"
    lines = text.split("\n")
    ends = [most] * len(lines)
    if 0 < windows < old.count("\n"):
        had = old.removeprefix(_MARK).split("\n")
        before = [line.removesuffix("\r") for line in had]
        ended = ["\r\n" if line.endswith("\r") else "\n" for line in had[:-1]] + [most]
        if max(len(lines), len(had)) <= _MOST_COMPARED:
            for a, b, size in difflib.SequenceMatcher(None, before, lines, autojunk=False).get_matching_blocks():
                ends[b : b + size] = ended[a : a + size]
    ends[-1] = ""
    return mark + "".join(line + end for line, end in zip(lines, ends, strict=True))
