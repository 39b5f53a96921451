"""Whether a CL file that was written says what the toolpath does: it is read again and compared, row by row.

What dialects say in different words is the same here: a tool that is loaded again, or a depth with or without its
sign. So is a cycle or radius compensation that ends with its operation, and a retract to the rapid height.
"""

import math
from collections.abc import Iterator, Set
from dataclasses import fields
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats
from trunnion.cl.read import read_cl
from trunnion.cl.writers import WRITERS
from trunnion.cl.writers.checks import rows_with_own_feed
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import (
    CutterComp,
    CycleOff,
    CycleOn,
    Event,
    From,
    GoHome,
    Kind,
    LoadTool,
    Message,
    Operation,
    SetMode,
    Toolpath,
    UnknownStatement,
)

#: Lengths in inches have nine decimals, tool axes twelve.
_SAME_LENGTH: Final = 1e-6
_SAME_DIRECTION: Final = 1e-9
_SAME_FEED: Final = 1e-6
#: Numbers of events, which some dialects write with fewer decimals.
_SAME_NUMBER: Final = 1e-5

#: Fields of events that no CL file has words for, or that say where a statement stands.
_NOT_WRITTEN: Final = ("row", "line", "stated", "surface")


def read_back_problems(expected: Toolpath, path: Path, dialect: str) -> list[Problem]:
    """Return what reads back otherwise.

    expected  what was written, as its writer prepared it
    path      the file
    dialect   in which it is written, and as which it must be recognized
    """
    title = WRITERS[dialect].title
    try:
        found = read_cl(path)
    except InputError as error:
        return [
            Problem(
                expected.file,
                0,
                Wording(
                    "CL920",
                    "could_not_read",
                    title=title,
                    problems_line=error.problems[0].line,
                    problems_what=error.problems[0].what,
                ),
            )
        ]
    if found.dialect != dialect:
        return [Problem(expected.file, 0, Wording("CL920", "would_taken", title=title, recognized=found.recognized_by))]
    if expected.dialect == dialect and not _same_system(expected.system, found.system):
        return [Problem(expected.file, 0, Wording("CL920", "would_read_back_another", title=title))]
    names = {name for each in (expected, found) for operation in each.operations for name in operation.joined}
    return [
        Problem(expected.file, line, Wording("CL920", "would_read_back", title=title, subject=what))
        for line, what in _differences(_Rows.of(expected, names), _Rows.of(found, names))
    ]


def _same_system(ours: tuple[float, ...], theirs: tuple[float, ...]) -> bool:
    return len(ours) == len(theirs) and all(abs(a - b) <= _SAME_LENGTH for a, b in zip(ours, theirs, strict=True))


class _Rows(NamedTuple):
    """All operations in one."""

    columns: dict[str, Any]
    events: list[tuple[int, int, tuple[object, ...]]]
    line: Any

    @staticmethod
    def of(toolpath: Toolpath, names: Set[str]) -> "_Rows":
        """Return the rows without messages that are ``names`` of joined operations: one file may have operations for
        them.
        """
        operations = [operation for operation in toolpath.operations if len(operation.moves) or operation.events]
        begins = np.cumsum([0, *(len(operation.moves) for operation in operations)]).tolist()
        moves, arcs = [o.moves for o in operations], [o.arcs for o in operations]
        kind = np.concatenate([m.kind for m in moves])
        without = (kind == Kind.RAPID) | np.concatenate([rows_with_own_feed(o) for o in operations])
        feed = np.where(without, 0.0, np.concatenate([m.feed for m in moves]))
        columns = {
            "position": np.concatenate([m.tip for m in moves]),
            "tool axis": np.concatenate([m.axis for m in moves]),
            "kind of motion": kind,
            "feed": feed,
            "unit of the feed": np.concatenate([m.per_rev for m in moves]) & ~without & ~np.isnan(feed),
            "arc": np.concatenate([a.row + begin for a, begin in zip(arcs, begins, strict=False)]),
            "centre of an arc": np.concatenate([a.centre for a in arcs]),
            "normal of an arc": np.concatenate([a.normal for a in arcs]),
            "radius": np.concatenate([a.radius for a in arcs]),
            "number of turns": np.concatenate([a.full_turns for a in arcs]),
            "work offset": np.concatenate([np.full(len(o.moves), o.work_offset) for o in operations]),
            "tool diameter": np.concatenate([np.full(len(o.moves), o.tool.diameter) for o in operations]),
        }
        line = np.concatenate([m.line for m in moves])
        return _Rows(columns, list(_said(operations, begins, names)), line)


def _differences(expected: _Rows, found: _Rows) -> Iterator[tuple[int, str]]:
    """Line and name of the first difference of each kind."""
    if len(expected.line) != len(found.line):
        yield 0, f"number of points: {len(found.line)} instead of {len(expected.line)}"
        return
    arc_rows = expected.columns["arc"]
    for name, ours in expected.columns.items():
        theirs = found.columns[name]
        if len(ours) != len(theirs):
            yield 0, f"number of arcs: {len(theirs)} instead of {len(ours)}"
            return
        if len(off := np.flatnonzero(_differ(name, ours, theirs))):
            row = int(off[0]) if len(ours) == len(expected.line) and "arc" not in name else int(arc_rows[off[0]])
            yield int(expected.line[row]), name
    for ours, theirs in zip(expected.events, found.events, strict=False):
        if ours[0] != theirs[0] or not _is_same(ours[2], theirs[2]):
            yield ours[1], f"statement: {_shown(theirs[2])} instead of {_shown(ours[2])}"
            return
    if len(expected.events) > len(found.events):
        _, line, said = expected.events[len(found.events)]
        yield line, f"number of statements: {_shown(said)} is lost"
    elif len(expected.events) < len(found.events):
        yield 0, f"number of statements: {_shown(found.events[len(expected.events)][2])} is added"


def _differ(name: str, ours: Floats, theirs: Floats) -> Any:
    """(n,) bool: where two columns are not the same."""
    if ours.dtype.kind != "f":
        return ours != theirs
    tolerance = _SAME_DIRECTION if name in ("tool axis", "normal of an arc") else _SAME_LENGTH
    if name == "feed":
        return ~np.isclose(ours, theirs, rtol=_SAME_FEED, atol=_SAME_FEED, equal_nan=True)
    off = ~(np.abs(ours - theirs) <= tolerance)
    return off.any(axis=1) if off.ndim == 2 else off


def _said(
    operations: list[Operation], begins: list[int], names: Set[str]
) -> Iterator[tuple[int, int, tuple[object, ...]]]:
    """Row, line and content of each event that changes something."""
    loaded: tuple[int, int] | None = None
    cycle: tuple[object, ...] | None = None
    side = "OFF"
    for operation, begin in zip(operations, begins, strict=False):
        for event in sorted(operation.events, key=lambda event: event.row):
            said = _content(event)
            if isinstance(event, Message) and not event.display and event.text in names:
                continue
            if isinstance(event, LoadTool):
                repeated = loaded is not None and loaded[0] == event.number and event.adjust in (0, loaded[1])
                loaded = loaded if repeated else (event.number, event.adjust)
            elif isinstance(event, CycleOn):
                repeated, cycle = said == cycle, said
            elif isinstance(event, CycleOff):
                repeated, cycle = cycle is None, None
            elif isinstance(event, CutterComp):
                repeated, side = event.side == side == "OFF", event.side
            else:
                repeated = isinstance(event, SetMode)
            if not repeated:
                yield begin + event.row, event.line, said
        if cycle is not None:
            yield begin + len(operation.moves), operation.line, _content(CycleOff(0, 0))
            cycle = None
        if side != "OFF":
            yield begin + len(operation.moves), operation.line, _content(CutterComp(0, 0, "OFF"))
            side = "OFF"


def _content(event: Event) -> tuple[object, ...]:
    """Return what an event says, without its place, and without who said it."""
    if isinstance(event, CycleOn):
        return ("CycleOn", *_cycle(event))
    if isinstance(event, UnknownStatement):
        return ("UnknownStatement", "".join(event.text.replace("$", "").split()))
    if isinstance(event, From | GoHome):
        return (type(event).__name__, *_vectors(event))
    values = (getattr(event, field.name) for field in fields(event) if field.name not in _NOT_WRITTEN)
    return (type(event).__name__, *values)


def _is_same(ours: object, theirs: object) -> bool:
    """Whether two contents are the same: numbers within the last digit that is written, all else exactly."""
    if isinstance(ours, tuple) and isinstance(theirs, tuple):
        return len(ours) == len(theirs) and all(map(_is_same, ours, theirs))
    if isinstance(ours, float) and isinstance(theirs, float):
        return math.isclose(ours, theirs, rel_tol=_SAME_NUMBER, abs_tol=_SAME_NUMBER)
    return ours == theirs


def _vectors(event: From | GoHome) -> tuple[tuple[float, float, float], ...]:
    return (event.tip, event.axis) if isinstance(event, From) else ()


def _cycle(event: CycleOn) -> tuple[object, ...]:
    """Mode, numbers and words of a cycle, in one form for all dialects."""
    values = {word: [abs(n) if word == "FEDTO" else n for n in numbers] for word, numbers in event.values}
    words = dict(event.words)
    if "RTRCTO" not in words and "RAPTO" in values:
        values.setdefault("RTRCTO", values["RAPTO"])
    mode = ("FACE",) if event.mode == ("DRILL", "FACE") else event.mode
    numbers = tuple(sorted((word, tuple(n + 0.0 for n in given)) for word, given in values.items()))
    return mode, numbers, tuple(sorted(words.items()))


def _shown(said: tuple[object, ...]) -> str:
    return " ".join(str(part) for part in said)[:120]
