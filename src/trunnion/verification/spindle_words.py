"""Words of the spindle of which nobody knows what they do, wherever they stand."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.model.run import Run, RunEvent
from trunnion.model.toolpath import Kind

TURNING: Final = ("clockwise", "counter-clockwise")


def both_senses(run: Run) -> Iterator[tuple[RunEvent, RunEvent]]:
    """Yield the words that start the spindle in both senses in one block: controls differ in which of them counts."""
    for before, event in pairwise(_spindle_words(run)):
        turns = {before.value, event.value}
        if turns == set(TURNING) and _block(before) == _block(event):
            yield before, event


def started_behind_cuts(run: Run) -> RunEvent | None:
    """Return the word that starts the spindle behind the last cut, and which none stops any more: M3 in place of M5."""
    events, cuts = _spindle_words(run), np.flatnonzero((run.kind != Kind.RAPID) & ~run.machine_frame)
    if not (events and len(cuts)) or events[-1].value not in TURNING or events[-1].before_row <= int(cuts[-1]):
        return None
    return events[-1]


def _spindle_words(run: Run) -> list[RunEvent]:
    return [event for event in run.events if event.kind == "spindle"]


def _block(event: RunEvent) -> tuple[int, int, int]:
    return event.file, event.line, event.before_row
