"""What a program contains besides motion, in the order in which it acts: events, comments, and signs in its text."""

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.unsupported import Warnings
from trunnion.model.run import Run, RunEvent

_SIDES = {"G40": "OFF", "G41": "LEFT", "G42": "RIGHT"}
_PLANES = {"G17": "XYPLAN", "G18": "ZXPLAN", "G19": "YZPLAN"}
_CIRCLE = re.compile(r"G0?[23](?!\d)")

#: Where events found in the text come among those of the run in the same block.
_BEFORE_OTHERS, _AFTER_OTHERS = -1, 1 << 60

#: Diagnostics of the reader that become events here.
COMPENSATION_FINDINGS = ("G41:", "G42:")


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
    skips = list(text.skip_changes())
    compensated = any(finding.text.startswith(COMPENSATION_FINDINGS) for finding in run.diagnostics)
    # A line has one place in the run only if lines are executed once and in their order.
    if len(run.files) == 1 and bool((np.diff(run.line) >= 0).all()):
        rows = np.searchsorted(run.line, [line for line, _ in skips]).tolist()
        found += [
            ProgramEvent(row, line, _BEFORE_OTHERS, "skip", on, 0) for row, (line, on) in zip(rows, skips, strict=True)
        ]
        found += _compensations(run, text) if compensated else ()
    elif skips or compensated:
        what = " and ".join(["block skip signs"] * bool(skips) + ["cutter radius compensation"] * compensated)
        warn(0, f"{what} in a program with jumps or subprograms: not carried over")
    return _without_tool_calls(sorted(found, key=lambda event: (event.row, event.line, event.order)))


def _row_before(run: Run, event: RunEvent) -> int:
    """The row before which an event is written. M5 and M9 act after the motion of their own block."""
    row = event.before_row
    late = event.kind in ("spindle", "coolant") and event.value == "off" and row > 0
    return row - 1 if late and (run.line[row - 1], run.file[row - 1]) == (event.line, event.file) else row


def _compensations(run: Run, text: ProgramText) -> Iterator[ProgramEvent]:
    """Changes of cutter radius compensation, which the reader only reports."""
    side = "OFF"
    for line, words in text.sparse_words():
        active = next((_SIDES[word] for word in words if word in _SIDES), side)
        if active == side:
            continue
        side = active
        # In the block of a circle the plane is that of the circle.
        planes = [] if _CIRCLE.search(text.line_text(line)) else [_PLANES[word] for word in words if word in _PLANES]
        row, value = int(np.searchsorted(run.line, line)), (side, planes[0] if planes else "")
        yield ProgramEvent(row, line, _AFTER_OTHERS, "comp", value, 0)


def _without_tool_calls(events: list[ProgramEvent]) -> list[ProgramEvent]:
    """The events without ``T`` words that only name the tool of the tool change that follows at the same place."""
    tools = [event for event in events if event.kind in ("tool", "tool_change")]
    calls = {
        one.order
        for one, two in pairwise(tools)
        if one.kind == "tool" and two.kind == "tool_change" and one.row == two.row
    }
    return [event for event in events if event.order not in calls or event.kind != "tool"]
