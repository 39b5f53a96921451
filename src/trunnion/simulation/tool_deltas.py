"""What a program adds to the tool, which its path does not show: DL of Klartext, TOFFL of Sinumerik, and the like.

In:     a run, whose positions are those of a tool without it.
Out:    the run as the tool really goes; errors where nobody knows how it goes.
Units:  mm.

The control takes the tool for so much longer: with a positive length its tip stays as far above the programmed path,
along the tool axis. Machine positions stay where they are.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run, RunEvent

#: Words that add to the length along the tool axis; to the radius, which counts only where the control compensates it.
_LENGTHS: Final = frozenset({"DL", "TOFFL", "TOFFLR"})
_RADII: Final = frozenset({"DR", "DR2", "TOFFR", "TOFFLR"})

#: Sizes that Klartext gives a tool, in place of those of the tool table: they add nothing.
SIZES: Final = ("TOOL DEF L", "TOOL DEF R")


@dataclass(frozen=True, slots=True)
class _Delta:
    """What an event adds: its rows ``first`` to ``end`` (exclusive)."""

    event: RunEvent
    name: str
    value: float
    first: int
    end: int


def as_the_tool_goes(run: Run) -> tuple[Run, list[Problem]]:
    """Return the run with the lengths that its program adds, and what cannot be simulated."""
    deltas = list(_deltas(run))
    if not deltas:
        return run, []
    added = np.zeros(len(run))
    for each in deltas:
        if each.name in _LENGTHS:
            added[each.first : each.end] += each.value
    added[np.asarray(run.machine_frame)] = 0.0
    return _lengthened(run, added), list(_refused(run, deltas))


def is_told_of_length(run: Run, line: int, wording: Wording) -> bool:
    """Whether a reader's warning tells of a length that is simulated here, or of sizes that are compared."""
    told = {
        str(event.value[0]) for event in run.events
        if event.kind == "delta" and event.line == line and isinstance(event.value, tuple)
    }  # fmt: skip
    if wording.variant == "tool_delta":
        return wording.parameter("word") in told.intersection(_LENGTHS)
    return wording.variant == "tool_def_size" and not told.isdisjoint(SIZES)


def _deltas(run: Run) -> Iterator[_Delta]:
    """All that adds something to a tool, as long as it does: until the tool is changed, or the word is said again."""
    held: dict[str, tuple[RunEvent, float]] = {}

    def ended(names: list[str], row: int) -> Iterator[_Delta]:
        for name in names:
            event, value = held.pop(name)
            if value and row > event.before_row:
                yield _Delta(event, name, value, event.before_row, row)

    for event in run.events:
        if event.kind == "tool_change":
            yield from ended(list(held), event.before_row)
        elif event.kind == "delta" and isinstance(event.value, tuple) and event.value[0] not in SIZES:
            name, value = str(event.value[0]), float(event.value[1] or 0.0)
            yield from ended([name] if name in held else [], event.before_row)
            held[name] = event, value
    yield from ended(list(held), len(run))


def _refused(run: Run, deltas: list[_Delta]) -> Iterator[Problem]:
    for each in deltas:
        file = run.files[each.event.file]
        if each.name not in _LENGTHS | _RADII:
            yield Problem(file, each.event.line, Wording("SIM162", "moves_tool_mm", name=each.name, name_2=each.value))
        elif each.name in _RADII and _radius_counts(run, each):
            yield Problem(file, each.event.line, Wording("SIM162", "adds_mm_radius", name=each.name, name_2=each.value))


def _radius_counts(run: Run, each: _Delta) -> bool:
    compensated = run.state.compensation.part(each.first, each.end).any()
    with_normals = ((run.normals.row >= each.first) & (run.normals.row < each.end)).any()
    return bool(compensated or with_normals)


def _lengthened(run: Run, added: Floats) -> Run:
    """Return the run with the tip so much farther along the tool axis in each row, (n,)."""
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
