"""Parts of sentences that messages of all layers share, and names of any origin in them."""

import re
from collections.abc import Iterable
from typing import Final

#: Characters that a terminal obeys, that turn the order of a line round, or that no file can hold.
_UNPRINTABLE: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ufffe\uffff\ud800-\udfff]"
)
_LINES: Final = re.compile(r"[\t\n]")


def printable(text: str) -> str:
    """Return a text with U+FFFD for each character that is no part of it: it may come from any file or archive.

    >>> printable("hub\\x1b[31m 轮毂")
    'hub\ufffd[31m 轮毂'
    """
    return text if text.isprintable() else _UNPRINTABLE.sub("\ufffd", text)


def one_line(text: str) -> str:
    """Return a text as a part of a line: printable, and with blanks for tabs and line ends."""
    return text if text.isprintable() else _LINES.sub(" ", printable(text))


def nearest_word(word: str, known: Iterable[str]) -> str:
    """Return the known word that resembles an unknown one; empty if none does."""
    from difflib import get_close_matches  # a command line without mistakes does without it

    return next(iter(get_close_matches(word, list(known), n=1, cutoff=0.6)), "")


def position(place: Iterable[float]) -> str:
    """Return a position (3,) in mm, such as ``X1.000 Y-2.500 Z0.000``."""
    return " ".join(f"{name}{value:.3f}" for name, value in zip("XYZ", place, strict=True))


def counted(count: int, thing: str) -> str:
    """Return a number of things in words; ``thing`` is the singular of a noun with a regular plural.

    >>> counted(1, "check"), counted(3, "check")
    ('1 check', '3 checks')
    """
    return f"{count} {thing}" + ("" if count == 1 else "s")


def format_duration(seconds: float, colons: bool = True) -> str:
    """Return a time as people read it.

    >>> format_duration(4.26), format_duration(75), format_duration(7384)
    ('4.3 s', '1:15 min', '2:03:04 h')
    >>> format_duration(75, colons=False), format_duration(7384, colons=False)
    ('1 min 15 s', '2 h 3 min')

    colons   write them between the numbers; some controls have none in their comments
    """
    if round(seconds, 1) < 60.0:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if not colons:
        return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes}:{rest:02d} min" if minutes < 60 else f"{minutes // 60}:{minutes % 60:02d}:{rest:02d} h"
