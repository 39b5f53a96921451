"""Comments in the head of a program or of a CL file that say how its part is clamped and where its zero is.

What is written here is read again here, whole lines of it: a notice of which a word has been changed is not believed.

Units: degrees, mm.
"""

import re
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from trunnion.messages import Wording, phrase
from trunnion.model.clamping import Clamping, number
from trunnion.records import dataclass

#: How the comments begin.
TURNED_NOTICE: Final = "PART TURNED"
TILTED_NOTICE: Final = "PART TILTED"
DRAWN_NOTICE: Final = "PART CLAMPED AS DRAWN"
ZERO_NOTICE: Final = "WORKPIECE ZERO X"
LENGTH_NOTICE: Final = "ZERO FOR TOOL LENGTH"
PLACED_NOTICES: Final = (TURNED_NOTICE, TILTED_NOTICE, DRAWN_NOTICE, ZERO_NOTICE, LENGTH_NOTICE)

#: What damaged ones still begin with.
_BEGINNINGS: Final = (TURNED_NOTICE, TILTED_NOTICE, "PART CLAMPED", "WORKPIECE ZERO", "ZERO FOR TOOL")

#: A line that is nothing but a comment, behind its block number; its text is the group.
_COMMENT: Final = re.compile(r"\s*/?\s*(?:N?\d+\s*)?[;(]\s*(.*?)[\s)]*", re.IGNORECASE)

#: Lines with which a program begins and that move nothing: names, numbers and marks of the file.
_MARK: Final = re.compile(r"\s*(?:%.*|[O:]\d+.*|(?:\d+\s+)?BEGIN PGM .*|<.*>|)\s*", re.IGNORECASE)

#: Lines before which a control may allow nothing, not even a comment.
_FIRST_LINES: Final = 3

_NUMBER: Final = r"(-?[0-9]{1,6}(?:\.[0-9]{1,6})?)"
_TILTED: Final = re.compile(rf"{TILTED_NOTICE} {_NUMBER} DEG FIRST, ABOUT ITS X, RIGHT-HANDED, ITS \+Y SIDE (UP|DOWN)")
_TURNED: Final = re.compile(rf"{TURNED_NOTICE} {_NUMBER} DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM \+Z")
_DRAWN: Final = re.compile(f"{DRAWN_NOTICE}, NOT TURNED")
_ZERO: Final = re.compile(rf"{ZERO_NOTICE}{_NUMBER} Y{_NUMBER} Z{_NUMBER} MM ON THE MACHINE, AXES AT 0")
_WITHOUT_TCP: Final = re.compile(
    rf"WITHOUT TCP, FOR A WORKPIECE ZERO AT X{_NUMBER} Y{_NUMBER} Z{_NUMBER} OF THE MACHINE,? "
    rf"AND A TOOL LENGTH OF {_NUMBER}"
)
# Not every control has a colon.
_LENGTH: Final = re.compile(
    rf"{LENGTH_NOTICE} (?:{_NUMBER} MM, FROM GAUGE POINT TO TIP|0 MM[:-] (?:NONE|NO LENGTH) WAS STATED)"
)


@dataclass(frozen=True, slots=True)
class HeadNotices:
    """What the head of a program, or of a CL file, states of its part.

    clamping     None: nothing, or what cannot be believed
    zero         on the machine, with all axes at zero, (3,) mm; None: it is not stated
    tool_length  for which the zero holds, mm; None: it is not stated
    faults       what is damaged or contradicts itself, each with its line: phrases
    """

    clamping: Clamping | None = None
    zero: tuple[float, float, float] | None = None
    tool_length: float | None = None
    faults: tuple[tuple[int, Wording], ...] = ()


def clamped_notices(clamping: Clamping) -> Iterator[str]:
    """Comments on how a part is clamped, for the head of a program or of a CL file."""
    turn, tilt = clamping.turn % 360.0, clamping.tilt
    if tilt:
        side = "UP" if tilt > 0.0 else "DOWN"
        yield f"{TILTED_NOTICE} {number(tilt)} DEG FIRST, ABOUT ITS X, RIGHT-HANDED, ITS +Y SIDE {side}"
    if turn or tilt:
        yield f"{TURNED_NOTICE} {number(turn)} DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z"
    else:
        yield f"{DRAWN_NOTICE}, NOT TURNED"


def zero_notices(zero: tuple[float, float, float], tool_length: float | None) -> Iterator[str]:
    """Comments on the workpiece zero (3,), mm, and on the tool length for which it holds; None: none was stated."""
    x, y, z = zero
    yield f"{ZERO_NOTICE}{x:.3f} Y{y:.3f} Z{z:.3f} MM ON THE MACHINE, AXES AT 0"
    if tool_length is None:
        yield f"{LENGTH_NOTICE} 0 MM: NO LENGTH WAS STATED"
    else:
        yield f"{LENGTH_NOTICE} {number(tool_length)} MM, FROM GAUGE POINT TO TIP"


def read_places_without_tcp(lines: Iterable[str]) -> set[tuple[float, ...]]:
    """Return the zeros and lengths for which the operations of a program without TCP were written, (4,) each, mm."""
    found, texts = set[tuple[float, ...]](), deque[str](maxlen=3)
    for line in lines:
        comment = _COMMENT.fullmatch(line)
        texts.append(" ".join(comment[1].upper().split()) if comment else "")
        if stated := _WITHOUT_TCP.search(" ".join(texts)):
            found.add(tuple(map(float, stated.groups())))
    return found


def may_be_notice(comment: str) -> bool:
    """Whether a comment begins as one of the notices does."""
    return " ".join(comment.split()).upper().startswith(_BEGINNINGS)


def head_comments(lines: Iterable[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Yield the comments in the head of a program, whose numbered ``lines`` begin with its first one.

    The head ends before the first block that does something; texts of operations stand behind that.
    """
    for line, text in lines:
        if found := _COMMENT.fullmatch(text):
            yield line, found[1]
        elif line > _FIRST_LINES and not _MARK.fullmatch(text):
            return


def read_place(comments: Sequence[tuple[int, str]]) -> HeadNotices:
    """Return what the comments of a head state, each with its line and without the signs of a comment.

    A comment that a control had to break goes on in the next one.
    """
    texts = [(line, " ".join(text.split()).upper()) for line, text in comments]
    reader = _Reader()
    for k, (line, text) in enumerate(texts):
        behind = texts[k + 1][1] if k + 1 < len(texts) else ""
        if text.startswith(_BEGINNINGS):
            reader.read(line, text, behind)
    return reader.result()


class _Reader:
    """Collects what notices state, and what of it cannot be believed."""

    def __init__(self) -> None:
        self._faults: list[tuple[int, Wording]] = []
        self._values: dict[str, tuple[float, ...] | None] = {}
        self._lines: dict[str, int] = {}

    def read(self, line: int, text: str, behind: str) -> None:
        for pattern in (_TILTED, _TURNED, _DRAWN, _ZERO, _LENGTH):
            for whole in (text, f"{text} {behind}", text + behind):
                if found := pattern.fullmatch(whole):
                    self._take(line, pattern, found)
                    return
        self._damaged(line, text, phrase("notice_not_as_written", notice=text[:100]))

    def _take(self, line: int, pattern: re.Pattern[str], found: re.Match[str]) -> None:
        name = {_TILTED: "tilt", _TURNED: "turn", _DRAWN: "drawn", _ZERO: "zero", _LENGTH: "length"}[pattern]
        values = tuple(float(text) for text in found.groups() if text and text not in ("UP", "DOWN"))
        if name in ("tilt", "turn") and abs(values[0]) > 360.0:
            self._damaged(line, found[0], phrase("notice_with_large_angle", notice=found[0][:100]))
        elif name == "tilt" and (found[2] == "UP") is not (values[0] > 0.0):
            self._damaged(line, found[0], phrase("notice_of_other_side", notice=found[0][:100]))
        elif name in self._values and self._values[name] not in (None, values):
            fault = phrase("notice_contradicts", notice=found[0][:100], line=self._lines[name])
            self._damaged(line, found[0], fault)
        else:
            self._values.setdefault(name, values)
            self._lines.setdefault(name, line)

    def _damaged(self, line: int, text: str, fault: Wording) -> None:
        self._faults.append((line, fault))
        name = "zero" if text.startswith("WORKPIECE") else "length" if text.startswith("ZERO") else "turn"
        self._values[name] = None
        self._lines.setdefault(name, line)

    def result(self) -> HeadNotices:
        values, turn = self._values, self._values.get("turn")
        if "drawn" in values and ("turn" in values or "tilt" in values):
            line = self._lines["drawn"]
            self._faults.append((line, phrase("notices_contradict")))
        elif "tilt" in values and "turn" not in values:
            self._faults.append((self._lines["tilt"], phrase("notice_of_tilt_alone")))
        elif "drawn" in values or turn is not None:
            tilt = values.get("tilt") or (0.0,)
            return self._stated(Clamping(0.0 if turn is None else turn[0], tilt[0]))
        return self._stated(None)

    def _stated(self, clamping: Clamping | None) -> HeadNotices:
        zero, length = self._values.get("zero"), self._values.get("length")
        return HeadNotices(
            clamping,
            (zero[0], zero[1], zero[2]) if zero else None,
            length[0] if length else None,
            tuple(sorted(self._faults, key=lambda fault: (fault[0], fault[1].what))),
        )
