"""How the texts of two programs differ, line by line, in bounded time whatever their size.

In:     two files.
Out:    what to say of the difference, and the first lines of it.
"""

import difflib
import re
from collections.abc import Iterator
from itertools import islice, zip_longest
from pathlib import Path
from typing import BinaryIO, Final

from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: Lines behind the first difference that are compared by what they say, and not by their numbers alone.
_MOST_ALIGNED: Final = 1000

#: Lines of a difference that are shown, and unchanged ones around them.
_MOST_SHOWN: Final = 40
_CONTEXT: Final = 2

#: Letters of a line that are shown.
_MOST_LETTERS: Final = 200

#: The number of a first line in the head of a piece of a unified diff.
_PLACE: Final = re.compile(r"([-+])([0-9]+)")

#: The number of a block: N100 of most controls, 100 of Klartext.
_BLOCK_NUMBER: Final = re.compile(rb"^[N:]?[0-9]+ ")

#: Longer lines are taken for several.
_LONGEST_LINE: Final = 10_000


@dataclass(frozen=True, slots=True)
class TextDifference:
    """How a new text differs from the old one.

    summary  in words
    lines    the first ones that differ, as a unified diff has them; ``is_cut``: there are more
    """

    summary: Wording
    lines: tuple[str, ...] = ()
    is_cut: bool = False


def text_difference(old: Path, new: Path) -> TextDifference | None:
    """Compare two texts; None where they are the same, byte for byte.

    Raises ``OSError`` if a file cannot be read.
    """
    with old.open("rb") as before, new.open("rb") as after:
        first, context = _first_difference(before, after)
        if first is None:
            return None
        was, now = list(islice(_lines(before), _MOST_ALIGNED + 1)), list(islice(_lines(after), _MOST_ALIGNED + 1))
    if max(len(was), len(now)) <= _MOST_ALIGNED:
        return _of_all(context, was, now, first)
    return _by_numbers(old, new, first, context, was, now)


def _lines(stream: BinaryIO) -> Iterator[bytes]:
    return iter(lambda: stream.readline(_LONGEST_LINE), b"")


def _first_difference(before: BinaryIO, after: BinaryIO) -> tuple[int | None, list[bytes]]:
    """Return the line of the first difference, from 1, and the lines before it; both streams stand at that
    line then.
    """
    context: list[bytes] = []
    number = 1
    while True:
        places = before.tell(), after.tell()
        was, now = before.readline(_LONGEST_LINE), after.readline(_LONGEST_LINE)
        if was != now:
            before.seek(places[0])
            after.seek(places[1])
            return number, context
        if not was:
            return None, []
        context = [*context, was][-_CONTEXT:]
        number += 1


def _of_all(context: list[bytes], was: list[bytes], now: list[bytes], first: int) -> TextDifference:
    """Return the difference of short rests of two texts."""
    if [line.rstrip(b"\r\n") for line in was] == [line.rstrip(b"\r\n") for line in now]:
        return _of_line_ends(first)
    with_numbers = _diff(context, was, now, first)
    without = _diff(_unnumbered(context), _unnumbered(was), _unnumbered(now), first)
    is_moved = _changes(without) < _changes(with_numbers)
    shown = without if is_moved else with_numbers
    if not shown:
        return TextDifference(phrase("only_block_numbers", line=first))
    added = sum(line.startswith("+") for line in shown)
    variant = "lines_changed_and_numbers" if is_moved else "lines_changed"
    summary = phrase(variant, count=_changes(shown) - added, added=added)
    return TextDifference(summary, tuple(shown[:_MOST_SHOWN]), len(shown) > _MOST_SHOWN)


def _unnumbered(lines: list[bytes]) -> list[bytes]:
    """Lines without their block numbers: one line more gives all that follow other ones."""
    return [_BLOCK_NUMBER.sub(b"", line) for line in lines]


def _changes(diff: list[str]) -> int:
    return sum(line.startswith(("+", "-")) for line in diff)


def _of_line_ends(first: int) -> TextDifference:
    return TextDifference(phrase("only_line_ends", line=first))


def _by_numbers(
    old: Path, new: Path, first: int, context: list[bytes], was: list[bytes], now: list[bytes]
) -> TextDifference:
    """Return the difference of long texts: of lines with the same numbers, if there are as many, or else its
    beginning.
    """
    shown: list[str] = []
    changed, lines_before, lines_after, only_ends = 0, 0, 0, True
    with old.open("rb") as before, new.open("rb") as after:
        for number, (one, two) in enumerate(zip_longest(_lines(before), _lines(after)), 1):
            lines_before += one is not None
            lines_after += two is not None
            if one != two:
                changed += 1
                only_ends = only_ends and (one or b"").rstrip(b"\r\n") == (two or b"").rstrip(b"\r\n")
                if len(shown) < _MOST_SHOWN:
                    shown += [f"@@ line {number} @@", f"-{_shown(one or b'')}", f"+{_shown(two or b'')}"]
    if only_ends:
        return _of_line_ends(first)
    if lines_before == lines_after:
        return TextDifference(
            phrase("lines_other", count=changed), tuple(shown[:_MOST_SHOWN]), 3 * changed > len(shown)
        )
    summary = phrase("lines_from_on", line=first, before=lines_before, now=lines_after)
    beginning = _diff(_unnumbered(context), _unnumbered(was), _unnumbered(now), first)
    return TextDifference(summary, tuple(beginning[:_MOST_SHOWN]), is_cut=True)


def _diff(context: list[bytes], was: list[bytes], now: list[bytes], first: int) -> list[str]:
    """Return a unified diff of the lines from the first difference on; the lines before it are its ``context``."""
    before, after = ([_shown(line) for line in (*context, *lines)] for lines in (was, now))
    found = list(difflib.unified_diff(before, after, lineterm="", n=_CONTEXT))[2:]
    skipped = first - len(context) - 1

    def moved(place: re.Match[str]) -> str:
        return f"{place[1]}{int(place[2]) + skipped}"

    return [_PLACE.sub(moved, line) if line.startswith("@@") else line for line in found]


def _shown(line: bytes) -> str:
    text = line.rstrip(b"\r\n").decode("utf-8", errors="replace")
    return text if len(text) <= _MOST_LETTERS else f"{text[:_MOST_LETTERS]}…"
