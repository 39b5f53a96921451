"""What a text of a shop leaves in force, read back from its words."""

import re
from collections.abc import Iterable, Sequence
from typing import Final

from trunnion.controls.definition import Control
from trunnion.controls.inches import without_comments
from trunnion.controls.words import Word

_WORD: Final = re.compile(r"([FS])=?[0-9]+\.?[0-9]*|M0*([0-9]+)", re.ASCII)
_QUOTED: Final = re.compile(r'MSG\("[^"]*"\)')


def said_words(lines: Iterable[str], control: Control, words: Sequence[Word]) -> set[str] | None:
    """Return the words of motion blocks that a text changes; None if nobody knows.

    Comments, messages, F, S and the M words of spindle and coolant are understood, and nothing else: a block with
    another word may have changed what it does not name.
    """
    switches = _switches(control)
    found: set[str] = set()
    for line in lines:
        for part in without_comments(control, _QUOTED.sub("", line)).split():
            match = _WORD.fullmatch(part)
            if match is None or (match[2] and int(match[2]) not in switches):
                return None
            if match[2]:
                found.add(switches[int(match[2])])
            else:
                said = {word.key for word in words if word.letter == match[1]}
                if not said:
                    return None
                found |= said
    return found


def _switches(control: Control) -> dict[int, str]:
    """M codes of spindle and coolant, and the words that they are."""
    codes = dict.fromkeys(control.coolant.values(), "coolant")
    names = ("spindle_clockwise", "spindle_counterclockwise", "spindle_off")
    return codes | {control.codes[name]: "spindle" for name in names if name in control.codes}
