"""What a program contains besides motion, in the order in which it acts: events, comments, and signs in its text."""

import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.run import Run, RunEvent

_SIDE_OF_WORD = {"G40": 0, "G41": 1, "G42": -1}
_SIDES = {0: "OFF", 1: "LEFT", -1: "RIGHT"}
_PLANES = {"G17": "XYPLAN", "G18": "ZXPLAN", "G19": "YZPLAN"}
_CIRCLE = re.compile(r"G0?[23](?!\d)")

#: Where events found in the text come among those of the run in the same block.
_BEFORE_OTHERS, _AFTER_OTHERS = -1, 1 << 60

#: The register of radius compensation, on controls that name one.
_REGISTER = re.compile(r"(?<![A-Z])D0*(\d{1,4})(?![\d.])")

#: Words that become events here, and what a reader says of them.
COMPENSATION_WORDS = ("G41", "G42", "RL", "RR")
COMPENSATION_FINDINGS = ("radius_compensation", "not_simulated")


class ProgramEvent(NamedTuple):
    """Something that acts before row ``row`` of the run.

    order  position among the events of its block
    kind   that of a ``RunEvent``, or "comment", "skip" (value bool) or "comp" (value side and plane)
    file   as in ``Run.file``
    """

    row: int
    line: int
    order: int
    kind: str
    value: object
    file: int

    @property
    def text(self) -> str:
        """The text of a comment; empty for other kinds."""
        return str(self.value).strip() if self.kind == "comment" else ""


def collect_events(run: Run, text: ProgramText, warn: Warnings) -> list[ProgramEvent]:
    """All events of a program, in order; ``text`` is that of its main file."""
    found = [ProgramEvent(_row_before(run, e), e.line, k, e.kind, e.value, e.file) for k, e in enumerate(run.events)]
    found += [
        ProgramEvent(c.before_row, c.line, len(found) + k, "comment", c.text, c.file)
        for k, c in enumerate(run.comments)
    ]
    skips, own_lines = list(text.skip_changes()), dict[tuple[int, int], int]()
    # A line has one place in the run only if lines are executed once and in their order.
    if len(run.files) == 1 and bool((np.diff(run.line) >= 0).all()):
        rows = np.searchsorted(run.line, [line for line, _ in skips]).tolist()
        found += [
            ProgramEvent(row, line, _BEFORE_OTHERS, "skip", on, 0) for row, (line, on) in zip(rows, skips, strict=True)
        ]
        own_lines = _compensation_lines(run, text)
    elif skips:
        warn.refuse(skips[0][0], Wording("CNV170", "block_skip_signs"))
    found += _compensations(run, text, own_lines)
    return _without_tool_calls(sorted(found, key=lambda event: (event.row, event.line, event.order)))


def _row_before(run: Run, event: RunEvent) -> int:
    """Return the row before which an event is written. M5 and M9 act after the motion of their own block."""
    row = event.before_row
    late = event.kind in ("spindle", "coolant") and event.value == "off" and row > 0
    return row - 1 if late and (run.line[row - 1], run.file[row - 1]) == (event.line, event.file) else row


def _compensation_lines(run: Run, text: ProgramText) -> dict[tuple[int, int], int]:
    """Return the lines of G40, G41 and G42, also in blocks without motion, by the row that follows and the side."""
    found: dict[tuple[int, int], int] = {}
    for line, words in text.sparse_words():
        for side in (_SIDE_OF_WORD[word] for word in words if word in _SIDE_OF_WORD):
            found.setdefault((int(np.searchsorted(run.line, line)), side), line)
    return found


def _compensations(run: Run, text: ProgramText, own_lines: Mapping[tuple[int, int], int]) -> Iterator[ProgramEvent]:
    """Yield changes of cutter radius compensation: side, plane and register; the reader does not simulate its
    effect.
    """
    side, column = 0, run.state.compensation
    for row, value in zip(column.rows.tolist(), column.values.tolist(), strict=True):
        if value == side or row > len(run):
            continue
        side = value
        at = min(row, len(run) - 1)
        line, file = own_lines.get((row, side), int(run.line[at])), int(run.file[at])
        block = text.line_text(line).upper() if file == 0 else ""
        # In the block of a circle the plane is that of the circle.
        words = () if _CIRCLE.search(block) else re.findall(r"G1[789](?!\d)", block)
        planes = [_PLANES[word] for word in words]
        register = _REGISTER.search(block) if side and run.uses_length_numbers else None
        number = int(register[1]) if register else 0
        yield ProgramEvent(row, line, _AFTER_OTHERS, "comp", (_SIDES[side], planes[0] if planes else "", number), file)


def _without_tool_calls(events: list[ProgramEvent]) -> list[ProgramEvent]:
    """Return the events without ``T`` words that only name the tool of the tool change that follows at the
    same place.
    """
    tools = [event for event in events if event.kind in ("tool", "tool_change")]
    calls = {
        one.order
        for one, two in pairwise(tools)
        if one.kind == "tool" and two.kind == "tool_change" and one.row == two.row
    }
    return [event for event in events if event.order not in calls or event.kind != "tool"]
