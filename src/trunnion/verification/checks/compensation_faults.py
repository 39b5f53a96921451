"""Radius compensation in a plane that the tool axis leaves, and blocks across which it does not see the next corner."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.messages import Wording
from trunnion.model.run import CHUNK_ROWS, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import Context
from trunnion.verification.results import Place

#: A smaller motion in the plane, mm, is none.
_STILL: Final = 1e-6

#: The tool axis may be off the normal of the plane by so much, degrees: more than the rounding of printed angles.
_ASKEW: Final = 0.05


def compensated_blind(context: Context) -> Iterator[Place]:
    """Yield the first stop, and the first too many blocks without motion, between two compensated motions.

    The control offsets a corner when it has read the motion after it. It reads a number of blocks ahead at most, and
    some none at a stop: there it takes the tool square to the end of the motion before, into the wall of an inside
    corner.
    """
    run, settings = context.run, context.settings
    if set(run.state.compensation.distinct().tolist()) <= {0}:
        return
    on = np.flatnonzero(run.compensation != 0)
    if not len(on):
        return
    if not settings.stops_in_compensation:
        within = set(on[1:][np.diff(on) == 1].tolist())
        stops = (
            event for event in run.events if event.kind in ("stop", "optional_stop") and event.before_row in within
        )
        for event in stops:
            yield context.place_of_event(event, 0.0, Wording("modal", "stop_compensated"))
            break
    row, found = next(blind_corners(run, settings.blocks_in_compensation), (-1, 0))
    if row >= 0:
        said = Wording("modal", "blocks_compensated", found=found, most=settings.blocks_in_compensation)
        yield context.place(row, float(found), said)


def blind_corners(run: Run, most: int) -> Iterator[tuple[int, int]]:
    """Yield rows within radius compensation before which more than ``most`` blocks do not move, and how many."""
    on = np.flatnonzero(run.compensation != 0)
    if not len(on):
        return
    moving = _moves_in_plane(run, on)
    # Blocks without motion up to each row, from the first row with compensation on.
    blocks = np.cumsum(_blocks_before(run, on) + ~moving)
    spell = np.cumsum(np.diff(on, prepend=on[0] - 1) != 1)
    at = np.flatnonzero(moving)
    count = np.diff(blocks[at])
    count[np.diff(spell[at]) != 0] = 0
    for k in np.flatnonzero(count > most).tolist():
        yield int(on[at[k + 1]]), int(count[k])


def _moves_in_plane(run: Run, rows: Ints) -> Flags:
    """Whether rows move across the tool, (k,)."""
    moving = np.ones(len(rows), np.bool_)
    for first in range(0, len(rows), CHUNK_ROWS):
        part = rows[first : first + CHUNK_ROWS]
        here = run.positions(part)
        way = here.tip - run.positions(part - 1).tip
        across = way - np.einsum("ij,ij->i", way, here.axis)[:, None] * here.axis
        moving[first : first + CHUNK_ROWS] = (np.abs(across).max(axis=1) > _STILL) | (run.kind[part] == Kind.ARC)
    return moving


def _blocks_before(run: Run, rows: Ints) -> Ints:
    """How many blocks stand between each row and the one before it, (k,); lines of comments are none.

    From one file to another these are the blocks that are known to switch something.
    """
    lines = run.line.astype(np.int64)
    before = np.maximum(rows - 1, 0)
    gap = np.maximum(lines[rows] - lines[before] - 1, 0)
    file = run.state.file
    elsewhere = (file.at(rows) != file.at(before)) | (lines[rows] < lines[before])
    switching = {(event.before_row, event.file, event.line) for event in run.events}
    only_comments = {(each.before_row, each.file, each.line) for each in run.comments} - switching
    gap -= _count_at(rows, only_comments, lines)
    gap[elsewhere] = _count_at(rows, switching, lines)[elsewhere]
    return np.asarray(np.maximum(gap, 0))


def _count_at(rows: Ints, found: set[tuple[int, int, int]], lines: Ints) -> Ints:
    """How many lines of (row before which, file, line) precede each row, but for those of motions."""
    here = [row for row, _, line in found if row >= len(lines) or (line != lines[row] and line != lines[row - 1])]
    counts = np.bincount(np.array(here, np.int64), minlength=len(lines) + 1)
    return np.asarray(counts[rows])


def compensated_askew(context: Context) -> Iterator[Place]:
    """Yield the first motion under compensation whose tool axis is not perpendicular to the plane of compensation."""
    run = context.run
    if not len(run.compensation_planes):
        return
    on = np.flatnonzero(run.compensation != 0)
    on = on[(run.state.compensation_plane.at(on) >= 0) & ~run.state.machine_frame.at(on)]
    for first in range(0, len(on), CHUNK_ROWS):
        rows = on[first : first + CHUNK_ROWS]
        normal = run.compensation_planes[run.state.compensation_plane.at(rows)]
        along = np.abs(np.einsum("ij,ij->i", run.positions(rows).axis, normal))
        angle = np.degrees(np.arccos(np.minimum(along, 1.0)))
        askew = np.flatnonzero(angle > _ASKEW)
        if len(askew):
            worst = float(angle[askew[0]])
            yield context.place(int(rows[askew[0]]), worst, Wording("modal", "askew", angle=worst))
            return
