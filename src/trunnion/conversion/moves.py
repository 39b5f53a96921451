"""Rows of a run as the columns of an operation: positions, feeds and arcs."""

from collections.abc import Iterable

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.feed_path import row_feed_path_lengths
from trunnion.model.run import Run
from trunnion.model.toolpath import Arcs, Kind, Moves

#: Pieces are of one circle if centre, radius and slope differ by less, mm; and the same points, mm.
_SAME_CIRCLE = 1e-4
_SAME_POINT = 1e-9

#: Nearer to a full turn than this, radians, only ends that are the same point tell that it is one.
_NEARLY_WHOLE = 1e-3

#: G93.
_INVERSE_TIME = 93

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


def without_pieces_of_arcs(run: Run, rows: Ints, divided: Iterable[int]) -> Ints:
    """Return the ``rows`` (n,) of a stretch without those behind which the next one goes on along the same circle.

    divided  rows before which something happens
    """
    kept, barred = np.ones(len(rows), np.bool_), {*divided, *(comment.before_row for comment in run.comments)}
    are_arcs = run.kind[rows] == Kind.ARC
    pairs = np.flatnonzero(are_arcs[:-1] & are_arcs[1:] & (np.diff(rows) == 1))
    start, gone = 0, 0.0  # the row before the arc, and how far round it has gone
    for k in pairs.tolist():
        row, following = int(rows[k]), int(rows[k + 1])
        if k == 0 or kept[k - 1]:
            start, gone = row - 1, 0.0
        gone += _sweep(run, row)
        if following in barred or not _goes_on(run, row):
            continue
        whole = gone + _sweep(run, following)
        way = run.tip[following] - run.tip[max(start, 0)]
        normal = run.arcs.normal[int(np.searchsorted(run.arcs.row, row))]
        closes = float(np.abs(way - (way @ normal) * normal).max()) < _SAME_POINT
        is_whole = closes and abs(whole - 2.0 * np.pi) < _NEARLY_WHOLE
        kept[k] = not (is_whole or whole < 2.0 * np.pi - _NEARLY_WHOLE)
    return rows[kept]


def _goes_on(run: Run, row: int) -> bool:
    """Whether the arc of a row and that of the next one are pieces of one circle or helix, at one feed."""
    arcs = run.arcs
    here, there = (int(np.searchsorted(arcs.row, each)) for each in (row, row + 1))
    normal, between = arcs.normal[here], arcs.centre[there] - arcs.centre[here]
    slopes = [float((run.tip[k] - run.tip[k - 1]) @ normal) / _sweep(run, k) for k in (row, row + 1)]
    same_state = (
        run.feed[row] == run.feed[row + 1]
        and run.feed_mode[row] == run.feed_mode[row + 1] != _INVERSE_TIME
        and bool((run.axis[row] == run.axis[row + 1]).all())
        and not (arcs.full_turns[here] or arcs.full_turns[there])
    )
    return (
        same_state
        and float(np.abs(between - (between @ normal) * normal).max()) < _SAME_CIRCLE
        and float(np.abs(normal - arcs.normal[there]).max()) < _SAME_CIRCLE
        and abs(float(arcs.radius[here] - arcs.radius[there])) < _SAME_CIRCLE
        and abs(slopes[0] - slopes[1]) < _SAME_CIRCLE
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
    index = int(np.searchsorted(run.arcs.row, row))
    rise = float((run.tip[row] - run.tip[row - 1]) @ run.arcs.normal[index])
    return float(np.hypot(_sweep(run, row) * run.arcs.radius[index], rise))


def _sweep(run: Run, row: int) -> float:
    """How far round the arc of a row goes, radians."""
    arcs = run.arcs
    index = int(np.searchsorted(arcs.row, row))
    normal = arcs.normal[index]
    start, end = run.tip[row - 1] - arcs.centre[index], run.tip[row] - arcs.centre[index]
    start, end = start - (start @ normal) * normal, end - (end @ normal) * normal
    angle = float(np.arctan2(np.cross(start, end) @ normal, start @ end)) % (2 * np.pi)
    return (angle if angle > 1e-9 else 2 * np.pi) + 2 * np.pi * float(arcs.full_turns[index])
