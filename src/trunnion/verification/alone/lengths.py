"""Tool lengths of a program against each other: cuts without one, and with that of another tool."""

from collections.abc import Iterator, Mapping

import numpy as np

from trunnion.arrays import Ints
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.verification.context import Context
from trunnion.verification.results import Place


def wrong_lengths(context: Context, cuts: Ints) -> Iterator[Place]:
    """Yield the first cut without a tool length where others have one, and the first with that of another tool."""
    run = context.run
    bare = _without_length(run, cuts)
    if 0 < len(bare) < len(cuts):
        with_one = int(np.setdiff1d(cuts, bare)[0])
        yield context.place(int(bare[0]), 0.0, Wording("modal", "length_missing", block=context.block_name(with_one)))
    for row, number in _foreign(run, cuts).items():
        tool = run.tools[run.state.tool[row]]
        yield context.place(row, 0.0, Wording("modal", "foreign_length", number=number, tool=tool))


def odd_lengths(context: Context, cuts: Ints) -> Iterator[Wording]:
    """Yield that no cut has a length, and cuts with another number than the tool's where others have their own."""
    run = context.run
    if len(cuts) and len(_without_length(run, cuts)) == len(cuts):
        yield phrase("cuts_without_length", block=context.block_name(int(cuts[0])))
    firsts = _first_uses(run, cuts)
    wrong = _foreign(run, cuts)
    if any(_same(tool, str(number)) for tool, number in firsts):
        for (tool, number), row in firsts.items():
            if number > 0 and row not in wrong and not _same(tool, str(number)):
                yield phrase("odd_length", tool=tool, number=number, block=context.block_name(row))


def _without_length(run: Run, cuts: Ints) -> Ints:
    return cuts[run.state.length_axis.at(cuts) < 0]


def _first_uses(run: Run, cuts: Ints) -> dict[tuple[str, int], int]:
    """Return the first cut of each tool with each number of a length, where programs select lengths by numbers."""
    if not run.uses_length_numbers or not len(cuts):
        return {}
    pairs = np.stack((run.state.tool.at(cuts), run.state.edge.at(cuts)), axis=1)
    begins = np.flatnonzero(np.r_[True, (pairs[1:] != pairs[:-1]).any(axis=1)])
    found: dict[tuple[str, int], int] = {}
    for k in begins.tolist():
        found.setdefault((run.tools[int(pairs[k, 0])], int(pairs[k, 1])), int(cuts[k]))
    return found


def _foreign(run: Run, cuts: Ints) -> Mapping[int, int]:
    """Return the first cut of each tool with the length of another one, and its number.

    The number is the other tool's where that one cuts with it too, or where that one is selected and not changed to.
    """
    firsts = _first_uses(run, cuts)
    owned = {number for tool, number in firsts if _same(tool, str(number))}
    return {
        row: number
        for (tool, number), row in firsts.items()
        if number > 0
        and not _same(tool, str(number))
        and (number in owned or _same(_selected_at(run, row), str(number)))
    }


def _same(name: str, number: str) -> bool:
    """Whether two texts are the same number of a tool."""
    return name.isdecimal() and number.isdecimal() and int(name) == int(number)


def _selected_at(run: Run, row: int) -> str:
    """Return the tool that is selected at a row and was not changed to; empty: none."""
    selected = ""
    for event in run.events:
        if event.before_row > row:
            break
        if event.kind in ("tool", "tool_change"):
            selected = str(event.value or "") if event.kind == "tool" else ""
    return selected
