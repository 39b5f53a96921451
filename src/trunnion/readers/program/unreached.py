"""Blocks behind the return of a subprogram that never run.

A return that is written too early takes the rest of a subprogram away, and the path shows it only where motion is in
it.
"""

import re
from collections.abc import Callable

from trunnion.readers.program.source_text import SourceText

#: A block that the operator can skip.
_SKIPPED = re.compile(r"[ \t]*(?:N[ \t]*[0-9]+[ \t]*)?/", re.IGNORECASE)


class UnreachedBlocks:
    """Finds blocks behind returns; each return is looked at once.

    jumps      words with which blocks run in another order than they stand in: where a text has one of them, blocks
               behind a return may run all the same
    has_words  whether a line has anything but comments and its number
    """

    def __init__(self, jumps: re.Pattern[bytes], has_words: Callable[[str], bool]) -> None:
        self._jumps, self._has_words = jumps, has_words
        self._seen: set[tuple[str, int]] = set()

    def behind(self, source: SourceText, raw: str, first: int, end: int | None) -> int:
        """Return the line of the first block behind a return that never runs; 0 if there is none.

        source      stands behind the line of the return, whose text is ``raw``
        first, end  first line of the subprogram, and the line behind its last; None: the end of the file
        """
        place = str(source.path), source.line
        if place in self._seen or _SKIPPED.match(raw):
            return 0
        self._seen.add(place)
        line, found = source.line, 0
        while (end is None or source.line < end) and source.fill():
            if self._has_words(source.next_line()):
                found = source.line - 1
                break
        if found:
            source.load()
            if source.search(self._jumps, first, end):
                found = 0
        if source.whole:
            source.jump(line)
        return found
