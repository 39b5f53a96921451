"""Lines and tables as wide as the terminal; where lines go to a file or a pipe, they stay as they are.

Chinese characters take two columns, and a line may be broken between them.
"""

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Final, TextIO

#: The narrowest terminal that lines are made for, the blanks between columns, and those of what goes on.
_LEAST: Final = 40
_GAP: Final = 2
_FURTHER: Final = 4

#: Where a column begins: after two blanks or more.
_COLUMN: Final = re.compile(r"(?<=\S) {2,}(?=\S)")

#: What stands at the beginning of no line.
_CLOSING: Final = "，。；：、！？）》”’…"

#: What stands at the end of no line.
_OPENING: Final = "（《“‘"


class CodeLine(str):
    """A line of a program or a definition, which is copied as it is: it is never broken."""

    __slots__ = ()


def width_of(stream: TextIO) -> int | None:
    """Return how many characters a line of a terminal has; None: the stream is none."""
    if not stream.isatty():
        return None
    stated = os.environ.get("COLUMNS", "")
    if stated.isdecimal() and int(stated):
        return max(int(stated), _LEAST)
    try:
        return max(os.get_terminal_size(stream.fileno()).columns, _LEAST)
    except (OSError, ValueError):  # one that does not know
        return None


def columns_of(text: str) -> int:
    """Return how many columns of a terminal a text takes."""
    return len(text) if text.isascii() else sum(map(_columns, text))


def _columns(letter: str) -> int:
    import unicodedata  # most lines are ASCII

    return 2 if unicodedata.east_asian_width(letter) in "WF" else 1


def padded(text: str, width: int, *, right: bool = False) -> str:
    """Return a text with blanks up to a number of columns, before it where it ends at the right."""
    blanks = " " * (width - columns_of(text))
    return blanks + text if right else text + blanks


def wrapped(text: str, width: int) -> list[str]:
    """Return a paragraph in lines of a width."""
    if text.isascii():
        import textwrap

        return textwrap.wrap(text, width, break_on_hyphens=False)
    return [piece.strip() for piece in folded(text, width)]


def folded(line: str, width: int | None) -> Iterator[str]:
    """Yield a line in pieces of a width, broken at blanks and wide characters; they go on under the last column with
    room.

    >>> list(folded("limits  ok    X 12 mm left, Y 40 mm left", 24))
    ['limits  ok    X 12 mm', '        left, Y 40 mm', '        left']
    """
    if width is None or columns_of(line) <= width or isinstance(line, CodeLine):
        yield line
        return
    indent = len(line) - len(line.lstrip(" "))
    starts = (found.end() for found in _COLUMN.finditer(line))
    hang = max((start for start in starts if start <= width // 2), default=min(indent + _GAP, width // 2))
    start = hang
    while columns_of(line) > width:
        end = _end_of_piece(line, start, width)
        if end < 0:
            break
        yield line[:end].rstrip()
        line = " " * hang + line[end:].lstrip()
    yield line


def _end_of_piece(line: str, start: int, width: int) -> int:
    """Return where a line that is too wide is broken, behind ``start``; -1 if it cannot be."""
    if line.isascii():
        end = line.rfind(" ", start, width + 1)
        return end if end > start else line.find(" ", width)
    room, end = 0, -1
    for at, letter in enumerate(line):
        if at > start and (letter == " " or _may_begin(line, at)) and (room <= width or end < 0):
            end = at
        room += _columns(letter)
        if room > width + 1 and end >= 0:
            break
    return end


def _may_begin(line: str, at: int) -> bool:
    """Whether a line may be broken before a character that is no blank."""
    if line[at] in _CLOSING or line[at - 1] in _OPENING:
        return False
    return _columns(line[at]) == 2 or _columns(line[at - 1]) == 2


def table(rows: Iterable[Sequence[str]], width: int | None, right: frozenset[int] = frozenset()) -> Iterator[str]:
    """Yield rows of cells in columns; those that have no room stand in further lines.

    rows   the same number of cells each
    width  of the terminal; None: no limit
    right  which columns end at the same place, as numbers do
    """
    cells = [tuple(row) for row in rows]
    wide = [max(map(columns_of, column)) for column in zip(*cells, strict=True)]
    bands = _bands(wide, width)
    for row in cells:
        for place, band in enumerate(bands):
            texts = [padded(row[k], wide[k], right=k in right) for k in band]
            line = " " * (_FURTHER if place else 0) + (" " * _GAP).join(texts)
            if line.strip():
                yield line.rstrip()


def _bands(wide: Sequence[int], width: int | None) -> list[list[int]]:
    """Return which columns stand in one line: a last one that begins in the left half goes on in further lines."""
    bands: list[list[int]] = [[]]
    end = 0
    for column, own in enumerate(wide):
        is_last = column == len(wide) - 1
        has_room = width is None or end + own <= width or (is_last and end <= width // 2)
        if bands[-1] and not has_room:
            bands.append([])
            end = _FURTHER
        bands[-1].append(column)
        end += own + _GAP
    return bands
