"""What a program adds to the tool, which its path does not show: DL of Klartext, TOFFL of Sinumerik, and the like.

In:     a run, whose positions are those of a tool without it.
Out:    what is added, and the run as the tool really goes.
Units:  mm.

The control takes the tool for so much longer: with a positive length its tip stays as far above the programmed path,
along the tool axis. Machine positions stay where they are.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run, RunEvent
from trunnion.records import dataclass

#: Words that add to the length along the tool axis.
LENGTHS: Final = frozenset({"DL", "TOFFL", "TOFFLR", "G43.2 Z"})

#: Words whose value stands in the place of the length: the rows have it already.
REPLACED: Final = frozenset({"G43.1 Z"})

#: Sizes that Klartext gives a tool, in place of those of the tool table: they add nothing.
SIZES: Final = ("TOOL DEF L", "TOOL DEF R")


@dataclass(frozen=True, slots=True)
class ToolAddition:
    """What an event adds: its rows ``first`` to ``end`` (exclusive)."""

    event: RunEvent
    name: str
    value: float
    first: int
    end: int


def added_lengths(run: Run) -> Floats:
    """Return what the program adds to the length of the tool in each row, (n,); 0 in machine positions."""
    added = np.zeros(len(run))
    for each in tool_additions(run):
        if each.name in LENGTHS:
            added[each.first : each.end] += each.value
    if added.any():
        added[np.asarray(run.machine_frame)] = 0.0
    return added


def tool_additions(run: Run) -> Iterator[ToolAddition]:
    """All that adds something to a tool, as long as it does: until the tool is changed, or the word is said again."""
    held: dict[str, tuple[RunEvent, float]] = {}

    def ended(names: list[str], row: int) -> Iterator[ToolAddition]:
        for name in names:
            event, value = held.pop(name)
            if value and row > event.before_row:
                yield ToolAddition(event, name, value, event.before_row, row)

    for event in run.events:
        if event.kind == "tool_change":
            yield from ended(list(held), event.before_row)
        elif event.kind == "delta" and isinstance(event.value, tuple) and event.value[0] not in SIZES:
            name, value = str(event.value[0]), float(event.value[1] or 0.0)
            yield from ended([name] if name in held else [], event.before_row)
            held[name] = event, value
    yield from ended(list(held), len(run))


def with_added_lengths(run: Run) -> Run:
    """Return the run with the tip where the added lengths keep it; the same run where nothing is added."""
    added = added_lengths(run)
    rows = np.flatnonzero(added)
    if not len(rows):
        return run
    xyz, is_tip = run.xyz.copy(), run.state.xyz_is_tip.column().astype(np.bool_)
    xyz[rows] = run.tip[rows] + added[rows, None] * run.axis[rows]
    is_tip[rows] = True
    centre = run.arcs.centre + added[run.arcs.row][:, None] * run.axis[run.arcs.row]
    state = replace(run.state, xyz_is_tip=_steps(is_tip))
    return replace(run, xyz=xyz, state=state, arcs=replace(run.arcs, centre=centre))


def _steps(column: Flags) -> StepColumn:
    changes: Ints = np.flatnonzero(np.diff(column, prepend=~column[:1]))
    return StepColumn(len(column), changes, column[changes])
