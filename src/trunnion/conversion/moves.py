"""Rows of a run as the columns of an operation: positions, feeds and arcs."""

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.feed_path import row_feed_path_lengths
from trunnion.model.run import Run
from trunnion.model.toolpath import Arcs, Kind, Moves

#: Positions are rounded to this many decimals: the rest is rounding error of binary fractions.
_DECIMALS = 9


def build_moves(run: Run, rows: Ints, phase: Codes, warn: Warnings) -> Moves:
    """Return the columns of the ``rows`` (n,) of a run; ``phase`` (n,) is a ``trunnion.model.toolpath.Phase`` each."""
    feed, per_rev = _feeds(run, rows, warn)
    tip = np.round(run.tip[rows], _DECIMALS) + 0.0
    return Moves(tip, run.axis[rows], run.kind[rows], phase, feed, per_rev, run.line[rows])


def build_arcs(run: Run, rows: Ints) -> Arcs:
    """Return the arcs among the ``rows`` (n,)."""
    arc_rows = np.flatnonzero(run.kind[rows] == Kind.ARC)
    index = np.searchsorted(run.arcs.row, rows[arc_rows])
    return Arcs(
        arc_rows.astype(np.int64),
        np.round(run.arcs.centre[index], _DECIMALS) + 0.0,
        run.arcs.normal[index] + 0.0,
        np.round(run.arcs.radius[index], _DECIMALS),
        run.arcs.full_turns[index],
    )


def _feeds(run: Run, rows: Ints, warn: Warnings) -> tuple[Floats, Flags]:
    """Return feeds (n,) in mm/min or mm/rev, and whether they are per revolution, (n,) bool.

    Rapids keep the feed in force; before the first cut it is NaN. Inverse-time feeds, and feeds along another path than
    that of the tip, are converted to mm/min of the tip.
    """
    feed, mode = run.feed[rows], run.feed_mode[rows]
    rapid = run.kind[rows] == Kind.RAPID
    inverse = np.flatnonzero((mode == 93) & ~rapid)
    feed[inverse] *= _path_lengths(run, rows[inverse])
    feed_path_length = row_feed_path_lengths(run, rows)
    without_tcp = np.flatnonzero(~np.isnan(feed_path_length))
    feed[without_tcp] *= _path_lengths(run, rows[without_tcp]) / feed_path_length[without_tcp]
    rescaled = np.union1d(inverse, without_tcp)
    without_feed = run.line[rows[rescaled[feed[rescaled] == 0.0]]]
    if len(without_feed):
        warn(int(without_feed[0]), Wording("CNV180", "no_feed_mm", count=len(without_feed)))
    last_cut = np.maximum.accumulate(np.where(rapid, -1, np.arange(len(feed))))
    feed = np.where(last_cut >= 0, feed[last_cut], np.nan)
    return feed, np.asarray((mode[last_cut] == 95) & ~np.isnan(feed))


def _path_lengths(run: Run, rows: Ints) -> Floats:
    """(n,) float64: length of the tip's path to each row, mm."""
    length: Floats = np.linalg.norm(run.tip[rows] - run.tip[np.maximum(rows - 1, 0)], axis=1)
    for index in np.flatnonzero(run.kind[rows] == Kind.ARC).tolist():
        length[index] = _arc_length(run, int(rows[index]))
    return length


def _arc_length(run: Run, row: int) -> float:
    """Length of the arc or helix of a row, mm."""
    arcs = run.arcs
    index = int(np.searchsorted(arcs.row, row))
    normal = arcs.normal[index]
    start, end = run.tip[row - 1] - arcs.centre[index], run.tip[row] - arcs.centre[index]
    rise = float((end - start) @ normal)
    start, end = start - (start @ normal) * normal, end - (end @ normal) * normal
    angle = float(np.arctan2(np.cross(start, end) @ normal, start @ end)) % (2 * np.pi)
    sweep = (angle if angle > 1e-9 else 2 * np.pi) + 2 * np.pi * float(arcs.full_turns[index])
    return float(np.hypot(sweep * arcs.radius[index], rise))
