"""Recognizes the dialect of a CL file by its lines, never by its name."""

import re
from collections.abc import Iterable
from operator import itemgetter
from typing import Final

from trunnion.cl.dialect import Dialect
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: Bytes of a line that marks are looked for in: the same line comes often.
_COMPARED: Final = 48

#: Text behind these words may be anything, so it is no mark; points look alike in most dialects, and there are many.
_NO_MARKS: Final = (b"PPRINT", b"INSERT", b"DISPLY", b"DISPLAY", b"TPRINT", b"GOTO")


@dataclass(frozen=True, slots=True, eq=False)
class Recognition:
    """The dialect of a file, and why; ``marked``: a line has a mark of it, so that it is no mere default."""

    dialect: Dialect
    why: Wording
    marked: bool = True


def recognize(head: bytes, dialects: Iterable[Dialect], default: Dialect) -> Recognition:
    """Return the dialect that the first line of ``head`` names, else the one with most different marks in lines.

    Among equals it is the first one. A general one counts where no other has a mark; without any mark it is the
    ``default``.
    """
    dialects = tuple(dialects)
    for dialect in dialects:
        if dialect.first_line is not None and (named := dialect.first_line.match(head)):
            return Recognition(dialect, _found(named, 1))
    seen: dict[bytes, int] = {}
    for number, line in enumerate(head.splitlines(), 1):
        if not line.lstrip()[:7].upper().startswith(_NO_MARKS):
            seen.setdefault(line[:_COMPARED], number)
    best, why, most = default, phrase("recognized_by_nothing"), 0
    for dialect in sorted(dialects, key=lambda dialect: dialect.is_general):
        if dialect.is_general and most:
            break
        found = _marks(dialect, seen)
        if len(found) > most:
            best, why, most = dialect, min(found, key=itemgetter(0))[1], len(found)
    return Recognition(best, why, most > 0)


def _marks(dialect: Dialect, lines: dict[bytes, int]) -> list[tuple[int, Wording]]:
    """Return the first line with each mark of a dialect, and the mark as it stands there."""
    found = []
    for mark in dialect.marks:
        for line, number in lines.items():
            if matched := mark.match(line):
                found.append((number, _found(matched, number)))
                break
    return found


def _found(matched: re.Match[bytes], line: int) -> Wording:
    """Return a mark as it stands in a line."""
    return phrase("recognized_in_line", mark=matched[0].strip().decode("ascii", "replace"), line=line)
