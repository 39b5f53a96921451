"""Text on a terminal: colours, unless ``NO_COLOR`` forbids them."""

import os
import sys
from typing import Final, TextIO

from trunnion.cli.command_line.language import spoken_language
from trunnion.messages import said_in

_STYLES: Final = {"error": "1;31", "warning": "33", "title": "1", "good": "32"}


def painted(text: str, style: str, stream: TextIO | None = None) -> str:
    """Return a text in the colour of its style, where the stream is a terminal that has colours."""
    return f"\x1b[{_STYLES[style]}m{text}\x1b[0m" if _has_colours(stream or sys.stderr) else text


def _has_colours(stream: TextIO) -> bool:
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    if sys.platform == "win32" and not (os.environ.get("WT_SESSION") or os.environ.get("TERM")):
        return False  # an old console prints the codes as they are
    return stream.isatty()


def severity_painted(line: str) -> str:
    """Return a line of a message with its severity in colour."""
    for word in ("error", "warning"):
        said = said_in(spoken_language(), "terminal", "terminal", word, "what")
        before, mark, rest = line.partition(f": {said}: ")
        if mark:
            return f"{before}: {painted(said, word)}: {rest}"
    return line
