"""Lines that most families write alike: program stops, and texts in pieces."""

from collections.abc import Callable

from trunnion.controls.family_writer import Codes
from trunnion.model.toolpath import Stop


def program_stop(event: Stop, codes: Codes, text_lines: Callable[[str], list[str]]) -> list[str]:
    """Return M0 or M1, after the text for the operator, as ``text_lines`` writes it."""
    code = codes["optional_stop" if event.optional else "stop"]
    return [*(text_lines(event.text) if event.text else ()), f"M{code}"]


def split_text(text: str, most: int) -> list[str]:
    """Return a text in pieces of at most ``most`` bytes; at least one piece."""
    pieces = [""]
    for character in text:
        if len((pieces[-1] + character).encode()) > most:
            pieces.append("")
        pieces[-1] += character
    return pieces
