"""Values that a definition has only until somebody enters or measures the true ones: comments behind them say so."""

import re
from typing import Final

from trunnion.definitions.source_lines import KeyPath, layout

#: The comments that ask for another value.
MARKS: Final = re.compile("# (?:enter|measure):")

#: Those that only say, anywhere in them, that a value or a part of it is none of the machine's.
ASSUMED: Final = re.compile(r"(?!# (?:enter|measure):)#.*\bassum(?:ption|ed)\b")

#: Both.
ANY_MARK: Final = re.compile(f"{MARKS.pattern}|{ASSUMED.pattern}")


def marked_values(text: str, mark: re.Pattern[str] = MARKS) -> list[tuple[str, int, str]]:
    """Return the values with a mark behind them: key, such as ``axis[1].limits_deg``, line, and what the mark says."""
    found = layout(text)
    return [
        (_dotted(path), found.lines.get(path, 0), text[begin:end].removeprefix("#").strip())
        for path, (begin, end) in _marks(text, mark).items()
    ]


def without_mark(text: str, where: KeyPath | None) -> str:
    """Return a definition without the mark behind the value at ``where``, which has been entered now."""
    place = _marks(text, MARKS).get(where) if where is not None else None
    return text if place is None else text[: place[0]].rstrip(" \t") + text[place[1] :]


def _marks(text: str, mark: re.Pattern[str]) -> dict[KeyPath, tuple[int, int]]:
    """Begin and end of the mark behind each value that has one."""
    found = layout(text)
    starts = {text.rfind("\n", 0, begin) + 1: (begin, end) for begin, end in found.comments}
    marks = {}
    for path, place in found.values.items():
        begin, end = starts.get(text.rfind("\n", 0, place.end) + 1, (0, 0))
        if place.key < place.start and begin >= place.end and mark.match(text, begin, end):
            marks[path] = begin, end
    return marks


def _dotted(path: KeyPath) -> str:
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")
