"""Lines that most families write alike: program stops, and texts in pieces."""

from collections.abc import Callable, Sequence

from trunnion.controls.family_writer import Codes
from trunnion.model.toolpath import Stop


def program_stop(event: Stop, codes: Codes, text_lines: Callable[[str], list[str]]) -> list[str]:
    """Return M0 or M1, after the text for the operator, as ``text_lines`` writes it."""
    code = codes["optional_stop" if event.optional else "stop"]
    return [*(text_lines(event.text) if event.text else ()), f"M{code}"]


def divided_comment(line: str, most: int, openings: Sequence[str], escape: Callable[[str], str] = str) -> list[str]:
    """Return a comment line in lines of at most ``most`` bytes; the line itself if it is none, or short enough.

    openings   texts with which lines begin that are comments to their end; the first one begins the further lines
    escape     changes what cannot stand at the beginning of a comment
    """
    opening = next((each for each in openings if line.startswith(each)), None)
    if opening is None or len(line.encode()) <= most:
        return [line]
    room = most - max(len(each.encode()) for each in openings)
    first, *more = split_text(line[len(opening) :], room, escape)
    return [opening + first, *(openings[0] + piece for piece in more)]


def split_text(text: str, most: int, escape: Callable[[str], str] = str) -> list[str]:
    """Return a text in pieces of at most ``most`` bytes, each as ``escape`` makes it; at least one piece."""
    pieces = [""]
    for character in text:
        if len(escape(pieces[-1] + character).encode()) > most:
            pieces.append("")
        pieces[-1] += character
    return [escape(piece) for piece in pieces]
