"""What a program says besides motion, in the order of time: comments, happenings, and signs in its text."""

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from trunnion.conversion.program_text import Source
from trunnion.conversion.unsupported import Remarks
from trunnion.model.run import Happening, Run

_SIDES = {"G40": "OFF", "G41": "LEFT", "G42": "RIGHT"}
_PLANES = {"G17": "XYPLAN", "G18": "ZXPLAN", "G19": "YZPLAN"}
_CIRCLE = re.compile(r"G0?[23](?!\d)")

#: Order of what only the text shows among the happenings of a block.
_FIRST, _LAST = -1, 1 << 60

#: Findings of the reader that become events here.
COMPENSATION = ("G41:", "G42:")


class Item(NamedTuple):
    """Something that is said before row ``row`` of the run.

    kind   of a ``Happening``, or "comment", "skip" (value bool) or "comp" (value side and plane)
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
        """The text of a comment; nothing for other items."""
        return str(self.value).strip() if self.kind == "comment" else ""


def items(run: Run, source: Source, remark: Remarks) -> list[Item]:
    """All that is said, in order; ``source`` is the program's own file."""
    found = [Item(_said_at(run, e), e.line, k, e.kind, e.value, e.file) for k, e in enumerate(run.events)]
    found += [Item(c.before_row, c.line, len(found) + k, "comment", c.text, c.file) for k, c in enumerate(run.comments)]
    skips = list(source.skips())
    compensated = any(finding.text.startswith(COMPENSATION) for finding in run.findings)
    # Only where lines are executed once and in their order has a line one place in the run.
    if len(run.files) == 1 and bool((np.diff(run.block) >= 0).all()):
        row_of = np.searchsorted(run.block, [line for line, _ in skips]).tolist()
        found += [Item(row, line, _FIRST, "skip", on, 0) for row, (line, on) in zip(row_of, skips, strict=True)]
        found += _compensations(run, source) if compensated else ()
    elif skips or compensated:
        what = " and ".join(["block skip signs"] * bool(skips) + ["cutter radius compensation"] * compensated)
        remark(0, f"{what} in a program with jumps or subprograms: not carried over")
    return _without_calls(sorted(found, key=lambda item: (item.row, item.line, item.order)))


def _said_at(run: Run, event: Happening) -> int:
    """The row before which an event is said: M5 and M9 act after the motion of the block that they stand in."""
    row = event.before_row
    late = event.kind in ("spindle", "coolant") and event.value == "off" and row > 0
    return row - 1 if late and (run.block[row - 1], run.file[row - 1]) == (event.line, event.file) else row


def _compensations(run: Run, source: Source) -> Iterator[Item]:
    """Cutter radius compensation, which the reader only remarks upon."""
    side = "OFF"
    for line, words in source.words():
        now = next((_SIDES[word] for word in words if word in _SIDES), side)
        if now == side:
            continue
        side = now
        # the plane of a circle is said by the circle
        planes = [] if _CIRCLE.search(source.text(line)) else [_PLANES[word] for word in words if word in _PLANES]
        yield Item(int(np.searchsorted(run.block, line)), line, _LAST, "comp", (side, planes[0] if planes else ""), 0)


def _without_calls(said: list[Item]) -> list[Item]:
    """The items without those ``T`` words that only name the tool of the change that follows at the same place."""
    tools = [item for item in said if item.kind in ("tool", "tool_change")]
    calls = {
        one.order
        for one, two in pairwise(tools)
        if one.kind == "tool" and two.kind == "tool_change" and one.row == two.row
    }
    return [item for item in said if item.order not in calls or item.kind != "tool"]
