"""A plan as the rows of a path."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.machines import Machine, inverse
from trunnion.model.arc_extremes import operation_arcs
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Kind, LoadTool
from trunnion.placing.path_rows import PathRows, Stretch, joined_rows, no_arcs
from trunnion.planning.holes.hole_ends import hole_ends


def rows_of_plan(machine: Machine, motions: Sequence[Motion]) -> PathRows:
    """Return the rows of all motions; of holes that are cycles also their bottoms, and where the tool leaves them."""
    parts = [_rows_of_motion(machine, motion, tool) for motion, tool in zip(motions, _tools(motions), strict=True)]
    home = machine.home[list(machine.rotary)][None]
    rows = joined_rows([replace(part, start=home) for part in parts])
    rows.straight[rows.begins] = False  # the tool comes from elsewhere
    begins = np.array([motion.starts_operation for motion in motions])
    begins[0] = True
    stretches = tuple(stretch for stretch, is_first in zip(rows.stretches, begins, strict=True) if is_first)
    return replace(rows, stretches=stretches, start=rows.start[begins])


def _tools(motions: Sequence[Motion]) -> Iterator[str]:
    """Yield the number of the tool in the spindle in each motion; empty: none was loaded."""
    number = ""
    for motion in motions:
        for event in motion.operation.events:
            if isinstance(event, LoadTool):
                number = str(event.number)
        yield number


def _rows_of_motion(machine: Machine, motion: Motion, tool: str) -> PathRows:
    operation, moves = motion.operation, motion.operation.moves
    seconds = np.zeros(len(moves))
    way = np.linalg.norm(np.diff(moves.tip, axis=0), axis=1)
    timed = (moves.kind[1:] != Kind.RAPID) & (moves.feed[1:] > 0.0) & ~moves.per_rev[1:]
    seconds[1:][timed] = 60.0 * way[timed] / moves.feed[1:][timed]
    tcp = not motion.mode.goes_straight
    rows = PathRows(
        moves.tip, moves.axis, branches(machine, moves.tip, moves.axis, motion.rotary), moves.line.astype(np.int64),
        np.full(len(moves), tcp), seconds, (Stretch(0, operation.file, operation.name, tool),), motion.rotary[:1],
        operation_arcs(operation) if len(operation.arcs.row) else no_arcs(), operation.arcs.row,
    )  # fmt: skip
    holes, ends = hole_ends(operation)
    return _with_holes(rows, holes, ends) if len(holes) else rows


def branches(machine: Machine, tip: Floats, axis: Floats, rotary: Floats) -> Codes:
    """(n,) uint8: which solution of the inverse map rotary positions (n, 2) are, degrees."""
    found = inverse(machine, tip, axis)
    off = np.abs(np.mod(found.joints[:, :, list(machine.rotary)] - rotary + 180.0, 360.0) - 180.0)
    off[:, found.pole, 0] = 0.0
    both = off.sum(axis=2)
    return np.asarray(both[1] < both[0] - 1e-6, np.uint8)


def _with_holes(rows: PathRows, holes: Ints, ends: Floats) -> PathRows:
    """Return the rows with two more after each hole, its bottom and the point from which the tool goes on."""
    count = np.zeros(len(rows), np.int64)
    count[holes] = 2
    source = np.repeat(np.arange(len(rows)), 1 + count)
    new = np.arange(len(rows)) + np.append(0, np.cumsum(count)[:-1])
    tip = rows.tip[source]
    tip[new[holes] + 1], tip[new[holes] + 2] = ends
    seconds = np.zeros(len(source))
    seconds[new] = rows.seconds
    return PathRows(
        tip, rows.axis[source], rows.branch[source], rows.line[source], rows.straight[source], seconds,
        rows.stretches, rows.start, rows.arcs, new[rows.arc_row],
    )  # fmt: skip
