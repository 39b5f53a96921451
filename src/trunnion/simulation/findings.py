"""What a simulation finds: which blocks do what they must not, first and worst of a run of blocks.

In:     what the rows of a run did (``RowsCut``), and the run.
Out:    ``Finding`` records, in the order of the program.
Units:  mm, workpiece frame.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.simulation.cutting.measurements import Depths, RowsCut
from trunnion.simulation.finding import Finding, What
from trunnion.simulation.stock.deviation import Gouges
from trunnion.simulation.tools.profile import Role, ToolShape

#: Rows without a finding that do not end a run of rows with one.
_PAUSE: Final = 2


def row_findings(run: Run, rows: RowsCut, shape: ToolShape, limit: float, turning: Flags) -> Iterator[Finding]:
    """Yield the findings of consecutive rows with one tool; what is no deeper than ``limit`` mm is none.

    ``turning`` says for all rows of the run whether the spindle turns, as ``spindle_turns`` has it.
    """
    name = tool_name(run, rows.tool)
    first, end = rows.first, rows.first + len(rows.removed)
    rapid = run.kind[first:end] == Kind.RAPID
    deep = rows.idle.depth > limit
    yield from _runs(What.RAPID, (name, "stock"), first, rapid & deep, rows.idle, pause=0)
    standing = ~rapid & ~turning[first:end] & deep
    yield from _runs(What.STANDING, (name, "stock"), first, standing, rows.idle)
    for section, met in rows.met.items():
        if section >= len(shape.sections):  # it only stands around one of them (``near_stock``)
            continue
        role = shape.sections[section].role
        what = What.HOLDER if role is Role.HOLDER else What.SHANK
        body = f"{what.name.lower()} of {name}"
        yield from _runs(what, (body, "stock"), first, met.depth > limit, met)


def gouge_findings(run: Run, tool: int, first: int, end: int, gouges: Gouges, apart: float) -> Iterator[Finding]:
    """Yield the gouges of rows ``first`` to ``end`` (exclusive); rows no farther ``apart`` than this, mm, are one."""
    own = np.flatnonzero((gouges.row >= first) & (gouges.row < end))
    own = own[np.lexsort((-gouges.thickness[own], gouges.row[own]))]
    rows, which = np.unique(gouges.row[own], return_index=True)
    if not len(rows):
        return
    steps = np.linalg.norm(np.diff(run.tip[first:end], axis=0, prepend=run.tip[first : first + 1]), axis=1)
    way = np.cumsum(steps)[rows - first]
    breaks = (np.diff(rows) > 1 + _PAUSE) & (np.diff(way) > apart)
    for part in np.split(np.arange(len(rows)), np.flatnonzero(breaks) + 1):
        worst = part[gouges.thickness[own[which[part]]].argmax()]
        place = own[which[worst]]
        x, y, z = gouges.place[place].tolist()
        depth = float(gouges.thickness[place])
        between = tool_name(run, tool), "part"
        yield Finding(
            What.GOUGE, between, (int(rows[part[0]]), int(rows[part[-1]])), int(rows[worst]), depth, (x, y, z)
        )


def idle_rows(run: Run, turning: Flags) -> Flags:
    """Rows that must not cut: rapids, and those in which the spindle stands, (n,)."""
    return np.asarray((run.kind == Kind.RAPID) | ~turning)


def spindle_turns(run: Run) -> Flags:
    """Whether the spindle turns in each row, (n,).

    A tool change stops it until the program says it again. A cycle that drives the spindle starts it by itself.
    """
    turning = (run.spindle != 0) & (run.rpm > 0.0)
    said, row = True, 0
    for event in run.events:
        if event.kind not in ("tool_change", "spindle"):
            continue
        if not said:
            turning[row : event.before_row] = False
        said, row = event.kind == "spindle", event.before_row
    if not said:
        turning[row:] = False
    for hole in run.spindle_holes:
        turning[hole.first : hole.end] = True
    return np.asarray(turning)


def tool_name(run: Run, tool: int) -> str:
    """Return a tool as messages name it; 0 where the program has called none."""
    return f"tool {run.tools[tool] or 0}"


def _runs(
    what: What, between: tuple[str, str], first: int, flags: Flags, depths: Depths, pause: int = _PAUSE
) -> Iterator[Finding]:
    """Consecutive rows as one finding."""
    for part in rows_together(flags, pause):
        worst = int(part[depths.depth[part].argmax()])
        x, y, z = depths.place[worst].tolist()
        rows = int(part[0]) + first, int(part[-1]) + first
        yield Finding(what, between, rows, worst + first, float(depths.depth[worst]), (x, y, z))


def rows_together(flags: Flags, pause: int = _PAUSE) -> Iterator[Ints]:
    """Yield the places of flags, in parts between which more than ``pause`` are off."""
    found = np.flatnonzero(flags)
    if len(found):
        yield from np.split(found, np.flatnonzero(np.diff(found) > 1 + pause) + 1)


def air_cuts(run: Run, rows: RowsCut) -> Ints:
    """Rows at feed that took nothing away."""
    end = rows.first + len(rows.removed)
    idle = (run.kind[rows.first : end] != Kind.RAPID) & (rows.removed <= 0.0)
    return np.flatnonzero(idle) + rows.first


def file_of_row(run: Run, row: int) -> str:
    """Return the file in which the block of a row stands."""
    return run.files[int(run.state.file[row])]
