"""What a program says besides motion, in the order of time: comments, happenings, and signs in its text."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from trunnion.convert.source import Source
from trunnion.reader import Happening, Run

_PLANES = {"G17": "XYPLAN", "G18": "ZXPLAN", "G19": "YZPLAN"}
_ARCS = {"G2", "G3", "G02", "G03"}

#: Order of what only the text shows among the happenings of a block.
_FIRST, _LAST = -1, 1 << 60

#: Findings of the reader that become events here.
COMPENSATION = ("G41:", "G42:")

Remark = Callable[[int, str], None]


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


def items(run: Run, source: Source, anyhow: set[str], ends: set[str], remark: Remark) -> list[Item]:
    """All of them, in order.

    Parameters
    ----------
    anyhow
        Words by which an operation's end brings back what its start relied on.
    ends
        Comments that end a path.
    remark
        Takes what cannot be told.
    """
    found = [Item(_said_at(run, e), e.line, k, e.kind, e.value, e.file) for k, e in enumerate(run.events)]
    found += [Item(c.before_row, c.line, len(found) + k, "comment", c.text, c.file) for k, c in enumerate(run.comments)]
    skips = list(source.skips())
    sides = {f.line: f.text[:3] for f in run.findings if f.text.startswith(COMPENSATION)}
    if source.in_order:
        found += [Item(source.row_of(line), line, _FIRST, "skip", on, 0) for line, on in skips]
        found += _compensations(source, sides, anyhow, ends)
    elif skips or sides:
        what = "block skip signs" if skips else "cutter radius compensation"
        remark(0, f"{what} in a program with jumps or subprograms: not carried over")
    return sorted(found, key=lambda item: (item.row, item.line, item.order))


def _said_at(run: Run, event: Happening) -> int:
    """The row before which an event is said: M5 and M9 act after the motion of the block that they stand in."""
    row = event.before_row
    late = event.kind in ("spindle", "coolant") and event.value == "off" and row > 0
    return row - 1 if late and (run.block[row - 1], run.file[row - 1]) == (event.line, event.file) else row


def _compensations(source: Source, sides: dict[int, str], anyhow: set[str], ends: set[str]) -> Iterator[Item]:
    """Cutter radius compensation, which the reader only remarks upon."""
    if not sides:
        return
    side = "OFF"
    for line in sorted({*sides, *source.numbers_with(b"G40")}):
        words = source.words(line)
        now = {"G41": "LEFT", "G42": "RIGHT"}.get(sides.get(line, ""), side)
        if "G40" in words:
            now = "OFF"
        if now == side:
            continue
        side = now
        behind = source.text(line + 1)
        last = behind.startswith(";") and behind[1:].strip() in ends
        if now == "OFF" and last and anyhow.issuperset(words):
            continue
        plane = next((_PLANES[word] for word in words if word in _PLANES), "")
        yield Item(source.row_of(line), line, _LAST, "comp", (side, "" if _ARCS & set(words) else plane), 0)


def blocks(said: Sequence[Item]) -> Iterator[list[Item]]:
    """Items of one block together."""
    block: list[Item] = []
    for item in said:
        if block and (item.row, item.line, item.file) != (block[0].row, block[0].line, block[0].file):
            yield block
            block = []
        block.append(item)
    if block:
        yield block


def sorts(said: Iterable[Item]) -> set[str]:
    """The kinds of events among items of one block that are words of it."""
    kinds = {"speed": "spindle", "spindle": "spindle", "coolant": "coolant", "comp": "comp", "m": "coolant"}
    return {kinds[item.kind] for item in said if item.kind in kinds}
