"""Rows of a run as the columns of an operation: positions, feeds and arcs."""

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.conversion.unsupported import Remarks
from trunnion.model.feed_path import counted
from trunnion.model.run import Run
from trunnion.model.toolpath import Arcs, Kind, Moves

#: Positions are taken to so many decimals: what is beyond them comes from computing with binary fractions.
_DECIMALS = 9


def moves_of(run: Run, rows: Ints, phase: Codes, remark: Remarks) -> Moves:
    """The columns of the ``rows`` (n,) of a run; ``phase`` (n,) is a ``trunnion.model.toolpath.Phase``."""
    feed, per_rev = _feeds(run, rows, remark)
    tip = np.round(run.tip[rows], _DECIMALS) + 0.0
    return Moves(tip, run.axis[rows], run.kind[rows], phase, feed, per_rev, run.block[rows])


def arcs_of(run: Run, rows: Ints) -> Arcs:
    """The arcs among the ``rows`` (n,)."""
    made = np.flatnonzero(run.kind[rows] == Kind.ARC)
    here = np.searchsorted(run.arcs.row, rows[made])
    return Arcs(
        made.astype(np.int64),
        np.round(run.arcs.centre[here], _DECIMALS) + 0.0,
        run.arcs.normal[here] + 0.0,
        np.round(run.arcs.radius[here], _DECIMALS),
        run.arcs.turns[here],
    )


def _feeds(run: Run, rows: Ints, remark: Remarks) -> tuple[Floats, Flags]:
    """Feeds in mm/min or mm/rev, and whether per revolution.

    Rapids carry on what was in force; before the first cut there is none.
    """
    feed, mode = run.feed[rows], run.feed_mode[rows]
    rapid = run.kind[rows] == Kind.RAPID
    inverse = np.flatnonzero((mode == 93) & ~rapid)
    feed[inverse] *= _lengths(run, rows[inverse])
    way = counted(run, rows)
    free = np.flatnonzero(~np.isnan(way))
    feed[free] *= _lengths(run, rows[free]) / way[free]
    led = np.union1d(inverse, free)
    lost = run.block[rows[led[feed[led] == 0.0]]]
    if len(lost):
        what = f"{len(lost)} blocks turn the tool about a tip that rests: they have no feed in mm/min"
        remark(int(lost[0]), what, "their feed becomes 0")
    last_cut = np.maximum.accumulate(np.where(rapid, -1, np.arange(len(feed))))
    feed = np.where(last_cut >= 0, feed[last_cut], np.nan)
    return feed, np.asarray((mode[last_cut] == 95) & ~np.isnan(feed))


def _lengths(run: Run, rows: Ints) -> Floats:
    """(n,) float64: length of the tip's way to each row, mm."""
    length: Floats = np.linalg.norm(run.tip[rows] - run.tip[np.maximum(rows - 1, 0)], axis=1)
    for place in np.flatnonzero(run.kind[rows] == Kind.ARC).tolist():
        length[place] = _arc_length(run, int(rows[place]))
    return length


def _arc_length(run: Run, row: int) -> float:
    arcs = run.arcs
    place = int(np.searchsorted(arcs.row, row))
    normal = arcs.normal[place]
    start, end = run.tip[row - 1] - arcs.centre[place], run.tip[row] - arcs.centre[place]
    rise = float((end - start) @ normal)
    start, end = start - (start @ normal) * normal, end - (end @ normal) * normal
    angle = float(np.arctan2(np.cross(start, end) @ normal, start @ end)) % (2 * np.pi)
    sweep = (angle if angle > 1e-9 else 2 * np.pi) + 2 * np.pi * float(arcs.turns[place])
    return float(np.hypot(sweep * arcs.radius[place], rise))
